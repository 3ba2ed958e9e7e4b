// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/centerlines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "folder.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using namespace test;

/// A skeleton of curves that lead from node to node; radii are 1.
Skeleton curves_of(const std::vector<Point>& nodes, const std::vector<std::vector<Index>>& branches) {
    Skeleton result;
    result.nodes = nodes;
    result.radii.assign(nodes.size(), 1.0);
    result.node_branches.assign(nodes.size(), kNone);
    result.node_components.assign(nodes.size(), 0);
    for (const std::vector<Index>& branch : branches) {
        for (std::size_t k = 0; k < branch.size(); ++k) {
            result.node_branches[branch[k]] = static_cast<Index>(result.branches.size());
            if (k > 0) {
                result.edges.push_back({std::min(branch[k - 1], branch[k]), std::max(branch[k - 1], branch[k])});
            }
        }
        result.branches.push_back(branch);
    }
    std::ranges::sort(result.edges);
    return result;
}

std::vector<Index> numbers(Index first, Index last) {
    std::vector<Index> result(static_cast<std::size_t>(last - first + 1));
    std::iota(result.begin(), result.end(), first);
    return result;
}

constexpr double kHelixRadius = 3.0;
constexpr double kRise = 1.0;  // of a radian

Point helix(double angle) { return {kHelixRadius * std::cos(angle), kHelixRadius * std::sin(angle), kRise * angle}; }

constexpr double kSquare = kHelixRadius * kHelixRadius + kRise * kRise;
constexpr double kHelixCurvature = kHelixRadius / kSquare;
constexpr double kHelixTorsion = kRise / kSquare;

TEST(Centerlines, GeometryOfAHelix) {
    std::vector<Point> nodes;
    for (int k = 0; k <= 200; ++k) {
        nodes.push_back(helix(4.0 * std::numbers::pi * k / 200.0));
    }
    Skeleton skeleton = curves_of(nodes, {numbers(0, 200)});
    skeleton.radii.assign(skeleton.nodes.size(), 0.4);
    const BranchGeometry geometry = branch_geometry(skeleton, 0);
    EXPECT_NEAR(geometry.length, 4.0 * std::numbers::pi * std::sqrt(kSquare), 0.01);
    EXPECT_NEAR(geometry.tortuosity, geometry.length / (4.0 * std::numbers::pi * kRise) - 1.0, 1e-9);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const bool is_inner = k > 4 && k + 5 < nodes.size();
        EXPECT_NEAR(geometry.curvature[k], kHelixCurvature, (is_inner ? 0.01 : 0.05) * kHelixCurvature) << k;
        EXPECT_NEAR(geometry.torsion[k], kHelixTorsion, (is_inner ? 0.01 : 0.3) * kHelixTorsion) << k;
        const double angle = 4.0 * std::numbers::pi * static_cast<double>(k) / 200.0;
        const Point tangent = unit(Point{-3.0 * std::sin(angle), 3.0 * std::cos(angle), 1.0});
        EXPECT_LT(distance(geometry.tangents[k], tangent), 0.01);
        if (is_inner) {
            EXPECT_LT(distance(geometry.normals[k], Point{-std::cos(angle), -std::sin(angle), 0.0}), 0.01);
        }
        EXPECT_LT(distance(geometry.binormals[k], cross(geometry.tangents[k], geometry.normals[k])), 1e-9);
        EXPECT_NEAR(dot(geometry.transported[k], geometry.tangents[k]), 0.0, 1e-9);
    }
    // A frame that does not turn lags behind Frenet's by the integral of the torsion.
    const auto lag = [&](std::size_t k) {
        return std::atan2(dot(geometry.transported[k], geometry.binormals[k]),
                          dot(geometry.transported[k], geometry.normals[k]));
    };
    const double turned = std::remainder(lag(60) - lag(20), 2.0 * std::numbers::pi);
    EXPECT_NEAR(turned, -kHelixTorsion * (geometry.abscissas[60] - geometry.abscissas[20]), 0.01);
}

TEST(Centerlines, GeometryOfALineAndOfAShortBranch) {
    std::vector<Point> nodes;
    for (int k = 0; k <= 20; ++k) {
        nodes.push_back({0.3 * k, 0.6 * k, -0.2 * k});
    }
    const Skeleton skeleton = curves_of(nodes, {numbers(0, 20), {0, 20}});
    for (const Index b : {0, 1}) {
        const BranchGeometry geometry = branch_geometry(skeleton, b);
        for (std::size_t k = 0; k < geometry.tangents.size(); ++k) {
            EXPECT_LT(distance(geometry.tangents[k], unit(nodes[20])), 1e-9);
            EXPECT_NEAR(geometry.curvature[k], 0.0, 1e-9);
            EXPECT_EQ(geometry.torsion[k], 0.0);
            EXPECT_LT(distance(geometry.transported[k], geometry.transported[0]), 1e-9);
        }
        EXPECT_NEAR(geometry.tortuosity, 0.0, 1e-12);
    }
}

TEST(Centerlines, GeometryOfALoopHasNoSeam) {
    std::vector<Point> nodes;
    std::vector<Index> loop;
    for (int k = 0; k < 60; ++k) {
        nodes.push_back({2.0 * std::cos(std::numbers::pi * k / 30.0), 2.0 * std::sin(std::numbers::pi * k / 30.0), 0});
        loop.push_back(k);
    }
    loop.push_back(0);
    const BranchGeometry geometry = branch_geometry(curves_of(nodes, {loop}), 0);
    for (std::size_t k = 0; k < loop.size(); ++k) {
        EXPECT_NEAR(geometry.curvature[k], geometry.curvature[30], 1e-9);
        EXPECT_NEAR(geometry.curvature[k], 0.5, 0.05);
        EXPECT_NEAR(geometry.torsion[k], 0.0, 1e-9);
    }
    EXPECT_EQ(geometry.tortuosity, 0.0);
}

/// A trunk 0-1-2, a thick child 2-3-4 and a thin one 2-5-6, whose list runs towards the trunk; and a loop at its end.
Skeleton fork() {
    Skeleton result = curves_of(
        {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 3}, {2, 0, 4}, {-1, 0, 3}, {-2, 0, 4}, {-3, 0, 5}, {-3, 1, 5}},
        {{0, 1, 2}, {2, 3, 4}, {6, 5, 2}, {6, 7, 8, 6}});
    result.radii = {0.5, 0.5, 0.5, 0.4, 0.4, 0.2, 0.2, 0.1, 0.1};
    return result;
}

TEST(Centerlines, TreeOfAForkWithALoop) {
    const SkeletonTree tree = tree_of(fork());
    ASSERT_EQ(tree.nodes.size(), 9u);
    EXPECT_EQ(tree.nodes[0], 0);
    EXPECT_EQ(std::ranges::count(tree.parents, kNone), 1);
    for (std::size_t i = 1; i < tree.parents.size(); ++i) {
        EXPECT_LT(tree.parents[i], static_cast<Index>(i));
    }
    ASSERT_EQ(tree.cuts.size(), 1u);
    EXPECT_EQ(tree.cuts[0], (std::array<Index, 2>{7, 8})) << "where the loop is farthest from the root";
    const std::vector<Diagnostic> warnings = tree_warnings(fork());
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].code, "skeleton.loops");
    ASSERT_TRUE(warnings[0].place);
    EXPECT_EQ(*warnings[0].place, (Point{-3, 0.5, 5}));

    const BranchPlaces places = branch_places(fork());
    EXPECT_EQ(places.centerlines, (std::vector<Index>{0, 0, 1, 1}));
    EXPECT_EQ(places.tracts, (std::vector<Index>{0, 1, 1, 2}));
    EXPECT_EQ(places.is_backwards, (std::vector<Index>{0, 0, 1, 0}));
}

TEST(Centerlines, TreesLeadAwayFromTheirRoot) {
    Skeleton rooted = fork();
    rooted.root = nearest_node(rooted, {2.2, 0, 4});
    EXPECT_EQ(rooted.root, 4);
    EXPECT_EQ(tree_of(rooted).nodes[0], 4);
    EXPECT_EQ(branch_places(rooted).is_backwards, (std::vector<Index>{1, 1, 1, 0}));
    const Skeleton even = resampled(rooted, 0.1);
    EXPECT_EQ(even.nodes[even.root], rooted.nodes[4]);
    rooted.root = 3;  // within a branch
    const BranchPlaces places = branch_places(rooted);
    EXPECT_EQ(places.tracts, (std::vector<Index>{1, 0, 1, 2}));
    // A path leads from its first end, though that is the thinner one.
    EXPECT_EQ(tree_of(path_between(fork(), {-2, 0, 4}, {0, 0, 0})).nodes[0], 0);
}

TEST(Centerlines, CylindersOfAFork) {
    const std::vector<Cylinder> all = cylinders(fork());
    ASSERT_EQ(all.size(), 8u);
    double length = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        length += all[i].length;
        EXPECT_LT(all[i].parent, static_cast<Index>(i));
        if (all[i].parent != kNone) {
            const Cylinder& parent = all[all[i].parent];
            EXPECT_LT(distance(all[i].start, parent.start + parent.length * parent.axis), 1e-12);
        }
    }
    EXPECT_NEAR(length, 2.0 + 5.0 * std::sqrt(2.0) + std::sqrt(3.0), 1e-12);
    EXPECT_EQ(std::ranges::count(all, kNone, &Cylinder::parent), 1);
    // The thick child goes on with the trunk, the thin one is a branch of order 1, and half of the loop one of 2.
    for (const Cylinder& c : all) {
        const Index order = c.axis.y > 0.0 ? 2 : c.start.x < 0.0 || c.axis.x < -0.5 ? 1 : 0;
        EXPECT_EQ(c.order, order) << c.start.x;
        EXPECT_EQ(c.branch, order);
    }
    EXPECT_EQ(all[0].position, 0);
    EXPECT_EQ(all[3].position, 3);
    EXPECT_EQ(all[4].position, 0);
    EXPECT_DOUBLE_EQ(all[2].radius, 0.45);
}

TEST(Centerlines, PathIsTheShortestWay) {
    const Skeleton path = path_between(fork(), {2.1, 0, 4}, {-2.9, 0.9, 5});
    ASSERT_EQ(path.branches.size(), 1u);
    EXPECT_EQ(path.nodes.front(), (Point{2, 0, 4}));
    EXPECT_EQ(path.nodes.back(), (Point{-3, 1, 5}));
    EXPECT_NEAR(branch_length(path, 0), 4.0 * std::sqrt(2.0) + std::sqrt(3.0), 1e-12);
    EXPECT_EQ(path.radii[1], 0.4);
    const Skeleton back = path_between(fork(), {-2.9, 0.9, 5}, {2.1, 0, 4});
    EXPECT_NEAR(branch_length(back, 0), branch_length(path, 0), 1e-12);
    EXPECT_EQ(back.nodes.front(), path.nodes.back());
    EXPECT_EQ(path_between(fork(), {0, 0, 0}, {0, 0, 0.1}).nodes.size(), 1u);
    EXPECT_THROW(path_between({}, {0, 0, 0}, {1, 0, 0}), UnusableInput);
    Skeleton point;
    point.nodes = {{0, 0, 0}};
    EXPECT_THROW(nearest_node(point, {std::nan(""), 0, 0}), InvalidOption);
    Skeleton apart = curves_of({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {6, 0, 0}}, {{0, 1}, {2, 3}});
    apart.node_components = {0, 0, 1, 1};
    EXPECT_THROW(path_between(apart, {0, 0, 0}, {6, 0, 0}), UnusableInput);
    ASSERT_EQ(tree_warnings(apart).size(), 1u);
    EXPECT_EQ(tree_warnings(apart)[0].code, "skeleton.trees");
}

TEST(Centerlines, ResampledHasEvenSteps) {
    Skeleton given = fork();
    given.vertex_nodes = numbers(0, 8);
    const Skeleton even = resampled(given, 0.3);
    EXPECT_EQ(even.branches.size(), 4u);
    EXPECT_EQ(topology(even), topology(given));
    for (Index b = 0; b < 4; ++b) {
        EXPECT_NEAR(branch_length(even, b), branch_length(given, b), b == 3 ? 0.3 : 1e-9);
        const BranchGeometry geometry = branch_geometry(even, b);
        const double step = geometry.abscissas[1];
        EXPECT_LE(step, 0.3 + 1e-9);
        EXPECT_GT(step, 0.2);
        if (b < 3) {
            for (std::size_t k = 1; k < geometry.abscissas.size(); ++k) {
                EXPECT_NEAR(geometry.abscissas[k], static_cast<double>(k) * step, 1e-9);
            }
        }
    }
    for (std::size_t v = 0; v < given.nodes.size(); ++v) {
        EXPECT_LE(distance(even.nodes[even.vertex_nodes[v]], given.nodes[v]), 0.16);
    }
    EXPECT_EQ(even.radii[even.branches[1].back()], 0.4);
    // A coarse step leaves ends, junctions and loops.
    const Skeleton coarse = resampled(given, 100.0);
    EXPECT_EQ(topology(coarse), topology(given));
    EXPECT_EQ(coarse.nodes.size(), 6u);
    EXPECT_THROW(resampled(given, 0.0), InvalidOption);
    // 1.2 in steps of 0.3 are four, though 1.2 / 0.3 is a little more in doubles.
    EXPECT_EQ(resampled(curves_of({{0, 0, 0}, {0, 0, 3 * 0.4}}, {{0, 1}}), 0.3).nodes.size(), 5u);
}

ScaleAxis axis_of(const Solid& solid, double delta) {
    ScaleAxisOptions options{.delta = Length::relative(delta), .scales = {1.1}};
    options.reaches_sharp_edges = false;
    return scale_axis(solid, options);
}

TEST(Centerlines, OfATubeAroundAHelixHaveItsCurvatureTorsionAndArea) {
    constexpr double kTube = 0.5;
    constexpr int kRings = 240;
    constexpr int kSides = 48;
    TriangleMesh mesh;
    for (int i = 0; i <= kRings; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kRings;
        const Point tangent = unit(Point{-3.0 * std::sin(angle), 3.0 * std::cos(angle), 1.0});
        const Point normal{-std::cos(angle), -std::sin(angle), 0.0};
        const Point binormal = cross(tangent, normal);
        for (int j = 0; j < kSides; ++j) {
            const double turn = 2.0 * std::numbers::pi * j / kSides;
            mesh.vertices.push_back(helix(angle) + kTube * (std::cos(turn) * normal + std::sin(turn) * binormal));
        }
    }
    for (int i = 0; i < kRings; ++i) {
        for (int j = 0; j < kSides; ++j) {
            const Index a = i * kSides + j;
            const Index b = i * kSides + (j + 1) % kSides;
            mesh.triangles.push_back({a, b, b + kSides});
            mesh.triangles.push_back({a, b + kSides, a + kSides});
        }
    }
    for (int j = 1; j + 1 < kSides; ++j) {
        mesh.triangles.push_back({0, j + 1, j});
        mesh.triangles.push_back({kRings * kSides, kRings * kSides + j, kRings * kSides + j + 1});
    }
    const auto solid = mesh_solid(repair(mesh));
    Skeleton skeleton = scaleaxis::skeleton(axis_of(*solid, 0.01).axes[0].complex, *solid);
    ASSERT_EQ(skeleton.branches.size(), 1u);
    add_sections(skeleton, *solid);
    ASSERT_EQ(skeleton.sections.size(), skeleton.nodes.size());
    const BranchGeometry geometry = branch_geometry(skeleton, 0);
    const std::span<const Index> nodes = skeleton.branches[0];
    double curvature = 0.0;
    double torsion = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const double from_end = std::min(geometry.abscissas[k], geometry.length - geometry.abscissas[k]);
        const Section& section = skeleton.sections[nodes[k]];
        // A polygon of 48 sides is 0.3 % smaller than its circle.
        EXPECT_NEAR(section.area, std::numbers::pi * kTube * kTube, 0.02 * std::numbers::pi * kTube * kTube);
        EXPECT_NEAR(section.least_width, 2.0 * kTube, 0.02);
        EXPECT_NEAR(section.largest_width, 2.0 * kTube, 0.03);
        EXPECT_TRUE(section.is_closed);
        if (from_end > 2.0) {
            EXPECT_NEAR(geometry.curvature[k], kHelixCurvature, 0.1 * kHelixCurvature) << k;
            curvature += geometry.curvature[k];
            torsion += geometry.torsion[k];
            count += 1.0;
        }
    }
    EXPECT_NEAR(curvature / count, kHelixCurvature, 0.02 * kHelixCurvature);
    EXPECT_NEAR(torsion / count, kHelixTorsion, 0.1 * kHelixTorsion);
}

TEST(Centerlines, SectionsOfAnEllipticBarAndOfATorus) {
    // Half axes 1 and 0.5: the area is that of the ellipse, not of the ball in it.
    const auto bar = function_solid(
        [](const Point& p) {
            const double ellipse = std::hypot(p.x, 2.0 * p.y) - 1.0;
            return std::max(0.5 * ellipse, std::abs(p.z) - 5.0);
        },
        {.bounds = centered_box(1.5, 1.0, 5.5)});
    Skeleton line = curves_of({{0, 0, -4}, {0, 0, -2}, {0, 0, 0}, {0, 0, 2}, {0, 0, 4}}, {numbers(0, 4)});
    line.radii.assign(5, 0.5);
    for (const int threads : {1, 3}) {
        add_sections(line, *bar, {threads});
        for (const Section& section : line.sections) {
            EXPECT_NEAR(section.area, 0.5 * std::numbers::pi, 0.005);
            EXPECT_NEAR(section.least_width, 1.0, 0.005);
            EXPECT_NEAR(section.largest_width, 2.0, 0.01);
            EXPECT_TRUE(section.is_closed);
        }
    }
    EXPECT_EQ(path_between(line, {0, 0, -2}, {0, 0, 2}).sections.size(), 3u);
    EXPECT_TRUE(resampled(line, 1.0).sections.empty());

    const ImplicitSolid torus = torus_solid(2.0, 0.6);
    Skeleton loop = scaleaxis::skeleton(axis_of(torus, 0.02).axes[0].complex);
    ASSERT_EQ(loop.branches.size(), 1u);
    add_sections(loop, torus);
    for (const Section& section : loop.sections) {
        EXPECT_NEAR(section.area, std::numbers::pi * 0.36, 0.03);
        EXPECT_TRUE(section.is_closed);
    }

    // A plane along a bar leads on in it.
    const auto bar_along_x = mesh_solid(box_mesh({-20, -1, -1}, {20, 1, 1}));
    Skeleton across = curves_of({{0, -0.5, 0}, {0, 0, 0}, {0, 0.5, 0}}, {numbers(0, 2)});
    add_sections(across, *bar_along_x);
    EXPECT_FALSE(across.sections[1].is_closed);
}

class CenterlineFiles : public FolderTest {};

TEST_F(CenterlineFiles, CylindersAreATable) {
    const std::vector<Diagnostic> warnings = write_skeleton(path("tree.csv"), fork());
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].code, "skeleton.loops");
    EXPECT_TRUE(write_skeleton(path("tree.vtp"), fork()).empty());
    std::istringstream lines(content("tree.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line,
              "id,parent,start_x,start_y,start_z,axis_x,axis_y,axis_z,length,radius,branch,branch_order,"
              "position_in_branch");
    std::getline(lines, line);
    EXPECT_EQ(line, "1,0,0,0,0,0,0,1,1,0.5,1,0,1");
    std::getline(lines, line);
    EXPECT_EQ(line, "2,1,0,0,1,0,0,1,1,0.5,1,0,2");
}

}  // namespace
}  // namespace scaleaxis
