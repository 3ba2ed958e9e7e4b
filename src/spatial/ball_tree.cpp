// SPDX-License-Identifier: Apache-2.0
#include "spatial/ball_tree.hpp"

#include <algorithm>
#include <limits>

#include "base/numbers.hpp"
#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Takes the radii out of the boxes: they are then around the centres.
void shrink_to_centers(BallTree& tree) {
    tree.radii.resize(tree.nodes.size());
    for (std::size_t n = tree.nodes.size(); n-- > 0;) {  // children before parents
        BoxTree::Node& node = tree.nodes[n];
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            const bool is_missing = node.bounds[0][0][k] > node.bounds[1][0][k];
            tree.radii[n][k] = 0.0F;
            if (is_missing) {
                continue;
            }
            if (node.count[k] == 0) {
                const std::size_t child = n + static_cast<std::size_t>(node.first[k]);
                for (int axis = 0; axis < 3; ++axis) {
                    node.bounds[0][axis][k] = least_of(tree.nodes[child].bounds[0][axis]);
                    node.bounds[1][axis][k] = largest_of(tree.nodes[child].bounds[1][axis]);
                }
                tree.radii[n][k] = largest_of(tree.radii[child]);
                continue;
            }
            std::array<float, 3> low{kFloatInfinity, kFloatInfinity, kFloatInfinity};
            std::array<float, 3> high{-kFloatInfinity, -kFloatInfinity, -kFloatInfinity};
            for (Index i = node.first[k]; i < node.first[k] + node.count[k]; ++i) {
                const FramedPoint center(tree, tree.balls[i].center);
                for (int axis = 0; axis < 3; ++axis) {
                    low[axis] = std::min(low[axis], center.at[axis]);
                    high[axis] = std::max(high[axis], center.at[axis]);
                }
                const auto radius = static_cast<float>(tree.balls[i].radius * tree.scale);
                tree.radii[n][k] = std::max(tree.radii[n][k], radius + BoxTree::kPadding);
            }
            for (int axis = 0; axis < 3; ++axis) {
                node.bounds[0][axis][k] = low[axis] - BoxTree::kPadding;
                node.bounds[1][axis][k] = high[axis] + BoxTree::kPadding;
            }
        }
    }
}

}  // namespace

BallTree build_ball_tree(std::span<const Ball> balls) {
    const auto boxes = mapped<Box>(balls.size(), [&](std::size_t i) {
        const auto& [center, radius] = balls[i];
        const Point r{radius, radius, radius};
        return Box{center - r, center + r};
    });
    BallTree tree{build_box_tree(boxes), {}, {}};
    tree.balls = mapped<Ball>(balls.size(), [&](std::size_t i) { return balls[tree.order[i]]; });
    shrink_to_centers(tree);
    return tree;
}

Index covering_ball(const BallTree& tree, const Point& p) {
    const FramedPoint framed(tree, p);
    const auto hit = [&](const BoxTree::Node& node) {
        const Float4 reach = tree.radii[&node - tree.nodes.data()] + framed.slack;
        return squared_distances(node, framed) <= reach * reach;
    };
    Index covering = kNone;
    box_tree_details::any_leaf(tree, hit, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            const auto& [center, radius] = tree.balls[i];
            if (squared_distance(center, p) <= radius * radius) {
                covering = tree.order[i];
                return true;
            }
        }
        return false;
    });
    return covering;
}

bool CoverTest::operator()(const Point& p) {
    const auto contains_it = [&](Index i) {
        return i != kNone && squared_distance(balls_[i].center, p) <= balls_[i].radius * balls_[i].radius;
    };
    if (std::any_of(last_.begin(), last_.end(), contains_it)) {
        return true;
    }
    const Index ball = covering_ball(tree_, p);
    if (ball != kNone) {
        last_[oldest_] = ball;
        oldest_ = (oldest_ + 1) % last_.size();
    }
    return ball != kNone;
}

namespace {

// The ball to which |p - centre| - radius is least, or |p - centre| alone.
template <bool has_radii>
NearestBall nearest_in(const BallTree& tree, const Point& p, double limit) {
    const FramedPoint framed(tree, p);
    const auto bound = [&](const BoxTree::Node& node) {
        const Float4 square = squared_distances(node, framed);
        const Float4 distance = {std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]),
                                 std::sqrt(square[3])};
        return has_radii ? distance - tree.radii[&node - tree.nodes.data()] - framed.slack : distance - framed.slack;
    };
    NearestBall nearest{kNone, limit};
    const auto in_frame = [&](double distance) {
        return static_cast<float>(distance * tree.scale) +
               BoxTree::kPadding * static_cast<float>(1.0 + std::abs(distance * tree.scale));
    };
    float best = in_frame(limit);
    for_each_better_leaf(tree, bound, best, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            const auto& [center, radius] = tree.balls[i];
            const double distance = norm(p - center) - (has_radii ? radius : 0.0);
            if (distance < nearest.distance ||
                (distance == nearest.distance && (nearest.ball == kNone || tree.order[i] < nearest.ball))) {
                nearest = {tree.order[i], distance};
            }
        }
        best = in_frame(nearest.distance);
    });
    return nearest;
}

}  // namespace

NearestBall nearest_ball(const BallTree& tree, const Point& p, double limit) {
    return nearest_in<true>(tree, p, limit);
}

double nearest_center_distance(const BallTree& tree, const Point& p) {
    return nearest_in<false>(tree, p, std::numeric_limits<double>::infinity()).distance;
}

}  // namespace scaleaxis::inline v1
