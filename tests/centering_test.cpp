// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/centering.hpp"
#include "scaleaxis/cleaning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/stages/stages.hpp"
#include "complexes.hpp"
#include "meshes.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/topology.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

/// The axis that the pipeline centers: only the last filter, afterwards, takes the whole angle.
MedialComplex axis_before(const Solid& solid, double delta, double scale) {
    return scale_axis(solid, {.delta = Length::relative(delta),
                              .scales = {scale},
                              .filter_angle = 0.93 * 30.0,
                              .sharp_angle = 61.0,
                              .is_centered = false})
        .axes[0]
        .complex;
}

double depth(const Solid& solid, const Point& p) {
    return solid.inside(p) ? distance(p, *solid.nearest(p)) : -distance(p, *solid.nearest(p));
}

/// Which vertices have a triangle that ends on a sharp edge?
std::vector<std::uint8_t> feet_of_strips(const MedialComplex& complex) {
    std::vector<std::uint8_t> result(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const auto is_on_edge = [&](Index v) { return complex.radii[v] == 0.0; };
        for (const Index v : complex.faces[f]) {
            if (std::ranges::any_of(complex.faces[f], is_on_edge)) {
                result[v] = 1;
            }
        }
    }
    return result;
}

/// The distances of a point from the sides of the box from 0 to `size`, the least one first.
std::array<double, 6> sides_of_box(const Point& p, const Point& size) {
    std::array<double, 6> result{p.x, p.y, p.z, size.x - p.x, size.y - p.y, size.z - p.z};
    std::ranges::sort(result);
    return result;
}

TEST(Centering, BringsTheAxisOfABoxToItsMiddle) {
    const Point size{3.0, 2.0, 1.0};
    const std::unique_ptr<Solid> box = mesh_solid(box_mesh({0, 0, 0}, size));
    const double tolerance = 0.02 * norm(size);
    for (const double scale : {1.0, 1.1}) {
        SCOPED_TRACE(scale);
        const ScaleAxis axis = scale_axis(*box, {.delta = Length::relative(0.02), .scales = {scale}});
        const MedialComplex& complex = axis.axes[0].complex;
        std::size_t in_middle = 0;
        for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
            const auto sides = sides_of_box(complex.vertices[v], size);
            EXPECT_NEAR(complex.radii[v], std::max(0.0, sides[0]), 1e-9);
            EXPECT_LT(sides[1] - sides[0], 0.2 * tolerance);
            in_middle += sides[1] - sides[0] < 1e-6 ? 1 : 0;
        }
        EXPECT_GT(static_cast<double>(in_middle), 0.95 * static_cast<double>(complex.vertices.size()));
        EXPECT_GT(axis.axes[0].center_statistics->mean_growth, 0.0);
        double area = 0.0;
        double wrong = 0.0;  // of the faces whose object angle is neither 45 nor 90 degrees
        for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
            const double angle = complex.face_angles[f];
            area += face_area(complex, f);
            wrong += std::min(std::abs(angle - 45.0), 90.0 - angle) > 1.0 ? face_area(complex, f) : 0.0;
        }
        EXPECT_LT(wrong, 0.02 * area);
        EXPECT_LE(axis.axes[0].center_statistics->largest_move, tolerance);
    }
}

TEST(Centering, MakesCompactAxesOfPlaneFacesAlmostExact) {
    const std::unique_ptr<Solid> ell = mesh_solid(prism({{0, 0}, {20, 0}, {20, 2}, {2, 2}, {2, 20}, {0, 20}}, 10.0));
    const ScaleAxis axis =
        scale_axis(*ell, {.delta = Length::relative(0.01), .scales = {1.0}, .compact = CompactOptions()});
    EXPECT_LE(axis.axes[0].complex.vertices.size(), 100U);
    EXPECT_LT(axis.axes[0].accuracy->mean_solid_to_envelope, 0.003 * axis.tolerance);
    EXPECT_LT(*axis.axes[0].accuracy->mean_envelope_to_solid, 0.003 * axis.tolerance);
    // Beside the re-entrant edge a sheet may end early.
    EXPECT_LT(axis.axes[0].accuracy->solid_to_envelope, 0.3 * axis.tolerance);
    EXPECT_LT(*axis.axes[0].accuracy->envelope_to_solid, 0.3 * axis.tolerance);
}

TEST(Centering, MakesCompactBoxesExact) {
    const std::unique_ptr<Solid> box = mesh_solid(box_mesh({0, 0, 0}, {3, 2, 1}));
    for (const double scale : {1.0, 1.1}) {
        SCOPED_TRACE(scale);
        const ScaleAxis axis =
            scale_axis(*box, {.delta = Length::relative(0.02), .scales = {scale}, .compact = CompactOptions()});
        EXPECT_LE(axis.axes[0].complex.vertices.size(), 60U);
        EXPECT_LT(axis.axes[0].accuracy->solid_to_envelope, 0.02 * axis.tolerance);
        EXPECT_LT(*axis.axes[0].accuracy->envelope_to_solid, 0.02 * axis.tolerance);
    }
}

TEST(Centering, BallsOfRandomSolidsTouchTheirBoundary) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        TriangleMesh mesh = seed % 2 == 0 ? torus_mesh(1.0, 0.4, 24, 16) : dumbbell_mesh(0.5, 1.0, 0.2, 20);
        for (Point& p : mesh.vertices) {
            p = p + 0.03 * Point{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
        }
        const std::unique_ptr<Solid> solid = mesh_solid(mesh);
        const double tolerance = 0.02 * solid->bounds().diagonal();
        for (const double scale : {1.0, 1.2}) {
            const MedialComplex before = axis_before(*solid, 0.02, scale);
            const CenteredComplex centered = center(before, *solid, {.tolerance = tolerance});
            const MedialComplex& after = centered.complex;
            const MedialComplex wide =
                filter(contract_slivers(after, tolerance), {.measure = SheetAngle::kByArea}).complex;
            EXPECT_TRUE(same_bytes(
                wide, scale_axis(*solid, {.delta = Length::relative(0.02), .scales = {scale}}).axes[0].complex));
            EXPECT_EQ(topology(before), topology(after));
            EXPECT_EQ(after.vertices.size() - before.vertices.size(), centered.statistics.halved);
            EXPECT_EQ(before.edges == after.edges && before.faces.items == after.faces.items,
                      centered.statistics.halved == 0);
            Index fitted = 0;
            Index touching = 0;
            const std::vector<std::uint8_t> is_foot = feet_of_strips(before);
            for (std::size_t v = 0; v < before.vertices.size(); ++v) {
                EXPECT_LE(distance(before.vertices[v], after.vertices[v]), tolerance);
                EXPECT_GE(after.radii[v], before.radii[v] - (is_foot[v] != 0 ? 1.1 : 0.1) * tolerance);
                if (before.radii[v] > 0.0 && is_linear(after.vertex_origins[v]) && after.radii[v] != before.radii[v]) {
                    EXPECT_NEAR(after.radii[v], depth(*solid, after.vertices[v]), 1e-9);
                    ++fitted;
                }
                touching +=
                    std::abs(after.radii[v] - depth(*solid, after.vertices[v])) < kDefaultSlack * tolerance ? 1 : 0;
            }
            EXPECT_GT(static_cast<double>(touching), 0.7 * static_cast<double>(before.vertices.size()));
            EXPECT_GT(fitted, 0);
            EXPECT_GE(centered.statistics.fitted, fitted);
            EXPECT_GT(centered.statistics.moved, 0);
        }
    }
}

TEST(Centering, HalvesEdgesBesideSharpOnesWhereTheSolidTurns) {
    // Where a re-entrant edge ends between two convex ones the axis is a cone.
    const std::unique_ptr<Solid> ell = mesh_solid(prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 2.0));
    const double tolerance = 0.02 * ell->bounds().diagonal();
    const CenteredComplex result = center(axis_before(*ell, 0.02, 1.0), *ell, {.tolerance = tolerance});
    EXPECT_GT(result.statistics.halved, 0);
    const MedialComplex& complex = result.complex;
    expect_consistent(complex);
    EXPECT_EQ(complex.sheets, 17);
    double farthest = 0.0;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const auto is_on_edge = [&](Index v) { return complex.radii[v] == 0.0; };
        if (std::ranges::any_of(complex.faces[f], is_on_edge)) {
            for (const Index e : complex.face_edges[f]) {
                const auto& [a, b] = complex.edges[e];
                const double room = depth(*ell, midpoint(complex.vertices[a], complex.vertices[b]));
                farthest = std::max(farthest, std::abs(room - 0.5 * (complex.radii[a] + complex.radii[b])));
            }
        }
    }
    EXPECT_LT(farthest, 0.15 * tolerance);
}

TEST(Centering, HalvesNoEdgesWhereOnlyTheUnionDips) {
    const std::unique_ptr<Solid> plate = mesh_solid(box_mesh({0, 0, 0}, {10, 10, 1}));
    const double tolerance = 0.02 * plate->bounds().diagonal();
    const MedialComplex before = axis_before(*plate, 0.02, 1.0);
    ASSERT_GT(pairs_off_linear(before, 0.2 * tolerance).size(), 100U);
    const CenteredComplex after = center(before, *plate, {.tolerance = tolerance});
    EXPECT_LT(after.statistics.halved, static_cast<Index>(before.vertices.size() / 100));
}

/// Points all over a mesh.
std::vector<Point> points_on(const TriangleMesh& mesh, std::size_t count, Random& random) {
    std::vector<double> areas;
    for (const auto& [a, b, c] : mesh.triangles) {
        areas.push_back((areas.empty() ? 0.0 : areas.back()) +
                        norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])));
    }
    std::vector<Point> points;
    while (points.size() < count) {
        const auto at = std::ranges::upper_bound(areas, uniform(random, 0.0, areas.back()));
        const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(at - areas.begin())];
        double u = uniform(random, 0.0, 1.0);
        double v = uniform(random, 0.0, 1.0);
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        points.push_back(mesh.vertices[a] + u * (mesh.vertices[b] - mesh.vertices[a]) +
                         v * (mesh.vertices[c] - mesh.vertices[a]));
    }
    return points;
}

TEST(Centering, EnvelopesOfPlaneFacesAreAlmostExact) {
    // Around the re-entrant edge of the one the axis is curved; the sheet in the middle of the other ends before the
    // tip.
    struct Case {
        TriangleMesh mesh;
        double most_apart;  // of the points: a part, by more than 0.01 δ
        double farthest;    // δ
    };
    for (const auto& [mesh, most_apart, most] :
         {Case{prism({{0, 0}, {20, 0}, {20, 2}, {2, 2}, {2, 20}, {0, 20}}, 10.0), 0.004, 0.15},
          Case{prism({{0, 0}, {4, 0}, {2.2, 20}, {1.8, 20}}, 8.0), 0.002, 0.2}}) {
        Random random(7);
        const std::unique_ptr<Solid> solid = mesh_solid(mesh);
        const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.01)});
        const Envelope envelope(axis.axes[0].complex);
        const std::vector<Point> points = points_on(mesh, 20000, random);
        std::size_t apart = 0;
        double farthest = 0.0;
        for (const double signed_distance : envelope.signed_distances(points)) {
            const double gap = std::abs(signed_distance);
            farthest = std::max(farthest, gap);
            apart += gap > 0.01 * axis.tolerance ? 1 : 0;
        }
        EXPECT_LT(static_cast<double>(apart), most_apart * static_cast<double>(points.size()));
        EXPECT_LT(farthest, most * axis.tolerance);
    }
}

TEST(Centering, CurvesGoToTheMiddle) {
    // A square rod, longer than what is seen of it, and a curve that zigzags around its axis.
    const std::unique_ptr<Solid> rod = mesh_solid(box_mesh({-1, -1, -20}, {1, 1, 20}, 2));
    std::vector<Point> points;
    for (int i = 0; i <= 20; ++i) {
        points.push_back({i % 2 == 0 ? 0.05 : -0.05, 0.02, -5.0 + 0.5 * i});
    }
    MedialComplex curve = complex_by_hand(points, {}, {}, chain_edges(21));
    std::ranges::fill(curve.radii, 0.9);
    const MedialComplex after = center(curve, *rod, {.tolerance = 0.2}).complex;
    for (std::size_t v = 1; v + 1 < points.size(); ++v) {
        EXPECT_NEAR(after.vertices[v].x, 0.0, 1e-4);
        EXPECT_NEAR(after.vertices[v].y, 0.0, 1e-4);
        EXPECT_NEAR(after.radii[v], 1.0, 1e-4);
    }
    EXPECT_EQ(after.vertices[0], points[0]) << "nothing tells where the end should go";
    EXPECT_NEAR(after.radii[0], 0.95, 1e-9);
}

TEST(Centering, LeavesAloneWhatDoesNotBelongToTheSolid) {
    const std::unique_ptr<Solid> box = mesh_solid(box_mesh({0, 0, 0}, {3, 2, 1}));
    const MedialComplex before = axis_before(*box, 0.02, 1.0);
    const double tolerance = 0.02 * box->bounds().diagonal();
    const auto with = [&](const auto& change) {
        MedialComplex changed = before;
        change(changed);
        return changed;
    };
    const MedialComplex large = with([](MedialComplex& complex) {
        for (double& radius : complex.radii) {
            radius = radius > 0.0 ? 1.5 * radius + 0.1 : 0.0;
        }
    });
    EXPECT_TRUE(same_bytes(center(large, *box, {.tolerance = tolerance}).complex, large)) << "sticks out";
    const MedialComplex far = with([](MedialComplex& complex) {
        for (Point& p : complex.vertices) {
            p = p + Point{10.0, 0.0, 0.0};
        }
    });
    EXPECT_TRUE(same_bytes(center(far, *box, {.tolerance = tolerance}).complex, far)) << "outside";
    const MedialComplex small = with([&](MedialComplex& complex) {
        for (std::size_t v = 0; v < complex.radii.size(); ++v) {
            complex.radii[v] = std::max(0.0, complex.radii[v] - 2.0 * tolerance);
            if (complex.radii[v] == 0.0) {
                complex.vertex_origins[v] = {VertexKind::kSharpEdge};
            }
        }
    });
    const CenteredComplex left = center(small, *box, {.tolerance = tolerance});
    for (std::size_t v = 0; v < small.vertices.size(); ++v) {
        EXPECT_LE(left.complex.radii[v], small.radii[v] + tolerance);
    }
}

TEST(Centering, DoesNotDependOnThreadsOrPlace) {
    const TriangleMesh mesh = dumbbell_mesh(0.5, 1.0, 0.2, 24);
    const std::unique_ptr<Solid> solid = mesh_solid(mesh);
    const MedialComplex before = axis_before(*solid, 0.02, 1.1);
    const double tolerance = 0.02 * solid->bounds().diagonal();
    const MedialComplex one = center(before, *solid, {.tolerance = tolerance}, {.threads = 1}).complex;
    EXPECT_TRUE(same_bytes(one, center(before, *solid, {.tolerance = tolerance}, {.threads = 3}).complex));

    const Similarity larger = enlargement(64.0);
    const std::unique_ptr<Solid> large_solid = mesh_solid(moved(mesh, larger));
    MedialComplex large = before;
    for (std::size_t v = 0; v < large.vertices.size(); ++v) {
        large.vertices[v] = 64.0 * large.vertices[v];
        large.radii[v] *= 64.0;
    }
    for (Point& p : large.boundary_vertices) {
        p = 64.0 * p;
    }
    const MedialComplex result = center(large, *large_solid, {.tolerance = 64.0 * tolerance}).complex;
    for (std::size_t v = 0; v < one.vertices.size(); ++v) {
        EXPECT_LT(distance(result.vertices[v], 64.0 * one.vertices[v]), 64.0 * 1e-6);
        EXPECT_NEAR(result.radii[v], 64.0 * one.radii[v], 64.0 * 1e-6);
    }
}

TEST(Centering, CanBeLeftOutAndChecksItsInput) {
    const std::unique_ptr<Solid> box = mesh_solid(box_mesh({0, 0, 0}, {3, 2, 1}));
    const ScaleAxis without = scale_axis(*box, {.delta = Length::relative(0.02), .is_centered = false});
    EXPECT_FALSE(without.axes[0].center_statistics);
    EXPECT_FALSE(scale_axis(*box, {.delta = Length::relative(0.02), .is_dense = true}).axes[0].center_statistics);
    EXPECT_FALSE(
        scale_axis(*box, {.delta = Length::relative(0.02), .union_kind = UnionKind::kPolar}).axes[0].center_statistics);
    MedialComplex complex = without.axes[0].complex;
    EXPECT_THROW(center(complex, *box, {.tolerance = 0.0}), InvalidOption);
    EXPECT_THROW(center(complex, *box, {.tolerance = std::numeric_limits<double>::infinity()}), InvalidOption);
    complex.radii.pop_back();
    EXPECT_THROW(center(complex, *box, {.tolerance = 0.1}), UnusableInput);
    EXPECT_TRUE(center({}, *box, {.tolerance = 0.1}).complex.vertices.empty());
}

}  // namespace
}  // namespace scaleaxis
