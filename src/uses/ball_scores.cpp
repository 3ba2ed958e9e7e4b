// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/powers.hpp"
#include "base/random.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/few_balls.hpp"
#include "scaleaxis/fit.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/mesh_parts.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Points of a triangle for each square of their spacing: as many as seeds of a solid.
constexpr double kPointsOfSpacing = 10.0;

// No more points than these are looked at, in the volume or on what was left out: a triangle that is much larger than
// the solid would take all memory.
constexpr double kMostPoints = 3e6;

std::vector<double> distances_to(const BallTree& tree, std::span<const Point> points) {
    return mapped<double>(points.size(), [&](std::size_t i) { return nearest_ball(tree, points[i]).distance; });
}

// At least so many points are looked at in the box around solid and balls, and on the boundary of the union.
constexpr double kPoints = 40000.0;

// One point in each cell of a grid.
std::vector<Point> jittered_grid(const Box& box, double cell, std::uint64_t seed) {
    const auto steps = [&](double length) { return std::max<std::int64_t>(1, std::llround(length / cell)); };
    const Point size = box.max - box.min;
    const std::int64_t nx = steps(size.x), ny = steps(size.y), nz = steps(size.z);
    return mapped<Point>(static_cast<std::size_t>(nx * ny * nz), [&](std::size_t i) {
        const auto at = static_cast<std::int64_t>(i);
        const auto along = [&](std::int64_t k, std::int64_t n, double low, double length, std::uint64_t axis) {
            return low + length * (static_cast<double>(k) + random_unit(seed, i, axis)) / static_cast<double>(n);
        };
        return Point{along(at % nx, nx, box.min.x, size.x, 0), along(at / nx % ny, ny, box.min.y, size.y, 1),
                     along(at / nx / ny, nz, box.min.z, size.z, 2)};
    });
}

void score_volume(BallScores& scores, const BallTree& tree, const Solid& solid, const Box& box, double rounding,
                  std::uint64_t seed) {
    constexpr std::int64_t kEnoughInside = 30000;
    const Point size = box.max - box.min;
    const double volume = size.x * size.y * size.z;
    for (double wanted = kPoints;; wanted *= 4.0) {
        const std::vector<Point> points = jittered_grid(box, cube_root(volume / wanted), seed);
        const std::vector<std::uint8_t> sides = sides_of(solid, points);
        const std::vector<double> distances = distances_to(tree, points);
        std::int64_t in_solid = 0, in_union = 0, in_both = 0;
        double largest_gap = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool is_covered = distances[i] <= rounding;
            in_solid += sides[i];
            in_union += is_covered ? 1 : 0;
            in_both += is_covered && sides[i] != 0 ? 1 : 0;
            largest_gap = sides[i] != 0 ? std::max(largest_gap, distances[i]) : largest_gap;
        }
        scores.largest_gap = std::max(scores.largest_gap, largest_gap);
        if (in_solid >= kEnoughInside || 4.0 * wanted > kMostPoints) {
            const auto share = [](std::int64_t part, std::int64_t whole) {
                return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
            };
            scores.coverage = share(in_both, in_solid);
            scores.volume_ratio = share(in_union, in_solid);
            scores.outside_share = share(in_union - in_both, in_union);
            scores.volume_points = static_cast<Index>(in_solid);
            return;
        }
    }
}

void score_surface(BallScores& scores, const BallTree& tree, std::span<const Point> points, double rounding) {
    const std::vector<double> distances = distances_to(tree, points);
    Index covered = 0;
    double sum = 0.0;
    for (const double each : distances) {
        covered += each <= rounding ? 1 : 0;
        sum += std::max(0.0, each);
        scores.largest_gap = std::max(scores.largest_gap, each);
    }
    scores.surface_points = static_cast<Index>(points.size());
    scores.surface_coverage = covered / static_cast<double>(points.size());
    scores.mean_gap = sum / static_cast<double>(points.size());
}

// Points of the boundary of the union, equally dense by area.
std::vector<Point> boundary_points(std::span<const Ball> balls, const BallTree& tree, double rounding) {
    const double squares = std::accumulate(balls.begin(), balls.end(), 0.0,
                                           [](double sum, const Ball& b) { return sum + b.radius * b.radius; });
    return collect<std::vector<Point>>(
        balls.size(),
        [&](std::size_t k, std::vector<Point>& out) {
            const auto& [center, radius] = balls[k];
            // A Fibonacci lattice.
            const auto count = static_cast<std::int64_t>(std::ceil(kPoints * radius * radius / squares));
            for (std::int64_t i = 0; i < count; ++i) {
                const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
                const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
                const auto [cosine, sine] = on_circle(std::numbers::phi * static_cast<double>(i));
                const Point p = center + radius * Point{across * cosine, across * sine, z};
                if (nearest_ball(tree, p).distance > -rounding) {
                    out.push_back(p);
                }
            }
        },
        std::size_t{1});
}

void score_protrusion(BallScores& scores, std::span<const Ball> balls, const BallTree& tree, const Solid& solid,
                      double rounding) {
    const std::vector<Point> points = boundary_points(balls, tree, rounding);
    const std::vector<std::uint8_t> sides = sides_of(solid, points);
    std::vector<double> distances(points.size(), 0.0);
    for_each_index(
        points.size(),
        [&](std::size_t i) {
            if (sides[i] == 0) {
                const std::optional<Point> foot = solid.nearest(points[i]);
                distances[i] = foot ? distance(points[i], *foot) : 0.0;
            }
        },
        std::size_t{64});
    scores.union_points = static_cast<Index>(points.size());
    if (points.empty()) {
        return;
    }
    std::ranges::sort(distances);
    const auto size = static_cast<double>(distances.size());
    scores.largest_protrusion = distances.back();
    scores.mean_protrusion = std::accumulate(distances.begin(), distances.end(), 0.0) / size;
    scores.protrusion_95 = distances[static_cast<std::size_t>(0.95 * (size - 1.0))];
}

}  // namespace

BallScores ball_scores(std::span<const Ball> balls, std::span<const Point> points, const Solid& solid,
                       std::uint64_t seed, const Execution& execution) {
    check_balls(balls);
    if (balls.empty() || points.empty()) {
        throw UnusableInput("there are no balls, or no points of the surface, to measure");
    }
    check_knows_nearest(solid);
    return in_arena(execution, [&] {
        report(execution, "scores", 0.0);
        BallScores scores;
        const BallTree tree = build_ball_tree(balls);
        Box box = solid.bounds();
        const double rounding = kRelativeRounding * box.diagonal();
        const Box around = bounds(balls);
        box.extend(around);
        score_volume(scores, tree, solid, box, rounding, seed);
        report(execution, "scores", 0.5);
        score_surface(scores, tree, points, rounding);
        score_protrusion(scores, balls, tree, solid, rounding);
        report(execution, "scores", 1.0);
        return scores;
    });
}

std::vector<Point> points_left_out(const MeshView& triangles, const Solid& solid, double spacing, std::uint64_t seed,
                                   const Execution& execution) {
    check_knows_nearest(solid);
    return in_arena(execution, [&] {
        const auto areas = each_of<double>(triangles.triangles, [&](const auto& t) {
            return triangle_area(triangles.vertices[t[0]], triangles.vertices[t[1]], triangles.vertices[t[2]]);
        });
        const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
        const double density = std::min(kPointsOfSpacing / (spacing * spacing), kMostPoints / area);
        const std::vector<Point> points =
            collect<std::vector<Point>>(areas.size(), [&](std::size_t t, std::vector<Point>& out) {
                const auto& [a, b, c] = triangles.triangles[t];
                const double wanted = density * areas[t];
                const auto count = std::isfinite(wanted) ? std::floor(wanted + random_unit(seed, t)) : 0.0;
                for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
                    out.push_back(point_of_triangle(triangles.vertices[a], triangles.vertices[b], triangles.vertices[c],
                                                    random_unit(seed, t, 2 * i + 1), random_unit(seed, t, 2 * i + 2)));
                }
            });
        const std::vector<std::uint8_t> sides = sides_of(solid, points);
        // Wraps are off by a little.
        const std::vector<double> beside(points.size(), kNegligible * solid.bounds().diagonal());
        const std::vector<std::optional<Point>> nearest = nearest_of(solid, points, beside);
        std::vector<Point> result;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (sides[i] == 0 && !nearest[i]) {
                result.push_back(points[i]);
            }
        }
        return result;
    });
}

}  // namespace scaleaxis::inline v1
