// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/balls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string>

#include "balls/dual_complex.hpp"
#include "complexes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/sampling.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

struct Named {
    std::string name;
    std::unique_ptr<ImplicitSolid> solid;
    double tolerance;
};

std::vector<Named> solids() {
    std::vector<Named> result;
    const auto add = [&](const std::string& name, ImplicitSolid* solid, double tolerance) {
        result.push_back({name, std::unique_ptr<ImplicitSolid>(solid), tolerance});
    };
    add("torus", new ImplicitSolid(torus_solid(1.0, 0.4)), 0.1);
    add("ellipsoid", new ImplicitSolid(ellipsoid_solid(1.0, 0.7, 0.4)), 0.08);
    add("shell", new ImplicitSolid(shell_solid(1.0, 0.6)), 0.12);
    add("box", new ImplicitSolid(box_solid({1.0, 0.7, 0.4})), 0.1);
    add("cylinder", new ImplicitSolid(cylinder_solid(0.5, 1.0)), 0.1);
    add("dumbbell", new ImplicitSolid(dumbbell_solid(0.5, 1.0, 0.2)), 0.08);
    add("lens", new ImplicitSolid(lens_solid(1.0, 0.5)), 0.08);
    return result;
}

// The inner polar balls alone, in the plainest way.
std::vector<Ball> poles(const Samples& samples) {
    std::set<std::size_t> chosen;
    for (std::size_t v = 0; v < samples.points.size(); ++v) {
        std::size_t best = samples.tetrahedra.size();
        for (std::size_t t = 0; t < samples.tetrahedra.size(); ++t) {
            const auto& corners = samples.tetrahedra[t];
            if (samples.inside[t] != 0 && std::count(corners.begin(), corners.end(), static_cast<Index>(v)) > 0 &&
                (best == samples.tetrahedra.size() || samples.radii[t] > samples.radii[best])) {
                best = t;
            }
        }
        if (best < samples.tetrahedra.size()) {
            chosen.insert(best);
        }
    }
    std::vector<Ball> result;
    for (const std::size_t t : chosen) {
        result.push_back({samples.centers[t], samples.radii[t]});
    }
    return result;
}

bool has_ball(const std::vector<Ball>& balls, const Ball& ball, double tolerance) {
    return std::any_of(balls.begin(), balls.end(), [&](const Ball& other) {
        return distance(other.center, ball.center) <= tolerance && std::abs(other.radius - ball.radius) <= tolerance;
    });
}

TEST(InnerBalls, OfABallAreTheBall) {
    for (const double tolerance : {0.5, 0.2, 0.05}) {
        const std::vector<Ball> balls =
            inner_balls(sample(ball_solid(1.0), {.tolerance = tolerance, .sizing = Sizing::kUniform}));
        ASSERT_EQ(balls.size(), 1U) << "coinciding balls are merged";
        EXPECT_LT(norm(balls[0].center), 1e-6);
        EXPECT_NEAR(balls[0].radius, 1.0, 1e-6);
    }
}

TEST(InnerBalls, HoldThePoleOfEverySample) {
    for (const auto& [name, solid, tolerance] : solids()) {
        const Samples samples = sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
        const std::vector<Ball> balls = inner_balls(samples);
        const std::vector<Ball> expected = poles(samples);
        for (const Ball& pole : expected) {
            EXPECT_TRUE(has_ball(balls, pole, 1e-5 * tolerance)) << name;
        }
        // The further ones are few.
        EXPECT_LT(static_cast<double>(balls.size()), 1.2 * static_cast<double>(expected.size()) + 5.0) << name;
    }
}

// A Voronoi ball has no sample within, so that it protrudes by as little as the samples are dense: by the height of a
// cap of the tolerance's width where the surface is smooth, and never by more than the tolerance.
TEST(InnerBalls, AreEmptyOfSamplesAndFitIntoTheSolid) {
    for (const auto& [name, solid, tolerance] : solids()) {
        const Samples samples = sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
        const bool is_smooth = name == "torus" || name == "shell";
        for (const Ball& ball : inner_balls(samples)) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const Point& p : samples.points) {
                nearest = std::min(nearest, distance(p, ball.center));
            }
            ASSERT_NEAR(nearest, ball.radius, 1e-9) << name;
            ASSERT_TRUE(solid->inside(ball.center)) << name;
            if (name != "ellipsoid") {  // whose function is no distance
                const double cap = 0.8 * tolerance * tolerance / ball.radius;
                ASSERT_LT(ball.radius + solid->value(ball.center), is_smooth ? cap : tolerance) << name;
            }
        }
    }
}

TEST(InnerBalls, HaveNoTwoTheSame) {
    for (const auto& [name, solid, tolerance] : solids()) {
        const std::vector<Ball> balls =
            inner_balls(sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform}));
        for (std::size_t i = 0; i < balls.size(); ++i) {
            for (std::size_t j = i + 1; j < balls.size(); ++j) {
                ASSERT_FALSE(distance(balls[i].center, balls[j].center) < 1e-7 * tolerance &&
                             std::abs(balls[i].radius - balls[j].radius) < 1e-7 * tolerance)
                    << name << ' ' << i << ' ' << j;
            }
        }
    }
}

TEST(InnerBalls, HaveTheTopologyOfTheSolid) {
    for (const auto& [name, solid, tolerance] : solids()) {
        for (const double factor : {1.0, 0.5}) {
            for (std::uint64_t seed = 1; seed <= 3; ++seed) {
                const Samples samples =
                    sample(*solid, {.tolerance = factor * tolerance, .sizing = Sizing::kUniform, .seed = seed});
                const std::vector<Ball> balls = perturbed(inner_balls(samples), 1e-4, seed);
                EXPECT_EQ(dual_complex(balls).topology, solid->topology().value())
                    << name << ", tolerance " << factor * tolerance << ", seed " << seed;
            }
        }
    }
}

// Where a plate is as thin as the samples are apart, the poles alone leave holes through it. The further balls close
// them, in the thinnest plates after a little growing.
TEST(InnerBalls, CloseTheHolesThatPolesLeave) {
    const double tolerance = 0.06;
    for (const auto& [thickness, scale] : {std::pair{2.0, 1.0}, std::pair{1.0, 1.1}}) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const ImplicitSolid plate = box_solid({1.0, 1.0, 0.5 * thickness * tolerance});
            const Samples samples = sample(plate, {.tolerance = tolerance, .sizing = Sizing::kUniform, .seed = seed});
            const auto topology_of = [&, grow = scale](const std::vector<Ball>& balls) {
                return dual_complex(perturbed(scaled(balls, grow), 1e-4, 1)).topology;
            };
            EXPECT_EQ(topology_of(inner_balls(samples)), known_topology(1, 0, 0))
                << "thickness " << thickness << " tolerances, seed " << seed;
            EXPECT_NE(topology_of(poles(samples)), known_topology(1, 0, 0)) << "too easy: the poles would do";
        }
    }
}

TEST(InnerBalls, AreTheSameForAnyNumberOfThreads) {
    const Samples samples = sample(torus_solid(1.0, 0.4), {.tolerance = 0.04, .sizing = Sizing::kUniform});
    const std::vector<Ball> balls = inner_balls(samples, {.threads = 1});
    ASSERT_GT(samples.tetrahedra.size(), 2 * 4096U);
    for (const int threads : {1, 2, 4}) {
        EXPECT_TRUE(same_bytes(inner_balls(samples, {.threads = threads}), balls)) << threads;
    }
    EXPECT_THROW(inner_balls(samples, {.progress = [](std::string_view, double) { return false; }}), Cancelled);
}

TEST(Balls, Scale) {
    const Balls balls{{{1.0, 2.0, 3.0}, 0.5}, {{-1.0, 0.0, 0.0}, 2.0}};
    EXPECT_EQ(scaled(balls, 1.5), (Balls{{{1.0, 2.0, 3.0}, 0.75}, {{-1.0, 0.0, 0.0}, 3.0}}));
    EXPECT_TRUE(scaled({}, 2.0).empty());
    for (const double factor : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_THROW(scaled(balls, factor), InvalidOption) << factor;
    }
}

TEST(Balls, HaveABox) {
    const Box box = bounds(Balls{{{1.0, 2.0, 3.0}, 0.5}, {{-1.0, 0.0, 0.0}, 2.0}});
    EXPECT_EQ(box.min, (Point{-3.0, -2.0, -2.0}));
    EXPECT_EQ(box.max, (Point{1.5, 2.5, 3.5}));
    EXPECT_TRUE(bounds({}).is_empty());
}

TEST(Balls, MoveByAPartOfTheirRadius) {
    Random random(1);
    const Balls balls = scattered_balls(random, 1000, 1.0, 0.01, 1.0);
    const Balls moved_once = perturbed(balls, 0.01, 7);
    Point mean;
    double farthest = 0.0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        EXPECT_EQ(moved_once[i].radius, balls[i].radius);
        const Point by = (1.0 / balls[i].radius) * (moved_once[i].center - balls[i].center);
        EXPECT_LE(norm(by), 0.01 * (1.0 + 1e-9));
        EXPECT_GT(norm(by), 0.0);
        farthest = std::max(farthest, norm(by));
        mean = mean + 1e-3 * by;
    }
    EXPECT_GT(farthest, 0.008);
    EXPECT_LT(norm(mean), 0.001) << "no direction is preferred";
    EXPECT_TRUE(same_bytes(perturbed(balls, 0.01, 7), moved_once));
    EXPECT_FALSE(same_bytes(perturbed(balls, 0.01, 8), moved_once));
    EXPECT_TRUE(same_bytes(perturbed(balls, 0.0, 7), balls));
    for (const double amount : {-1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_THROW(perturbed(balls, amount, 7), InvalidOption) << amount;
    }
    // A ball's way depends on its position in the array alone.
    const Balls first(balls.begin(), balls.begin() + 10);
    EXPECT_TRUE(same_bytes(perturbed(first, 0.01, 7), Balls(moved_once.begin(), moved_once.begin() + 10)));
}

TEST(Balls, AreMergedWhereTheyCoincide) {
    const Ball a{{0.0, 0.0, 0.0}, 1.0};
    const Ball b{{1.0, 0.0, 0.0}, 1.0};
    const Ball beside_b{{1.0 + 1e-11, 0.0, 0.0}, 1.0 - 1e-11};
    const Ball larger{{1.0, 0.0, 0.0}, 1.001};
    EXPECT_EQ(distinct_balls(Balls{a, b, a, beside_b, larger, b}), (Balls{a, b, larger}));
    EXPECT_TRUE(distinct_balls({}).empty());

    // A row of balls closer than the tolerance does not become one.
    Balls row;
    for (int i = 0; i < 1000; ++i) {
        row.push_back({{1e-10 * i, 0.0, 0.0}, 1.0});
    }
    row.push_back({{0.0, 0.0, 50.0}, 1.0});
    const Balls kept = distinct_balls(row);
    EXPECT_GT(kept.size(), 2U);
    EXPECT_LT(kept.size(), 20U);
}

TEST(Balls, AreMergedByTheirOwnSizeWhateverLiesElsewhere) {
    const Balls balls{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}, {{1e-11, 0, 0}, 1.0}, {{1e10, 0, 0}, 1.0}, {{0, 0, 0}, 1e12}};
    EXPECT_EQ(distinct_balls(balls), (Balls{balls[0], balls[1], balls[3], balls[4]}));
    EXPECT_EQ(distinct_positions(balls), (std::vector<Index>{0, 1, 3, 4}));
    // Far from the origin coordinates that differ by rounding alone are the same.
    const Balls far{{{1e8, 0, 0}, 1e-3}, {{std::nextafter(1e8, HUGE_VAL), 0, 0}, 1e-3}, {{1e8 + 1e-5, 0, 0}, 1e-3}};
    EXPECT_EQ(distinct_balls(far), (Balls{far[0], far[2]}));
}

TEST(Balls, AreRejectedWhereTheyAreNone) {
    const double nan = std::nan("");
    const Ball good{{0.0, 0.0, 0.0}, 1.0};
    for (const Ball& bad : {Ball{{nan, 0, 0}, 1}, Ball{{0, HUGE_VAL, 0}, 1}, Ball{{0, 0, -HUGE_VAL}, 1},
                            Ball{{0, 0, 0}, nan}, Ball{{0, 0, 0}, HUGE_VAL}, Ball{{0, 0, 0}, 0}, Ball{{0, 0, 0}, -1}}) {
        try {
            distinct_balls(Balls{good, good, bad, good});
            ADD_FAILURE() << "taken for a ball";
        } catch (const UnusableInput& error) {
            EXPECT_NE(std::string(error.what()).find("ball 3 of"), std::string::npos) << error.what();
            EXPECT_EQ(error.diagnostic().element, "ball");
            EXPECT_EQ(error.diagnostic().index, 3);
        }
    }
}

}  // namespace
}  // namespace scaleaxis
