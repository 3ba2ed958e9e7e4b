// SPDX-License-Identifier: Apache-2.0
// A union of balls as a shape, against brute force over all balls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/solid.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

// The shape brings the balls into general position by moving and growing them by a billionth of their radii.
constexpr double kAccuracy = 1e-8;

double signed_distance(const Balls& balls, const Point& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Ball& ball : balls) {
        least = std::min(least, distance(p, ball.center) - ball.radius);
    }
    return least;
}

// All parameters along a segment where it enters or leaves the union, by sorting the ends of the parts that the balls
// cover.
std::vector<double> boundary_parameters(const Balls& balls, const Point& a, const Point& b) {
    const Point d = b - a;
    std::vector<double> ends;
    for (const Ball& ball : balls) {
        const double half = dot(d, a - ball.center);
        const double root =
            half * half - squared_norm(d) * (squared_distance(a, ball.center) - ball.radius * ball.radius);
        if (root > 0.0) {
            ends.push_back((-half - std::sqrt(root)) / squared_norm(d));
            ends.push_back((-half + std::sqrt(root)) / squared_norm(d));
        }
    }
    std::erase_if(ends,
                  [&](double t) { return t <= 0.0 || t >= 1.0 || signed_distance(balls, a + t * d) < -kAccuracy; });
    std::sort(ends.begin(), ends.end());
    return ends;
}

struct Family {
    std::string name;
    Balls balls;
};

std::vector<Family> families(Random& random) {
    return {{"one", {{{0.3, 0.2, 0.1}, 0.7}}},
            {"two", chain_of_balls(2, 1.0, 0.7)},
            {"apart", chain_of_balls(2, 3.0, 1.0)},
            {"tangent", chain_of_balls(3, 2.0, 1.0)},
            {"nested", {{{0, 0, 0}, 1.0}, {{0.1, 0, 0}, 0.3}, {{0, 0, 0}, 1.0}}},
            {"chain", chain_of_balls(40, 0.1, 0.3)},
            {"grid", grid_of_balls(4, 4, 4, 0.6)},
            {"ring", ring_of_balls(24, 1.0, 0.3)},
            {"scattered", scattered_balls(random, 200, 1.0, 0.05, 0.3)},
            {"all sizes", balls_of_all_sizes(random, 300)},
            {"void", balls_around_a_void(random, 150, 0.5)},
            {"through points", balls_through_points(random, 100, 10)},
            {"flat", flat_balls(random, 60)},
            {"aligned", aligned_balls(random, 60)}};
}

TEST(UnionSolid, InsideIsWhereSomeBallIs) {
    constexpr std::uint64_t kSeed = 11;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (const auto& [name, balls] : families(random)) {
        SCOPED_TRACE(name);
        const auto shape = union_solid(balls);
        int inside = 0;
        for (int i = 0; i < 3000; ++i) {
            const Point p = random_point(random, 1.5);
            const double truth = signed_distance(balls, p);
            if (std::abs(truth) > kAccuracy) {
                ASSERT_EQ(shape->inside(p), truth < 0.0) << p.x << ' ' << p.y << ' ' << p.z;
                inside += truth < 0.0 ? 1 : 0;
            }
        }
        EXPECT_GT(inside, 0);
        EXPECT_FALSE(shape->inside({1e9, -1e9, 1e9}));
    }
}

TEST(UnionSolid, CrossingIsTheBoundaryPointFarthestFromTheReference) {
    constexpr std::uint64_t kSeed = 12;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    int several = 0;
    for (const auto& [name, balls] : families(random)) {
        SCOPED_TRACE(name);
        const auto shape = union_solid(balls);
        int crossed = 0;
        for (int i = 0; i < 3000; ++i) {
            const Point a = random_point(random, 1.5);
            const Point b = i % 3 == 0 ? a + 10.0 * random_direction(random) : random_point(random, 1.5);
            const Point reference = random_point(random, 1.5);
            const double at_a = signed_distance(balls, a);
            const double at_b = signed_distance(balls, b);
            if (std::min(std::abs(at_a), std::abs(at_b)) < kAccuracy) {
                continue;
            }
            const std::optional<Point> crossing = shape->crossing(a, b, reference);
            if (at_a > 0.0 || at_b < 0.0) {
                EXPECT_FALSE(crossing.has_value());
                continue;
            }
            const std::vector<double> truth = boundary_parameters(balls, a, b);
            ASSERT_FALSE(truth.empty());
            double farthest = 0.0;
            for (const double t : truth) {
                farthest = std::max(farthest, distance(a + t * (b - a), reference));
            }
            ASSERT_TRUE(crossing.has_value());
            // Where the segment touches a sphere, a tiny change of the ball moves the crossing much more.
            EXPECT_NEAR(distance(*crossing, reference), farthest, 1e-3);
            EXPECT_NEAR(signed_distance(balls, *crossing), 0.0, kAccuracy);
            ++crossed;
            several += truth.size() > 2 ? 1 : 0;
        }
        EXPECT_GT(crossed, 0);
    }
    EXPECT_GT(several, 100);
}

TEST(UnionSolid, SeedsAreDenseOnTheBoundaryAndNowhereElse) {
    constexpr std::uint64_t kSeed = 13;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (const auto& [name, balls] : families(random)) {
        SCOPED_TRACE(name);
        constexpr double kSpacing = 0.08;
        const auto shape = union_solid(balls);
        const std::vector<Point> seeds = shape->seeds(kSpacing, 5, {});
        ASSERT_FALSE(seeds.empty());
        for (const Point& p : seeds) {
            ASSERT_NEAR(signed_distance(balls, p), 0.0, kAccuracy);
        }
        double farthest = 0.0;
        for (int i = 0; i < 500; ++i) {
            const Ball& ball = balls[random() % balls.size()];
            const Point p = ball.center + ball.radius * random_direction(random);
            if (signed_distance(balls, p) > -kAccuracy) {
                double nearest = std::numeric_limits<double>::infinity();
                for (const Point& q : seeds) {
                    nearest = std::min(nearest, distance(p, q));
                }
                farthest = std::max(farthest, nearest);
            }
        }
        EXPECT_LT(farthest, 2.0 * kSpacing);
        EXPECT_EQ(shape->seeds(kSpacing, 5, {.threads = 1}), seeds);
        EXPECT_NE(shape->seeds(kSpacing, 6, {}), seeds);
    }
}

TEST(UnionSolid, EveryComponentHasSeedsHoweverSmall) {
    Balls balls = chain_of_balls(5, 0.5, 0.6);
    balls.push_back({{0.0, 3.0, 0.0}, 1e-6});
    balls.push_back({{0.0, 0.0, 4.0}, 1e-3});
    balls.push_back({{0.0, 0.001, 4.0}, 1e-3});
    const std::vector<Point> seeds = union_solid(balls)->seeds(0.1, 1, {});
    const auto seeds_near = [&](const Point& p, double radius) {
        return std::count_if(seeds.begin(), seeds.end(), [&](const Point& q) { return distance(p, q) < radius; });
    };
    EXPECT_GE(seeds_near({0.0, 3.0, 0.0}, 2e-6), 4);
    EXPECT_GE(seeds_near({0.0, 0.0, 4.0}, 3e-3), 4);
}

TEST(UnionSolid, BoundsAndTopologyAreThoseOfTheUnion) {
    Random random(14);
    const auto check = [](const std::string& name, const Balls& balls, const Topology& topology) {
        SCOPED_TRACE(name);
        const auto shape = union_solid(balls);
        ASSERT_TRUE(shape->topology().has_value());
        EXPECT_EQ(*shape->topology(), topology);
    };
    check("one", {{{0, 0, 0}, 1.0}}, known_topology(1, 0, 0));
    check("two", chain_of_balls(2, 1.0, 0.7), known_topology(1, 0, 0));
    check("apart", chain_of_balls(3, 2.1, 1.0), known_topology(3, 0, 0));
    check("tangent", chain_of_balls(3, 2.0, 1.0), known_topology(1, 0, 0));
    check("nested", {{{0, 0, 0}, 1.0}, {{0.1, 0, 0}, 0.3}}, known_topology(1, 0, 0));
    check("ring", ring_of_balls(24, 1.0, 0.3), known_topology(1, 1, 0));
    check("shell", balls_around_a_void(random, 400, 0.4), known_topology(1, 0, 1));
    const Box box = union_solid(chain_of_balls(3, 2.0, 1.0))->bounds();
    EXPECT_NEAR(box.min.x, -1.0, kAccuracy);
    EXPECT_NEAR(box.max.x, 5.0, kAccuracy);
    EXPECT_NEAR(box.max.y, 1.0, kAccuracy);
    EXPECT_NEAR(box.min.z, -1.0, kAccuracy);
}

TEST(UnionSolid, WhatIsNoBallIsAnErrorThatNamesIt) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto message = [](const Balls& balls) -> std::string {
        try {
            union_solid(balls);
        } catch (const UnusableInput& error) {
            return error.what();
        }
        return "";
    };
    const Ball good{{0, 0, 0}, 1.0};
    EXPECT_NE(message({}).find("no balls"), std::string::npos);
    EXPECT_NE(message({good, {{0, 0, 0}, -1.0}}).find("ball 2 of 2"), std::string::npos);
    EXPECT_NE(message({good, good, {{0, 0, 0}, nan}}).find("ball 3 of 3"), std::string::npos);
    EXPECT_NE(message({{{nan, 0, 0}, 1.0}}).find("ball 1 of 1"), std::string::npos);
    EXPECT_NE(message({{{0, 0, 0}, 0.0}}).find("ball 1 of 1"), std::string::npos);
    EXPECT_THROW(union_solid({good})->seeds(1e-6, 1, {}), InvalidOption);
}

}  // namespace
}  // namespace scaleaxis
