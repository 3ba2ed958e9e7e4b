// SPDX-License-Identifier: Apache-2.0
// Samples as dense as the solid needs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "complexes.hpp"
#include "meshes.hpp"
#include "sampling/crossed_facets.hpp"
#include "sampling/restricted_facets.hpp"
#include "sampling/size_field.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis {
namespace {

using namespace test;

std::vector<double> facet_radii(const Samples& samples) {
    std::vector<double> radii;
    for (const RestrictedFacet& facet : restricted_facets(samples)) {
        const auto [a, b, c] = vertices_of(samples, facet);
        radii.push_back(circumradius(samples.points[a], samples.points[b], samples.points[c]));
    }
    return radii;
}

// Between balls of radius 1 that touch the sphere 2ρ apart their union dips by ρ²/2: by 0.4 δ at most.
TEST(Sizing, FacetsOfABallAreAsLargeAsItsUnionLets) {
    const auto ball = mesh_solid(sphere_mesh({0, 0, 0}, 1.0, 6));
    std::vector<double> counts;
    for (const double tolerance : {0.02, 0.01, 0.005, 0.0025}) {
        const Samples samples = sample(*ball, {.tolerance = tolerance});
        const double most = std::sqrt(0.8 * tolerance);
        std::vector<double> radii = facet_radii(samples);
        std::ranges::sort(radii);
        EXPECT_LE(radii.back(), 1.05 * most) << tolerance;
        EXPECT_GE(radii[radii.size() / 2], 0.35 * most) << tolerance;
        EXPECT_GT(samples.statistics.dip_facets, 0);
        counts.push_back(static_cast<double>(samples.points.size()));
    }
    for (std::size_t i = 1; i < counts.size(); ++i) {
        // Two times as many, but that the first samples are no sparser than four tolerances.
        EXPECT_LT(counts[i] / counts[i - 1], 3.0) << "a uniform sample has four times as many";
        EXPECT_GT(counts[i] / counts[i - 1], 1.7);
    }
}

TriangleMesh ball_and_pin() {
    return together(sphere_mesh({0, 0, 0}, 1.0, 4), box_mesh({0.9, -0.04, -0.04}, {2.5, 0.04, 0.04}, 4));
}

struct NamedSolid {
    std::string name;
    TriangleMesh mesh;
    double delta;
};

// Among them parts and gaps much thinner than the first samples are apart, which is four tolerances at least.
std::vector<NamedSolid> solids_with_thin_parts() {
    const auto slab = [](double thickness) { return box_mesh({-1, -1, -0.5 * thickness}, {1, 1, 0.5 * thickness}, 8); };
    return {{"box", box_mesh({0, 0, 0}, {3, 2, 1}, 4), 0.01},
            {"torus", torus_mesh(1.0, 0.3, 96, 48), 0.01},
            {"dumbbell", dumbbell_mesh(0.5, 1.0, 0.05, 48), 0.01},
            {"plate", slab(0.06), 0.01},
            {"gap", together(slab(0.4), moved(slab(0.4), Point{0, 0, 0.46})), 0.01},
            {"ball and pin", ball_and_pin(), 0.01}};
}

TEST(Sizing, UnionsAreWithinHalfOfDelta) {
    for (const auto& [name, mesh, delta] : solids_with_thin_parts()) {
        SCOPED_TRACE(name);
        const auto solid = mesh_solid(mesh);
        const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(delta), .scales = {1.0}});
        if (axis.solid_topology) {
            EXPECT_EQ(axis.fit->repair.topology, *axis.solid_topology);
        }
        EXPECT_EQ(axis.fit->repair.far_points, 0);
        EXPECT_LE(axis.fit->accuracy.largest_distance, kPromise * axis.tolerance);
        // Points that the pipeline has not looked at.
        double farthest = 0.0;
        for (const NearestBall& near : BallUnion(axis.balls).nearest_balls(solid->seeds(axis.tolerance, 77, {}))) {
            farthest = std::max(farthest, near.distance);
        }
        // Along sharp edges, between two that it has looked at, they are farther away.
        EXPECT_LE(farthest, 0.85 * axis.tolerance);
    }
}

TEST(Sizing, AreHardlyDenserThanUniformOnes) {
    for (const auto& [name, mesh, delta] : solids_with_thin_parts()) {
        const auto solid = mesh_solid(mesh);
        const double tolerance = delta * solid->bounds().diagonal();
        const std::size_t uniform = sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform}).points.size();
        EXPECT_LE(sample(*solid, {.tolerance = tolerance}).points.size(), uniform + uniform / 10) << name;
    }
}

TEST(Sizing, PartsThatTheFirstSamplesMissAreFound) {
    const auto solid = mesh_solid(ball_and_pin());
    const double tolerance = 0.04;
    const Samples samples = sample(*solid, {.tolerance = tolerance});
    EXPECT_GT(samples.statistics.far_samples, 0);
    const std::vector<Ball> balls = inner_balls(samples);
    for (const double x : {1.2, 1.6, 2.0, 2.4}) {
        EXPECT_TRUE(std::ranges::any_of(balls, [&](const Ball& ball) {
            return distance(ball.center, {x, 0, 0}) < ball.radius + tolerance;
        })) << x;
    }
}

TEST(Sizing, SizesAreLipschitzAndBounded) {
    const auto solid = mesh_solid(dumbbell_mesh(0.5, 1.0, 0.05, 48));
    const double tolerance = 0.02;
    const double largest = 4.0 * tolerance;
    LabelledTriangulation triangulation(*solid, tolerance, 1.5 * largest);
    triangulation.insert(sample(*solid, {.tolerance = tolerance}).points);
    SamplingStatistics statistics;
    std::vector<CrossedFacet> facets;
    ask_again(facets, triangulation, largest, statistics);
    ASSERT_GT(facets.size(), 1000U);
    const std::vector<FacetSize> sizes = size_field(triangulation, facets, tolerance, largest, {{}, 0.0});
    for (const CrossedFacet& facet : facets) {
        for (int k = 0; k < 3; ++k) {
            const Index v = facet.vertices[k];
            const Index w = facet.vertices[(k + 1) % 3];
            const double length = distance(triangulation.point(v), triangulation.point(w));
            EXPECT_LE(std::abs(sizes[v].length - sizes[w].length), length * (1.0 + 1e-12));
        }
    }
    const auto [least, most] = std::ranges::minmax(sizes, {}, &FacetSize::length);
    EXPECT_GE(least.length, kLeastSize * tolerance);
    EXPECT_LE(most.length, largest);
    EXPECT_LT(least.length, 0.5 * most.length) << "the bar is thin";
}

TEST(Sizing, IsTheSameForAnyThreadsAndScalesWithTheSolid) {
    const TriangleMesh mesh = dumbbell_mesh(0.5, 1.0, 0.05, 48);
    const Samples one = sample(*mesh_solid(mesh), {.tolerance = 0.02}, {.threads = 1});
    for (const int threads : {2, 4}) {
        EXPECT_EQ(sample(*mesh_solid(mesh), {.tolerance = 0.02}, {.threads = threads}).points, one.points);
    }
    TriangleMesh large = mesh;
    for (Point& p : large.vertices) {
        p = 1024.0 * p;
    }
    std::vector<Point> points = sample(*mesh_solid(large), {.tolerance = 1024.0 * 0.02}).points;
    for (Point& p : points) {
        p = (1.0 / 1024.0) * p;
    }
    EXPECT_EQ(points, one.points);
    EXPECT_NE(sample(*mesh_solid(mesh), {.tolerance = 0.02, .seed = 2}).points, one.points);
}

// Facets that are larger than the tolerance, too.
TEST(Sizing, FacetsComeAsCloseToTheSurfaceAsTheyAreTo) {
    const TriangleMesh ball = sphere_mesh({0, 0, 0}, 1.0, 6);
    const double tolerance = 0.02;
    const auto farthest = [&](double facet_distance) {
        const Samples samples =
            sample(*mesh_solid(ball),
                   {.tolerance = tolerance, .facet_distance = facet_distance * tolerance, .growth_limit = 10.0});
        double most = 0.0;
        for (const RestrictedFacet& facet : restricted_facets(samples)) {
            const auto [a, b, c] = vertices_of(samples, facet);
            const Point middle = (1.0 / 3.0) * (samples.points[a] + samples.points[b] + samples.points[c]);
            most = std::max(most, 1.0 - norm(middle));
        }
        return most / tolerance;
    };
    EXPECT_GT(farthest(100.0), 0.1);
    EXPECT_LT(farthest(0.05), 0.055);
}

TEST(Sizing, StatisticsTellTheSizesOfFacets) {
    const auto solid = mesh_solid(torus_mesh(1.0, 0.3, 96, 48));
    for (const Sizing sizing : {Sizing::kAdaptive, Sizing::kUniform}) {
        const Samples samples = sample(*solid, {.tolerance = 0.02, .sizing = sizing});
        const std::vector<Index>& sizes = samples.statistics.facet_sizes;
        EXPECT_EQ(std::accumulate(sizes.begin(), sizes.end(), Index{0}), samples.statistics.restricted_facets);
        std::vector<Index> expected(sizes.size());
        for (const double radius : facet_radii(samples)) {
            std::size_t k = 0;
            while (radius / 0.02 > std::ldexp(1.0, static_cast<int>(k) - 3)) {
                ++k;
            }
            ++expected[k];
        }
        EXPECT_EQ(sizes, expected);
    }
}

}  // namespace
}  // namespace scaleaxis
