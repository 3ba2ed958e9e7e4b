// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/smoothing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "axis/complex.hpp"
#include "axis/stages/stages.hpp"
#include "balls/union/union_data.hpp"
#include "complexes.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/shrinking.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

TEST(UnionBoundary, DistancesAreThoseOfBruteForce) {
    Random random(11);
    const std::vector<std::pair<std::string, Balls>> unions{
        {"one ball", {{{1, 2, 3}, 2.0}}},
        {"two apart", {{{0, 0, 0}, 1.0}, {{3, 0, 0}, 0.5}}},
        {"a hidden ball", {{{0, 0, 0}, 1.0}, {{0.1, 0, 0}, 0.5}, {{1, 0.2, 0}, 0.6}}},
        {"a chain", chain_of_balls(6, 0.9, 0.7)},
        {"a ring", ring_of_balls(12, 2.0, 0.7)},
        {"around a void", balls_around_a_void(random, 25, 0.7)},
        {"scattered", scattered_balls(random, 25, 1.0, 0.2, 0.8)},
        {"flat", flat_balls(random, 25)},
        {"of all sizes", balls_of_all_sizes(random, 25)},
        {"through points", balls_through_points(random, 20, 12)},
    };
    for (const auto& [name, balls] : unions) {
        SCOPED_TRACE(name);
        const MedialAxis axis = medial_axis(balls);
        const std::span<const Ball> moved = axis.ball_union.balls();
        const UnionBoundary& boundary = axis.ball_union.data().boundary();
        const UnionInterior& interior = axis.ball_union.data().interior();
        int unknown = 0;
        for (std::size_t v = 0; v < axis.complex.vertices.size(); ++v) {
            EXPECT_NEAR(nearest_point(boundary, axis.complex.vertices[v]).distance, axis.complex.radii[v], 1e-6);
        }
        const UnionOfBalls truth(Balls(moved.begin(), moved.end()));
        for (int i = 0; i < 200; ++i) {
            const Ball& ball = moved[static_cast<std::size_t>(i) % moved.size()];
            const Point p = ball.center + uniform(random, 0.0, 0.99 * ball.radius) * random_direction(random);
            EXPECT_NEAR(nearest_point(boundary, p).distance, truth.depth(p), 1e-6 * ball.radius);
            const std::optional<NearBoundaryPoint> inner = nearest_from_inside(interior, p);
            EXPECT_NEAR(inner ? inner->distance : truth.depth(p), truth.depth(p), 1e-6 * ball.radius);
            EXPECT_NEAR(inner ? distance(p, inner->point) : truth.depth(p), truth.depth(p), 1e-6 * ball.radius);
            unknown += inner ? 0 : 1;
            const Point outside = p + 1000.0 * random_direction(random);
            EXPECT_FALSE(nearest_from_inside(interior, outside));
        }
        EXPECT_LE(unknown, 10) << "of 200";
    }
}

// A sheet of 2 × 2 squares in a large ball.
TEST(Smooth, MovesTheBoundaryOfASheetHalfTheWay) {
    std::vector<Point> grid;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            grid.push_back({1.0 * x, 1.0 * y, 0.0});
        }
    }
    MedialComplex sheet = complex_by_hand(grid, {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}});
    sheet.boundary_vertices = {{0, 0, 10}, {0, 0, -10}};
    const MedialAxis ball = medial_axis(Balls{{{0, 0, 0}, 10.0}}, {.perturbation = 0.0});
    const MedialComplex smoothed = smooth(with_scale(sheet, 2.0), ball.ball_union, {.rounds = 1});
    EXPECT_EQ(smoothed.vertices[0], (Point{-0.75, -0.75, 0.0}));
    EXPECT_NEAR(smoothed.radii[0], (10.0 - 0.75 * std::sqrt(2.0)) / 2.0, 1e-12);
    EXPECT_EQ(smoothed.vertices[1], (Point{0.0, -1.0, 0.0})) << "its neighbours are on both sides";
    EXPECT_EQ(smoothed.vertices[4], grid[4]) << "inside the sheet nothing moves";
    EXPECT_EQ(smoothed.radii[4], 1.0);
    EXPECT_EQ(smoothed.faces.items, sheet.faces.items);
    EXPECT_EQ(smoothed.edges, sheet.edges);
    EXPECT_TRUE(same_bytes(smooth(sheet, ball.ball_union, {.rounds = 0}), sheet));
}

TEST(Smooth, KeepsSeamsEndsAndWhatWouldLeaveTheUnion) {
    // Three squares at a seam, one of them with a curve at its outer corner.
    const std::vector<Point> points{{0, 0, 0},  {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0},
                                    {-1, 1, 0}, {0, 0, 1}, {0, 1, 1}, {2, 2, 0}};
    const MedialComplex fins = complex_by_hand(points, {{0, 2, 3, 1}, {0, 1, 5, 4}, {0, 1, 7, 6}}, {}, {{3, 8}});
    const MedialAxis around = medial_axis(Balls{{{0, 0, 0}, 10.0}}, {.perturbation = 0.0});
    const MedialComplex smoothed = smooth(fins, around.ball_union, {.rounds = 3});
    for (const Index fixed : {0, 1, 3, 8}) {
        EXPECT_EQ(smoothed.vertices[fixed], points[fixed]) << fixed;
    }
    for (const Index moved : {2, 4, 5, 6, 7}) {
        EXPECT_NE(smoothed.vertices[moved], points[moved]) << moved;
    }
    // The way to the middle leads through what no ball covers.
    const MedialAxis apart = medial_axis(
        Balls{{{1, 0, 0}, 0.1}, {{-1, 0, 0}, 0.1}, {{-1, 1, 0}, 0.1}, {{0, 0, 1}, 0.1}}, {.perturbation = 0.0});
    EXPECT_TRUE(same_bytes(smooth(fins, apart.ball_union, {.rounds = 2}), fins));
}

TEST(Smooth, KeepsTheLargestBallWhereACurveTurnsBack) {
    const std::vector<Point> points{{0.4, 0, 0}, {0, 0, 0}, {0.8, 0.01, 0}, {1.5, 0, 0}};
    const MedialComplex curve = with_radii(complex_by_hand(points, {}, {}, {{0, 1}, {1, 2}, {2, 3}}),
                                           [](const Point& p) { return p.x == 0.0 || p.x == 1.5 ? 1.0 : 0.7; });
    const MedialAxis two = medial_axis(Balls{{{0, 0, 0}, 1.0}, {{1.5, 0, 0}, 1.0}}, {.perturbation = 0.0});
    const MedialComplex smoothed = smooth(curve, two.ball_union, {.rounds = 20});
    EXPECT_EQ(smoothed.vertices[1], points[1]);
    EXPECT_EQ(smoothed.radii[1], 1.0);
    EXPECT_NE(smoothed.vertices[2], points[2]);
}

double roughness(const MedialComplex& complex) {
    std::vector<Index> faces_at_edge(complex.edges.size());
    for (const Index e : complex.face_edges.items) {
        ++faces_at_edge[e];
    }
    std::vector<std::vector<Index>> along(complex.vertices.size());
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (faces_at_edge[e] == 1) {
            along[complex.edges[e][0]].push_back(complex.edges[e][1]);
            along[complex.edges[e][1]].push_back(complex.edges[e][0]);
        }
    }
    double sum = 0.0;
    for (std::size_t v = 0; v < along.size(); ++v) {
        if (along[v].size() == 2) {
            sum += squared_distance(complex.vertices[v],
                                    midpoint(complex.vertices[along[v][0]], complex.vertices[along[v][1]]));
        }
    }
    return sum;
}

TEST(Smooth, MovedBallsTouchTheBoundaryOfTheUnionFromInside) {
    // A plate with round edges, whose axis is a disc-like sheet with a ragged boundary.
    const ImplicitSolid plate(box_solid({1.0, 0.7, 0.2}));
    for (const double scale : {1.0, 1.1}) {
        SCOPED_TRACE("s = " + std::to_string(scale));
        const Samples samples = sample(plate, {.tolerance = 0.15, .sizing = Sizing::kUniform});
        const MedialAxis axis = medial_axis(scaled(inner_balls(samples), scale));
        const MedialComplex before = densify(shrink(filter(axis.complex).complex, scale));
        const MedialComplex after = smooth(before, axis.ball_union, {.rounds = 10});
        EXPECT_EQ(after.edges, before.edges);
        EXPECT_EQ(after.faces.items, before.faces.items);
        EXPECT_EQ(topology(after), topology(before));
        EXPECT_LT(roughness(after), 0.5 * roughness(before));
        const std::span<const Ball> balls = axis.ball_union.balls();
        const UnionOfBalls truth(Balls(balls.begin(), balls.end()));
        std::size_t moved = 0;
        for (std::size_t v = 0; v < after.vertices.size(); ++v) {
            if (after.vertices[v] == before.vertices[v]) {
                EXPECT_NEAR(after.radii[v], before.radii[v], 1e-12);
            } else {
                ++moved;
                EXPECT_NEAR(scale * after.radii[v], truth.depth(after.vertices[v]), 1e-6);
            }
        }
        EXPECT_GT(moved, 20U);
    }
}

TEST(Smooth, DoesNotDependOnThreads) {
    const ImplicitSolid plate(box_solid({1.0, 0.7, 0.2}));
    const ScaleAxisOptions options{.delta = Length::relative(0.03), .smoothing_rounds = 5};
    EXPECT_TRUE(same_bytes(scale_axis(plate, options, {1, {}}).axes[0].complex,
                           scale_axis(plate, options, {4, {}}).axes[0].complex));
}

TEST(Smooth, BadOptionsAreErrors) {
    const MedialAxis axis = medial_axis(Balls{{{0, 0, 0}, 1.0}});
    EXPECT_THROW(smooth(axis.complex, axis.ball_union, {.rounds = -1}), InvalidOption);
    EXPECT_THROW(smooth(axis.complex, MedialAxis().ball_union, {.rounds = 1}), UnusableInput);
}

/// How far linear radii may be from those of the union where a complex alone is smoothed.
double linear_tolerance(const MedialComplex& complex) { return 0.002 * box_of_balls(complex).diagonal(); }

TEST(Smooth, OfAComplexAloneIsNearThatWithItsUnion) {
    const ImplicitSolid solid = box_solid({1.0, 0.6, 0.4});
    const std::vector<Ball> balls = inner_balls(sample(solid, {.tolerance = 0.05, .sizing = Sizing::kUniform}));
    const double scale = 1.1;
    const MedialAxis axis = medial_axis(scaled(balls, scale));
    const MedialComplex shrunk = shrink(filter(axis.complex).complex, scale);
    const MedialComplex divided = linearized_around_borders(shrunk, linear_tolerance(shrunk));
    const SmoothOptions options{.rounds = 10};
    const MedialComplex expected = smooth(divided, axis.ball_union, options);
    const MedialComplex smoothed = smooth(shrunk, options);
    expect_well_formed(smoothed);
    EXPECT_EQ(smoothed.edges, divided.edges);
    std::size_t moved = 0;
    for (std::size_t v = 0; v < smoothed.vertices.size(); ++v) {
        if (scaleaxis::is_linear(smoothed.vertex_origins[v]) && scaleaxis::is_linear(expected.vertex_origins[v])) {
            ++moved;
            EXPECT_EQ(smoothed.vertices[v], expected.vertices[v]);
            EXPECT_LE(smoothed.radii[v], expected.radii[v] * (1.0 + 1e-6)) << "inside the solid";
            EXPECT_GE(smoothed.radii[v], expected.radii[v] * 0.985);
        }
    }
    EXPECT_GT(moved, 20U);
    EXPECT_EQ(smooth(shrunk, {.rounds = 0}).vertices, shrunk.vertices);
    EXPECT_THROW(smooth(shrunk, {.rounds = -1}), InvalidOption);
    EXPECT_TRUE(smooth(MedialComplex{}, options).vertices.empty());
}

/// How far balls inside faces stick out of a union at most.
double largest_excess(const MedialComplex& complex, const UnionOfBalls& solid) {
    Random random(5);
    double most = 0.0;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        const bool is_linear =
            std::ranges::any_of(corners, [&](Index v) { return scaleaxis::is_linear(complex.vertex_origins[v]); });
        // In a triangle of the polygon: linear radii are those of one.
        const std::array<Index, 3> triangle{corners[0], corners[corners.size() / 2], corners.back()};
        for (int i = 0; i < 5; ++i) {
            const double a = uniform(random, 0.0, 1.0);
            const double b = uniform(random, 0.0, 1.0 - a);
            const std::array<double, 3> weights{a, b, 1.0 - a - b};
            Ball ball = interpolated(complex, triangle, weights);
            if (is_linear) {
                ball.radius = 0.0;
                for (int k = 0; k < 3; ++k) {
                    ball.radius += weights[k] * complex.radii[triangle[k]];
                }
            }
            most = std::max(most, ball.radius - solid.depth(ball.center));
        }
    }
    return most;
}

TEST(Smooth, OfAComplexAloneStaysInTheSolidOnLargeFaces) {
    // Few large balls in a plate: between their centres the radii of the axis dip far below linear ones.
    Balls balls;
    for (int i = 0; i < 8; ++i) {
        for (int k = 0; k < 6; ++k) {
            balls.push_back({{0.5 * i + 0.03 * (k % 2), 0.5 * k + 0.05 * (i % 3), 0.0}, 0.4});
        }
    }
    const MedialAxis axis = medial_axis(balls);
    const UnionOfBalls solid(Balls(axis.ball_union.balls().begin(), axis.ball_union.balls().end()));
    const MedialComplex before = filter(axis.complex).complex;
    const double tolerance = linear_tolerance(before);
    const MedialComplex with_union = smooth(before, axis.ball_union, {.rounds = 10});
    EXPECT_GT(largest_excess(with_union, solid), 2.0 * tolerance) << "the test is too easy";
    const MedialComplex alone = smooth(before, {.rounds = 10});
    expect_well_formed(alone);
    EXPECT_EQ(topology(alone), topology(before));
    EXPECT_LT(largest_excess(alone, solid), tolerance);
    // Cleaning leaves radii exact, at its cuts too.
    const MedialComplex cleaned = clean(before, {.thickness = 0.2}).complex;
    EXPECT_GT(cleaned.faces.size(), 10U);
    EXPECT_NE(cleaned.vertices, before.vertices);
    EXPECT_LT(largest_excess(cleaned, solid), 1e-3);
}

}  // namespace
}  // namespace scaleaxis
