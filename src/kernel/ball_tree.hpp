// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A bounding-volume hierarchy over balls.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "kernel/box_tree.hpp"
#include "scaleaxis/field.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::kernel {

/// The boxes of the tree are around the centres of the balls alone, and no ball reaches farther beyond them than the
/// radius given: tight even for thousands of balls with almost the same centre, as along a medial axis.
struct BallTree : BoxTree {
    std::vector<Float4> radii;           ///< largest radius in each child of each node, in the frame
    std::vector<Float4> smallest_radii;  ///< the smallest
    std::vector<Ball> balls;             ///< in the order of the leaves
};

/// \param balls at least one; finite
BallTree build_ball_tree(std::span<const Ball> balls);

/// A ball that contains `p`, as numbered when the tree was built; `kNone` if there is none besides `except`.
Index covering_ball(const BallTree& tree, const Point& p, std::span<const Index> except = {});

/// The ball, as numbered when the tree was built, to which the signed distance |p - centre| - radius is least. Of
/// several it is the first. None if all are farther than `limit`.
NearestBall nearest_ball(const BallTree& tree, const Point& p, double limit = std::numeric_limits<double>::infinity());

/// Visits leaves whose balls may have a sphere at a distance from `p` of less than `best` (in the frame), near ones
/// first.
template <class Visit>
void for_each_near_sphere(const BallTree& tree, const FramedPoint& p, const float& best, const Visit& visit) {
    const auto bound = [&](const BoxTree::Node& node) {
        Float4 farthest = {0.0F, 0.0F, 0.0F, 0.0F};  // squared distance of a centre
        for (int axis = 0; axis < 3; ++axis) {
            const Float4 beyond = greater(node.bounds[1][axis] - p.at[axis], p.at[axis] - node.bounds[0][axis]);
            farthest += beyond * beyond;
        }
        const Float4 nearest = squared_distances(node, p);
        const auto n = &node - tree.nodes.data();
        Float4 result;
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            const float outside = std::sqrt(nearest[k]) - tree.radii[n][k];
            const float inside = tree.smallest_radii[n][k] - std::sqrt(farthest[k]);
            result[k] = std::max(outside, inside) - 2.0F * p.slack;
        }
        return result;
    };
    for_each_better_leaf(tree, bound, best, visit);
}

}  // namespace scaleaxis::kernel
