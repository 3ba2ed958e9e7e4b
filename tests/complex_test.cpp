// SPDX-License-Identifier: Apache-2.0
#include "axis/complex.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "axis/edit/clipped.hpp"
#include "base/vectors.hpp"
#include "complexes.hpp"
#include "meshes.hpp"
#include "scaleaxis/centering.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/shrinking.hpp"
#include "scaleaxis/simplification.hpp"
#include "scaleaxis/smoothing.hpp"

namespace scaleaxis {
namespace {

using namespace test;

// Two squares at an edge, in one sheet, and a curve at a corner.
MedialComplex valid_complex() {
    return complex_by_hand({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {2, 2, 0}},
                           {{0, 2, 3, 1}, {0, 1, 5, 4}}, {60.0, 60.0}, {{3, 6}});
}

// As a file gives it.
MedialComplex without_contacts(MedialComplex complex) {
    complex.face_contacts.clear();
    complex.boundary_vertices.clear();
    complex.boundary_vertex_balls.clear();
    return complex;
}

Diagnostic diagnostic_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const UnusableInput& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.diagnostic();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
}

struct Fault {
    std::string name;
    std::function<void(MedialComplex&)> make;
    std::string code;
    std::string element = {};
    std::int64_t index = -1;
};

std::vector<Fault> faults() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {
        {"no radii", [](MedialComplex& c) { c.radii.clear(); }, "complex.size"},
        {"no origins of vertices", [](MedialComplex& c) { c.vertex_origins.pop_back(); }, "complex.size"},
        {"a sharp edge with a radius", [](MedialComplex& c) { c.vertex_origins[0] = {VertexKind::kSharpEdge}; },
         "complex.origin", "vertex", 0},
        {"a ball without a number", [](MedialComplex& c) { c.vertex_origins[0] = {VertexKind::kBall}; },
         "complex.origin", "vertex", 0},
        {"no edges of faces", [](MedialComplex& c) { c.face_edges = {}; }, "complex.size"},
        {"offsets behind the items", [](MedialComplex& c) { c.faces.offsets.back() = 9; }, "complex.size"},
        {"offsets that descend", [](MedialComplex& c) { c.faces.offsets[1] = 9; }, "complex.size"},
        {"no offsets", [](MedialComplex& c) { c.faces.offsets.clear(); }, "complex.size"},
        {"no sheets", [](MedialComplex& c) { c.face_sheets.clear(); }, "complex.size"},
        {"an angle too few", [](MedialComplex& c) { c.face_angles.pop_back(); }, "complex.size"},
        {"contacts of one face", [](MedialComplex& c) { c.face_contacts.pop_back(); }, "complex.size"},
        {"a coordinate", [](MedialComplex& c) { c.vertices[4].y = kInfinity; }, "complex.vertex", "vertex", 4},
        {"a negative radius", [](MedialComplex& c) { c.radii[5] = -1e-9; }, "complex.radius", "vertex", 5},
        {"no radius", [](MedialComplex& c) { c.radii[2] = std::nan(""); }, "complex.radius", "vertex", 2},
        {"an end too high", [](MedialComplex& c) { c.edges[3][1] = 7; }, "complex.edge", "edge", 3},
        {"an end too low", [](MedialComplex& c) { c.edges[3][0] = -1; }, "complex.edge", "edge", 3},
        {"one end",
         [](MedialComplex& c) {
             c.edges[0] = {0, 0};
         },
         "complex.edge", "edge", 0},
        {"ends the wrong way", [](MedialComplex& c) { std::swap(c.edges[1][0], c.edges[1][1]); }, "complex.edge",
         "edge", 1},
        {"an edge twice", [](MedialComplex& c) { c.edges.push_back(c.edges[2]); }, "complex.edge", "edge", 2},
        {"a corner too high", [](MedialComplex& c) { c.faces.items[6] = 7; }, "complex.face", "face", 1},
        {"a corner twice", [](MedialComplex& c) { c.faces.items[6] = 0; }, "complex.face", "face", 1},
        {"a face of two corners",
         [](MedialComplex& c) {
             c.faces.offsets[1] = 2;
             c.face_edges.offsets[1] = 2;
         },
         "complex.face", "face", 0},
        {"another edge", [](MedialComplex& c) { c.face_edges.items[1] = c.face_edges.items[2]; }, "complex.face",
         "face", 0},
        {"no such edge", [](MedialComplex& c) { c.face_edges.items[7] = 8; }, "complex.face", "face", 1},
        {"no such sheet", [](MedialComplex& c) { c.face_sheets[1] = 1; }, "complex.sheet", "face", 1},
        {"more sheets than faces", [](MedialComplex& c) { c.sheets = 1 << 30; }, "complex.sheet"},
        {"a scale below 1", [](MedialComplex& c) { c.scale = 0.5; }, "complex.scale"},
        {"no scale", [](MedialComplex& c) { c.scale = std::nan(""); }, "complex.scale"},
        {"an angle above 90", [](MedialComplex& c) { c.face_angles[1] = 90.1; }, "complex.angle", "face", 1},
        {"an angle that is no number", [](MedialComplex& c) { c.face_angles[0] = std::nan(""); }, "complex.angle",
         "face", 0},
        {"no such contact",
         [](MedialComplex& c) {
             c.face_contacts[1] = {0, 2};
         },
         "complex.contact", "face", 1},
        {"contact -1",
         [](MedialComplex& c) {
             c.face_contacts[0] = {kNone, kNone};
         },
         "complex.contact", "face", 0},
    };
}

TEST(Complex, IsRefusedWhereItIsNotValid) {
    EXPECT_NO_THROW(check(MedialComplex()));
    EXPECT_NO_THROW(check(valid_complex()));
    EXPECT_NO_THROW(check(without_contacts(valid_complex())));
    const MedialAxis axis = medial_axis(Balls{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}});
    for (const Fault& fault : faults()) {
        SCOPED_TRACE(fault.name);
        MedialComplex complex = valid_complex();
        fault.make(complex);
        const Diagnostic found = diagnostic_of([&] { check(complex); });
        EXPECT_EQ(found.code, fault.code);
        EXPECT_EQ(found.element, fault.element);
        EXPECT_EQ(found.index, fault.index);
        if (fault.index >= 0) {
            EXPECT_NE(found.message.find(fault.element + ' ' + std::to_string(fault.index)), std::string::npos);
        }
        EXPECT_THROW(filter(complex), UnusableInput);
        EXPECT_THROW(thresholded(complex, LocalMeasure::kObjectAngle, 30.0), UnusableInput);
        EXPECT_THROW(shrink(complex, 1.0), UnusableInput);
        EXPECT_THROW(densify(complex, {}), UnusableInput);
        EXPECT_THROW(smooth(complex, axis.ball_union, {.rounds = 1}), UnusableInput);
        EXPECT_THROW(topology(complex), UnusableInput);
    }
}

TEST(Complex, NamesTheFirstFaultForAnyNumberOfThreads) {
    std::vector<Point> points;
    for (int i = 0; i < 50000; ++i) {
        points.push_back({1.0 * i, 0, 0});
    }
    MedialComplex complex = complex_by_hand(points, {});
    for (const int i : {40000, 20001, 49999}) {
        complex.radii[i] = -1.0;
    }
    EXPECT_EQ(diagnostic_of([&] { check(complex); }).index, 20001);
}

TEST(Complex, HasCornersOnceInLargeFacesToo) {
    std::vector<Point> points;
    std::vector<Index> corners;
    for (Index i = 0; i < 100; ++i) {
        points.push_back({std::cos(0.06 * i), std::sin(0.06 * i), 0.0});
        corners.push_back(i);
    }
    EXPECT_NO_THROW(check(complex_by_hand(points, {corners})));
    corners[99] = 50;
    EXPECT_EQ(diagnostic_of([&] { check(complex_by_hand(points, {corners})); }).index, 0);
}

TEST(Complex, NeedsNoContactsButForCircumradii) {
    const MedialComplex complex = valid_complex();
    const MedialComplex read = without_contacts(complex);
    ASSERT_TRUE(complex.has_contacts());
    ASSERT_FALSE(read.has_contacts());
    EXPECT_TRUE(same_bytes(filter(read).complex, without_contacts(filter(complex).complex)));
    EXPECT_TRUE(same_bytes(thresholded(read, LocalMeasure::kObjectAngle, 50.0).complex,
                           without_contacts(thresholded(complex, LocalMeasure::kObjectAngle, 50.0).complex)));
    EXPECT_TRUE(same_bytes(densify(with_scale(read, 2.0)), without_contacts(densify(with_scale(complex, 2.0)))));
    EXPECT_EQ(topology(read), topology(complex));
    EXPECT_EQ(diagnostic_of([&] { thresholded(read, LocalMeasure::kCircumradius, 0.1); }).code, "complex.contacts");
}

TEST(Complex, NeedsAnglesForTheFilters) {
    MedialComplex complex = valid_complex();
    complex.face_angles[1] = 0.0;
    EXPECT_NO_THROW(filter(complex, {.angle = 0.0}));
    EXPECT_NO_THROW(densify(complex, {}));
    for (const Diagnostic& found : {diagnostic_of([&] { filter(complex); }),
                                    diagnostic_of([&] { thresholded(complex, LocalMeasure::kObjectAngle, 30.0); })}) {
        EXPECT_EQ(found.code, "complex.angle");
        EXPECT_EQ(found.index, 1);
    }
}

TEST(Complex, IsSmoothedWithItsUnionOnly) {
    EXPECT_EQ(diagnostic_of([] { smooth(valid_complex(), BallUnion(), {.rounds = 1}); }).code, "balls.none");
}

TEST(Complex, KeepsItsScaleInAllStages) {
    const MedialComplex complex = with_scale(valid_complex(), 1.5);
    const BallUnion around(Balls{{{0, 0, 0}, 9.0}});
    const std::unique_ptr<Solid> solid = mesh_solid(box_mesh({-5, -5, -5}, {10, 10, 10}));
    for (const MedialComplex& made :
         {filter(complex).complex, thresholded(complex, LocalMeasure::kObjectAngle, 30.0).complex,
          with_object_angles(complex), with_linear_radii(complex), clean(complex, {.thickness = 0.1}).complex,
          densify(complex), smooth(complex, around, {.rounds = 2}), smooth(complex, {.rounds = 2}),
          center(complex, *solid, {.tolerance = 0.1}).complex, contract_slivers(complex, 0.1),
          extend_to_sharp_edges(complex, *solid, {.tolerance = 0.1}).complex,
          simplify(complex, {.error = 0.01}).complex, filtration(complex).complex, cut(filtration(complex), 1.0)}) {
        EXPECT_EQ(made.scale, 1.5);
    }
    EXPECT_EQ(shrink(complex, 2.0).scale, 3.0);
    MedialComplex all;
    append_labelled(all, complex, 1);
    EXPECT_EQ(all.scale, 1.5);
    append_labelled(all, complex, 2);
    EXPECT_EQ(all.scale, 1.5);
    append_labelled(all, with_scale(complex, 1.2), 3);
    EXPECT_EQ(all.scale, 1.0) << "none that all have";
}

TEST(Complex, ListsCurvesAndIsolatedVertices) {
    MedialComplex complex =
        complex_by_hand({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {2, 0, 0}, {9, 9, 9}}, {{0, 1, 2}}, {}, {{1, 4}});
    EXPECT_EQ(curve_edges(complex), (std::vector<std::array<Index, 2>>{{1, 4}}));
    EXPECT_EQ(isolated_vertices(complex), (std::vector<Index>{3, 5}));
}

TEST(Complex, ReportsProgressUpToTheEnd) {
    const MedialComplex complex = valid_complex();
    double last = 0.0;
    const Execution execution{.progress = [&](std::string_view, double fraction) {
        EXPECT_GE(fraction, last);
        last = fraction;
        return true;
    }};
    const auto end_of = [&](const auto& call) {
        last = 0.0;
        call();
        return last;
    };
    EXPECT_EQ(end_of([&] { filter(complex, {}, execution); }), 1.0);
    EXPECT_EQ(end_of([&] { thresholded(complex, LocalMeasure::kObjectAngle, 1.0, execution); }), 1.0);
    EXPECT_EQ(end_of([&] { densify(with_scale(complex, 3.0), {}, execution); }), 1.0);
}

TEST(Clipped, IsThePartWhereAFunctionIsNotNegative) {
    constexpr std::uint64_t kSeed = 76;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (int round = 0; round < 100; ++round) {
        std::vector<Point> vertices;
        for (int i = 0; i < 9; ++i) {
            vertices.push_back(random_point(random, 1.0));
        }
        const auto radius = [](const Point& p) { return 2.0 + 0.3 * p.x - 0.2 * p.y; };
        const MedialComplex complex = with_linear_radii(
            complex_by_hand(vertices, {{0, 1, 2}, {1, 2, 3}, {1, 2, 4}}, {}, {{4, 5}, {5, 6}, {5, 7}}), radius);
        const Point direction = random_point(random, 1.0);
        const auto values = [&](double sign) {
            return each_of<double>(vertices, [&](const Point& p) { return sign * (dot(direction, p) - 0.1); });
        };
        double area = 0.0, length = 0.0;
        std::size_t isolated = 0;
        for (const double sign : {1.0, -1.0}) {
            const MedialComplex part = clipped(complex, values(sign));
            check(part);
            for (std::size_t v = 0; v < part.vertices.size(); ++v) {
                EXPECT_GE(sign * (dot(direction, part.vertices[v]) - 0.1), -1e-12);
                EXPECT_NEAR(part.radii[v], radius(part.vertices[v]), 1e-12);
            }
            for (Index f = 0; f < static_cast<Index>(part.faces.size()); ++f) {
                area += face_area(part, f);
            }
            for (const auto& [a, b] : curve_edges(part)) {
                length += distance(part.vertices[a], part.vertices[b]);
            }
            isolated += isolated_vertices(part).size();
        }
        double whole = 0.0, whole_length = 0.0;
        for (Index f = 0; f < 3; ++f) {
            whole += face_area(complex, f);
        }
        for (const auto& [a, b] : curve_edges(complex)) {
            whole_length += distance(vertices[a], vertices[b]);
        }
        EXPECT_NEAR(area, whole, 1e-12);
        EXPECT_NEAR(length, whole_length, 1e-12);
        EXPECT_EQ(isolated, 1);
    }
}

}  // namespace
}  // namespace scaleaxis
