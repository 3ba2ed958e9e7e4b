// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include "executions.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/thickness.hpp"
#include "uses/flat_faces.hpp"

namespace scaleaxis {
namespace {

using test::box_mesh;
using test::is_in;
using test::rectilinear;
using test::revolved_mesh;
using test::sphere_mesh;

// Turned, so that no face is parallel to a plane of coordinates.
TriangleMesh turned(TriangleMesh mesh) {
    const Point x = unit({2, 1, -0.5});
    const Point y = unit(cross({0.3, -1, 2}, x));
    const Point z = cross(x, y);
    for (Point& p : mesh.vertices) {
        p = p.x * x + p.y * y + p.z * z + Point{3, -7, 11};
    }
    return mesh;
}

Walls walls_of(const TriangleMesh& mesh, const WallOptions& options, const Execution& execution = {}) {
    return find_walls(*mesh_solid(mesh), mesh, options, execution);
}

TEST(Walls, FindAPlateBelowTheLimitAndNotOneAtIt) {
    const TriangleMesh plate = turned(box_mesh({0, 0, 0}, {20, 10, 0.8}));
    EXPECT_TRUE(walls_of(plate, {.min_wall = 0.8}).findings.empty());
    const Walls walls = walls_of(plate, {.min_wall = 0.81});
    ASSERT_EQ(walls.findings.size(), 1U);
    const Finding& finding = walls.findings[0];
    EXPECT_EQ(finding.kind, FindingKind::kThinWall);
    EXPECT_NEAR(finding.value, 0.8, 0.003);
    EXPECT_EQ(finding.value, 2.0 * finding.ball.radius);
    EXPECT_EQ(finding.limit, 0.81);
    EXPECT_NEAR(finding.area, 448.0, 1.0);  // all of the surface, both sides and rim
    EXPECT_NEAR(finding.extent.diagonal(), 27.0, 6.0);
    EXPECT_EQ(walls.tolerance, 0.003);
    // Whatever the other limits are.
    EXPECT_EQ(walls_of(plate, {.min_wall = 0.81, .max_wall = 400.0, .min_gap = 400.0}).findings.size(), 1U);
    const double along = std::abs(dot(finding.direction, unit(finding.contacts[1] - finding.contacts[0])));
    EXPECT_NEAR(along, 1.0, 1e-9);
}

TEST(Walls, TellRibsAndTheGapBetweenThemApart) {
    // A block with two ribs of 0.5 and 0.9, 0.4 apart.
    const TriangleMesh part =
        turned(rectilinear({{{0, 1, 9, 10}, {0, 3, 3.5, 3.9, 4.8, 8}, {0, 3, 8}}}, [](const Point& p) {
            return p.z < 3 || is_in(p, {1, 3, 3}, {9, 3.5, 8}) || is_in(p, {1, 3.9, 3}, {9, 4.8, 8});
        }));
    const Walls walls = walls_of(part, {.min_wall = 0.8, .min_gap = 0.6});
    ASSERT_EQ(walls.findings.size(), 2U);
    EXPECT_EQ(walls.findings[0].kind, FindingKind::kThinWall);
    EXPECT_NEAR(walls.findings[0].value, 0.5, 0.005);
    EXPECT_NEAR(walls.findings[0].area, 2 * 8 * 5 + 0.5 * (8 + 2 * 5), 2.0);
    EXPECT_EQ(walls.findings[1].kind, FindingKind::kNarrowGap);
    EXPECT_NEAR(walls.findings[1].value, 0.4, 0.004);
    EXPECT_NEAR(walls.findings[1].area, 2 * 8 * 5 + 0.4 * 8, 5.0);  // less where it opens
    const auto count = std::ranges::count(walls.wall_findings, 0);
    EXPECT_EQ(count, walls.findings[0].vertices);
    EXPECT_EQ(walls.wall.size(), walls.surface.vertices.size());
}

TEST(Walls, AreThoseThatThePointIsOn) {
    // A cap of 1 on a wall of 0.6: on top of the cap nothing is thin.
    const TriangleMesh part = rectilinear({{{0, 2, 2.6, 4.6}, {0, 8}, {0, 2, 6, 7}}}, [](const Point& p) {
        return p.z < 2 || (p.z > 6 && p.x > 2) || (p.x > 2 && p.x < 2.6);
    });
    const Walls walls = walls_of(part, {.min_wall = 0.8, .edge = 0.03});
    ASSERT_EQ(walls.findings.size(), 1U);
    EXPECT_NEAR(walls.findings[0].value, 0.6, 0.002);
    for (std::size_t v = 0; v < walls.wall.size(); ++v) {
        if (walls.surface.vertices[v].z == 7) {
            EXPECT_GT(walls.wall[v], 0.99);
        }
    }
    EXPECT_NEAR(walls.findings[0].area, 2 * 8 * 4 + 2 * 0.6 * 4, 5.0);  // less beside the cap and the base
}

TEST(Walls, AreNotWhereEdgesAndCornersAre) {
    EXPECT_TRUE(walls_of(box_mesh({0, 0, 0}, {5, 6, 7}), {.min_wall = 1.0, .min_gap = 1.0}).findings.empty());
    // A step: its re-entrant edge is no gap.
    const TriangleMesh step =
        rectilinear({{{0, 5, 9}, {0, 8}, {0, 5, 9}}}, [](const Point& p) { return p.x < 5 || p.z < 5; });
    EXPECT_TRUE(walls_of(turned(step), {.min_wall = 1.0, .min_gap = 1.0}).findings.empty());
}

// A prism over a rhombus with this angle at its tips.
TriangleMesh wedges(double degrees) {
    const double half = 4.0 * std::tan(0.5 * degrees * std::numbers::pi / 180.0);
    TriangleMesh mesh;
    for (const double z : {0.0, 6.0}) {
        mesh.vertices.insert(mesh.vertices.end(), {{0, 0, z}, {4, -half, z}, {8, 0, z}, {4, half, z}});
    }
    mesh.triangles = {{0, 3, 1}, {1, 3, 2}, {4, 5, 7}, {5, 6, 7}};
    for (Index k = 0; k < 4; ++k) {
        const Index next = (k + 1) % 4;
        mesh.triangles.push_back({k, next, next + 4});
        mesh.triangles.push_back({k, next + 4, k + 4});
    }
    return mesh;
}

TEST(Walls, EndInSharpEdgesOfLessThan60Degrees) {
    const Walls sharp = walls_of(turned(wedges(20)), {.min_wall = 0.5});
    ASSERT_EQ(sharp.findings.size(), 2U);
    for (const Finding& finding : sharp.findings) {
        EXPECT_LT(finding.value, 0.02);
        EXPECT_NEAR(norm(finding.direction), 1.0, 1e-9);
    }
    EXPECT_TRUE(walls_of(turned(wedges(65)), {.min_wall = 0.5}).findings.empty());
}

TEST(Walls, FindATipThatNearlyMeetsAFace) {
    // A disc with a conical hole of 90 degrees, whose tip is 0.5 above the bottom.
    const TriangleMesh disc = turned(revolved_mesh({{0, 0}, {8, 0}, {8, 3}, {2.5, 3}, {0, 0.5}}, 48, 20));
    const Walls walls = walls_of(disc, {.min_wall = 0.52, .edge = 0.2});
    ASSERT_EQ(walls.findings.size(), 1U);
    EXPECT_NEAR(walls.findings[0].value, 0.5, 0.0025);
}

// A plate with grooves across each other on both sides, 0.4 apart in one point: nothing else there is thinner than 1.
// \param shift of vertices away from the crossing, along each groove
TriangleMesh crossing_grooves(double shift) {
    TriangleMesh mesh =
        rectilinear({{{0, 4, 5, 6, 10}, {0, 4, 5, 6, 10}, {0, 2.4}}}, [](const Point&) { return true; });
    for (Point& p : mesh.vertices) {
        const bool is_middle = p.x == 5 && p.y == 5;
        if (p.x == 5 && p.z == 2.4) {
            p = {5, is_middle ? 5 + shift : p.y, 1.4};
        } else if (p.y == 5 && p.z == 0) {
            p = {is_middle ? 5 + shift : p.x, 5, 1.0};
        }
    }
    return turned(mesh);
}

TEST(Walls, FindWhereTwoGroovesNearlyCross) {
    const Walls walls = walls_of(crossing_grooves(0.0), {.min_wall = 0.41, .edge = 1.0});
    ASSERT_EQ(walls.findings.size(), 1U);
    EXPECT_NEAR(walls.findings[0].value, 0.4, 0.004);
    EXPECT_GT(walls.findings[0].vertices, 0);
}

TEST(Walls, FindWhatIsThinBetweenVerticesAlone) {
    // On both grooves the vertices beside the crossing are 0.03 from it, where 0.4024 is opposite.
    const Walls walls = walls_of(crossing_grooves(0.1), {.min_wall = 0.402, .edge = 1.0});
    ASSERT_EQ(walls.findings.size(), 1U);
    EXPECT_NEAR(walls.findings[0].value, 0.4, 0.0005);
    EXPECT_GT(walls.findings[0].vertices, 0);
}

TEST(Walls, FindThickOnes) {
    // A plate of 2 with a block of 6.
    const TriangleMesh part = turned(rectilinear({{{0, 8, 14, 22}, {0, 8, 14, 22}, {0, 2, 6}}}, [](const Point& p) {
        return p.z < 2 || is_in(p, {8, 8, 0}, {14, 14, 6});
    }));
    EXPECT_TRUE(walls_of(part, {.max_wall = 6.5}).findings.empty());
    const Walls walls = walls_of(part, {.max_wall = 3});
    ASSERT_EQ(walls.findings.size(), 1U);
    EXPECT_EQ(walls.findings[0].kind, FindingKind::kThickWall);
    EXPECT_NEAR(walls.findings[0].value, 6.0, 0.3);
}

void append(TriangleMesh& mesh, const TriangleMesh& other, bool is_void) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& [a, b, c] : other.triangles) {
        mesh.triangles.push_back(is_void ? std::array{first + a, first + c, first + b}
                                         : std::array{first + a, first + b, first + c});
    }
}

TEST(Walls, AreNotWherePartsOverlap) {
    TriangleMesh two = box_mesh({0, 0, 0}, {3, 3, 3});
    append(two, box_mesh({2.8, 0.1, 0.1}, {5.8, 3.1, 3.1}), false);
    EXPECT_TRUE(walls_of(two, {.min_wall = 0.5, .min_gap = 0.5}).findings.empty());
}

TEST(Walls, FindGapsBetweenPartsAndInVoids) {
    TriangleMesh two = box_mesh({0, 0, 0}, {5, 5, 5});
    append(two, box_mesh({5.3, 0, 0}, {10, 5, 5}), false);
    append(two, sphere_mesh({2.5, 2.5, 2.5}, 0.1, 3), true);
    const Walls walls = walls_of(turned(two), {.min_gap = 0.6});
    ASSERT_EQ(walls.findings.size(), 2U);
    EXPECT_NEAR(walls.findings[0].value, 0.2, 0.004);
    EXPECT_NEAR(walls.findings[1].value, 0.3, 0.003);
    EXPECT_TRUE(walls.wall.empty());
}

TEST(Walls, HaveADirectionHoweverThinTheyAre) {
    const Walls wall = walls_of(box_mesh({0, 0, 0}, {1, 1, 0.01}), {.min_wall = 0.3});
    ASSERT_EQ(wall.findings.size(), 1U);
    EXPECT_NEAR(std::abs(wall.findings[0].direction.z), 1.0, 1e-9);
    TriangleMesh two = box_mesh({0, 0, 0}, {1, 1, 1});
    append(two, box_mesh({1.01, 0, 0}, {2.01, 1, 1}), false);
    const Walls gap = walls_of(two, {.min_gap = 0.2});
    ASSERT_EQ(gap.findings.size(), 1U);
    EXPECT_NEAR(std::abs(gap.findings[0].direction.x), 1.0, 1e-9);
}

TEST(Walls, AreTheSameForAnyNumberOfThreads) {
    const TriangleMesh part = turned(rectilinear({{{0, 1, 9, 10}, {0, 3, 3.5, 8}, {0, 3, 8}}}, [](const Point& p) {
        return p.z < 3 || is_in(p, {1, 3, 3}, {9, 3.5, 8});
    }));
    const WallOptions options{.min_wall = 0.8, .max_wall = 2.5, .min_gap = 0.6};
    const Walls one = walls_of(part, options, {.threads = 1});
    const Walls four = walls_of(part, options, {.threads = 4});
    EXPECT_EQ(one.surface.vertices, four.surface.vertices);
    EXPECT_EQ(one.wall, four.wall);
    ASSERT_EQ(one.findings.size(), four.findings.size());
    for (std::size_t i = 0; i < one.findings.size(); ++i) {
        EXPECT_EQ(one.findings[i].ball, four.findings[i].ball);
    }
    const auto solid = mesh_solid(part);
    test::expect_progress_and_cancellation(
        [&](const Execution& execution) { find_walls(*solid, part, options, execution); });
}

TEST(Walls, RefuseLimitsThatMakeNoSense) {
    const TriangleMesh box = box_mesh({0, 0, 0}, {1, 1, 1});
    EXPECT_THROW(walls_of(box, {}), InvalidOption);
    EXPECT_THROW(walls_of(box, {.min_wall = 0.0}), InvalidOption);
    EXPECT_THROW(walls_of(box, {.min_wall = 2.0, .max_wall = 1.0}), InvalidOption);
    EXPECT_THROW(walls_of(box, {.min_wall = 0.1, .angle = 20.0}), InvalidOption);
    EXPECT_THROW(walls_of(box, {.min_wall = 0.1, .edge = 0.0}), InvalidOption);
}

TEST(Walls, AtPoints) {
    const auto plate = mesh_solid(box_mesh({0, 0, 0}, {20, 10, 2}));
    const std::vector<Point> points{{7, 5, 2}, {7, 5, 0}, {7, 5, 0.4}, {20, 5, 1}};
    for (const WallAt& wall : wall_at(*plate, points)) {
        EXPECT_NEAR(wall.value, 2.0, 0.006);
        EXPECT_NEAR(std::abs(wall.contacts[0].z - wall.contacts[1].z), 2.0, 0.01);
    }
    EXPECT_TRUE(std::isinf(gap_at(*plate, points)[0].value));
    const auto slotted = mesh_solid(rectilinear({{{0, 4, 4.5, 9}, {0, 9}, {0, 3, 9}}},
                                                [](const Point& p) { return p.z < 3 || p.x < 4 || p.x > 4.5; }));
    const std::vector<Point> in_slot{{4, 4, 6}, {4.5, 4, 6}, {4.2, 4, 6}};
    for (const WallAt& gap : gap_at(*slotted, in_slot)) {
        EXPECT_NEAR(gap.value, 0.5, 0.002);
    }
}

TEST(FlatFaces, RefuseTrianglesWithoutTheirVertices) {
    const std::vector<Point> vertices{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    EXPECT_THROW(with_delaunay_faces({vertices, {{0, 1, 3}}}), UnusableInput);
    EXPECT_THROW(with_delaunay_faces({vertices, {{0, -1, 2}}}), UnusableInput);
}

TEST(FlatFaces, TurnFansOfNeedlesIntoDelaunayTriangles) {
    // A disc whose faces are fans around one corner of the rim.
    constexpr int kCorners = 64;
    TriangleMesh disc;
    for (const double z : {0.0, 1.0}) {
        for (int k = 0; k < kCorners; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / kCorners;
            disc.vertices.push_back({(5 + 0.3 * (k % 2)) * std::cos(angle), 4 * std::sin(angle), z});
        }
    }
    for (Index k = 0; k < kCorners; ++k) {
        const Index next = (k + 1) % kCorners;
        disc.triangles.push_back({k, next, next + kCorners});
        disc.triangles.push_back({k, next + kCorners, k + kCorners});
    }
    TriangleMesh closed = disc;
    closed.vertices.push_back({4.9, 0.1, 0});
    closed.vertices.push_back({4.9, 0.1, 1});
    for (Index k = 0; k < kCorners; ++k) {
        const Index next = (k + 1) % kCorners;
        closed.triangles.push_back({next, k, 2 * kCorners});
        closed.triangles.push_back({k + kCorners, next + kCorners, 2 * kCorners + 1});
    }
    const TriangleMesh better = with_delaunay_faces(closed);
    EXPECT_EQ(better.vertices, closed.vertices);
    ASSERT_EQ(better.triangles.size(), closed.triangles.size());
    const auto volume = [](const TriangleMesh& mesh) {
        double sum = 0.0;
        for (const auto& [a, b, c] : mesh.triangles) {
            sum += dot(mesh.vertices[a], cross(mesh.vertices[b], mesh.vertices[c])) / 6.0;
        }
        return sum;
    };
    EXPECT_NEAR(volume(better), volume(closed), 1e-9);
    EXPECT_TRUE(repair(better).report.fault.empty());
    EXPECT_LT(with_short_edges(better, 0.5).vertices.size(), with_short_edges(closed, 0.5).vertices.size() / 2);
}

}  // namespace
}  // namespace scaleaxis
