// SPDX-License-Identifier: Apache-2.0
/// \file
/// Balls between opposite sides of a solid, or of what is outside it, from points of its boundary.
#pragma once

#include <array>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// All that a solid is not, with the same boundary and the same bounds.
class OutsideOf final : public Solid {
   public:
    explicit OutsideOf(const Solid& solid) : solid_(solid) {}

    Box bounds() const override { return solid_.bounds(); }
    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override;
    void crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const override;
    const NearestPoints* nearest_points() const override { return solid_.nearest_points(); }
    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return solid_.seeds(spacing, seed, execution);
    }

   private:
    const Solid& solid_;
};

/// \throws InvalidOption if the angle between two contacts is not in `kWallAngleRange`
void check_wall_angle(double angle);

/// Appends normals of vertices from the first that has none: the mean of those of the triangles there, by their angles.
void add_normals(const TriangleMesh& mesh, std::vector<Point>& normals);

/// The ball that a point of the boundary leads to: one that is seen from the point in a direction, moved `uphill` to
/// between two opposite sides. \param inwards of length 1 \param slope see `uphill` \param most radius of interest: a
/// ball as large is returned as soon as one is found
Ball ball_between_sides(const Solid& solid, const Point& p, const Point& inwards, double slope, double most);

/// The same for a point on the boundary or in the solid.
Ball ball_between_sides(const Solid& solid, const Point& p, double slope, double most);

/// The two contacts of a ball that are farthest apart.
std::array<Point, 2> opposite_contacts(const Solid& solid, const Ball& ball);

/// The smallest ball that is reached by going down along the wall. \param slope see `uphill`
Ball downhill(const Solid& solid, Ball ball, double slope);

}  // namespace scaleaxis::inline v1
