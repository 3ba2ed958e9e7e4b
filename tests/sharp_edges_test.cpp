// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sharp_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "axis/edit/remainder.hpp"
#include "base/disjoint_sets.hpp"
#include "base/vectors.hpp"
#include "complexes.hpp"
#include "homology.hpp"
#include "images.hpp"
#include "meshes.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/shrinking.hpp"
#include "scaleaxis/smoothing.hpp"
#include "scaleaxis/union_mesh.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

std::vector<Point> zero_balls(const MedialComplex& complex) {
    std::vector<Point> points;
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        if (complex.radii[v] == 0.0) {
            EXPECT_EQ(complex.vertex_origins[v].kind, VertexKind::kSharpEdge);
            points.push_back(complex.vertices[v]);
        }
    }
    return points;
}

/// Sheets of more than a handful of faces: beside a corner a crumb may be left where two seams end.
Index sheets_without_crumbs(const MedialComplex& complex) {
    std::vector<Index> faces(complex.sheets);
    for (const Index sheet : complex.face_sheets) {
        ++faces[sheet];
    }
    return static_cast<Index>(std::ranges::count_if(faces, [](Index count) { return count > 10; }));
}

double length_of(std::span<const Segment> segments) {
    double sum = 0.0;
    for (const auto& [a, b] : segments) {
        sum += distance(a, b);
    }
    return sum;
}

AxisAtScale axis_of(const Solid& solid, double scale = 1.1, double delta = 0.02, Sizing sizing = Sizing::kAdaptive) {
    ScaleAxis axis = scale_axis(solid, {.delta = Length::relative(delta), .scales = {scale}, .sizing = sizing});
    AxisAtScale result = std::move(axis.axes[0]);
    expect_consistent(result.complex);
    EXPECT_TRUE(agree(result.filter_statistics.topology, result.clean_statistics->topology));
    return result;
}

/// All balls of radius 0 lie on the edges, and nearly all of the edges are reached.
void expect_reached(const AxisAtScale& axis, std::span<const Segment> edges, double tolerance, double part) {
    const std::vector<Point> points = zero_balls(axis.complex);
    EXPECT_GT(points.size(), edges.size());
    for (const Point& p : points) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& [a, b] : edges) {
            least = std::min(least, distance_to_segment(p, a, b));
        }
        ASSERT_LE(least, tolerance) << p.x << ' ' << p.y << ' ' << p.z;
    }
    ASSERT_TRUE(axis.sharp_statistics.has_value());
    EXPECT_NEAR(axis.sharp_statistics->length, length_of(edges), (1.0 - part) * length_of(edges));
}

TEST(SharpEdges, OfABoxAreAllReachedAndItHas13Sheets) {
    const std::vector<std::array<double, 2>> rectangle{{0.0, 0.0}, {3.0, 0.0}, {3.0, 2.0}, {0.0, 2.0}};
    for (const double scale : {1.0, 1.1}) {
        for (const double delta : {0.01, 0.02}) {
            SCOPED_TRACE(scale);
            SCOPED_TRACE(delta);
            const AxisAtScale axis = axis_of(*mesh_solid(prism(rectangle, 1.0)), scale, delta);
            EXPECT_EQ(axis.complex.sheets, 13);
            EXPECT_EQ(axis.sharp_statistics->corners, 8);
            expect_reached(axis, convex_edges(rectangle, 1.0), 1e-9, 0.999);
            const std::vector<Point> points = zero_balls(axis.complex);
            for (const auto& [x, y] : rectangle) {
                for (const double z : {0.0, 1.0}) {
                    const auto is_corner = [corner = Point{x, y, z}](const Point& p) {
                        return distance(p, corner) <= 1e-9;
                    };
                    EXPECT_EQ(std::ranges::count_if(points, is_corner), 1);
                }
            }
        }
    }
}

// The sheets into the edges of a hexagonal prism have the default angle of the filter exactly, those into the edges of
// a chamfer 22.5 degrees: all of them go, in any position and at any scale.
TEST(SharpEdges, WhoseSheetsAreNarrowLoseAllOfThem) {
    std::vector<std::array<double, 2>> hexagon;
    for (int k = 0; k < 6; ++k) {
        const double at = k * std::numbers::pi / 3.0;
        hexagon.push_back({2.0 * std::cos(at), 2.0 * std::sin(at)});
    }
    const std::vector<std::array<double, 2>> chamfered{{0.6, 0}, {9.4, 0}, {10, 0.6}, {10, 5.4},
                                                       {9.4, 6}, {0.6, 6}, {0, 5.4},  {0, 0.6}};
    for (const double angle : {0.0, 0.7, 2.1}) {
        for (const double scale : {1.0, 1.1}) {
            SCOPED_TRACE(std::to_string(angle) + ", s = " + std::to_string(scale));
            // Two cones over the caps, and the middle plane: three sheets more where these meet.
            const AxisAtScale prismatic = axis_of(*mesh_solid(moved(prism(hexagon, 1.0), turn(angle))), scale, 0.01);
            EXPECT_EQ(prismatic.complex.sheets, 3);
            EXPECT_NEAR(prismatic.sharp_statistics->known, 24.0, 1e-6);
            const AxisAtScale box = axis_of(*mesh_solid(moved(prism(chamfered, 4.0), turn(angle))), scale, 0.01);
            EXPECT_EQ(box.complex.sheets, 7);
            ASSERT_TRUE(box.narrow_statistics.has_value());
            EXPECT_TRUE(agree(box.narrow_statistics->topology, box.filter_statistics.topology));
        }
    }
}

std::size_t free_ends(const MedialComplex& complex) {
    const Remainder all(complex);
    return indices_where(complex.vertices.size(), [&](Index v) { return all.only_bare_edge(v) != kNone; }).size();
}

// Bars with a round end, whose lengthwise edges are too blunt for sheets. What is left of a bar is a curve: at its flat
// end it meets the sheet into the rim, its round end is at the origin.
TEST(SharpEdges, TooBluntForSheetsLeaveTheCurveOfABar) {
    std::vector<std::array<double, 2>> profile{{0.0, -1.0}};
    for (int k = 1; k <= 12; ++k) {
        const double at = k * std::numbers::pi / 24.0;
        profile.push_back({std::sin(at), -std::cos(at)});
    }
    profile.push_back({1.0, 5.0});
    profile.push_back({0.0, 5.0});
    for (const int sides : {6, 7, 8, 12}) {
        for (const double angle : {0.0, 0.7}) {
            for (const double scale : {1.0, 1.1}) {
                SCOPED_TRACE(std::to_string(sides) + " sides, turned by " + std::to_string(angle) +
                             ", s = " + std::to_string(scale));
                const TriangleMesh mesh = moved(revolved_mesh(profile, sides, 10.0), turn(angle));
                const MedialComplex axis = axis_of(*mesh_solid(mesh), scale, 0.01).complex;
                EXPECT_EQ(axis.sheets, 1);
                EXPECT_EQ(topology(axis), known_topology(1, 0, 0));
                if (scale == 1.0) {  // growing leaves ways down to single edges
                    EXPECT_EQ(free_ends(axis), 1U) << "the curve has hairs";
                }
                const Point nearest =
                    *std::ranges::min_element(axis.vertices, {}, [](const Point& p) { return norm(p); });
                EXPECT_LE(norm(nearest), 0.2);
            }
        }
    }
}

// Where four sheets meet in a seam those of a union meet by threes, two by two: between them slivers may be left, which
// count as sheets. `known` is how many sheets come out today of uniform samples, the true number is that without
// crumbs.
void expect_few_slivers(const TriangleMesh& mesh, double angle, Index truth, Index known) {
    SCOPED_TRACE("turned by " + std::to_string(angle));
    const std::unique_ptr<Solid> solid = mesh_solid(moved(mesh, turn(angle)));
    EXPECT_NEAR(sheets_without_crumbs(axis_of(*solid, 1.0, 0.01).complex), truth, 1);
    const AxisAtScale axis = axis_of(*solid, 1.0, 0.01, Sizing::kUniform);
    EXPECT_EQ(sheets_without_crumbs(axis.complex), truth);
    EXPECT_GE(axis.complex.sheets, truth);
    EXPECT_LE(axis.complex.sheets, known);
}

TriangleMesh square_bar(double length) { return box_mesh({0, 0, 0}, {1, 1, length}); }

TriangleMesh square_ring() { return revolved_mesh({{3.0, 0.0}, {4.0, 0.0}, {4.0, 1.0}, {3.0, 1.0}}, 96, 1.0); }

TEST(SharpEdges, OfSquareBarsAndRingsLeaveFewSliversInTheirSeams) {
    expect_few_slivers(square_bar(1.0), 0.0, 12, 17);
    expect_few_slivers(square_bar(3.0), 0.0, 12, 16);
    expect_few_slivers(square_bar(10.0), 0.0, 12, 15);
    expect_few_slivers(square_ring(), 0.0, 4, 10);
}

TEST(SharpEdgesSweep, OfTurnedSquareBarsAndRingsLeaveFewSliversInTheirSeams) {
    expect_few_slivers(square_bar(1.0), 0.5, 12, 12);
    expect_few_slivers(square_bar(1.0), 2.0, 12, 12);
    expect_few_slivers(square_bar(3.0), 0.5, 12, 14);
    expect_few_slivers(square_bar(3.0), 2.0, 12, 13);
    expect_few_slivers(square_bar(10.0), 0.5, 12, 14);
    expect_few_slivers(square_bar(10.0), 2.0, 12, 15);
    expect_few_slivers(square_ring(), 0.5, 4, 5);
    expect_few_slivers(square_ring(), 2.0, 4, 10);
}

TEST(SharpEdges, OfBarsPyramidsAndOctahedraGiveTheSameSheetsInAnyPosition) {
    const TriangleMesh pyramid{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1.6}},
                               {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
    const TriangleMesh octahedron{
        {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
        {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}}};
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Similarity turned = random_turn(random);
        EXPECT_EQ(axis_of(*mesh_solid(moved(square_bar(5.0), turned)), 1.1, 0.01).complex.sheets, 12);
        EXPECT_EQ(axis_of(*mesh_solid(moved(pyramid, turned)), 1.1, 0.01).complex.sheets, 8);
        EXPECT_EQ(axis_of(*mesh_solid(moved(octahedron, turned)), 1.1, 0.01).complex.sheets, 12);
    }
}

TEST(SharpEdges, OfAPyramidLeaveNoCrumbThatFindsRoomLate) {
    // Turned so that a crumb in its axis is still between common neighbors when others beside it have gone.
    const TriangleMesh pyramid{{{-1.2884783349459006, -0.05179611731905309, -0.5806382200697009},
                                {-0.17744999201027079, -1.306922019424722, 0.5103590260575013},
                                {-0.6282268022550541, 0.6084966455724321, 1.3397996094750262},
                                {1.2884783349459006, 0.05179611731905309, 0.5806382200697009},
                                {0.17744999201027079, 1.306922019424722, -0.5103590260575013}},
                               {{0, 1, 2}, {1, 3, 2}, {0, 2, 4}, {4, 2, 3}, {4, 3, 1}, {4, 1, 0}}};
    EXPECT_EQ(axis_of(*mesh_solid(pyramid), 1.1, 0.01).complex.sheets, 8);
}

/// Faces that go around, with four corners in each row of vertices: between one row and the next.
TriangleMesh rings(std::vector<Point> rows, std::span<const std::array<Index, 2>> neighbors) {
    TriangleMesh mesh{std::move(rows), {}};
    for (const auto& [from, to] : neighbors) {
        for (Index k = 0; k < 4; ++k) {
            const Index a = 4 * from + k;
            const Index b = 4 * from + (k + 1) % 4;
            const Index c = 4 * to + (k + 1) % 4;
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, 4 * to + k}});
        }
    }
    return mesh;
}

void add_rectangle(double x, double y, double z, std::vector<Point>& rows) {
    rows.insert(rows.end(), {{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}});
}

// In the corners of a frame of square bars, where the inner edge is farther away than the faces, the middle planes of
// the bars are left: triangles with an arc for a side, 1.8 tolerances wide. They are no slivers.
TEST(SharpEdges, OfAFrameOfSquareBarsLeaveTheSheetsInItsCorners) {
    std::vector<Point> rows;
    for (const double half : {3.0, 2.0}) {
        add_rectangle(half, half, 0.0, rows);
        add_rectangle(half, half, 1.0, rows);
    }
    const TriangleMesh frame = rings(rows, std::array<std::array<Index, 2>, 4>{{{0, 1}, {3, 2}, {1, 3}, {2, 0}}});
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        EXPECT_EQ(axis_of(*mesh_solid(moved(frame, random_turn(random))), 1.1, 0.01).complex.sheets, 18);
    }
}

// Below the ends of a rib's edges their sheets become narrow, and go on down to the middle of the plate all the same.
TEST(SharpEdges, OfARibGoOnBelowItsFeet) {
    std::vector<Point> rows;
    add_rectangle(30.0, 20.0, 0.0, rows);
    add_rectangle(30.0, 20.0, 3.0, rows);
    add_rectangle(20.0, 1.25, 3.0, rows);
    add_rectangle(20.0, 1.25, 12.0, rows);
    TriangleMesh rib = rings(rows, std::array<std::array<Index, 2>, 3>{{{0, 1}, {1, 2}, {2, 3}}});
    rib.triangles.insert(rib.triangles.end(), {{0, 2, 1}, {0, 3, 2}, {12, 13, 14}, {12, 14, 15}});
    for (std::uint64_t seed = 11; seed <= 18; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const TriangleMesh turned = moved(rib, random_turn(random));
        EXPECT_EQ(axis_of(*mesh_solid(turned), 1.1, 0.01).complex.sheets, 22);
        EXPECT_EQ(axis_of(*mesh_solid(turned), 1.1, 0.02).complex.sheets, 22);
    }
}

// A wing: each of its ends has one edge, from the trailing corner around and back to it (NACA 0015, closed).
TEST(SharpEdges, AroundAWingAreReachedFromTheirOnlyCorner) {
    std::vector<std::array<double, 2>> profile;
    constexpr int kSides = 116;
    for (int k = 0; k < kSides; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kSides;
        const double t = 0.5 * (1.0 + std::cos(angle));
        const double half = 0.2969 * std::sqrt(t) - t * (0.126 + t * (0.3516 - t * (0.2843 - 0.1036 * t)));
        profile.push_back({10.0 * t, (angle < std::numbers::pi ? 7.5 : -7.5) * half});
    }
    const TriangleMesh wing = prism(profile, 20.0);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const AxisAtScale axis = axis_of(*mesh_solid(moved(wing, random_turn(random))), 1.1, 0.01);
        EXPECT_EQ(axis.complex.sheets, 3);
        EXPECT_NEAR(axis.sharp_statistics->length, axis.sharp_statistics->known, 1e-3);
    }
}

// Beside an acute corner the face of a short edge is narrow.
TEST(SharpEdges, OfBarbsAreReachedThoughShort) {
    const TriangleMesh arrow = prism({{9, 2}, {6, 4}, {6, 3}, {0, 3}, {0, 1}, {6, 1}, {6, 0}}, 10.0);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const TriangleMesh turned = moved(arrow, random_turn(random));
        EXPECT_EQ(axis_of(*mesh_solid(turned), 1.1, 0.01).complex.sheets, 16);
        EXPECT_EQ(axis_of(*mesh_solid(turned), 1.1, 0.02).complex.sheets, 16);
    }
}

TEST(SharpEdges, OfAThinPlateAreReachedAcrossGaps) {
    // 3.5 tolerances thick: beside its rims the balls make a sheet to one edge or to the other, here and there to both.
    const std::vector<std::array<double, 2>> square{{0.0, 0.0}, {20.0, 0.0}, {20.0, 20.0}, {0.0, 20.0}};
    for (const Sizing sizing : {Sizing::kUniform, Sizing::kAdaptive}) {
        const AxisAtScale axis = axis_of(*mesh_solid(prism(square, 1.0)), 1.1, 0.01, sizing);
        EXPECT_LE(axis.complex.sheets, sizing == Sizing::kUniform ? 13 : 15);
        EXPECT_EQ(axis.sharp_statistics->corners, 8);
        expect_reached(axis, convex_edges(square, 1.0), 1e-9, 0.999);
    }
}

TEST(SharpEdges, TurnMoveAndScaleWithTheShape) {
    const std::vector<std::array<double, 2>> rectangle{{0.0, 0.0}, {3.0, 0.0}, {3.0, 2.0}, {0.0, 2.0}};
    Similarity all = turn(0.7);
    all.scale = 1e-3;
    all.translation = {0.01, -0.02, 0.03};
    for (const Similarity& similarity : {turn(0.5), turn(2.0), enlargement(1e6), all}) {
        const AxisAtScale axis = axis_of(*mesh_solid(moved(prism(rectangle, 1.0), similarity)));
        std::vector<Segment> edges = convex_edges(rectangle, 1.0);
        for (auto& [a, b] : edges) {
            a = similarity(a);
            b = similarity(b);
        }
        EXPECT_EQ(sheets_without_crumbs(axis.complex), 13);
        EXPECT_EQ(axis.sharp_statistics->corners, 8);
        expect_reached(axis, edges, 1e-9 * similarity.scale, 0.999);
    }
}

TEST(SharpEdges, OfPrismsAndTheirCorners) {
    const double h = 0.5 * std::sqrt(3.0);
    const std::vector<std::array<double, 2>> triangle{{1.0, 0.0}, {-0.5, h}, {-0.5, -h}};
    const AxisAtScale axis = axis_of(*mesh_solid(prism(triangle, 1.2)), 1.1, 0.01);
    EXPECT_EQ(axis.complex.sheets, 9) << "the inscribed circle is smaller than half the height";
    EXPECT_EQ(axis.sharp_statistics->corners, 6);
    expect_reached(axis, convex_edges(triangle, 1.2), 1e-9, 0.99);
}

TEST(SharpEdges, ConcaveOnesGetNothing) {
    const std::vector<std::array<double, 2>> ell{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
    const AxisAtScale axis = axis_of(*mesh_solid(prism(ell, 2.0)));
    expect_reached(axis, convex_edges(ell, 2.0), 1e-9, 0.97);
    for (const Point& p : zero_balls(axis.complex)) {
        EXPECT_FALSE(distance_to_segment(p, {1.0, 1.0, 0.1}, {1.0, 1.0, 1.9}) < 1e-6);
    }
}

TEST(SharpEdges, GoOnToTheEndsOfReentrantOnes) {
    const std::vector<std::array<double, 2>> ell{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
    for (const double delta : {0.01, 0.02}) {
        SCOPED_TRACE(delta);
        const AxisAtScale axis = axis_of(*mesh_solid(prism(ell, 2.0)), 1.0, delta);
        EXPECT_EQ(axis.complex.sheets, 17);
        EXPECT_EQ(axis.sharp_statistics->corners, 10 + 2);
        expect_reached(axis, convex_edges(ell, 2.0), 1e-9, 0.9999);
        const std::vector<Point> points = zero_balls(axis.complex);
        for (const double z : {0.0, 2.0}) {
            EXPECT_TRUE(std::ranges::any_of(points, [&](const Point& p) { return distance(p, {1, 1, z}) < 1e-9; }));
        }
    }
}

TEST(SharpEdges, OfACylinderAreItsRims) {
    constexpr int kSegments = 96;
    const AxisAtScale axis = axis_of(*mesh_solid(cylinder_mesh(1.0, 0.6, kSegments)));
    EXPECT_EQ(axis.complex.sheets, 3);
    std::vector<Segment> rims;
    for (int k = 0; k < kSegments; ++k) {
        const auto at = [&](int i, double z) {
            const double angle = 2.0 * std::numbers::pi * i / kSegments;
            return Point{std::cos(angle), std::sin(angle), z};
        };
        for (const double z : {-0.6, 0.6}) {
            rims.push_back({at(k, z), at(k + 1, z)});
        }
    }
    expect_reached(axis, rims, 1e-6, 0.995);
}

/// A wheel of teeth whose tips are narrower than two tolerances of 0.01 of its diagonal.
std::vector<std::array<double, 2>> gear(int teeth) {
    std::vector<std::array<double, 2>> polygon;
    for (int i = 0; i < 4 * teeth; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + 0.5) / (4 * teeth);
        const double radius = i % 4 < 2 ? 20.0 : 24.0;
        polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return polygon;
}

/// A prism over a polygon around the origin, all of which is seen from there.
TriangleMesh star_prism(const std::vector<std::array<double, 2>>& polygon, double height) {
    TriangleMesh mesh = prism(polygon, height);
    const auto n = static_cast<Index>(polygon.size());
    std::erase_if(mesh.triangles, [&](const std::array<Index, 3>& t) {
        return std::ranges::all_of(t, [&](Index v) { return v < n; }) ||
               std::ranges::all_of(t, [&](Index v) { return v >= n; });
    });
    mesh.vertices.push_back({0.0, 0.0, 0.0});
    mesh.vertices.push_back({0.0, 0.0, height});
    for (Index i = 0; i < n; ++i) {
        mesh.triangles.push_back({2 * n, (i + 1) % n, i});
        mesh.triangles.push_back({2 * n + 1, n + i, n + (i + 1) % n});
    }
    return mesh;
}

TEST(SharpEdges, OfNarrowTeethAreReachedFromTheEdgesTheMeshKnows) {
    const std::vector<std::array<double, 2>> polygon = gear(30);
    for (const double scale : {1.0, 1.1}) {
        SCOPED_TRACE(scale);
        const AxisAtScale axis = axis_of(*mesh_solid(star_prism(polygon, 8.0)), scale, 0.01);
        const std::vector<Segment> edges = convex_edges(polygon, 8.0);
        expect_reached(axis, edges, 1e-9, 0.99);
        EXPECT_GT(axis.sharp_statistics->corners, 150) << "of 240 ends of convex edges";
        EXPECT_NEAR(axis.sharp_statistics->known, length_of(edges), 1e-6);
    }
}

TEST(SharpEdgesSweep, OfNarrowTeethLeaveNoSpecksInMeshes) {
    const std::unique_ptr<Solid> solid = mesh_solid(star_prism(gear(24), 8.0));
    const ScaleAxis axis =
        scale_axis(*solid, {.delta = Length::relative(0.01), .scales = {1.1}, .compact = CompactOptions()});
    const UnionMesh mesh = envelope_mesh(Envelope(axis.axes[0].complex), {.delta = Length::absolute(axis.tolerance)});
    EXPECT_EQ(mesh.report.euler, 2);
    EXPECT_EQ(mesh.report.components, 1);
    EXPECT_EQ(mesh.tolerance, axis.tolerance);
}

// However fine their mesh is: facets wider than the tolerance are plane across from the edge.
TEST(SharpEdges, OfRoundFacesAreReached) {
    constexpr int kParts = 150;
    std::vector<std::array<double, 2>> lens;  // of two arcs of radius 10
    for (const double side : {1.0, -1.0}) {
        for (int k = 0; k < kParts; ++k) {
            const double turn = (2.0 * k / kParts - 1.0) * std::acos(0.6);
            lens.push_back({side * (10.0 * std::cos(turn) - 6.0), side * 10.0 * std::sin(turn)});
        }
    }
    const std::unique_ptr<Solid> solid = mesh_solid(prism(lens, 30.0));
    for (const double delta : {0.02, 0.01}) {
        const AxisAtScale axis = axis_of(*solid, 1.1, delta);
        EXPECT_EQ(axis.complex.sheets, 5) << delta;
        EXPECT_NEAR(axis.sharp_statistics->length, axis.sharp_statistics->known, 1e-3 * axis.sharp_statistics->known);
        EXPECT_NEAR(axis.sharp_statistics->known, length_of(convex_edges(lens, 0.0)) + 60.0, 0.1) << delta;
    }
}

TEST(SharpEdges, OfHolesAreClosedLines) {
    // A ring: its four rims have no corners.
    constexpr int kSegments = 64;
    const TriangleMesh ring = revolved_mesh({{1.0, 0.0}, {2.0, 0.0}, {2.0, 0.4}, {1.0, 0.4}}, kSegments, 1.0);
    const AxisAtScale axis = axis_of(*mesh_solid(ring), 1.0, 0.02);
    EXPECT_EQ(axis.sharp_statistics->corners, 0);
    const double length = 2.0 * kSegments * 2.0 * std::sin(std::numbers::pi / kSegments) * (1.0 + 2.0);
    EXPECT_NEAR(axis.sharp_statistics->length, length, 0.02 * length);
    EXPECT_EQ(axis.complex.sheets, 5);
}

TEST(SharpEdges, OfCountersinksAreReachedThoughNoRowSeesThem) {
    constexpr int kSegments = 32;
    const TriangleMesh washer =
        revolved_mesh({{0.1, 0.0}, {1.0, 0.0}, {1.0, 0.3}, {0.3, 0.3}, {0.1, 0.2}}, kSegments, 1.0);
    const AxisAtScale axis = axis_of(*mesh_solid(washer), 1.1, 0.02, Sizing::kUniform);
    EXPECT_GE(axis.sharp_statistics->length, 0.99 * axis.sharp_statistics->known);
    EXPECT_EQ(axis.sharp_statistics->corners, 0) << "where rims are cut there are none";
    EXPECT_EQ(axis.complex.sheets, 5);
}

// Where facets of a rim meet, rows see a place beside the rim. A flange has 7 sheets: one to each of its five rims, and
// two between those. `known` is how many come out today of uniform samples: strips beside two facets of a rim are cut
// off here and there.
void expect_one_strip_each(int segments, Index known) {
    SCOPED_TRACE(std::to_string(segments) + " segments");
    const TriangleMesh flange =
        revolved_mesh({{1.0, 0.0}, {3.0, 0.0}, {3.0, 0.25}, {1.5, 0.25}, {1.5, 1.5}, {1.0, 1.5}}, segments, 1.0);
    const AxisAtScale axis = axis_of(*mesh_solid(flange), 1.1, 0.01, Sizing::kUniform);
    const double length = 2.0 * segments * std::sin(std::numbers::pi / segments) * (1.0 + 3.0 + 3.0 + 1.5 + 1.0);
    EXPECT_NEAR(axis.sharp_statistics->known, length, 1e-6);
    EXPECT_NEAR(axis.sharp_statistics->length, length, 1e-3 * length);
    EXPECT_EQ(axis.sharp_statistics->corners, 0);
    EXPECT_GE(axis.complex.sheets, 7);
    EXPECT_LE(axis.complex.sheets, known);
}

TEST(SharpEdges, GetOneStripEach) {
    expect_one_strip_each(20, 7);
    expect_one_strip_each(36, 9);
}

TEST(SharpEdgesSweep, GetOneStripEach) {
    for (const auto& [segments, known] :
         {std::pair(24, 8), std::pair(28, 8), std::pair(32, 8), std::pair(40, 7), std::pair(44, 8), std::pair(48, 8)}) {
        expect_one_strip_each(segments, known);
    }
}

void expect_prisms_keep_the_homotopy_type(std::uint64_t first_seed, std::uint64_t last_seed) {
    for (std::uint64_t seed = first_seed; seed <= last_seed; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        std::vector<std::array<double, 2>> polygon;
        const int corners = 6 + static_cast<int>(uniform(random, 0.0, 18.0));
        for (int i = 0; i < corners; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / corners;
            const double radius = uniform(random, 0.7, 1.3);
            polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
        }
        const std::unique_ptr<Solid> solid = mesh_solid(star_prism(polygon, uniform(random, 0.1, 1.0)));
        const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.02), .scales = {1.0, 1.1, 1.3}});
        for (const AxisAtScale& at : axis.axes) {
            SCOPED_TRACE(at.complex.scale);
            expect_consistent(at.complex);
            EXPECT_EQ(at.sharp_statistics->topology, at.filter_statistics.topology);
            EXPECT_EQ(topology(at.complex), at.filter_statistics.topology);
        }
    }
}

TEST(SharpEdges, OfRandomPrismsKeepTheHomotopyType) { expect_prisms_keep_the_homotopy_type(1, 3); }

TEST(SharpEdgesSweep, OfRandomPrismsKeepTheHomotopyType) { expect_prisms_keep_the_homotopy_type(4, 12); }

TEST(SharpEdges, OfWideAnglesAreNotLookedForWhereGrowingTakesTheirSheets) {
    const std::vector<std::array<double, 2>> polygon = gear(30);
    const std::unique_ptr<Solid> solid = mesh_solid(star_prism(polygon, 8.0));
    const ScaleAxis without = scale_axis(*solid, {.delta = Length::relative(0.01),
                                                  .scales = {1.0},
                                                  .reaches_sharp_edges = false,
                                                  .cleaning = Length::relative(0.0)});
    const double tolerance = without.tolerance;
    const auto reached = [&](double scale) {
        const SharpComplex result =
            extend_to_sharp_edges(without.axes[0].complex, *solid, {.tolerance = tolerance, .scale = scale});
        EXPECT_EQ(result.statistics.topology, without.axes[0].filter_statistics.topology);
        return result.statistics.length;
    };
    // Between walls at a right angle radii grow by 0.71 of the way.
    EXPECT_EQ(reached(1.2), reached(1.0));
    EXPECT_LT(reached(1.5), 0.9 * reached(1.0));
}

TEST(SharpEdges, OfAFunctionWhoseNormalsJump) {
    const std::unique_ptr<Solid> solid = function_solid(
        [](const Point& p) {
            return std::max({std::abs(p.x) - 1.5, std::abs(p.y) - 1.0, std::abs(p.z) - 0.5});
        },
        {.bounds = {{-2.0, -1.5, -1.0}, {2.0, 1.5, 1.0}}});
    const AxisAtScale axis = axis_of(*solid);
    const std::vector<std::array<double, 2>> rectangle{{-1.5, -1.0}, {1.5, -1.0}, {1.5, 1.0}, {-1.5, 1.0}};
    std::vector<Segment> edges = convex_edges(rectangle, 1.0);
    for (auto& [a, b] : edges) {
        a.z -= 0.5;
        b.z -= 0.5;
    }
    EXPECT_EQ(axis.complex.sheets, 13);
    expect_reached(axis, edges, 1e-6, 0.99);
}

/// A solid that turns around the z axis, as a function of parts and as a mesh, and the length of its edges.
struct Turned {
    std::string name;
    ImplicitSolid::Function function;
    std::vector<std::array<double, 2>> curve;  ///< as `revolved` takes it
    double length;
};

std::vector<Turned> turned_solids() {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    std::vector<Turned> result;
    const auto square = [](double a) { return a * a; };
    const double rim = std::sqrt(1.0 - 0.3 * 0.3);
    std::vector<std::array<double, 2>> cut{{0.0, 0.3}, {rim, 0.3}};
    for (int i = 1; i < 48; ++i) {
        const double angle = (1.0 - i / 48.0) * std::acos(0.3);
        cut.push_back({std::sin(angle), std::cos(angle)});
    }
    cut.push_back({0.0, 1.0});
    for (const double factor : {1.0, 100.0, 0.01}) {
        result.push_back({"cut ball, factor " + std::to_string(factor),
                          [=](const Point& p) { return std::max(factor * (squared_norm(p) - 1.0), 0.3 - p.z); }, cut,
                          kTurn * rim});
    }
    result.push_back({"flat cone",
                      [=](const Point& p) {
                          return std::max({square(p.x) + square(p.y) - square(1.0 - p.z), -p.z, p.z - 1.0});
                      },
                      {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}},
                      kTurn});
    result.push_back(
        {"sharp cone",
         [](const Point& p) { return std::max(10.0 * (std::hypot(p.x, p.y) - 0.25 * (1.0 - p.z)), -1.0 - p.z); },
         {{0.0, -1.0}, {0.5, -1.0}, {0.0, 1.0}},
         0.5 * kTurn});
    result.push_back(
        {"cylinder",
         [=](const Point& p) { return std::max(100.0 * (square(p.x) + square(p.y) - 1.0), square(p.z) - 0.36); },
         {{0.0, -0.6}, {1.0, -0.6}, {1.0, 0.6}, {0.0, 0.6}},
         2.0 * kTurn});
    return result;
}

void expect_edges_of_functions_of_parts(double delta) {
    for (const auto& [name, function, curve, length] : turned_solids()) {
        SCOPED_TRACE(name);
        const AxisAtScale of_mesh = axis_of(*mesh_solid(revolved(curve, 128)), 1.1, delta);
        const auto solid = function_solid(function, {.bounds = centered_box(1.2, 1.2, 1.2)});
        const AxisAtScale axis = axis_of(*solid, 1.1, delta);
        EXPECT_EQ(axis.complex.sheets, of_mesh.complex.sheets);
        EXPECT_NEAR(axis.sharp_statistics->length, length, 0.005 * length);
        // Places of a traced edge are up to four tolerances apart, with straight lines between them; no rim has a
        // radius below 1/2.
        const double tolerance = delta * solid->bounds().diagonal();
        for (const Point& p : zero_balls(axis.complex)) {
            const double across = std::hypot(p.x, p.y);
            double least = std::numeric_limits<double>::infinity();
            for (const auto& [r, z] : curve) {
                least = std::min(least, std::hypot(across - r, p.z - z));
            }
            EXPECT_LE(least, 4.0 * tolerance * tolerance);
        }
    }
}

TEST(SharpEdges, OfFunctionsOfPartsAreReachedWhateverTheirSlopes) {
    expect_edges_of_functions_of_parts(0.02);
    expect_edges_of_functions_of_parts(0.01);
}

TEST(SharpEdgesSweep, OfFunctionsOfPartsAreReachedWhateverTheirSlopes) { expect_edges_of_functions_of_parts(0.005); }

TEST(SharpEdges, RoundAndNoisyShapesHaveNone) {
    const std::uint64_t seed = 1;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    TriangleMesh noisy = sphere_mesh({0.0, 0.0, 0.0}, 1.0, 4);
    for (Point& p : noisy.vertices) {
        p = (1.0 + 0.01 * (uniform(random, -0.5, 0.5))) * p;
    }
    for (const TriangleMesh& mesh :
         {noisy, sphere_mesh({0.0, 0.0, 0.0}, 1.0, 3), torus_mesh(1.0, 0.4, 40), dumbbell_mesh(0.5, 1.0, 0.2, 40)}) {
        const AxisAtScale axis = axis_of(*mesh_solid(mesh));
        EXPECT_EQ(axis.sharp_statistics->points, 0);
        EXPECT_TRUE(zero_balls(axis.complex).empty());
    }
}

TEST(SharpEdges, OfARoughImageAreNoneThatAreShorterThanTheTolerance) {
    // Waves in random directions, about five points of the grid long.
    const std::uint64_t seed = 1;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<std::pair<Point, double>> waves;
    for (int k = 0; k < 40; ++k) {
        const Point direction{uniform(random, -1.2, 1.2), uniform(random, -1.2, 1.2), uniform(random, -1.2, 1.2)};
        waves.emplace_back(direction, uniform(random, 0.0, 6.3));
    }
    const auto field = [&](const Point& p) {
        double sum = 0.0;
        for (const auto& [direction, phase] : waves) {
            sum += std::cos(dot(direction, p) + phase);
        }
        return std::max(sum, norm(p) - 9.0);
    };
    const Image image = sampled(field, {{-11.0, -11.0, -11.0}, {11.0, 11.0, 11.0}}, 23);
    const double delta = 0.5;
    const AxisAtScale axis = std::move(
        scale_axis(*image_solid(image, {0.0, true}), {.delta = Length::absolute(delta), .scales = {1.0}}).axes[0]);
    EXPECT_GT(axis.sharp_statistics->points, 0);
    DisjointSets lines(axis.complex.vertices.size());
    std::vector<double> lengths(axis.complex.vertices.size());
    for (const bool adds : {false, true}) {
        for (const auto& [a, b] : axis.complex.edges) {
            if (axis.complex.radii[a] == 0.0 && axis.complex.radii[b] == 0.0) {
                lines.join(a, b);
                lengths[lines.find(a)] += adds ? distance(axis.complex.vertices[a], axis.complex.vertices[b]) : 0.0;
            }
        }
    }
    for (const double length : lengths) {
        EXPECT_TRUE(length == 0.0 || length >= delta) << length;
    }
}

TEST(SharpEdges, CanBeLeftOut) {
    const std::unique_ptr<Solid> box = mesh_solid(box_mesh({0, 0, 0}, {3, 2, 1}));
    const ScaleAxis without = scale_axis(*box, {.delta = Length::relative(0.02), .reaches_sharp_edges = false});
    EXPECT_FALSE(without.axes[0].sharp_statistics);
    EXPECT_TRUE(zero_balls(without.axes[0].complex).empty());
    const ScaleAxis blunt = scale_axis(*box, {.delta = Length::relative(0.02), .sharp_angle = 100.0});
    EXPECT_EQ(blunt.axes[0].sharp_statistics->points, 0) << "the normals differ by 90 degrees";
    EXPECT_TRUE(same_bytes(without.axes[0].complex, blunt.axes[0].complex));
    const ScaleAxis polar = scale_axis(*box, {.delta = Length::relative(0.02), .union_kind = UnionKind::kPolar});
    EXPECT_FALSE(polar.axes[0].sharp_statistics) << "polar balls do not touch the boundary";
    EXPECT_THROW(validate(ScaleAxisOptions{.reaches_sharp_edges = false, .sharp_angle = 30.0}), InvalidOption);
    EXPECT_THROW(validate(ScaleAxisOptions{.union_kind = UnionKind::kPolar, .sharp_angle = 30.0}), InvalidOption);
    EXPECT_THROW(validate(ScaleAxisOptions{.sharp_angle = 5.0}), InvalidOption);
    const MedialComplex& complex = without.axes[0].complex;
    EXPECT_THROW(extend_to_sharp_edges(complex, *box, {.tolerance = 0.0}), InvalidOption);
    EXPECT_THROW(extend_to_sharp_edges(complex, *box, {.angle = 180.0, .tolerance = 0.1}), InvalidOption);
    EXPECT_THROW(extend_to_sharp_edges(complex, *box, {.tolerance = 0.1, .scale = 0.9}), InvalidOption);
}

void expect_polytopes_keep_the_homotopy_type(const std::vector<std::uint64_t>& seeds) {
    for (const std::uint64_t seed : seeds) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        std::vector<Point> normals;
        for (int i = 0; i < 12; ++i) {
            normals.push_back(
                unit({uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5)}));
        }
        const std::unique_ptr<Solid> solid = function_solid(
            [&](const Point& p) {
                double most = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) - 1.0;
                for (const Point& n : normals) {
                    most = std::max(most, dot(n, p) - 0.8);
                }
                return most;
            },
            {.bounds = {{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}}});
        const ScaleAxis axis =
            scale_axis(*solid, {.delta = Length::relative(seed == 25 ? 0.04 : 0.03), .scales = {1.0, 1.1, 1.3}});
        for (const AxisAtScale& at : axis.axes) {
            SCOPED_TRACE(at.complex.scale);
            expect_consistent(at.complex);
            EXPECT_EQ(at.sharp_statistics->topology, at.filter_statistics.topology);
            EXPECT_EQ(at.clean_statistics->topology, at.filter_statistics.topology);
            EXPECT_EQ(topology(at.complex), at.filter_statistics.topology);
        }
    }
}

TEST(SharpEdges, KeepTheHomotopyTypeOfRandomPolytopes) {
    // Of 11 bridges meet each other, of 25 a row meets the way to a corner.
    expect_polytopes_keep_the_homotopy_type({1, 11, 25});
}

TEST(SharpEdgesSweep, KeepTheHomotopyTypeOfRandomPolytopes) {
    expect_polytopes_keep_the_homotopy_type({2, 3, 4, 5, 6, 7, 8});
}

TEST(SharpEdges, AreTheSameForAnyThreads) {
    const std::unique_ptr<Solid> box = mesh_solid(box_mesh({0, 0, 0}, {3, 2, 1}));
    const ScaleAxisOptions options{.delta = Length::relative(0.02)};
    const ScaleAxis one = scale_axis(*box, options, {.threads = 1});
    const ScaleAxis three = scale_axis(*box, options, {.threads = 3});
    EXPECT_TRUE(same_bytes(one.axes[0].complex, three.axes[0].complex));
}

TEST(SharpEdges, LeaveNothingOfASheetBesideTheirStrips) {
    // A sheet below an edge of a cube that ends in teeth: the way is shorter below them than around them.
    const std::unique_ptr<Solid> cube = mesh_solid(box_mesh({-5, -5, -5}, {5, 5, 5}));
    constexpr Index kTeeth = 30;
    const auto at_depth = [](double depth, double y) { return Point{5.0 - depth, y, 5.0 - depth}; };
    std::vector<Point> vertices;
    std::vector<std::vector<Index>> faces;
    for (Index k = 0; k <= kTeeth; ++k) {
        const double y = 0.2 * k - 3.0;
        vertices.insert(vertices.end(), {at_depth(0.5, y), at_depth(0.4, y), at_depth(0.1, y + 0.1)});
        if (k < kTeeth) {
            const Index a = 3 * k;
            faces.insert(faces.end(), {{a, a + 1, a + 4, a + 3}, {a + 1, a + 2, a + 4}});
        }
    }
    vertices.pop_back();
    const MedialComplex teeth = with_radii(complex_by_hand(vertices, faces), [](const Point& p) { return 5.0 - p.x; });
    const SharpComplex result = extend_to_sharp_edges(teeth, *cube, {.tolerance = 0.1});
    expect_consistent(result.complex);
    EXPECT_GT(result.statistics.length, 9.0);
    EXPECT_EQ(result.complex.sheets, 1);
    EXPECT_EQ(homology(result.complex), homology(teeth));
    // The quadrangles, one triangle for each step of the way, and one for each of the line.
    EXPECT_NEAR(static_cast<double>(result.complex.faces.size()), 2 * kTeeth + 100, 10);
}

TEST(SharpEdges, BallsOfRadius0DoNotHinderWhatFollows) {
    const std::unique_ptr<Solid> box = mesh_solid(box_mesh({0, 0, 0}, {3, 2, 1}));
    const ScaleAxis axis = scale_axis(*box, {.delta = Length::relative(0.02)});
    const MedialComplex& complex = axis.axes[0].complex;
    const MedialComplex dense = densify(complex);
    expect_consistent(dense);
    EXPECT_EQ(zero_balls(dense).size(), zero_balls(complex).size());
    const std::vector<Ball> balls = balls_of(dense);
    EXPECT_TRUE(std::ranges::all_of(balls, [](const Ball& ball) { return ball.radius > 0.0; }));
    EXPECT_EQ(balls.size(), dense.vertices.size() - zero_balls(dense).size());
    const UnionMesh mesh = union_mesh(balls, {});
    EXPECT_EQ(mesh.report.euler, 2);
    const CleanedComplex again = clean(complex, {.thickness = 0.5 * axis.tolerance});
    EXPECT_EQ(again.complex.sheets, 13);
    EXPECT_EQ(zero_balls(again.complex).size(), zero_balls(complex).size());
    const MedialComplex smoothed = [&] {
        const MedialAxis medial = medial_axis(scaled(axis.balls, 1.1));
        return smooth(complex, medial.ball_union, {20});
    }();
    EXPECT_EQ(zero_balls(smoothed), zero_balls(complex));
}

}  // namespace
}  // namespace scaleaxis
