// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/winding.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace scaleaxis {
namespace {

constexpr std::array<double Point::*, 3> kAxes{&Point::x, &Point::y, &Point::z};

/// A point beyond one of the six sides of the box, a little askew from `p`, so that the way there does not run along
/// the edges and faces of a mesh that is aligned with the axes.
Point beyond_side(const Box& box, const Point& p, int axis, bool is_upper) {
    double Point::*const x = kAxes[(axis + 1) % 3];
    double Point::*const y = kAxes[(axis + 2) % 3];
    double Point::*const z = kAxes[axis];
    const double sign = is_upper ? 1.0 : -1.0;
    const double side = is_upper ? box.max.*z : box.min.*z;
    const double end = side + sign * 0.01 * box.diagonal();
    const double way = std::abs(end - p.*z);
    Point q = p;
    q.*x += 0.0123 * way;
    q.*y += 0.0071 * way;
    q.*z = std::nextafter(end, sign * std::numeric_limits<double>::infinity());
    return q;
}

Point beyond_nearest_side(const Box& box, const Point& p) {
    int axis = 0;
    bool is_upper = false;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const double below = p.*kAxes[k] - box.min.*kAxes[k];
        const double above = box.max.*kAxes[k] - p.*kAxes[k];
        if (std::min(below, above) < least) {
            least = std::min(below, above);
            axis = k;
            is_upper = above < below;
        }
    }
    return beyond_side(box, p, axis, is_upper);
}

}  // namespace

int winding_number(const Bvh& bvh, const Box& box, const Point& p) {
    int winding = 0;
    if (box.contains(p)) {
        for_each_crossing(bvh, p, beyond_nearest_side(box, p),
                          [&](Index, const SegmentCrossing& crossing) { winding += crossing.sign; });
    }
    return winding;
}

int winding_number_outside(const Bvh& bvh, const Box& box, Index t, const Point& p) {
    const auto& [u, v, w] = bvh.mesh.triangles[t];
    const Point& origin = bvh.mesh.vertices[u];
    const Point normal = cross(bvh.mesh.vertices[v] - origin, bvh.mesh.vertices[w] - origin);
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        axis = std::abs(normal.*kAxes[k]) > std::abs(normal.*kAxes[axis]) ? k : axis;
    }
    // The way out leads away from the triangle, so that this one, which passes through `p` but for rounding, is left
    // out on purpose and the side is certain.
    int winding = 0;
    for_each_crossing(bvh, p, beyond_side(box, p, axis, normal.*kAxes[axis] > 0.0),
                      [&](Index other, const SegmentCrossing& crossing) { winding += other != t ? crossing.sign : 0; });
    return winding;
}

}  // namespace scaleaxis
