// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "complexes.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using namespace test;

struct Measured {
    MedialComplex axis;
    Skeleton skeleton;
    TriangleMesh surface;
};

Measured measured(const TriangleMesh& mesh, double delta) {
    const std::unique_ptr<Solid> solid = mesh_solid(mesh);
    Measured result;
    result.axis = scale_axis(*solid, {.delta = Length::relative(delta), .reaches_sharp_edges = false}).axes[0].complex;
    result.skeleton = skeleton(result.axis, *solid);
    result.surface = with_short_edges(mesh, 0.02 * solid->bounds().diagonal());
    return result;
}

std::vector<Measures> rows_of(const Measured& solid, MeasuredPieces pieces) {
    return measures(solid.axis, solid.skeleton, solid.surface, {.pieces = pieces, .thickness = {}});
}

TEST(Measures, OfATube) {
    // A torus: one loop without ends, as thick as its tube everywhere.
    const double pi = std::numbers::pi;
    const Measured torus = measured(torus_mesh(2.0, 0.5, 96, 48), 0.02);
    const std::vector<Measures> rows = rows_of(torus, MeasuredPieces::kWhole);
    ASSERT_EQ(rows.size(), 1U);
    const Measures& row = rows[0];
    EXPECT_NEAR(*row.volume, 2.0 * pi * pi * 2.0 * 0.25, 0.1);
    EXPECT_NEAR(row.thickness.area, 4.0 * pi * pi * 2.0 * 0.5, 0.3);
    EXPECT_NEAR(row.thickness.mean, 1.0, 0.02);
    EXPECT_LT(row.thickness.deviation, 0.01);
    EXPECT_NEAR(row.curve_length, 4.0 * pi, 0.2);
    EXPECT_EQ(row.branches, 1);
    EXPECT_EQ(row.ends, 0);
    EXPECT_EQ(row.junctions, 0);
    EXPECT_EQ(row.topology.components, 1);
    EXPECT_EQ(row.topology.tunnels, 1);
    EXPECT_EQ(row.topology.voids, 0);
}

TEST(Measures, OfAPlate) {
    const Measured plate = measured(box_mesh({0, 0, 0}, {4, 3, 0.5}, 8), 0.01);
    const Measures row = rows_of(plate, MeasuredPieces::kWhole)[0];
    EXPECT_NEAR(*row.volume, 6.0, 1e-9);
    EXPECT_NEAR(row.thickness.area, 2.0 * (12.0 + 2.0 + 1.5), 1e-9);
    EXPECT_NEAR(row.thickness.mean, 0.5, 0.005);
    // One in the middle, and those in the edges, which end before these.
    EXPECT_EQ(row.sheets, plate.axis.sheets);
    EXPECT_GT(row.sheet_area, 3.5 * 2.5);
    EXPECT_LT(row.sheet_area, 3.5 * 2.5 + 2.0 * std::sqrt(0.125) * (4.0 + 3.0 + 3.5 + 2.5) + 0.5);
    EXPECT_EQ(row.topology.tunnels, 0);
}

TEST(Measures, ComponentsAndPartsAddUpToTheWhole) {
    const TriangleMesh two =
        together(torus_mesh(2.0, 0.5, 64, 32), moved(box_mesh({0, 0, 0}, {3, 1, 1}, 6), Point{6, 0, 0}));
    const Measured solid = measured(two, 0.01);
    const Measures whole = rows_of(solid, MeasuredPieces::kWhole)[0];
    const std::vector<Measures> components = rows_of(solid, MeasuredPieces::kComponents);
    ASSERT_EQ(components.size(), 2U);
    const std::size_t ring = components[0].topology.tunnels == 1 ? 0 : 1;
    EXPECT_EQ(components[ring].topology.tunnels, 1);
    EXPECT_EQ(components[1 - ring].topology.tunnels, 0);
    EXPECT_NEAR(*components[1 - ring].volume, 3.0, 1e-9);
    EXPECT_NEAR(components[1 - ring].thickness.mean, 1.0, 0.01);
    EXPECT_NEAR(*components[0].volume + *components[1].volume, *whole.volume, 1e-9);
    const std::vector<Measures> parts = rows_of(solid, MeasuredPieces::kParts);
    ASSERT_EQ(parts.size(), solid.skeleton.branches.size());
    for (const std::vector<Measures>& rows : {components, parts}) {
        Measures sum;
        for (const Measures& row : rows) {
            sum.thickness.area += row.thickness.area;
            sum.sheets += row.sheets;
            sum.sheet_area += row.sheet_area;
            sum.branches += row.branches;
            sum.curve_length += row.curve_length;
        }
        EXPECT_NEAR(sum.thickness.area, whole.thickness.area, 1e-6 * whole.thickness.area);
        EXPECT_EQ(sum.sheets, whole.sheets);
        EXPECT_NEAR(sum.sheet_area, whole.sheet_area, 1e-9);
        EXPECT_EQ(sum.branches, whole.branches);
        EXPECT_NEAR(sum.curve_length, whole.curve_length, 1e-9);
    }
    for (const Measures& row : parts) {
        EXPECT_FALSE(row.volume);
        EXPECT_EQ(row.topology.components, 1);
    }
}

// Balls have no branch, and the sheet around a void none but what leads to it: they are parts, too.
TEST(Measures, OfPartsWithoutBranchesAreThere) {
    const TriangleMesh ball = sphere_mesh({0, 0, 0}, 1.0, 3);
    const TriangleMesh shell =
        moved(together({sphere_mesh({0, 0, 0}, 1.0, 3), inside_out(sphere_mesh({0, 0, 0}, 0.5, 3))}), Point{4, 0, 0});
    const TriangleMesh bar = moved(box_mesh({0, 0, 0}, {0.4, 0.4, 3}, 6), Point{8, 0, 0});
    const Measured solid = measured(together({ball, shell, bar}), 0.01);
    const Measures whole = rows_of(solid, MeasuredPieces::kWhole)[0];
    const std::vector<Measures> parts = rows_of(solid, MeasuredPieces::kParts);
    ASSERT_EQ(parts.size(), 3U);
    double area = 0.0;
    std::int64_t voids = 0;
    for (const Measures& row : parts) {
        area += row.thickness.area;
        voids += *row.topology.voids;
        EXPECT_EQ(row.topology.components, 1);
        EXPECT_EQ(row.topology.tunnels, 0);
    }
    EXPECT_NEAR(area, whole.thickness.area, 1e-6 * whole.thickness.area);
    EXPECT_EQ(voids, 1);
}

TEST(Measures, TakeThicknessAsGiven) {
    const Measured plate = measured(box_mesh({0, 0, 0}, {4, 3, 0.5}), 0.02);
    const std::vector<double> thickness(plate.surface.vertices.size(), 0.7);
    const std::vector<Measures> rows =
        measures(plate.axis, plate.skeleton, plate.surface, thickness, box_mesh({0, 0, 0}, {4, 3, 1}));
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_NEAR(rows[0].thickness.mean, 0.7, 1e-9);
    EXPECT_NEAR(*rows[0].volume, 12.0, 1e-9);
    EXPECT_NEAR(rows[0].thickness.area, 38.0, 1e-9);
    EXPECT_THROW(measures(plate.axis, plate.skeleton, plate.surface, std::vector{0.7}, plate.surface), InvalidOption);
}

TEST(Measures, RefuseTheSkeletonOfAnotherAxis) {
    const Measured plate = measured(box_mesh({0, 0, 0}, {4, 3, 0.5}), 0.02);
    MedialComplex other = axis_of_box({3, 2, 1}, [](const Point&) { return 0.1; });
    EXPECT_THROW(measures(other, plate.skeleton, plate.surface), InvalidOption);
}

}  // namespace
}  // namespace scaleaxis
