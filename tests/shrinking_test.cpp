// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/shrinking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "complexes.hpp"
#include "homology.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/sampling.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr double kDegrees = 180.0 / std::numbers::pi;

MedialComplex dense(const MedialComplex& complex, double scale, const DensifyOptions& options = {},
                    const Execution& execution = {}) {
    return densify(shrink(complex, scale), options, execution);
}

// The angle at which two balls meet: 180 degrees where they coincide, 0 where they touch from outside.
double meeting_angle(const Ball& a, const Ball& b) {
    const double cosine = (a.radius * a.radius + b.radius * b.radius - squared_distance(a.center, b.center)) /
                          (2.0 * a.radius * b.radius);
    return 180.0 - std::acos(std::clamp(cosine, -1.0, 1.0)) * kDegrees;
}

double area(const MedialComplex& complex) {
    double sum = 0.0;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        Point twice;
        const std::span<const Index> face = complex.faces[f];
        for (std::size_t k = 2; k < face.size(); ++k) {
            const Point& a = complex.vertices[face[0]];
            twice = twice + cross(complex.vertices[face[k - 1]] - a, complex.vertices[face[k]] - a);
        }
        sum += 0.5 * norm(twice);
    }
    return sum;
}

// Of all edges to which `number` faces belong.
double length_of_edges(const MedialComplex& complex, int number) {
    std::vector<int> faces(complex.edges.size());
    for (const Index e : complex.face_edges.items) {
        ++faces[e];
    }
    double sum = 0.0;
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (faces[e] == number) {
            sum += distance(complex.vertices[complex.edges[e][0]], complex.vertices[complex.edges[e][1]]);
        }
    }
    return sum;
}

TEST(Densify, TakesRadiiOfOtherProgramsForLinear) {
    MedialComplex cone = complex_by_hand({{0, 0, 0}, {4, 0, 0}}, {}, {}, {{0, 1}});
    cone.radii = {1.0, 0.5};
    EXPECT_THROW(densify(cone, {}), UnusableInput) << "balls of a union never meet";
    for (const double scale : {1.0, 1.2}) {
        const MedialComplex finer = densify(with_scale(with_linear_radii(cone), scale));
        EXPECT_GT(finer.vertices.size(), 5U);
        for (std::size_t v = 0; v < finer.vertices.size(); ++v) {
            EXPECT_NEAR(finer.radii[v], 1.0 - finer.vertices[v].x / 8.0, 1e-12);
        }
    }
}

TEST(Shrinking, KeepsAllButRadii) {
    const MedialComplex complex = medial_axis(chain_of_balls(3, 1.6, 1.0)).complex;
    for (const double scale : {1.0, 1.1, 7.0}) {
        MedialComplex c = shrink(complex, scale);
        for (std::size_t v = 0; v < c.radii.size(); ++v) {
            EXPECT_EQ(c.radii[v], complex.radii[v] / scale);
        }
        EXPECT_EQ(c.scale, scale);
        c.radii = complex.radii;
        c.scale = 1.0;
        EXPECT_TRUE(same_bytes(c, complex));
    }
}

TEST(Shrinking, SamplesASegment) {
    // Two balls of radius 1 whose centres are 1.6 apart: at distance t from the middle the radius is √(t² + 0.6²).
    const Balls balls{{{-0.8, 0.0, 0.0}, 1.0}, {{0.8, 0.0, 0.0}, 1.0}};
    const MedialComplex segment = medial_axis(balls, {.perturbation = 0.0}).complex;
    for (const double scale : {1.0, 1.1, 2.0, 10.0}) {
        const MedialComplex c = dense(segment, scale);
        expect_well_formed(c);
        EXPECT_EQ(homology(c), known_topology(1, 0, 0));
        EXPECT_EQ(c.edges.size() + 1, c.vertices.size());
        for (std::size_t v = 0; v < c.vertices.size(); ++v) {
            const double t = c.vertices[v].x;
            EXPECT_NEAR(c.radii[v], std::sqrt(t * t + 0.36) / scale, 1e-14);
            EXPECT_NEAR(norm({0.0, c.vertices[v].y, c.vertices[v].z}), 0.0, 1e-15);
            EXPECT_EQ(c.vertex_origins[v].kind == VertexKind::kVoronoi, v >= 2);
        }
        for (const auto& [p, q] : c.edges) {
            EXPECT_GE(meeting_angle(ball_at(c, p), ball_at(c, q)), 150.0 - 1e-9) << "at scale " << scale;
        }
        EXPECT_LE(c.edges.size(), 32U * static_cast<std::size_t>(scale)) << "at scale " << scale;
    }
}

TEST(Shrinking, HasAnEndWhereBallsTouch) {
    // Where the spheres touch, the radius is zero: no sampling is dense enough there, and a point is left.
    const Balls balls{{{-1.0, 0.0, 0.0}, 1.0}, {{0.5, 0.0, 0.0}, 0.5}};
    const MedialComplex c = dense(medial_axis(balls, {.perturbation = 0.0}).complex, 1.5);
    expect_well_formed(c);
    EXPECT_EQ(homology(c), known_topology(1, 0, 0));
    EXPECT_LT(c.vertices.size(), 1000U);
}

TEST(Shrinking, OnlyDividesTheRadiiOfADenseComplex) {
    const MedialComplex chain = medial_axis(chain_of_balls(10, 0.2, 1.0), {.perturbation = 0.0}).complex;
    MedialComplex c = dense(chain, 1.25);
    EXPECT_EQ(c.vertices.size(), 10U);
    for (double& radius : c.radii) {
        EXPECT_DOUBLE_EQ(radius, 0.8);
        radius = 1.0;
    }
    EXPECT_EQ(c.scale, 1.25);
    c.scale = 1.0;
    EXPECT_TRUE(same_bytes(c, chain));
}

TEST(Shrinking, SplitsByTheAngleThatIsAskedFor) {
    const MedialComplex segment = medial_axis(Balls{{{0, 0, 0}, 1}, {{1, 0, 0}, 1}}, {.perturbation = 0.0}).complex;
    std::size_t last = 0;
    for (const double angle : {90.0, 120.0, 150.0, 170.0, 175.0}) {
        const MedialComplex c = dense(segment, 1.0, {.meeting_angle = angle});
        for (const auto& [p, q] : c.edges) {
            EXPECT_GE(meeting_angle(ball_at(c, p), ball_at(c, q)), angle - 1e-9);
        }
        EXPECT_GE(c.vertices.size(), last);
        last = c.vertices.size();
    }
    EXPECT_GT(last, 16U);
}

struct Grown {
    std::string name;
    MedialComplex complex;
    double scale;
};

std::vector<Grown> grown_axes() {
    std::vector<Grown> result;
    const auto add = [&](const std::string& name, const Solid& solid, double tolerance) {
        for (const double scale : {1.0, 1.1, 1.5, 3.0}) {
            const Samples samples = sample(solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
            const MedialComplex complex = medial_axis(scaled(inner_balls(samples), scale)).complex;
            result.push_back({name + " at s = " + std::to_string(scale), filter(complex).complex, scale});
        }
    };
    add("box", box_solid({1.0, 0.7, 0.4}), 0.15);
    add("torus", torus_solid(1.0, 0.35), 0.15);
    add("shell", shell_solid(1.0, 0.6), 0.2);
    add("dumbbell", dumbbell_solid(0.5, 1.0, 0.2), 0.1);
    Random random(3);
    result.push_back({"balls", medial_axis(scattered_balls(random, 60, 1.5, 0.2, 0.6)).complex, 1.3});
    return result;
}

// The finer complex is the same set of points: conforming, with the same area, seams and borders.
TEST(Shrinking, SubdividesTheComplex) {
    for (const auto& [name, complex, scale] : grown_axes()) {
        SCOPED_TRACE(name);
        const MedialComplex c = dense(complex, scale);
        expect_well_formed(c);
        if (HasFatalFailure()) {
            return;
        }
        EXPECT_EQ(topology(c), topology(complex));
        EXPECT_NEAR(area(c), area(complex), 1e-9 * area(complex));
        EXPECT_EQ(c.sheets, complex.sheets);
        for (const int faces : {0, 1, 3, 4}) {
            EXPECT_NEAR(length_of_edges(c, faces), length_of_edges(complex, faces), 1e-6) << faces << " faces";
        }
        ASSERT_GE(c.vertices.size(), complex.vertices.size());
        for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
            EXPECT_EQ(c.vertices[v], complex.vertices[v]) << "vertices keep their place";
            EXPECT_EQ(c.vertex_origins[v], complex.vertex_origins[v]);
            EXPECT_DOUBLE_EQ(c.radii[v], complex.radii[v] / scale);
        }
        // Radii stay exact: the distance to the contacts.
        for (std::size_t f = 0; f < c.faces.size(); ++f) {
            for (const Index v : c.faces[f]) {
                for (const Index contact : c.face_contacts[f]) {
                    EXPECT_NEAR(scale * c.radii[v], distance(c.vertices[v], c.boundary_vertices[contact]), 1e-6);
                }
            }
        }
        for (const auto& [p, q] : c.edges) {
            ASSERT_GE(meeting_angle(ball_at(c, p), ball_at(c, q)), 150.0 - 1e-6);
        }
    }
}

TEST(Shrinking, GivesBallsThatMeetLikeTheComplex) {
    // The balls at the vertices of the finer complex form a union of its homotopy type.
    const Samples samples = sample(torus_solid(1.0, 0.35), {.tolerance = 0.15, .sizing = Sizing::kUniform});
    const MedialComplex complex = filter(medial_axis(scaled(inner_balls(samples), 1.2)).complex).complex;
    const MedialComplex c = dense(complex, 1.2);
    Balls balls;
    for (std::size_t v = 0; v < c.vertices.size(); ++v) {
        balls.push_back(ball_at(c, static_cast<Index>(v)));
    }
    EXPECT_EQ(medial_axis(balls).statistics.dual_complex, known_topology(1, 1, 0));
}

// The number of vertices is known before they are made.
TEST(Shrinking, RefusesMoreVerticesThanTheLimit) {
    for (const auto& [name, complex, scale] : grown_axes()) {
        SCOPED_TRACE(name);
        const MedialComplex c = dense(complex, scale);
        const auto count = static_cast<Index>(c.vertices.size());
        EXPECT_TRUE(same_bytes(dense(complex, scale, {.most_vertices = count}), c));
        EXPECT_THROW(dense(complex, scale, {.most_vertices = count - 1}), UnusableInput);
    }
}

TEST(Shrinking, RefusesWhatWouldFillTheMemory) {
    // Balls of a plane lattice that barely overlap: shrunk ones are far apart.
    std::vector<Ball> balls;
    for (int i = 0; i < 12; ++i) {
        for (int k = 0; k < 12; ++k) {
            balls.push_back({{1.0 * i, 1.0 * k, 0.0}, 0.7072});
        }
    }
    const MedialComplex complex = medial_axis(balls).complex;
    try {
        dense(complex, 500.0);
        FAIL() << "was not refused";
    } catch (const UnusableInput& error) {
        EXPECT_EQ(error.diagnostic().code, "shrinking.size");
        EXPECT_NE(std::string(error.what()).find("1000000 vertices"), std::string::npos) << error.what();
    }
    for (const Index limit : {0, -1}) {
        EXPECT_THROW(dense(complex, 1.0, {.most_vertices = limit}), InvalidOption);
    }
}

TEST(Shrinking, DoesNotDependOnThreads) {
    const Grown axis = grown_axes().front();
    const MedialComplex c = dense(axis.complex, axis.scale, {}, {.threads = 1});
    for (const int threads : {1, 2, 4}) {
        EXPECT_TRUE(same_bytes(dense(axis.complex, axis.scale, {}, {.threads = threads}), c)) << threads;
    }
}

TEST(Shrinking, RejectsOptionsOutOfRange) {
    const MedialComplex segment = medial_axis(chain_of_balls(2, 1.0, 0.8)).complex;
    for (const double scale : {0.0, 0.99, -1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_THROW(dense(segment, scale), InvalidOption) << scale;
    }
    for (const double angle : {89.9, 175.1, std::nan("")}) {
        EXPECT_THROW(dense(segment, 1.0, {.meeting_angle = angle}), InvalidOption) << angle;
    }
    EXPECT_THROW(dense(segment, 1.0, {}, {.progress = [](std::string_view, double) { return false; }}), Cancelled);
}

}  // namespace
}  // namespace scaleaxis
