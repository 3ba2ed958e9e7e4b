// SPDX-License-Identifier: Apache-2.0
// Samples to a triangle mesh, and the sampler's manifold criterion behind it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "meshes.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/solid.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr double kPi = std::numbers::pi;

// Every side of a triangle occurs once in each direction, and the triangles around a vertex form one fan.
void expect_closed_manifold(const TriangleMesh& mesh) {
    std::set<std::array<Index, 2>> sides;
    std::vector<std::map<Index, Index>> fans(mesh.vertices.size());
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const Index a = triangle[k], b = triangle[(k + 1) % 3], c = triangle[(k + 2) % 3];
            ASSERT_TRUE(sides.insert({a, b}).second) << "two triangles have the side " << a << ' ' << b;
            fans[a][b] = c;
        }
    }
    for (const auto& [a, b] : sides) {
        ASSERT_TRUE(sides.contains({b, a})) << "the side " << a << ' ' << b << " is free";
    }
    for (std::size_t v = 0; v < fans.size(); ++v) {
        ASSERT_FALSE(fans[v].empty()) << "vertex " << v << " has no triangle";
        std::size_t length = 1;
        const Index start = fans[v].begin()->first;
        for (Index at = fans[v].at(start); at != start; at = fans[v].at(at)) {
            ++length;
        }
        ASSERT_EQ(length, fans[v].size()) << "vertex " << v << " has several fans";
    }
}

std::int64_t euler(const TriangleMesh& mesh) {
    return static_cast<std::int64_t>(mesh.vertices.size()) - static_cast<std::int64_t>(mesh.triangles.size()) / 2;
}

double volume(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += dot(mesh.vertices[a], cross(mesh.vertices[b], mesh.vertices[c])) / 6.0;
    }
    return sum;
}

double area(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += 0.5 * norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
    }
    return sum;
}

// The edges of a mesh whose triangles do not lie in a plane.
std::vector<std::array<Point, 2>> creases_of(const TriangleMesh& mesh) {
    std::map<std::array<Index, 2>, std::vector<Point>> normals;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        const auto& [a, b, c] = triangle;
        const Point normal = unit(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            normals[{low, high}].push_back(normal);
        }
    }
    std::vector<std::array<Point, 2>> creases;
    for (const auto& [ends, both] : normals) {
        if (norm(both[0] - both[1]) > 1e-6) {
            creases.push_back({mesh.vertices[ends[0]], mesh.vertices[ends[1]]});
        }
    }
    return creases;
}

// The mesh of the surface of a mesh, with or without its creases. \param cut part of the diagonal
BoundaryMesh meshed_again(const TriangleMesh& mesh, double cut, bool has_creases) {
    const auto shape = mesh_solid(repair(mesh));
    SamplingOptions options = boundary_sampling(cut * shape->bounds().diagonal());
    if (has_creases) {
        options.creases = creases_of(mesh);
    }
    return boundary_mesh(sample(*shape, options));
}

double signed_distance(const Balls& balls, const Point& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Ball& ball : balls) {
        least = std::min(least, distance(p, ball.center) - ball.radius);
    }
    return least;
}

// Two balls of radius r, their centres d apart.
double volume_of_two(double r, double d) {
    return 8.0 / 3.0 * kPi * r * r * r - kPi * (4.0 * r + d) * (2.0 * r - d) * (2.0 * r - d) / 12.0;
}

struct Case {
    std::string name;
    Balls balls;
    double tolerance;
    std::int64_t euler;  // of the boundary
    double volume;       // 0: not known
    bool has_crevice = false;
};

std::vector<Case> cases() {
    Random random(21);
    const double ball = 4.0 / 3.0 * kPi;
    Balls nested = chain_of_balls(1, 0.0, 1.0);
    nested.push_back({{0.2, 0.0, 0.0}, 0.4});
    Balls tiny = chain_of_balls(1, 0.0, 1.0);
    tiny.push_back({{0.0, 2.0, 0.0}, 0.02});  // a fifth of the tolerance
    return {{"one ball", chain_of_balls(1, 0.0, 1.0), 0.1, 2, ball},
            {"one ball, coarse", chain_of_balls(1, 0.0, 1.0), 0.7, 2, 0.0},
            {"two overlapping", chain_of_balls(2, 1.0, 0.8), 0.08, 2, volume_of_two(0.8, 1.0)},
            {"two with a thin neck", chain_of_balls(2, 1.99, 1.0), 0.15, 2, volume_of_two(1.0, 1.99), true},
            {"two apart", chain_of_balls(2, 2.3, 1.0), 0.1, 4, 2.0 * ball},
            {"nested", nested, 0.1, 2, ball},
            {"chain", chain_of_balls(10, 0.5, 0.6), 0.1, 2, 0.0},
            {"torus", ring_of_balls(24, 1.0, 0.3), 0.06, 0, 0.0},
            {"shell with a cavity", balls_around_a_void(random, 600, 0.4), 0.08, 4, 0.0},
            {"with a tiny ball", tiny, 0.1, 4, ball}};
}

TEST(BoundaryMesh, OfUnionsIsTheClosedSurfaceThatItShouldBe) {
    constexpr std::uint64_t kSeed = 22;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (const auto& [name, balls, tolerance, expected_euler, expected_volume, has_crevice] : cases()) {
        SCOPED_TRACE(name);
        const Samples samples =
            sample(*union_solid(balls),
                   {.tolerance = tolerance, .sizing = Sizing::kUniform, .seed = 3, .needs_manifold = true});
        const BoundaryMesh result = boundary_mesh(samples);
        // Deep in a crevice, where it is thinner than the samples are apart, they are out of reach.
        EXPECT_EQ(samples.statistics.irregular_samples, result.lost_samples);
        EXPECT_LE(result.lost_samples, has_crevice ? 10 : 0);
        const TriangleMesh& mesh = result.mesh;
        expect_closed_manifold(mesh);
        EXPECT_EQ(result.copied_vertices, 0);
        EXPECT_EQ(result.parted_edges, 0);
        EXPECT_EQ(euler(mesh), expected_euler);
        EXPECT_EQ(repair(mesh).report.self_intersections, 0);
        if (expected_volume > 0.0) {
            EXPECT_NEAR(volume(mesh), expected_volume, 0.03 * expected_volume);
        }
        EXPECT_GT(volume(mesh), 0.0);

        for (const Point& p : mesh.vertices) {
            ASSERT_NEAR(signed_distance(balls, p), 0.0, 1e-8);
        }
        for (const auto& [a, b, c] : mesh.triangles) {
            const Point center = (1.0 / 3.0) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
            ASSERT_NEAR(signed_distance(balls, center), 0.0, tolerance);
        }
        for (int i = 0; i < 500; ++i) {
            const Ball& ball = balls[random() % balls.size()];
            const Point p = ball.center + ball.radius * random_direction(random);
            if (signed_distance(balls, p) > -1e-9) {
                double nearest = std::numeric_limits<double>::infinity();
                for (const Point& q : mesh.vertices) {
                    nearest = std::min(nearest, distance(p, q));
                }
                ASSERT_LT(nearest, 1.6 * tolerance);
            }
        }
    }
}

TEST(BoundaryMesh, OfBallsThatTouchInAPointIsCutThere) {
    const Balls balls = chain_of_balls(3, 2.0, 1.0);
    const BoundaryMesh result = boundary_mesh(
        sample(*union_solid(balls), {.tolerance = 0.1, .sizing = Sizing::kUniform, .seed = 1, .needs_manifold = true}));
    expect_closed_manifold(result.mesh);
    // Three spheres, or joined by necks too thin to matter.
    EXPECT_NEAR(volume(result.mesh), 4.0 * kPi, 0.3);
    EXPECT_GE(euler(result.mesh), 2);
    EXPECT_LE(euler(result.mesh), 6);
}

TEST(BoundaryMesh, OfATinyBallNeedsTheManifoldCriterion) {
    Balls balls = chain_of_balls(1, 0.0, 1.0);
    balls.push_back({{0.0, 2.0, 0.0}, 0.02});
    const auto shape = union_solid(balls);
    const BoundaryMesh without = boundary_mesh(sample(*shape, {.tolerance = 0.1, .sizing = Sizing::kUniform}));
    EXPECT_EQ(euler(without.mesh), 2);
    EXPECT_EQ(without.lost_samples, 1);
    const Samples samples = sample(*shape, {.tolerance = 0.1, .sizing = Sizing::kUniform, .needs_manifold = true});
    EXPECT_GT(samples.statistics.manifold_samples, 2);
    EXPECT_EQ(euler(boundary_mesh(samples).mesh), 4);
}

TEST(BoundaryMesh, OfAnyTetrahedraIsAClosedManifold) {
    // Whatever is inside: cells that touch in edges and vertices, voids, single cells.
    const Samples samples =
        sample(*union_solid(ring_of_balls(12, 1.0, 0.4)), {.tolerance = 0.2, .sizing = Sizing::kUniform});
    Index copied = 0;
    Index parted = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        Samples labelled = samples;
        const double part = uniform(random, 0.05, 0.95);
        double expected = 0.0;
        for (std::size_t t = 0; t < labelled.tetrahedra.size(); ++t) {
            labelled.inside[t] = uniform(random, 0.0, 1.0) < part ? 1 : 0;
            if (labelled.inside[t] != 0) {
                const auto& [a, b, c, d] = labelled.tetrahedra[t];
                const std::vector<Point>& p = labelled.points;
                expected += dot(p[b] - p[a], cross(p[c] - p[a], p[d] - p[a])) / 6.0;
            }
        }
        const BoundaryMesh result = boundary_mesh(labelled);
        expect_closed_manifold(result.mesh);
        EXPECT_NEAR(volume(result.mesh), expected, 1e-9);
        copied += result.copied_vertices;
        parted += result.parted_edges;
    }
    EXPECT_GT(copied, 100);
    EXPECT_GT(parted, 100);
}

TEST(BoundaryMesh, FollowsCreases) {
    // Boxes, sheared: planar sides and straight edges come back as they are, at any tolerance below their width.
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        TriangleMesh box = box_mesh({0, 0, 0}, {uniform(random, 0.3, 1.0), uniform(random, 0.3, 1.0), 1.0});
        const Point shear = uniform(random, 0.0, 0.5) * random_direction(random);
        for (Point& p : box.vertices) {
            p = {p.x + shear.x * p.y + 100.0, p.y + shear.y * p.z, p.z + shear.z * p.x};
        }
        ASSERT_EQ(creases_of(box).size(), 12);
        const double cut = uniform(random, 0.02, 0.3);
        const TriangleMesh followed = meshed_again(box, cut, true).mesh;
        expect_closed_manifold(followed);
        EXPECT_EQ(euler(followed), 2);
        EXPECT_NEAR(area(followed), area(box), 1e-9);
        EXPECT_NEAR(volume(followed), volume(box), 1e-9);
        EXPECT_LT(volume(meshed_again(box, cut, false).mesh), (1.0 - 1e-4) * volume(box));
    }
}

TEST(BoundaryMesh, FollowsReentrantCreases) {
    // A square ring with a step inside.
    const TriangleMesh ell =
        revolved_mesh({{1.0, 0.0}, {2.0, 0.0}, {2.0, 0.4}, {1.5, 0.4}, {1.5, 1.0}, {1.0, 1.0}}, 4, 10.0);
    const TriangleMesh followed = meshed_again(ell, 0.05, true).mesh;
    expect_closed_manifold(followed);
    EXPECT_EQ(euler(followed), euler(ell));
    EXPECT_NEAR(area(followed), area(ell), 1e-9);
    EXPECT_NEAR(volume(followed), volume(ell), 1e-9);
}

TEST(BoundaryMesh, EndsWhereCreasesMeetAtAcuteAngles) {
    // Pieces of creases crowd each other near the tip: they are cut, but not for ever.
    for (const double width : {0.2, 0.02, 0.002}) {
        SCOPED_TRACE(width);
        TriangleMesh spike;
        spike.vertices = {{0, 0, 0}, {1, 0, 0}, {1, width, 0}, {1, 0, 1.5 * width}};
        spike.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
        const double cut = 0.03;
        const BoundaryMesh result = meshed_again(spike, cut, true);
        expect_closed_manifold(result.mesh);
        EXPECT_GT(result.mesh.vertices.size(), 60);
        EXPECT_LT(result.mesh.vertices.size(), 4000);
        EXPECT_LE(volume(result.mesh), (1.0 + 1e-9) * volume(spike));
    }
}

TEST(BoundaryMesh, IsTheSameForAnyNumberOfThreads) {
    const auto shape = union_solid(ring_of_balls(24, 1.0, 0.3));
    const auto mesh_with = [&](int threads) {
        return boundary_mesh(sample(*shape, {.tolerance = 0.03, .sizing = Sizing::kUniform, .needs_manifold = true},
                                    {.threads = threads}),
                             {.threads = threads})
            .mesh;
    };
    const TriangleMesh one = mesh_with(1);
    const TriangleMesh four = mesh_with(4);
    EXPECT_EQ(one.vertices, four.vertices);
    EXPECT_EQ(one.triangles, four.triangles);

    const auto box = mesh_solid(repair(box_mesh({0, 0, 0}, {1, 2, 3})));
    const auto samples_with = [&](int threads) {
        SamplingOptions options = boundary_sampling(0.1);
        options.creases = creases_of(box_mesh({0, 0, 0}, {1, 2, 3}));
        return sample(*box, options, {.threads = threads});
    };
    const Samples first = samples_with(1);
    const Samples second = samples_with(4);
    EXPECT_EQ(first.points, second.points);
    EXPECT_EQ(first.tetrahedra, second.tetrahedra);
}

TEST(BoundaryMesh, OfNothingIsEmpty) {
    Samples samples;
    samples.points.resize(3);
    const BoundaryMesh result = boundary_mesh(samples);
    EXPECT_TRUE(result.mesh.triangles.empty());
    EXPECT_EQ(result.lost_samples, 3);
}

}  // namespace
}  // namespace scaleaxis
