// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/refit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "complexes.hpp"
#include "meshes.hpp"
#include "pipeline/envelope_accuracy.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/simplification.hpp"

namespace scaleaxis {
namespace {

using namespace test;

const std::vector<std::array<double, 2>> kEll{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};

TEST(Refit, BringsTheAxisOfABoxBackExactly) {
    const Point size{3.0, 2.0, 1.0};
    const auto radius = [&](const Point& p) {
        return std::min({p.x, p.y, p.z, size.x - p.x, size.y - p.y, size.z - p.z});
    };
    const MedialComplex exact = linear(axis_of_box(size, radius));
    MedialComplex complex = exact;
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        if (complex.radii[v] > 0.0) {
            const double sign = v % 2 == 0 ? 1.0 : -1.0;
            complex.vertices[v] = complex.vertices[v] + sign * Point{0.02, -0.01, 0.015};
            complex.radii[v] = radius(complex.vertices[v]);
        }
    }
    const auto solid = mesh_solid(box_mesh({0, 0, 0}, size));
    const auto result = refitted(complex, *solid, {.tolerance = 0.05, .error = 1e-3, .most_vertices = 12}, Execution());
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->vertices.size(), 12);
    expect_consistent(*result);
    for (std::size_t v = 0; v < exact.vertices.size(); ++v) {
        EXPECT_TRUE(std::ranges::any_of(result->vertices,
                                        [&](const Point& p) { return distance(p, exact.vertices[v]) < 1e-4; }));
    }
}

TEST(Refit, FollowsCurvedSheetsWithFewVertices) {
    const auto solid = mesh_solid(prism(kEll, 2.0));
    const ScaleAxis axis =
        scale_axis(*solid, {.delta = Length::relative(0.02), .scales = {1.0}, .compact = CompactOptions()});
    const AxisAtScale& compact = axis.axes[0];
    EXPECT_LE(compact.accuracy->solid_to_envelope, 0.13 * axis.tolerance) << "0.16 as simplified";
    EXPECT_LE(*compact.accuracy->envelope_to_solid, 0.13 * axis.tolerance) << "the same";
    EXPECT_LE(compact.complex.vertices.size(), 50);
    EXPECT_LE(compact.simplify_statistics->largest_gap, 0.25 * axis.tolerance);
    EXPECT_EQ(compact.simplify_statistics->vertices_after, static_cast<Index>(compact.complex.vertices.size()));
    EXPECT_TRUE(agree(compact.simplify_statistics->topology, compact.clean_statistics->topology));
    EXPECT_EQ(compact.complex.sheets, 17);
    expect_consistent(compact.complex);
}

TEST(Refit, IsMeasuredWhereSamplesAreFarApart) {
    // A gusset of 45 degrees on a plate: its toe ends amid a plane, where samples are few.
    const auto solid = mesh_solid(prism({{0, 0}, {30, 0}, {30, 4}, {29, 4}, {4, 29}, {4, 30}, {0, 30}}, 4.0));
    const ScaleAxis axis = scale_axis(*solid, {.compact = CompactOptions()});
    const AxisAtScale& compact = axis.axes[0];
    MedialComplex complex = compact.complex;
    complex.scale = 1.0;
    const double found = largest_distance_from(*solid, Envelope(complex), 0.5 * axis.tolerance, {});
    EXPECT_GE(compact.accuracy->solid_to_envelope, found);
}

TEST(Refit, GivesUpWhereItTakesTooManyVertices) {
    const auto ellipsoid =
        function_solid([](const Point& p) { return p.x * p.x / 9.0 + p.y * p.y / 4.0 + p.z * p.z - 1.0; },
                       {.bounds = Box{{-3.1, -2.1, -1.1}, {3.1, 2.1, 1.1}}});
    const ScaleAxis axis =
        scale_axis(*ellipsoid, {.delta = Length::relative(0.02), .scales = {1.0}, .compact = CompactOptions()});
    const MedialComplex& compact = axis.axes[0].complex;
    const auto count = static_cast<Index>(compact.vertices.size());
    RefitOptions options{.tolerance = axis.tolerance, .error = 1e-4 * axis.tolerance, .most_vertices = count};
    EXPECT_FALSE(refitted(compact, *ellipsoid, options, Execution()).has_value());
}

TEST(Refit, IsTheSameForAnyThreads) {
    const auto solid = mesh_solid(prism(kEll, 2.0));
    const ScaleAxisOptions options{.delta = Length::relative(0.02), .scales = {1.0}, .compact = CompactOptions()};
    const ScaleAxis one = scale_axis(*solid, options, {.threads = 1});
    const ScaleAxis four = scale_axis(*solid, options, {.threads = 4});
    EXPECT_EQ(one.axes[0].complex.vertices, four.axes[0].complex.vertices);
    EXPECT_EQ(one.axes[0].complex.radii, four.axes[0].complex.radii);
    EXPECT_EQ(one.axes[0].complex.faces.items, four.axes[0].complex.faces.items);
}

}  // namespace
}  // namespace scaleaxis
