// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/balls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "sampling/inner_cells.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Inner balls that differ by less than this part of the sampling tolerance are one.
constexpr double kMergeTolerance = 1e-6;

// Of balls that others made two are one if they differ by no more than the smaller of these parts of the diagonal of
// all balls and of the radius, plus the rounding of their coordinates.
constexpr double kMergeToleranceOfDiagonal = 1e-9;
constexpr double kMergeToleranceOfRadius = 1e-6;

double merge_tolerance(const Ball& ball, double diagonal) {
    constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
    const auto& [c, r] = ball;
    return std::min(kMergeToleranceOfDiagonal * diagonal, kMergeToleranceOfRadius * r) +
           kRounding * std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
}

struct SampledCells {
    const Samples& samples;

    Index size() const { return static_cast<Index>(samples.tetrahedra.size()); }
    bool is_inside(Index cell) const { return samples.inside[cell] != 0; }
    const std::array<Index, 4>& vertices(Index cell) const { return samples.tetrahedra[cell]; }
    Ball ball(Index cell) const { return {samples.centers[cell], samples.radii[cell]}; }
    bool is_larger(Index cell, Index other) const { return samples.radii[cell] > samples.radii[other]; }
};

// The positions of the balls without those that coincide with an earlier one to within `tolerance_of(ball)`: a sweep
// along a direction in which no symmetry of the shape lines up many centres.
template <class ToleranceOf>
std::vector<Index> positions_without_repetitions(std::span<const Ball> balls, const ToleranceOf& tolerance_of) {
    const Point direction{0.5412, 0.2963, 0.7869};
    std::vector<std::pair<double, Index>> order(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
        order[i] = {dot(direction, balls[i].center), static_cast<Index>(i)};
    }
    tasks::parallel_sort(order.begin(), order.end());
    // Balls are compared with kept ones alone, so that a long row of near ones does not become one ball.
    std::vector<std::pair<double, Index>> swept;  // of those kept
    std::vector<Index> kept;
    CancellationPoint cancellation_point;
    for (const auto& [position, i] : order) {
        cancellation_point();
        const Ball& ball = balls[i];
        const double tolerance = tolerance_of(ball);
        const auto is_same = [&](const Ball& other) {
            return squared_distance(other.center, ball.center) <= tolerance * tolerance &&
                   std::abs(other.radius - ball.radius) <= tolerance;
        };
        bool is_repetition = false;
        for (std::size_t k = swept.size(); k-- > 0 && swept[k].first >= position - 2.0 * tolerance && !is_repetition;) {
            is_repetition = is_same(balls[swept[k].second]);
        }
        if (!is_repetition) {
            swept.emplace_back(position, i);
            kept.push_back(i);
        }
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

std::vector<Ball> balls_at(std::span<const Ball> balls, const std::vector<Index>& positions) {
    return each_of<Ball>(positions, [&](Index i) { return balls[i]; });
}

}  // namespace

std::vector<Ball> inner_balls(const Samples& samples, const Execution& execution) {
    return in_arena(execution, [&] {
        report(execution, "balls", 0.0);
        const std::vector<Ball> balls = balls_of_cells(SampledCells{samples}, samples.points.size());
        report(execution, "balls", 0.5);
        const auto tolerance_of = [&](const Ball&) { return kMergeTolerance * samples.tolerance; };
        std::vector<Ball> distinct = balls_at(balls, positions_without_repetitions(balls, tolerance_of));
        report(execution, "balls", 1.0);
        return distinct;
    });
}

std::vector<Ball> scaled(std::span<const Ball> balls, double factor) {
    require(factor > 0.0 && std::isfinite(factor), "the factor of radii must be a positive number");
    std::vector<Ball> result(balls.begin(), balls.end());
    for (Ball& ball : result) {
        ball.radius *= factor;
    }
    return result;
}

std::vector<Ball> perturbed(std::span<const Ball> balls, double amount, std::uint64_t seed) {
    require(amount >= 0.0 && std::isfinite(amount), "the part of a radius to move by must be 0 or a positive number");
    std::vector<Ball> result(balls.begin(), balls.end());
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i].center = result[i].center + (amount * result[i].radius) * random_direction(seed, i);
    }
    return result;
}

Diagnostic find_bad_ball(std::span<const Ball> balls) {
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const auto& [center, radius] = balls[i];
        const auto fault = [&](const char* code, const std::string& what) {
            return Diagnostic{code,
                              "ball " + std::to_string(i + 1) + " of " + std::to_string(balls.size()) + ' ' + what,
                              "ball", static_cast<std::int64_t>(i + 1)};
        };
        if (!is_usable(center)) {
            return fault("balls.not_finite", kUnusableCoordinate);
        }
        if (!(radius > 0.0) || !(radius <= kLargestCoordinate)) {
            return fault("balls.radius", "has the radius " + to_text(radius) +
                                             ", which is not a positive number up to 1e18; correct or remove it");
        }
    }
    return {};
}

void check_balls(std::span<const Ball> balls) {
    if (Diagnostic fault = find_bad_ball(balls); !fault.empty()) {
        throw UnusableInput(std::move(fault));
    }
}

std::vector<Index> distinct_positions(std::span<const Ball> balls) {
    check_balls(balls);
    const double diagonal = bounds(balls).diagonal();
    return positions_without_repetitions(balls, [&](const Ball& ball) { return merge_tolerance(ball, diagonal); });
}

std::vector<Ball> distinct_balls(std::span<const Ball> balls) { return balls_at(balls, distinct_positions(balls)); }

Box bounds(std::span<const Ball> balls) {
    Box box;
    for (const Ball& ball : balls) {
        const Point r{ball.radius, ball.radius, ball.radius};
        box.extend(ball.center - r);
        box.extend(ball.center + r);
    }
    return box;
}

}  // namespace scaleaxis::inline v1
