// SPDX-License-Identifier: Apache-2.0
/// \file
/// Winding numbers of a closed surface, by exact crossings.
#pragma once

#include <span>
#include <vector>

#include "base/numbers.hpp"
#include "scaleaxis/geometry.hpp"
#include "solid/mesh/segment_crossing.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// Places of a segment that are closer than this part of its length are one place where it passes through several
/// sheets, as where parts of a solid touch.
inline constexpr double kSamePlace = 1e-9;

/// The same for segments that lead out of the bounds: those between samples are shorter by a factor of about 100.
inline constexpr double kSamePlaceOnWayOut = 1e-11;

/// Where a segment crosses triangle `t`.
inline SegmentCrossing crossing_with(const Bvh& bvh, const SegmentProbe& probe, Index t) {
    const auto& [u, v, w] = bvh.mesh.triangles[t];
    const std::vector<Point>& p = bvh.mesh.vertices;
    return probe.crossing(p[u], p[v], p[w]);
}

/// Calls `visit(t, crossing)` for all triangles that the segment `ab` crosses, in no particular order.
template <class Visit>
void for_each_crossing(const Bvh& bvh, const Point& a, const Point& b, const Visit& visit) {
    const SegmentProbe probe(a, b);
    for_each_near_segment(bvh, a, b, [&](Index t) {
        if (const SegmentCrossing crossing = crossing_with(bvh, probe, t); crossing.sign != 0) {
            visit(t, crossing);
        }
    });
}

/// A point outside the box, beyond the side that is nearest to `p`, a little askew from it: so that the segment to it
/// does not run along the edges and faces of a mesh that is aligned with the axes.
Point beyond_nearest_side(const Box& box, const Point& p);

/// How often those triangles that `is_counted(t)` takes wind around `p`; together they are closed.
/// \param box of the surface
template <class Predicate>
int winding_number(const Bvh& bvh, const Box& box, const Point& p, const Predicate& is_counted) {
    int winding = 0;
    if (box.contains(p)) {
        for_each_crossing(bvh, p, beyond_nearest_side(box, p), [&](Index t, const SegmentCrossing& crossing) {
            winding += is_counted(t) ? crossing.sign : 0;
        });
    }
    return winding;
}

/// How often the surface winds around `p`.
inline int winding_number(const Bvh& bvh, const Box& box, const Point& p) {
    return winding_number(bvh, box, p, [](Index) { return true; });
}

/// The same for several points, faster where those that follow each other are near each other.
void winding_numbers(const Bvh& bvh, const Box& box, std::span<const Point> points, std::span<int> windings);

/// The winding number just outside triangle `t`, where its normal points to, at its point `p`. Just inside it is one
/// more. \pre no other triangle passes through `p`
int winding_number_outside(const Bvh& bvh, const Box& box, Index t, const Point& p);

/// Is the solid, all points of non-zero winding number, on just one side of a triangle?
inline bool is_boundary(int winding_outside) { return (winding_outside == 0) != (winding_outside + 1 == 0); }

/// Is the solid on just one side of the surface at point `p` of triangle `t`? All sheets that pass through `p` count as
/// one, and so do those no farther away than `gap`: the two walls of parts that touch bound nothing.
bool is_boundary_at(const Bvh& bvh, const Box& box, Index t, const Point& p, double gap);

}  // namespace scaleaxis::inline v1
