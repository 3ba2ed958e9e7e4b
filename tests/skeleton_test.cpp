// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/skeleton.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "complexes.hpp"
#include "folder.hpp"
#include "meshes.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

/// Arms of one radius from the origin.
struct Arm {
    Point direction;
    double length;
    double radius;
};

std::unique_ptr<Solid> arms_solid(const std::vector<Arm>& arms, double half_extent) {
    const auto distance_to_arms = [arms](const Point& p) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& [direction, length, radius] : arms) {
            least = std::min(least, test::distance_to_segment(p, {0, 0, 0}, length * unit(direction)) - radius);
        }
        return least;
    };
    return function_solid(distance_to_arms, {.bounds = centered_box(half_extent, half_extent, half_extent)});
}

struct Result {
    ScaleAxis axis;
    Skeleton skeleton;
    SkeletonStatistics statistics;

    const MedialComplex& complex() const { return axis.axes[0].complex; }
};

Result skeleton_of(const Solid& solid, double delta = 0.01, const SkeletonOptions& options = {}) {
    ScaleAxisOptions pipeline{.delta = Length::relative(delta), .scales = {1.1}};
    pipeline.reaches_sharp_edges = false;
    Result result{scale_axis(solid, pipeline), {}, {}};
    result.skeleton = skeleton(result.complex(), BallUnion(scaled(result.axis.balls, 1.1)), options);
    result.statistics = statistics_of(result.skeleton, result.complex());
    return result;
}

/// Arrays that fit together, edges that are those of branches and faces, each once.
void expect_well_formed(const Skeleton& s) {
    const std::size_t count = s.nodes.size();
    ASSERT_EQ(s.radii.size(), count);
    ASSERT_EQ(s.node_branches.size(), count);
    ASSERT_EQ(s.node_components.size(), count);
    EXPECT_TRUE(std::ranges::is_sorted(s.edges));
    EXPECT_EQ(std::ranges::adjacent_find(s.edges), s.edges.end());
    const std::vector<Index> degree = degrees(s);
    std::size_t branch_edges = 0;
    for (std::size_t b = 0; b < s.branches.size(); ++b) {
        const std::span<const Index> branch = s.branches[b];
        branch_edges += branch.size() - 1;
        for (std::size_t k = 1; k < branch.size(); ++k) {
            const std::array<Index, 2> edge{std::min(branch[k - 1], branch[k]), std::max(branch[k - 1], branch[k])};
            EXPECT_TRUE(std::ranges::binary_search(s.edges, edge));
            EXPECT_EQ(s.node_components[branch[k]], s.node_components[branch[0]]);
            if (k + 1 < branch.size()) {
                EXPECT_EQ(degree[branch[k]], 2);
                EXPECT_EQ(s.node_branches[branch[k]], static_cast<Index>(b));
            }
        }
    }
    if (s.faces.empty()) {
        EXPECT_EQ(branch_edges, s.edges.size());
    }
    for (const Index node : s.vertex_nodes) {
        EXPECT_GE(node, 0);
        EXPECT_LT(node, static_cast<Index>(count));
    }
}

/// A sheet in the plane z = 0, balls of one radius.
MedialComplex plate(int length, int width, int n, double radius) {
    return linear(squares(
        1.0, length, width, n, [](int, int) { return true; }, [=](const Point&) { return radius; }));
}

TEST(Skeleton, OfALongPlateRunsAlongItsMiddle) {
    const MedialComplex complex = plate(6, 2, 8, 0.2);
    Box box;
    std::ranges::for_each(complex.vertices, [&](const Point& p) { box.extend(p); });
    const Point middle = midpoint(box.min, box.max);
    const Skeleton result = skeleton(complex);
    expect_well_formed(result);
    ASSERT_EQ(result.branches.size(), 1u);
    for (std::size_t n = 0; n < result.nodes.size(); ++n) {
        EXPECT_NEAR(result.nodes[n].y, middle.y, 0.13) << result.nodes[n].x;
        EXPECT_NEAR(result.nodes[n].z, middle.z, 1e-9);
        EXPECT_NEAR(result.radii[n], 0.2, 0.01);
    }
    EXPECT_NEAR(branch_length(result, 0), 4.0, 0.6);  // it ends where the corners are as near as the sides
}

TEST(Skeleton, OfAPlateAlmostSquareRunsAlongItsLongerSide) {
    for (const std::uint64_t seed : {1, 2, 5}) {
        SCOPED_TRACE(seed);
        const auto solid = mesh_solid(repair(box_mesh({0, 0, 0}, {10, 8, 1})));
        ScaleAxisOptions pipeline{.delta = Length::relative(0.01), .scales = {1.1}, .seed = seed};
        pipeline.reaches_sharp_edges = false;
        const Skeleton result = skeleton(scale_axis(*solid, pipeline).axes[0].complex, *solid);
        ASSERT_EQ(result.branches.size(), 1u);
        const Point along = result.nodes[result.branches[0].back()] - result.nodes[result.branches[0].front()];
        EXPECT_GT(std::abs(along.x), 0.3);
        EXPECT_LT(std::abs(along.y), 0.3 * std::abs(along.x));
        for (const Point& p : result.nodes) {
            EXPECT_NEAR(p.y, 4.0, 0.3);
        }
    }
}

/// Where a tube leaves a thicker one, nothing of the solid is narrower than the thin tube. Along the sheet between the
/// two the balls are as small as the crotch is sharp.
TEST(Skeleton, CrossesBetweenTubesWhereTheyAreWide) {
    constexpr double kDelta = 0.1;
    for (const double angle : {30.0, 45.0, 60.0, 90.0}) {
        for (const double radius : {0.3, 0.5, 0.7, 1.0}) {
            SCOPED_TRACE("a tube of radius " + std::to_string(radius) + " at " + std::to_string(angle) + " degrees");
            const double turn = angle * std::numbers::pi / 180.0;
            const auto solid = arms_solid(
                {{{0, 0, -1}, 6.0, 1.0}, {{0, 0, 1}, 9.0, 1.0}, {{std::sin(turn), 0, std::cos(turn)}, 9.0, radius}},
                11);
            ScaleAxisOptions options{.delta = Length::absolute(kDelta), .scales = {1.0}};
            options.reaches_sharp_edges = false;
            const ScaleAxis axis = scale_axis(*solid, options);
            const MedialComplex complex = clean(axis.axes[0].complex, {.thickness = 0.5 * kDelta}).complex;
            const Skeleton result = skeleton(complex, *solid);
            EXPECT_EQ(result.branches.size(), 3u);
            EXPECT_GT(std::ranges::min(result.radii), 0.6 * radius);
        }
    }
}

/// The curve of a rod ends in the ball that touches its end: so far from there as its radius.
TEST(Skeleton, OfARodReachesTheLastBall) {
    for (const std::uint64_t seed : {1, 2}) {
        for (const double delta : {0.01, 0.02}) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", delta " + std::to_string(delta));
            const auto length_of = [&](const TriangleMesh& mesh) {
                const auto solid = mesh_solid(repair(mesh));
                ScaleAxisOptions pipeline{.delta = Length::relative(delta), .scales = {1.1}, .seed = seed};
                pipeline.reaches_sharp_edges = false;
                const Skeleton s = skeleton(scale_axis(*solid, pipeline).axes[0].complex, *solid);
                return s.branches.size() == 1 ? branch_length(s, 0) : 0.0;
            };
            EXPECT_NEAR(length_of(box_mesh({0, 0, 0}, {10, 1, 1})), 9.0, delta > 0.01 ? 0.4 : 0.1);
            EXPECT_NEAR(length_of(cylinder_mesh(1.0, 5.0, 48)), 8.0, 0.1);
        }
    }
}

TEST(Skeleton, OfASquarePlateIsItsMiddle) {
    const MedialComplex complex = plate(4, 4, 6, 0.2);
    const Skeleton result = skeleton(complex);
    expect_well_formed(result);
    ASSERT_EQ(result.nodes.size(), 1u);
    Box box;
    std::ranges::for_each(complex.vertices, [&](const Point& p) { box.extend(p); });
    EXPECT_LT(distance(result.nodes[0], midpoint(box.min, box.max)), 0.5);
    EXPECT_EQ(result.branches.size(), 0u);
    // Without regard to significance the diagonals stay.
    const Skeleton all = skeleton(complex, {.significance = 0.0});
    expect_well_formed(all);
    const SkeletonStatistics statistics = statistics_of(all, complex);
    EXPECT_EQ(statistics.ends, 4);
    EXPECT_EQ(statistics.topology, known_topology(1, 0, 0));
    EXPECT_NEAR(statistics.length, 2.0 * std::hypot(4.0, 4.0), 0.4);
}

TEST(Skeleton, OfThreeArmsHasThreeBranches) {
    const std::vector<Arm> arms{{{1, 0, 0.2}, 5, 0.6}, {{-0.5, 1, 0}, 4, 0.5}, {{-0.4, -1, -0.3}, 3, 0.4}};
    const Result result = skeleton_of(*arms_solid(arms, 6));
    expect_well_formed(result.skeleton);
    EXPECT_EQ(result.statistics.branches, 3);
    EXPECT_EQ(result.statistics.ends, 3);
    EXPECT_EQ(result.statistics.junctions, 1);
    EXPECT_EQ(result.statistics.topology, known_topology(1, 0, 0));
    for (std::size_t n = 0; n < result.skeleton.nodes.size(); ++n) {
        const Point& p = result.skeleton.nodes[n];
        double off = std::numeric_limits<double>::infinity();
        double radius = 0.0;
        for (const Arm& arm : arms) {
            const double d = test::distance_to_segment(p, {0, 0, 0}, arm.length * unit(arm.direction));
            if (d < off) {
                off = d;
                radius = arm.radius;
            }
        }
        EXPECT_LT(off, 0.2);
        if (norm(p) > 1.2) {
            EXPECT_LT(off, 0.03);
            EXPECT_NEAR(result.skeleton.radii[n], radius, 0.03 * radius);
        }
    }
    std::vector<double> lengths;
    for (Index b = 0; b < 3; ++b) {
        lengths.push_back(branch_length(result.skeleton, b));
    }
    std::ranges::sort(lengths);
    // The branches meet within the ball in which the arms do.
    EXPECT_NEAR(lengths[0], 3.0, arms[0].radius);
    EXPECT_NEAR(lengths[1], 4.0, arms[0].radius);
    EXPECT_NEAR(lengths[2], 5.0, arms[0].radius);
}

// Where tubes meet in a corner or a limb leaves one at an angle, balls and sheets are larger: these are no ends.
/// Between two tubes that part slowly the axis is a sheet with large faces, which burns from three sides.
TEST(Skeleton, OfTwoTubesThatPartIsOneCurve) {
    for (const double degrees : {60.0, 90.0}) {
        const double angle = degrees * std::numbers::pi / 180.0;
        const Result result =
            skeleton_of(*arms_solid({{{1, 0, 0}, 4, 0.4}, {{std::cos(angle), std::sin(angle), 0}, 4, 0.4}}, 4.5));
        EXPECT_EQ(result.statistics.branches, 1) << degrees;
        EXPECT_NEAR(result.statistics.length, 7.5, 0.5) << degrees;
    }
}

// Of balls grown by 1.1 that one sticks out by 0.89, not 1.05: less than the radius of a finger and a quarter of its
// own.
TEST(Skeleton, OfABallWithFingersHasAllOfThem) {
    std::vector<Arm> arms{{{1, 0, 0}, 1e-3, 2.0}};
    for (const Point& direction : {Point{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}) {
        arms.push_back({direction, 2.65, 0.4});
    }
    const Result result = skeleton_of(*arms_solid(arms, 3.5));
    EXPECT_EQ(result.statistics.ends, 4);
    EXPECT_EQ(result.statistics.branches, 4);
}

TEST(Skeleton, OfAFrameOfTubesEndsWhereATubeEnds) {
    constexpr double kRadius = 0.4;
    const auto ring = [](const Point& p) {  // with mitred corners
        return std::hypot(std::max(std::abs(p.x) - 4.0, std::abs(p.y) - 3.0), p.z) - kRadius;
    };
    const auto bar = [](const Point& p) {  // with flat ends
        const Point along = unit(Point{3.0, 0.5, 0.0});
        const Point from = p - Point{4.0, 0.0, 0.0};
        const double way = dot(from, along);
        return std::max({norm(from - way * along) - kRadius, -way, way - 3.0});
    };
    const auto welded = [&](const Point& p) { return std::min(ring(p), bar(p)); };
    const Result one = skeleton_of(*function_solid(welded, {.bounds = centered_box(7.5, 4.0, 1.0)}));
    EXPECT_EQ(one.statistics.ends, 1);
    EXPECT_EQ(one.statistics.junctions, 1);
    EXPECT_EQ(one.statistics.topology, known_topology(1, 1, 0));

    const auto post = [](const Point& p) {
        return std::max(std::hypot(std::abs(p.x) - 4.0, std::abs(p.y) - 3.0) - kRadius, std::abs(p.z) - 3.0);
    };
    const auto cage = [&](const Point& p) {
        return std::min({ring(p - Point{0, 0, 3}), ring(p + Point{0, 0, 3}), post(p)});
    };
    const Result twelve = skeleton_of(*function_solid(cage, {.bounds = centered_box(5.0, 4.0, 4.0)}));
    EXPECT_EQ(twelve.statistics.ends, 0);
    EXPECT_EQ(twelve.statistics.junctions, 8);
    EXPECT_EQ(twelve.statistics.branches, 12);
    EXPECT_NEAR(twelve.statistics.length, 4.0 * (8.0 + 6.0 + 6.0), 1.6);
}

// The sum of the angles between successive edges, in degrees.
double turning(const Skeleton& skeleton, Index branch) {
    const std::span<const Index> nodes = skeleton.branches[branch];
    double sum = 0.0;
    for (std::size_t k = 2; k < nodes.size(); ++k) {
        const Point before = unit(skeleton.nodes[nodes[k - 1]] - skeleton.nodes[nodes[k - 2]]);
        const Point after = unit(skeleton.nodes[nodes[k]] - skeleton.nodes[nodes[k - 1]]);
        sum += std::acos(std::clamp(dot(before, after), -1.0, 1.0)) * 180.0 / std::numbers::pi;
    }
    return sum;
}

TEST(Skeleton, IsStraightAlongFlatParts) {
    const Result result = skeleton_of(*mesh_solid(box_mesh({0, 0, 0}, {12, 2.4, 0.8})));
    ASSERT_EQ(result.statistics.branches, 1);
    EXPECT_LT(turning(result.skeleton, 0), 60.0);
}

TEST(Skeleton, LeavesOutDetoursInABall) {
    MedialComplex complex;
    const auto add = [&](const Point& p) { add_vertex(complex, {p, 1.0}, {VertexKind::kTouching}); };
    for (int i = 0; i <= 40; ++i) {
        add({0.1 * i, 0, 0});
    }
    for (int i = 1; i <= 8; ++i) {
        add({4.0, 0.1 * i, 0});
    }
    for (int i = 7; i >= 0; --i) {
        add({4.05, 0.1 * i, 0});
    }
    for (int i = 0; i <= 40; ++i) {
        add({4.1 + 0.1 * i, 0, 0});
    }
    std::vector<std::array<Index, 2>> curve;
    for (Index v = 1; v < static_cast<Index>(complex.vertices.size()); ++v) {
        curve.push_back({v - 1, v});
    }
    build_edges(complex, curve);
    const Skeleton result = skeleton(complex);
    ASSERT_EQ(result.branches.size(), 1u);
    EXPECT_NEAR(branch_length(result, 0), 8.1, 0.05);
    EXPECT_LT(turning(result, 0), 30.0);
}

TEST(Skeleton, BallsAreTheLargestInTheSolid) {
    const auto solid = mesh_solid(dumbbell_mesh(1.5, 3.0, 0.5, 40));
    ScaleAxisOptions pipeline{.delta = Length::relative(0.02), .scales = {1.1}};
    pipeline.reaches_sharp_edges = false;
    const MedialComplex complex = scale_axis(*solid, pipeline).axes[0].complex;
    const Skeleton result = skeleton(complex, *solid);
    expect_well_formed(result);
    EXPECT_EQ(result.branches.size(), 1u);
    for (std::size_t n = 0; n < result.nodes.size(); ++n) {
        ASSERT_TRUE(solid->inside(result.nodes[n]));
        const std::optional<Point> nearest = solid->nearest(result.nodes[n]);
        ASSERT_TRUE(nearest);
        EXPECT_NEAR(distance(result.nodes[n], *nearest), result.radii[n], 0.02);
        EXPECT_LT(std::hypot(result.nodes[n].x, result.nodes[n].y), 0.1);
    }
    const Skeleton mean = skeleton(complex, *solid, {.radius = SkeletonRadius::kMean});
    EXPECT_EQ(mean.nodes, result.nodes);
    double least = 10.0;
    for (std::size_t n = 0; n < mean.nodes.size(); ++n) {
        EXPECT_GE(mean.radii[n], result.radii[n] - 0.02);
        least = std::min(least, mean.radii[n]);
    }
    EXPECT_NEAR(least, 0.5, 0.02);
    EXPECT_THROW(skeleton(complex, {.radius = SkeletonRadius::kMean}), InvalidOption);
}

TEST(Skeleton, OfATorusIsALoop) {
    const Result result = skeleton_of(torus_solid(2.0, 0.6));
    expect_well_formed(result.skeleton);
    EXPECT_EQ(result.statistics.topology, known_topology(1, 1, 0));
    ASSERT_EQ(result.statistics.branches, 1);
    EXPECT_EQ(result.skeleton.branches[0].front(), result.skeleton.branches[0].back());
    EXPECT_NEAR(result.statistics.length, 4.0 * std::numbers::pi, 0.05);
    for (std::size_t n = 0; n < result.skeleton.nodes.size(); ++n) {
        const Point& p = result.skeleton.nodes[n];
        EXPECT_NEAR(std::hypot(p.x, p.y), 2.0, 0.03);
        EXPECT_NEAR(result.skeleton.radii[n], 0.6, 0.02);
    }
}

TEST(Skeleton, OfAShellKeepsTheSheetAroundTheVoid) {
    const Result result = skeleton_of(shell_solid(2.0, 1.4), 0.03);
    expect_well_formed(result.skeleton);
    EXPECT_GT(result.statistics.faces, 0);
    EXPECT_EQ(result.statistics.topology, known_topology(1, 0, 1));
    EXPECT_TRUE(agree(result.statistics.complex_topology, result.statistics.topology));
}

TEST(Skeleton, OfSeveralPartsHasAComponentForEach) {
    std::vector<Ball> balls = chain_of_balls(30, 0.2, 0.5);
    for (const Ball& ball : ring_of_balls(60, 4.0, 0.5)) {
        balls.push_back({ball.center + Point{0, 20, 0}, ball.radius});
    }
    balls.push_back({{0, 0, 30}, 1.0});
    const MedialAxis axis = medial_axis(balls);
    const MedialComplex complex = filter(axis.complex, {}).complex;
    const Skeleton result = skeleton(complex, axis.ball_union);
    expect_well_formed(result);
    EXPECT_EQ(topology(result), known_topology(3, 1, 0));
    EXPECT_EQ(result.branches.size(), 2u);
    EXPECT_EQ(std::ranges::max(result.node_components), 2);
    EXPECT_EQ(std::ranges::count(degrees(result), 0), 1);
}

TEST(Skeleton, HasTheTopologyOfItsComplex) {
    Random random(5);
    for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE(i);
        const std::vector<Ball> balls =
            i % 2 == 0 ? scattered_balls(random, 40, 1.5, 0.2, 0.6) : balls_around_a_void(random, 40, 0.6);
        const MedialAxis axis = medial_axis(balls);
        for (const double significance : {0.0, 1.0, 100.0}) {
            const Skeleton result = skeleton(axis.complex, axis.ball_union, {.significance = significance});
            expect_well_formed(result);
            EXPECT_TRUE(agree(topology(axis.complex), topology(result)));
        }
    }
}

TEST(Skeleton, SpacingAndSignificance) {
    const auto solid = arms_solid({{{1, 0, 0}, 5, 1.0}, {{-1, 0, 0}, 5, 1.0}, {{0, 1, 0}, 2.2, 0.5}}, 6.5);
    for (const double spacing : {0.1, 0.5}) {
        const Result result = skeleton_of(*solid, 0.01, {.spacing = spacing});
        EXPECT_EQ(result.statistics.ends, 3);
        for (const auto& [a, b] : result.skeleton.edges) {
            const double length = distance(result.skeleton.nodes[a], result.skeleton.nodes[b]);
            EXPECT_LE(length, 1.5 * spacing);
        }
    }
    // Two arms stick out by five times their radius less half of it, the third one by less.
    EXPECT_EQ(skeleton_of(*solid, 0.01, {.significance = 4.0}).statistics.ends, 2);
}

TEST(Skeleton, NodesOfTheSurface) {
    const std::vector<Arm> arms{{{1, 0, 0}, 5, 0.6}, {{-0.5, 1, 0}, 4, 0.5}, {{-0.4, -1, 0}, 3, 0.4}};
    const Result result = skeleton_of(*arms_solid(arms, 6));
    std::vector<Point> points;
    for (const Arm& arm : arms) {
        points.push_back(0.8 * arm.length * unit(arm.direction) + Point{0, 0, arm.radius});
    }
    const std::vector<Index> nodes = nearest_nodes(result.skeleton, result.complex(), points);
    for (std::size_t i = 0; i < arms.size(); ++i) {
        EXPECT_LT(distance(result.skeleton.nodes[nodes[i]], points[i]), arms[i].radius + 0.15);
    }
    std::vector<Index> branches;
    for (const Index node : nodes) {
        branches.push_back(result.skeleton.node_branches[node]);
    }
    std::ranges::sort(branches);
    EXPECT_EQ(branches, (std::vector<Index>{0, 1, 2}));
    EXPECT_THROW(nearest_nodes(result.skeleton, {}, points), InvalidOption);
}

TEST(Skeleton, DoesNotDependOnThreads) {
    const Result result = skeleton_of(torus_solid(2.0, 0.8), 0.03);
    const auto with = [&](int threads) { return skeleton(result.complex(), SkeletonOptions(), {threads}); };
    const Skeleton one = with(1);
    const Skeleton three = with(3);
    EXPECT_EQ(one.nodes, three.nodes);
    EXPECT_EQ(one.radii, three.radii);
    EXPECT_EQ(one.edges, three.edges);
    EXPECT_EQ(one.vertex_nodes, three.vertex_nodes);
}

TEST(Skeleton, RefusesBadOptions) {
    const MedialComplex complex = plate(2, 2, 2, 0.2);
    EXPECT_THROW(skeleton(complex, {.spacing = -1.0}), InvalidOption);
    EXPECT_THROW(skeleton(complex, {.significance = std::nan("")}), InvalidOption);
    EXPECT_TRUE(skeleton(MedialComplex{}).nodes.empty());
}

class SkeletonFiles : public FolderTest {};

/// Nodes and parents of an SWC file, which must come before their children.
struct Swc {
    std::vector<Ball> balls;
    std::vector<int> parents;
    int cuts = 0;
};

Swc read_swc(const std::filesystem::path& file) {
    Swc result;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with('#')) {
            result.cuts += line.find("loop cut") != std::string::npos ? 1 : 0;
            continue;
        }
        std::istringstream words(line);
        int id = 0;
        int type = -1;
        int parent = 0;
        Ball ball;
        EXPECT_TRUE(words >> id >> type >> ball.center.x >> ball.center.y >> ball.center.z >> ball.radius >> parent);
        result.balls.push_back(ball);
        result.parents.push_back(parent);
        EXPECT_EQ(id, static_cast<int>(result.balls.size()));
        EXPECT_TRUE(parent == -1 || (parent > 0 && parent < id));
        EXPECT_EQ(type, 0) << "NEURON cuts sections where the type changes";
    }
    return result;
}

TEST_F(SkeletonFiles, SwcHasATreeForEachComponentAndCutsLoops) {
    std::vector<Ball> balls = ring_of_balls(60, 4.0, 0.5);
    for (const Ball& ball : chain_of_balls(30, 0.2, 0.5)) {
        balls.push_back({ball.center + Point{0, 20, 0}, ball.radius});
    }
    const MedialAxis axis = medial_axis(balls);
    const Skeleton result = skeleton(filter(axis.complex, {}).complex, axis.ball_union);
    write_skeleton(folder() / "s.swc", result);
    const Swc swc = read_swc(folder() / "s.swc");
    EXPECT_EQ(swc.balls.size(), result.nodes.size());
    EXPECT_EQ(std::ranges::count(swc.parents, -1), 2);
    EXPECT_EQ(swc.cuts, 1);
    double length = 0.0;
    for (std::size_t i = 0; i < swc.balls.size(); ++i) {
        if (swc.parents[i] > 0) {
            length += distance(swc.balls[i].center, swc.balls[swc.parents[i] - 1].center);
        }
    }
    const SkeletonStatistics statistics = statistics_of(result, axis.complex);
    EXPECT_LT(length, statistics.length);
    EXPECT_NEAR(length, statistics.length, 1.0);
}

TEST_F(SkeletonFiles, PlyIsAnAxisAgain) {
    const MedialAxis axis = medial_axis(ring_of_balls(60, 4.0, 0.5));
    const Skeleton result = skeleton(filter(axis.complex, {}).complex, axis.ball_union);
    write_skeleton(folder() / "s.ply", result);
    const MedialComplex read = read_axis(folder() / "s.ply");
    EXPECT_EQ(read.vertices, result.nodes);
    EXPECT_EQ(read.edges, result.edges);
    EXPECT_EQ(topology(read), topology(result));
}

/// A single node, a curve, a loop, and sheets around a void.
Skeleton skeleton_of_all_kinds() {
    Random random(7);
    std::vector<Ball> balls = balls_around_a_void(random, 200, 0.5);
    balls.push_back({{0, 0, 10}, 0.5});
    for (const Ball& ball : chain_of_balls(10, 0.4, 0.5)) {
        balls.push_back({ball.center + Point{0, 0, 20}, ball.radius});
    }
    for (const Ball& ball : ring_of_balls(60, 4.0, 0.5)) {
        balls.push_back({ball.center + Point{0, 0, 30}, ball.radius});
    }
    const MedialAxis axis = medial_axis(balls);
    Skeleton result = skeleton(filter(axis.complex, {}).complex, axis.ball_union);
    EXPECT_EQ(topology(result), known_topology(4, 1, 1));
    EXPECT_EQ(std::ranges::count(degrees(result), 0), 1);
    EXPECT_EQ(result.branches.size(), 2u);
    EXPECT_GT(result.faces.size(), 10u);
    return result;
}

template <class Values>
std::vector<double> as_doubles(const Values& values) {
    return std::vector<double>(values.begin(), values.end());
}

std::vector<double> coordinates_of(const std::vector<Point>& points) {
    std::vector<double> result;
    for (const Point& p : points) {
        result.insert(result.end(), {p.x, p.y, p.z});
    }
    return result;
}

/// The numbers of an array of VTK's, which must be of this type.
std::vector<double> vtk_array(const pugi::xml_node& owner, const char* name, const std::string& type) {
    const pugi::xml_node array = owner.find_child_by_attribute("DataArray", "Name", name);
    EXPECT_EQ(array.attribute("type").value(), type) << name;
    EXPECT_STREQ(array.attribute("format").value(), "ascii") << name;
    std::istringstream words(array.text().get());
    const std::vector<double> values{std::istream_iterator<double>(words), {}};
    EXPECT_TRUE(words.eof()) << name << " holds more than numbers";
    return values;
}

TEST_F(SkeletonFiles, SheetsAroundVoidsAreNoJunctionsAndNotInSwc) {
    const Skeleton all = skeleton_of_all_kinds();
    const SkeletonStatistics statistics = statistics_of(all, complex_of(all));
    EXPECT_EQ(statistics.junctions, 0) << "no branches meet";
    EXPECT_EQ(statistics.ends, 2);
    Index nodes = 1;  // the single one
    for (std::size_t b = 0; b < all.branches.size(); ++b) {
        const std::span<const Index> branch = all.branches[b];
        nodes += static_cast<Index>(branch.size()) - (branch.front() == branch.back() ? 1 : 0);
    }
    write_skeleton(path("s.swc"), all);
    const Swc swc = read_swc(path("s.swc"));
    EXPECT_EQ(static_cast<Index>(swc.balls.size()), nodes);
    EXPECT_EQ(std::ranges::count(swc.parents, -1), 3);
}

TEST_F(SkeletonFiles, VtpHoldsNodesBranchesAndFaces) {
    const Skeleton expected = skeleton_of_all_kinds();
    write_skeleton(path("s.vtp"), expected);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_file(path("s.vtp").c_str()));
    const pugi::xml_node file = document.child("VTKFile");
    EXPECT_STREQ(file.attribute("type").value(), "PolyData");
    const pugi::xml_node piece = file.child("PolyData").child("Piece");
    // Nodes, and a second point where the loop closes: lines share no points.
    const std::size_t count = expected.nodes.size();
    EXPECT_EQ(piece.attribute("NumberOfPoints").as_uint(), count + 1);
    EXPECT_EQ(piece.attribute("NumberOfVerts").as_uint(), 1u);
    EXPECT_EQ(piece.attribute("NumberOfLines").as_uint(), expected.branches.size());
    EXPECT_EQ(piece.attribute("NumberOfPolys").as_uint(), expected.faces.size());

    const pugi::xml_node nodes = piece.child("PointData");
    const std::vector<double> node = vtk_array(nodes, "node", "Int32");
    ASSERT_EQ(node.size(), count + 1);
    const auto at_points = [&](const auto& values) {
        std::vector<std::decay_t<decltype(values[0])>> result;
        for (const double n : node) {
            result.push_back(values[static_cast<std::size_t>(n)]);
        }
        return result;
    };
    for (std::size_t n = 0; n < count; ++n) {
        EXPECT_EQ(node[n], static_cast<double>(n));
    }
    EXPECT_EQ(vtk_array(piece.child("Points"), "Points", "Float64"), coordinates_of(at_points(expected.nodes)));
    EXPECT_EQ(piece.child("Points").child("DataArray").attribute("NumberOfComponents").as_int(), 3);
    const std::vector<Index> degree = degrees(expected);
    EXPECT_EQ(vtk_array(nodes, "radius", "Float64"), at_points(expected.radii));
    EXPECT_EQ(vtk_array(nodes, "MaximumInscribedSphereRadius", "Float64"), at_points(expected.radii));
    EXPECT_EQ(vtk_array(nodes, "degree", "Int32"), as_doubles(at_points(degree)));
    EXPECT_EQ(vtk_array(nodes, "branch", "Int32"), as_doubles(at_points(expected.node_branches)));
    EXPECT_EQ(vtk_array(nodes, "component", "Int32"), as_doubles(at_points(expected.node_components)));

    const double single = static_cast<double>(std::ranges::find(degree, 0) - degree.begin());
    EXPECT_EQ(vtk_array(piece.child("Verts"), "connectivity", "Int32"), std::vector{single});
    EXPECT_EQ(vtk_array(piece.child("Verts"), "offsets", "Int32"), std::vector{1.0});
    for (const auto& [name, lists] : {std::pair("Lines", &expected.branches), std::pair("Polys", &expected.faces)}) {
        std::vector<double> corners = vtk_array(piece.child(name), "connectivity", "Int32");
        EXPECT_EQ(std::set<double>(corners.begin(), corners.end()).size() == corners.size(),
                  lists == &expected.branches);
        std::ranges::transform(corners, corners.begin(), [&](double c) { return node[static_cast<std::size_t>(c)]; });
        for (std::size_t i = 0; i < lists->size(); ++i) {  // the tree's root may be at the other end of a line
            const std::span<const Index> list = (*lists)[i];
            const auto first = corners.begin() + lists->offsets[i];
            const std::vector<double> line(first, first + static_cast<std::ptrdiff_t>(list.size()));
            EXPECT_TRUE(std::ranges::equal(line, list) ||
                        std::equal(line.begin(), line.end(), list.rbegin(), list.rend()));
        }
        EXPECT_EQ(vtk_array(piece.child(name), "offsets", "Int32"),
                  std::vector<double>(lists->offsets.begin() + 1, lists->offsets.end()));
    }

    // Cells in this order: single nodes, branches, faces.
    std::vector<double> branch_of_cell{kNone};
    std::vector<double> length_of_cell{0.0};
    for (Index b = 0; b < static_cast<Index>(expected.branches.size()); ++b) {
        branch_of_cell.push_back(b);
        length_of_cell.push_back(branch_length(expected, b));
    }
    branch_of_cell.resize(branch_of_cell.size() + expected.faces.size(), kNone);
    length_of_cell.resize(branch_of_cell.size(), 0.0);
    EXPECT_EQ(vtk_array(piece.child("CellData"), "branch", "Int32"), branch_of_cell);
    EXPECT_EQ(vtk_array(piece.child("CellData"), "length", "Float64"), length_of_cell);
    EXPECT_EQ(vtk_array(piece.child("CellData"), "Length", "Float64"), length_of_cell);
    EXPECT_EQ(vtk_array(piece.child("CellData"), "GroupIds", "Int32"), branch_of_cell);
    const std::vector<double> blanking = vtk_array(piece.child("CellData"), "Blanking", "Int32");
    ASSERT_EQ(blanking.size(), branch_of_cell.size());
    for (std::size_t c = 0; c < blanking.size(); ++c) {
        EXPECT_EQ(blanking[c], branch_of_cell[c] < 0 ? 1.0 : 0.0);
    }
}

std::string kind_of(Index degree) {
    return degree == 0 ? "single" : degree == 1 ? "end" : degree == 2 ? "inner" : "junction";
}

TEST_F(SkeletonFiles, GraphmlHoldsNodesAndEdgesWithDeclaredValues) {
    const Skeleton expected = skeleton_of_all_kinds();
    write_skeleton(path("s.graphml"), expected);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_file(path("s.graphml").c_str()));
    const pugi::xml_node root = document.child("graphml");
    EXPECT_STREQ(root.attribute("xmlns").value(), "http://graphml.graphdrawing.org/xmlns");
    const pugi::xml_node graph = root.child("graph");
    EXPECT_STREQ(graph.attribute("edgedefault").value(), "undirected");
    // A value is only read where its key is declared for the element that has it.
    const auto value = [&](const pugi::xml_node& element, const char* key, const std::string& type) {
        const pugi::xml_node declared = root.find_child_by_attribute("key", "id", key);
        EXPECT_STREQ(declared.attribute("for").value(), element.name()) << key;
        EXPECT_STREQ(declared.attribute("attr.name").value(), key);
        EXPECT_EQ(declared.attribute("attr.type").value(), type) << key;
        return element.find_child_by_attribute("data", "key", key).text();
    };
    const std::vector<Index> degree = degrees(expected);
    std::size_t n = 0;
    for (const pugi::xml_node& node : graph.children("node")) {
        ASSERT_LT(n, expected.nodes.size());
        EXPECT_EQ(node.attribute("id").value(), "n" + std::to_string(n));
        const Point place{value(node, "x", "double").as_double(), value(node, "y", "double").as_double(),
                          value(node, "z", "double").as_double()};
        EXPECT_EQ(place, expected.nodes[n]);
        EXPECT_EQ(value(node, "radius", "double").as_double(), expected.radii[n]);
        EXPECT_EQ(value(node, "kind", "string").get(), kind_of(degree[n]));
        EXPECT_EQ(value(node, "branch", "int").as_int(), expected.node_branches[n]);
        EXPECT_EQ(value(node, "component", "int").as_int(), expected.node_components[n]);
        ++n;
    }
    EXPECT_EQ(n, expected.nodes.size());
    std::size_t e = 0;
    for (const pugi::xml_node& edge : graph.children("edge")) {
        ASSERT_LT(e, expected.edges.size());
        const auto& [a, b] = expected.edges[e];
        EXPECT_EQ(edge.attribute("source").value(), "n" + std::to_string(a));
        EXPECT_EQ(edge.attribute("target").value(), "n" + std::to_string(b));
        EXPECT_EQ(value(edge, "length", "double").as_double(), distance(expected.nodes[a], expected.nodes[b]));
        ++e;
    }
    EXPECT_EQ(e, expected.edges.size());
}

TEST_F(SkeletonFiles, JsonHoldsNodesEdgesBranchesAndFaces) {
    using Json = nlohmann::json;
    const Skeleton expected = skeleton_of_all_kinds();
    write_skeleton(path("s.json"), expected);
    const Json document = Json::parse(content("s.json"));
    EXPECT_EQ(document.at("schema").get<std::string>(), "scaleaxis.skeleton-graph/1");
    const std::vector<Index> degree = degrees(expected);
    const Json& nodes = document.at("nodes");
    ASSERT_EQ(nodes.size(), expected.nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const auto [x, y, z] = nodes[n].at("place").get<std::array<double, 3>>();
        EXPECT_EQ((Point{x, y, z}), expected.nodes[n]);
        EXPECT_EQ(nodes[n].at("radius").get<double>(), expected.radii[n]);
        EXPECT_EQ(nodes[n].at("kind").get<std::string>(), kind_of(degree[n]));
        EXPECT_EQ(nodes[n].at("branch").get<Index>(), expected.node_branches[n]);
        EXPECT_EQ(nodes[n].at("component").get<Index>(), expected.node_components[n]);
    }
    EXPECT_EQ((document.at("edges").get<std::vector<std::array<Index, 2>>>()), expected.edges);
    const Json& branches = document.at("branches");
    ASSERT_EQ(branches.size(), expected.branches.size());
    for (std::size_t b = 0; b < branches.size(); ++b) {
        const std::span<const Index> on_it = expected.branches[b];
        EXPECT_EQ(branches[b].at("nodes").get<std::vector<Index>>(), std::vector<Index>(on_it.begin(), on_it.end()));
        EXPECT_EQ(branches[b].at("length").get<double>(), branch_length(expected, static_cast<Index>(b)));
        std::vector<double> radii;
        std::ranges::transform(on_it, std::back_inserter(radii), [&](Index n) { return expected.radii[n]; });
        EXPECT_EQ(branches[b].at("least_radius").get<double>(), std::ranges::min(radii));
        EXPECT_EQ(branches[b].at("largest_radius").get<double>(), std::ranges::max(radii));
    }
    const Json& faces = document.at("faces");
    ASSERT_EQ(faces.size(), expected.faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const std::span<const Index> corners = expected.faces[f];
        EXPECT_EQ(faces[f].get<std::vector<Index>>(), std::vector<Index>(corners.begin(), corners.end()));
    }
}

TEST_F(SkeletonFiles, PartsAreAMeshAndUnknownFormatsAreRefused) {
    const MedialAxis axis = medial_axis(chain_of_balls(10, 0.4, 0.5));
    const Skeleton result = skeleton(axis.complex, axis.ball_union);
    EXPECT_THROW(write_skeleton(folder() / "s.stl", result), FileError);
    EXPECT_THROW(check_skeleton_output(folder() / "s.stl"), FileError);
    const TriangleMesh surface{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    write_parts(folder() / "parts.ply", surface, result, std::vector<Index>{0, 1, 2});
    EXPECT_EQ(read_mesh(folder() / "parts.ply").triangles, surface.triangles);
    EXPECT_THROW(write_parts(folder() / "parts.ply", surface, result, std::vector<Index>{0}), InvalidOption);
}

TEST(Skeleton, IsLedToOpenings) {
    // A pipe of length 10 without its ends.
    constexpr int kSides = 32;
    TriangleMesh pipe;
    for (int ring = 0; ring <= 20; ++ring) {
        for (int side = 0; side < kSides; ++side) {
            const double angle = 2.0 * std::numbers::pi * side / kSides;
            pipe.vertices.push_back({std::cos(angle), std::sin(angle), 0.5 * ring});
        }
    }
    for (Index ring = 0; ring < 20; ++ring) {
        for (Index side = 0; side < kSides; ++side) {
            const Index a = ring * kSides + side;
            const Index b = ring * kSides + (side + 1) % kSides;
            pipe.triangles.push_back({a, b, b + kSides});
            pipe.triangles.push_back({a, b + kSides, a + kSides});
        }
    }
    RepairedMesh repaired = repair(pipe);
    const std::vector<Hole> holes = repaired.report.holes;
    ASSERT_EQ(holes.size(), 2U);
    const auto solid = mesh_solid(std::move(repaired));
    const MedialComplex axis =
        scale_axis(*solid, {.delta = Length::relative(0.02), .reaches_sharp_edges = false}).axes[0].complex;
    const Skeleton short_one = skeleton(axis, *solid);
    const Skeleton led = led_to_openings(short_one, holes, 0.3);
    ASSERT_EQ(led.branches.size(), 1U);
    EXPECT_NEAR(branch_length(short_one, 0), 8.0, 0.2);
    EXPECT_NEAR(branch_length(led, 0), 10.0, 0.01);
    for (const Index end : {led.branches[0].front(), led.branches[0].back()}) {
        EXPECT_NEAR(std::abs(led.nodes[end].z - 5.0), 5.0, 1e-6);
        EXPECT_NEAR(led.radii[end], 1.0, 0.02);
    }
    for (const auto& [a, b] : led.edges) {
        EXPECT_LT(distance(led.nodes[a], led.nodes[b]), 0.4);
    }
    EXPECT_EQ(statistics_of(led, axis).ends, 2);
    EXPECT_TRUE(statistics_of(led, axis).topology == topology(short_one));
    const std::vector<Hole> far{{.place = {5, 5, 5}, .width = 1.0, .area = 1.0, .edges = 4, .center = {5, 5, 5}}};
    EXPECT_EQ(led_to_openings(short_one, far, 0.3).nodes.size(), short_one.nodes.size());
    EXPECT_THROW(led_to_openings(short_one, holes, -1.0), InvalidOption);
}

}  // namespace
}  // namespace scaleaxis
