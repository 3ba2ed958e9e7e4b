// SPDX-License-Identifier: Apache-2.0
/// \file
/// A bounding-volume hierarchy over points.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "spatial/box_tree.hpp"

namespace scaleaxis::inline v1 {

/// Queries name a point by its position among the leaves; `order[position]` is its index as given.
struct PointTree : BoxTree {
    std::vector<Point> points;  ///< in the order of the leaves
};

/// \param points at least one; finite
PointTree build_point_tree(std::span<const Point> points);

struct NearPoint {
    Index position = kNone;
    double squared_distance = std::numeric_limits<double>::infinity();
};

/// The point nearest to `p`; of several the first one as given.
NearPoint nearest_point(const PointTree& tree, const Point& p);

/// The nearest point, if it is not farther than `exact_within`; if it is, a point at most `factor` times as far. Places
/// with many points at about their distance take much longer otherwise.
NearPoint near_point(const PointTree& tree, const Point& p, double exact_within, double factor);

/// The `count` points nearest to `p` (fewer if there are fewer), nearest ones first; at equal distances the first ones
/// as given. `result` is for memory that several calls use.
void nearest_points(const PointTree& tree, const Point& p, std::size_t count, std::vector<NearPoint>& result);

/// What the squared distances of a point to boxes are compared with, so that none within `radius` is missed.
inline Float4 squared_reach(const PointTree& tree, double radius, const FramedPoint& p) {
    const float reach = static_cast<float>(radius * tree.scale) * (1.0F + BoxTree::kPadding) + p.slack;
    return Float4{} + reach * reach;
}

/// Calls `visit(position, squared distance)` for all points at most `radius` away from `p`.
template <class Visit>
void for_each_point_near(const PointTree& tree, const Point& p, double radius, const Visit& visit) {
    const FramedPoint framed(tree, p);
    const Float4 limit = squared_reach(tree, radius, framed);
    const auto hit = [&](const BoxTree::Node& node) { return squared_distances(node, framed) <= limit; };
    const double squared_radius = radius * radius;
    box_tree_details::for_each_leaf(tree, hit, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            const double squared = squared_distance(tree.points[i], p);
            if (squared <= squared_radius) {
                visit(i, squared);
            }
        }
    });
}

}  // namespace scaleaxis::inline v1
