// SPDX-License-Identifier: Apache-2.0
/// \file
/// A union of balls as an object that keeps what several stages need of it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// The vertices of the boundary of a union of balls: the points where three spheres meet that no ball covers.
struct BoundaryVertices {
    std::vector<Point> points;                ///< #V
    std::vector<std::array<Index, 3>> balls;  ///< #V×3; the balls of the three spheres, ascending
    /// #P×2; the two vertices of each triangle of the dual complex that belongs to no tetrahedron of it. Such triangles
    /// are faces of the medial axis.
    std::vector<std::array<Index, 2>> pairs;
};

class UnionData;  // not public

/// A union of balls, which may lie in any position to each other, coincide, or hide each other.
///
/// Search trees, dual complex and boundary vertices are built when they are first needed, each once, and kept. Copies
/// share them. All members may be called from several threads at once; their results do not depend on which was called
/// first, nor on the number of threads.
///
/// The dual complex, and what follows from it (`topology`, `neighbors`, `boundary_vertices`, `distances_to_boundary`),
/// is that of the balls in general position: coinciding balls once (see `distinct_balls`), radii larger by 2e-9 of
/// themselves, centres moved by at most 1e-9 of the radius. Balls that touch still do.
///
/// Where a member takes an `Execution`, it says how that call runs; all of them throw `Cancelled`.
class SCALEAXIS_EXPORT BallUnion {
   public:
    /// The empty union. Its members throw `UnusableInput` where they need a ball.
    BallUnion();

    /// \param balls at least one
    /// \throws UnusableInput if there are none; or as `check_balls`; or if the diagonal of their box is not between
    ///     1e-40 and 1e18, or less than 1e-9 of their largest coordinate
    explicit BallUnion(std::vector<Ball> balls);

    /// The balls as given. All indices of balls below are positions in this array.
    std::span<const Ball> balls() const;

    /// The box around the balls.
    Box bounds() const;

    /// Topology of the union, which is that of its dual complex.
    Topology topology(const Execution& execution = {}) const;

    /// For each ball those with which it shares an edge of the dual complex. Of coinciding balls only the first has
    /// any.
    IndexLists neighbors(const Execution& execution = {}) const;

    /// The vertices of the boundary of the union.
    BoundaryVertices boundary_vertices(const Execution& execution = {}) const;

    /// For each point the ball to which the signed distance |p - centre| - radius is least; of several, the first.
    /// \param points #P \returns #P
    std::vector<NearestBall> nearest_balls(std::span<const Point> points, const Execution& execution = {}) const;

    /// For each point the least signed distance to a ball: negative inside, 0 on the boundary. Outside it is the
    /// distance to the union. Inside its magnitude is the depth in the one ball in which the point is deepest, which is
    /// at most the distance to the boundary.
    /// \param points #P \returns #P, in units of the balls
    std::vector<double> signed_distances(std::span<const Point> points, const Execution& execution = {}) const;

    /// Does each point lie in the union or on its boundary?
    /// \param points #P \returns #P, 1 or 0
    std::vector<std::uint8_t> inside(std::span<const Point> points, const Execution& execution = {}) const;

    /// The distance of each point, inside or outside, to the nearest point of the boundary; exact up to 1e-8 of
    /// the radii.
    /// \param points #P \returns #P, in units of the balls, ≥ 0
    std::vector<double> distances_to_boundary(std::span<const Point> points, const Execution& execution = {}) const;

    // For the stages of the library.
    explicit BallUnion(std::shared_ptr<const UnionData> data);
    /// \throws UnusableInput if the union is empty
    const UnionData& data() const;

   private:
    std::shared_ptr<const UnionData> data_;
};

/// The union as a solid that can be sampled, of the balls in general position (see `BallUnion`).
/// \throws UnusableInput (the union is empty), Cancelled
SCALEAXIS_EXPORT std::unique_ptr<Solid> union_solid(const BallUnion& balls, const Execution& execution = {});

/// \throws UnusableInput (see `BallUnion`), Cancelled
SCALEAXIS_EXPORT std::unique_ptr<Solid> union_solid(std::vector<Ball> balls, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
