// SPDX-License-Identifier: Apache-2.0
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "executions.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "solid/mesh/segment_crossing.hpp"
#include "solid/mesh/self_intersections.hpp"
#include "solid/mesh/winding.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr std::uint64_t kSeed = 20260101;

class Random {
   public:
    explicit Random(std::uint64_t seed = kSeed) : engine_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
    int integer(int low, int high) { return std::uniform_int_distribution(low, high)(engine_); }
    Point in(const Box& box) {
        return {between(box.min.x, box.max.x), between(box.min.y, box.max.y), between(box.min.z, box.max.z)};
    }

   private:
    std::mt19937_64 engine_;
};

Box box_of(const TriangleMesh& mesh) {
    Box box;
    for (const Point& p : mesh.vertices) {
        box.extend(p);
    }
    return box;
}

Box enlarged(const Box& box, double factor) {
    const Point center = midpoint(box.min, box.max);
    return {center + factor * (box.min - center), center + factor * (box.max - center)};
}

std::unique_ptr<Solid> solid_of(const TriangleMesh& mesh) {
    RepairedMesh repaired{mesh, {}};
    repaired.report.self_intersections = count_self_intersections(mesh);
    return mesh_solid(std::move(repaired));
}

std::array<Point, 3> corners_of(const TriangleMesh& mesh, Index t) {
    const auto& [u, v, w] = mesh.triangles[t];
    return {mesh.vertices[u], mesh.vertices[v], mesh.vertices[w]};
}

/// Distance of a point to a triangle (C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5).
double distance_to_triangle(const Point& p, const std::array<Point, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    const Point normal = cross(b - a, c - a);
    const double area = squared_norm(normal);
    const auto along = [&](const Point& s, const Point& e) {
        const double t = std::clamp(dot(p - s, e - s) / squared_norm(e - s), 0.0, 1.0);
        return distance(p, s + t * (e - s));
    };
    const auto is_left_of = [&](const Point& s, const Point& e) { return dot(cross(e - s, p - s), normal) >= 0.0; };
    if (area > 0.0 && is_left_of(a, b) && is_left_of(b, c) && is_left_of(c, a)) {
        return std::abs(dot(p - a, normal)) / std::sqrt(area);
    }
    return std::min({along(a, b), along(b, c), along(c, a)});
}

double distance_to_mesh(const Point& p, const TriangleMesh& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        least = std::min(least, distance_to_triangle(p, corners_of(mesh, static_cast<Index>(t))));
    }
    return least;
}

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

/// Two cubes that have a corner, an edge or part of a face in common, as separate components.
std::vector<NamedMesh> closed_meshes() {
    const TriangleMesh unit = box_mesh({0, 0, 0}, {1, 1, 1}, 2);
    const TriangleMesh ball = sphere_mesh({0.1, 0.2, 0.3}, 1.0, 2);
    TriangleMesh squeezed = ball;  // with triangles that have no area
    for (Point& p : squeezed.vertices) {
        p.z = std::max(p.z, 0.5);
    }
    return {{"box", box_mesh({-1, -1, -1}, {1, 1, 1}, 4)},
            {"sphere", ball},
            {"torus", torus_mesh(1.0, 0.4, 16, 8)},
            {"octahedron",
             {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
              {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}}},
            {"box in a box",
             together({box_mesh({-1, -1, -1}, {1, 1, 1}, 2), box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})})},
            {"shell", together({box_mesh({-1, -1, -1}, {1, 1, 1}, 2),
                                inside_out(box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}))})},
            {"inward box", inside_out(unit)},
            {"corner to corner", together({unit, moved(unit, {1, 1, 1})})},
            {"edge to edge", together({unit, moved(unit, {1, 1, 0})})},
            {"face to face", together({unit, moved(unit, {1, 0.5, 0})})},
            {"twice the same", together({unit, unit})},
            {"overlapping", together({unit, moved(unit, {0.5, 0.25, 0}), moved(ball, {0.5, 0, 0})})},
            {"flattened sphere", squeezed}};
}

/// Points on a grid that the vertices, edges and faces of the structured meshes are on too, and ordinary points.
std::vector<Point> query_points(const TriangleMesh& mesh, int count, Random& random) {
    std::vector<Point> points;
    const Box box = enlarged(box_of(mesh), 1.25);
    for (int i = 0; i < count; ++i) {
        const auto& corners = corners_of(mesh, random.integer(0, static_cast<int>(mesh.triangles.size()) - 1));
        switch (i % 6) {
            case 0:
                points.push_back(random.in(box));
                break;
            case 1:
                points.push_back(corners[0]);
                break;
            case 2:
                points.push_back(midpoint(corners[0], corners[1]));
                break;
            case 3:
                points.push_back(corners[0] + 0.25 * (corners[1] - corners[0]) + 0.5 * (corners[2] - corners[0]));
                break;
            default: {
                const auto on_grid = [&] { return 0.25 * random.integer(-6, 6); };
                points.push_back({on_grid(), on_grid(), on_grid()});
            }
        }
    }
    return points;
}

// ---------------------------------------------------------------------------------------------------------------------
// Crossings
// ---------------------------------------------------------------------------------------------------------------------

TEST(SegmentCrossing, OfAPlainTriangle) {
    const Point u{0, 0, 0}, v{1, 0, 0}, w{0, 1, 0};  // its normal points upward
    const SegmentCrossing up = SegmentProbe({0.25, 0.5, -1}, {0.25, 0.5, 3}).crossing(u, v, w);
    EXPECT_EQ(up.sign, 1);
    EXPECT_DOUBLE_EQ(up.position, 0.25);
    EXPECT_DOUBLE_EQ(up.weights[0], 0.25);
    EXPECT_DOUBLE_EQ(up.weights[1], 0.25);
    EXPECT_DOUBLE_EQ(up.weights[2], 0.5);
    EXPECT_EQ(SegmentProbe({0.25, 0.5, 3}, {0.25, 0.5, -1}).crossing(u, v, w).sign, -1);
    EXPECT_EQ(SegmentProbe({0.25, 0.5, -1}, {0.25, 0.5, 3}).crossing(v, u, w).sign, -1);
    EXPECT_EQ(SegmentProbe({0.25, 0.5, 1}, {0.25, 0.5, 3}).crossing(u, v, w).sign, 0);
    EXPECT_EQ(SegmentProbe({0.75, 0.5, -1}, {0.75, 0.5, 3}).crossing(u, v, w).sign, 0);
    EXPECT_EQ(SegmentProbe({0.25, 0.5, 0}, {0.5, 0.25, 0}).crossing(u, v, w).sign, 0);
    EXPECT_EQ(SegmentProbe({0.25, 0.5, 1}, {0.25, 0.5, 1}).crossing(u, v, w).sign, 0);
    EXPECT_EQ(SegmentProbe({0, 0, -1}, {0, 0, 1}).crossing(u, u, v).sign, 0);
}

TEST(SegmentCrossing, FilterAgreesWithExactArithmetic) {
    Random random;
    int crossings = 0;
    for (int i = 0; i < 200000; ++i) {
        // From a coarse grid: most of these are degenerate in some way. A little noise makes them nearly so.
        const double noise = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1e-15 : 0.3;
        const double scale = i % 5 == 0 ? 1e-60 : i % 5 == 1 ? 1e30 : 1.0;
        const auto coordinate = [&] { return scale * (random.integer(-2, 2) + random.between(-noise, noise)); };
        std::array<Point, 5> p;
        for (Point& q : p) {
            q = {coordinate(), coordinate(), coordinate()};
        }
        const auto& [a, b, u, v, w] = p;
        const SegmentCrossing fast = SegmentProbe(a, b).crossing(u, v, w);
        const SegmentCrossing exact = exact_crossing(a, b, u, v, w);
        ASSERT_EQ(fast.sign, exact.sign) << "case " << i << ", seed " << kSeed;
        if (fast.sign != 0) {
            ++crossings;
            const auto point_of = [&](const SegmentCrossing& c) {
                return c.weights[0] * p[2] + c.weights[1] * p[3] + c.weights[2] * p[4];
            };
            ASSERT_LT(distance(point_of(fast), point_of(exact)), 1e-9 * scale) << "case " << i << ", seed " << kSeed;
            ASSERT_LT(std::abs(fast.position - exact.position) * distance(a, b), 1e-12 * scale)
                << "case " << i << ", seed " << kSeed;
            ASSERT_GE(*std::min_element(fast.weights.begin(), fast.weights.end()), 0.0);
        }
    }
    EXPECT_GT(crossings, 10000);
}

// A triangle that lies almost in the direction of the segment: the filter must not return a point of no meaning.
TEST(SegmentCrossing, OfASliverSeenEdgeOnIsAccurate) {
    const Point u{0, 0, 0}, v{1e-9, 0, 1}, w{0, 1e-15, 0.5};
    const Point a{0.5e-9, 0.3e-15, -1}, b{0.5e-9, 0.3e-15, 2};
    const SegmentCrossing crossing = SegmentProbe(a, b).crossing(u, v, w);
    ASSERT_NE(crossing.sign, 0);
    const Point p = crossing.weights[0] * u + crossing.weights[1] * v + crossing.weights[2] * w;
    EXPECT_LT(norm(cross(p - a, b - a)) / norm(b - a), 1e-18);
}

TEST(Crossings, AreThoseOfAllTriangles) {
    Random random;
    for (const NamedMesh& named : closed_meshes()) {
        const Bvh bvh = build_bvh(named.mesh);
        ASSERT_EQ(bvh.mesh.triangles.size(), named.mesh.triangles.size());
        const std::vector<Point> points = query_points(named.mesh, 60, random);
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            std::set<Index> found;
            for_each_crossing(bvh, points[i], points[i + 1], [&](Index t, const SegmentCrossing&) { found.insert(t); });
            std::set<Index> all;
            const SegmentProbe probe(points[i], points[i + 1]);
            for (Index t = 0; t < static_cast<Index>(bvh.mesh.triangles.size()); ++t) {
                const auto& [u, v, w] = corners_of(bvh.mesh, t);
                if (probe.crossing(u, v, w).sign != 0) {
                    all.insert(t);
                }
            }
            ASSERT_EQ(found, all) << named.name << ", segment " << i << ", seed " << kSeed;
        }
    }
}

// Through vertices, along edges and in faces: the signed crossings on the way from one point to another must be the
// difference of the winding numbers at these points, whatever the way.
TEST(Crossings, AddUpToWindingNumbersInEveryDirection) {
    Random random;
    for (const NamedMesh& named : closed_meshes()) {
        const Bvh bvh = build_bvh(named.mesh);
        const Box box = box_of(bvh.mesh);
        const std::vector<Point> points = query_points(named.mesh, 150, random);
        std::vector<int> windings;
        for (const Point& p : points) {
            windings.push_back(winding_number(bvh, box, p));
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t j = 0; j < points.size(); ++j) {
                int sum = 0;
                for_each_crossing(bvh, points[i], points[j],
                                  [&](Index, const SegmentCrossing& crossing) { sum += crossing.sign; });
                ASSERT_EQ(sum, windings[i] - windings[j])
                    << named.name << ", from point " << i << " to point " << j << ", seed " << kSeed;
            }
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Inside
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshSolid, InsideIsWhereTheSolidAngleSaysSo) {
    Random random;
    for (const NamedMesh& named : closed_meshes()) {
        const auto solid = solid_of(named.mesh);
        int inside = 0;
        for (const Point& p : query_points(named.mesh, 400, random)) {
            if (distance_to_mesh(p, named.mesh) > 1e-6) {
                const bool expected = winding_by_solid_angle(named.mesh, p) != 0;
                inside += expected ? 1 : 0;
                ASSERT_EQ(solid->inside(p), expected)
                    << named.name << " at " << p.x << " " << p.y << " " << p.z << ", seed " << kSeed;
            }
        }
        EXPECT_GT(inside, 0) << named.name;
    }
}

TEST(MeshSolid, InsideOfABatchIsThatOfEachPoint) {
    Random random;
    for (const NamedMesh& named : closed_meshes()) {
        const auto solid = solid_of(named.mesh);
        std::vector<std::vector<Point>> batches{query_points(named.mesh, 400, random)};
        // Points so near to each other that few triangles are near them: around a vertex, and on it.
        const double step = 1e-4 * box_of(named.mesh).diagonal();
        for (int i = 0; i < 20; ++i) {
            const Point& vertex =
                named.mesh.vertices[random.integer(0, static_cast<int>(named.mesh.vertices.size()) - 1)];
            std::vector<Point> around{vertex, vertex};
            for (int k = 0; k < 40; ++k) {
                around.push_back(vertex + step * random.in({{-1, -1, -1}, {1, 1, 1}}));
            }
            batches.push_back(around);
        }
        for (const std::vector<Point>& points : batches) {
            std::vector<std::uint8_t> sides(points.size());
            solid->inside(points, sides);
            for (std::size_t i = 0; i < points.size(); ++i) {
                ASSERT_EQ(sides[i] != 0, solid->inside(points[i]))
                    << named.name << ", point " << i << ", seed " << kSeed;
            }
        }
    }
}

TEST(MeshSolid, InsideOfABox) {
    const auto solid = solid_of(box_mesh({-1, -2, -3}, {1, 2, 3}, 8));
    for (int i = -14; i <= 14; ++i) {
        for (int j = -14; j <= 14; ++j) {
            for (int k = -14; k <= 14; ++k) {
                const Point p{0.1 * i, 0.2 * j, 0.3 * k};  // on the grid of the faces' vertices, as it happens
                if (std::abs(i) != 10 && std::abs(j) != 10 && std::abs(k) != 10) {
                    ASSERT_EQ(solid->inside(p), std::abs(i) < 10 && std::abs(j) < 10 && std::abs(k) < 10)
                        << p.x << " " << p.y << " " << p.z;
                }
            }
        }
    }
    EXPECT_FALSE(solid->inside({std::numeric_limits<double>::quiet_NaN(), 0, 0}));
    EXPECT_FALSE(solid->inside({0, std::numeric_limits<double>::infinity(), 0}));
}

TEST(MeshSolid, SizeAndPlaceDoNotMatter) {
    Random random;
    const TriangleMesh mesh = torus_mesh(1.0, 0.4, 24, 12);
    const auto solid = solid_of(mesh);
    const std::vector<std::pair<Point, double>> motions{{{0, 0, 0}, 1e-9},       {{0, 0, 0}, 1e9},
                                                        {{0, 0, 0}, 1e-30},      {{0, 0, 0}, 1e30},
                                                        {{1e6, 1e6, -1e6}, 1.0}, {{0, 1e6, 0}, 1e-2}};
    for (const auto& [by, scale] : motions) {
        const TriangleMesh other_mesh = moved(mesh, by, scale);
        const auto other = solid_of(other_mesh);
        EXPECT_EQ(other->topology(), solid->topology());
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const Point a = random.in(solid->bounds()), b = random.in(solid->bounds());
            if (i < 200 && distance_to_mesh(a, mesh) > 1e-3) {
                ASSERT_EQ(other->inside(scale * a + by), solid->inside(a)) << "scale " << scale << ", seed " << kSeed;
            }
            const auto hit = other->crossing(scale * a + by, scale * b + by, scale * a + by);
            if (hit && i < 200) {
                ++hits;
                const double rounding = 1e-15 * (norm(by) + scale);
                ASSERT_LT(distance_to_mesh(*hit, other_mesh), 10 * rounding) << "scale " << scale;
            }
        }
        EXPECT_GT(hits, 20) << "scale " << scale;
    }
}

TEST(MeshSolid, QueriesFromSeveralThreadsAgree) {
    Random random;
    const auto solid = solid_of(sphere_mesh({0, 0, 0}, 1.0, 3));
    std::vector<Point> points(20000);
    for (Point& p : points) {
        p = random.in(enlarged(solid->bounds(), 1.1));
    }
    std::vector<char> alone(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        alone[i] = solid->inside(points[i]);
    }
    std::vector<char> together_(points.size());
    in_arena(Execution{4, {}}, [&] {
        for_each_index(
            points.size(), [&](std::size_t i) { together_[i] = solid->inside(points[i]); }, std::size_t{16});
    });
    EXPECT_EQ(alone, together_);
}

// ---------------------------------------------------------------------------------------------------------------------
// Crossing
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshSolid, CrossesOddlyJustBetweenInsideAndOutside) {
    Random random;
    for (const NamedMesh& named : closed_meshes()) {
        const auto solid = solid_of(named.mesh);
        const std::vector<Point> points = query_points(named.mesh, 80, random);
        int crossings = 0;
        for (const Point& a : points) {
            for (const Point& b : points) {
                const auto hit = solid->crossing(a, b, a);
                ASSERT_EQ(hit.has_value(), solid->inside(a) != solid->inside(b)) << named.name << ", seed " << kSeed;
                crossings += hit ? 1 : 0;
            }
        }
        EXPECT_GT(crossings, 100) << named.name;
    }
}

TEST(MeshSolid, CrossingLiesOnTheSegmentAndTheBoundary) {
    Random random;
    for (const NamedMesh& named : closed_meshes()) {
        const auto solid = solid_of(named.mesh);
        const Box box = enlarged(solid->bounds(), 1.2);
        int crossings = 0;
        for (int i = 0; i < 300; ++i) {
            const Point a = random.in(box), b = random.in(box);
            const auto hit = solid->inside(a) ? solid->crossing(a, b, a) : std::nullopt;
            if (hit) {
                ++crossings;
                const Point along = (1.0 / norm(b - a)) * (b - a);
                ASSERT_LT(norm(cross(*hit - a, along)), 1e-12) << named.name;
                ASSERT_LT(distance_to_mesh(*hit, named.mesh), 1e-12) << named.name;
                // Here it enters or leaves, unless another sheet is very near.
                const Point step = 1e-7 * along;
                ASSERT_NE(solid->inside(*hit - step), solid->inside(*hit + step)) << named.name << ", seed " << kSeed;
            }
        }
        EXPECT_GT(crossings, 10) << named.name;
    }
}

TEST(MeshSolid, OfSeveralCrossingsTheFarthestIsReturned) {
    const auto boxes = solid_of(
        together({box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({2, 0, 0}, {3, 1, 1}), box_mesh({4, 0, 0}, {5, 1, 1})}));
    const Point in_first{0.5, 0.3, 0.4}, in_second{2.5, 0.3, 0.4}, in_third{4.5, 0.3, 0.4};
    const Point beyond{7, 0.3, 0.4}, gap{1.5, 0.3, 0.4};
    const auto x_of = [](const std::optional<Point>& p) { return p ? p->x : -1.0; };
    EXPECT_DOUBLE_EQ(x_of(boxes->crossing(in_first, beyond, in_first)), 5.0);
    EXPECT_DOUBLE_EQ(x_of(boxes->crossing(in_first, beyond, beyond)), 1.0);
    EXPECT_DOUBLE_EQ(x_of(boxes->crossing(in_first, gap, in_first)), 1.0);
    EXPECT_DOUBLE_EQ(x_of(boxes->crossing(in_second, gap, in_first)), 2.0);
    EXPECT_EQ(boxes->crossing(in_first, in_second, in_first), std::nullopt);
    EXPECT_EQ(boxes->crossing(in_first, in_third, in_first), std::nullopt);
    EXPECT_EQ(boxes->crossing(gap, beyond, gap), std::nullopt);
}

TEST(MeshSolid, InnerWallsAreNotCrossed) {
    const TriangleMesh unit = box_mesh({0, 0, 0}, {1, 1, 1});
    const Point in{0.2, 0.3, 0.4}, out{4, 0.3, 0.4};
    const auto overlapping = solid_of(together({unit, moved(unit, {0.5, 0, 0})}));
    ASSERT_TRUE(overlapping->crossing(in, out, in));
    EXPECT_DOUBLE_EQ(overlapping->crossing(in, out, out)->x, 1.5);
    // Of two coinciding walls, divided in different ways, none may be left over by rounding.
    Random random;
    for (int i = 0; i < 200; ++i) {
        const double wall = random.between(0.5, 1.5);
        const auto touching =
            solid_of(together({box_mesh({0, 0, 0}, {wall, 1, 1}), box_mesh({wall, 0, 0}, {3, 1, 1}, 3)}));
        const Point start{0.1, random.between(0, 1), random.between(0, 1)};
        const Point end{4, start.y, random.between(0, 1)};
        const auto hit = touching->crossing(start, end, end);
        const bool leaves_by_the_end = start.z + (end.z - start.z) * 2.9 / 3.9 < 1.0;
        ASSERT_TRUE(hit);
        ASSERT_TRUE(leaves_by_the_end);
        ASSERT_DOUBLE_EQ(hit->x, 3.0) << "case " << i << ", seed " << kSeed;
    }
    const auto filled = solid_of(together({box_mesh({-1, -1, -1}, {2, 2, 2}), unit}));
    EXPECT_DOUBLE_EQ(filled->crossing({0.5, 0.5, 0.5}, {3, 0.5, 0.5}, {3, 0.5, 0.5})->x, 2.0);
    const auto shell = solid_of(together({box_mesh({-1, -1, -1}, {2, 2, 2}), inside_out(unit)}));
    EXPECT_DOUBLE_EQ(shell->crossing({1.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5})->x, 1.0);
    EXPECT_FALSE(shell->inside({0.5, 0.5, 0.5}));
    EXPECT_TRUE(filled->inside({0.5, 0.5, 0.5}));
}

// ---------------------------------------------------------------------------------------------------------------------
// Topology
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshSolid, TopologyOfTheSolid) {
    const TriangleMesh small = sphere_mesh({0, 0, 0}, 0.5, 1), middle = sphere_mesh({0, 0, 0}, 1.0, 2);
    const TriangleMesh large = sphere_mesh({0, 0, 0}, 2.0, 2), torus = torus_mesh(1.0, 0.3, 24, 12);
    struct Case {
        std::string name;
        TriangleMesh mesh;
        std::optional<Topology> expected;  // components, Euler characteristic, tunnels, voids
    };
    const std::vector<Case> cases{
        {"ball", middle, Topology{1, 1, 0, 0}},
        {"inward ball", inside_out(middle), Topology{1, 1, 0, 0}},
        {"torus", torus, Topology{1, 0, 1, 0}},
        {"shell", together({large, inside_out(middle)}), Topology{1, 2, 0, 1}},
        {"filled", together({large, middle}), Topology{1, 1, 0, 0}},
        {"ball in a shell", together({large, inside_out(middle), small}), Topology{2, 3, 0, 1}},
        {"three balls in each other", together({large, middle, small}), Topology{1, 1, 0, 0}},
        {"inward and outward", together({inside_out(large), middle}), Topology{1, 2, 0, 1}},
        {"two balls", together({middle, moved(middle, {3, 0, 0})}), Topology{2, 2, 0, 0}},
        {"ball with a cavity shaped like a torus", together({large, inside_out(torus)}), Topology{1, 1, 1, 1}},
        {"two tori and a ball", together({torus, moved(torus, {5, 0, 0}), moved(small, {0, 5, 0})}),
         Topology{3, 1, 2, 0}},
        {"linked tori",
         together({torus,
                   [&] {
                       TriangleMesh other = torus;
                       for (Point& p : other.vertices) {
                           p = {p.x + 1.0, p.z, -p.y};
                       }
                       return other;
                   }()}),
         Topology{2, 0, 2, 0}},
        {"overlapping", together({middle, moved(middle, {0.7, 0, 0})}), std::nullopt},
    };
    for (const Case& c : cases) {
        EXPECT_EQ(solid_of(c.mesh)->topology(), c.expected) << c.name;
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Self-intersections
// ---------------------------------------------------------------------------------------------------------------------

/// The same by the library that has been doing it for long.
std::int64_t reference_count(const TriangleMesh& mesh) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    CGAL::Surface_mesh<Kernel::Point_3> surface;
    using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
    std::vector<Surface::Vertex_index> vertices;
    for (const Point& p : mesh.vertices) {
        vertices.push_back(surface.add_vertex({p.x, p.y, p.z}));
    }
    for (const auto& [u, v, w] : mesh.triangles) {
        EXPECT_NE(surface.add_face(vertices[u], vertices[v], vertices[w]), Surface::null_face());
    }
    std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
    CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(pairs));
    return static_cast<std::int64_t>(pairs.size());
}

TEST(SelfIntersections, OfWholeMeshes) {
    for (const NamedMesh& named : closed_meshes()) {
        if (named.name != "flattened sphere") {  // of triangles without area the reference takes no notice
            EXPECT_EQ(count_self_intersections(named.mesh), reference_count(named.mesh)) << named.name;
        }
    }
}

TEST(SelfIntersections, OfRandomTetrahedraAndCrumpledSpheres) {
    Random random;
    std::int64_t total = 0;
    for (int i = 0; i < 60; ++i) {
        std::vector<TriangleMesh> tetrahedra;
        const bool is_on_grid = i % 2 == 0;
        while (tetrahedra.size() < 12) {
            TriangleMesh mesh{{}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
            for (int k = 0; k < 4; ++k) {
                const auto coordinate = [&] {
                    return is_on_grid ? static_cast<double>(random.integer(0, 4)) : random.between(0, 4);
                };
                mesh.vertices.push_back({coordinate(), coordinate(), coordinate()});
            }
            const Point& a = mesh.vertices[0];
            if (dot(mesh.vertices[1] - a, cross(mesh.vertices[2] - a, mesh.vertices[3] - a)) != 0.0) {
                tetrahedra.push_back(mesh);
            }
        }
        const TriangleMesh soup = together(tetrahedra);
        const std::int64_t count = count_self_intersections(soup);
        ASSERT_EQ(count, reference_count(soup)) << "case " << i << ", seed " << kSeed;
        total += count;

        // Triangles with corners and edges in common that cut and cover each other.
        TriangleMesh crumpled = sphere_mesh({0, 0, 0}, 2.0, 1);
        for (Point& p : crumpled.vertices) {
            p = is_on_grid ? Point{std::round(p.x), std::round(p.y), std::round(p.z)} : p;
            p = p + 0.6 * Point{1.0 * random.integer(-1, 1), 1.0 * random.integer(-1, 1), 1.0 * random.integer(-1, 1)};
        }
        const bool has_flat = std::any_of(crumpled.triangles.begin(), crumpled.triangles.end(), [&](const auto& t) {
            const auto& [u, v, w] = t;
            return first_sign_of_cross(crumpled.vertices[u], crumpled.vertices[v], crumpled.vertices[u],
                                       crumpled.vertices[w]) == 0;
        });
        if (!has_flat) {
            ASSERT_EQ(count_self_intersections(crumpled), reference_count(crumpled))
                << "case " << i << ", seed " << kSeed;
        }
    }
    EXPECT_GT(total, 1000);
}

TEST(SelfIntersections, MarkTheTrianglesAndDoNotDependOnThreads) {
    const TriangleMesh mesh = together({sphere_mesh({0, 0, 0}, 1.0, 4), sphere_mesh({1.1, 0.2, 0.1}, 0.7, 4)});
    const std::int64_t pairs = count_self_intersections(mesh, Execution{1, {}});
    EXPECT_GT(pairs, 100);
    EXPECT_EQ(count_self_intersections(mesh, Execution{4, {}}), pairs);
    const Bvh bvh = build_bvh(mesh);
    const SelfIntersections found = self_intersections(bvh);
    EXPECT_EQ(found.pairs, pairs);
    for (std::size_t t = 0; t < found.is_cut.size(); ++t) {
        if (found.is_cut[t] != 0) {  // near to both spheres
            const Point p = corners_of(bvh.mesh, static_cast<Index>(t))[0];
            EXPECT_NEAR(norm(p), 1.0, 0.15);
            EXPECT_NEAR(distance(p, {1.1, 0.2, 0.1}), 0.7, 0.15);
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Seeds
// ---------------------------------------------------------------------------------------------------------------------

double area_of(const TriangleMesh& mesh) {
    double area = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = corners_of(mesh, static_cast<Index>(t));
        area += 0.5 * norm(cross(b - a, c - a));
    }
    return area;
}

TEST(Seeds, AreOnTheSurfaceInTheRightNumber) {
    const std::vector<NamedMesh> meshes{{"sphere", sphere_mesh({1, 2, 3}, 1.0, 2)},
                                        {"fine sphere", sphere_mesh({1, 2, 3}, 1.0, 4)},
                                        {"box", box_mesh({0, 0, 0}, {1, 2, 30})},
                                        {"torus", torus_mesh(2.0, 0.5, 32, 16)}};
    for (const NamedMesh& named : meshes) {
        const auto solid = solid_of(named.mesh);
        for (const double spacing : {0.1, 0.3}) {
            const double wanted = area_of(named.mesh) / (spacing * spacing);
            const std::vector<Point> seeds = solid->seeds(spacing, 7, {});
            EXPECT_GE(static_cast<double>(seeds.size()), 7.0 * wanted) << named.name << " " << spacing;
            EXPECT_LE(static_cast<double>(seeds.size()), 20.0 * wanted + 20.0) << named.name << " " << spacing;
            for (std::size_t i = 0; i < seeds.size(); i += 1 + seeds.size() / 200) {
                ASSERT_LT(distance_to_mesh(seeds[i], named.mesh), 1e-14 * 30.0) << named.name;
            }
        }
    }
}

// A long box of two triangles a side: the part of the seeds on each piece is that of the area.
TEST(Seeds, AreUniform) {
    const auto solid = solid_of(box_mesh({0, 0, 0}, {1, 2, 30}));
    const std::vector<Point> seeds = solid->seeds(0.05, 3, {});
    const double area = 2.0 * (2.0 + 30.0 + 60.0);
    const auto count = static_cast<double>(seeds.size());
    const auto share_of = [&](auto&& is_counted) {
        return static_cast<double>(std::count_if(seeds.begin(), seeds.end(), is_counted)) / count;
    };
    const double tolerance = 4.0 / std::sqrt(count);
    EXPECT_NEAR(share_of([](const Point& p) { return p.z == 30.0; }), 2.0 / area, tolerance);
    EXPECT_NEAR(share_of([](const Point& p) { return p.x == 1.0; }), 60.0 / area, tolerance);
    EXPECT_NEAR(share_of([](const Point& p) { return p.y == 2.0 && p.z < 10.0; }), 10.0 / area, tolerance);
    EXPECT_NEAR(share_of([](const Point& p) { return p.x == 0.0 && p.y < 0.5 && p.z > 10.0; }), 10.0 / area, tolerance);
}

TEST(Seeds, AreAFunctionOfTheSeedAlone) {
    for (const TriangleMesh& mesh :
         {sphere_mesh({0, 0, 0}, 1.0, 4), together({sphere_mesh({0, 0, 0}, 1.0, 3), sphere_mesh({1, 0, 0}, 1.0, 3)})}) {
        const auto solid = solid_of(mesh);
        const std::vector<Point> one = solid->seeds(0.05, 5, Execution{1, {}});
        EXPECT_GT(one.size(), 10000U);
        EXPECT_EQ(one, solid->seeds(0.05, 5, Execution{4, {}}));
        EXPECT_EQ(one, solid_of(mesh)->seeds(0.05, 5, Execution{3, {}}));
        EXPECT_NE(one, solid->seeds(0.05, 6, Execution{1, {}}));
    }
}

TEST(Seeds, ReachEveryComponentAndKeepTheVertices) {
    const TriangleMesh box = box_mesh({0, 0, 0}, {1, 2, 3});
    const auto contains = [](const std::vector<Point>& seeds, const Point& p) {
        return std::find(seeds.begin(), seeds.end(), p) != seeds.end();
    };
    const std::vector<Point> of_box = solid_of(box)->seeds(0.2, 1, {});
    for (const Point& p : box.vertices) {
        EXPECT_TRUE(contains(of_box, p));
    }
    // Smaller than the spacing by far, and too many vertices in the rest for all of them to be taken.
    const Point center{10, 0, 0};
    const TriangleMesh both = together({sphere_mesh({0, 0, 0}, 1.0, 5), sphere_mesh(center, 1e-3, 0)});
    const std::vector<Point> seeds = solid_of(both)->seeds(0.5, 1, {});
    EXPECT_LT(seeds.size(), 1500U);
    const auto near =
        std::count_if(seeds.begin(), seeds.end(), [&](const Point& p) { return distance(p, center) < 0.1; });
    EXPECT_EQ(near, 12);
}

/// Turned so that no coordinate of a corner is exact.
TriangleMesh askew(TriangleMesh mesh) {
    const Point u = (1.0 / 3.0) * Point{1, 2, 2}, v = (1.0 / 3.0) * Point{2, 1, -2}, w = (1.0 / 3.0) * Point{-2, 2, -1};
    for (Point& p : mesh.vertices) {
        p = p.x * u + p.y * v + p.z * w;
    }
    return mesh;
}

TEST(Seeds, AreOnTheBoundaryOfTheSolidAlone) {
    const TriangleMesh unit = box_mesh({0, 0, 0}, {1, 1, 1}), large = box_mesh({-1, -1, -1}, {2, 2, 2});
    const std::vector<NamedMesh> meshes{
        {"nested", together({large, unit})},
        {"shell", together({large, inside_out(unit)})},
        {"overlapping", together({unit, moved(unit, {0.5, 0.3, 0.2}), moved(unit, {5, 0, 0})})},
        {"overlapping spheres", together({sphere_mesh({0, 0, 0}, 1.0, 4), sphere_mesh({1, 0.1, 0.2}, 0.8, 4)})},
        {"sharing a face", together({unit, moved(unit, {1, 0, 0})})},
        {"sharing a face divided in another way", together({unit, box_mesh({1, 0, 0}, {2, 1, 1}, 3)})},
        {"sharing a part of a face", together({unit, box_mesh({1, 0.2, 0.3}, {2, 0.7, 1}, 2)})},
        {"sharing a face askew", askew(together({unit, box_mesh({1, 0, 0}, {2, 1, 1}, 5)}))},
        {"with faces in one plane", together({unit, box_mesh({0.5, 0, 0.25}, {2, 1, 0.75}, 2)})},
        {"within a cavity of its own size", together({large, inside_out(unit), unit})},
    };
    for (const NamedMesh& named : meshes) {
        const auto solid = solid_of(named.mesh);
        const std::vector<Point> seeds = solid->seeds(0.1, 1, {});
        // Of the boundary: both sides can be seen from somewhere nearby.
        Random random;
        for (std::size_t i = 0; i < seeds.size(); i += 1 + seeds.size() / 500) {
            bool has_inside = false;
            bool has_outside = false;
            for (int k = 0; k < 40; ++k) {
                const Point step{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
                (solid->inside(seeds[i] + 1e-6 * step) ? has_inside : has_outside) = true;
            }
            ASSERT_TRUE(has_inside && has_outside)
                << named.name << " " << seeds[i].x << " " << seeds[i].y << " " << seeds[i].z;
        }
        // Nothing of the boundary is left out.
        int checked = 0;
        for (int i = 0; i < 300; ++i) {
            const Point a = random.in(enlarged(solid->bounds(), 1.2)), b = random.in(enlarged(solid->bounds(), 1.2));
            if (solid->inside(a) != solid->inside(b)) {
                ++checked;
                const auto hit = solid->crossing(a, b, a);
                ASSERT_TRUE(hit);
                ASSERT_TRUE(std::any_of(seeds.begin(), seeds.end(), [&](const Point& p) {
                    return distance(p, *hit) < 0.1;
                })) << named.name;
            }
        }
        EXPECT_GT(checked, 30) << named.name;
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Faults
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshSolid, SharpEdgesAreThoseOfAllPairsOfTriangles) {
    Random random;
    TriangleMesh mesh = sphere_mesh({1, 2, 3}, 1.0, 3);
    for (Point& p : mesh.vertices) {
        p = p + random.between(0.0, 0.15) * (p - Point{1, 2, 3});
    }
    const std::unique_ptr<Solid> solid = mesh_solid(mesh);
    const auto normal_of = [&](const std::array<Index, 3>& t) {
        const std::vector<Point>& x = mesh.vertices;
        return unit(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
    };
    for (const double angle : {1.0, 10.0, 30.0, 61.0, 90.0, 120.0}) {
        std::set<std::pair<Index, Index>> expected;
        for (const std::array<Index, 3>& a : mesh.triangles) {
            for (const std::array<Index, 3>& b : mesh.triangles) {
                for (int i = 0; i < 9; ++i) {
                    const Index u = a[i / 3], v = a[(i / 3 + 1) % 3], apex = b[(i % 3 + 2) % 3];
                    if (u < v && b[i % 3] == v && b[(i % 3 + 1) % 3] == u &&
                        dot(normal_of(a), normal_of(b)) <= std::cos(angle * std::numbers::pi / 180.0) &&
                        dot(normal_of(a), mesh.vertices[apex] - mesh.vertices[u]) < 0.0) {
                        expected.insert({u, v});
                    }
                }
            }
        }
        std::set<std::pair<Index, Index>> found;
        const std::vector<SharpEdge> edges = solid->sharp_edges(angle).value();
        for (const SharpEdge& edge : edges) {
            std::array<Index, 2> ends{};
            for (int k = 0; k < 2; ++k) {
                ends[k] = static_cast<Index>(std::ranges::find(mesh.vertices, edge.ends[k]) - mesh.vertices.begin());
            }
            found.insert(std::minmax(ends[0], ends[1]));
        }
        EXPECT_EQ(found, expected) << angle << " degrees, seed " << kSeed;
        EXPECT_EQ(expected.empty(), angle > 100.0);
    }
}

TEST(MeshSolid, SharpEdgesOfPartsThatOverlapOrTouchAreThoseOfTheSolid) {
    const auto length_of = [](const std::vector<TriangleMesh>& parts) {
        double length = 0.0;
        const std::vector<SharpEdge> edges = mesh_solid(together(parts))->sharp_edges(61.0).value();
        for (const auto& [ends, normals] : edges) {
            length += distance(ends[0], ends[1]);
        }
        return length;
    };
    const TriangleMesh cube = box_mesh({0, 0, 0}, {1, 1, 1});
    EXPECT_NEAR(length_of({cube, box_mesh({3, 0, 0}, {4, 1, 1})}), 24.0, 1e-9);
    EXPECT_NEAR(length_of({cube, box_mesh({1, 0, 0}, {2, 1, 1})}), 16.0, 1e-9);                // side by side
    EXPECT_NEAR(length_of({cube, box_mesh({0.25, 0.25, 1}, {0.75, 0.75, 2})}), 18.0, 1e-9);    // one on the other
    EXPECT_NEAR(length_of({cube, box_mesh({0.25, 0.25, 0.5}, {0.75, 0.75, 2})}), 18.0, 1e-4);  // stuck into it

    Random random;
    for (int trial = 0; trial < 30; ++trial) {
        SCOPED_TRACE("trial " + std::to_string(trial) + ", seed " + std::to_string(kSeed));
        const Point least{random.between(-0.5, 0.9), random.between(-0.5, 0.9), random.between(-0.5, 0.9)};
        const Point most = least + Point{random.between(0.2, 1.0), random.between(0.2, 1.0), random.between(0.2, 1.0)};
        const std::array boxes{Box{{0, 0, 0}, {1, 1, 1}}, Box{least, most}};
        double expected = 0.0;
        for (int which = 0; which < 2; ++which) {
            const Box& box = boxes[which];
            const Box& other = boxes[1 - which];
            for (double Point::*along : {&Point::x, &Point::y, &Point::z}) {
                for (int corner = 0; corner < 8; ++corner) {
                    Point start{(corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                                (corner & 4) != 0 ? box.max.z : box.min.z};
                    if (start.*along != box.min.*along) {
                        continue;
                    }
                    expected += box.max.*along - box.min.*along;
                    const double first = std::max(box.min.*along, other.min.*along);
                    const double last = std::min(box.max.*along, other.max.*along);
                    start.*along = 0.5 * (first + last);
                    expected -= last > first && other.contains(start) ? last - first : 0.0;
                }
            }
        }
        EXPECT_NEAR(length_of({cube, box_mesh(least, most)}), expected, 1e-3);
    }
}

TEST(MeshSolid, RefusesWhatBoundsNoSolid) {
    RepairedMesh open{sphere_mesh({0, 0, 0}, 1.0, 1), {}};
    open.report.fault = {"mesh.open", "3 edges have no neighbour"};
    try {
        mesh_solid(open);
        FAIL() << "an open mesh was taken";
    } catch (const UnusableInput& error) {
        EXPECT_STREQ(error.what(), "3 edges have no neighbour");
    }
    EXPECT_THROW(mesh_solid(RepairedMesh{}), UnusableInput);
    EXPECT_THROW(mesh_solid(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), UnusableInput);
    EXPECT_THROW(solid_of(sphere_mesh({0, 0, 0}, 1.0, 1))->seeds(1e-7, 1, {}), InvalidOption);
}

TEST(MeshSolid, RepairsAPlainMeshFirst) {
    TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1}, 2);
    std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
    mesh.vertices.push_back({9, 9, 9});
    const auto solid = mesh_solid(mesh);
    EXPECT_EQ(solid->bounds().max, (Point{1, 1, 1}));
    EXPECT_TRUE(solid->inside({0.5, 0.5, 0.5}));
    EXPECT_EQ(solid->topology(), (Topology{1, 1, 0, 0}));
}

TEST(MeshSolid, HandsOverWhatWasRepaired) {
    const TriangleMesh unit = box_mesh({0, 0, 0}, {1, 1, 1});
    EXPECT_TRUE(mesh_solid(unit)->warnings().empty());
    TriangleMesh overlapping = together({unit, moved(unit, {0.5, 0.3, 0.2})});
    overlapping.vertices.push_back({9, 9, 9});
    const auto solid = mesh_solid(overlapping);
    const std::vector<Diagnostic> warnings = solid->warnings();
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_EQ(warnings[0].code, "mesh.isolated_vertices");
    EXPECT_EQ(warnings[1].code, "mesh.self_intersections");
    EXPECT_EQ(warnings[1].message, repair(overlapping).report.warnings()[1].message);
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.1)});
    ASSERT_GE(axis.warnings.size(), 2U);
    EXPECT_EQ(axis.warnings[1].message, warnings[1].message);
}

TEST(MeshSolid, TakesArraysOfTheCallers) {
    const TriangleMesh mesh = sphere_mesh({0, 0, 0}, 1.0, 3);
    const MeshView view{mesh.vertices, mesh.triangles};
    EXPECT_EQ(repair(view).mesh.triangles, repair(mesh).mesh.triangles);
    EXPECT_EQ(mesh_solid(view)->seeds(0.1, 1, {}), mesh_solid(mesh)->seeds(0.1, 1, {}));
}

// Boxes that share a face are one box: as many samples, and as many sheets of the axis.
TEST(MeshSolid, PartsThatShareAFaceAreOne) {
    const ScaleAxisOptions options{.delta = Length::relative(0.03)};
    const ScaleAxis whole = scale_axis(*mesh_solid(box_mesh({0, 0, 0}, {2, 1, 1})), options);
    const TriangleMesh half = box_mesh({0, 0, 0}, {1, 1, 1});
    const std::vector<NamedMesh> cases{
        {"divided in the same way", together({half, moved(half, {1, 0, 0})})},
        {"divided in another way", together({half, box_mesh({1, 0, 0}, {2, 1, 1}, 3)})},
        {"askew", askew(together({half, box_mesh({1, 0, 0}, {2, 1, 1}, 5)}))},
    };
    for (const NamedMesh& named : cases) {
        const ScaleAxis axis = scale_axis(*mesh_solid(named.mesh), options);
        EXPECT_LT(axis.samples, 1.1 * whole.samples) << named.name;
        EXPECT_EQ(axis.axes.at(0).medial_statistics.dual_complex, (Topology{1, 1, 0, 0})) << named.name;
        // Seeds on a face that rounding has opened are samples without facets: then the topology stays unknown.
        EXPECT_EQ(axis.solid_topology.value_or(Topology{1, 1, 0, 0}), (Topology{1, 1, 0, 0})) << named.name;
        EXPECT_LE(axis.axes.at(0).complex.sheets, whole.axes.at(0).complex.sheets + 20) << named.name;
    }
}

// As assemblies in a file of STL: rounding leaves gaps and overlaps of some 1e-7 between the parts, which made hundreds
// of tunnels, and of boxes with all corners of the face in common two solids.
TEST(MeshSolid, PartsThatShareAFaceAreOneInSinglePrecision) {
    const TriangleMesh half = box_mesh({0, 0, 0}, {1, 1, 1});
    const std::vector<NamedMesh> cases{
        {"halves", together({half, moved(half, {1, 0, 0})})},
        {"a tower", together({box_mesh({0, 0, 0}, {3, 3, 1}), box_mesh({0.5, 0.5, 1}, {2.5, 2.5, 2}),
                              box_mesh({1, 1.2, 2}, {1.5, 2, 3})})},
        {"side by side", together({half, moved(half, {1, 0.4, 0.3})})},
    };
    for (const NamedMesh& named : cases) {
        for (const double angle : {0.5, 1.0, 2.0, 2.5}) {
            TriangleMesh mesh = named.mesh;
            for (Point& p : mesh.vertices) {
                const double c = std::cos(angle), s = std::sin(angle);
                p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
                p = {static_cast<float>(p.x), static_cast<float>(c * p.y - s * p.z),
                     static_cast<float>(s * p.y + c * p.z)};
            }
            const ScaleAxis axis = scale_axis(*mesh_solid(mesh), {.delta = Length::relative(0.03), .scales = {1.0}});
            EXPECT_EQ(axis.axes.at(0).medial_statistics.dual_complex, (Topology{1, 1, 0, 0})) << named.name << angle;
            EXPECT_EQ(axis.solid_topology.value_or(Topology{1, 1, 0, 0}), (Topology{1, 1, 0, 0})) << named.name;
        }
    }
}

TEST(MeshSolid, ReportsProgressAndStops) {
    const TriangleMesh mesh = together({sphere_mesh({0, 0, 0}, 1.0, 4), sphere_mesh({1, 0, 0}, 1.0, 4)});
    expect_progress_and_cancellation([&](const Execution& execution) { repair(mesh, execution); });
    expect_progress_and_cancellation([&](const Execution& execution) { mesh_solid(mesh, execution); });
}

}  // namespace
}  // namespace scaleaxis
