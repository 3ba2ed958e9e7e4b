// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A bounding-volume hierarchy over the triangles of a mesh, for segments and for boxes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// Four numbers that are computed with at once.
using Float4 = float __attribute__((vector_size(16)));
using Mask4 =
    std::int32_t __attribute__((vector_size(16)));  ///< of what compares two of them: -1 for true, 0 for false
constexpr Float4 lesser(Float4 a, Float4 b) { return a < b ? a : b; }
constexpr Float4 greater(Float4 a, Float4 b) { return a > b ? a : b; }

/// Boxes are floats in the frame of the tree, in which the mesh fills [-1, 1] along its longest side. They are larger
/// than the triangles by `kPadding`, more than all rounding of the queries adds up to: a query may visit a triangle in
/// vain but never misses one.
struct Bvh {
    static constexpr int kWidth = 4;
    static constexpr int kLeafSize = 8;
    static constexpr float kPadding = 0x1p-20F;

    /// Up to four children; one that is missing has an empty box.
    struct alignas(64) Node {
        // The lower [0] and upper [1] ends of the children's boxes, axis by axis.
        std::array<std::array<Float4, 3>, 2> bounds;
        // Leaf: its first triangle. Otherwise how many nodes further on the child is.
        std::array<Index, kWidth> first;
        // Leaf: how many triangles it has. Otherwise 0.
        std::array<Index, kWidth> count;
    };

    TriangleMesh mesh;        ///< triangles in the order of the leaves, vertices in the order of their first use
    std::vector<Node> nodes;  ///< parents before children
    Point origin;             ///< of the frame
    double scale = 1.0;       ///< of the frame: 1 / half the longest side

    Point in_frame(const Point& p) const { return scale * (p - origin); }
};

/// \param mesh at least one triangle; finite coordinates
Bvh build_bvh(TriangleMesh mesh);

namespace bvh_details {

// No path from the root is longer than twice this: see where it is built.
constexpr int kMaxDepth = 32;
constexpr int kStackSize = 2 * kMaxDepth * (Bvh::kWidth - 1) + 1;

/// The part of a segment that lies in the frame's cube.
struct ClippedSegment {
    std::array<float, 3> start;
    std::array<float, 3> inverse_direction;
    std::array<int, 3> is_negative;
};
std::optional<ClippedSegment> clipped(const Bvh& bvh, const Point& a, const Point& b);

/// Visits the leaves whose boxes pass `hit(node)`, an array of one flag for each child.
template <class Hit, class Visit>
void for_each_leaf(const Bvh& bvh, const Hit& hit, const Visit& visit) {
    std::array<const Bvh::Node*, kStackSize> stack;
    std::size_t size = 0;
    stack[size++] = bvh.nodes.data();
    while (size > 0) {
        const Bvh::Node& node = *stack[--size];
        const Mask4 is_hit = hit(node);
        for (int k = 0; k < Bvh::kWidth; ++k) {
            if (is_hit[k] == 0) {
                continue;
            }
            if (node.count[k] > 0) {
                visit(node.first[k], node.count[k]);
            } else {
                stack[size++] = &node + node.first[k];
            }
        }
    }
}

}  // namespace bvh_details

/// Calls `visit(t)` for all triangles `t` of `bvh.mesh` that the segment `ab` may meet.
template <class Visit>
void for_each_near_segment(const Bvh& bvh, const Point& a, const Point& b, const Visit& visit) {
    const auto segment = bvh_details::clipped(bvh, a, b);
    if (!segment) {
        return;
    }
    const auto hit = [s = *segment](const Bvh::Node& node) {
        Float4 enter = {0.0F, 0.0F, 0.0F, 0.0F};
        Float4 leave = {1.0F, 1.0F, 1.0F, 1.0F};
        for (int axis = 0; axis < 3; ++axis) {
            const Float4 near = node.bounds[s.is_negative[axis]][axis];
            const Float4 far = node.bounds[1 - s.is_negative[axis]][axis];
            enter = greater(enter, (near - s.start[axis]) * s.inverse_direction[axis]);
            leave = lesser(leave, (far - s.start[axis]) * s.inverse_direction[axis]);
        }
        return enter <= leave;
    };
    bvh_details::for_each_leaf(bvh, hit, [&](Index first, Index count) {
        for (Index t = first; t < first + count; ++t) {
            visit(t);
        }
    });
}

/// Calls `visit(first, count)` for the leaves whose boxes overlap with that of child `child` of `node`.
template <class Visit>
void for_each_leaf_near(const Bvh& bvh, const Bvh::Node& node, int child, const Visit& visit) {
    std::array<float, 3> min;
    std::array<float, 3> max;
    for (int axis = 0; axis < 3; ++axis) {
        min[axis] = node.bounds[0][axis][child];
        max[axis] = node.bounds[1][axis][child];
    }
    const auto hit = [&](const Bvh::Node& other) {
        Mask4 is_hit = {-1, -1, -1, -1};
        for (int axis = 0; axis < 3; ++axis) {
            is_hit &= (other.bounds[0][axis] <= max[axis]) & (other.bounds[1][axis] >= min[axis]);
        }
        return is_hit;
    };
    bvh_details::for_each_leaf(bvh, hit, visit);
}

}  // namespace scaleaxis
