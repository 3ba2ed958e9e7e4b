// SPDX-License-Identifier: Apache-2.0
/// \file
/// A bounding-volume hierarchy over boxes, for points, segments and boxes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/compiler.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Boxes are floats in the frame of the tree, in which all boxes together fill [-1, 1] along their longest side. They
/// are larger than those given by `kPadding`, more than all rounding of the queries adds up to: a query may visit an
/// item in vain but never misses one.
struct BoxTree {
    static constexpr int kWidth = 4;
    static constexpr int kLeafSize = 8;
    static constexpr float kPadding = 0x1p-20F;

    /// Up to four children; one that is missing has an empty box.
    struct alignas(64) Node {
        // The lower [0] and upper [1] ends of the children's boxes, axis by axis.
        std::array<std::array<Float4, 3>, 2> bounds;
        // Leaf: its first item. Otherwise how many nodes further on the child is.
        std::array<Index, kWidth> first;
        // Leaf: how many items it has. Otherwise 0.
        std::array<Index, kWidth> count;
    };

    std::vector<Node> nodes;   ///< parents before children
    std::vector<Index> order;  ///< the boxes given, in the order of the leaves: `order[i]` is item `i`
    Point origin;              ///< of the frame
    double scale = 1.0;        ///< of the frame: 1 / half the longest side

    Point in_frame(const Point& p) const { return scale * (p - origin); }
};

/// Writes a point into one lane of its coordinates.
template <class Lane>
void set_lane(std::array<Float4, 3>& coordinates, Lane lane, const Point& p) {
    coordinates[0][lane] = static_cast<float>(p.x);
    coordinates[1][lane] = static_cast<float>(p.y);
    coordinates[2][lane] = static_cast<float>(p.z);
}

inline float largest_of(Float4 values) { return std::max({values[0], values[1], values[2], values[3]}); }
inline float least_of(Float4 values) { return std::min({values[0], values[1], values[2], values[3]}); }

/// \param boxes at least one; finite
BoxTree build_box_tree(std::span<const Box> boxes);

namespace box_tree_details {

// No path from the root is longer than twice this: see where it is built.
constexpr int kMaxDepth = 32;
constexpr int kStackSize = 2 * kMaxDepth * (BoxTree::kWidth - 1) + 1;

/// The part of a segment that lies in the frame's cube.
struct ClippedSegment {
    std::array<float, 3> start;
    std::array<float, 3> inverse_direction;
    std::array<int, 3> is_negative;
};
std::optional<ClippedSegment> clipped(const BoxTree& tree, const Point& a, const Point& b);

/// Is `test(first, count)` true of one of the leaves whose boxes pass `hit(node)`, an array of one flag for each child?
template <class Hit, class Test>
bool any_leaf(const BoxTree& tree, const Hit& hit, const Test& test) {
    std::array<const BoxTree::Node*, kStackSize> stack;
    std::size_t size = 0;
    stack[size++] = tree.nodes.data();
    while (size > 0) {
        const BoxTree::Node& node = *stack[--size];
        const Mask4 is_hit = hit(node);
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            if (is_hit[k] == 0) {
                continue;
            }
            if (node.count[k] == 0) {
                stack[size++] = &node + node.first[k];
            } else if (test(node.first[k], node.count[k])) {
                return true;
            }
        }
    }
    return false;
}

/// Calls `visit(first, count)` for these leaves.
template <class Hit, class Visit>
void for_each_leaf(const BoxTree& tree, const Hit& hit, const Visit& visit) {
    any_leaf(tree, hit, [&](Index first, Index count) {
        visit(first, count);
        return false;
    });
}

}  // namespace box_tree_details

/// Calls `visit(i)` for all items `i` whose boxes the segment `ab` may meet.
template <class Visit>
void for_each_near_segment(const BoxTree& tree, const Point& a, const Point& b, const Visit& visit) {
    const auto segment = box_tree_details::clipped(tree, a, b);
    if (!segment) {
        return;
    }
    const auto hit = [s = *segment](const BoxTree::Node& node) {
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
    box_tree_details::for_each_leaf(tree, hit, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            visit(i);
        }
    });
}

/// Is `test(i)` true of one of the items `i` whose boxes may meet `box`?
template <class Test>
bool any_near_box(const BoxTree& tree, const Box& box, const Test& test) {
    const Point low = tree.in_frame(box.min), high = tree.in_frame(box.max);
    const std::array<float, 3> min{static_cast<float>(low.x), static_cast<float>(low.y), static_cast<float>(low.z)};
    const std::array<float, 3> max{static_cast<float>(high.x), static_cast<float>(high.y), static_cast<float>(high.z)};
    const auto hit = [&](const BoxTree::Node& node) {
        Mask4 is_hit = {-1, -1, -1, -1};
        for (int axis = 0; axis < 3; ++axis) {
            is_hit &= (node.bounds[0][axis] <= max[axis]) & (node.bounds[1][axis] >= min[axis]);
        }
        return is_hit;
    };
    return box_tree_details::any_leaf(tree, hit, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            if (test(i)) {
                return true;
            }
        }
        return false;
    });
}

/// Calls `visit(i)` for all of them.
template <class Visit>
void for_each_near_box(const BoxTree& tree, const Box& box, const Visit& visit) {
    any_near_box(tree, box, [&](Index i) {
        visit(i);
        return false;
    });
}

/// Calls `visit(first, count)` for the leaves whose boxes overlap with that of child `child` of `node`.
template <class Visit>
void for_each_leaf_near(const BoxTree& tree, const BoxTree::Node& node, int child, const Visit& visit) {
    std::array<float, 3> min;
    std::array<float, 3> max;
    for (int axis = 0; axis < 3; ++axis) {
        min[axis] = node.bounds[0][axis][child];
        max[axis] = node.bounds[1][axis][child];
    }
    const auto hit = [&](const BoxTree::Node& other) {
        Mask4 is_hit = {-1, -1, -1, -1};
        for (int axis = 0; axis < 3; ++axis) {
            is_hit &= (other.bounds[0][axis] <= max[axis]) & (other.bounds[1][axis] >= min[axis]);
        }
        return is_hit;
    };
    box_tree_details::for_each_leaf(tree, hit, visit);
}

/// A point as the boxes are compared with it.
struct FramedPoint {
    std::array<float, 3> at;
    /// Boxes are padded for rounding in the frame, but not for that of a point far away: no distance to one is wrong by
    /// more than this.
    float slack;

    FramedPoint(const BoxTree& tree, const Point& p) {
        // The nearest point of a cube around the frame stands for one so far away that its square overflows: it is
        // farther from no item.
        constexpr double kFar = 0x1p50;
        const Point q = tree.in_frame(p);
        at = {static_cast<float>(std::clamp(q.x, -kFar, kFar)), static_cast<float>(std::clamp(q.y, -kFar, kFar)),
              static_cast<float>(std::clamp(q.z, -kFar, kFar))};
        slack = BoxTree::kPadding * (std::abs(at[0]) + std::abs(at[1]) + std::abs(at[2]));
    }
};

/// The squared distances of a point to the boxes of the children, in the frame; infinite for a missing child.
inline Float4 squared_distances(const BoxTree::Node& node, const FramedPoint& p) {
    Float4 square = {0.0F, 0.0F, 0.0F, 0.0F};
    for (int axis = 0; axis < 3; ++axis) {
        const Float4 beyond = greater(node.bounds[0][axis] - p.at[axis], p.at[axis] - node.bounds[1][axis]);
        const Float4 outside = greater(beyond, Float4{});
        square += outside * outside;
    }
    return square;
}

/// Visits leaves by `visit(first, count)`, near ones first, and leaves out those that cannot hold the best item.
/// \param bound lower bounds of what is looked for in each child of a node; infinite for a missing child
/// \param best what was found; `visit` decreases it
template <class Bound, class Visit>
void for_each_better_leaf(const BoxTree& tree, const Bound& bound, const float& best, const Visit& visit) {
    struct Entry {
        const BoxTree::Node* node;
        float bound;
    };
    std::array<Entry, box_tree_details::kStackSize> stack;
    std::size_t size = 0;
    stack[size++] = {tree.nodes.data(), -std::numeric_limits<float>::infinity()};
    while (size > 0) {
        const Entry entry = stack[--size];
        if (entry.bound >= best) {
            continue;
        }
        const BoxTree::Node& node = *entry.node;
        const Float4 bounds = bound(node);
        // The children that are near enough, in order: mostly one or two.
        std::array<int, BoxTree::kWidth> children{};
        int count = 0;
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            if (bounds[k] < best) {
                int at = count++;
                for (; at > 0 && bounds[children[at - 1]] > bounds[k]; --at) {
                    children[at] = children[at - 1];
                }
                children[at] = k;
            }
        }
        for (int i = 0; i < count; ++i) {
            const int k = children[i];
            if (node.count[k] > 0 && bounds[k] < best) {
                visit(node.first[k], node.count[k]);
            }
        }
        // The nearest child comes last on the stack, and so first off it.
        for (int i = count - 1; i >= 0; --i) {
            const int k = children[i];
            if (node.count[k] == 0 && bounds[k] < best) {
                stack[size++] = {&node + node.first[k], bounds[k]};
            }
        }
    }
}

}  // namespace scaleaxis::inline v1
