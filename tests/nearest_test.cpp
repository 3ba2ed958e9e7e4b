// SPDX-License-Identifier: Apache-2.0
// The points of a solid's boundary that are nearest: closed forms and brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "balls/exposed.hpp"
#include "balls/union/union_data.hpp"
#include "images.hpp"
#include "meshes.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/nearest.hpp"
#include "solids.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/point_tree.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Random announced(std::uint64_t seed) {
    std::cout << "seed " << seed << '\n';
    return Random(seed);
}

/// A point of a triangle from random numbers.
Point random_point_of(const TriangleMesh& mesh, const std::array<Index, 3>& triangle, Random& random) {
    double x = uniform(random, 0.0, 1.0), y = uniform(random, 0.0, 1.0);
    if (x + y > 1.0) {
        x = 1.0 - x;
        y = 1.0 - y;
    }
    const Point& a = mesh.vertices[triangle[0]];
    return a + x * (mesh.vertices[triangle[1]] - a) + y * (mesh.vertices[triangle[2]] - a);
}

/// As the tree finds it, by trying all triangles in the order of the tree.
NearTriangle by_brute_force(const Bvh& bvh, const Point& p) {
    NearTriangle nearest;
    for (std::size_t t = 0; t < bvh.mesh.triangles.size(); ++t) {
        const auto& [u, v, w] = bvh.mesh.triangles[t];
        const std::vector<Point>& x = bvh.mesh.vertices;
        const Point q = nearest_point(x[u], x[v], x[w], p);
        if (squared_distance(p, q) < nearest.squared_distance) {
            nearest = {static_cast<Index>(t), q, squared_distance(p, q)};
        }
    }
    return nearest;
}

/// Triangles of all sizes and shapes, slivers and points among them.
TriangleMesh random_triangles(Random& random, int count) {
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Point center = random_point(random, 1.0);
        const double size = std::pow(10.0, uniform(random, -4.0, 0.0));
        std::array<Point, 3> t{center, center + random_point(random, size), center + random_point(random, size)};
        const double height = i % 5 == 0 ? std::pow(10.0, uniform(random, -17.0, -1.0)) : 1.0;
        t[2] = t[0] + uniform(random, -1.0, 2.0) * (t[1] - t[0]) + height * (t[2] - t[0]);
        if (i % 31 == 0) {
            t[2] = t[1];
        }
        if (i % 37 == 0) {
            t[1] = t[2] = t[0];
        }
        for (const Point& p : t) {
            mesh.vertices.push_back(p);
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

void expect_same(const NearTriangle& a, const NearTriangle& b) {
    EXPECT_EQ(a.triangle, b.triangle);
    EXPECT_EQ(a.point, b.point);
    EXPECT_EQ(a.squared_distance, b.squared_distance);
}

TEST(Nearest, OfAMeshIsThatOfAllItsTrianglesInTheOrderOfThePoints) {
    Random random = announced(31);
    const TriangleMesh mesh = random_triangles(random, 300);
    std::vector<Point> points;
    for (int i = 0; i < 3000; ++i) {
        points.push_back(random_point(random, i % 10 == 0 ? 100.0 : 1.5));
    }
    const NearestOnMesh found = nearest(mesh, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto distance_to = [&](const std::array<Index, 3>& t) {
            return distance(points[i],
                            nearest_point(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], points[i]));
        };
        std::vector<double> distances;
        std::ranges::transform(mesh.triangles, std::back_inserter(distances), distance_to);
        ASSERT_EQ(found.distances[i], std::ranges::min(distances));
        ASSERT_EQ(distances[found.triangles[i]], found.distances[i]);
        ASSERT_EQ(distance(points[i], found.points[i]), found.distances[i]);
    }
    const NearestOnMesh alone = nearest(mesh, points, {.threads = 1});
    EXPECT_EQ(alone.triangles, found.triangles);
    EXPECT_EQ(alone.points, found.points);
    EXPECT_THROW(nearest({}, points), UnusableInput);
    EXPECT_THROW(nearest(mesh, std::vector<Point>{{kInfinity, 0, 0}}), UnusableInput);
    EXPECT_TRUE(nearest(mesh, {}).points.empty());
}

TEST(NearestTriangle, TreeFindsWhatBruteForceFinds) {
    Random random = announced(61);
    for (const TriangleMesh& mesh :
         {random_triangles(random, 1), random_triangles(random, 7), random_triangles(random, 2000),
          torus_mesh(1.0, 0.4, 24), ball_mesh(1.0, 20), box_mesh({-1.0, -0.7, -0.4}, {1.0, 0.7, 0.4}, 2)}) {
        const Bvh bvh = build_bvh(mesh);
        const TriangleBounds bounds = triangle_bounds(bvh);
        for (int i = 0; i < 1000; ++i) {
            Point p = random_point(random, i % 5 == 0 ? 100.0 : 1.5);
            if (i % 7 == 0) {  // many are equally near
                p = {0.0, 0.0, i % 14 == 0 ? p.z : 0.0};
            }
            const NearTriangle truth = by_brute_force(bvh, p);
            const double distance = std::sqrt(truth.squared_distance);
            expect_same(nearest_triangle(bvh, bounds, p), truth);
            expect_same(nearest_triangle(bvh, bounds, p, distance * (1.0 + 1e-12) + 1e-300), truth);
            EXPECT_EQ(nearest_triangle(bvh, bounds, p, distance * (1.0 - 1e-12)).triangle, kNone);
        }
    }
}

TEST(NearestTriangle, TrianglesThatDoNotCountAreNeverLookedAt) {
    Random random = announced(71);
    for (const int part : {1, 2, 40}) {
        const Bvh bvh = build_bvh(random_triangles(random, 2000));
        // Every other one, and those of whole branches of the tree.
        std::vector<std::uint8_t> counts(2000);
        for (int t = 0; t < 2000; ++t) {
            counts[t] = t / part % 2 == 0 || t > 1500 ? 0 : 1;
        }
        const TriangleBounds bounds = triangle_bounds(bvh, counts);
        for (int i = 0; i < 1000; ++i) {
            const Point p = random_point(random, i % 5 == 0 ? 1e20 : 1.5);
            NearTriangle truth;
            for (Index t = 0; t < 2000; ++t) {
                const auto& [u, v, w] = bvh.mesh.triangles[t];
                const Point q = nearest_point(bvh.mesh.vertices[u], bvh.mesh.vertices[v], bvh.mesh.vertices[w], p);
                if (counts[t] != 0 && squared_distance(p, q) < truth.squared_distance) {
                    truth = {t, q, squared_distance(p, q)};
                }
            }
            expect_same(nearest_triangle(bvh, bounds, p, kInfinity,
                                         [&](Index t, const Point&) {
                                             EXPECT_NE(counts[t], 0);
                                             return true;
                                         }),
                        truth);
        }
    }
}

TEST(Trees, AnswerFromPlacesWhoseSquaresExceedSinglePrecision) {
    Random random = announced(67);
    const Bvh bvh = build_bvh(random_triangles(random, 200));
    const TriangleBounds bounds = triangle_bounds(bvh);
    const PointTree points = build_point_tree(bvh.mesh.vertices);
    const BallUnion balls(grid_of_balls(3, 3, 3, 0.6));
    for (const double far : {1e10, 1e18, 1e20, 1e38, 1e100}) {
        const Point p{0.3, far, -far};
        const NearTriangle truth = by_brute_force(bvh, p);
        EXPECT_EQ(nearest_triangle(bvh, bounds, p).squared_distance, truth.squared_distance);
        std::vector<NearPoint> near;
        nearest_points(points, p, 9, near);
        EXPECT_EQ(near.size(), 9u);
        EXPECT_EQ(near.front().squared_distance, nearest_point(points, p).squared_distance);
        EXPECT_NEAR(balls.signed_distances(std::vector{p})[0] / (far * std::sqrt(2.0)), 1.0, 1e-8);
    }
}

/// Do `nearest` and its bounds agree with each other?
void expect_consistent(const Solid& solid, const std::vector<Point>& points) {
    ASSERT_TRUE(solid.knows_nearest());
    std::vector<double> bounds(points.size(), kInfinity);
    std::vector<std::optional<Point>> nearest(points.size());
    solid.nearest(points, bounds, nearest);
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_TRUE(nearest[i]);
        EXPECT_EQ(solid.nearest(points[i]), nearest[i]);
        const double length = distance(points[i], *nearest[i]);
        const auto within = solid.nearest(points[i], length * 1.001);
        ASSERT_EQ(within.has_value(), length > 0.0);
        if (within) {
            EXPECT_NEAR(distance(*within, points[i]), length, 1e-9 * length);
        }
        EXPECT_FALSE(solid.nearest(points[i], length * 0.999));
        EXPECT_FALSE(solid.nearest(points[i], 0.0));
    }
}

TEST(Nearest, OfPointsFarFromTheOriginIsFoundWhateverCameBefore) {
    Random random = announced(7);
    for (const double offset : {1e3, 1e4, 1e5, 1e6, 1e7}) {
        SCOPED_TRACE(offset);
        TriangleMesh mesh = torus_mesh(1.0, 0.4, 24, 16);
        for (Point& p : mesh.vertices) {
            p = p + offset * Point{1.0, 0.7, -0.3};
        }
        const std::unique_ptr<Solid> solid = mesh_solid(mesh);
        std::vector<Point> points;
        for (const std::array<Index, 3>& triangle : mesh.triangles) {
            const Point p = random_point_of(mesh, triangle, random);
            points.insert(points.end(), {p, *solid->nearest(p)});
        }
        std::vector<std::optional<Point>> nearest(points.size());
        solid->nearest(points, std::vector<double>(points.size(), kInfinity), nearest);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(nearest[i], solid->nearest(points[i]));
        }
    }
}

TEST(Nearest, PointsThatFollowEachOtherHaveTheAnswersOfEachAlone) {
    const std::unique_ptr<Solid> solid = mesh_solid(torus_mesh(1.0, 0.4, 24, 16));
    std::vector<Point> points;
    for (int i = 0; i <= 400; ++i) {
        const Point p{-2.0 + 0.01 * i, 0.001 * i, 0.1};
        points.push_back(p);
        points.push_back(*solid->nearest(p));  // on the boundary: found again at a distance of 0
        points.push_back(p);
    }
    expect_consistent(*solid, points);
}

/// A solid that consists of parts which overlap, touch or hide each other, and points that show where its boundary is.
struct Parts {
    std::string name;
    std::vector<TriangleMesh> parts;
};

TriangleMesh turned(TriangleMesh mesh, double angle, const Point& by, double scale = 1.0) {
    for (Point& p : mesh.vertices) {
        p = scale * p;
        p = {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
        p = {p.x, std::cos(angle) * p.y - std::sin(angle) * p.z, std::sin(angle) * p.y + std::cos(angle) * p.z};
        p = p + by;
    }
    return mesh;
}

TEST(NearestOfAMesh, BoundaryOfPartsIsThatOfTheirUnion) {
    Random random = announced(62);
    const TriangleMesh box = box_mesh({-1, -1, -1}, {1, 1, 1});
    const TriangleMesh fine = box_mesh({-1, -1, -1}, {1, 1, 1}, 3);
    for (const Parts& solid :
         {Parts{"one", {box}}, Parts{"two boxes", {box, turned(box, 0.0, {0.7, 0.6, 0.5})}},
          Parts{"two fine boxes", {fine, turned(fine, 0.0, {0.7, 0.6, 0.5})}},
          Parts{"turned", {fine, turned(fine, 0.4, {0.7, 0.1, 0.3}), turned(box, 1.1, {0.2, -0.8, 0.1})}},
          Parts{"a cross", {box_mesh({-2, -0.5, -0.5}, {2, 0.5, 0.5}), box_mesh({-0.5, -2, -0.4}, {0.5, 2, 0.6})}},
          Parts{"side by side", {box, turned(fine, 0.0, {2.0, 0.0, 0.0})}},
          Parts{"side by side, shifted", {box, turned(fine, 0.0, {2.0, 0.3, 0.1})}},
          Parts{"one in the other", {box, turned(box, 0.0, {}, 0.5)}},
          Parts{"with a cavity", {box, inside_out(turned(box, 0.0, {}, 0.5))}},
          Parts{"balls", {sphere_mesh({}, 1.0, 2), sphere_mesh({0.9, 0.2, 0.1}, 0.8, 2)}},
          Parts{"far away",
                {turned(box, 0.0, {1e6, 2e6, -1e6}), turned(box, 0.0, {1e6 + 0.7, 2e6 + 0.6, -1e6 + 0.5})}}}) {
        SCOPED_TRACE(solid.name);
        const TriangleMesh mesh = together(solid.parts);
        const auto oracle = mesh_solid(mesh);
        const Box bounds = oracle->bounds();
        const double size = bounds.diagonal();
        const auto is_on_boundary = [&](const Point& p, double step) {
            bool is_inside = false, is_outside = false;
            for (int i = 0; i < 60; ++i) {
                const bool side = oracle->inside(p + step * random_direction(random));
                is_inside = is_inside || side;
                is_outside = is_outside || !side;
            }
            return is_inside && is_outside;
        };
        std::vector<Point> boundary;
        for (int i = 0; i < 4000; ++i) {
            const Point p = random_point_of(mesh, mesh.triangles[random() % mesh.triangles.size()], random);
            if (is_on_boundary(p, 1e-5 * size)) {
                boundary.push_back(p);
            }
        }
        std::vector<Point> points;
        for (int i = 0; i < 300; ++i) {
            points.push_back(midpoint(bounds.min, bounds.max) + random_point(random, 0.4 * size));
        }
        expect_consistent(*oracle, points);
        for (const Point& p : points) {
            const Point q = oracle->nearest(p).value();
            double least = kInfinity;
            for (const Point& x : boundary) {
                least = std::min(least, distance(p, x));
            }
            EXPECT_LE(distance(p, q), least + 3e-5 * size);
            EXPECT_TRUE(is_on_boundary(q, 3e-6 * size));
        }
    }
}

// Solids of known distance.

using Truth = std::function<double(const Point&)>;

double distance_to_ellipsoid(const Point& radii, Point p) {
    // On a plane of symmetry the root may be double: beside it it is not.
    for (double Point::*const axis : {&Point::x, &Point::y, &Point::z}) {
        p.*axis = std::max(std::abs(p.*axis), 1e-9);
    }
    // The foot is at r² x / (r² + t) for the largest root t: found by bisection.
    const auto level = [&](double t) {
        return squared_norm({radii.x * p.x / (radii.x * radii.x + t), radii.y * p.y / (radii.y * radii.y + t),
                             radii.z * p.z / (radii.z * radii.z + t)}) -
               1.0;
    };
    const double smallest = std::min({radii.x, radii.y, radii.z});
    double low = -smallest * smallest;
    double high = norm(p) * std::max({radii.x, radii.y, radii.z}) + 1.0;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (level(middle) > 0.0 ? low : high) = middle;
    }
    const double t = high;
    return norm(
        {p.x * t / (radii.x * radii.x + t), p.y * t / (radii.y * radii.y + t), p.z * t / (radii.z * radii.z + t)});
}

struct Known {
    std::string name;
    ImplicitSolid::Function function;  ///< negative inside; for values of images too
    Truth distance;
    double size;
};

std::vector<Known> known_solids() {
    const auto absolute = [](const ImplicitSolid& solid) -> Truth {
        return [function = solid.function()](const Point& p) { return std::abs(function(p)); };
    };
    std::vector<Known> result;
    const auto add = [&](const std::string& name, const ImplicitSolid& solid, double size) {
        result.push_back({name, solid.function(), absolute(solid), size});
    };
    add("ball", ball_solid(1.0), 1.0);
    add("torus", torus_solid(1.0, 0.4), 1.4);
    add("capsule", capsule_solid(0.4, 0.8), 1.2);
    add("box", box_solid({1.0, 0.7, 0.5}), 1.0);
    const Point radii{1.2, 0.8, 0.6};
    result.push_back({"ellipsoid", ellipsoid_solid(radii.x, radii.y, radii.z).function(),
                      [=](const Point& p) { return distance_to_ellipsoid(radii, p); }, 1.2});
    return result;
}

/// Inside and outside, in the centre and on axes.
std::vector<Point> questions(Random& random, double size, int count) {
    std::vector<Point> points{{}, {0, 0, 0.1}, {0.2, 0, 0}, {0, -0.3, 0}};
    for (int i = 0; i < count; ++i) {
        points.push_back(random_point(random, 1.3 * size));
    }
    return points;
}

/// How far the nearest points are from where they should be: in their distance, and from the surface.
double worst_error(const Solid& solid, const std::vector<Point>& points, const Truth& truth) {
    double worst = 0.0;
    for (const Point& p : points) {
        const std::optional<Point> q = solid.nearest(p);
        EXPECT_TRUE(q);
        if (q) {
            worst = std::max({worst, std::abs(distance(p, *q) - truth(p)), truth(*q)});
        }
    }
    return worst;
}

/// By how much points of the surface are nearer than the nearest one that the solid knows.
double worst_beside_seeds(const Solid& solid, const std::vector<Point>& points, double spacing) {
    const PointTree seeds = build_point_tree(solid.seeds(spacing, 1, {}));
    double worst = 0.0;
    for (const Point& p : points) {
        const std::optional<Point> q = solid.nearest(p);
        EXPECT_TRUE(q);
        if (q) {
            worst = std::max(worst, distance(p, *q) - std::sqrt(nearest_point(seeds, p).squared_distance));
        }
    }
    return worst;
}

/// A point of the boundary is the nearest one to itself.
void expect_points_on_boundary_stay(const Solid& solid, const std::vector<Point>& points, double accuracy) {
    for (const Point& p : points) {
        const Point q = solid.nearest(p).value();
        const Point r = solid.nearest(q).value();
        EXPECT_LE(distance(q, r), accuracy);
    }
}

TEST(NearestOfAMesh, DistancesAreThoseOfClosedForms) {
    Random random = announced(67);
    struct Meshed {
        TriangleMesh mesh;
        ImplicitSolid solid;
        double error;
    };
    for (const Meshed& known :
         {Meshed{box_mesh({-1.0, -0.7, -0.5}, {1.0, 0.7, 0.5}, 4), box_solid({1.0, 0.7, 0.5}), 1e-13},
          Meshed{ball_mesh(1.0, 200), ball_solid(1.0), 4e-4},
          Meshed{torus_mesh(1.0, 0.4, 200), torus_solid(1.0, 0.4), 8e-4}}) {
        const auto solid = mesh_solid(known.mesh);
        const std::vector<Point> points = questions(random, 1.4, 1000);
        const Truth truth = [&](const Point& p) { return std::abs(known.solid.value(p)); };
        EXPECT_LE(worst_error(*solid, points, truth), known.error);
        expect_consistent(*solid, points);
        expect_points_on_boundary_stay(*solid, points, 1e-14);
    }
}

TEST(NearestOfAUnion, PointsAreThoseOfBruteForce) {
    Random random = announced(68);
    for (const Balls& balls :
         {chain_of_balls(1, 0.0, 1.0), chain_of_balls(2, 1.0, 0.7), chain_of_balls(8, 0.2, 0.5),
          ring_of_balls(12, 1.0, 0.4), grid_of_balls(3, 3, 3, 0.7), scattered_balls(random, 40, 1.0, 0.1, 0.5),
          balls_of_all_sizes(random, 60), balls_around_a_void(random, 50, 0.6), balls_through_points(random, 30, 8)}) {
        const UnionOfBalls truth(balls);
        const auto solid = union_solid(balls);
        std::vector<Point> points{balls[0].center};  // as far from all of its sphere and its circles
        for (int i = 0; i < 400; ++i) {
            points.push_back(random_point(random, 1.5));
        }
        for (const Point& p : points) {
            const auto [far, nearest] = truth.boundary_near(p);
            const Point q = solid->nearest(p).value();
            EXPECT_NEAR(distance(p, q), far, 1e-6);
            EXPECT_NEAR(truth.boundary_near(q).first, 0.0, 1e-6);
        }
        expect_consistent(*solid, points);
    }
}

/// How far the boundary is, by trying every patch, arc and vertex.
double distance_by_brute_force(const UnionBoundary& boundary, const Point& p) {
    const std::vector<Ball>& balls = boundary.complex.balls;
    const IndexLists& neighbors = boundary.adjacency.neighbors;
    double least = kInfinity;
    const auto add = [&](Index ball, Index other, const Point& q) {
        if (distance(p, q) < least && is_exposed(balls, neighbors, ball, other, q)) {
            least = distance(p, q);
        }
    };
    for (const Index ball : boundary.adjacency.visible) {
        add(ball, kNone, balls[ball].center + balls[ball].radius * unit(p - balls[ball].center));
        for (const Index other : neighbors[ball]) {
            const Circle circle(balls[ball], balls[other]);
            add(ball, other, circle.toward(p - circle.center));
        }
    }
    for (const Point& vertex : boundary.complex.vertices.points) {
        least = std::min(least, distance(p, vertex));
    }
    return least;
}

TEST(NearestOfAUnion, OfNearlyEqualBallsIsThatOfBruteForce) {
    for (const double noise : {0.0, 1e-9, 1e-6, 1e-3}) {
        Random random = announced(19);
        Balls balls = ring_of_balls(600, 1.0, 0.2);
        for (Ball& ball : balls) {
            ball = {ball.center + random_point(random, noise), ball.radius + uniform(random, -noise, noise)};
        }
        const UnionData united(balls);
        for (int i = 0; i < 2000; ++i) {
            const Ball& ball = balls[static_cast<std::size_t>(uniform(random, 0.0, 600.0))];
            // On the surface, almost, or anywhere.
            const double off = std::pow(10.0, uniform(random, -8.0, 0.0));
            const Point p = ball.center + ball.radius * (1.0 + off) * random_direction(random);
            const double truth = distance_by_brute_force(united.boundary(), p);
            EXPECT_NEAR(nearest_point(united.boundary(), p).distance, truth, 1e-12) << noise << ' ' << off;
        }
    }
}

TEST(NearestOfAUnion, BoxesAreNoLargerThanThePatches) {
    // Rings, open ones where there is noise: no wider than a few balls are apart.
    for (const double noise : {0.0, 1e-5}) {
        Random random = announced(20);
        Balls balls = chain_of_balls(200, 0.01, 0.2);
        for (Ball& ball : balls) {
            ball.center = ball.center + random_point(random, noise);
        }
        const UnionData united(balls);
        for (const auto& [ball, box] : united.boundary().patches) {
            const auto& [center, radius] = united.complex().balls[ball];
            const Point reach{1.00001 * radius, 1.00001 * radius, 1.00001 * radius};
            EXPECT_TRUE(Box({center - reach, center + reach}).contains(box.min));
            EXPECT_TRUE(Box({center - reach, center + reach}).contains(box.max));
            if (ball > 0 && ball < 199) {
                EXPECT_LT(box.max.x - box.min.x, 0.03) << ball;
            }
        }
    }
}

TEST(NearestOfAFunction, DistancesAreThoseOfClosedForms) {
    Random random = announced(63);
    for (const Known& known : known_solids()) {
        SCOPED_TRACE(known.name);
        const double side = 1.5 * known.size;
        const auto solid = function_solid(known.function, {.bounds = centered_box(side, side, side)});
        const std::vector<Point> points = questions(random, known.size, 400);
        EXPECT_LE(worst_error(*solid, points, known.distance), 2e-5 * known.size);
        expect_consistent(*solid, points);
        expect_points_on_boundary_stay(*solid, points, 1e-6);
    }
}

/// A solid of parts: inside where all functions are negative. From inside the nearest face is that of one of them.
struct OfParts {
    std::string name;
    std::vector<ImplicitSolid::Function> functions;
    std::vector<ImplicitSolid::Function> distances;  ///< of each, signed, right inside
    double curvature;                                ///< the largest one
};

std::vector<OfParts> solids_of_parts() {
    using Function = ImplicitSolid::Function;
    const auto ball = [](const Point& center, double radius) -> Function {
        return [=](const Point& p) { return norm(p - center) - radius; };
    };
    const auto square_ball = [](double factor, const Point& center, double radius) -> Function {
        return [=](const Point& p) { return factor * (squared_norm(p - center) - radius * radius); };
    };
    const Function cut = [](const Point& p) { return 0.3 - p.x; };
    const Function base = [](const Point& p) { return -0.6 - p.z; };
    const Function box = [](const Point& p) {
        return std::max({std::abs(p.x) - 1.0, std::abs(p.y) - 0.7, std::abs(p.z) - 0.5});
    };
    const Point axis = unit(Point{1.0, 2.0, 3.0});
    const auto from_axis = [=](const Point& p) { return norm(p - dot(p, axis) * axis); };
    std::vector<OfParts> result;
    for (const double factor : {1.0, 100.0, 0.01}) {
        result.push_back({"cut ball", {square_ball(factor, {}, 1.0), cut}, {ball({}, 1.0), cut}, 1.0});
    }
    result.push_back(
        {"cone",
         {[](const Point& p) { return 10.0 * (std::hypot(p.x, p.y) - 0.5 * (1.0 - p.z)); }, base},
         {[](const Point& p) { return (std::hypot(p.x, p.y) - 0.5 * (1.0 - p.z)) / std::sqrt(1.25); }, base},
         1.25});
    result.push_back(
        {"cylinder",
         {[](const Point& p) { return p.x * p.x + p.y * p.y - 1.0; }, [](const Point& p) { return p.z * p.z - 1.0; }},
         {[](const Point& p) { return std::hypot(p.x, p.y) - 1.0; },
          [](const Point& p) { return std::abs(p.z) - 1.0; }},
         1.0});
    result.push_back({"turned cylinder",
                      {[=](const Point& p) { return 100.0 * (std::pow(from_axis(p), 2.0) - 0.64); },
                       [=](const Point& p) { return std::abs(dot(p, axis)) - 0.7; }},
                      {[=](const Point& p) { return from_axis(p) - 0.8; },
                       [=](const Point& p) { return std::abs(dot(p, axis)) - 0.7; }},
                      1.25});
    result.push_back({"box", {box}, {box}, 0.0});
    result.push_back({"lens",
                      {square_ball(1.0, {0.4, 0, 0}, 1.0), square_ball(10.0, {-0.4, 0, 0}, 1.0)},
                      {ball({0.4, 0, 0}, 1.0), ball({-0.4, 0, 0}, 1.0)},
                      1.0});
    const Point corner{1.0, 0.7, 0.5};
    result.push_back({"box without a ball",
                      {box, square_ball(-1.0, corner, 0.6)},
                      {box, [=](const Point& p) { return 0.6 - norm(p - corner); }},
                      1.0 / 0.6});
    return result;
}

TEST(NearestOfAFunction, OfPartsIsOnTheNearerFaceWhateverTheirSlopes) {
    Random random = announced(73);
    const auto all = [](const std::vector<ImplicitSolid::Function>& functions) -> ImplicitSolid::Function {
        return [=](const Point& p) {
            double most = -kInfinity;
            for (const ImplicitSolid::Function& function : functions) {
                most = std::max(most, function(p));
            }
            return most;
        };
    };
    const Box bounds = centered_box(1.2, 1.2, 1.2);
    const double step = bounds.diagonal() / 128;
    for (const OfParts& parts : solids_of_parts()) {
        SCOPED_TRACE(parts.name);
        const auto solid = function_solid(all(parts.functions), {.bounds = bounds});
        const auto truth = all(parts.distances);
        std::vector<Point> points;
        while (points.size() < 4000) {  // most of them within a step of the boundary
            const Point p = random_point(random, 1.2);
            const double depth = -truth(p);
            if (depth > 0.0 && (depth < step || points.size() % 4 == 0)) {
                points.push_back(p);
            }
        }
        const Truth depth = [&](const Point& p) { return std::abs(truth(p)); };
        EXPECT_LE(worst_error(*solid, points, depth), parts.curvature * step * step + 1e-9);
    }
}

TEST(NearestOfAFunction, OfAUnionIsFoundInItsNotch) {
    Random random = announced(74);
    const Box bounds = centered_box(1.2, 1.2, 1.2);
    const double step = bounds.diagonal() / 128;
    const Balls balls{{{-0.4, 0.1, 0.0}, 0.7}, {{0.5, 0.0, 0.1}, 0.6}};
    const auto solid = function_solid(
        [=](const Point& p) {
            return std::min(squared_norm(p - balls[0].center) - 0.49,
                            100.0 * (squared_norm(p - balls[1].center) - 0.36));
        },
        {.bounds = bounds});
    const UnionOfBalls united(balls);
    std::vector<Point> points;
    while (points.size() < 2000) {
        const Point p = random_point(random, 1.2);
        if (solid->inside(p)) {
            points.push_back(p);
        }
    }
    const Truth truth = [&](const Point& p) { return united.boundary_near(p).first; };
    EXPECT_LE(worst_error(*solid, points, truth), step * step / 0.6);
}

TEST(NearestOfAFunction, AReentrantEdgeIsFoundFromCloseBy) {
    // But for points that are almost as near to another face.
    Random random = announced(75);
    for (int turn = 0; turn < 6; ++turn) {
        const Similarity turned = random_turn(random);
        const auto ell = [&](const Point& q) {
            const Point p = turned.inverse(q);
            return std::max({-p.z, p.z - 2.0, -p.x, -p.y, p.x - 4.0, p.y - 4.0, std::min(p.x - 1.0, p.y - 1.0)});
        };
        const Point middle = turned({2, 2, 1});
        const Point half{3.3, 3.3, 3.3};
        const auto solid = function_solid(ell, {.bounds = {middle - half, middle + half}, .is_distance = true});
        const double step = 2.0 * norm(half) / 128;
        int wrong = 0;
        for (int i = 0; i < 4000; ++i) {
            const double near = 0.1 * uniform(random, 0.0, 1.0) * uniform(random, 0.0, 1.0);
            const Point p{1.0 - near * uniform(random, 0.0, 1.0), 1.0 - near * uniform(random, 0.0, 1.0),
                          uniform(random, 0.0, 0.15)};
            const std::optional<Point> found = solid->nearest(turned(p));
            ASSERT_TRUE(found);
            const double error = distance(turned(p), *found) - std::min(p.z, std::hypot(1.0 - p.x, 1.0 - p.y));
            ASSERT_LE(error, 0.25 * step);
            wrong += error > 1e-6 * step ? 1 : 0;
        }
        EXPECT_LE(wrong, 80);
    }
}

TEST(NearestOfAFunction, ItNeedNotBeSmoothNorADistance) {
    Random random = announced(69);
    const ImplicitSolid::Function function = torus_solid(1.0, 0.4).function();
    const Truth truth = [&](const Point& p) { return std::abs(function(p)); };
    const Box bounds = centered_box(1.6, 1.6, 1.0);
    const std::vector<Point> points = questions(random, 1.4, 300);
    const auto cubed = function_solid(
        std::function<double(const Point&)>([=](const Point& p) { return 1e-8 * std::pow(function(p), 3.0); }),
        {.bounds = bounds});
    EXPECT_LE(worst_error(*cubed, points, truth), 1e-2);
    const auto mask = function_solid(
        std::function<double(const Point&)>([=](const Point& p) { return function(p) < 0.0 ? -1.0 : 1.0; }),
        {.bounds = bounds});
    EXPECT_LE(worst_error(*mask, points, truth), 0.5 * bounds.diagonal() / 128);
    expect_consistent(*mask, points);
}

TEST(NearestOfAFunction, BatchesOfManyAreAskedForTogether) {
    const auto function = torus_solid(1.0, 0.4).function();
    std::size_t calls = 0;
    const auto solid = function_solid(std::function<void(std::span<const Point>, std::span<double>)>(
                                          [&](std::span<const Point> points, std::span<double> values) {
                                              ++calls;
                                              std::ranges::transform(points, values.begin(), function);
                                          }),
                                      {.bounds = centered_box(1.6, 1.6, 1.0)});
    Random random = announced(70);
    const std::vector<Point> points = questions(random, 1.4, 1000);
    const std::vector<double> bounds(points.size(), kInfinity);
    std::vector<std::optional<Point>> nearest(points.size());
    calls = 0;
    solid->nearest(points, bounds, nearest);
    EXPECT_LT(calls, 200U);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(solid->nearest(points[i]), nearest[i]);
    }
}

TEST(NearestOfAnImage, DistancesAreThoseOfClosedForms) {
    Random random = announced(64);
    for (const Known& known : known_solids()) {
        SCOPED_TRACE(known.name);
        const double side = 1.5 * known.size;
        const double voxel = 2.0 * side / 40;
        const auto solid = image_solid(sampled(known.function, centered_box(side, side, side), 41), Level{0.0, true});
        const std::vector<Point> points = questions(random, known.size, 400);
        // Interpolation rounds edges off.
        const double error = known.name == "box" ? 0.8 * voxel : 0.15 * voxel;
        EXPECT_LE(worst_error(*solid, points, known.distance), error);
        expect_consistent(*solid, points);
        expect_points_on_boundary_stay(*solid, points, 1e-3 * voxel);
    }
}

TEST(NearestOfAnImage, HardlyAPointOfTheSurfaceIsNearer) {
    Random random = announced(65);
    for (const Known& known : known_solids()) {
        for (const bool is_mask : {false, true}) {
            SCOPED_TRACE(known.name + (is_mask ? ", mask" : ""));
            const double side = 1.5 * known.size;
            const Index resolution = 25;
            const double voxel = 2.0 * side / (resolution - 1);
            const Box box = centered_box(side, side, side);
            const auto solid = is_mask ? image_solid(sampled(as_mask(known.function), box, resolution), Level{0.5})
                                       : image_solid(sampled(known.function, box, resolution), Level{0.0, true});
            const double error = is_mask || known.name == "box" ? 0.2 * voxel : 0.02 * voxel;
            EXPECT_LE(worst_beside_seeds(*solid, questions(random, known.size, 300), 0.05 * voxel), error);
        }
    }
}

TEST(NearestOfACloud, DistancesAreThoseOfClosedForms) {
    Random random = announced(66);
    for (const Known& known : known_solids()) {
        SCOPED_TRACE(known.name);
        const double side = 1.5 * known.size;
        const double spacing = 0.06;
        PointCloud cloud;
        cloud.points =
            function_solid(known.function, {.bounds = centered_box(side, side, side)})->seeds(spacing, 3, {});
        for (const Point& p : cloud.points) {
            cloud.normals.push_back(difference_quotient(known.function, p, 1e-6));
        }
        const auto solid = cloud_solid(prepare(cloud));
        const std::vector<Point> points = questions(random, known.size, 300);
        const double error = known.name == "box" ? spacing : 0.05 * spacing;
        EXPECT_LE(worst_error(*solid, points, known.distance), error);
        EXPECT_LE(worst_beside_seeds(*solid, points, 0.02), error);
        expect_consistent(*solid, points);
    }
}

TEST(NearestOfACloud, WhereTheHullClosesItTheHullIsTheSurface) {
    // The lower half of a sphere.
    Random random = announced(71);
    PointCloud cloud;
    while (cloud.points.size() < 6000) {
        const Point p = random_direction(random);
        if (p.z < 0.0) {
            cloud.points.push_back(p);
            cloud.normals.push_back(p);
        }
    }
    const auto solid = cloud_solid(prepare(cloud));
    const Point q = solid->nearest(Point{0.1, 0.05, -0.2}).value();
    EXPECT_NEAR(q.z, 0.0, 0.02);
    EXPECT_NEAR(q.x, 0.1, 1e-9);
    EXPECT_TRUE(solid->inside(Point{q.x, q.y, q.z - 1e-6}));
    EXPECT_FALSE(solid->inside(Point{q.x, q.y, q.z + 1e-6}));
}

TEST(Nearest, FarFromTheOriginItIsTheSame) {
    Random random = announced(72);
    const Point far{1e5, -2e5, 3e5};
    const auto function = torus_solid(1.0, 0.4).function();
    const auto moved_function = [=](const Point& p) { return function(p - far); };
    const Box bounds = centered_box(1.6, 1.6, 1.0);
    const Box moved_bounds{bounds.min + far, bounds.max + far};
    const Truth truth = [=](const Point& p) { return std::abs(moved_function(p)); };
    std::vector<Point> points;
    for (const Point& p : questions(random, 1.4, 200)) {
        points.push_back(p + far);
    }
    const auto of_mesh = mesh_solid(turned(torus_mesh(1.0, 0.4, 200), 0.0, far));
    EXPECT_LE(worst_error(*of_mesh, points, truth), 1e-3);
    expect_consistent(*of_mesh, points);
    const auto of_function =
        function_solid(std::function<double(const Point&)>(moved_function), {.bounds = moved_bounds});
    EXPECT_LE(worst_error(*of_function, points, truth), 2e-5);
    expect_consistent(*of_function, points);
    const auto of_image = image_solid(sampled(moved_function, moved_bounds, 50), Level{0.0, true});
    EXPECT_LE(worst_error(*of_image, points, truth), 5e-3);
    expect_consistent(*of_image, points);
}

TEST(Nearest, ASolidThatDoesNotKnowSaysSo) {
    const ImplicitSolid solid = ball_solid(1.0);
    EXPECT_FALSE(solid.knows_nearest());
    EXPECT_THROW(static_cast<const Solid&>(solid).nearest(Point{}), UnusableInput);
}

}  // namespace
}  // namespace scaleaxis
