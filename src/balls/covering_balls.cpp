// SPDX-License-Identifier: Apache-2.0
#include "balls/covering_balls.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {

std::vector<Index> covering_balls(std::span<const Ball> balls, std::span<const Point> points, double reach) {
    const auto by_size = sorted_indices(
        balls.size(), [&](Index i) { return balls[i].radius; }, std::greater<>());
    const PointTree tree = build_point_tree(points);
    std::vector<std::uint8_t> is_covered(points.size());
    std::vector<Index> chosen;
    CancellationPoint cancellation_point(64);
    for (const Index i : by_size) {
        cancellation_point();
        bool covers_more = false;
        for_each_point_near(tree, balls[i].center, balls[i].radius + reach, [&](Index position, double) {
            covers_more = covers_more || is_covered[position] == 0;
            is_covered[position] = 1;
        });
        if (covers_more) {
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
