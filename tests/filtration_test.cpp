// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/filtration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "complexes.hpp"
#include "executions.hpp"
#include "folder.hpp"
#include "meshes.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr double kTolerance = FiltrationOptions().tolerance;

void expect_vanishes(double found, double scale) {
    EXPECT_GE(found, scale * (1.0 - 1e-7));
    EXPECT_LE(found, scale * (1.0 + 1.001 * kTolerance));
}

bool is_larger(const Balls& balls, std::size_t a, std::size_t b) {
    return balls[a].radius > balls[b].radius || (balls[a].radius == balls[b].radius && a < b);
}

/// The scale from which on larger balls cover a point `y` of ball `i`, given from its centre and divided by the scale.
double covering_scale(const Balls& balls, std::size_t i, const Point& y) {
    double most = 0.0;
    for (std::size_t j = 0; j < balls.size(); ++j) {
        const Point d = balls[j].center - balls[i].center;
        const double square = squared_norm(d);
        if (j != i && is_larger(balls, j, i) && square > 0.0) {
            const double along = dot(y, d);
            const double rest = balls[j].radius * balls[j].radius - squared_norm(y);
            most = std::max(most, (along + std::sqrt(along * along + square * rest)) / square);
        }
    }
    return most > 0.0 ? 1.0 / most : kNeverVanishes;
}

/// The same of the whole ball, by points on its sphere and inside, and uphill from the worst of them: not more than the
/// true one, and close to it.
double sampled_scale(const Balls& balls, std::size_t i, Random& random, int points) {
    std::vector<std::pair<double, Point>> samples;
    for (int k = 0; k < points; ++k) {
        const double radius = balls[i].radius * (k % 4 == 0 ? std::cbrt(uniform(random, 0.0, 1.0)) : 1.0);
        const Point y = radius * random_direction(random);
        samples.emplace_back(covering_scale(balls, i, y), y);
    }
    const std::size_t starts = std::min<std::size_t>(12, samples.size());
    std::ranges::partial_sort(samples, samples.begin() + starts, std::greater<>(), &std::pair<double, Point>::first);
    for (std::size_t k = 0; k < starts; ++k) {
        auto& [scale, at] = samples[k];
        for (double step = 0.3; step > 1e-5; step *= 0.98) {
            Point y = at + step * balls[i].radius * random_direction(random);
            y = std::min(1.0, balls[i].radius / norm(y)) * y;
            if (const double next = covering_scale(balls, i, y); next > scale) {
                scale = next;
                at = y;
            }
        }
    }
    return std::max(1.0, std::ranges::max(samples, {}, &std::pair<double, Point>::first).first);
}

TEST(VanishingScales, SmallBallOnALargeOne) {
    for (const double d : {1.0, 1.5, 2.0, 3.0, 7.0}) {
        const std::vector<double> scales = vanishing_scales(Balls{{{d, 0, 0}, 0.5}, {{0, 0, 0}, 1.5}});
        expect_vanishes(scales[0], d);  // d / (1.5 - 0.5)
        EXPECT_EQ(scales[1], kNeverVanishes);
    }
}

TEST(VanishingScales, HiddenBallsVanishAtOnce) {
    EXPECT_EQ(vanishing_scales(Balls{{{0.3, 0, 0}, 0.5}, {{0, 0, 0}, 1.0}})[0], 1.0);
    EXPECT_EQ(vanishing_scales(Balls{{{0.8, 0, 0}, 0.1}, {{0, 0, 0}, 1.0}})[0], 1.0);
    EXPECT_EQ(vanishing_scales(Balls{{{0, 0, 0}, 0.5}, {{0, 0, 0}, 1.0}})[0], 1.0);
    EXPECT_EQ(vanishing_scales(Balls{{{0, 0, 0}, 1.0}, {{0, 0, 0}, 1.0}}), (std::vector<double>{kNeverVanishes, 1.0}));
}

TEST(VanishingScales, BeyondTheLargestScaleBallsStay) {
    const Balls balls{{{3.0, 0, 0}, 0.5}, {{0, 0, 0}, 1.5}};
    EXPECT_EQ(vanishing_scales(balls, {.largest_scale = 2.9})[0], kNeverVanishes);
    expect_vanishes(vanishing_scales(balls, {.largest_scale = 3.1})[0], 3.0);
}

TEST(VanishingScales, EqualBallsNeverVanish) {
    EXPECT_EQ(vanishing_scales(Balls{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}}),
              (std::vector<double>{kNeverVanishes, kNeverVanishes}));
    EXPECT_EQ(vanishing_scales(Balls{{{0, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}}),
              (std::vector<double>{kNeverVanishes, kNeverVanishes}));
}

TEST(VanishingScales, Points) {
    // A point at distance d from the centre is in the ball when s r ≥ d.
    const std::vector<double> scales = vanishing_scales(Balls{{{3, 0, 0}, 0.0}, {{0, 0, 0}, 2.0}, {{0.5, 0, 0}, 0.0}});
    expect_vanishes(scales[0], 1.5);
    EXPECT_EQ(scales[2], 1.0);
}

TEST(VanishingScales, ManyPoints) {
    // A tree whose boxes are not all taken.
    Balls balls;
    for (int i = 0; i < 13; ++i) {
        balls.push_back({{0.1 * i, 0.01 * i * i, 0}, 0.0});
    }
    const std::vector<double> scales = vanishing_scales(balls);
    EXPECT_TRUE(std::ranges::all_of(scales, [](double s) { return s == kNeverVanishes; }));
}

TEST(VanishingScales, BallBetweenTwo) {
    // Radius 1 in the middle between two of radius 2 at distance 4: its equator is covered when the two spheres of
    // radius 2s meet in a circle of radius s: 4s² - 4 = ... of radius sqrt(4s² - 4) ≥ s.
    const std::vector<double> scales = vanishing_scales(Balls{{{0, 0, 0}, 1.0}, {{-2, 0, 0}, 2.0}, {{2, 0, 0}, 2.0}});
    expect_vanishes(scales[0], std::sqrt(4.0 / 3.0));
}

TEST(VanishingScales, BallThatFillsAVoid) {
    // Six larger balls around a void with a ball in it: they cover its sphere at s = 1, but its centre, at the distance
    // 1.1 of theirs, last.
    for (const double radius : {0.4, 0.6}) {
        Balls balls{{{0, 0, 0}, radius}};
        for (const double side : {-1.1, 1.1}) {
            balls.insert(balls.end(), {{{side, 0, 0}, 1.0}, {{0, side, 0}, 1.0}, {{0, 0, side}, 1.0}});
        }
        EXPECT_LT(covering_scale(balls, 0, radius / std::sqrt(3.0) * Point{1, 1, 1}), 1.0);  // the worst on the sphere
        expect_vanishes(vanishing_scales(balls)[0], 1.1);
    }
}

TEST(VanishingScales, BallOnACone) {
    // Along a cone of half angle 30° radii grow by sin 30° = 1/2 a length: each ball is covered at s = 2 by those
    // before it, and not earlier.
    Balls balls;
    for (int i = 0; i <= 100; ++i) {
        balls.push_back({{0.01 * i, 0, 0}, 1.0 - 0.005 * i});
    }
    const std::vector<double> scales = vanishing_scales(balls);
    EXPECT_EQ(scales[0], kNeverVanishes);
    for (int i = 1; i <= 100; ++i) {
        expect_vanishes(scales[i], 2.0);
    }
}

TEST(VanishingScales, RandomBallsAgreeWithSampling) {
    for (std::uint64_t seed = 1; seed <= 32; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        Balls balls = seed % 4 == 0   ? balls_of_all_sizes(random, 40)
                      : seed % 4 == 1 ? scattered_balls(random, 30, 1.0, 0.2, 0.6)
                      : seed % 4 == 2 ? balls_through_points(random, 40, 12)
                                      : balls_around_a_void(random, 30, 0.9);
        const std::vector<double> scales = vanishing_scales(balls);
        for (std::size_t i = 0; i < balls.size(); ++i) {
            const double sampled = sampled_scale(balls, i, random, 2000);
            if (sampled > 10.0) {
                EXPECT_EQ(scales[i], kNeverVanishes);
            } else {
                EXPECT_GE(scales[i], sampled * (1.0 - 1e-7)) << i;
                EXPECT_LE(std::min(10.0, scales[i]), sampled * 1.02) << i;
            }
        }
    }
}

TEST(VanishingScales, SurvivorsHaveTheSameUnion) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Balls balls = seed % 2 == 0 ? balls_of_all_sizes(random, 60) : scattered_balls(random, 60, 1, 0.1, 0.5);
        const std::vector<double> scales = vanishing_scales(balls);
        for (const double s : {1.0, 1.05, 1.2, 1.7, 3.0, 8.0}) {
            Balls survivors;
            for (std::size_t i = 0; i < balls.size(); ++i) {
                if (scales[i] > s) {
                    survivors.push_back(balls[i]);
                }
            }
            const BallUnion all(scaled(balls, s));
            const BallUnion few(scaled(survivors, s));
            std::vector<Point> points;
            for (const Ball& ball : balls) {
                for (int k = 0; k < 50; ++k) {
                    points.push_back(ball.center + s * (1.0 - 1e-6) * ball.radius * random_direction(random));
                }
            }
            EXPECT_EQ(std::ranges::count(few.inside(points), 1), std::ssize(points));
        }
    }
}

TEST(VanishingScales, SameForAnyNumberOfThreads) {
    Random random(7);
    const Balls balls = scattered_balls(random, 2000, 1.0, 0.02, 0.3);
    const std::vector<double> one = vanishing_scales(balls, {}, {.threads = 1});
    EXPECT_TRUE(same_bytes(one, vanishing_scales(balls, {}, {.threads = 3})));
}

TEST(VanishingScales, BadOptions) {
    const Balls balls{{{0, 0, 0}, 1.0}};
    EXPECT_THROW(vanishing_scales(balls, {.largest_scale = 0.9}), InvalidOption);
    EXPECT_THROW(vanishing_scales(balls, {.tolerance = 0.0}), InvalidOption);
    EXPECT_THROW(vanishing_scales(Balls{{{0, 0, 0}, -1.0}}), UnusableInput);
    EXPECT_TRUE(vanishing_scales({}).empty());
}

TEST(VanishingScales, ProgressAndCancellation) {
    Random random(7);
    const Balls balls = scattered_balls(random, 200, 1.0, 0.02, 0.3);
    expect_progress_and_cancellation([&](const Execution& execution) { vanishing_scales(balls, {}, execution); });
}

/// All levels of a filtration: nested, and of one topology.
void expect_filtration(const Filtration& filtration) {
    check(filtration);
    const Topology whole = topology(filtration.complex);
    std::vector<double> scales = filtration.vertex_scales;
    std::ranges::sort(scales);
    scales.erase(std::unique(scales.begin(), scales.end()), scales.end());
    const std::size_t step = scales.size() / 40 + 1;
    for (std::size_t i = 0; i < scales.size(); i += step) {
        if (scales[i] < kNeverVanishes) {
            for (const double scale : {std::nextafter(scales[i], 1.0), scales[i]}) {
                SCOPED_TRACE(scale);
                const MedialComplex level = cut(filtration, std::max(1.0, scale));
                expect_well_formed(level);
                EXPECT_EQ(topology(level), whole);
            }
        }
    }
}

/// The axis of a solid at s = 1.
MedialComplex axis_of(const TriangleMesh& mesh, double delta = 0.02) {
    ScaleAxisOptions options;
    options.delta = Length::relative(delta);
    options.scales = {1.0};
    return scale_axis(*mesh_solid(repair(mesh)), options).axes[0].complex;
}

/// A cylinder with round ends along x from 0 to 6 of radius 1, as balls are it, with a thorn on it: a ball of radius r
/// at the height h above the axis.
Filtration of_thorn(double h, double r) {
    std::vector<Point> vertices;
    for (int i = 0; i <= 24; ++i) {
        vertices.push_back({0.25 * i, 0, 0});
    }
    std::vector<std::array<Index, 2>> edges = chain_edges(25);
    for (int k = 1; k <= 4; ++k) {
        vertices.push_back({3.0, 0.25 * h * k, 0});
        edges.push_back({k == 1 ? 12 : 24 + k - 1, 24 + k});
    }
    MedialComplex complex = complex_by_hand(vertices, {}, {}, edges);
    complex.radii.assign(vertices.size(), 1.0);
    for (int k = 1; k <= 4; ++k) {
        complex.radii[24 + k] = 1.0 + 0.25 * k * (r - 1.0);
    }
    return filtration(complex);
}

TEST(Filtration, ThornOnACylinder) {
    // Alone, its tip is covered by the ball below it at s = h / (1 - r): radii fall linearly, and so are the others.
    const Filtration nested = of_thorn(1.0, 0.5);
    for (int k = 1; k <= 4; ++k) {
        expect_vanishes(nested.vertex_scales[24 + k], nested.ball_scales[28]);
        EXPECT_LE(nested.ball_scales[24 + k], 2.0 * (1.0 + kTolerance));
    }
    EXPECT_EQ(cut(nested, 1.0).vertices.size(), 29U);
    EXPECT_EQ(cut(nested, 2.01).vertices.size(), 25U);
    expect_filtration(nested);
    // The same thorn, but longer, stays longer.
    EXPECT_GT(of_thorn(1.2, 0.5).vertex_scales[28], nested.vertex_scales[28]);
}

TEST(Filtration, NothingVanishesBeforeItsBalls) {
    const Filtration nested = filtration(axis_of(box_mesh({0, 0, 0}, {3, 2, 1})));
    for (std::size_t v = 0; v < nested.vertex_scales.size(); ++v) {
        EXPECT_GE(nested.vertex_scales[v], nested.ball_scales[v]);
    }
    expect_filtration(nested);
}

TEST(Filtration, BoxLosesItsEdgesAtTheRootOfTwo) {
    // Radii in the sheets to edges of 90° grow by 1 / √2 a length, and along the seams to corners by 1 / √3: sheets
    // vanish at s = √2 at once, seams at √3, and what is left is the middle, where no ball is larger.
    const Filtration nested = filtration(axis_of(box_mesh({0, 0, 0}, {6, 4, 1})));
    const auto area_left = [&](double scale) {
        return static_cast<double>(cut(nested, scale).faces.size()) / static_cast<double>(nested.complex.faces.size());
    };
    EXPECT_GT(area_left(1.38), 0.95);
    EXPECT_LT(area_left(1.45), 0.9 * area_left(1.38));
    const MedialComplex middle = cut(nested, 2.0);
    double lowest = 1.0;
    double highest = 0.0;
    for (const Point& p : middle.vertices) {
        lowest = std::min(lowest, p.z);
        highest = std::max(highest, p.z);
    }
    EXPECT_GT(lowest, 0.4);
    EXPECT_LT(highest, 0.6);
    double area = 0.0;
    for (Index f = 0; f < static_cast<Index>(middle.faces.size()); ++f) {
        area += face_area(middle, f);
    }
    EXPECT_NEAR(area, 5.0 * 3.0, 0.01 * 15.0);
}

TEST(Filtration, VolumeIsThatOfTheBallsThatAreLeft) {
    // A ball of radius 1 with a thorn, a ball of radius 0.5 at the distance 1.2, whose volume is in closed form that of
    // the whole less a lens.
    const double d = 1.2;
    const auto volume = [](double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; };
    const double lens = std::numbers::pi * std::pow(1.0 + 0.5 - d, 2) *
                        (d * d + 2.0 * d * 0.5 - 3.0 * 0.25 + 2.0 * d + 6.0 * 0.5 - 3.0) / (12.0 * d);
    MedialComplex complex = complex_by_hand({{0, 0, 0}, {d, 0, 0}}, {}, {}, {{0, 1}});
    complex.radii = {1.0, 0.5};
    const Filtration nested = filtration(complex);
    const double vanishes = nested.vertex_scales[1];
    EXPECT_NEAR(vanishes, 2.4, 0.01);
    for (const FiltrationLevel& level : profile(nested, 10.0, 20)) {
        const double left = level.scale < vanishes ? volume(1.0) + volume(0.5) - lens : volume(1.0);
        EXPECT_NEAR(level.volume, left, 0.002 * left) << level.scale;
    }
    const auto box = filtration(axis_of(box_mesh({0, 0, 0}, {3, 2, 1})));
    EXPECT_NEAR(profile(box).front().volume, 6.0, 0.15);
}

TEST(Filtration, KnowsUpToWhichScale) {
    const Filtration nested = filtration(axis_of(torus_mesh(2.0, 0.6, 24, 12)), {.largest_scale = 2.0});
    EXPECT_FALSE(unknown_level(nested, 2.0));
    ASSERT_TRUE(unknown_level(nested, 2.1));
    EXPECT_EQ(unknown_level(nested, 2.1)->code, "filtration.unknown_level");
}

TEST(Filtration, TunnelsAndVoidsStay) {
    expect_filtration(filtration(axis_of(torus_mesh(2.0, 0.6, 24, 12))));
    const TriangleMesh shell = together({sphere_mesh({}, 2.0, 3), inside_out(sphere_mesh({}, 1.2, 3))});
    expect_filtration(filtration(axis_of(shell)));
    const Filtration two =
        filtration(axis_of(together({box_mesh({0, 0, 0}, {1, 2, 1}), box_mesh({5, 0, 0}, {5.1, 0.2, 0.1})})));
    expect_filtration(two);
    EXPECT_EQ(topology(cut(two, 10.0)).components, 2);  // the small one stays, as a point or a curve
}

TEST(Filtration, SameForAnyNumberOfThreads) {
    const MedialComplex axis = axis_of(torus_mesh(2.0, 0.6, 24, 12));
    const Filtration one = filtration(axis, {}, {.threads = 1});
    const Filtration three = filtration(axis, {}, {.threads = 3});
    EXPECT_TRUE(same_bytes(one.vertex_scales, three.vertex_scales));
    EXPECT_TRUE(same_bytes(one.edge_scales, three.edge_scales));
    EXPECT_TRUE(same_bytes(one.face_scales, three.face_scales));
}

using FiltrationFile = FolderTest;

TEST_F(FiltrationFile, WrittenAndReadAgain) {
    const Filtration nested = filtration(axis_of(torus_mesh(2.0, 0.6, 24, 12)), {.largest_scale = 12.5});
    ASSERT_GT(std::ranges::count_if(nested.edge_scales, [](double s) { return s == kNeverVanishes; }), 0);
    for (const bool has_polygons : {false, true}) {
        const std::filesystem::path file = path("nested.ply");
        write_filtration(file, nested, {}, has_polygons);
        EXPECT_TRUE(is_filtration(file));
        const Filtration read = read_filtration(file);
        EXPECT_TRUE(same_bytes(read.ball_scales, nested.ball_scales));
        EXPECT_TRUE(same_bytes(read.vertex_scales, nested.vertex_scales));
        EXPECT_TRUE(same_bytes(read.edge_scales, nested.edge_scales));
        EXPECT_TRUE(same_bytes(read.face_scales, nested.face_scales));
        EXPECT_EQ(read.largest_scale, 12.5);
        EXPECT_TRUE(same_bytes(cut(read, 1.5).edges, cut(nested, 1.5).edges));
        EXPECT_EQ(read_axis(file).faces.size(), nested.complex.faces.size());
    }
    write_filtration(path("nested.vtp"), nested);
    EXPECT_THROW(write_filtration(path("nested.ma"), nested), FileError);
    write_axis(path("axis.ply"), nested.complex);
    EXPECT_FALSE(is_filtration(path("axis.ply")));
    EXPECT_THROW(read_filtration(path("axis.ply")), FileError);
}

TEST(Filtration, BadOnes) {
    Filtration nested = filtration(axis_of(torus_mesh(2.0, 0.6, 24, 12)));
    EXPECT_THROW(cut(nested, 0.5), InvalidOption);
    nested.edge_scales[0] = 0.5;
    EXPECT_THROW(cut(nested, 1.5), UnusableInput);
    nested.edge_scales[0] = 1e300;
    nested.vertex_scales[nested.complex.edges[0][0]] = 2.0;
    EXPECT_THROW(check(nested), UnusableInput);
    nested.edge_scales.pop_back();
    EXPECT_THROW(check(nested), UnusableInput);
}

TEST(Filtration, ProgressAndCancellation) {
    const MedialComplex axis = axis_of(torus_mesh(2.0, 0.6, 24, 12));
    expect_progress_and_cancellation([&](const Execution& execution) { filtration(axis, {}, execution); });
}

}  // namespace
}  // namespace scaleaxis
