// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "meshes.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/solid.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using test::together;
using test::winding_by_solid_angle;
using Triangle = std::array<Index, 3>;

// ---------------------------------------------------------------------------------------------------------------------
// Meshes
// ---------------------------------------------------------------------------------------------------------------------

/// The box between two corners, outward.
TriangleMesh box(const Point& low, const Point& high) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.vertices.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

TriangleMesh cube(double half_side) {
    return box({-half_side, -half_side, -half_side}, {half_side, half_side, half_side});
}

/// `n × m` quadrilaterals, bent around in both directions so that `point(i, j)` repeats; a torus, if so.
template <class PointOf>
TriangleMesh grid(int n, int m, const PointOf& point) {
    TriangleMesh mesh;
    const auto id = [&](int i, int j) { return static_cast<Index>((i % n) * m + j % m); };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            mesh.vertices.push_back(point(2.0 * std::numbers::pi * i / n, 2.0 * std::numbers::pi * j / m));
            mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    }
    return mesh;
}

TriangleMesh torus(int n = 24, int m = 12) {
    return grid(n, m, [](double u, double v) {
        return Point{(2.0 + std::cos(v)) * std::cos(u), (2.0 + std::cos(v)) * std::sin(u), std::sin(v)};
    });
}

TriangleMesh moved(TriangleMesh mesh, const Point& by, double scale = 1.0) {
    for (Point& p : mesh.vertices) {
        p = scale * p + by;
    }
    return mesh;
}

void turn_over(Triangle& triangle) { std::swap(triangle[0], triangle[1]); }

TriangleMesh inside_out(TriangleMesh mesh) {
    std::ranges::for_each(mesh.triangles, turn_over);
    return mesh;
}

/// Every triangle with vertices of its own.
TriangleMesh soup(const TriangleMesh& mesh) {
    TriangleMesh result;
    for (const Triangle& triangle : mesh.triangles) {
        const auto first = static_cast<Index>(result.vertices.size());
        for (const Index v : triangle) {
            result.vertices.push_back(mesh.vertices[v]);
        }
        result.triangles.push_back({first, first + 1, first + 2});
    }
    return result;
}

/// Every side has exactly one reverse side, and every vertex a single fan of triangles.
void expect_closed_manifold(const TriangleMesh& mesh) {
    std::map<std::array<Index, 2>, Index> apex_of_side;
    std::vector<std::size_t> sides_from(mesh.vertices.size(), 0);
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            ASSERT_TRUE(apex_of_side.emplace(std::array{t[k], t[(k + 1) % 3]}, t[(k + 2) % 3]).second);
            ++sides_from[t[k]];
        }
    }
    std::vector<bool> is_seen(mesh.vertices.size(), false);
    for (const auto& [side, apex] : apex_of_side) {
        ASSERT_TRUE(apex_of_side.contains({side[1], side[0]}));
        const Index v = side[0];
        if (!is_seen[v]) {
            is_seen[v] = true;
            std::size_t size = 0;
            Index spoke = side[1];
            do {
                spoke = apex_of_side.at({v, spoke});
                ++size;
            } while (spoke != side[1]);
            EXPECT_EQ(size, sides_from[v]) << "vertex " << v << " has several fans";
        }
    }
    EXPECT_TRUE(std::ranges::all_of(is_seen, [](bool seen) { return seen; })) << "an isolated vertex";
}

/// As many sides run along every edge one way as the other.
void expect_balanced(const TriangleMesh& mesh) {
    std::map<std::array<Index, 2>, int> balance;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const Index a = t[k], b = t[(k + 1) % 3];
            balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    }
    EXPECT_TRUE(std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; }));
}

/// Repairs a mesh that can be repaired, and checks what holds for every result.
RepairedMesh repaired(const TriangleMesh& mesh) {
    RepairedMesh result = repair(mesh);
    const MeshReport& report = result.report;
    EXPECT_EQ(report.fault.message, "");
    EXPECT_TRUE(report.is_closed());
    EXPECT_TRUE(report.is_manifold());
    EXPECT_EQ(report.vertices, static_cast<std::int64_t>(mesh.vertices.size()));
    EXPECT_EQ(report.triangles, static_cast<std::int64_t>(mesh.triangles.size()));
    EXPECT_EQ(report.euler, 2 * (report.components - report.genus));
    expect_closed_manifold(result.mesh);
    // A second repair finds nothing to do.
    const RepairedMesh again = repair(result.mesh);
    EXPECT_EQ(again.report.fault.message, "");
    EXPECT_EQ(again.mesh.triangles, result.mesh.triangles);
    EXPECT_EQ(again.mesh.vertices, result.mesh.vertices);
    return result;
}

void expect_fault(const TriangleMesh& mesh, const std::vector<std::string>& words) {
    const std::string fault = repair(mesh).report.fault.message;
    EXPECT_NE(fault, "");
    EXPECT_EQ(fault.find('\n'), std::string::npos);
    for (const std::string& word : words) {
        EXPECT_NE(fault.find(word), std::string::npos) << "'" << word << "' is not in: " << fault;
    }
}

using Lines = std::vector<std::string>;

Lines messages(const std::vector<Diagnostic>& diagnostics) {
    Lines lines;
    std::ranges::transform(diagnostics, std::back_inserter(lines), &Diagnostic::message);
    return lines;
}

// ---------------------------------------------------------------------------------------------------------------------
// Sound meshes
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshRepair, LeavesASoundMeshAlone) {
    const TriangleMesh mesh = box({-1.0, 0.0, 2.0}, {1.0, 3.0, 6.0});
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.mesh.vertices, mesh.vertices);
    EXPECT_EQ(result.mesh.triangles, mesh.triangles);
    EXPECT_EQ(messages(result.report.warnings()), Lines{});
    EXPECT_EQ(result.report.components, 1);
    EXPECT_EQ(result.report.euler, 2);
    EXPECT_EQ(result.report.genus, 0);
    EXPECT_DOUBLE_EQ(result.report.area, 2.0 * (6.0 + 8.0 + 12.0));
    EXPECT_DOUBLE_EQ(result.report.volume, 24.0);
    EXPECT_EQ(result.report.bounds.min, mesh.vertices[0]);
    EXPECT_EQ(result.report.bounds.max, mesh.vertices[7]);
}

TEST(MeshRepair, ReportsTheTopologyOfTheSurface) {
    const RepairedMesh one = repaired(torus());
    EXPECT_EQ(one.report.euler, 0);
    EXPECT_EQ(one.report.genus, 1);
    const RepairedMesh all = repaired(together({torus(), moved(torus(), {9, 0, 0}), moved(cube(1), {0, 9, 0})}));
    EXPECT_EQ(all.report.components, 3);
    EXPECT_EQ(all.report.euler, 2);
    EXPECT_EQ(all.report.genus, 2);
    EXPECT_EQ(messages(all.report.warnings()), Lines{});
}

TEST(MeshRepair, TakesEverySizeAndAReasonableDistance) {
    for (const double scale : {1e-30, 1e-9, 1e9, 1e17}) {
        const RepairedMesh result = repaired(moved(cube(1.0), {}, scale));
        EXPECT_NEAR(result.report.volume / std::pow(2.0 * scale, 3), 1.0, 1e-12);
    }
    EXPECT_NEAR(repaired(moved(cube(1.0), {1e6, -1e6, 1e6})).report.volume, 8.0, 1e-8);
}

// ---------------------------------------------------------------------------------------------------------------------
// Repairs
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshRepair, LeavesOutIsolatedVertices) {
    TriangleMesh mesh = cube(1.0);
    mesh.vertices.insert(mesh.vertices.begin(), {100.0, 0.0, 0.0});
    for (Triangle& triangle : mesh.triangles) {
        for (Index& v : triangle) {
            ++v;
        }
    }
    mesh.vertices.push_back({0.0, 100.0, 0.0});
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.mesh.vertices, cube(1.0).vertices);
    EXPECT_EQ(result.mesh.triangles, cube(1.0).triangles);
    EXPECT_EQ(result.report.isolated_vertices, 2);
    EXPECT_EQ(result.report.bounds.max, (Point{1.0, 1.0, 1.0}));
    EXPECT_EQ(messages(result.report.warnings()), Lines{"2 isolated vertices left out"});
}

TEST(MeshRepair, LeavesOutCollapsedTriangles) {
    TriangleMesh mesh = cube(1.0);
    mesh.triangles.insert(mesh.triangles.begin() + 3, {5, 5, 6});
    mesh.triangles.push_back({1, 1, 1});
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.mesh.triangles, cube(1.0).triangles);
    EXPECT_EQ(result.report.degenerate_triangles, 2);
    ASSERT_EQ(result.report.warnings().size(), 1u);
    EXPECT_TRUE(result.report.warnings()[0].message.starts_with("2 degenerate triangles"));
}

TEST(MeshRepair, KeepsTrianglesWithoutAreaThatCloseTheMesh) {
    // Vertex 8 in the middle of an edge of one of its two triangles; a triangle without area fills the slit.
    TriangleMesh mesh = cube(1.0);
    mesh.vertices.push_back({0.0, -1.0, -1.0});
    std::erase(mesh.triangles, Triangle{0, 2, 1});
    mesh.triangles.insert(mesh.triangles.end(), {{0, 2, 8}, {8, 2, 1}, {0, 8, 1}});
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.mesh.triangles.size(), 14u);
    EXPECT_EQ(result.report.degenerate_triangles, 1);
    EXPECT_DOUBLE_EQ(result.report.volume, 8.0);
}

TEST(MeshRepair, WeldsASoup) {
    const TriangleMesh mesh = torus();
    const RepairedMesh result = repaired(soup(mesh));
    EXPECT_EQ(result.mesh.vertices.size(), mesh.vertices.size());
    EXPECT_EQ(result.report.duplicate_vertices, static_cast<std::int64_t>(5 * mesh.vertices.size()));
    EXPECT_EQ(result.report.genus, 1);
    EXPECT_NEAR(result.report.volume, repaired(mesh).report.volume, 1e-12);
}

TEST(MeshRepair, WeldsASeamAndTakesZeroAndMinusZeroForOne) {
    TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
    mesh.vertices.insert(mesh.vertices.end(), {{-0.0, 0, 0}, {0, -0.0, 1}});  // the edge from 0 to 4
    mesh.triangles[8] = {8, 9, 2};
    mesh.triangles[9] = {2, 9, 6};
    mesh.triangles[0] = {8, 2, 1};
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.report.duplicate_vertices, 2);
    EXPECT_EQ(result.mesh.vertices.size(), 8u);
    EXPECT_EQ(messages(result.report.warnings()), Lines{"2 duplicate vertices welded"});
}

TEST(MeshRepair, DoesNotWeldClosedPartsThatTouch) {
    // Two cubes with an edge in common: welded, it would have four triangles.
    const RepairedMesh result = repaired(together({box({0, 0, 0}, {1, 1, 1}), box({1, 1, 0}, {2, 2, 1})}));
    EXPECT_EQ(result.mesh.vertices.size(), 16u);
    EXPECT_EQ(result.report.duplicate_vertices, 0);
    EXPECT_EQ(result.report.components, 2);
}

TEST(MeshRepair, LeavesOutCopiesOfTriangles) {
    const TriangleMesh sound = cube(1.0);
    TriangleMesh mesh = sound;
    mesh.triangles.push_back(sound.triangles[3]);                                                     // twice
    mesh.triangles.push_back({sound.triangles[5][1], sound.triangles[5][2], sound.triangles[5][0]});  // rotated
    mesh.triangles.push_back(sound.triangles[5]);                                                     // three times
    mesh.triangles.push_back(sound.triangles[7]);
    turn_over(mesh.triangles.back());
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.mesh.triangles, sound.triangles);
    EXPECT_EQ(result.report.duplicate_triangles, 4);
    EXPECT_EQ(messages(result.report.warnings()), Lines{"4 duplicate triangles left out"});
}

TEST(MeshRepair, MakesOneOfAMeshWithEachTriangleTwice) {
    for (const bool is_turned : {false, true}) {
        TriangleMesh mesh = torus();
        for (const Triangle& triangle : torus().triangles) {
            mesh.triangles.push_back(triangle);
            if (is_turned) {
                turn_over(mesh.triangles.back());
            }
        }
        const RepairedMesh result = repaired(mesh);
        EXPECT_EQ(result.mesh.triangles, torus().triangles);
        // And where the copies have vertices of their own.
        EXPECT_EQ(repaired(soup(mesh)).mesh.triangles.size(), torus().triangles.size());
    }
}

TEST(MeshRepair, RemovesAWallBetweenTwoParts) {
    // Two boxes, each closed, with the corners of the side between them in common: 1, 3, 5, 7 of the first.
    const TriangleMesh whole = box({0, 0, 0}, {1, 1, 1});
    TriangleMesh mesh = whole;
    const TriangleMesh other = box({1, 0, 0}, {3, 1, 1});
    std::array<Index, 8> id{1, 8, 3, 9, 5, 10, 7, 11};
    for (const int corner : {1, 3, 5, 7}) {
        mesh.vertices.push_back(other.vertices[corner]);
    }
    for (const auto& [a, b, c] : other.triangles) {
        mesh.triangles.push_back({id[a], id[b], id[c]});
    }
    // The wall's two quadrilaterals have to have the same diagonal for this.
    mesh.triangles[10] = {1, 3, 5};
    mesh.triangles[11] = {3, 7, 5};
    std::erase(mesh.triangles, Triangle{1, 5, 3});
    std::erase(mesh.triangles, Triangle{3, 5, 7});
    mesh.triangles.push_back({1, 5, 3});
    mesh.triangles.push_back({3, 5, 7});
    for (const bool is_soup : {false, true}) {
        const RepairedMesh result = repaired(is_soup ? soup(mesh) : mesh);
        EXPECT_EQ(result.report.duplicate_triangles, 4);
        EXPECT_EQ(result.report.components, 1);
        EXPECT_EQ(result.report.genus, 0);
        EXPECT_DOUBLE_EQ(result.report.volume, 3.0);
    }
}

TEST(MeshRepair, RemovesAFin) {
    TriangleMesh mesh = cube(1.0);
    mesh.vertices.push_back({0.0, 5.0, 5.0});
    mesh.triangles.push_back({6, 7, 8});
    mesh.triangles.push_back({7, 6, 8});
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.report.duplicate_triangles, 2);
    EXPECT_EQ(result.mesh.triangles, cube(1.0).triangles);
    EXPECT_EQ(result.mesh.vertices, cube(1.0).vertices);
}

TEST(MeshRepair, SplitsAVertexWithTwoFans) {
    // Two tetrahedra tip to tip.
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {-1, 1, -1}, {-1, -1, -1}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}};
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.report.split_vertices, 1);
    EXPECT_EQ(result.mesh.vertices.size(), 8u);
    EXPECT_EQ(result.mesh.vertices[7], mesh.vertices[0]);
    EXPECT_EQ(result.report.components, 2);
    EXPECT_EQ(result.report.euler, 4);
    EXPECT_EQ(result.report.genus, 0);
    EXPECT_EQ(messages(result.report.warnings()), Lines{"1 non-manifold vertex split"});
}

TEST(MeshRepair, CountsAVertexWithManyFansOnce) {
    std::vector<TriangleMesh> spikes;
    for (int i = 0; i < 6; ++i) {
        const double angle = std::numbers::pi * i / 3.0;
        const Point out{std::cos(angle), std::sin(angle), 0.0};
        const Point side{-0.2 * std::sin(angle), 0.2 * std::cos(angle), 0.0};
        spikes.push_back({{{0, 0, 0}, out - side, out + side, out + Point{0, 0, 0.3}},
                          {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}}});
    }
    TriangleMesh mesh = together(spikes);
    for (Triangle& triangle : mesh.triangles) {
        for (Index& v : triangle) {
            v = v % 4 == 0 ? 0 : v;
        }
    }
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.report.split_vertices, 1);
    EXPECT_EQ(result.report.isolated_vertices, 5);
    EXPECT_EQ(result.report.components, 6);
    EXPECT_EQ(result.mesh.vertices.size(), 24u);
}

// ---------------------------------------------------------------------------------------------------------------------
// Orientation
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshRepair, TurnsTheMinorityOfTriangles) {
    constexpr std::uint64_t kSeed = 5;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random(kSeed);
    for (const double share : {0.01, 0.2, 0.45}) {
        TriangleMesh mesh = torus();
        std::int64_t turned = 0;
        for (Triangle& triangle : mesh.triangles) {
            if (std::generate_canonical<double, 53>(random) < share) {
                turn_over(triangle);
                ++turned;
            }
        }
        ASSERT_LT(2 * turned, static_cast<std::int64_t>(mesh.triangles.size()));
        const RepairedMesh result = repaired(mesh);
        EXPECT_EQ(result.report.reversed_triangles, turned);
        EXPECT_EQ(result.report.reversed_components, 0);
        EXPECT_NEAR(result.report.volume, repaired(torus()).report.volume, 1e-12);
    }
}

TEST(MeshRepair, TurnsInwardComponentsOutward) {
    const TriangleMesh mesh =
        together({inside_out(cube(1.0)), moved(torus(), {9, 0, 0}), inside_out(moved(cube(2.0), {0, 9, 0}))});
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.report.reversed_components, 2);
    EXPECT_EQ(result.report.reversed_triangles, 0);
    EXPECT_EQ(messages(result.report.warnings()), Lines{"2 inward-oriented components turned outward"});
    EXPECT_EQ(winding_by_solid_angle(result.mesh, {0, 0, 0}), 1);
    EXPECT_EQ(winding_by_solid_angle(result.mesh, {11, 0.1, 0.1}), 1);
    EXPECT_EQ(winding_by_solid_angle(result.mesh, {0, 9, 0}), 1);
}

TEST(MeshRepair, KeepsACavityAndWhatLiesInIt) {
    // A shell, in its cavity a body, in that another cavity; whatever the order and the orientation of the whole.
    std::vector<TriangleMesh> parts{cube(4.0), inside_out(cube(3.0)), cube(2.0), inside_out(cube(1.0))};
    for (int i = 0; i < 24; ++i) {
        for (const bool is_inside_out : {false, true}) {
            const TriangleMesh mesh = is_inside_out ? inside_out(together(parts)) : together(parts);
            const RepairedMesh result = repaired(mesh);
            EXPECT_EQ(result.report.reversed_components, is_inside_out ? 4 : 0);
            EXPECT_EQ(winding_by_solid_angle(result.mesh, {3.5, 0, 0}), 1);
            EXPECT_EQ(winding_by_solid_angle(result.mesh, {2.5, 0, 0}), 0);
            EXPECT_EQ(winding_by_solid_angle(result.mesh, {1.5, 0, 0}), 1);
            EXPECT_EQ(winding_by_solid_angle(result.mesh, {0, 0, 0}), 0);
            EXPECT_DOUBLE_EQ(result.report.volume, 512.0 - 216.0 + 64.0 - 8.0);
        }
        std::ranges::next_permutation(parts, {}, [](const TriangleMesh& part) { return part.vertices[7].x; });
    }
}

TEST(MeshRepair, KeepsCavitiesThatTouchOthersOrTheBoundary) {
    const TriangleMesh body = box({0, 0, 0}, {6, 6, 6});
    const std::vector<std::pair<std::string, std::vector<TriangleMesh>>> cases{
        {"beside each other", {box({1, 1, 1}, {2, 2, 2}), box({2, 1.2, 1.3}, {3, 2.2, 2.3})}},
        {"through each other", {box({1, 1, 1}, {3, 3, 3}), box({2, 2, 2}, {4, 4, 4})}},
        {"a pocket", {box({1, 1, 4}, {2, 2, 6})}},
        {"a corner", {box({0, 0, 0}, {2, 3, 4})}},
        {"a hole through", {box({2, 2, 0}, {3, 3, 6})}},
    };
    for (const auto& [name, cavities] : cases) {
        for (const bool is_inside_out : {false, true}) {
            SCOPED_TRACE(name + (is_inside_out ? ", all inside out" : ""));
            TriangleMesh mesh = body;
            double volume = 216.0;
            for (const TriangleMesh& cavity : cavities) {
                mesh = together({mesh, inside_out(cavity)});
                const Point size = cavity.vertices[7] - cavity.vertices[0];
                volume -= size.x * size.y * size.z;
            }
            const RepairedMesh result = repaired(is_inside_out ? inside_out(mesh) : mesh);
            EXPECT_EQ(result.report.reversed_components, is_inside_out ? std::ssize(cavities) + 1 : 0);
            EXPECT_NEAR(result.report.volume, volume, 1e-9);
        }
    }
}

TEST(MeshRepair, TurnsABodyInACavityOutward) {
    const RepairedMesh result = repaired(together({cube(3.0), inside_out(cube(2.0)), inside_out(cube(1.0))}));
    EXPECT_EQ(result.report.reversed_components, 1);
    EXPECT_EQ(winding_by_solid_angle(result.mesh, {0, 0, 0}), 1);
    EXPECT_EQ(winding_by_solid_angle(result.mesh, {1.5, 0, 0}), 0);
}

TEST(MeshRepair, TurnsInwardBodiesThatOverlap) {
    const RepairedMesh result = repaired(together({cube(1.0), inside_out(moved(cube(1.0), {1.0, 0.1, 0.2}))}));
    EXPECT_EQ(result.report.reversed_components, 1);
    EXPECT_EQ(winding_by_solid_angle(result.mesh, {0.5, 0.1, 0.1}), 2);
    EXPECT_GT(result.report.self_intersections, 0);
    ASSERT_EQ(result.report.warnings().size(), 2u);
    EXPECT_NE(result.report.warnings()[1].message.find("intersect"), std::string::npos);
}

TEST(MeshRepair, TellsManyCavitiesFromManyBodies) {
    // Random small cubes of random orientation, within a large one, and outside.
    constexpr std::uint64_t kSeed = 11;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random(kSeed);
    std::vector<TriangleMesh> parts{cube(10.5)};
    std::vector<std::pair<Point, int>> expected;
    int turned = 0;
    for (int x = -10; x <= 18; x += 2) {
        for (int y = -10; y <= 10; y += 2) {
            for (int z = -10; z <= 10; z += 5) {
                const Point center{x + 0.01 * y, y + 0.01 * z, 1.0 * z};
                const bool is_inward = random() % 2 == 0;
                const bool is_within = x <= 10;
                parts.push_back(moved(is_inward ? inside_out(cube(0.2)) : cube(0.2), center));
                expected.push_back({center, is_within ? (is_inward ? 0 : 2) : 1});
                turned += is_inward && !is_within ? 1 : 0;
            }
        }
    }
    const RepairedMesh result = repaired(together(parts));
    EXPECT_EQ(result.report.reversed_components, turned);
    for (const auto& [center, count] : expected) {
        EXPECT_EQ(winding_by_solid_angle(result.mesh, center), count) << center.x << ' ' << center.y << ' ' << center.z;
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Holes and walls
// ---------------------------------------------------------------------------------------------------------------------

/// Repairs a mesh with holes or edges of many triangles, and checks what holds for every result.
RepairedMesh closed(const TriangleMesh& mesh) {
    RepairedMesh result = repair(mesh);
    EXPECT_EQ(result.report.fault.message, "");
    EXPECT_EQ(result.report.kind, SolidKind::kWinding);
    EXPECT_NE(result.report.reason, "");
    EXPECT_GT(result.report.volume, 0.0);
    expect_balanced(result.mesh);
    return result;
}

TEST(MeshClosing, ClosesHolesAndTellsWhere) {
    TriangleMesh mesh = cube(1.0);
    mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);  // the bottom
    const RepairedMesh one = closed(mesh);
    expect_closed_manifold(one.mesh);
    EXPECT_FALSE(one.report.is_closed());
    EXPECT_EQ(one.report.boundary_edges, 4);
    EXPECT_EQ(one.report.euler, 2);
    EXPECT_DOUBLE_EQ(one.report.volume, 8.0);
    ASSERT_EQ(one.report.holes.size(), 1u);
    EXPECT_EQ(one.report.holes[0].edges, 4);
    EXPECT_DOUBLE_EQ(one.report.holes[0].width, 2.0 * std::numbers::sqrt2);
    EXPECT_DOUBLE_EQ(one.report.holes[0].area, 4.0);
    EXPECT_DOUBLE_EQ(one.report.holes[0].place.z, -1.0);
    EXPECT_EQ(messages(one.report.warnings()),
              Lines{"1 hole closed, of 20.0 % of the area; the widest, 2.83 across, at (-1 -1 -1)"});
    EXPECT_EQ(one.report.warnings()[0].code, "mesh.holes");

    mesh.triangles.erase(mesh.triangles.begin());  // half of the top
    for (const TriangleMesh& two : {mesh, soup(mesh), inside_out(mesh), inside_out(soup(mesh))}) {
        const RepairedMesh result = closed(two);
        EXPECT_EQ(result.report.holes.size(), 2u);
        EXPECT_GT(result.report.holes[0].width, 0.9 * result.report.holes[1].width);
        EXPECT_DOUBLE_EQ(result.report.volume, 8.0);
    }
}

TEST(MeshClosing, DoesNotCutOffALimbThatAHoleGoesAroundMostOf) {
    const TriangleMesh whole = torus(64, 24);
    TriangleMesh mesh = whole;
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
        return std::ranges::all_of(t, [&](Index v) {
            const Point& p = whole.vertices[v];
            return std::abs(std::atan2(p.y, p.x)) < 0.4 && std::hypot(p.x, p.y) < 2.9;
        });
    });
    const RepairedMesh result = closed(mesh);
    ASSERT_EQ(result.report.holes.size(), 1u);
    // Two caps would leave out 12 %.
    EXPECT_NEAR(result.report.volume, repair(whole).report.volume, 0.02 * result.report.volume);
}

TEST(MeshClosing, DoesNotTakeCopiesForTheCauseOfAHole) {
    TriangleMesh mesh = cube(1.0);
    mesh.triangles.erase(mesh.triangles.begin());
    mesh.triangles.push_back(mesh.triangles.back());
    mesh.triangles.push_back(mesh.triangles.front());
    turn_over(mesh.triangles.back());
    const RepairedMesh result = closed(mesh);
    EXPECT_EQ(result.report.duplicate_triangles, 2);
    EXPECT_EQ(result.report.holes.size(), 1u);
    EXPECT_DOUBLE_EQ(result.report.volume, 8.0);
}

TEST(MeshClosing, TakesPartsAtAnEdgeOfFourTrianglesApart) {
    // Two cubes that share the vertices of an edge; the second one also the other way up.
    for (const bool is_turned : {false, true}) {
        const TriangleMesh second = box({1, 1, 0}, {2, 2, 1});
        TriangleMesh mesh = together({box({0, 0, 0}, {1, 1, 1}), is_turned ? inside_out(second) : second});
        for (Triangle& triangle : mesh.triangles) {
            for (Index& v : triangle) {
                v = v == 8 ? 3 : v == 12 ? 7 : v;
            }
        }
        const RepairedMesh result = closed(mesh);
        expect_closed_manifold(result.mesh);
        EXPECT_EQ(result.report.non_manifold_edges, 1);
        EXPECT_EQ(result.report.components, 2);
        EXPECT_EQ(result.report.euler, 4);
        EXPECT_DOUBLE_EQ(result.report.volume, 2.0);
        EXPECT_TRUE(result.report.holes.empty());
    }
}

TEST(MeshClosing, LeavesWallsOut) {
    // Two boxes side by side without the face between them, or with one wall there, either way up.
    TriangleMesh mesh = together({box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})});
    const auto is_between = [&](const Triangle& t) {
        return std::ranges::all_of(t, [&](Index v) { return mesh.vertices[v].x == 1.0; });
    };
    std::vector<Triangle> walls;
    std::ranges::copy_if(mesh.triangles, std::back_inserter(walls), is_between);
    ASSERT_EQ(walls.size(), 4u);
    std::erase_if(mesh.triangles, is_between);
    const auto share = [](std::vector<Triangle>& triangles) {
        for (Triangle& triangle : triangles) {
            for (Index& v : triangle) {
                v = v >= 8 && v % 2 == 0 ? v - 7 : v;
            }
        }
    };
    share(mesh.triangles);
    share(walls);
    for (const std::size_t first : {0, 2}) {
        TriangleMesh with_wall = mesh;
        with_wall.triangles.push_back(walls[first]);
        with_wall.triangles.push_back(walls[first + 1]);
        const RepairedMesh result = closed(with_wall);
        EXPECT_EQ(result.report.wall_triangles, 2);
        EXPECT_EQ(result.left_out.triangles.size(), 2U);
        EXPECT_EQ(result.report.components, 1);
        EXPECT_TRUE(result.report.holes.empty());
        EXPECT_DOUBLE_EQ(result.report.volume, 2.0);
    }
}

// A block of cells, the walls between them drawn once, each facing either way: they meet in lines and points.
TEST(MeshClosing, LeavesWallsBetweenManyCellsOut) {
    for (const std::array<int, 3>& counts : {std::array{2, 2, 1}, {3, 1, 1}, {3, 3, 1}, {2, 2, 2}, {3, 3, 3}}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            SCOPED_TRACE(std::to_string(counts[0] * 100 + counts[1] * 10 + counts[2]) + ", seed " +
                         std::to_string(seed));
            std::mt19937_64 random(seed);
            TriangleMesh mesh;
            std::int64_t walls = 0;
            const auto add_face = [&](const Point& low, int axis, bool is_up) {
                const std::array<Point, 3> units{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
                const Point& u = units[(axis + 1) % 3];
                const Point& v = units[(axis + 2) % 3];
                const auto first = static_cast<Index>(mesh.vertices.size());
                for (const Point& corner : {low, low + u, low + u + v, low + v}) {
                    mesh.vertices.push_back(corner);
                }
                for (Triangle triangle : {Triangle{first, first + 1, first + 2}, {first, first + 2, first + 3}}) {
                    if (!is_up) {
                        turn_over(triangle);
                    }
                    mesh.triangles.push_back(triangle);
                }
            };
            for (int axis = 0; axis < 3; ++axis) {
                const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                for (int level = 0; level <= counts[axis]; ++level) {
                    for (int i = 0; i < counts[u]; ++i) {
                        for (int j = 0; j < counts[v]; ++j) {
                            std::array<double, 3> low{};
                            low[axis] = level, low[u] = i, low[v] = j;
                            const bool is_wall = level > 0 && level < counts[axis];
                            walls += is_wall ? 2 : 0;
                            add_face({low[0], low[1], low[2]}, axis, is_wall ? random() % 2 == 0 : level > 0);
                        }
                    }
                }
            }
            const RepairedMesh result = closed(mesh);
            EXPECT_EQ(result.report.wall_triangles, walls);
            EXPECT_TRUE(result.report.holes.empty());
            EXPECT_EQ(result.report.components, 1);
            EXPECT_EQ(result.report.genus, 0);
            EXPECT_NEAR(result.report.volume, counts[0] * counts[1] * counts[2], 1e-12);
        }
    }
}

TEST(MeshClosing, KeepsTheCavityOfASolidInsideOutWithHoles) {
    for (const bool is_body_open : {false, true}) {
        for (const bool is_cavity_open : {false, true}) {
            for (const bool is_inside_out : {false, true}) {
                SCOPED_TRACE(std::to_string(is_body_open) + std::to_string(is_cavity_open) +
                             std::to_string(is_inside_out));
                TriangleMesh body = test::ball_mesh(4.0, 20);
                TriangleMesh cavity = inside_out(test::ball_mesh(2.0, 20));
                const double volume = repaired(together({body, cavity})).report.volume;
                body.triangles.resize(body.triangles.size() - (is_body_open ? 1 : 0));
                cavity.triangles.resize(cavity.triangles.size() - (is_cavity_open ? 1 : 0));
                const TriangleMesh mesh = together({body, cavity});
                const RepairedMesh result = closed(is_inside_out ? inside_out(mesh) : mesh);
                EXPECT_NEAR(result.report.volume, volume, 1e-9);
                EXPECT_EQ(winding_by_solid_angle(result.mesh, {0, 0, 0.1}), 0);
            }
        }
    }
}

// A few rays from each triangle: none may go to one side alone.
TEST(MeshClosing, DoesNotTurnTrianglesThatDoNotMeet) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> step(0.0, 0.01);
        TriangleMesh mesh = soup(cube(1.0));
        for (Point& p : mesh.vertices) {
            p = p + Point{step(random), step(random), step(random)};
        }
        std::ranges::shuffle(mesh.triangles, random);
        EXPECT_EQ(repair(mesh).report.reversed_triangles, 0);
    }
}

TEST(MeshClosing, LeavesFinsAndSheetsWithinOut) {
    TriangleMesh fin = cube(1.0);
    fin.vertices.push_back({3, 3, 3});
    fin.triangles.push_back({5, 7, 8});
    const RepairedMesh without_fin = closed(fin);
    EXPECT_EQ(without_fin.report.wall_triangles, 1);
    EXPECT_TRUE(without_fin.report.holes.empty());
    EXPECT_EQ(without_fin.mesh.vertices.size(), 8u);
    EXPECT_EQ(without_fin.left_out.triangles.size(), 1U);
    EXPECT_EQ(without_fin.left_out.vertices.size(), 3U);

    const TriangleMesh bent{{{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0.1}, {0, 0.5, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    for (const TriangleMesh& sheet : {bent, inside_out(bent)}) {
        const RepairedMesh result = closed(together({cube(1.0), sheet}));
        EXPECT_EQ(result.report.wall_triangles, 2);
        EXPECT_EQ(result.left_out.triangles.size(), 2U);
        EXPECT_TRUE(result.report.holes.empty());
        EXPECT_DOUBLE_EQ(result.report.volume, 8.0);
    }
}

TEST(MeshClosing, WeldsWhatIsAlmostAtOnePlace) {
    constexpr std::uint64_t kSeed = 5;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random(kSeed);
    const double diagonal = repair(torus()).report.bounds.diagonal();
    for (const double most : {1e-9, 1e-7, 1e-6}) {
        std::uniform_real_distribution<double> noise(-most * diagonal / 2.0, most * diagonal / 2.0);
        TriangleMesh mesh = soup(torus());
        for (Point& p : mesh.vertices) {
            p = p + Point{noise(random), noise(random), noise(random)};
        }
        const RepairedMesh result = closed(mesh);
        expect_closed_manifold(result.mesh);
        EXPECT_EQ(result.report.genus, 1) << most;
        EXPECT_EQ(result.mesh.vertices.size(), torus().vertices.size());
        EXPECT_TRUE(result.report.holes.empty());
        EXPECT_LE(result.report.weld_tolerance, 100.0 * most * diagonal);
        EXPECT_NE(result.report.warnings()[0].message.find("apart"), std::string::npos);
    }
}

TEST(MeshClosing, KeepsTheTopologyOfATorusWithTrianglesRemoved) {
    const double volume = closed(torus(60, 30)).report.volume;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        TriangleMesh mesh = torus(60, 30);
        std::erase_if(mesh.triangles, [&](const Triangle&) { return random() % 20 == 0; });
        const RepairedMesh result = closed(mesh);
        EXPECT_GT(result.report.holes.size(), 50u);
        EXPECT_EQ(result.report.components, 1);
        EXPECT_EQ(result.report.genus, 1);
        EXPECT_NEAR(result.report.volume / volume, 1.0, 0.01);
        for (const auto& [place, count] :
             {std::pair{Point{2, 0, 0}, 1}, {Point{0, -2, 0.5}, 1}, {Point{0, 0, 0}, 0}, {Point{3.5, 0, 0}, 0}}) {
            EXPECT_EQ(winding_by_solid_angle(result.mesh, place), count);
        }
    }
}

TEST(MeshClosing, ClosesLongRims) {
    // A tube: more edges around each end than the patch of least area takes.
    constexpr int kSteps = 1000;
    TriangleMesh tube;
    for (int i = 0; i < kSteps; ++i) {
        const double u = 2.0 * std::numbers::pi * i / kSteps;
        tube.vertices.push_back({std::cos(u), std::sin(u), 0});
        tube.vertices.push_back({std::cos(u), std::sin(u), 4});
        const Index a = 2 * i, b = 2 * ((i + 1) % kSteps);
        tube.triangles.push_back({a, b, b + 1});
        tube.triangles.push_back({a, b + 1, a + 1});
    }
    const RepairedMesh result = closed(tube);
    ASSERT_EQ(result.report.holes.size(), 2u);
    for (const Hole& hole : result.report.holes) {
        EXPECT_EQ(hole.edges, kSteps);
        EXPECT_NEAR(hole.area, std::numbers::pi, 1e-4);
    }
    EXPECT_NEAR(result.report.volume, 4.0 * std::numbers::pi, 1e-3);
    EXPECT_EQ(result.report.euler, 2);
}

// ---------------------------------------------------------------------------------------------------------------------
// Faults
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshClosing, LeavesSheetsBesideClosedPartsOut) {
    TriangleMesh wavy = test::sphere_mesh({3, 0, 0}, 1.0, 3);  // a shallow cap of a ball
    std::erase_if(wavy.triangles, [&](const auto& triangle) {
        return std::ranges::any_of(triangle, [&](Index v) { return wavy.vertices[v].z < 0.9; });
    });
    const auto sheet = std::ssize(wavy.triangles);
    ASSERT_GT(sheet, 10);
    const TriangleMesh ball = test::sphere_mesh({0, 0, 0}, 1.0, 3);
    const RepairedMesh result = repair(test::together({ball, wavy}));
    EXPECT_TRUE(result.report.fault.empty()) << result.report.fault.message;
    EXPECT_EQ(result.report.sheet_triangles, sheet);
    EXPECT_EQ(std::ssize(result.left_out.triangles), sheet);
    EXPECT_EQ(result.report.wall_triangles, 0);
    EXPECT_TRUE(result.report.holes.empty());
    EXPECT_EQ(result.mesh.triangles.size(), ball.triangles.size());
    // A ball with a hole is none, and is closed.
    TriangleMesh open = test::sphere_mesh({3, 0, 0}, 1.0, 3);
    std::erase_if(open.triangles, [&](const auto& triangle) { return open.vertices[triangle[0]].z > 0.8; });
    const RepairedMesh both = repair(test::together({ball, open}));
    EXPECT_EQ(both.report.sheet_triangles, 0);
    EXPECT_TRUE(both.left_out.triangles.empty()) << "patches are none of the triangles given";
    EXPECT_EQ(both.report.holes.size(), 1U);
    EXPECT_EQ(both.report.components, 2);
}

TEST(MeshRepair, NamesSheets) {
    TriangleMesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    expect_fault(square, {"no inside", "thick"});
    EXPECT_EQ(repair(square).report.fault.code, "mesh.sheet");
    square.vertices[2].z = 0.3;
    expect_fault(square, {"no inside", "thick"});

    TriangleMesh fan;
    fan.vertices = {{0, 0, 0}, {0, 0, 2}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
    fan.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    expect_fault(fan, {"no inside"});
    EXPECT_FALSE(repair(fan).report.is_manifold());
}

TEST(MeshRepair, NamesOneSidedSurfaces) {
    // A Möbius band.
    TriangleMesh band;
    constexpr int kSteps = 20;
    for (int i = 0; i < kSteps; ++i) {
        const double u = 2.0 * std::numbers::pi * i / kSteps;
        for (const double side : {-0.5, 0.5}) {
            const double r = 2.0 + side * std::cos(u / 2.0);
            band.vertices.push_back({r * std::cos(u), r * std::sin(u), side * std::sin(u / 2.0)});
        }
        const Index a = 2 * i;
        const bool is_last = i + 1 == kSteps;
        const Index c = is_last ? 1 : a + 2;
        const Index d = is_last ? 0 : a + 3;
        band.triangles.push_back({a, c, a + 1});
        band.triangles.push_back({a + 1, c, d});
    }
    expect_fault(band, {"one-sided", "cannot be oriented"});

    // A Klein bottle is closed, and crosses itself: a grid whose second direction is reversed where the first closes.
    constexpr int kRings = 24;
    constexpr int kRingSize = 12;
    TriangleMesh bottle;
    const auto id = [&](int i, int j) {
        const int k = i == kRings ? kRingSize - j : j;
        return static_cast<Index>((i % kRings) * kRingSize + (k + kRingSize) % kRingSize);
    };
    for (int i = 0; i < kRings; ++i) {
        for (int j = 0; j < kRingSize; ++j) {
            const double u = 2.0 * std::numbers::pi * i / kRings;
            const double v = 2.0 * std::numbers::pi * j / kRingSize;
            const double r = 3.0 + std::cos(u / 2.0) * std::sin(v) - std::sin(u / 2.0) * std::sin(2.0 * v);
            bottle.vertices.push_back({r * std::cos(u), r * std::sin(u),
                                       std::sin(u / 2.0) * std::sin(v) + std::cos(u / 2.0) * std::sin(2.0 * v)});
            bottle.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            bottle.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    }
    expect_fault(bottle, {"one-sided", "cannot be oriented"});
    EXPECT_TRUE(repair(bottle).report.is_closed());
    EXPECT_EQ(repair(bottle).report.reversed_triangles, 0);
}

TEST(MeshRepair, NamesSurfacesThatEncloseNothing) {
    expect_fault({}, {"no triangles"});
    expect_fault({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}}, {"no triangles"});
    expect_fault({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 1, 1}}}, {"no volume"});

    // A sheet with triangles for both sides.
    TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}}};
    expect_fault(sheet, {"no volume"});
    expect_fault(soup(sheet), {"no volume"});
    // The other side has the other diagonal, or vertices of its own inside.
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {2, 1, 3}};
    expect_fault(sheet, {"no volume", "thickness"});
    expect_fault(moved(box({0, 0, 0}, {1, 1, 0}), {5, 5, 5}), {"no volume"});

    expect_fault(moved(cube(1.0), {1, 2, 3}, 0.0), {"no extent", "(1 2 3)"});
}

TEST(MeshRepair, KeepsSurfacesWhoseSignedVolumesCancel) {
    // Turned around an axis: an 8, one loop above the other.
    const TriangleMesh mesh = grid(24, 16, [](double u, double v) {
        const double r = 3.0 + std::sin(2.0 * v);
        return Point{r * std::cos(u), r * std::sin(u), std::sin(v)};
    });
    const RepairedMesh result = repair(mesh);
    EXPECT_NEAR(result.report.volume, 0.0, 1e-9);
    ASSERT_TRUE(result.report.fault.empty()) << result.report.fault.message;
    const std::unique_ptr<Solid> solid = mesh_solid(result);
    for (const double z : {-0.7, 0.7}) {
        EXPECT_TRUE(solid->inside({3.0, 0.0, z}));
    }
    EXPECT_FALSE(solid->inside({3.5, 0.0, 0.0}));
}

TEST(MeshRepair, NamesCoordinatesThatCannotBeComputedWith) {
    expect_fault(moved(cube(1.0), {0, 1e11, 0}), {"origin", "translate"});
    expect_fault(moved(cube(1.0), {}, 9e17), {"too large", "scale"});
    expect_fault(moved(cube(1.0), {}, 1e100), {"vertex 0", "up to 1e18", "scale"});
    expect_fault(moved(cube(1.0), {}, 1e-100), {"too small", "scale"});
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        TriangleMesh mesh = cube(1.0);
        mesh.vertices[5].y = bad;
        expect_fault(mesh, {"vertex 5", "finite"});
    }
}

TEST(MeshRepair, NamesIndicesOutOfRange) {
    for (const Index bad : {-1, 8, std::numeric_limits<Index>::max(), std::numeric_limits<Index>::min()}) {
        TriangleMesh mesh = cube(1.0);
        mesh.triangles[7][1] = bad;
        expect_fault(mesh, {"triangle 7", "vertex " + std::to_string(bad)});
    }
}

TEST(MeshRepair, SurvivesRandomTriangles) {
    constexpr std::uint64_t kSeed = 17;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random(kSeed);
    int sound = 0;
    for (int round = 0; round < 3000; ++round) {
        TriangleMesh mesh;
        const auto vertices = static_cast<Index>(3 + random() % 6);
        for (Index v = 0; v < vertices; ++v) {
            mesh.vertices.push_back({static_cast<double>(random() % 3), static_cast<double>(random() % 3),
                                     static_cast<double>(random() % 3)});
        }
        if (round % 2 == 0) {
            mesh = together({mesh, cube(1.0), inside_out(moved(cube(0.5), {0.25, 0, 0}))});
        }
        for (std::size_t t = random() % 12; t > 0; --t) {
            const auto corner = [&] { return static_cast<Index>(random() % mesh.vertices.size()); };
            mesh.triangles.push_back({corner(), corner(), corner()});
        }
        const RepairedMesh result = repair(mesh);
        if (result.report.fault.empty()) {
            expect_balanced(result.mesh);
            ++sound;
        }
    }
    EXPECT_GT(sound, 100);
}

}  // namespace
}  // namespace scaleaxis
