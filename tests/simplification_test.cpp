// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/simplification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "axis/complex.hpp"
#include "complexes.hpp"
#include "executions.hpp"
#include "meshes.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

/// How far these balls stick out of the envelope of a complex, at most.
double largest_excess(const std::vector<Point>& centers, const std::vector<double>& radii,
                      const MedialComplex& complex) {
    const std::vector<double> distances = Envelope(complex).signed_distances(centers);
    double most = 0.0;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        most = std::max(most, distances[i] + radii[i]);
    }
    return most;
}

/// The same of the balls in the middle of the edges of `a`.
double largest_excess_in_edges(const MedialComplex& a, const MedialComplex& b) {
    std::vector<Point> centers;
    std::vector<double> radii;
    for (const auto& [p, q] : a.edges) {
        const bool is_linear = scaleaxis::is_linear(a.vertex_origins[p]) || scaleaxis::is_linear(a.vertex_origins[q]);
        const double square = squared_distance(a.vertices[p], a.vertices[q]);
        centers.push_back(midpoint(a.vertices[p], a.vertices[q]));
        radii.push_back(is_linear ? 0.5 * (a.radii[p] + a.radii[q])
                                  : radius_between(a.radii[p], a.radii[q], square, 0.5));
    }
    return largest_excess(centers, radii, b);
}

/// The axis of a box, its sheets divided into many triangles.
MedialComplex fine_axis_of_box(const Point& size) {
    const auto radius = [&](const Point& p) {
        return std::min({p.x, p.y, p.z, size.x - p.x, size.y - p.y, size.z - p.z});
    };
    MedialComplex complex = axis_of_box(size, radius);
    for (int i = 0; i < 3; ++i) {
        complex = refined(complex, radius);
    }
    return linear(complex);
}

TEST(Simplify, BoxBecomesItsTwelveVerticesExactly) {
    const Point size{3.0, 2.0, 1.0};
    const MedialComplex fine = fine_axis_of_box(size);
    ASSERT_GT(fine.vertices.size(), 300U);
    const SimplifiedComplex simplified = simplify(fine, {.error = 1e-6});
    ASSERT_NO_FATAL_FAILURE(expect_consistent(simplified.complex));
    EXPECT_EQ(simplified.complex.vertices.size(), 12U);
    EXPECT_EQ(simplified.complex.sheets, 13);
    EXPECT_LT(simplified.statistics.largest_gap, 1e-9);
    EXPECT_LT(simplified.statistics.largest_protrusion, 1e-9);
    EXPECT_LT(
        surface_distance(Envelope(simplified.complex), box_mesh({0, 0, 0}, size), {.spacing = 0.05, .accuracy = 0.01})
            .max(),
        1e-9);
}

TEST(Simplify, KeepsToItsErrorOnBothSides) {
    const auto solid = mesh_solid(read_mesh(SCALEAXIS_SOURCE_DIR "/data/cat.obj"));
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.02), .scales = {1.0}});
    const MedialComplex& fine = axis.axes[0].complex;
    std::size_t last = fine.vertices.size();
    // In errors, in the middle of edges: between the places that are looked at, which are as dense as the error or a
    // quarter of the edges of the complex, whichever is larger. The smallest error is less than that.
    struct Bound {
        double error;
        double of_result;
        double of_given;
    };
    for (const auto& [error, of_result, of_given] :
         {Bound{0.005, 1.4, 1.4}, Bound{0.025, 1.05, 1.05}, Bound{0.1, 1.0, 1.0}}) {
        const SimplifiedComplex simplified = simplify(fine, {.error = error});
        ASSERT_NO_FATAL_FAILURE(expect_consistent(simplified.complex));
        EXPECT_LT(simplified.complex.vertices.size(), last) << "a larger error, and not fewer vertices";
        last = simplified.complex.vertices.size();
        const SimplifyStatistics& statistics = simplified.statistics;
        EXPECT_LE(statistics.largest_gap, error);
        // Between the balls that are looked at: a little more.
        EXPECT_LE(statistics.largest_protrusion, 1.1 * error);
        EXPECT_LE(largest_excess(fine.vertices, fine.radii, simplified.complex), error);
        EXPECT_LE(largest_excess(simplified.complex.vertices, simplified.complex.radii, fine), error);
        EXPECT_LE(largest_excess_in_edges(simplified.complex, fine), of_result * error);
        EXPECT_LE(largest_excess_in_edges(fine, simplified.complex), of_given * error);
        EXPECT_EQ(statistics.error, error);
        EXPECT_TRUE(agree(statistics.topology, topology(fine)));
        EXPECT_TRUE(agree(statistics.topology, topology(simplified.complex)));
        EXPECT_EQ(statistics.vertices_after, static_cast<Index>(simplified.complex.vertices.size()));
        EXPECT_EQ(statistics.vertices_before, static_cast<Index>(fine.vertices.size()));
        for (const VertexOrigin& origin : simplified.complex.vertex_origins) {
            EXPECT_TRUE(is_linear(origin));
        }
    }
}

/// A loop of edges with radii, a plate with a hole, and a ball alone.
MedialComplex parts_of_all_kinds() {
    MedialComplex complex = squares(
        0.3, 5, 5, 3, [](int i, int j) { return i != 2 || j != 2; }, [](const Point& p) { return 0.2 + 0.01 * p.x; });
    std::vector<std::array<Index, 2>> curves;
    const auto first = static_cast<Index>(complex.vertices.size());
    constexpr Index kCount = 60;
    for (Index i = 0; i < kCount; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kCount;
        complex.vertices.push_back({5.0 + std::cos(angle), std::sin(angle), 0.0});
        complex.radii.push_back(0.1);
        curves.push_back(i + 1 < kCount ? std::array{first + i, first + i + 1} : std::array{first, first + i});
    }
    complex.vertices.push_back({9.0, 0.0, 0.0});
    complex.radii.push_back(0.5);
    complex.vertex_origins.resize(complex.vertices.size());
    build_edges(complex, curves);
    return linear(complex);
}

TEST(Simplify, KeepsPlatesWithHolesLoopsAndBallsAlone) {
    const MedialComplex complex = parts_of_all_kinds();
    const SimplifiedComplex simplified = simplify(complex, {.error = 1.0});
    EXPECT_TRUE(agree(topology(simplified.complex), topology(complex)));
    EXPECT_EQ(simplified.complex.sheets, 1);
    EXPECT_EQ(curve_edges(simplified.complex).size(), 3U) << "a loop has three edges at least";
    EXPECT_EQ(isolated_vertices(simplified.complex).size(), 1U);
    EXPECT_LT(simplified.complex.vertices.size(), 20U);
}

TEST(Simplify, StopsAtANumberOfVertices) {
    const MedialComplex fine = fine_axis_of_box({3.0, 2.0, 1.0});
    for (const Index count : {200, 77, 20}) {
        const SimplifiedComplex simplified = simplify(fine, {.vertices = count});
        EXPECT_EQ(simplified.complex.vertices.size(), static_cast<std::size_t>(count));
        EXPECT_LE(simplified.statistics.largest_gap, simplified.statistics.error);
    }
    // The error of an axis that keeps all seams and corners is no longer worth it where so few are asked for.
    const SimplifiedComplex least = simplify(fine, {.vertices = 1});
    EXPECT_EQ(least.complex.vertices.size(), 3U) << "a sheet is a triangle at least";
    EXPECT_TRUE(agree(topology(least.complex), topology(fine)));
    // With an error what must stay does.
    EXPECT_EQ(simplify(fine, {.error = 0.1, .vertices = 1}).complex.vertices.size(), 12U);
    // Both: whichever comes first.
    EXPECT_EQ(simplify(fine, {.error = 1e-6, .vertices = 100}).complex.vertices.size(), 100U);
}

TEST(Simplify, AnchorsStay) {
    const MedialComplex fine = fine_axis_of_box({3.0, 2.0, 1.0});
    constexpr std::uint64_t kSeed = 81;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    std::vector<Index> anchors;
    for (int i = 0; i < 10; ++i) {
        anchors.push_back(static_cast<Index>(uniform(random, 0.0, static_cast<double>(fine.vertices.size()))));
    }
    const MedialComplex result = simplify(fine, {.error = 1e-3, .anchors = anchors}).complex;
    EXPECT_LE(result.vertices.size(), 12U + anchors.size() + 10U);
    for (const Index v : anchors) {
        const auto at = std::ranges::find(result.vertices, fine.vertices[v]);
        ASSERT_NE(at, result.vertices.end()) << "anchor " << v;
        EXPECT_EQ(result.radii[at - result.vertices.begin()], fine.radii[v]);
    }
}

TEST(Simplify, IsTheSameForAnyThreadsAndUnderSimilarities) {
    const MedialComplex fine = fine_axis_of_box({3.0, 2.0, 1.0});
    const MedialComplex one = simplify(fine, {.error = 0.01}, {.threads = 1}).complex;
    EXPECT_TRUE(same_bytes(one, simplify(fine, {.error = 0.01}, {.threads = 4}).complex));
    MedialComplex far = fine;
    for (std::size_t v = 0; v < far.vertices.size(); ++v) {
        far.vertices[v] = 1024.0 * (far.vertices[v] + Point{1000.0, -500.0, 300.0});
        far.radii[v] *= 1024.0;
    }
    const SimplifiedComplex moved = simplify(far, {.error = 1024.0 * 0.01});
    EXPECT_NEAR(static_cast<double>(moved.complex.vertices.size()), static_cast<double>(one.vertices.size()), 2.0);
    EXPECT_LE(moved.statistics.largest_gap, 10.24);
}

TEST(Simplify, RefusesWhatMakesNoSense) {
    const MedialComplex fine = fine_axis_of_box({3.0, 2.0, 1.0});
    EXPECT_THROW(simplify(fine, {}), InvalidOption);
    EXPECT_THROW(simplify(fine, {.error = 0.0}), InvalidOption);
    EXPECT_THROW(simplify(fine, {.error = std::nan("")}), InvalidOption);
    EXPECT_THROW(simplify(fine, {.error = 10.0}), InvalidOption);
    EXPECT_THROW(simplify(fine, {.vertices = 0}), InvalidOption);
    EXPECT_THROW(simplify(fine, {.error = 0.1, .anchors = {-1}}), InvalidOption);
    EXPECT_THROW(simplify(fine, {.error = 0.1, .anchors = {static_cast<Index>(fine.vertices.size())}}), InvalidOption);
    EXPECT_THROW(simplify(MedialComplex(), {.error = 0.1}), UnusableInput);
}

}  // namespace
}  // namespace scaleaxis
