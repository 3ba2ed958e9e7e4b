// SPDX-License-Identifier: Apache-2.0
/// \file
/// The part of a solid that lies in half-spaces, as the search for a few balls sees it.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "base/numbers.hpp"
#include "scaleaxis/few_balls.hpp"
#include "solid/pointwise_solid.hpp"

namespace scaleaxis::inline v1 {

/// How far a point is from leaving the half-spaces, whose normals have length 1; negative outside, infinity for none.
inline double clearance(std::span<const HalfSpace> spaces, const Point& p) {
    double least = kInfinity;
    for (const auto& [normal, offset] : spaces) {
        least = std::min(least, dot(normal, p) - offset);
    }
    return least;
}

/// The nearest point may be one of a plane outside the solid. Its distance is right all the same, inside: a ball lies
/// in the part if it lies in both.
class ClippedSolid final : public PointwiseSolid {
   public:
    ClippedSolid(const Solid& solid, std::span<const HalfSpace> spaces) : solid_(solid), spaces_(spaces) {}

    Box bounds() const override { return solid_.bounds(); }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        std::vector<Point> points = solid_.seeds(spacing, seed, execution);
        std::erase_if(points, [&](const Point& p) { return clearance(spaces_, p) < 0.0; });
        return points;
    }

   private:
    bool is_inside(const Point& p) const override { return clearance(spaces_, p) >= 0.0 && solid_.inside(p); }

    std::optional<Point> crossing_of(const Point&, const Point&, const Point&) const override { return std::nullopt; }

    std::optional<Point> nearest_to(const Point& p, double bound) const override {
        std::optional<Point> nearest;
        for (const auto& [normal, offset] : spaces_) {
            const double height = dot(normal, p) - offset;
            if (std::abs(height) < bound) {
                bound = std::abs(height);
                nearest = p - height * normal;
            }
        }
        const std::optional<Point> own = solid_.nearest(p, bound);
        return own ? own : nearest;
    }

    const Solid& solid_;
    std::span<const HalfSpace> spaces_;
};

}  // namespace scaleaxis::inline v1
