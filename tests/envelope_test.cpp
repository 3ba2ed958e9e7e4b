// SPDX-License-Identifier: Apache-2.0
// Envelopes of medial meshes: closed forms and brute force.
#include "scaleaxis/envelope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "axis/envelope_data.hpp"
#include "base/vectors.hpp"
#include "complexes.hpp"
#include "meshes.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/union_mesh.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

/// The least |p - centre| - radius over balls all over the simplex.
double by_brute_force(const Slab& slab, const Point& p, int n) {
    const auto& [a, b, c] = slab.corners;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= (slab.size > 1 ? n : 0); ++i) {
        for (int k = 0; k <= (slab.size > 2 ? n - i : 0); ++k) {
            const double t = static_cast<double>(i) / n;
            const double s = static_cast<double>(k) / n;
            Ball ball{a.center + t * (b.center - a.center), a.radius + t * (b.radius - a.radius)};
            if (slab.size > 2) {
                ball = {ball.center + s * (c.center - a.center), ball.radius + s * (c.radius - a.radius)};
            }
            least = std::min(least, distance(ball.center, p) - ball.radius);
        }
    }
    return least;
}

TEST(SlabBall, IsTheBestOfAllBallsOfTheSimplex) {
    constexpr std::uint64_t kSeed = 71;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (int i = 0; i < 600; ++i) {
        std::array<Ball, 3> balls;
        for (Ball& ball : balls) {
            ball = {random_point(random, 1.0), uniform(random, 0.0, i % 3 == 0 ? 2.0 : 0.4)};  // often one in another
        }
        if (i % 5 == 0) {
            balls[2].center = midpoint(balls[0].center, balls[1].center);  // in a line
        }
        if (i % 7 == 0) {
            balls[1].radius = balls[2].radius = balls[0].radius;
        }
        if (i % 11 == 0) {
            balls[1].center = balls[0].center;
        }
        if (i % 13 == 0) {
            balls[1] = balls[2] = balls[0];
        }
        const Slab slab(std::span<const Ball>(balls).first(1 + i % 3));
        for (int k = 0; k < 10; ++k) {
            const Point p = random_point(random, 2.0);
            const auto [ball, distance_to_ball] = nearest_ball(slab, p);
            EXPECT_NEAR(distance(ball.center, p) - ball.radius, distance_to_ball, 1e-12);
            const double expected = by_brute_force(slab, p, 120);
            EXPECT_LE(distance_to_ball, expected + 1e-9) << "slab " << i;
            EXPECT_GE(distance_to_ball, expected - 0.03) << "slab " << i;  // half a step of the brute force
            EXPECT_LE(least_distance_bound(slab, p), distance_to_ball + 1e-12) << "slab " << i;
        }
        const Point corner = slab.corners[0].center;
        EXPECT_LE(least_distance_bound(slab, corner), nearest_ball(slab, corner).distance + 1e-12) << "slab " << i;
    }
}

TEST(SlabBall, HasACloseBoundFarAway) {
    const Slab slab(std::array<Ball, 3>{Ball{{0, 0, 0}, 1.0}, Ball{{0.1, 0, 0}, 1.02}, Ball{{0, 0.1, 0}, 0.98}});
    for (const Point& p : {Point{2, 1, 0.5}, Point{-1, 0.3, 2}, Point{0, 0, 0.9}, Point{0.3, 0.2, -0.5}}) {
        EXPECT_NEAR(least_distance_bound(slab, p), nearest_ball(slab, p).distance, 0.01);
    }
}

TEST(SlabTree, FindsWhatBruteForceFinds) {
    constexpr std::uint64_t kSeed = 72;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (const int count : {1, 7, 500}) {
        std::vector<Slab> slabs;
        for (int i = 0; i < count; ++i) {
            const Point center = random_point(random, 1.0);
            std::array<Ball, 3> balls;
            for (Ball& ball : balls) {
                ball = {center + random_point(random, 0.2), uniform(random, 0.0, 0.3)};
            }
            slabs.emplace_back(std::span<const Ball>(balls).first(1 + i % 3));
        }
        const SlabTree tree = build_slab_tree(slabs);
        for (int i = 0; i < 300; ++i) {
            const Point p = random_point(random, i % 10 == 0 ? 50.0 : 1.5);
            double least = std::numeric_limits<double>::infinity();
            for (const Slab& slab : slabs) {
                least = std::min(least, nearest_ball(slab, p).distance);
            }
            const NearestSlab nearest = nearest_slab(tree, p);
            EXPECT_EQ(nearest.near.distance, least);
            EXPECT_EQ(nearest_ball(slabs[nearest.slab], p).distance, least);
            EXPECT_EQ(nearest_slab(tree, p, least).slab, kNone) << "nothing is nearer than the limit";
            const FramedPoint framed(tree, p);
            for (std::size_t k = 0; k < slabs.size(); ++k) {
                const float bound = tree.blocks[k / SlabBlock::kSize].least_distances(framed.at)[k % SlabBlock::kSize];
                const double exact = tree.scale * nearest_ball(tree.slabs[k], p).distance;
                EXPECT_LE(bound - framed.slack, exact) << "slab " << k;
                if (exact > 5.0 * tree.scale) {
                    EXPECT_GE(bound, exact - 0.02 * tree.scale) << "slab " << k << ": close to it far away";
                }
            }
            for (const double reach : {0.0, 0.1}) {
                EXPECT_TRUE(slab_within(tree, p, least + 1e-12, reach));
                EXPECT_FALSE(slab_within(tree, p, least - 1e-9, reach));
            }
        }
    }
}

MedialComplex capsule(double length, double radius) {
    return with_linear_radii(complex_by_hand({{0, 0, 0}, {length, 0, 0}}, {}, {}, {{0, 1}}),
                             [=](const Point&) { return radius; });
}

TEST(Envelope, OfACapsuleHasItsDistances) {
    constexpr std::uint64_t kSeed = 73;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    const Envelope envelope(capsule(2.0, 0.5));
    std::vector<Point> points;
    for (int i = 0; i < 200; ++i) {
        points.push_back(random_point(random, 3.0));
    }
    const std::vector<double> distances = envelope.signed_distances(points);
    const std::vector<std::uint8_t> inside = envelope.inside(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double expected = distance_to_segment(points[i], {0, 0, 0}, {2, 0, 0}) - 0.5;
        EXPECT_NEAR(distances[i], expected, 1e-14);
        EXPECT_EQ(inside[i] != 0, expected <= 0.0);
    }
    EXPECT_EQ(envelope.bounds().min, (Point{-0.5, -0.5, -0.5}));
    EXPECT_EQ(envelope.bounds().max, (Point{2.5, 0.5, 0.5}));
    EXPECT_EQ(envelope.topology().euler, 1);
}

/// A cross of two plates, with a seam: re-entrant edges all along it.
MedialComplex cross_of_plates() {
    const std::vector<Point> vertices{{0, 0, 0},  {0, 0, 2},  {1, 0, 0}, {1, 0, 2},
                                      {-1, 0, 0}, {-1, 0, 2}, {0, 1, 0}, {0, 1, 2}};
    return with_linear_radii(complex_by_hand(vertices, {{0, 1, 3, 2}, {0, 1, 5, 4}, {0, 1, 7, 6}}),
                             [](const Point&) { return 0.2; });
}

TEST(Envelope, BoundaryPointsLieOnItAndCoverIt) {
    constexpr std::uint64_t kSeed = 74;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (const MedialComplex& complex : {capsule(2.0, 0.5), cross_of_plates()}) {
        const Envelope envelope(complex);
        const EnvelopeData& data = envelope.data();
        constexpr double kSpacing = 0.05;
        const std::vector<SurfacePoint> points = data.boundary_points(kSpacing);
        double area = 0.0;
        for (const SurfacePoint& p : points) {
            EXPECT_NEAR(data.signed_distance(p.point), 0.0, 1e-8);
            area += p.area;
        }
        if (complex.faces.empty()) {
            EXPECT_NEAR(area, 2.0 * std::numbers::pi * 0.5 * (2.0 + 2.0 * 0.5), 0.01 * area);
        }
        // Of random points on the boundary, found from outside, every one has a point within the spacing.
        for (int i = 0; i < 300; ++i) {
            Point p = random_point(random, 4.0);
            const NearestSlab nearest = nearest_slab(data.tree(), p);
            if (nearest.near.distance < 0.0) {
                continue;
            }
            p = nearest.near.ball.center + nearest.near.ball.radius * unit(p - nearest.near.ball.center);
            double least = std::numeric_limits<double>::infinity();
            for (const SurfacePoint& q : points) {
                least = std::min(least, distance(p, q.point));
            }
            EXPECT_LE(least, kSpacing);
        }
    }
}

/// Triangles, edges and vertices at random, some with balls that hold others, some of radius 0.
MedialComplex random_complex(Random& random) {
    std::vector<Point> vertices;
    for (int i = 0; i < 14; ++i) {
        vertices.push_back(random_point(random, 1.0));
    }
    MedialComplex complex = complex_by_hand(vertices, {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {4, 5, 6}}, {},
                                            {{{6, 7}}, {{7, 8}}, {{7, 9}}, {{10, 11}}});
    for (double& radius : complex.radii) {
        radius = std::max(uniform(random, -0.1, 0.5), 0.0);
    }
    complex.radii[11] = distance(vertices[10], vertices[11]) + complex.radii[10] + 0.01;  // one ball holds the other
    return linear(complex);
}

TEST(EnvelopeSolid, FindsTheFirstOrTheLastPlaceWhereASegmentLeaves) {
    constexpr std::uint64_t kSeed = 75;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    constexpr int kSteps = 2000;
    int several = 0;
    for (int round = 0; round < 60; ++round) {
        const MedialComplex complex = round == 0 ? cross_of_plates() : random_complex(random);
        const Envelope envelope(complex);
        const auto solid = envelope_solid(envelope);
        for (int i = 0; i < 60; ++i) {
            const Point inside_end = random_point(random, 1.2);
            const Point outside_end = random_point(random, 3.0);
            const Point reference = random_point(random, 2.0);
            const double before = envelope.data().signed_distance(inside_end);
            EXPECT_EQ(solid->inside(inside_end), before <= 0.0);
            const auto found = solid->crossing(inside_end, outside_end, reference);
            if (before > 0.0 || envelope.data().signed_distance(outside_end) <= 0.0) {
                EXPECT_FALSE(found);
                continue;
            }
            const auto at = [&](double t) { return inside_end + t * (outside_end - inside_end); };
            std::vector<double> exits;
            double last = before;
            for (int k = 1; k <= kSteps; ++k) {
                const double next = envelope.data().signed_distance(at(1.0 * k / kSteps));
                if (last <= 0.0 && next > 0.0) {
                    exits.push_back((k - 0.5) / kSteps);
                }
                last = next;
            }
            several += exits.size() > 1 ? 1 : 0;
            ASSERT_TRUE(found) << "round " << round << ", segment " << i;
            EXPECT_NEAR(envelope.data().signed_distance(*found), 0.0, 1e-8);
            const double farthest =
                std::max(distance(at(exits.front()), reference), distance(at(exits.back()), reference));
            const double step = distance(inside_end, outside_end) / kSteps;
            EXPECT_NEAR(distance(*found, reference), farthest, step) << "round " << round << ", segment " << i;
        }
    }
    EXPECT_GT(several, 30);
}

TEST(EnvelopeSolid, SeedsLieOnItAndCoverIt) {
    const Envelope envelope(cross_of_plates());
    const auto solid = envelope_solid(envelope);
    const std::vector<Point> seeds = solid->seeds(0.1, 1, {});
    for (const Point& seed : seeds) {
        EXPECT_NEAR(envelope.data().signed_distance(seed), 0.0, 1e-8);
    }
    for (const SurfacePoint& p : envelope.data().boundary_points(0.02)) {
        EXPECT_LE(std::ranges::min(each_of<double>(seeds, [&](const Point& q) { return distance(p.point, q); })), 0.1);
    }
    EXPECT_THROW(solid->seeds(1e-7, 1, {}), InvalidOption);
}

TEST(EnvelopeSolid, OfBallsWithoutRadiusIsRefused) {
    EXPECT_THROW(envelope_solid(Envelope(capsule(1.0, 0.0))), UnusableInput);
    EXPECT_THROW(envelope_solid(Envelope(capsule(1.0, 0.1)), -1.0), InvalidOption);
}

TEST(EnvelopeSolid, KnowsNearestPoints) {
    const auto solid = envelope_solid(Envelope(capsule(2.0, 0.5)), 0.05);
    for (const Point& p : {Point{1.0, 0.3, 0.0}, Point{1.2, 0.0, -0.9}, Point{-0.8, 0.1, 0.0}}) {
        const auto nearest = solid->nearest(p);
        ASSERT_TRUE(nearest);
        EXPECT_NEAR(distance(p, *nearest), std::abs(distance_to_segment(p, {0, 0, 0}, {2, 0, 0}) - 0.5), 1e-6);
    }
}

MedialComplex exact_axis_of_box(const Point& size) {
    return linear(axis_of_box(size, [&](const Point& p) {
        return std::min({p.x, p.y, p.z, size.x - p.x, size.y - p.y, size.z - p.z});
    }));
}

TEST(Envelope, OfTheAxisOfABoxIsTheBox) {
    const Point size{3.0, 2.0, 1.0};
    const Envelope envelope(exact_axis_of_box(size));
    const SurfaceDistance distance =
        surface_distance(envelope, box_mesh({0, 0, 0}, size), {.spacing = 0.05, .accuracy = 0.01});
    EXPECT_LT(distance.max(), 1e-12);
    EXPECT_GT(distance.a_to_b.samples, 1000);
    // A box that is larger by 0.1 on one side: that is how far its side is.
    const SurfaceDistance other =
        surface_distance(envelope, box_mesh({0, 0, 0}, {3.1, 2.0, 1.0}), {.spacing = 0.05, .accuracy = 0.01});
    EXPECT_NEAR(other.b_to_a.max, 0.1, 1e-9);
    EXPECT_NEAR(other.a_to_b.max, 0.1, 1e-9);
}

TEST(Envelope, MeshOfTheAxisOfABoxIsTheBox) {
    const Point size{3.0, 2.0, 1.0};
    const Envelope envelope(exact_axis_of_box(size));
    EXPECT_EQ(envelope.data().creases().size(), 12);
    for (const double delta : {0.02, 0.1}) {
        const UnionMesh mesh = envelope_mesh(envelope, {.delta = Length::relative(delta)});
        EXPECT_EQ(mesh.report.euler, 2);
        EXPECT_NEAR(mesh.report.volume, 6.0, 1e-6);
        EXPECT_NEAR(mesh.report.area, 22.0, 1e-6);
    }
}

TEST(Envelope, MeshFollowsSharpEdgesOfTenTolerances) {
    const Envelope cube(exact_axis_of_box({1.0, 1.0, 1.0}));  // edges of 12 in all
    EXPECT_NEAR(envelope_mesh(cube, {.delta = Length::absolute(1.19)}).report.volume, 1.0, 1e-9);
    EXPECT_LT(envelope_mesh(cube, {.delta = Length::absolute(1.21)}).report.volume, 0.99);
}

TEST(Envelope, HasNoCreaseWhereAnotherBallCoversIt) {
    // The plate ends in an edge of radius 0, in part within a ball.
    MedialComplex plate =
        complex_by_hand({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {0, 0, 0.1}},
                        {{0, 1, 4, 3}, {1, 2, 5, 4}}, {});
    plate.radii = {0.0, 0.0, 0.0, 0.3, 0.3, 0.3, 0.2};
    const auto creases = Envelope(linear(plate)).data().creases();
    ASSERT_EQ(creases.size(), 1);  // the half whose ends are not covered
    EXPECT_TRUE(std::ranges::all_of(creases, [](const auto& c) { return c.ends[0].x >= 1.0 && c.ends[1].x >= 1.0; }));
}

TEST(Envelope, MeshOfAWedgeIsOneWhateverItsAngle) {
    // Half a sheet, whose radii grow from an edge on; its back and its ends are round.
    for (const double angle : {10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 120.0}) {
        SCOPED_TRACE(angle);
        const double sine = std::sin(0.5 * angle * std::numbers::pi / 180.0);
        const Envelope wedge(
            with_linear_radii(complex_by_hand({{0, 0, 0}, {2, 0, 0}, {2, 0, 3}, {0, 0, 3}}, {{0, 1, 2, 3}}),
                              [&](const Point& p) { return sine * p.x; }));
        ASSERT_EQ(wedge.data().creases().size(), 1);
        EXPECT_NEAR(wedge.data().creases()[0].sine, sine, 1e-12);
        const UnionMesh mesh = envelope_mesh(wedge, {.delta = Length::absolute(0.06)});
        EXPECT_EQ(mesh.tolerance, 0.06);
        EXPECT_EQ(mesh.report.euler, 2);
        EXPECT_EQ(mesh.report.self_intersections, 0);
        EXPECT_TRUE(mesh.warnings.empty());
    }
}

TEST(Envelope, MeshOfAPlateThinnerThanTheToleranceIsThere) {
    for (const double thickness : {0.02, 0.03, 0.05, 0.2}) {
        SCOPED_TRACE(thickness);
        const Point size{3.0, 2.0, thickness};
        const Envelope plate(exact_axis_of_box(size));
        const UnionMesh mesh = envelope_mesh(plate, {.delta = Length::absolute(0.06)});
        EXPECT_NEAR(mesh.report.volume, 6.0 * thickness, 0.02 * 6.0 * thickness);
        // Half as thick as the tolerance takes half the tolerance; what is far thinner gets holes, and says so.
        EXPECT_EQ(mesh.report.euler == 2, mesh.warnings.empty());
        EXPECT_EQ(mesh.report.euler == 2, thickness >= 0.03);
        EXPECT_EQ(mesh.tolerance, thickness == 0.03 ? 0.03 : 0.06);
    }
}

TEST(Envelope, DistanceFromWithinToAReentrantEdgeIsThatOfTheEdge) {
    // The boundary nearest to the seam of the cross is in the edges between its plates, which no ball touches.
    const Envelope envelope(cross_of_plates());
    const Point at_seam{0.0, 0.05, 1.0};
    TriangleMesh point_like;  // a tiny triangle there
    point_like.vertices = {at_seam, at_seam + Point{1e-9, 0, 0}, at_seam + Point{0, 1e-9, 0}};
    point_like.triangles = {{0, 1, 2}};
    constexpr double kSpacing = 0.01;
    const OneSidedDistance side = surface_distance(point_like, envelope, {.spacing = kSpacing, .accuracy = 0.1}).a_to_b;
    // Half-planes y = 0 and x = 0, y > 0 thickened by 0.2: below, the flat side is at -0.2; above, edges at (±0.2,
    // 0.2).
    const double expected = std::min(0.25, std::hypot(0.2, 0.15));
    EXPECT_LE(side.max, expected + 1e-9);
    EXPECT_GE(side.max, expected - kSpacing);
}

TEST(Envelope, MeshOfACapsuleIsWithinTheTolerance) {
    const Envelope envelope(capsule(2.0, 0.5));
    const double tolerance = 0.05;
    const UnionMesh mesh = envelope_mesh(envelope, {.delta = Length::absolute(tolerance)});
    EXPECT_EQ(mesh.report.euler, 2);
    EXPECT_TRUE(mesh.warnings.empty());
    EXPECT_EQ(mesh.solid->euler, 1);
    EXPECT_LT(surface_distance(mesh.boundary.mesh, envelope, {.spacing = 0.02, .accuracy = 0.001}).max(), tolerance);
}

TEST(Envelope, FieldIsTheSignedDistance) {
    const Envelope envelope(cross_of_plates());
    const Image image = signed_distance_image(envelope, 24);
    Index i = 0;
    for (int z = 0; z < image.sizes[2]; ++z) {
        for (int y = 0; y < image.sizes[1]; ++y) {
            for (int x = 0; x < image.sizes[0]; ++x, ++i) {
                const Point p = image.origin + image.steps[0].x * Point{1.0 * x, 1.0 * y, 1.0 * z};
                ASSERT_FLOAT_EQ(image.values[i], static_cast<float>(envelope.data().signed_distance(p)));
            }
        }
    }
}

TEST(Envelope, OfNothingIsRefused) {
    EXPECT_THROW(Envelope{MedialComplex()}, UnusableInput);
    MedialComplex broken = capsule(1.0, 0.1);
    broken.radii[0] = -1.0;
    EXPECT_THROW(Envelope{broken}, UnusableInput);
}

}  // namespace
}  // namespace scaleaxis
