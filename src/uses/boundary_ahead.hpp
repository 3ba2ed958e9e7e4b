// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far the boundary of a solid is ahead.
#pragma once

#include <functional>
#include <optional>

#include "axis/envelope_data.hpp"
#include "base/numbers.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// The distance of a point to the boundary: positive inside.
using DistanceInside = std::function<double(const Point&)>;

/// \param solid that knows the nearest points of its boundary, and outlives the result
inline DistanceInside distance_inside(const Solid& solid) {
    return [&](const Point& p) { return (solid.inside(p) ? 1.0 : -1.0) * distance(p, *solid.nearest(p)); };
}

/// In radii, how far the boundary is from the centre of a ball, at most: farther on is another part of the solid. In a
/// corner of 90 degrees of a plate, or at a rim of 45, it is at √2, and of a ragged border a little farther; ways that
/// are longer run along a wall, as where the free edge of a rib ends in it.
inline constexpr double kMostRadii = 2.0;

/// The way from the border of the middle of a wall to the boundary in some direction: steps as long as the distance to
/// it cannot miss it. Nothing if it is too far, or met at less than about 25 degrees, which takes more steps.
inline std::optional<double> way_to_boundary(const Point& from, const Point& direction, double radius,
                                             const DistanceInside& distance) {
    constexpr int kMostSteps = 20;
    double way = 0.0;
    for (int step = 0; step < kMostSteps && way <= kMostRadii * radius; ++step) {
        const double left = distance(from + way * direction);
        way += left;
        if (left <= kNegligible * radius) {
            return way;
        }
    }
    return std::nullopt;
}

}  // namespace scaleaxis::inline v1
