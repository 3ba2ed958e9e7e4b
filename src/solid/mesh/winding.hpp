// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Winding numbers of a closed surface, by exact crossings.
#pragma once

#include <vector>

#include "scaleaxis/geometry.hpp"
#include "shapes/bvh.hpp"
#include "shapes/segment_crossing.hpp"

namespace scaleaxis {

/// Calls `visit(t, crossing)` for all triangles that the segment `ab` crosses, in no particular order.
template <class Visit>
void for_each_crossing(const Bvh& bvh, const Point& a, const Point& b, const Visit& visit) {
    const SegmentProbe probe(a, b);
    kernel::for_each_near_segment(bvh, a, b, [&](Index t) {
        const auto& [u, v, w] = bvh.mesh.triangles[t];
        const std::vector<Point>& p = bvh.mesh.vertices;
        if (const SegmentCrossing crossing = probe.crossing(p[u], p[v], p[w]); crossing.sign != 0) {
            visit(t, crossing);
        }
    });
}

/// How often the surface winds around `p`.
/// \param box of the surface
int winding_number(const Bvh& bvh, const Box& box, const Point& p);

/// How often the surface winds around a point just outside triangle `t`, where its normal points to, at its point `p`.
/// Just inside it is one more.
int winding_number_outside(const Bvh& bvh, const Box& box, Index t, const Point& p);

/// Is the solid, all points of non-zero winding number, on just one side of a triangle?
inline bool is_boundary(int winding_outside) { return (winding_outside == 0) != (winding_outside + 1 == 0); }

}  // namespace scaleaxis
