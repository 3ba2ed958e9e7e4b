// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/medial_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <string>
#include <thread>

#include "complexes.hpp"
#include "homology.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr double kDegrees = 180.0 / std::numbers::pi;

MedialAxis axis_as_given(const Balls& balls) { return medial_axis(balls, {.perturbation = 0.0}); }

std::vector<Index> balls_of(const MedialComplex& complex) {
    std::vector<Index> balls;
    for (const VertexOrigin& origin : complex.vertex_origins) {
        balls.push_back(origin.ball);
    }
    return balls;
}

Balls moved(Balls balls, double scale, const Point& translation) {
    for (Ball& ball : balls) {
        ball = {scale * ball.center + translation, scale * ball.radius};
    }
    return balls;
}

// Few balls, of which all is known.

TEST(MedialAxis, OfOneBallIsItsCentre) {
    const MedialAxis axis = axis_as_given({{{1.0, 2.0, 3.0}, 0.5}});
    EXPECT_EQ(axis.complex.vertices, (std::vector<Point>{{1.0, 2.0, 3.0}}));
    EXPECT_EQ(axis.complex.radii, std::vector<double>{0.5});
    EXPECT_EQ(balls_of(axis.complex), std::vector<Index>{0});
    EXPECT_TRUE(axis.complex.edges.empty());
    EXPECT_TRUE(axis.complex.faces.empty());
    EXPECT_EQ(axis.statistics.medial_complex, known_topology(1, 0, 0));
    EXPECT_EQ(axis.statistics.boundary_vertices, 0);
}

TEST(MedialAxis, OfTwoOverlappingBallsIsASegment) {
    const MedialAxis axis = axis_as_given({{{0.0, 0.0, 0.0}, 1.0}, {{1.2, 0.0, 0.0}, 0.7}});
    EXPECT_EQ(axis.complex.vertices, (std::vector<Point>{{0.0, 0.0, 0.0}, {1.2, 0.0, 0.0}}));
    EXPECT_EQ(axis.complex.radii, (std::vector<double>{1.0, 0.7}));
    EXPECT_EQ(balls_of(axis.complex), (std::vector<Index>{0, 1}));
    EXPECT_EQ(axis.complex.edges, (std::vector<std::array<Index, 2>>{{0, 1}}));
    EXPECT_TRUE(axis.complex.faces.empty());
}

TEST(MedialAxis, OfTwoTangentBallsIsASegment) {
    const MedialAxis axis = axis_as_given({{{0.0, 0.0, 0.0}, 1.0}, {{1.5, 0.0, 0.0}, 0.5}});
    EXPECT_EQ(axis.complex.edges.size(), 1U);
    EXPECT_EQ(axis.statistics.medial_complex, known_topology(1, 0, 0));
}

TEST(MedialAxis, OfTwoDisjointBallsAreTwoPoints) {
    const MedialAxis axis = axis_as_given({{{0.0, 0.0, 0.0}, 1.0}, {{1.75, 0.0, 0.0}, 0.5}});
    EXPECT_EQ(axis.complex.vertices.size(), 2U);
    EXPECT_TRUE(axis.complex.edges.empty());
    EXPECT_EQ(axis.statistics.medial_complex, known_topology(2, 0, 0));
}

TEST(MedialAxis, OfThreeOverlappingBallsIsATriangle) {
    const double side = 1.0;
    const double height = side * std::sqrt(0.75);
    const MedialAxis axis =
        axis_as_given({{{0.0, 0.0, 0.0}, 0.8}, {{side, 0.0, 0.0}, 0.8}, {{0.5 * side, height, 0.0}, 0.8}});
    const MedialComplex& c = axis.complex;
    ASSERT_EQ(c.faces.size(), 1U);
    EXPECT_EQ(c.vertices.size(), 3U);
    EXPECT_EQ(c.edges.size(), 3U);
    EXPECT_EQ(c.sheets, 1);
    // The spheres meet above and below the middle of the triangle, which sees both points under the largest angle.
    ASSERT_EQ(c.boundary_vertices.size(), 2U);
    const double up = std::sqrt(0.8 * 0.8 - side * side / 3.0);
    for (const Point& p : c.boundary_vertices) {
        EXPECT_NEAR(distance(p, {0.5 * side, height / 3.0, p.z}), 0.0, 1e-12);
        EXPECT_NEAR(std::abs(p.z), up, 1e-12);
    }
    EXPECT_NEAR(c.face_angles[0], 90.0, 1e-9);
    EXPECT_EQ(c.boundary_vertex_balls[0], (std::array<Index, 3>{0, 1, 2}));
    EXPECT_EQ(c.boundary_vertex_balls[1], (std::array<Index, 3>{0, 1, 2}));
}

TEST(MedialAxis, TellsTheObjectAngleOfAnObtuseTriangle) {
    // The plane between the contacts meets their line outside the triangle, whose longest side is the nearest to it.
    const Balls balls{{{-1.0, 0.0, 0.0}, 1.3}, {{1.0, 0.0, 0.0}, 1.3}, {{0.0, 0.3, 0.0}, 0.95}};
    const MedialAxis axis = axis_as_given(balls);
    ASSERT_EQ(axis.complex.faces.size(), 1U);
    const Point contact = axis.complex.boundary_vertices[0];
    EXPECT_GT(std::abs(contact.y), 0.05) << "the contacts lie beside the triangle";
    const double beside =
        contact.y < 0.0 ? -contact.y : distance_to_segment({0.0, contact.y, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.3, 0.0});
    EXPECT_NEAR(axis.complex.face_angles[0], std::atan2(std::abs(contact.z), beside) * kDegrees, 1e-9);
    EXPECT_LT(axis.complex.face_angles[0], 89.0);
}

// Where balls touch, or are tiny beside others, a perturbation in parts of the radii may part them.
TEST(MedialAxis, KeepsTheTopologyOfBallsThatTouch) {
    Balls row;
    Balls grid;
    Balls beads{{{0.0, 0.0, 0.0}, 1.0}};  // on a large ball
    for (int i = 0; i < 8; ++i) {
        row.push_back({{2.0 * i, 0.0, 0.0}, 1.0});
        grid.push_back({{2.0 * (i & 1), 1.0 * (i & 2), 0.5 * (i & 4)}, 1.0});
        const double sign = (i & 1) != 0 ? 1.0 : -1.0;
        const int axis = i / 2 % 3;
        beads.push_back({{axis == 0 ? sign : 0.0, axis == 1 ? sign : 0.0, axis == 2 ? sign : 0.0}, 1e-5});
    }
    for (const Balls& balls : {row, grid, beads}) {
        for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
            const MedialAxis axis = medial_axis(balls, {.seed = seed});
            EXPECT_EQ(axis.statistics.medial_complex.components, 1) << "seed " << seed;
            ASSERT_TRUE(axis.statistics.given_union);
            EXPECT_TRUE(agree(axis.statistics.medial_complex, *axis.statistics.given_union)) << "seed " << seed;
            EXPECT_FALSE(changed_union(axis.statistics));
        }
    }
}

TEST(MedialAxis, KeepsTheTopologyOfBallsThatAreHardlyApart) {
    const Balls balls{{{0.0, 0.0, 0.0}, 1.0}, {{2.0 + 1e-12, 0.0, 0.0}, 1.0}, {{4.0 + 2e-12, 0.0, 0.0}, 1.0}};
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
        EXPECT_EQ(medial_axis(balls, {.seed = seed}).statistics.medial_complex.components, 3) << "seed " << seed;
    }
}

TEST(MedialAxis, TellsThatTheUnionIsAnother) {
    MedialAxisStatistics statistics;
    statistics.perturbation = 1e-4;
    statistics.dual_complex = known_topology(2, 0, 0);
    EXPECT_FALSE(changed_union(statistics)) << "nothing was compared";
    statistics.given_union = known_topology(2, 0, 0);
    EXPECT_FALSE(changed_union(statistics));
    statistics.given_union = known_topology(1, 0, 0);
    ASSERT_TRUE(changed_union(statistics));
    EXPECT_EQ(changed_union(statistics)->code, "axis.perturbed_union");
}

TEST(MedialAxis, OfAChainIsThePolyline) {
    const int count = 20;
    const MedialAxis axis = axis_as_given(chain_of_balls(count, 1.0, 0.8));
    EXPECT_EQ(axis.complex.vertices.size(), 20U);
    ASSERT_EQ(axis.complex.edges.size(), 19U);
    for (Index i = 0; i + 1 < count; ++i) {
        EXPECT_EQ(axis.complex.edges[i], (std::array{i, i + 1}));
    }
    EXPECT_TRUE(axis.complex.faces.empty());
}

TEST(MedialAxis, LeavesOutBallsWithinOthers) {
    const Balls balls{{{0.0, 0.0, 0.0}, 1.0}, {{0.1, 0.0, 0.0}, 0.5}, {{1.2, 0.0, 0.0}, 0.7}, {{0.0, 0.0, 0.0}, 1.0}};
    const MedialAxis axis = axis_as_given(balls);
    EXPECT_EQ(axis.statistics.balls, 4);
    EXPECT_EQ(axis.statistics.hidden_balls, 2);
    EXPECT_EQ(axis.complex.edges.size(), 1U);
    EXPECT_EQ(balls_of(axis.complex), (std::vector<Index>{0, 2}));
}

TEST(MedialAxis, FindsTunnelsAndVoids) {
    EXPECT_EQ(medial_axis(ring_of_balls(12, 1.0, 0.4)).statistics.medial_complex, known_topology(1, 1, 0));
    Random random(1);
    EXPECT_EQ(medial_axis(balls_around_a_void(random, 100, 0.5)).statistics.medial_complex, known_topology(1, 0, 1));
    // At the corners of a cube: a graph of twelve edges, then six sides around a void, then all.
    EXPECT_EQ(medial_axis(grid_of_balls(2, 2, 2, 0.6)).statistics.medial_complex, known_topology(1, 5, 0));
    EXPECT_EQ(medial_axis(grid_of_balls(2, 2, 2, 0.8)).statistics.medial_complex, known_topology(1, 0, 1));
    EXPECT_EQ(medial_axis(grid_of_balls(2, 2, 2, 0.9)).statistics.medial_complex, known_topology(1, 0, 0));
}

TEST(MedialAxis, OfEqualBallsAtTheCornersOfACubeIsWhereDiagonalPlanesMeet) {
    // The nearest points of the boundary are the six above the middles of the cube's sides: the axis is made of the
    // parts of the planes |x| = |y|, |y| = |z|, |z| = |x| that are nearest to two of them. The perturbation moves them.
    const Point middle{0.5, 0.5, 0.5};
    const MedialAxis axis = medial_axis(grid_of_balls(2, 2, 2, 0.9), {.perturbation = 1e-6});
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        const double large = uniform(random, 0.0, 0.5);
        const double small = uniform(random, -large, large);
        const double other = i % 2 == 0 ? large : -large;
        const Point p = i % 3 == 0   ? Point{large, other, small}
                        : i % 3 == 1 ? Point{small, large, other}
                                     : Point{other, small, large};
        EXPECT_LT(distance_to(axis.complex, middle + p), 2e-5) << i;
    }
    for (const Point& v : axis.complex.vertices) {
        std::array<double, 3> at{std::abs(v.x - 0.5), std::abs(v.y - 0.5), std::abs(v.z - 0.5)};
        std::sort(at.begin(), at.end());
        EXPECT_NEAR(at[2], at[1], 2e-5);
        EXPECT_LT(at[2], 0.5 + 2e-5);
    }
}

// Random unions against brute force.

Balls balls_of(const MedialAxis& axis) { return {axis.ball_union.balls().begin(), axis.ball_union.balls().end()}; }

// Everything of the complex is medial (its ball is empty of the boundary, and touches it at both contacts), and
// everything medial that random points lead to is in the complex.
void expect_is_medial_axis(const MedialAxis& axis, Random& random, double size = 1.0, double accuracy = 1e-6) {
    const MedialComplex& c = axis.complex;
    const Balls balls = balls_of(axis);
    const UnionOfBalls truth(balls);
    const double tolerance = accuracy * size;

    ASSERT_EQ(c.boundary_vertices.size(), truth.vertices().size());
    for (std::size_t v = 0; v < c.boundary_vertices.size(); ++v) {
        const auto is_same = [&](const UnionOfBalls::Vertex& other) {
            return other.balls == c.boundary_vertex_balls[v] &&
                   distance(other.point, c.boundary_vertices[v]) < tolerance;
        };
        ASSERT_EQ(std::count_if(truth.vertices().begin(), truth.vertices().end(), is_same), 1) << "vertex " << v;
    }
    const auto expect_medial = [&](const Ball& ball, const char* what, std::size_t i) {
        ASSERT_NEAR(truth.depth(ball.center), ball.radius, 10.0 * tolerance) << what << ' ' << i;
    };
    for (std::size_t v = 0; v < c.vertices.size(); ++v) {
        expect_medial({c.vertices[v], c.radii[v]}, "vertex", v);
        if (const auto& [kind, ball] = c.vertex_origins[v]; kind == VertexKind::kBall) {
            ASSERT_EQ((Ball{c.vertices[v], c.radii[v]}), balls[ball]);
        }
    }
    for (std::size_t e = 0; e < c.edges.size(); ++e) {
        expect_medial(random_ball_of(c, c.edges[e], random), "edge", e);
    }
    for (std::size_t f = 0; f < c.faces.size(); ++f) {
        const Ball ball = random_ball_of(c, c.faces[f], random);
        expect_medial(ball, "face", f);
        const Point& a = c.boundary_vertices[c.face_contacts[f][0]];
        const Point& b = c.boundary_vertices[c.face_contacts[f][1]];
        ASSERT_NEAR(distance(ball.center, a), ball.radius, 10.0 * tolerance) << "face " << f;
        ASSERT_NEAR(distance(ball.center, b), ball.radius, 10.0 * tolerance) << "face " << f;
        const double nearest = distance_to_face(c, f, midpoint(a, b));
        ASSERT_NEAR(c.face_angles[f], std::atan2(0.5 * distance(a, b), nearest) * kDegrees, 0.01) << "face " << f;
    }

    // From the nearest boundary point of a random point straight on, as long as it stays the nearest one. Where the
    // end is ill-conditioned (another one comes near very slowly) it proves nothing.
    const Box box = bounds(balls);
    const double far = box.diagonal();
    for (int i = 0; i < 20; ++i) {
        const Point start = midpoint(box.min, box.max) + random_point(random, 0.25 * far);
        if (!truth.contains(start)) {
            continue;
        }
        const auto [depth, foot] = truth.boundary_near(start);
        const Point direction = (1.0 / depth) * (start - foot);
        const auto reach = [&, origin = foot, first = depth](double slack) {
            double low = first;
            double high = far;
            for (int step = 0; step < 60; ++step) {
                const double middle = 0.5 * (low + high);
                const bool is_nearest = truth.depth(origin + middle * direction) >= middle - slack;
                (is_nearest ? low : high) = middle;
            }
            return low;
        };
        const double end = reach(1e-10 * size);
        if (depth > tolerance && reach(1e-8 * size) < end + tolerance) {
            ASSERT_LT(distance_to(c, foot + end * direction), 10.0 * tolerance) << "incomplete near ray " << i;
        }
    }
}

struct Family {
    std::string name;
    Balls balls;
};

std::vector<Family> families(std::uint64_t seed, int count) {
    Random random(seed);
    const auto cells = static_cast<int>(seed % 3);
    return {{"scattered", scattered_balls(random, count, 1.0, 0.2, 0.8)},
            {"sparse", scattered_balls(random, count, 2.0, 0.2, 0.8)},
            {"of all sizes", balls_of_all_sizes(random, count)},
            {"around a void", balls_around_a_void(random, count, 0.6)},
            {"through few points", balls_through_points(random, count, 8)},
            {"through many points", balls_through_points(random, count, 30)},
            {"coplanar", flat_balls(random, count)},
            {"collinear", aligned_balls(random, count)},
            {"grid", grid_of_balls(1 + cells, 2, 2, uniform(random, 0.5, 0.9))},
            {"touching grid", grid_of_balls(2, 1 + cells, 2, std::sqrt(0.25 * (1 + cells)))},
            {"ring", ring_of_balls(count, 1.0, uniform(random, 0.2, 1.2))},
            {"chain", chain_of_balls(count, 1.0, uniform(random, 0.5, 1.5))}};
}

TEST(MedialAxis, OfRandomUnionsIsTheTrueOne) {
    int retries = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const int count = seed <= 48 ? 3 + static_cast<int>(seed) % 14 : 5 * static_cast<int>(seed - 48);
        for (const auto& [name, balls] : families(seed, count)) {
            SCOPED_TRACE(name + ", " + std::to_string(balls.size()) + " balls, seed " + std::to_string(seed));
            Random random(seed);
            // Brute force cannot tell balls that are grown by 1e-9 from those that touch.
            const MedialAxis axis = medial_axis(balls, {.seed = seed, .compares_union = false});
            retries += axis.statistics.retries;
            expect_well_formed(axis.complex);
            expect_is_medial_axis(axis, random);
            if (HasFatalFailure()) {
                return;
            }
        }
    }
    std::cout << "retries: " << retries << '\n';
}

TEST(MedialAxis, HasTheTopologyOfTheNerve) {
    std::map<Topology, int, decltype([](const Topology& a, const Topology& b) {
                 return std::tie(a.components, a.tunnels, a.voids) < std::tie(b.components, b.tunnels, b.voids);
             })>
        seen;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        for (const auto& [name, balls] : families(seed, 3 + static_cast<int>(seed) % 11)) {
            SCOPED_TRACE(name + ", " + std::to_string(balls.size()) + " balls, seed " + std::to_string(seed));
            const MedialAxis axis = medial_axis(balls, {.seed = seed});
            const Topology truth = nerve_homology(balls_of(axis));
            ASSERT_EQ(axis.statistics.dual_complex, truth);
            ASSERT_EQ(axis.statistics.medial_complex, truth);
            ASSERT_EQ(homology(axis.complex), truth);
            ++seen[truth];
        }
    }
    const auto has = [&](auto property) { return std::any_of(seen.begin(), seen.end(), property); };
    EXPECT_TRUE(has([](const auto& entry) { return entry.first.components > 2; }));
    EXPECT_TRUE(has([](const auto& entry) { return entry.first.tunnels > 2; }));
    EXPECT_TRUE(has([](const auto& entry) { return entry.first.voids > 0; }));
}

// Degenerate input, near the origin and far from it, very small and very large.

std::vector<Family> degenerate_families() {
    Random random(5);
    Balls scattered = scattered_balls(random, 12, 1.0, 0.2, 0.8);
    Balls doubled = scattered;
    doubled.insert(doubled.end(), scattered.begin(), scattered.end());
    Balls nearly_doubled = scattered;
    for (Ball& ball : scattered) {
        nearly_doubled.push_back({ball.center + 1e-11 * random_direction(random), ball.radius});
    }
    Balls nested;
    for (int i = 0; i < 10; ++i) {
        nested.push_back({{0.1 * i, 0.0, 0.0}, 1.0 - 0.1 * i});  // tangent from within at one point
    }
    Balls on_a_sphere;
    Balls through_the_origin;
    for (int i = 0; i < 30; ++i) {
        on_a_sphere.push_back({random_direction(random), 0.5});
        through_the_origin.push_back({random_direction(random), 1.0});
    }
    Balls octahedron;
    for (const double x : {-1.0, 1.0}) {
        octahedron.insert(octahedron.end(), {{{x, 0, 0}, 0.9}, {{0, x, 0}, 0.9}, {{0, 0, x}, 0.9}});
    }
    Balls beside_a_plane = scattered;
    beside_a_plane.push_back({{0.0, 0.0, -1e4}, 1e4});
    return {{"one", {{{0.0, 0.0, 0.0}, 1.0}}},
            {"tangent", chain_of_balls(6, 1.0, 0.5)},
            {"nested", nested},
            {"doubled", doubled},
            {"nearly doubled", nearly_doubled},
            {"collinear", aligned_balls(random, 15)},
            {"coplanar", flat_balls(random, 25)},
            {"on a sphere", on_a_sphere},
            {"through one point", through_the_origin},
            {"through eight points", balls_through_points(random, 60, 8)},
            {"octahedron", octahedron},
            {"beside a plane", beside_a_plane},
            {"row of a grid", grid_of_balls(5, 1, 1, 0.6)},
            {"layer of a grid", grid_of_balls(4, 4, 1, 0.7)},
            {"grid", grid_of_balls(4, 4, 4, 0.6)},
            {"grid, touching", grid_of_balls(3, 3, 3, 0.5)},
            {"grid, touching along the face", grid_of_balls(3, 3, 3, std::sqrt(0.5))},
            {"grid, touching through the cube", grid_of_balls(3, 3, 3, std::sqrt(0.75))},
            {"grid, dense", grid_of_balls(3, 4, 5, 1.1)}};
}

TEST(MedialAxis, OfDegenerateUnionsIsRightWhereverTheyAre) {
    struct Place {
        double scale;
        Point translation;
    };
    const Point far{1e6, -1e6, 1e6};
    for (const Place& place : {Place{1.0, {}}, Place{1e-9, {}}, Place{1e9, {}}, Place{1.0, far}}) {
        for (const auto& [name, balls] : degenerate_families()) {
            SCOPED_TRACE(name + ", scale " + std::to_string(place.scale) + ", x " +
                         std::to_string(place.translation.x));
            MedialAxis axis = medial_axis(moved(balls, place.scale, place.translation), {.compares_union = false});
            EXPECT_LE(axis.statistics.retries, 2);
            expect_well_formed(axis.complex);
            EXPECT_EQ(homology(axis.complex), axis.statistics.dual_complex);
            // Back to where the brute force is accurate.
            axis.ball_union = BallUnion(moved(balls_of(axis), 1.0, -1.0 * place.translation));
            for (Point& p : axis.complex.vertices) {
                p = p - place.translation;
            }
            for (Point& p : axis.complex.boundary_vertices) {
                p = p - place.translation;
            }
            Random random(1);
            expect_is_medial_axis(axis, random, place.scale, place.translation == Point() ? 1e-6 : 1e-4);
            if (HasFatalFailure()) {
                return;
            }
        }
    }
}

// Without a perturbation symbolic ones decide. A contradiction leads to a small perturbation, and is counted.
TEST(MedialAxis, CopesWithDegenerateUnionsAsTheyAre) {
    int retries = 0;
    for (const auto& [name, balls] : degenerate_families()) {
        SCOPED_TRACE(name);
        const MedialAxis axis = axis_as_given(balls);
        expect_well_formed(axis.complex);
        EXPECT_EQ(homology(axis.complex), axis.statistics.dual_complex);
        retries += axis.statistics.retries;
        EXPECT_EQ(axis.statistics.perturbation > 0.0, axis.statistics.retries > 0);
        EXPECT_LT(axis.statistics.perturbation, 1e-4);
    }
    EXPECT_GT(retries, 0) << "no input tests the repetition";
}

// Invariance.

TEST(MedialAxis, ScalesExactlyWithPowersOfTwo) {
    Random random(7);
    const Balls balls = scattered_balls(random, 200, 2.0, 0.2, 0.6);
    const MedialAxis axis = medial_axis(balls);
    for (const double scale : {0x1p-30, 0x1p40}) {
        MedialAxis scaled = medial_axis(moved(balls, scale, {}));
        for (Point& p : scaled.complex.vertices) {
            p = (1.0 / scale) * p;
        }
        for (Point& p : scaled.complex.boundary_vertices) {
            p = (1.0 / scale) * p;
        }
        for (double& radius : scaled.complex.radii) {
            radius /= scale;
        }
        EXPECT_TRUE(same_bytes(axis.complex, scaled.complex)) << scale;
    }
}

TEST(MedialAxis, TurnsAndMovesWithTheBalls) {
    Random random(8);
    const Balls balls = scattered_balls(random, 100, 1.5, 0.2, 0.6);
    Balls turned = balls;
    Similarity motion = turn(0.7);
    motion.translation = {10.0, -20.0, 30.0};
    for (Ball& ball : turned) {
        ball.center = motion(ball.center);
    }
    const MedialAxis a = axis_as_given(balls);
    const MedialAxis b = axis_as_given(turned);
    EXPECT_EQ(a.complex.boundary_vertex_balls.size(), b.complex.boundary_vertex_balls.size());
    EXPECT_EQ(a.complex.faces.size(), b.complex.faces.size());
    EXPECT_EQ(a.complex.edges.size(), b.complex.edges.size());
    EXPECT_EQ(a.complex.sheets, b.complex.sheets);
    EXPECT_EQ(a.statistics.medial_complex, b.statistics.medial_complex);
    for (const Point& p : a.complex.vertices) {
        EXPECT_LT(distance_to(b.complex, motion(p)), 1e-8);
    }
}

// Coordinates of 1e6 have ten digits less behind the point than the vertices need to be told apart.
TEST(MedialAxis, IsAsGoodFarFromTheOrigin) {
    Random random(12);
    const Balls balls = balls_through_points(random, 2000, 200);
    const Point far{1e6, -1e6, 1e6};
    const MedialAxis a = medial_axis(balls);
    const MedialAxis b = medial_axis(moved(balls, 1.0, far));
    EXPECT_EQ(a.statistics.retries, 0);
    EXPECT_EQ(b.statistics.retries, 0);
    EXPECT_EQ(a.statistics.medial_complex, b.statistics.medial_complex);
    EXPECT_NEAR(a.statistics.boundary_vertices, b.statistics.boundary_vertices, 0.01 * a.statistics.boundary_vertices);
    EXPECT_NEAR(a.statistics.faces, b.statistics.faces, 0.01 * a.statistics.faces);
}

TEST(MedialAxis, DoesNotDependOnTheOrderOfTheBalls) {
    Random random(9);
    const Balls balls = scattered_balls(random, 100, 1.5, 0.2, 0.6);
    const MedialAxis a = axis_as_given(balls);
    const MedialAxis b = axis_as_given(Balls(balls.rbegin(), balls.rend()));
    const auto sorted = [](std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return values;
    };
    ASSERT_EQ(a.complex.vertices.size(), b.complex.vertices.size());
    EXPECT_EQ(a.complex.edges.size(), b.complex.edges.size());
    EXPECT_EQ(a.complex.faces.size(), b.complex.faces.size());
    const std::vector<double> radii_a = sorted(a.complex.radii);
    const std::vector<double> radii_b = sorted(b.complex.radii);
    for (std::size_t i = 0; i < radii_a.size(); ++i) {
        EXPECT_NEAR(radii_a[i], radii_b[i], 1e-9);
    }
}

TEST(MedialAxis, IsTheSameForAnyNumberOfThreads) {
    Random random(10);
    const Balls balls = scattered_balls(random, 3000, 4.0, 0.2, 0.5);
    const MedialAxis first = medial_axis(balls, {}, {.threads = 1});
    ASSERT_GT(first.statistics.cells, 4 * 4096) << "too small to be shared among threads";
    for (const int threads : {1, 2, 4, 0}) {
        const MedialAxis again = medial_axis(balls, {}, {.threads = threads});
        EXPECT_TRUE(same_bytes(first.complex, again.complex)) << threads << " threads";
        EXPECT_TRUE(same_bytes(Balls(first.ball_union.balls().begin(), first.ball_union.balls().end()),
                               Balls(again.ball_union.balls().begin(), again.ball_union.balls().end())))
            << threads << " threads";
    }
}

TEST(MedialAxis, CountsWhatItMade) {
    Random random(11);
    const MedialAxis axis = medial_axis(scattered_balls(random, 200, 1.5, 0.2, 0.6));
    const MedialAxisStatistics& s = axis.statistics;
    EXPECT_EQ(s.balls, 200);
    EXPECT_GT(s.hidden_balls, 0);
    EXPECT_EQ(s.dual_vertices - s.dual_edges + s.dual_triangles - s.dual_tetrahedra, s.dual_complex.euler);
    EXPECT_EQ(s.boundary_vertices, static_cast<Index>(axis.complex.boundary_vertices.size()));
    EXPECT_EQ(s.vertices, static_cast<Index>(axis.complex.vertices.size()));
    EXPECT_EQ(s.edges, static_cast<Index>(axis.complex.edges.size()));
    EXPECT_EQ(s.faces, static_cast<Index>(axis.complex.faces.size()));
    EXPECT_EQ(s.medial_complex.euler, s.vertices - s.edges + s.faces);
    EXPECT_EQ(s.perturbation, MedialAxisOptions().perturbation);
    EXPECT_GE(s.cells, s.inside_cells);
}

// Options and callbacks.

TEST(MedialAxis, RejectsWhatItCannotTake) {
    const Balls balls = chain_of_balls(3, 1.0, 0.8);
    EXPECT_THROW(medial_axis(Balls{}), UnusableInput);
    for (const double perturbation : {-1e-9, 0.011, std::nan(""), HUGE_VAL}) {
        EXPECT_THROW(medial_axis(balls, {.perturbation = perturbation}), InvalidOption) << perturbation;
    }
    EXPECT_NO_THROW(medial_axis(balls, {.perturbation = 0.01}));
}

TEST(MedialAxis, ReportsProgressThatNeverDecreases) {
    // Some of these inputs need a second attempt.
    int retries = 0;
    const std::thread::id caller = std::this_thread::get_id();
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        std::vector<double> fractions;
        const Execution execution{.threads = 2, .progress = [&](std::string_view, double fraction) {
                                      EXPECT_EQ(std::this_thread::get_id(), caller);
                                      fractions.push_back(fraction);
                                      return true;
                                  }};
        Random random(seed);
        const Balls balls = balls_through_points(random, 20, 10);
        retries += medial_axis(balls, {.perturbation = 0.0}, execution).statistics.retries;
        ASSERT_GE(fractions.size(), 3U);
        EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end())) << testing::PrintToString(fractions);
        EXPECT_EQ(fractions.front(), 0.0);
        EXPECT_EQ(fractions.back(), 1.0);
    }
    EXPECT_GT(retries, 0);
}

TEST(MedialAxis, StopsWhenItIsTold) {
    const Balls balls = chain_of_balls(10, 1.0, 0.8);
    for (int calls = 0; calls < 3; ++calls) {
        int left = calls;
        EXPECT_THROW(medial_axis(balls, {}, {.progress = [&](std::string_view, double) { return left-- > 0; }}),
                     Cancelled);
    }
}

// The topology of complexes that no union of balls has.

TEST(Topology, OfSurfacesAndGraphs) {
    const std::vector<Point> points(12);
    const auto expect_topology = [&](int vertices, const std::vector<std::vector<Index>>& faces,
                                     const std::vector<std::array<Index, 2>>& curves, const Topology& expected) {
        const std::vector<Point> used(points.begin(), points.begin() + vertices);
        const MedialComplex complex = complex_by_hand(used, faces, {}, curves);
        EXPECT_EQ(topology(complex), expected);
        EXPECT_EQ(homology(complex), expected);
    };
    const std::vector<std::vector<Index>> tetrahedron{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    expect_topology(3, {}, {}, known_topology(3, 0, 0));
    expect_topology(4, {}, {{0, 1}, {1, 2}, {2, 0}, {0, 3}}, known_topology(1, 1, 0));
    expect_topology(4, {{0, 1, 2, 3}}, {}, known_topology(1, 0, 0));
    expect_topology(4, tetrahedron, {}, known_topology(1, 0, 1));
    expect_topology(6, tetrahedron, {{4, 5}}, known_topology(2, 0, 1));
    // A Möbius strip of five triangles.
    expect_topology(5, {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}}, {}, known_topology(1, 1, 0));
    // Two tetrahedra that share a face: two voids; one more corner beyond an edge of it, as a fin.
    std::vector<std::vector<Index>> chambers = tetrahedron;
    chambers.insert(chambers.end(), {{0, 1, 4}, {1, 2, 4}, {2, 0, 4}});
    expect_topology(5, chambers, {}, known_topology(1, 0, 2));
    chambers.push_back({0, 1, 5});
    expect_topology(6, chambers, {{5, 4}}, known_topology(1, 1, 2));
    // Two that share a vertex, and two that share an edge.
    std::vector<std::vector<Index>> at_vertex = tetrahedron;
    at_vertex.insert(at_vertex.end(), {{0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {5, 6, 0}});
    expect_topology(7, at_vertex, {}, known_topology(1, 0, 2));
    std::vector<std::vector<Index>> at_edge = tetrahedron;
    at_edge.insert(at_edge.end(), {{0, 1, 4}, {0, 5, 1}, {1, 5, 4}, {4, 5, 0}});
    expect_topology(6, at_edge, {}, known_topology(1, 0, 2));
}

TEST(Sheets, EndAtSeams) {
    // Three squares around an edge, of two triangles each.
    const MedialComplex complex =
        complex_by_hand({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {-1, 1, 0}, {-1, 1, 1}, {-1, -1, 0}, {-1, -1, 1}},
                        {{0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 1}, {0, 6, 7}, {0, 7, 1}});
    EXPECT_EQ(complex.sheets, 3);
    EXPECT_EQ(complex.face_sheets, (std::vector<Index>{0, 0, 1, 1, 2, 2}));
}

}  // namespace
}  // namespace scaleaxis
