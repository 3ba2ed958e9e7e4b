// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which points of the spheres of a union of balls belong to its boundary.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Points on a sphere are taken for covered only if they lie deeper in another ball than rounding can tell, relative to
/// its squared radius.
constexpr double kRounding = 1e-12;

/// Where two spheres meet.
struct Circle {
    Point center;
    Point normal;
    double radius;

    Circle(const Ball& a, const Ball& b) {
        const Point along = b.center - a.center;
        const double length = norm(along);
        normal = (1.0 / length) * along;
        const double position = 0.5 * (length + (a.radius - b.radius) * (a.radius + b.radius) / length);
        center = a.center + position * normal;
        radius = std::sqrt(std::max(0.0, a.radius * a.radius - position * position));
    }

    /// The point of the circle in a direction, which need not lie in its plane.
    Point toward(const Point& direction) const {
        const Point in_plane = direction - dot(direction, normal) * normal;
        const double length = norm(in_plane);
        if (length > kRounding * norm(direction)) {
            // Once more, for rounding has left something that is not in the plane.
            const Point unit = (1.0 / length) * in_plane;
            const Point radial = unit - dot(unit, normal) * normal;
            return center + (radius / norm(radial)) * radial;
        }
        // All of the circle is as near; which point does not matter.
        return toward(std::abs(normal.x) < 0.5 ? Point{1, 0, 0} : Point{0, 1, 0});
    }
};

/// Is a point on the sphere of a ball of the dual complex (and perhaps on that of its neighbor `other`) covered by no
/// neighbor? Of all balls it is enough to ask the neighbors in the dual complex: the way from the ball's own part of
/// the power diagram to a point that another ball covers leads, within the ball, into the part of a neighbor that
/// covers the point too.
inline bool is_exposed(std::span<const Ball> balls, const IndexLists& neighbors, Index ball, Index other,
                       const Point& p) {
    const std::span<const Index> list = neighbors[ball];
    return std::none_of(list.begin(), list.end(), [&](Index k) {
        const auto& [center, radius] = balls[k];
        return k != other && squared_distance(p, center) < (1.0 - kRounding) * radius * radius;
    });
}

}  // namespace scaleaxis::inline v1
