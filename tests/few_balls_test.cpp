// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/few_balls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "base/random.hpp"
#include "executions.hpp"
#include "meshes.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "unions.hpp"
#include "uses/set_cover.hpp"

namespace scaleaxis {
namespace {

using namespace test;

struct Sampled {
    std::unique_ptr<Solid> solid;
    SampledUnion made;
    double diagonal = 0.0;
};

Sampled sampled(std::unique_ptr<Solid> solid, double delta = 0.02) {
    Sampled result{std::move(solid), {}, 0.0};
    result.diagonal = result.solid->bounds().diagonal();
    result.made = sampled_union(*result.solid, {.tolerance = delta * result.diagonal});
    return result;
}

Sampled sampled(const TriangleMesh& mesh) { return sampled(mesh_solid(repair(mesh))); }

FewBalls found(const Sampled& input, FewBallsOptions options, const Execution& execution = {}) {
    options.search_size = 1000;
    return few_balls(input.made.balls.balls, input.made.samples.points, *input.solid, options, execution);
}

double largest_gap(const Sampled& input, const std::vector<Ball>& balls) {
    const std::vector<Point> points = input.solid->seeds(0.01 * input.diagonal, 99, {});
    return std::ranges::max(BallUnion(balls).signed_distances(points));
}

// Separated balls: as many as there are stand for them, and none fewer.
TEST(FewBalls, AChainOfSeparatedBallsNeedsThemAll) {
    std::vector<TriangleMesh> parts;
    for (int k = 0; k < 5; ++k) {
        parts.push_back(sphere_mesh({3.0 * k, 0.2 * k, 0.0}, 1.0 - 0.1 * k, 3));
    }
    const Sampled input = sampled(together(parts));
    for (const FewBallsKind kind : {FewBallsKind::kCover, FewBallsKind::kInside}) {
        const FewBalls few = found(input, {.kind = kind, .error = 0.05});
        EXPECT_EQ(few.balls.size(), 5U);
        EXPECT_EQ(few.statistics.count_bound, 5);
        EXPECT_LE(few.statistics.error, 0.05);
    }
}

TEST(FewBalls, ABallIsOneBall) {
    const Sampled input = sampled(sphere_mesh({1.0, 2.0, 3.0}, 2.0, 4));
    const FewBalls cover = found(input, {.count = 1});
    ASSERT_EQ(cover.balls.size(), 1U);
    EXPECT_NEAR(distance(cover.balls[0].center, {1.0, 2.0, 3.0}), 0.0, 0.02);
    EXPECT_NEAR(cover.balls[0].radius, 2.0, 0.02);
    EXPECT_LT(cover.statistics.error, 0.03);
}

// Of the box a × a × 2a, two balls that cover it best are those around the cubes: r = a √3 / 2.
TEST(FewBalls, TwoBallsAroundTwoCubes) {
    const Sampled input = sampled(box_mesh({0.0, 0.0, 0.0}, {1.0, 1.0, 2.0}, 4));
    const FewBalls cover = found(input, {.count = 2});
    ASSERT_EQ(cover.balls.size(), 2U);
    EXPECT_NEAR(cover.statistics.error, 0.5 * std::sqrt(3.0) - 0.5, 0.02);
    EXPECT_LE(cover.statistics.error, cover.statistics.greedy_error);
}

void expect_cover_of_what_was_not_looked_at(const std::vector<Index>& counts) {
    const Sampled input = sampled(torus_mesh(1.0, 0.3, 60, 30));
    for (const Index count : counts) {
        SCOPED_TRACE(count);
        const FewBalls few = found(input, {.count = count});
        EXPECT_EQ(few.balls.size(), static_cast<std::size_t>(count));
        EXPECT_LT(largest_gap(input, few.balls), 0.002 * input.diagonal);
        const BallScores scores =
            ball_scores(few.balls, input.solid->seeds(0.01 * input.diagonal, 99, {}), *input.solid);
        EXPECT_GT(scores.coverage, 0.9999);
        EXPECT_LE(scores.largest_protrusion, few.statistics.error + 1e-6);
        EXPECT_GT(scores.largest_protrusion, 0.9 * few.statistics.error);
        EXPECT_GE(scores.volume_ratio, 1.0);
    }
}

TEST(FewBalls, CoverWhatWasNotLookedAt) { expect_cover_of_what_was_not_looked_at({3}); }

TEST(FewBallsSweep, CoverWhatWasNotLookedAt) { expect_cover_of_what_was_not_looked_at({8, 20}); }

TEST(FewBalls, InnerOnesLieInside) {
    const Sampled input = sampled(torus_mesh(1.0, 0.3, 60, 30));
    const FewBalls few = found(input, {.kind = FewBallsKind::kInside, .count = 12});
    for (const Ball& ball : few.balls) {
        EXPECT_TRUE(input.solid->inside(ball.center));
        const std::optional<Point> foot = input.solid->nearest(ball.center);
        ASSERT_TRUE(foot);
        EXPECT_LE(ball.radius, distance(ball.center, *foot) * (1.0 + 1e-12));
    }
    EXPECT_LE(largest_gap(input, few.balls), few.statistics.error + 0.002 * input.diagonal);
    const BallScores scores = ball_scores(few.balls, input.made.samples.points, *input.solid);
    EXPECT_LT(scores.largest_protrusion, 1e-9);
    EXPECT_LT(scores.volume_ratio, 1.0);
    EXPECT_NEAR(scores.outside_share, 0.0, 1e-9);
}

TEST(FewBalls, DoNotLeaveTheSolidBehind) {
    // Of a plate, points are the less farther than the boundary the farther off a centre outside is.
    Sampled input = sampled(box_mesh({-1.0, -1.0, -0.05}, {1.0, 1.0, 0.05}, 4));
    input.made.balls.balls = {{{0.0, 0.0, 0.5}, 0.45}};
    const FewBalls few = found(input, {.kind = FewBallsKind::kInside, .count = 1});
    ASSERT_EQ(few.balls.size(), 1U);
    EXPECT_LT(few.balls[0].radius, input.diagonal);
}

TEST(FewBalls, FewerForALargerError) {
    const Sampled input = sampled(torus_mesh(1.0, 0.3, 60, 30));
    std::size_t before = 1000;
    for (const double error : {0.1, 0.25}) {
        const FewBalls few = found(input, {.error = error});
        EXPECT_LE(few.statistics.error, error * (1.0 + 1e-6));
        EXPECT_LT(few.balls.size(), before);
        EXPECT_LE(few.balls.size(), static_cast<std::size_t>(few.statistics.greedy_count));
        before = few.balls.size();
    }
}

// With balls around all of a hollow the surface may be covered, and the inside not: the middle of a large ball.
TEST(FewBalls, TheInsideIsCovered) {
    const Sampled input = sampled(box_mesh({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, 4));
    const FewBalls few = found(input, {.count = 30});
    const BallUnion ball_union(few.balls);
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const Point p{random_unit(3, i, 0), random_unit(3, i, 1), random_unit(3, i, 2)};
        ASSERT_LT(ball_union.signed_distances(std::vector{p})[0], 0.003 * input.diagonal) << i;
    }
}

TEST(FewBalls, SameForAnyNumberOfThreads) {
    const Sampled input = sampled(torus_mesh(1.0, 0.3, 60, 30));
    const std::vector<Ball> one = found(input, {.count = 6}, {.threads = 1}).balls;
    EXPECT_EQ(one, found(input, {.count = 6}, {.threads = 3}).balls);
}

TEST(FewBalls, PointsOfSheetsThatWereLeftOutAreMeasured) {
    // A closed cube and an open plate of area 2 beside it.
    TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1}, 2);
    const auto first = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 2}, {2, 0, 2}, {2, 1, 2}, {0, 1, 2}});
    const TriangleMesh cube = mesh;
    mesh.triangles.insert(mesh.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
    const SolidOfTriangles made = solid_of_triangles(mesh, {}, {});
    ASSERT_EQ(made.report.sheet_triangles, 2);
    const std::vector<Point> points = points_left_out({mesh.vertices, mesh.triangles}, *made.solid, 0.1);
    EXPECT_NEAR(static_cast<double>(points.size()), 10.0 * 2.0 / (0.1 * 0.1), 2.0);
    for (const Point& p : points) {
        EXPECT_EQ(p.z, 2.0);
        EXPECT_TRUE(p.x >= 0.0 && p.x <= 2.0 && p.y >= 0.0 && p.y <= 1.0);
    }
    EXPECT_TRUE(points_left_out({cube.vertices, cube.triangles}, *made.solid, 0.1).empty());
    const TriangleMesh& sheets = made.left_out;
    ASSERT_EQ(sheets.triangles.size(), 2U);
    EXPECT_EQ(sheets.vertices, std::vector<Point>(mesh.vertices.begin() + first, mesh.vertices.end()));
    const std::vector<Ball> cover{{{0.5, 0.5, 0.5}, 0.87}};
    const BallScores scores = ball_scores(cover, points, *made.solid);
    EXPECT_EQ(scores.surface_coverage, 0.0);
    EXPECT_GT(scores.largest_gap, 1.2);
}

TEST(FewBalls, PointsOfATriangleMuchLargerThanTheSolidAreFew) {
    const std::unique_ptr<Solid> cube = mesh_solid(box_mesh({0, 0, 0}, {1, 1, 1}));
    const std::vector<Point> corners{{5, 0, 0}, {1e6, 0, 0}, {5, 1e6, 0}};
    const std::vector<std::array<Index, 3>> triangle{{0, 1, 2}};
    const std::vector<Point> points = points_left_out({corners, triangle}, *cube, 0.01);
    EXPECT_GT(points.size(), 1000U);
    EXPECT_LE(points.size(), 3000001U);
}

TEST(FewBalls, NoneReachesThroughAPlane) {
    const Sampled input = sampled(box_mesh({0.0, 0.0, 0.0}, {1.0, 1.0, 2.0}, 4));
    // One plane along a side, one through the middle, neither of unit length.
    for (const HalfSpace& plane : {HalfSpace{{0.0, 0.0, 3.0}, 0.0}, HalfSpace{{0.0, -2.0, -2.0}, -1.5}}) {
        const FewBalls few = found(input, {.count = 12, .clip = {plane}, .effort = 0.1});
        EXPECT_EQ(few.balls.size(), 12U);
        const Point normal = unit(plane.normal);
        for (const auto& [center, radius] : few.balls) {
            EXPECT_GE(dot(normal, center) - radius, plane.offset - 1e-9);
        }
        // Only what is nearer to it than the error may be left over.
        const std::vector<Point> points = input.solid->seeds(0.01 * input.diagonal, 99, {});
        const std::vector<double> gaps = BallUnion(few.balls).signed_distances(points);
        double largest = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double height = dot(normal, points[i]) - plane.offset;
            largest = height >= 1.1 * few.statistics.error ? std::max(largest, gaps[i]) : largest;
        }
        EXPECT_LT(largest, 0.001);
        EXPECT_LT(few.statistics.error, 0.3);
    }
    EXPECT_THROW(found(input, {.count = 2, .clip = {{{0.0, 0.0, 1.0}, 2.5}}}), UnusableInput);
    EXPECT_THROW(found(input, {.count = 2, .clip = {{{0.0, 0.0, 0.0}, 0.0}}}), InvalidOption);
}

TEST(FewBalls, CoverWhatIsLowAboveAPlane) {
    // A foot of 5 × 0.5 below a column: lower than the balls grow at first.
    const Sampled input = sampled(prism({{0, 0}, {5, 0}, {5, 0.5}, {1, 0.5}, {1, 5}, {0, 5}}, 3.0));
    const HalfSpace floor{{0.0, 1.0, 0.0}, 0.0};
    const HalfSpace wall{{0.0, 0.0, 1.0}, 0.0};
    for (const auto& [count, planes] :
         {std::pair(Index{10}, std::vector{floor}), std::pair(Index{16}, std::vector{floor}),
          std::pair(Index{16}, std::vector{floor, wall})}) {
        const FewBalls few = found(input, {.count = count, .clip = planes, .effort = 0.1});
        for (const auto& [center, radius] : few.balls) {
            EXPECT_GE(center.y - radius, -1e-9);
            EXPECT_TRUE(planes.size() == 1 || center.z - radius >= -1e-9);
        }
        EXPECT_LT(few.statistics.error, 1.0) << count << ' ' << planes.size();
        EXPECT_LT(largest_gap(input, few.balls), few.statistics.error) << count;
    }
}

TEST(FewBalls, SoManyThatStickOutNoFarther) {
    const Sampled input = sampled(box_mesh({0.0, 0.0, 0.0}, {1.0, 1.0, 2.0}, 4));
    const std::vector<Point> points = input.solid->seeds(0.01 * input.diagonal, 99, {});
    double before = 0.0;
    for (const double error : {0.02, 0.1, 0.2}) {
        const FewBalls few = found(input, {.count = 4, .error = error, .effort = 0.1});
        EXPECT_EQ(few.balls.size(), 4U);
        EXPECT_LE(few.statistics.error, error * (1.0 + 1e-9));
        const BallScores scores = ball_scores(few.balls, points, *input.solid);
        EXPECT_LE(scores.largest_protrusion, error * (1.0 + 1e-6));
        EXPECT_GT(scores.coverage, before);
        EXPECT_LT(scores.coverage, 0.999);
        before = scores.coverage;
    }
    EXPECT_THROW(found(input, {.kind = FewBallsKind::kInside, .count = 4, .error = 0.1}), InvalidOption);
}

TEST(FewBalls, ATotalIsSharedSoThatTheLargestErrorIsSmall) {
    const Sampled large = sampled(box_mesh({0.0, 0.0, 0.0}, {1.0, 1.0, 2.0}, 4));
    const Sampled small = sampled(sphere_mesh({0.0, 0.0, 0.0}, 0.3, 4));
    std::vector<Sharer> sharers;
    for (const Sampled* input : {&small, &large}) {
        sharers.push_back({input->made.balls.balls, input->made.samples.points, input->solid.get()});
    }
    const FewBallsOptions options{.search_size = 300, .effort = 0.1};
    const std::vector<FewBalls> shared = shared_balls(sharers, 8, options, {.threads = 1});
    ASSERT_EQ(shared.size(), 2U);
    // A ball is one ball: all others are for the box.
    EXPECT_EQ(shared[0].balls.size(), 1U);
    EXPECT_EQ(shared[1].balls.size(), 7U);

    EXPECT_LT(shared[1].statistics.error, found(large, {.count = 4, .effort = 0.1}).statistics.error);
    const std::vector<FewBalls> again = shared_balls(sharers, 8, options, {.threads = 2});
    EXPECT_TRUE(shared[1].balls == again[1].balls);
    EXPECT_THROW(shared_balls(sharers, 1, options), InvalidOption);
}

TEST(FewBalls, LargeOnesContainTheOthers) {
    std::vector<Ball> balls;
    for (std::uint64_t i = 0; i < 40; ++i) {
        balls.push_back({{random_unit(3, i, 0) + (i % 2 == 0 ? 5.0 : 0.0), random_unit(3, i, 1), random_unit(3, i, 2)},
                         0.3 * random_unit(3, i, 3)});
    }
    for (const Index count : {1, 2, 7, 40, 100}) {
        const std::vector<Ball> large = enclosing_balls(balls, count);
        EXPECT_EQ(large.size(), std::min<std::size_t>(count, 40));
        for (const Ball& ball : balls) {
            EXPECT_TRUE(std::ranges::any_of(large, [&](const Ball& other) {
                return distance(ball.center, other.center) + ball.radius <= other.radius * (1.0 + 1e-12);
            })) << count;
        }
    }
    // Two heaps become two balls; corners of a cube have the ball through them.
    EXPECT_LT(std::ranges::max(enclosing_balls(balls, 2), {}, &Ball::radius).radius, 1.3);
    std::vector<Ball> corners;
    for (int corner = 0; corner < 8; ++corner) {
        corners.push_back({{corner & 1 ? 1.0 : 0.0, corner & 2 ? 1.0 : 0.0, corner & 4 ? 1.0 : 0.0}, 0.1});
    }
    EXPECT_NEAR(enclosing_balls(corners, 1)[0].radius, 0.1 + 0.5 * std::sqrt(3.0), 1e-3);
    EXPECT_THROW(enclosing_balls({}, 1), InvalidOption);
    EXPECT_THROW(enclosing_balls(balls, 0), InvalidOption);
}

TEST(FewBalls, WrongOptions) {
    const Sampled input = sampled(sphere_mesh({}, 1.0, 2));
    EXPECT_THROW(found(input, {}), InvalidOption);
    EXPECT_THROW(found(input, {.kind = FewBallsKind::kInside, .count = 3, .error = 0.1}), InvalidOption);
    EXPECT_THROW(found(input, {.count = 0}), InvalidOption);
    EXPECT_THROW(found(input, {.error = -1.0}), InvalidOption);
    EXPECT_THROW(found(input, {.error = 1e-6}), InvalidOption);  // that no candidates reach
    EXPECT_THROW(few_balls({}, input.made.samples.points, *input.solid, {.count = 1}), UnusableInput);
    EXPECT_THROW(ball_scores({}, input.made.samples.points, *input.solid), UnusableInput);
}

SetSystem random_system(std::uint64_t seed, Index sets, Index elements, double share) {
    SetSystem system;
    system.elements = elements;
    for (Index set = 0; set < sets; ++set) {
        std::vector<Index> list;
        for (Index element = 0; element < elements; ++element) {
            // Every element is in some set.
            if (element % sets == set || random_unit(seed, static_cast<std::uint64_t>(set), element) < share) {
                list.push_back(element);
            }
        }
        system.sets.push_back(list);
    }
    return system;
}

bool covers(const SetSystem& system, unsigned chosen) {
    std::vector<char> is_covered(system.elements, 0);
    for (std::size_t set = 0; set < system.sets.size(); ++set) {
        if ((chosen >> set & 1U) != 0) {
            std::ranges::for_each(system.sets[set], [&](Index element) { is_covered[element] = 1; });
        }
    }
    return std::ranges::count(is_covered, 0) == 0;
}

unsigned bits_of(const std::vector<Index>& sets) {
    return std::accumulate(sets.begin(), sets.end(), 0U, [](unsigned bits, Index set) { return bits | 1U << set; });
}

// Against all subsets.
TEST(SetCover, BoundsAndCoversOfRandomSystems) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        const SetSystem system = random_system(seed, 12, 30, 0.2);
        int least = 12;
        for (unsigned chosen = 0; chosen < 1U << 12U; ++chosen) {
            if (std::popcount(chosen) < least && covers(system, chosen)) {
                least = std::popcount(chosen);
            }
        }
        const auto greedy = greedy_cover(system, 12);
        ASSERT_TRUE(greedy);
        EXPECT_TRUE(covers(system, bits_of(*greedy)));
        EXPECT_GE(static_cast<int>(greedy->size()), least);
        const Index bound = cover_bound(system, static_cast<Index>(greedy->size()));
        EXPECT_LE(bound, least);
        EXPECT_GE(bound, least - 2);
        std::vector<Index> start(least);
        std::iota(start.begin(), start.end(), 0);
        const auto best = cover_of_size(system, start, 1'000'000);
        ASSERT_TRUE(best);
        EXPECT_EQ(static_cast<int>(best->size()), least);
        EXPECT_TRUE(covers(system, bits_of(*best)));
        if (least > 1) {
            start.pop_back();
            EXPECT_FALSE(cover_of_size(system, start, 100'000));
        }
    }
}

// Intervals of a row of points: of many that lie in others, and points that no interval tells from others, nothing is
// left that the search would have to look at.
TEST(SetCover, WhatIsHiddenInOtherSetsCostsNoWork) {
    constexpr Index kElements = 1000;
    SetSystem system;
    system.elements = kElements;
    for (Index set = 0; set < 600; ++set) {
        const auto i = static_cast<std::uint64_t>(set);
        const auto first = static_cast<Index>(random_unit(5, i, 0) * (kElements - 60));
        std::vector<Index> list(20 + static_cast<Index>(random_unit(5, i, 1) * 40));
        std::iota(list.begin(), list.end(), first);
        system.sets.push_back(list);
    }
    std::vector<Index> ends(60);
    std::iota(ends.begin(), ends.end(), 0);
    system.sets.push_back(ends);
    std::iota(ends.begin(), ends.end(), kElements - 60);
    system.sets.push_back(ends);
    // The fewest: from the first element on, each time the one that goes farthest.
    std::vector<Index> start;
    for (Index covered = 0; covered < kElements; start.push_back(static_cast<Index>(start.size()))) {
        Index next = covered;
        for (std::size_t set = 0; set < system.sets.size(); ++set) {
            if (system.sets[set].front() <= covered) {
                next = std::max(next, system.sets[set].back() + 1);
            }
        }
        ASSERT_GT(next, covered);
        covered = next;
    }
    const auto cover = cover_of_size(system, start, 20'000);
    ASSERT_TRUE(cover);
    EXPECT_EQ(cover->size(), start.size());
    std::vector<char> is_covered(kElements, 0);
    for (const Index set : *cover) {
        std::ranges::for_each(system.sets[set], [&](Index element) { is_covered[element] = 1; });
    }
    EXPECT_EQ(std::ranges::count(is_covered, 0), 0);
    // So many, though fewer would do; each once.
    start.resize(start.size() + 5);
    std::iota(start.begin(), start.end(), 0);
    auto more = cover_of_size(system, start, 20'000);
    ASSERT_TRUE(more);
    EXPECT_EQ(more->size(), start.size());
    std::ranges::sort(*more);
    EXPECT_EQ(std::ranges::adjacent_find(*more), more->end());
    // An element in no set.
    ++system.elements;
    EXPECT_FALSE(cover_of_size(system, start, 20'000));
}

}  // namespace
}  // namespace scaleaxis
