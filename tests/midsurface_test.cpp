// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/midsurface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using test::box_mesh;
using test::moved;
using test::Random;
using test::random_turn;
using test::revolved_mesh;
using test::Similarity;
using test::sphere_mesh;

using Cell = std::array<int, 3>;

// The boundary of a union of unit cubes.
TriangleMesh cells_mesh(const std::set<Cell>& cells) {
    TriangleMesh mesh;
    std::map<Cell, Index> ids;
    const auto vertex = [&](const Cell& at) {
        const auto [it, is_new] = ids.emplace(at, static_cast<Index>(mesh.vertices.size()));
        if (is_new) {
            mesh.vertices.push_back(
                {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
        }
        return it->second;
    };
    for (const Cell& cell : cells) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 1}) {
                Cell beside = cell;
                beside[axis] += side == 0 ? -1 : 1;
                if (cells.contains(beside)) {
                    continue;
                }
                const auto corner = [&](int i, int j) {
                    Cell at = cell;
                    at[axis] += side;
                    at[(axis + 1) % 3] += i;
                    at[(axis + 2) % 3] += j;
                    return vertex(at);
                };
                std::array<Index, 4> q{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                if (side == 0) {
                    std::swap(q[1], q[3]);
                }
                mesh.triangles.push_back({q[0], q[1], q[2]});
                mesh.triangles.push_back({q[0], q[2], q[3]});
            }
        }
    }
    return mesh;
}

// Walls of thickness 1 along y, 6 long, over cells of the plane y = 0.
TriangleMesh profile(const std::vector<std::array<int, 2>>& cells) {
    std::set<Cell> all;
    for (const auto& [x, z] : cells) {
        for (int y = 0; y < 6; ++y) {
            all.insert({x, y, z});
        }
    }
    return cells_mesh(all);
}

void add_box(std::set<Cell>& cells, const Cell& low, const Cell& high) {
    for (int x = low[0]; x < high[0]; ++x) {
        for (int y = low[1]; y < high[1]; ++y) {
            for (int z = low[2]; z < high[2]; ++z) {
                cells.insert({x, y, z});
            }
        }
    }
}

struct CellBox {
    Cell low;
    Cell high;
};

TriangleMesh boxes_mesh(const std::vector<CellBox>& boxes) {
    std::set<Cell> cells;
    for (const auto& [low, high] : boxes) {
        add_box(cells, low, high);
    }
    return cells_mesh(cells);
}

TriangleMesh t_profile() {
    return profile(
        {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}, {6, 0}, {7, 0}, {8, 0}, {4, 1}, {4, 2}, {4, 3}, {4, 4}});
}

TriangleMesh l_profile() { return profile({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}}); }

struct Found {
    MedialComplex axis;
    Midsurface surface;
};

Found midsurface_of(const TriangleMesh& mesh, double delta = 0.01, const MidsurfaceOptions& options = {}) {
    const auto solid = mesh_solid(mesh);
    Found found{scale_axis(*solid, {.delta = Length::relative(delta), .scales = {1.1}}).axes[0].complex, {}};
    found.surface = midsurface(found.axis, *solid, options);
    return found;
}

double area(const Midsurface& surface) {
    double sum = 0.0;
    for (const MidsurfaceSheet& sheet : surface.sheets) {
        sum += sheet.area;
    }
    return sum;
}

// Triangles at each edge, and how often it is passed from its smaller end.
std::map<std::array<Index, 2>, std::array<int, 2>> edges_of(const Midsurface& surface) {
    std::map<std::array<Index, 2>, std::array<int, 2>> edges;
    for (const auto& triangle : surface.mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const Index a = triangle[k], b = triangle[(k + 1) % 3];
            auto& [count, ascending] = edges[{std::min(a, b), std::max(a, b)}];
            ++count;
            ascending += a < b ? 1 : 0;
        }
    }
    return edges;
}

void expect_whole(const Midsurface& surface) {
    EXPECT_EQ(surface.thickness.size(), surface.mesh.vertices.size());
    EXPECT_EQ(surface.triangle_sheets.size(), surface.mesh.triangles.size());
    for (const auto& [edge, counts] : edges_of(surface)) {
        if (counts[0] == 2) {
            EXPECT_EQ(counts[1], 1) << "triangles of a sheet have one orientation";
        }
    }
    EXPECT_NO_THROW(check(complex_of(surface)));
}

TEST(Midsurface, OfAPlateIsARectangle) {
    for (const Midsurface& surface :
         {midsurface_of(box_mesh({0, 0, 0}, {10, 6, 1})).surface,
          midsurface(midsurface_of(box_mesh({0, 0, 0}, {10, 6, 1})).axis)}) {  // the envelope in place of the solid
        expect_whole(surface);
        ASSERT_EQ(surface.sheets.size(), 1U);
        EXPECT_NEAR(area(surface), 60.0, 0.02 * 60.0);
        EXPECT_NEAR(surface.border_length, 32.0, 0.02 * 32.0);
        EXPECT_NEAR(surface.sheets[0].mean, 1.0, 0.01);
        EXPECT_NEAR(surface.sheets[0].min, 1.0, 0.01);
        EXPECT_NEAR(surface.sheets[0].max, 1.0, 0.01);
        EXPECT_EQ(surface.seams, 0);
        EXPECT_GT(surface.left_out_area, 10.0);  // of the strips into the edges
        for (const Point& p : surface.mesh.vertices) {
            EXPECT_NEAR(p.z, 0.5, 0.01);
        }
    }
}

// Here crumbs of the strips into the edges hang on the sheet between the sides: spikes out of it, thin as 0.56.
TEST(Midsurface, OfALargePlateHasNoSpikesIntoItsEdges) {
    const Midsurface surface = midsurface_of(box_mesh({0, 0, 0}, {30, 20, 1})).surface;
    ASSERT_EQ(surface.sheets.size(), 1U);
    EXPECT_NEAR(area(surface), 600.0, 1.0);
    EXPECT_GT(surface.sheets[0].min, 0.9);
    for (const Point& p : surface.mesh.vertices) {
        EXPECT_NEAR(p.z, 0.5, 0.05);
    }
}

// The walls are 2.8 δ thick. Faces across the seam between what is a wall and what runs into an edge hung on it, thin
// as 0.55; seams ended before the rim, and sheets went on around them.
TEST(Midsurface, IsTheSameInAnyPosition) {
    Random random(1);
    for (int turn = 0; turn < 8; ++turn) {
        SCOPED_TRACE("turn " + std::to_string(turn) + " of seed 1");
        const Similarity position = random_turn(random);
        const Midsurface plate = midsurface_of(moved(box_mesh({0, 0, 0}, {30, 20, 1}), position)).surface;
        ASSERT_EQ(plate.sheets.size(), 1U);
        EXPECT_NEAR(area(plate), 600.0, 1.0);
        EXPECT_GT(plate.sheets[0].min, 0.75);
        const Midsurface profile = midsurface_of(moved(t_profile(), position)).surface;
        EXPECT_EQ(profile.sheets.size(), 3U);
        EXPECT_EQ(profile.seams, 1);
        EXPECT_NEAR(profile.seam_length, 6.0, 0.1);
    }
}

TEST(Midsurface, EndsHalfTheThicknessBeforeTheRimIfItIsNotExtended) {
    const Midsurface surface = midsurface_of(box_mesh({0, 0, 0}, {10, 6, 1}), 0.01, {.extends = false}).surface;
    ASSERT_EQ(surface.sheets.size(), 1U);
    EXPECT_NEAR(area(surface), 9.0 * 5.0, 0.02 * 45.0);
}

TEST(Midsurface, OfATProfileKeepsItsJunction) {
    const Midsurface surface = midsurface_of(t_profile()).surface;
    expect_whole(surface);
    EXPECT_EQ(surface.sheets.size(), 3U);
    EXPECT_EQ(surface.seams, 1);
    EXPECT_NEAR(surface.seam_length, 6.0, 0.1);
    for (const auto& [edge, counts] : edges_of(surface)) {
        EXPECT_LE(counts[0], 3);
        if (counts[0] == 3) {
            for (const Index v : edge) {
                EXPECT_NEAR(surface.mesh.vertices[v].x, 4.5, 0.1);
                EXPECT_NEAR(surface.mesh.vertices[v].z, 0.625, 0.07);  // as far from z = 0 as from both inner edges
            }
        }
    }
    EXPECT_NEAR(area(surface), 6.0 * (9.0 + 5.0 - 0.625), 0.02 * 80.0);
    for (const MidsurfaceSheet& sheet : surface.sheets) {
        EXPECT_NEAR(sheet.min, 1.0, 0.02);
        EXPECT_NEAR(sheet.max, 1.25, 0.02);
    }
}

/// Pieces of a surface without isolated vertices: each edge of a triangle that joins two leaves one less.
Index components(const Midsurface& surface) {
    DisjointSets sets(surface.mesh.vertices.size());
    auto count = static_cast<Index>(surface.mesh.vertices.size());
    for (const auto& [a, b, c] : surface.mesh.triangles) {
        count -= (sets.join(a, b) ? 1 : 0) + (sets.join(b, c) ? 1 : 0);
    }
    return count;
}

TEST(Midsurface, KeepsItsJunctions) {
    // Walls of thickness 1. Sheets of the axis bend where a wall meets them: parabolas with the re-entrant edges as
    // focus. So a wall is longer by 0.04 where another one ends in it, which begins 0.625 above its outer side; and
    // both are shorter by 0.074 where they meet in an L.
    constexpr double kT = 0.0402 - 0.125;  // beside a wall that ends in the middle of the other one
    constexpr double kL = -2.0 * 0.0742;
    struct Part {
        const char* name;
        std::vector<CellBox> boxes;
        std::size_t sheets;
        double seam;  // ends half a thickness before the end of a rib on a plate
        double area;
    };
    const std::vector<Part> parts{
        {"rib on a plate", {{{0, 0, 0}, {16, 10, 1}}, {{2, 4, 1}, {14, 5, 6}}}, 2, 11.0, 160.0 + 12.0 * (5.5 + kT)},
        {"crossed ribs",
         {{{0, 0, 0}, {16, 12, 1}}, {{2, 5, 1}, {14, 6, 6}}, {{7, 1, 1}, {8, 11, 6}}},
         5,
         11.0 + 9.0 + 5.4,
         192.0 + 22.0 * (5.5 + kT)},
        {"plus", {{{0, 0, 0}, {9, 12, 1}}, {{4, 0, -4}, {5, 12, 5}}}, 4, 12.0, 2.0 * 9.0 * 12.0},
        {"U",
         {{{0, 0, 0}, {6, 12, 1}}, {{0, 0, 1}, {1, 12, 5}}, {{5, 0, 1}, {6, 12, 5}}},
         1,
         0.0,
         12.0 * (5.0 + 2.0 * 4.5 + 2.0 * kL)},
        {"E",
         {{{0, 0, 0}, {5, 12, 1}}, {{0, 0, 4}, {5, 12, 5}}, {{0, 0, 8}, {5, 12, 9}}, {{0, 0, 0}, {1, 12, 9}}},
         3,
         12.0,
         12.0 * (8.0 + 3.0 * 4.5 + kT + 2.0 * kL)},
    };
    for (const Part& part : parts) {
        SCOPED_TRACE(part.name);
        const Midsurface surface = midsurface_of(boxes_mesh(part.boxes)).surface;
        expect_whole(surface);
        EXPECT_EQ(surface.sheets.size(), part.sheets);
        EXPECT_EQ(components(surface), 1);
        EXPECT_NEAR(surface.seam_length, part.seam, 0.02 * part.seam);
        EXPECT_NEAR(area(surface), part.area, 0.01 * part.area);
    }
}

// Beside a seam single faces may have a smaller angle than their sheet, and a seam may end just before the border.
// Where it is interrupted two sheets are one.
TEST(Midsurface, HasWholeSeamsInAnyPosition) {
    const TriangleMesh tee =
        test::prism({{-6, 0}, {6, 0}, {6, 1}, {0.5, 1}, {0.5, 7}, {-0.5, 7}, {-0.5, 1}, {-6, 1}}, 15.0);
    for (unsigned seed = 1; seed <= 24; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Midsurface surface = midsurface_of(moved(tee, random_turn(random)), 0.0147).surface;
        EXPECT_EQ(surface.sheets.size(), 3U);
        EXPECT_EQ(surface.seams, 1);
        EXPECT_NEAR(surface.seam_length, 15.0, 0.3);
    }
}

TEST(Midsurface, OfAnLProfileIsOneSheet) {
    const Midsurface surface = midsurface_of(l_profile()).surface;
    expect_whole(surface);
    ASSERT_EQ(surface.sheets.size(), 1U);
    EXPECT_EQ(surface.seams, 0);
    EXPECT_NEAR(area(surface), 6.0 * 2.0 * 4.45, 0.02 * 54.0);
    EXPECT_NEAR(surface.sheets[0].min, 1.0, 0.02);
    EXPECT_NEAR(surface.sheets[0].max, 2.0 * (2.0 - std::numbers::sqrt2), 0.02);
}

TEST(Midsurface, OfATubeIsACylinder) {
    const Midsurface surface = midsurface_of(revolved_mesh({{2, -3}, {3, -3}, {3, 3}, {2, 3}}, 96, 0.25)).surface;
    expect_whole(surface);
    ASSERT_EQ(surface.sheets.size(), 1U);
    EXPECT_NEAR(area(surface), 2.0 * std::numbers::pi * 2.5 * 6.0, 0.02 * 94.2);
    EXPECT_NEAR(surface.border_length, 2.0 * 2.0 * std::numbers::pi * 2.5, 0.5);
    EXPECT_NEAR(surface.sheets[0].mean, 1.0, 0.01);
    for (const Point& p : surface.mesh.vertices) {
        EXPECT_NEAR(std::hypot(p.x, p.y), 2.5, 0.03);
        EXPECT_LT(std::abs(p.z), 3.0 + 1e-6);
    }
}

// Round notches leave it a neck as wide as it is thick, where no sheet lies between its sides. The end beyond the neck
// has a long border, and the borders on both sides of the neck go on towards each other.
TEST(Midsurface, OfAPlateWithANeckHasBothEnds) {
    constexpr double kNotch = 3.5;
    std::vector<std::array<double, 2>> outline{{-20, -5}, {20, -5}, {20, 5}, {-20, 5}};
    for (const std::size_t side : {3U, 1U}) {  // the later one first
        std::vector<std::array<double, 2>> notch;
        for (int k = 0; k <= 32; ++k) {
            const double angle = std::numbers::pi * k / 32.0;
            const double turn = side == 1 ? 1.0 : -1.0;
            notch.push_back({13.0 - turn * kNotch * std::cos(angle), turn * (kNotch * std::sin(angle) - 5.0)});
        }
        outline.insert(outline.begin() + static_cast<std::ptrdiff_t>(side), notch.begin(), notch.end());
    }
    for (unsigned seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Random random(seed);
        const TriangleMesh plate = test::moved(test::prism(outline, 3.0), test::random_turn(random));
        const Midsurface surface = midsurface_of(plate).surface;
        expect_whole(surface);
        EXPECT_EQ(surface.seams, 0);
        EXPECT_NEAR(area(surface), 400.0 - std::numbers::pi * kNotch * kNotch, 0.02 * 361.5);
    }
}

// Sheets into its edges of 60° are no walls. From the inner corner to the bisector of the outer one a sheet follows a
// parabola.
TEST(Midsurface, OfATriangularTubeIsItsThreeWalls) {
    const double arc = 0.908;
    const double wall = 2.5 * 2.0 * std::numbers::sqrt3 + 2.0 * arc;
    const TriangleMesh tube = revolved_mesh({{5, -12}, {8, -12}, {8, 12}, {5, 12}}, 3, 24.0);
    for (unsigned seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Random random(seed);
        const Midsurface surface = midsurface_of(test::moved(tube, test::random_turn(random))).surface;
        expect_whole(surface);
        EXPECT_EQ(surface.sheets.size(), 1U);
        EXPECT_EQ(surface.seams, 0);
        EXPECT_NEAR(area(surface), 3.0 * wall * 24.0, 0.01 * 754.0);
        EXPECT_GT(surface.sheets[0].min, 0.95 * 1.5);
    }
}

TEST(Midsurface, IsEmptyWhereThereAreNoWalls) {
    const Midsurface ball = midsurface_of(sphere_mesh({0, 0, 0}, 1, 3), 0.03).surface;
    EXPECT_TRUE(ball.mesh.triangles.empty());
    EXPECT_TRUE(ball.mesh.vertices.empty());
    EXPECT_TRUE(ball.sheets.empty());
    EXPECT_TRUE(midsurface_of(box_mesh({0, 0, 0}, {1, 1, 6}), 0.01).surface.sheets.empty());  // all in its edges
    MedialComplex rod;
    rod.vertices = {{0, 0, 0}, {3, 0, 0}};
    rod.radii = {1, 1};
    rod.vertex_origins.assign(2, {VertexKind::kTouching});
    rod.edges = {{0, 1}};
    const Midsurface none = midsurface(rod);
    EXPECT_TRUE(none.sheets.empty());
    EXPECT_EQ(none.left_out_curves, 1);
    EXPECT_EQ(none.left_out_length, 3.0);
}

TEST(Midsurface, DoesNotDependOnThreads) {
    const TriangleMesh mesh = box_mesh({0, 0, 0}, {10, 6, 1});
    const auto solid = mesh_solid(mesh);
    const MedialComplex axis = scale_axis(*solid, {.delta = Length::relative(0.02)}).axes[0].complex;
    const Midsurface one = midsurface(axis, *solid, {}, {.threads = 1});
    const Midsurface two = midsurface(axis, *solid, {}, {.threads = 2});
    EXPECT_EQ(one.mesh.vertices, two.mesh.vertices);
    EXPECT_EQ(one.mesh.triangles, two.mesh.triangles);
    EXPECT_EQ(one.thickness, two.thickness);
}

TEST(Midsurface, RefusesWhatItCannotTake) {
    MedialComplex complex;
    complex.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    complex.radii = {1, 1, 1};
    complex.vertex_origins.assign(3, {VertexKind::kTouching});
    complex.edges = {{0, 1}, {0, 2}, {1, 2}};
    complex.faces.push_back(std::vector<Index>{0, 1, 2});
    complex.face_edges.push_back(std::vector<Index>{0, 2, 1});
    complex.face_angles = {0.0};
    complex.face_sheets = {0};
    complex.sheets = 1;
    EXPECT_THROW(midsurface(complex), UnusableInput);
    complex.face_angles = {90.0};
    EXPECT_NO_THROW(midsurface(complex));
    for (const double angle : {0.0, 91.0, std::nan("")}) {
        EXPECT_THROW(midsurface(complex, {.angle = angle}), InvalidOption);
    }
}

}  // namespace
}  // namespace scaleaxis
