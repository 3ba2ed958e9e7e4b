// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/parallel.hpp"
#include "solid/mesh/segment_crossing.hpp"
#include "solid/mesh/triangle_intersection.hpp"
#include "spatial/exact/predicates.hpp"

namespace scaleaxis::inline v1 {
namespace {

bool has_no_area(const Corners& t) { return first_sign_of_cross(t[0], t[1], t[0], t[2]) == 0; }

/// Two triangles relative to a corner of the first, for quick tests that may fail to see that the triangles are apart
/// but never err otherwise.
struct TrianglePair {
    Corners a, b;
    double size = 0.0;  ///< no coordinate difference is larger
};

TrianglePair pair_of(const Corners& a, const Corners& b, double size) {
    return {{Point(), a[1] - a[0], a[2] - a[0]}, {b[0] - a[0], b[1] - a[0], b[2] - a[0]}, size};
}

/// How much two projections to this axis can differ by rounding (12 ε for each), with some reserve.
double projection_error(const TrianglePair& pair, const Point& axis) {
    return 0x1p-48 * pair.size * std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)}) + 1e-290;
}

bool are_apart_along(const TrianglePair& pair, const Point& axis) {
    const double a0 = dot(axis, pair.a[0]), a1 = dot(axis, pair.a[1]), a2 = dot(axis, pair.a[2]);
    const double b0 = dot(axis, pair.b[0]), b1 = dot(axis, pair.b[1]), b2 = dot(axis, pair.b[2]);
    const double gap =
        std::max(std::min({b0, b1, b2}) - std::max({a0, a1, a2}), std::min({a0, a1, a2}) - std::max({b0, b1, b2}));
    return gap > projection_error(pair, axis);
}

/// A separating axis is most often the line between the centres, then a normal of a triangle or, in its plane, of one
/// of its sides.
bool are_apart(const TrianglePair& pair) {
    const auto& [a, b, size] = pair;
    if (are_apart_along(pair, (b[0] + b[1] + b[2]) - (a[0] + a[1] + a[2]))) {
        return true;
    }
    for (const Corners& t : {a, b}) {
        const Point normal = cross(t[1] - t[0], t[2] - t[0]);
        if (are_apart_along(pair, normal) || are_apart_along(pair, cross(normal, t[1] - t[0])) ||
            are_apart_along(pair, cross(normal, t[2] - t[1])) || are_apart_along(pair, cross(normal, t[0] - t[2]))) {
            return true;
        }
    }
    return false;
}

bool meet_without_common_corner(const Corners& a, const Corners& b, double size) {
    return !are_apart(pair_of(a, b, size)) && !has_no_area(a) && !has_no_area(b) && intersect(a, b);
}

/// Do the corners of `b` other than the first lie on one side of the plane of `a`?
bool is_beside_plane(const Corners& a, const Corners& b) {
    const int side = orientation(a[0], a[1], a[2], b[1]);
    return side != 0 && side == orientation(a[0], a[1], a[2], b[2]);
}

/// Triangles with the first corner in common: what else they share reaches the side opposite to it of one of them.
bool meet_beside_corner(const Corners& a, const Corners& b, double size) {
    const TrianglePair pair = pair_of(a, b, size);
    const Point axis = (pair.b[1] + pair.b[2]) - (pair.a[1] + pair.a[2]);
    const double error = projection_error(pair, axis);
    if (std::min(dot(axis, pair.b[1]), dot(axis, pair.b[2])) > error &&
        std::max(dot(axis, pair.a[1]), dot(axis, pair.a[2])) < -error) {
        return false;
    }
    return !is_beside_plane(a, b) && !is_beside_plane(b, a) && !has_no_area(a) && !has_no_area(b) &&
           (intersect(a, Ends{b[1], b[2]}) || intersect(b, Ends{a[1], a[2]}));
}

/// Triangles with the first two corners in common meet elsewhere if they are folded onto each other.
bool meet_beside_edge(const Corners& a, const Corners& b) {
    const int sign = first_sign_of_cross(a[0], a[1], a[0], a[2]);
    return sign != 0 && sign == first_sign_of_cross(a[0], a[1], a[0], b[2]) && orientation(a[0], a[1], a[2], b[2]) == 0;
}

bool meet(const TriangleMesh& mesh, Index i, Index j, double size) {
    std::array<Index, 3> a = mesh.triangles[i];
    std::array<Index, 3> b = mesh.triangles[j];
    int common = 0;  // the common corners are moved to the front
    for (int k = 0; k < 3; ++k) {
        const auto same = std::find(b.begin() + common, b.end(), a[k]);
        if (same != b.end()) {
            std::swap(b[common], *same);
            std::swap(a[common], a[k]);
            ++common;
        }
    }
    const auto corners = [&](const std::array<Index, 3>& t) -> Corners {
        return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    };
    switch (common) {
        case 0:
            return meet_without_common_corner(corners(a), corners(b), size);
        case 1:
            return meet_beside_corner(corners(a), corners(b), size);
        case 2:
            return meet_beside_edge(corners(a), corners(b));
        default:
            return !has_no_area(corners(a));
    }
}

double longest_side(const Box& a, const Box& b) {
    return std::max({std::max(a.max.x, b.max.x) - std::min(a.min.x, b.min.x),
                     std::max(a.max.y, b.max.y) - std::min(a.min.y, b.min.y),
                     std::max(a.max.z, b.max.z) - std::min(a.min.z, b.min.z)});
}

}  // namespace

SelfIntersections self_intersections(const Bvh& bvh) {
    SelfIntersections result;
    result.is_cut.resize(bvh.mesh.triangles.size());
    std::atomic<std::int64_t> pairs = 0;
    const auto test = [&](Index i, Index j, double size) {
        if (meet(bvh.mesh, i, j, size)) {
            pairs.fetch_add(1, std::memory_order_relaxed);
            std::atomic_ref(result.is_cut[i]).store(1, std::memory_order_relaxed);
            std::atomic_ref(result.is_cut[j]).store(1, std::memory_order_relaxed);
        }
    };
    const auto test_leaf = [&](const Bvh::Node& node, int child) {
        const Index begin = node.first[child];
        const Index end = begin + node.count[child];
        std::array<Box, Bvh::kLeafSize> boxes;
        Box leaf;
        for (Index i = begin; i < end; ++i) {
            boxes[i - begin] = box_of_triangle(bvh.mesh, i);
            leaf.extend(boxes[i - begin]);
        }
        for_each_leaf_near(bvh, node, child, [&](Index first, Index count) {
            // Of two leaves the earlier one tests their pairs.
            for (Index j = std::max(first, begin + 1); j < first + count && first >= begin; ++j) {
                const Box box = box_of_triangle(bvh.mesh, j);
                if (!overlap(leaf, box)) {
                    continue;
                }
                for (Index i = begin; i < std::min(end, j); ++i) {
                    if (overlap(boxes[i - begin], box)) {
                        test(i, j, longest_side(boxes[i - begin], box));
                    }
                }
            }
        });
    };
    for_each_index(
        bvh.nodes.size(),
        [&](std::size_t n) {
            for (int k = 0; k < Bvh::kWidth; ++k) {
                if (bvh.nodes[n].count[k] > 0) {
                    test_leaf(bvh.nodes[n], k);
                }
            }
        },
        std::size_t{256});
    result.pairs = pairs;
    return result;
}

std::int64_t count_self_intersections(const TriangleMesh& mesh, const Execution& execution) {
    return in_arena(execution, [&] { return self_intersections(build_bvh(mesh)).pairs; });
}

}  // namespace scaleaxis::inline v1
