// SPDX-License-Identifier: Apache-2.0
#include "uses/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/vectors.hpp"

namespace scaleaxis::inline v1 {
namespace {

double farthest(const Point& center, std::span<const Point> points) {
    double square = 0.0;
    for (const Point& p : points) {
        square = std::max(square, squared_distance(center, p));
    }
    return std::sqrt(square);
}

// The inscribed ball for which the largest distance of the points to it is least, found by steps into several
// directions that become shorter. A step stays in the ball that it starts from, and so in the solid.
Ball fitted(Ball ball, std::span<const Point> points, const Solid& solid) {
    constexpr int kHalvings = 8;
    constexpr std::uint64_t kSeed = 7;
    double error = farthest(ball.center, points) - ball.radius;
    const double first_step = 0.5 * std::min(ball.radius, std::max(error, 0.25 * ball.radius));
    double step = first_step;
    std::uint64_t round = 0;
    for (int halving = 0; halving < kHalvings;) {
        const Point far =
            *std::ranges::max_element(points, {}, [&](const Point& p) { return squared_distance(p, ball.center); });
        const std::optional<Point> foot = solid.nearest(ball.center);
        if (!foot) {
            return ball;
        }
        const Point a = random_unit_vector(kSeed, round, 0);
        const Point b = unit(cross(a, random_unit_vector(kSeed, round, 1)));
        const Point c = cross(a, b);
        const Point towards = unit(far - ball.center);
        const Point away = unit(ball.center - *foot);
        const std::array<Point, 9> directions{
            unit(towards + away), towards, away, a, b, c, -1.0 * a, -1.0 * b, -1.0 * c};
        ++round;
        bool is_better = false;
        for (const Point& direction : directions) {
            const Point center = ball.center + std::min(step, 0.99 * ball.radius) * direction;
            const double reach = farthest(center, points);
            // What the radius has to be at least; it changes by no more than the step.
            const double needed = reach - error + kNegligible * step;
            if (needed > ball.radius + step || (needed > 0.0 && solid.nearest(center, needed))) {
                continue;
            }
            const Ball moved = inscribed_ball(solid, center);
            // Outside, where rounding or a ball that sticks out may lead, distances to the boundary have no end.
            if (moved.radius > 0.0 && reach - moved.radius < error && solid.inside(center)) {
                ball = moved;
                error = reach - moved.radius;
                is_better = true;
                break;
            }
        }
        if (!is_better) {
            step *= 0.5;
            ++halving;
        } else if (round > 200) {
            break;
        }
    }
    return ball;
}

// Fills in everything but the balls.
void assign(Placement& placement, std::span<const Point> points) {
    const std::vector<Ball>& balls = placement.balls;
    placement.nearest.resize(points.size());
    placement.distances.resize(points.size());
    placement.otherwise.resize(points.size());
    for_each_index(
        points.size(),
        [&](std::size_t i) {
            Index best = kNone;
            double least = kInfinity;
            double second = kInfinity;
            for (std::size_t k = 0; k < balls.size(); ++k) {
                const double value = distance(points[i], balls[k].center) - balls[k].radius;
                if (value < least) {
                    second = std::exchange(least, value);
                    best = static_cast<Index>(k);
                } else if (value < second) {
                    second = value;
                }
            }
            placement.nearest[i] = best;
            placement.distances[i] = least;
            placement.otherwise[i] = second;
        },
        std::size_t{256});
    placement.ball_errors.assign(balls.size(), -kInfinity);
    for (std::size_t i = 0; i < points.size(); ++i) {
        double& error = placement.ball_errors[placement.nearest[i]];
        error = std::max(error, placement.distances[i]);
    }
    placement.error = *std::ranges::max_element(placement.ball_errors);
}

// The candidate that brings most of the points that are far from all balls near to one, the farthest point among them.
Ball best_addition(const Placement& placement, std::span<const Point> points, std::span<const Ball> candidates) {
    constexpr double kNear = 0.7;  // of the error
    const auto worst = std::ranges::max_element(placement.distances) - placement.distances.begin();
    const double error = std::max(placement.error, 0.0);
    std::vector<Point> far;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (placement.distances[i] > kNear * error) {
            far.push_back(points[i]);
        }
    }
    struct Gain {
        Index count = -1;
        double distance = kInfinity;
    };
    std::vector<Gain> gains(candidates.size());
    for_each_index(
        candidates.size(),
        [&](std::size_t k) {
            const auto& [center, radius] = candidates[k];
            gains[k].distance = distance(points[worst], center) - radius;
            if (gains[k].distance <= kNear * error) {
                const double reach = radius + kNear * error;
                gains[k].count = static_cast<Index>(std::ranges::count_if(far, [&, center = center](const Point& p) {
                    return squared_distance(p, center) <= reach * reach;
                }));
            }
        },
        std::size_t{64});
    const auto best = std::ranges::max_element(gains, [](const Gain& a, const Gain& b) {
        return a.count != b.count ? a.count < b.count : a.distance > b.distance;
    });
    return candidates[best - gains.begin()];
}

std::vector<std::vector<Point>> points_of_balls(const Placement& placement, std::span<const Point> points) {
    std::vector<std::vector<Point>> clusters(placement.balls.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        clusters[placement.nearest[i]].push_back(points[i]);
    }
    return clusters;
}

}  // namespace

Ball inscribed_ball(const Solid& solid, const Point& center) {
    const std::optional<Point> foot = solid.nearest(center);
    return {center, foot ? distance(center, *foot) : 0.0};
}

Placement placed(std::vector<Ball> balls, std::span<const Point> points) {
    Placement placement;
    placement.balls = std::move(balls);
    assign(placement, points);
    return placement;
}

Placement settled(Placement placement, std::span<const Point> points, const Solid& solid,
                  const std::vector<char>& has_moved, int max_rounds) {
    std::vector<char> is_due = has_moved;
    for (int round = 0; round < max_rounds; ++round) {
        const std::vector<std::vector<Point>> clusters = points_of_balls(placement, points);
        Placement next = placement;
        for_each_index(
            next.balls.size(),
            [&](std::size_t k) {
                if (is_due[k] != 0 && !clusters[k].empty()) {
                    next.balls[k] = fitted(next.balls[k], clusters[k], solid);
                }
            },
            std::size_t{1});
        assign(next, points);
        std::ranges::fill(is_due, 0);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (next.nearest[i] != placement.nearest[i]) {
                is_due[next.nearest[i]] = 1;
                is_due[placement.nearest[i]] = 1;
            }
        }
        const double before = std::exchange(placement, std::move(next)).error;
        if (placement.error > before - 0.1 * kNegligible * std::abs(before) && round > 1) {
            break;
        }
    }
    return placement;
}

std::vector<Index> by_need(const Placement& placement) {
    std::vector<double> need(placement.balls.size(), -kInfinity);
    for (std::size_t i = 0; i < placement.nearest.size(); ++i) {
        double& most = need[placement.nearest[i]];
        most = std::max(most, placement.otherwise[i]);
    }
    return sorted_indices(need.size(), [&](Index k) { return need[k]; });
}

std::vector<Ball> with_one_more(const Placement& placement, std::span<const Point> points,
                                std::span<const Ball> candidates) {
    std::vector<Ball> balls = placement.balls;
    balls.push_back(best_addition(placement, points, candidates));
    return balls;
}

Placement improved(Placement placement, std::span<const Point> points, std::span<const Ball> candidates,
                   const Solid& solid, double goal) {
    constexpr std::size_t kTries = 5;
    constexpr int kRounds = 8;
    const std::size_t most_swaps = std::clamp<std::size_t>(3000 / placement.balls.size(), 5, 200);
    const std::size_t count = placement.balls.size();
    placement = settled(std::move(placement), points, solid, std::vector<char>(count, 1), kRounds);
    std::size_t failures = 0;
    for (std::size_t swaps = 0; count > 1 && failures < std::min(kTries, count) && swaps < most_swaps; ++swaps) {
        if (placement.error <= goal) {
            break;
        }
        stop_if_cancelled();
        const Index gone = by_need(placement)[failures];
        std::vector<Ball> balls = placement.balls;
        balls.erase(balls.begin() + gone);
        Placement fewer = placed(std::move(balls), points);
        Placement next = placed(with_one_more(fewer, points, candidates), points);
        // The ball has a new place in the array as well.
        std::vector<char> has_changed(count, 0);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Index before = placement.nearest[i];
            const Index after = next.nearest[i];
            if (before == gone || after != (before > gone ? before - 1 : before)) {
                has_changed[after] = 1;
                if (before != gone) {
                    has_changed[before > gone ? before - 1 : before] = 1;
                }
            }
        }
        next = settled(std::move(next), points, solid, has_changed, kRounds);
        if (next.error < (1.0 - kNegligible) * placement.error) {
            placement = std::move(next);
            failures = 0;
        } else {
            ++failures;
        }
    }
    return placement;
}

}  // namespace scaleaxis::inline v1
