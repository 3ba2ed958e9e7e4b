// SPDX-License-Identifier: Apache-2.0
#include "spatial/point_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// A squared distance in the frame, not smaller than rounding makes it.
float in_frame(const PointTree& tree, double squared_distance) {
    return static_cast<float>(squared_distance * tree.scale * tree.scale) * (1.0F + 4.0F * BoxTree::kPadding) +
           std::numeric_limits<float>::min();
}

Float4 lower_bounds(const BoxTree::Node& node, const FramedPoint& p) {
    const Float4 square = squared_distances(node, p);
    // Boxes are padded: only what a far point adds to the rounding is left.
    const Float4 distance =
        Float4{std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]), std::sqrt(square[3])} - p.slack;
    return greater(distance, Float4{}) * greater(distance, Float4{});
}

}  // namespace

PointTree build_point_tree(std::span<const Point> points) {
    const auto boxes = mapped<Box>(points.size(), [&](std::size_t i) { return Box{points[i], points[i]}; });
    PointTree tree{build_box_tree(boxes), {}};
    tree.points = mapped<Point>(points.size(), [&](std::size_t i) { return points[tree.order[i]]; });
    return tree;
}

NearPoint nearest_point(const PointTree& tree, const Point& p) {
    return near_point(tree, p, std::numeric_limits<double>::infinity(), 1.0);
}

NearPoint near_point(const PointTree& tree, const Point& p, double exact_within, double factor) {
    const double far = (factor * exact_within) * (factor * exact_within);
    const FramedPoint framed(tree, p);
    NearPoint nearest;
    float best = std::numeric_limits<float>::infinity();
    const auto bound = [&](const BoxTree::Node& node) { return lower_bounds(node, framed); };
    for_each_better_leaf(tree, bound, best, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            const double squared = squared_distance(tree.points[i], p);
            if (squared < nearest.squared_distance ||
                (squared == nearest.squared_distance && tree.order[i] < tree.order[nearest.position])) {
                nearest = {i, squared};
            }
        }
        best = in_frame(tree, nearest.squared_distance > far ? nearest.squared_distance / (factor * factor)
                                                             : nearest.squared_distance);
    });
    return nearest;
}

void nearest_points(const PointTree& tree, const Point& p, std::size_t count, std::vector<NearPoint>& result) {
    result.clear();
    const auto is_nearer = [&](const NearPoint& a, const NearPoint& b) {
        return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                        : tree.order[a.position] < tree.order[b.position];
    };
    const FramedPoint framed(tree, p);
    float best = std::numeric_limits<float>::infinity();
    const auto bound = [&](const BoxTree::Node& node) { return lower_bounds(node, framed); };
    for_each_better_leaf(tree, bound, best, [&](Index first, Index size) {
        for (Index i = first; i < first + size; ++i) {
            const NearPoint candidate{i, squared_distance(tree.points[i], p)};
            if (result.size() == count && is_nearer(candidate, result.front())) {
                std::ranges::pop_heap(result, is_nearer);
                result.back() = candidate;
                std::ranges::push_heap(result, is_nearer);
            } else if (result.size() < count) {
                result.push_back(candidate);
                std::ranges::push_heap(result, is_nearer);
            }
        }
        if (result.size() == count) {
            best = in_frame(tree, result.front().squared_distance);
        }
    });
    std::ranges::sort_heap(result, is_nearer);
}

}  // namespace scaleaxis::inline v1
