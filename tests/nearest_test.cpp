// SPDX-License-Identifier: Apache-2.0
// The points of a solid's boundary that are nearest: closed forms and brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "meshes.hpp"
#include "scaleaxis/mesh.hpp"
#include "solids.hpp"
#include "spatial/nearest_triangle.hpp"
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

TEST(NearestTriangle, TreeFindsWhatBruteForceFinds) {
    Random random = announced(61);
    for (const TriangleMesh& mesh :
         {random_triangles(random, 1), random_triangles(random, 7), random_triangles(random, 2000),
          torus_mesh(1.0, 0.4, 24), ball_mesh(1.0, 20), box_mesh({1.0, 0.7, 0.4}, 2)}) {
        const Bvh bvh = build_bvh(mesh);
        const std::vector<TriangleBlock> blocks = triangle_blocks(bvh);
        for (int i = 0; i < 1000; ++i) {
            Point p = random_point(random, i % 5 == 0 ? 100.0 : 1.5);
            if (i % 7 == 0) {  // many are equally near
                p = {0.0, 0.0, i % 14 == 0 ? p.z : 0.0};
            }
            const NearTriangle truth = by_brute_force(bvh, p);
            const double distance = std::sqrt(truth.squared_distance);
            expect_same(nearest_triangle(bvh, blocks, p), truth);
            expect_same(nearest_triangle(bvh, blocks, p, distance * (1.0 + 1e-12) + 1e-300), truth);
            EXPECT_EQ(nearest_triangle(bvh, blocks, p, distance * (1.0 - 1e-12)).triangle, kNone);
        }
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

}  // namespace
}  // namespace scaleaxis
