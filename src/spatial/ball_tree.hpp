// SPDX-License-Identifier: Apache-2.0
/// \file
/// A bounding-volume hierarchy over balls.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/box_tree.hpp"

namespace scaleaxis::inline v1 {

/// The boxes of the tree are around the centres of the balls alone, and no ball reaches farther beyond them than the
/// radius given: tight even for thousands of balls with almost the same centre, as along a medial axis.
struct BallTree : BoxTree {
    std::vector<Float4> radii;  ///< largest radius in each child of each node, in the frame
    std::vector<Ball> balls;    ///< in the order of the leaves
};

/// \param balls at least one; finite
BallTree build_ball_tree(std::span<const Ball> balls);

/// A ball that contains `p`, as numbered when the tree was built; `kNone` if there is none.
Index covering_ball(const BallTree& tree, const Point& p);

/// Tells of points one after the other whether a ball contains them. Where they come in an order with locality, one of
/// the balls that contain the last ones mostly contains the next one, too, and the tree is not asked.
class CoverTest {
   public:
    /// \param balls that the tree was built of
    CoverTest(const BallTree& tree, std::span<const Ball> balls) : tree_(tree), balls_(balls) {}

    bool operator()(const Point& p);

   private:
    const BallTree& tree_;
    std::span<const Ball> balls_;
    std::array<Index, 4> last_{kNone, kNone, kNone, kNone};
    std::size_t oldest_ = 0;
};

/// The ball, as numbered when the tree was built, to which the signed distance |p - centre| - radius is least. Of
/// several it is the first. None if all are farther than `limit`.
NearestBall nearest_ball(const BallTree& tree, const Point& p, double limit = std::numeric_limits<double>::infinity());

/// How far the nearest centre of a ball is.
double nearest_center_distance(const BallTree& tree, const Point& p);

/// Those of some points that are farther than `distance` from all balls, in their order, which should have locality.
/// \param place_of tells where a point is
template <class T, class PlaceOf>
std::vector<T> far_from_balls(std::span<const T> points, std::span<const Ball> balls, double distance,
                              const PlaceOf& place_of) {
    if (balls.empty()) {
        return {points.begin(), points.end()};
    }
    std::vector<Ball> inflated(balls.begin(), balls.end());
    for (Ball& ball : inflated) {
        ball.radius += distance;
    }
    const BallTree tree = build_ball_tree(inflated);
    constexpr std::size_t kBlock = 4096;  // a test remembers balls: from block to block it begins anew
    return collect<std::vector<T>>(
        (points.size() + kBlock - 1) / kBlock,
        [&](std::size_t block, std::vector<T>& out) {
            CoverTest is_covered(tree, inflated);
            const std::size_t begin = block * kBlock;
            for (const T& point : points.subspan(begin, std::min(kBlock, points.size() - begin))) {
                if (!is_covered(place_of(point))) {
                    out.push_back(point);
                }
            }
        },
        std::size_t{1});
}

}  // namespace scaleaxis::inline v1
