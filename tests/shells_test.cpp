// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/shells.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "meshes.hpp"

#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using test::prism;

ShellMesh shells_of(const TriangleMesh& mesh, const ShellOptions& options, int threads = 0, double delta = 0.01) {
    const auto solid = mesh_solid(mesh);
    const ScaleAxis axis =
        scale_axis(*solid, {.delta = Length::relative(delta), .scales = {1.1}}, {.threads = threads});
    return shell_mesh(axis.axes[0].complex, *solid, options, {.threads = threads});
}

// A T of walls of thickness 1: a plate 9 wide, and one 5 high on it.
TriangleMesh tee() { return prism({{0, 0}, {9, 0}, {9, 1}, {5, 1}, {5, 6}, {4, 6}, {4, 1}, {0, 1}}, 8.0); }

std::map<std::pair<Index, Index>, int> triangles_at_edges(const TriangleMesh& mesh) {
    std::map<std::pair<Index, Index>, int> counts;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            ++counts[std::minmax(triangle[k], triangle[(k + 1) % 3])];
        }
    }
    return counts;
}

TEST(Shells, WallsMeetInTheirMiddlePlanes) {
    const ShellMesh shells = shells_of(tee(), {.size = 1.0});
    ASSERT_EQ(shells.sheets.size(), 3U);
    EXPECT_NEAR(shells.sheets[0].area, 5.5 * 8.0, 1e-3);
    EXPECT_NEAR(shells.sheets[1].area, 4.5 * 8.0, 1e-3);
    EXPECT_NEAR(shells.sheets[2].area, 4.5 * 8.0, 1e-3);
    for (const MidsurfaceSheet& sheet : shells.sheets) {
        EXPECT_NEAR(sheet.mean, 1.0, 1e-3);
        EXPECT_EQ(sheet.min, sheet.max);
    }
    EXPECT_NEAR(shells.seam_length, 8.0, 1e-3);
    EXPECT_NEAR(shells.border_length, 3.0 * 8.0 + 2.0 * (9.0 + 5.5), 1e-2);
    EXPECT_GT(shells.least_angle, 20.0);
    EXPECT_NEAR(shells.mean_edge, 1.0, 0.1);
    int on_seam = 0;
    for (const auto& [edge, count] : triangles_at_edges(shells.mesh)) {
        const Point& a = shells.mesh.vertices[edge.first];
        const Point& b = shells.mesh.vertices[edge.second];
        const auto is_at_seam = [](const Point& p) { return std::hypot(p.x - 4.5, p.y - 0.5) < 1e-3; };
        EXPECT_EQ(count == 3, is_at_seam(a) && is_at_seam(b));
        EXPECT_LE(count, 3);
        EXPECT_LT(distance(a, b), 1.5);
        on_seam += count == 3 ? 1 : 0;
    }
    EXPECT_GE(on_seam, 6);
}

TEST(Shells, AnAngleHasAnEdgeInsteadOfAnArc) {
    const ShellMesh shells = shells_of(prism({{0, 0}, {6, 0}, {6, 1}, {1, 1}, {1, 6}, {0, 6}}, 8.0), {.size = 1.0});
    ASSERT_EQ(shells.sheets.size(), 2U);
    EXPECT_NEAR(shells.sheets[0].area, 5.5 * 8.0, 1e-3);
    EXPECT_NEAR(shells.sheets[1].area, 5.5 * 8.0, 1e-3);
    EXPECT_EQ(shells.seam_length, 0.0);
}

// Middles of edges are where a quadratic element wants them.
TEST(Shells, MiddlesLieOnCurvedWalls) {
    std::vector<std::array<double, 2>> outline;
    const auto arc = [&](double radius, int from, int to, int step) {
        for (int i = from; i != to + step; i += step) {
            const double angle = 3.14159265358979 * i / 64.0;
            outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
        }
    };
    arc(10.5, 0, 64, 1);
    arc(9.5, 64, 0, -1);
    const ShellMesh shells = shells_of(prism(outline, 8.0), {.size = 2.0});
    ASSERT_EQ(shells.sheets.size(), 1U);
    EXPECT_NEAR(shells.sheets[0].mean, 1.0, 0.01);
    for (const Point& p : shells.mesh.vertices) {
        EXPECT_NEAR(std::hypot(p.x, p.y), 10.0, 0.03);
    }
    for (const Point& p : shells.middles) {
        EXPECT_NEAR(std::hypot(p.x, p.y), 10.0, 0.03);
    }
}

double area_of(const ShellMesh& shells) {
    double area = 0.0;
    for (const MidsurfaceSheet& sheet : shells.sheets) {
        area += sheet.area;
    }
    return area;
}

// In a corner of a hole the rims of two sides meet at one place, where normals turn from one to the other.
TEST(Shells, HolesHaveTheirCorners) {
    const TriangleMesh plate = test::blocks_mesh({{{{-20, -15, -1}, {20, 15, 1}}}}, {{{{-3, -5, -1}, {7, 4, 1}}}});
    for (const double size : {1.0, 2.0, 4.0}) {
        SCOPED_TRACE(size);
        const ShellMesh shells = shells_of(plate, {.size = size});
        EXPECT_NEAR(area_of(shells), 40.0 * 30.0 - 10.0 * 9.0, 0.1);
        EXPECT_NEAR(shells.border_length, 2.0 * (40.0 + 30.0 + 10.0 + 9.0), 0.1);
    }
}

// Seams of four walls, which two of them must not have with another edge than the others.
TEST(Shells, CrossingRibsHaveNoFlatTriangles) {
    const TriangleMesh ribs = test::blocks_mesh({{{{0, 0, 0}, {32, 32, 1.5}}},
                                                 {{{9.25, 0, 1.5}, {10.75, 32, 10}}},
                                                 {{{21.25, 0, 1.5}, {22.75, 32, 10}}},
                                                 {{{0, 9.25, 1.5}, {32, 10.75, 10}}},
                                                 {{{0, 21.25, 1.5}, {32, 22.75, 10}}}});
    for (int k = 0; k < 6; ++k) {
        const Point axis = unit(Point{1.0, 2.0 - k, 3.0});
        const double angle = 0.7 + 0.9 * k;
        SCOPED_TRACE("turned by " + std::to_string(angle) + " about " + std::to_string(2 - k));
        TriangleMesh turned = ribs;
        for (Point& p : turned.vertices) {
            p = std::cos(angle) * p + std::sin(angle) * cross(axis, p) + (1.0 - std::cos(angle)) * dot(axis, p) * axis;
        }
        const ShellMesh shells = shells_of(turned, {.size = 2.0});
        EXPECT_GT(shells.least_angle, 3.0);
        EXPECT_NEAR(area_of(shells), 32.0 * 32.0 + 4.0 * 32.0 * 9.25, 0.005 * 2208.0);
    }
}

// Between the seams of the acute corners balls have a sheet of their own, which has no room between middle planes.
TEST(Shells, ObliqueCrossesHaveOneSeam) {
    for (const double degrees : {30.0, 45.0, 60.0}) {
        SCOPED_TRACE(degrees);
        const double angle = degrees * std::numbers::pi / 180.0;
        const std::array<Point, 2> bars{Point{1, 0, 0}, {std::cos(angle), std::sin(angle), 0}};
        std::vector<std::array<double, 2>> outline;
        for (int k = 0; k < 4; ++k) {
            const Point along = (k < 2 ? 1.0 : -1.0) * bars[k % 2];
            const Point next = (k == 0 || k == 3 ? 1.0 : -1.0) * bars[(k + 1) % 2];
            const Point aside{-0.5 * along.y, 0.5 * along.x, 0.0};
            const Point corner = (0.5 / norm(cross(along, next))) * (along + next);
            for (const Point& p : {7.5 * along - aside, 7.5 * along + aside, corner}) {
                outline.push_back({p.x, p.y});
            }
        }
        const ShellMesh shells = shells_of(prism(outline, 8.0), {.size = 1.5});
        ASSERT_EQ(shells.sheets.size(), 4U);
        for (const MidsurfaceSheet& sheet : shells.sheets) {
            EXPECT_NEAR(sheet.area, 7.5 * 8.0, 0.01);
        }
        EXPECT_NEAR(shells.seam_length, 8.0, 0.01);
        EXPECT_GT(shells.least_angle, 15.0);
    }
}

// Turned at random.
TriangleMesh ring(double outer, double inner, double height, unsigned seed) {
    constexpr Index kSides = 64;
    TriangleMesh mesh;
    for (Index i = 0; i < kSides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kSides;
        for (const auto& [radius, z] : {std::pair(outer, 0.0), {outer, height}, {inner, height}, {inner, 0.0}}) {
            mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
        }
        const Index next = (i + 1) % kSides;
        for (Index k = 0; k < 4; ++k) {
            const Index above = (k + 1) % 4;
            mesh.triangles.push_back({4 * i + k, 4 * next + k, 4 * next + above});
            mesh.triangles.push_back({4 * i + k, 4 * next + above, 4 * i + above});
        }
    }
    test::Random random(seed);
    return test::moved(mesh, test::random_turn(random));
}

TEST(Shells, AHoleAsWideAsAnElementStays) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(seed);
        const ShellMesh shells = shells_of(ring(6.0, 0.8, 1.0, seed), {.size = 1.5}, 0, 0.015);
        const auto vertices = static_cast<int>(shells.mesh.vertices.size());
        const auto triangles = static_cast<int>(shells.mesh.triangles.size());
        EXPECT_EQ(vertices - static_cast<int>(shells.middles.size()) + triangles, 0);
    }
}

TEST(Shells, CurvedWallsEndInTheirMiddle) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(seed);
        const TriangleMesh tube = ring(6.0, 5.0, 15.0, seed);
        const Point base = 0.5 * (tube.vertices[0] + tube.vertices[4 * 32]);
        const Point along = (1.0 / 15.0) * (0.5 * (tube.vertices[1] + tube.vertices[4 * 32 + 1]) - base);
        for (const double size : {0.8, 1.5}) {
            SCOPED_TRACE(size);
            const ShellMesh shells = shells_of(tube, {.size = size}, 0, 0.014);
            for (const auto& [edge, count] : triangles_at_edges(shells.mesh)) {
                for (const Index v : {edge.first, edge.second}) {
                    const Point from = shells.mesh.vertices[v] - base;
                    const double height = dot(from, along);
                    ASSERT_NEAR(norm(from - height * along), 5.5, 0.05);
                    ASSERT_NEAR(count > 1 ? 0.0 : std::abs(height - 7.5) - 7.5, 0.0, 0.02);
                }
            }
        }
    }
}

// From the edge of the solid to the seam its balls grow from nothing to the thickness of the walls.
TEST(Shells, AWedgeBetweenWallsTapers) {
    const double half = 25.0 * 3.14159265358979 / 180.0;
    const Point u{std::cos(half), std::sin(half), 0.0};
    const Point n{-std::sin(half), std::cos(half), 0.0};
    const Point end = 30.0 * u;
    const Point inner = end - 2.0 * n;
    const double tip = 2.0 / std::sin(half);
    const ShellMesh shells = shells_of(
        prism({{0, 0}, {end.x, -end.y}, {inner.x, -inner.y}, {tip, 0}, {inner.x, inner.y}, {end.x, end.y}}, 20.0),
        {.size = 1.0}, 0, 0.005);
    ASSERT_EQ(shells.sheets.size(), 3U);
    for (std::size_t t = 0; t < shells.mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3 && shells.triangle_sheets[t] == 2; ++k) {
            const Point& p = shells.mesh.vertices[shells.mesh.triangles[t][k]];
            if (p.z < 2.0 || p.z > 18.0) {
                continue;  // balls that touch an end, too
            }
            EXPECT_NEAR(shells.thickness[t][k], 2.0 * std::hypot(p.x, p.y) * std::sin(half), 0.2);
        }
    }
}

TEST(Shells, DoNotDependOnThreads) {
    const ShellMesh one = shells_of(tee(), {.size = 0.7}, 1);
    const ShellMesh two = shells_of(tee(), {.size = 0.7}, 2);
    EXPECT_EQ(one.mesh.vertices, two.mesh.vertices);
    EXPECT_EQ(one.mesh.triangles, two.mesh.triangles);
    EXPECT_EQ(one.middles, two.middles);
    EXPECT_EQ(one.thickness, two.thickness);
}

TEST(Shells, RefuseASizeOfNothing) {
    EXPECT_THROW(shells_of(tee(), {}), InvalidOption);
    EXPECT_TRUE(shells_of(test::sphere_mesh({}, 1.0, 2), {.size = 1.0}).mesh.triangles.empty());
}

}  // namespace
}  // namespace scaleaxis
