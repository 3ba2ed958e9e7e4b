// SPDX-License-Identifier: Apache-2.0
// Distances between surfaces: closed forms and brute force.
#include "scaleaxis/distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "meshes.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/errors.hpp"
#include "solids.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

TEST(MeshDistance, NearestPointOfATriangleIsNearerThanAnyOther) {
    constexpr std::uint64_t kSeed = 41;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (int i = 0; i < 2000; ++i) {
        std::array<Point, 3> t{random_point(random, 1.0), random_point(random, 1.0), random_point(random, 1.0)};
        if (i % 10 == 0) {
            t[2] = midpoint(t[0], t[1]);  // no area
        }
        if (i % 25 == 0) {
            t[1] = t[2] = t[0];
        }
        const Point p = random_point(random, 2.0);
        const Point q = nearest_point(t[0], t[1], t[2], p);
        // It is nearest if and only if every corner lies beyond the plane through it that faces `p`.
        for (const Point& corner : t) {
            EXPECT_LE(dot(p - q, corner - q), 1e-12);
        }
        // And it belongs to the triangle.
        const Point normal = cross(t[1] - t[0], t[2] - t[0]);
        EXPECT_NEAR(dot(q - t[0], normal), 0.0, 1e-12);
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(dot(cross(t[(k + 1) % 3] - t[k], q - t[k]), normal), -1e-12);
        }
        EXPECT_LE(distance(q, t[0]), std::max(distance(t[0], t[1]), distance(t[0], t[2])) + 1e-12);
    }
}

TEST(MeshDistance, HierarchyFindsWhatBruteForceFinds) {
    constexpr std::uint64_t kSeed = 42;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (const TriangleMesh& mesh :
         {torus_mesh(1.0, 0.4, 24), ball_mesh(1.0, 20), box_mesh({-1.0, -0.7, -0.4}, {1.0, 0.7, 0.4}, 1)}) {
        const Bvh bvh = build_bvh(mesh);
        const TriangleBounds bounds = triangle_bounds(bvh);
        for (int i = 0; i < 500; ++i) {
            const Point p = random_point(random, i % 5 == 0 ? 100.0 : 1.5);
            double nearest = std::numeric_limits<double>::infinity();
            for (const auto& [a, b, c] : mesh.triangles) {
                const auto& v = mesh.vertices;
                nearest = std::min(nearest, distance(p, nearest_point(v[a], v[b], v[c], p)));
            }
            ASSERT_NEAR(std::sqrt(nearest_triangle(bvh, bounds, p).squared_distance), nearest, 1e-12 * nearest);
        }
    }
}

TEST(UnionDistance, BoundaryIsAsFarAsBruteForceSays) {
    constexpr std::uint64_t kSeed = 43;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (const Balls& balls :
         {chain_of_balls(1, 0.0, 1.0), chain_of_balls(2, 1.0, 0.7), chain_of_balls(8, 0.2, 0.5),
          ring_of_balls(12, 1.0, 0.4), grid_of_balls(3, 3, 3, 0.7), scattered_balls(random, 40, 1.0, 0.1, 0.5),
          balls_of_all_sizes(random, 60), balls_around_a_void(random, 50, 0.6), balls_through_points(random, 30, 8)}) {
        const UnionOfBalls truth(balls);
        const BallUnion united(balls);
        int inside = 0;
        for (int i = 0; i < 400; ++i) {
            const Point p = random_point(random, 1.5);
            inside += truth.contains(p) ? 1 : 0;
            ASSERT_NEAR(united.distances_to_boundary(std::span(&p, 1))[0], truth.boundary_near(p).first, 1e-6);
        }
        EXPECT_GT(inside, 0);
        // The middle of a ball is as far from all of its sphere and its circles.
        const Point middle = balls[0].center;
        ASSERT_NEAR(united.distances_to_boundary(std::span(&middle, 1))[0], truth.boundary_near(middle).first, 1e-6);
    }
}

TriangleMesh scaled_mesh(TriangleMesh mesh, double factor) {
    for (Point& p : mesh.vertices) {
        p = factor * p;
    }
    return mesh;
}

TriangleMesh moved_mesh(TriangleMesh mesh, const Point& by) {
    for (Point& p : mesh.vertices) {
        p = p + by;
    }
    return mesh;
}

// What is asked for is between what was found and that plus its error.
void expect_between(const OneSidedDistance& found, double truth, double slack = 1e-9) {
    EXPECT_LE(found.max, truth + slack);
    EXPECT_GE(found.max + found.error, truth - slack);
    EXPECT_GE(found.rms, found.mean - 1e-12);
    EXPECT_GE(found.max, found.rms - 1e-12);
    EXPECT_EQ(found.mean > slack, truth > slack) << found.mean;
}

TEST(SurfaceDistance, OfAMovedBoxIsTheMove) {
    const TriangleMesh box = box_mesh({-1.0, -0.7, -0.4}, {1.0, 0.7, 0.4}, 1);
    const SurfaceDistance distance =
        surface_distance(box, moved_mesh(box, {0.1, 0.0, 0.0}), {.spacing = 0.02, .accuracy = 1e-4});
    expect_between(distance.a_to_b, 0.1);
    expect_between(distance.b_to_a, 0.1);
    EXPECT_NEAR(distance.max(), 0.1, 0.01);
    // Two sides are 0.1 away, and the ends of the others: all but these are 0.
    const double area = 2.0 * (4.0 * 0.28 + 4.0 * 0.4 + 4.0 * 0.7);
    const double end = 2.0 * (1.4 + 0.8) * 0.1 * 0.1 / 2.0;
    EXPECT_NEAR(distance.a_to_b.mean, (2.0 * 4.0 * 0.28 * 0.1 + 0.0) / area, 2.0 * end / area + 1e-3);
}

TEST(SurfaceDistance, IsExactWhereASharpCornerSticksOut) {
    // One vertex of a flat box is pulled out: only the branch and bound finds it exactly from a coarse spacing.
    const TriangleMesh box = box_mesh({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}, 4);
    TriangleMesh spiked = box;
    std::size_t top = 0;
    for (std::size_t v = 0; v < spiked.vertices.size(); ++v) {
        const Point& p = spiked.vertices[v];
        if (p.z > 0.99 && std::abs(p.x) < 0.3 && std::abs(p.y) < 0.3) {
            top = v;
        }
    }
    spiked.vertices[top].z += 0.37;
    const SurfaceDistance distance = surface_distance(spiked, box, {.spacing = 0.3, .accuracy = 1e-6});
    EXPECT_NEAR(distance.a_to_b.max, 0.37, 1e-6);
    EXPECT_LE(distance.a_to_b.error, 2e-6);
    EXPECT_NEAR(norm(distance.a_to_b.farthest - spiked.vertices[top]), 0.0, 1e-4);
    EXPECT_LT(distance.b_to_a.max, 0.37);
}

TEST(SurfaceDistance, OfConcentricSpheresIsTheDifferenceOfTheirRadii) {
    const BallUnion small({{{0, 0, 0}, 1.0}});
    const BallUnion large({{{0, 0, 0}, 1.25}});
    const TriangleMesh mesh = ball_mesh(1.0, 60);
    const double sagitta = 0.01;  // of the mesh's triangles
    const auto check = [&](const Surface& a, const Surface& b, double truth, double slack) {
        const SurfaceDistance distance = surface_distance(a, b, {.spacing = 0.05, .accuracy = 1e-3});
        expect_between(distance.a_to_b, truth, slack);
        expect_between(distance.b_to_a, truth, slack);
        EXPECT_NEAR(distance.a_to_b.mean, truth, slack);
        EXPECT_NEAR(distance.b_to_a.rms, truth, slack);
        EXPECT_NEAR(distance.max(), truth, slack);
    };
    check(small, large, 0.25, 1e-6);
    check(large, small, 0.25, 1e-6);
    check(mesh, large, 0.25, sagitta);
    check(large, mesh, 0.25, sagitta);
    check(mesh, small, 0.0, sagitta);
    check(mesh, scaled_mesh(mesh, 1.5), 0.5, sagitta);
    check(mesh, mesh, 0.0, 1e-12);
}

TEST(SurfaceDistance, IsOneSidedEachWay) {
    // A ball, and the same with another one beside it.
    const BallUnion one({{{0, 0, 0}, 1.0}});
    const BallUnion two({{{0, 0, 0}, 1.0}, {{4, 0, 0}, 0.5}});
    const SurfaceDistance distance = surface_distance(one, two, {.spacing = 0.05});
    expect_between(distance.a_to_b, 0.0, 1e-8);
    expect_between(distance.b_to_a, 3.5, 1e-6);
    EXPECT_NEAR(distance.max(), 3.5, 0.01);
    EXPECT_GE(distance.max() + distance.error(), 3.5 - 1e-6);
}

TEST(SurfaceDistance, WithinAUnionIsToItsBoundaryAlone) {
    // A small sphere within two overlapping balls: the nearest boundary is the crease between them.
    const BallUnion two({{{-0.5, 0, 0}, 1.0}, {{0.5, 0, 0}, 1.0}});
    const BallUnion within({{{0, 0, 0}, 0.05}});
    const SurfaceDistance distance = surface_distance(within, two, {.spacing = 0.02});
    EXPECT_NEAR(distance.a_to_b.max, std::sqrt(0.75), 0.051);
    EXPECT_NEAR(distance.a_to_b.mean, std::sqrt(0.75), 0.051);
}

TEST(SurfaceDistance, IsTheSameForAnyNumberOfThreads) {
    const TriangleMesh mesh = torus_mesh(1.0, 0.4, 24);
    const Balls balls = ring_of_balls(24, 1.0, 0.4);
    const DistanceOptions options{.spacing = 0.03, .accuracy = 1e-4};
    const SurfaceDistance one = surface_distance(mesh, BallUnion(balls), options, {.threads = 1});
    const SurfaceDistance four = surface_distance(mesh, BallUnion(balls), options, {.threads = 4});
    EXPECT_EQ(one.a_to_b.max, four.a_to_b.max);
    EXPECT_EQ(one.a_to_b.mean, four.a_to_b.mean);
    EXPECT_EQ(one.a_to_b.error, four.a_to_b.error);
    EXPECT_EQ(one.b_to_a.rms, four.b_to_a.rms);
    EXPECT_EQ(one.b_to_a.farthest, four.b_to_a.farthest);
}

TEST(SurfaceDistance, WhatIsNoSurfaceIsAnError) {
    const Surface ball = BallUnion({{{0, 0, 0}, 1.0}});
    EXPECT_THROW(surface_distance(ball, TriangleMesh{}, {.spacing = 0.1}), UnusableInput);
    EXPECT_THROW(surface_distance(BallUnion(), ball, {.spacing = 0.1}), UnusableInput);
    EXPECT_THROW(surface_distance(ball, ball, {.spacing = 0.0}), InvalidOption);
    EXPECT_THROW(surface_distance(ball, ball, {.spacing = std::nan("")}), InvalidOption);
    EXPECT_THROW(surface_distance(ball, ball, {.spacing = 0.1, .accuracy = -1.0}), InvalidOption);
    EXPECT_THROW(surface_distance(ball_mesh(1.0, 10), ball, {.spacing = 1e-9}), InvalidOption);
}

}  // namespace
}  // namespace scaleaxis
