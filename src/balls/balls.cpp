// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/balls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include "kernel/parallel.hpp"
#include "kernel/random.hpp"
#include "sampling/inner_cells.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

// Balls that differ by less than this part of the sampling tolerance are one.
constexpr double kMergeTolerance = 1e-6;

struct SampledCells {
    const Samples& samples;

    Index size() const { return static_cast<Index>(samples.tetrahedra.size()); }
    bool is_inside(Index cell) const { return samples.inside[cell] != 0; }
    const std::array<Index, 4>& vertices(Index cell) const { return samples.tetrahedra[cell]; }
    Ball ball(Index cell) const { return {samples.centers[cell], samples.radii[cell]}; }
    bool is_larger(Index cell, Index other) const { return samples.radii[cell] > samples.radii[other]; }
};

// The balls without those that coincide with an earlier one to within `tolerance`: a sweep along a direction in which
// no symmetry of the shape lines up many centres.
std::vector<Ball> without_repetitions(const std::vector<Ball>& balls, double tolerance) {
    const Point direction{0.5412, 0.2963, 0.7869};
    std::vector<std::pair<double, Index>> order(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
        order[i] = {dot(direction, balls[i].center), static_cast<Index>(i)};
    }
    std::sort(order.begin(), order.end());
    // Balls are compared with kept ones alone, so that a long row of near ones does not become one ball.
    std::vector<bool> is_kept(balls.size(), true);
    std::deque<std::pair<double, Index>> window;
    for (const auto& [position, i] : order) {
        while (!window.empty() && window.front().first < position - 2.0 * tolerance) {
            window.pop_front();
        }
        is_kept[i] = std::none_of(window.begin(), window.end(), [&, ball = balls[i]](const auto& entry) {
            const Ball& other = balls[entry.second];
            return squared_distance(other.center, ball.center) <= tolerance * tolerance &&
                   std::abs(other.radius - ball.radius) <= tolerance;
        });
        if (is_kept[i]) {
            window.emplace_back(position, i);
        }
    }
    std::vector<Ball> kept;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (is_kept[i]) {
            kept.push_back(balls[i]);
        }
    }
    return kept;
}

}  // namespace

std::vector<Ball> inner_balls(const Samples& samples, const Execution& execution) {
    return kernel::in_arena(execution, [&] {
        kernel::report(execution, "balls", 0.0);
        const std::vector<Ball> balls = balls_of_cells(SampledCells{samples}, samples.points.size());
        kernel::report(execution, "balls", 1.0);
        return without_repetitions(balls, kMergeTolerance * samples.tolerance);
    });
}

std::vector<Ball> scaled(std::span<const Ball> balls, double factor) {
    std::vector<Ball> result(balls.begin(), balls.end());
    for (Ball& ball : result) {
        ball.radius *= factor;
    }
    return result;
}

std::vector<Ball> perturbed(std::span<const Ball> balls, double amount, std::uint64_t seed) {
    std::vector<Ball> result(balls.begin(), balls.end());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const auto coordinate = [&](std::uint64_t k) { return 2.0 * kernel::random_unit(seed, i, k) - 1.0; };
        // A point of the cube within the unit ball.
        const Point direction = (1.0 / std::sqrt(3.0)) * Point{coordinate(0), coordinate(1), coordinate(2)};
        result[i].center = result[i].center + (amount * result[i].radius) * direction;
    }
    return result;
}

void check_balls(std::span<const Ball> balls) {
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const bool is_ball = is_finite(balls[i].center) && std::isfinite(balls[i].radius) && balls[i].radius > 0.0;
        if (!is_ball) {
            throw UnusableShape("ball " + std::to_string(i) +
                                " needs finite coordinates and a finite positive radius: remove or correct it");
        }
    }
}

std::vector<Ball> cleaned(std::span<const Ball> balls) {
    check_balls(balls);
    return without_repetitions({balls.begin(), balls.end()}, 1e-9 * bounds(balls).diagonal());
}

Box bounds(std::span<const Ball> balls) {
    Box box;
    for (const Ball& ball : balls) {
        const Point r{ball.radius, ball.radius, ball.radius};
        box.extend(ball.center - r);
        box.extend(ball.center + r);
    }
    return box;
}

}  // namespace scaleaxis
