// SPDX-License-Identifier: Apache-2.0
#include "balls/covering_balls.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

bool is_empty(const BoxTree::Node& node, int child) { return node.bounds[0][0][child] > node.bounds[1][0][child]; }

void empty(BoxTree::Node& node, int child) {
    node.count[child] = 0;
    for (int axis = 0; axis < 3; ++axis) {
        node.bounds[0][axis][child] = kFar;
        node.bounds[1][axis][child] = -kFar;
    }
}

/// Takes the points in a ball out of a part of a tree, so that no other ball meets them again: many nearly equal balls
/// would each visit all that they cover. \returns whether there were any
bool take_out(PointTree& tree, BoxTree::Node& node, const Ball& ball, const FramedPoint& center, Float4 squared_reach) {
    const Mask4 is_hit = squared_distances(node, center) <= squared_reach;
    const double squared_radius = ball.radius * ball.radius;
    bool any = false;
    for (int k = 0; k < BoxTree::kWidth; ++k) {
        if (is_hit[k] == 0) {
            continue;
        }
        if (node.count[k] == 0) {
            BoxTree::Node& child = *(&node + node.first[k]);
            if (take_out(tree, child, ball, center, squared_reach)) {
                any = true;
                if (is_empty(child, 0) && is_empty(child, 1) && is_empty(child, 2) && is_empty(child, 3)) {
                    empty(node, k);
                }
            }
            continue;
        }
        const auto points = std::span(tree.points).subspan(node.first[k], node.count[k]);
        const auto left = std::partition(points.begin(), points.end(), [&](const Point& p) {
            return squared_distance(p, ball.center) > squared_radius;
        });
        if (left != points.end()) {
            any = true;
            node.count[k] = static_cast<Index>(left - points.begin());
            if (node.count[k] == 0) {
                empty(node, k);
            }
        }
    }
    return any;
}

}  // namespace

std::vector<Index> covering_balls(std::span<const Ball> balls, std::span<const Point> points, double reach) {
    const auto by_size = sorted_indices(
        balls.size(), [&](Index i) { return balls[i].radius; }, std::greater<>());
    PointTree left = build_point_tree(points);
    std::vector<Index> chosen;
    CancellationPoint cancellation_point(64);
    for (const Index i : by_size) {
        cancellation_point();
        const Ball wide{balls[i].center, balls[i].radius + reach};
        const FramedPoint center(left, wide.center);
        if (take_out(left, left.nodes.front(), wide, center, squared_reach(left, wide.radius, center))) {
            chosen.push_back(i);
        }
    }
    std::ranges::sort(chosen);
    return chosen;
}

FittedBalls selected(const FittedBalls& fitted, std::span<const Index> positions) {
    return {each_of<Ball>(positions, [&](Index i) { return fitted.balls[i]; }),
            each_of<Contacts>(positions, [&](Index i) { return fitted.contacts[i]; }),
            each_of<Index>(positions, [&](Index i) { return fitted.given[i]; }), fitted.statistics};
}

}  // namespace scaleaxis::inline v1
