// SPDX-License-Identifier: Apache-2.0
// A union of balls as an object: what it answers, that it builds its parts once, and from any thread.
#include "scaleaxis/ball_union.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "base/built_once.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/field.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/smoothing.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

std::vector<Point> points_around(Random& random, int count, double size) {
    std::vector<Point> points(static_cast<std::size_t>(count));
    std::ranges::generate(points, [&] { return random_point(random, size); });
    return points;
}

TEST(BallUnion, AnswersAreThoseOfBruteForce) {
    Random random(61);
    for (const Balls& balls : {chain_of_balls(1, 0.0, 1.0), ring_of_balls(12, 1.0, 0.4), balls_of_all_sizes(random, 40),
                               scattered_balls(random, 40, 1.0, 0.1, 0.5)}) {
        const UnionOfBalls truth(balls);
        const BallUnion united(balls);
        const std::vector<Point> points = points_around(random, 300, 1.5);
        const std::vector<NearestBall> nearest = united.nearest_balls(points);
        const std::vector<double> signed_distances = united.signed_distances(points);
        const std::vector<std::uint8_t> inside = united.inside(points);
        const std::vector<double> to_boundary = united.distances_to_boundary(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            double least = HUGE_VAL;
            for (const auto& [center, radius] : balls) {
                least = std::min(least, distance(points[i], center) - radius);
            }
            ASSERT_EQ(signed_distances[i], least);
            ASSERT_EQ(nearest[i].distance, least);
            ASSERT_EQ(inside[i] != 0, truth.contains(points[i]));
            ASSERT_NEAR(to_boundary[i], truth.boundary_near(points[i]).first, 1e-6);
            ASSERT_LE(std::abs(signed_distances[i]), to_boundary[i] + 1e-8);
        }
    }
}

TEST(BallUnion, NumbersBallsAsGivenAlsoWhereSomeCoincide) {
    Random random(62);
    const Balls distinct = scattered_balls(random, 30, 1.0, 0.2, 0.5);
    const BallUnion plain(distinct);
    Balls repeated;  // every ball twice: at 2 i and 2 i + 1
    for (const Ball& ball : distinct) {
        repeated.push_back(ball);
        repeated.push_back(ball);
    }
    const BallUnion united(repeated);
    EXPECT_EQ(united.balls().size(), 2 * distinct.size());
    EXPECT_EQ(united.topology(), plain.topology());
    const BoundaryVertices vertices = united.boundary_vertices();
    const BoundaryVertices expected = plain.boundary_vertices();
    ASSERT_GT(vertices.points.size(), 0U);
    EXPECT_EQ(vertices.points, expected.points);
    for (std::size_t v = 0; v < vertices.points.size(); ++v) {
        for (int k = 0; k < 3; ++k) {
            ASSERT_EQ(vertices.balls[v][k], 2 * expected.balls[v][k]);
            const Ball& ball = united.balls()[vertices.balls[v][k]];
            ASSERT_NEAR(distance(vertices.points[v], ball.center), ball.radius, 1e-6);
        }
    }
    const IndexLists neighbors = united.neighbors();
    ASSERT_EQ(neighbors.size(), repeated.size());
    for (std::size_t i = 0; i < distinct.size(); ++i) {
        ASSERT_EQ(neighbors[2 * i].size(), plain.neighbors()[i].size());
        for (std::size_t k = 0; k < neighbors[2 * i].size(); ++k) {
            ASSERT_EQ(neighbors[2 * i][k], 2 * plain.neighbors()[i][k]);
        }
        ASSERT_TRUE(neighbors[2 * i + 1].empty());
    }
}

TEST(BallUnion, MedialAxisOfTheUnionIsThatOfItsBalls) {
    Random random(63);
    for (const Balls& balls : {chain_of_balls(1, 0.0, 1.0), ring_of_balls(12, 1.0, 0.4), grid_of_balls(3, 3, 3, 0.7),
                               scattered_balls(random, 40, 1.0, 0.1, 0.5), balls_around_a_void(random, 60, 0.6)}) {
        const BallUnion united(balls);
        const MedialAxis axis = medial_axis(united);
        EXPECT_EQ(axis.statistics.dual_complex, united.topology());
        EXPECT_TRUE(agree(axis.statistics.medial_complex, united.topology()));
        EXPECT_EQ(axis.complex.boundary_vertices, united.boundary_vertices().points);
        const std::vector<double> depths = axis.ball_union.distances_to_boundary(axis.complex.vertices);
        for (std::size_t v = 0; v < depths.size(); ++v) {
            ASSERT_NEAR(axis.complex.radii[v], depths[v], 1e-6);
            if (const Index ball = axis.complex.vertex_origins[v].ball; ball != kNone) {
                ASSERT_NEAR(distance(axis.complex.vertices[v], balls[ball].center), 0.0, 1e-8);
            }
        }
    }
}

TEST(BallUnion, AnswersDoNotDependOnWhatWasAskedBeforeNorOnThreads) {
    Random random(64);
    const Balls balls = scattered_balls(random, 2000, 1.0, 0.05, 0.1);
    const std::vector<Point> points = points_around(random, 3000, 1.2);
    const BallUnion first(balls);
    const std::vector<double> expected = first.distances_to_boundary(points, {.threads = 1});
    const BallUnion second(balls);
    second.topology();
    second.nearest_balls(points);
    const BallUnion copy = second;
    EXPECT_EQ(copy.distances_to_boundary(points, {.threads = 3}), expected);
    EXPECT_EQ(&copy.data(), &second.data());
    // Many threads ask a new one at once.
    const BallUnion third(balls);
    std::vector<std::vector<double>> found(4);
    std::vector<std::thread> threads;
    for (std::vector<double>& result : found) {
        threads.emplace_back([&] { result = third.distances_to_boundary(points, {.threads = 2}); });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    for (const std::vector<double>& result : found) {
        EXPECT_EQ(result, expected);
    }
}

TEST(BallUnion, MayBeAskedFromWithinAParallelLoop) {
    Random random(65);
    const BallUnion united(scattered_balls(random, 3000, 1.0, 0.05, 0.1));
    std::atomic<int> answers = 0;
    tbb::parallel_for(0, 64, [&](int i) {
        const Point p{0.01 * i, 0.0, 0.0};
        answers += static_cast<int>(united.distances_to_boundary(std::span(&p, 1)).size());
    });
    EXPECT_EQ(answers, 64);
}

TEST(BallUnion, CanBeAskedAgainAfterACancelledCall) {
    Random random(66);
    const Balls balls = scattered_balls(random, 3000, 1.0, 0.05, 0.1);
    const BallUnion united(balls);
    std::stop_source stop;
    stop.request_stop();
    const Execution cancelled{.threads = 2, .cancel = stop.get_token()};
    EXPECT_THROW(united.topology(cancelled), Cancelled);
    EXPECT_THROW(medial_axis(united, {}, cancelled), Cancelled);
    EXPECT_EQ(united.topology(), BallUnion(balls).topology());
}

TEST(BallUnion, RefusesWhatIsNone) {
    const std::vector<Point> points{{0, 0, 0}};
    EXPECT_THROW(BallUnion(Balls{}), UnusableInput);
    EXPECT_THROW(BallUnion({{{0, 0, 0}, -1.0}}), UnusableInput);
    EXPECT_THROW(BallUnion({{{0, 0, std::nan("")}, 1.0}}), UnusableInput);
    EXPECT_TRUE(BallUnion().balls().empty());
    EXPECT_TRUE(BallUnion().bounds().is_empty());
    EXPECT_THROW(BallUnion().topology(), UnusableInput);
    EXPECT_THROW(BallUnion().inside(points), UnusableInput);
    EXPECT_THROW(medial_axis(BallUnion()), UnusableInput);
    EXPECT_THROW(union_solid(BallUnion()), UnusableInput);
}

TEST(BallUnion, RefusesSizesThatCannotBeComputedWith) {
    const auto code = [](const Balls& balls) -> std::string {
        std::string codes;
        for (const auto& make :
             {std::function<void()>([&] { BallUnion{balls}; }), std::function<void()>([&] { medial_axis(balls); }),
              std::function<void()>([&] { union_solid(balls); })}) {
            try {
                make();
                codes += "none ";
            } catch (const UnusableInput& error) {
                codes += error.diagnostic().code + ' ';
            }
        }
        return codes;
    };
    EXPECT_EQ(code({{{0, 1e16, 0}, 0.4}}), "size.too_far size.too_far size.too_far ");
    EXPECT_EQ(code({{{1e14, 0, 0}, 1.0}, {{1e14 + 1.0, 0, 0}, 1.0}}), "size.too_far size.too_far size.too_far ");
    EXPECT_EQ(code({{{0, 0, 0}, 1e-200}, {{1e-200, 0, 0}, 1e-200}}), "size.too_small size.too_small size.too_small ");
    EXPECT_EQ(code({{{0, 0, 0}, 1e-170}}), "size.too_small size.too_small size.too_small ");
    EXPECT_EQ(code({{{0, 0, 0}, 5e17}, {{5e17, 0, 0}, 5e17}}), "size.too_large size.too_large size.too_large ");
    EXPECT_EQ(code({{{0, 0, 0}, 1.0}, {{1e20, 0, 0}, 1.0}}), "balls.not_finite balls.not_finite balls.not_finite ");
    EXPECT_EQ(code({{{0, 0, 0}, -1.0}}), "balls.radius balls.radius balls.radius ");
    EXPECT_EQ(code({}), "balls.none balls.none balls.none ");
    EXPECT_EQ(code({{{0, 0, 0}, 1e-30}, {{1e-30, 0, 0}, 1e-30}}), "none none none ");
    EXPECT_EQ(code({{{1e6, 0, 0}, 1.0}, {{1e6, 1, 0}, 1e-20}}), "none none none ") << "one small ball is no fault";
}

TEST(BallUnion, ProgressOfAllThatTakesOneEndsAtOne) {
    const Balls balls = ring_of_balls(12, 1.0, 0.4);
    const BallUnion united(balls);
    const std::vector<Point> points{{0, 0, 0}};
    const Samples samples = sample(*union_solid(united), {.tolerance = 0.2, .sizing = Sizing::kUniform});
    const MedialAxis axis = medial_axis(balls);
    using Call = std::function<void(const Execution&)>;
    const std::vector<std::pair<std::string, Call>> calls{
        {"topology", [&](const Execution& e) { united.topology(e); }},
        {"inside", [&](const Execution& e) { united.inside(points, e); }},
        {"distances", [&](const Execution& e) { united.distances_to_boundary(points, e); }},
        {"solid", [&](const Execution& e) { union_solid(united, e); }},
        {"inner balls", [&](const Execution& e) { inner_balls(samples, e); }},
        {"axis of balls", [&](const Execution& e) { medial_axis(balls, {}, e); }},
        {"axis of the union", [&](const Execution& e) { medial_axis(united, {}, e); }},
        {"smooth", [&](const Execution& e) { smooth(axis.complex, axis.ball_union, {.rounds = 2}, e); }},
        {"smooth not at all", [&](const Execution& e) { smooth(axis.complex, axis.ball_union, {}, e); }},
        {"field", [&](const Execution& e) { signed_distance_image(united, 16, e); }},
        {"mesh", [&](const Execution& e) { boundary_mesh(samples, e); }},
        {"distance", [&](const Execution& e) { surface_distance(united, united, {.spacing = 0.3}, e); }},
    };
    for (const auto& [name, call] : calls) {
        std::vector<double> fractions;
        call({.threads = 1, .progress = [&](std::string_view, double fraction) {
                  fractions.push_back(fraction);
                  return true;
              }});
        ASSERT_FALSE(fractions.empty()) << name;
        EXPECT_EQ(fractions.back(), 1.0) << name;
        EXPECT_TRUE(std::ranges::is_sorted(fractions)) << name;
        EXPECT_THROW(call({.progress = [](std::string_view, double) { return false; }}), Cancelled) << name;
    }
}

TEST(BuiltOnce, BuildsOnceAndAgainAfterAnException) {
    BuiltOnce<int> value;
    EXPECT_THROW(value.get([]() -> int { throw Cancelled(); }), Cancelled);
    EXPECT_EQ(value.get([] { return 7; }), 7);
    EXPECT_EQ(value.get([] { return 8; }), 7);
    EXPECT_EQ(BuiltOnce<int>(5).get([] { return 6; }), 5);
}

}  // namespace
}  // namespace scaleaxis
