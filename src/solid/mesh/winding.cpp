// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/winding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::array<double Point::*, 3> kAxes{&Point::x, &Point::y, &Point::z};

/// A point beyond one of the six sides of the box; see `beyond_nearest_side`.
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

/// A point beyond the box on the side of triangle `t` that its normal points to, as seen from its point `p`.
Point beyond_outer_side(const Bvh& bvh, const Box& box, Index t, const Point& p) {
    const auto& [u, v, w] = bvh.mesh.triangles[t];
    const Point& origin = bvh.mesh.vertices[u];
    const Point normal = cross(bvh.mesh.vertices[v] - origin, bvh.mesh.vertices[w] - origin);
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        axis = std::abs(normal.*kAxes[k]) > std::abs(normal.*kAxes[axis]) ? k : axis;
    }
    return beyond_side(box, p, axis, normal.*kAxes[axis] > 0.0);
}

/// A point, and how often the surface winds around it.
struct KnownWinding {
    Point place{kInfinity, kInfinity, kInfinity};
    int winding = 0;
};

/// How often the surface winds around `p`, by the way to a point where that is known, or by that out of the box,
/// whichever is shorter. The answer is the same: crossings are exact, and of moved segments.
int winding_from(const Bvh& bvh, const Box& box, const Point& p, const KnownWinding& known) {
    if (!box.contains(p)) {
        return 0;
    }
    const Point beyond = beyond_nearest_side(box, p);
    const bool is_near = squared_distance(p, known.place) < squared_distance(p, beyond);
    int winding = is_near ? known.winding : 0;
    for_each_crossing(bvh, p, is_near ? known.place : beyond,
                      [&](Index, const SegmentCrossing& crossing) { winding += crossing.sign; });
    return winding;
}

// Testing more triangles one by one takes as long as looking for those near a segment in the tree.
constexpr std::size_t kFewTriangles = 12;

/// The triangles whose boxes meet a box, if they are few.
std::optional<std::vector<Index>> few_triangles_near(const Bvh& bvh, const Box& box) {
    std::vector<Index> near;
    const bool is_few = !any_near_box(bvh, box, [&](Index t) {
        if (overlap(box_of_triangle(bvh.mesh, t), box)) {
            near.push_back(t);
        }
        return near.size() > kFewTriangles;
    });
    return is_few ? std::optional(std::move(near)) : std::nullopt;
}

}  // namespace

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

void winding_numbers(const Bvh& bvh, const Box& box, std::span<const Point> points, std::span<int> windings) {
    // Points that follow each other are mostly near each other: crossings on the short way to the last one tell as
    // exactly as those on the way out. Where all of them are so near that a handful of triangles comes between them, as
    // for directions around one point, these are found once.
    KnownWinding last;
    std::optional<std::vector<Index>> near;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& p = points[i];
        if (i == 1) {
            near = few_triangles_near(bvh, box_around(points));
        }
        if (near) {
            const SegmentProbe probe(p, last.place);
            for (const Index t : *near) {
                last.winding += crossing_with(bvh, probe, t).sign;
            }
        } else {
            last.winding = winding_from(bvh, box, p, last);
        }
        last.place = p;
        windings[i] = last.winding;
    }
}

int winding_number_outside(const Bvh& bvh, const Box& box, Index t, const Point& p) {
    // The segment leads away from the triangle, which it passes through at `p` up to rounding: leaving the triangle
    // out makes the side certain.
    int winding = 0;
    for_each_crossing(bvh, p, beyond_outer_side(bvh, box, t, p),
                      [&](Index other, const SegmentCrossing& crossing) { winding += other != t ? crossing.sign : 0; });
    return winding;
}

bool is_boundary_at(const Bvh& bvh, const Box& box, Index t, const Point& p, double gap) {
    const Point end = beyond_outer_side(bvh, box, t, p);
    // The way out is askew to the triangle by up to 60 degrees.
    const double across = std::max(kSamePlaceOnWayOut, 2.0 * gap / distance(p, end));
    const Point start = p - across * (end - p);
    int outside = 0;
    int inside = 1;  // in addition to `outside`; `t` itself counts whatever rounding does
    for_each_crossing(bvh, start, end, [&](Index other, const SegmentCrossing& crossing) {
        if (other != t) {
            (crossing.position > 2.0 * std::max(kSamePlace, across) ? outside : inside) += crossing.sign;
        }
    });
    return (outside == 0) != (outside + inside == 0);
}

}  // namespace scaleaxis::inline v1
