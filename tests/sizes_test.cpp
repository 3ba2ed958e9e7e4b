// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "executions.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"

namespace scaleaxis {
namespace {

using test::box_mesh;
using test::prism;
using test::revolved_mesh;

SizeField field_of(const TriangleMesh& mesh, const SizeOptions& options) { return {*mesh_solid(mesh), mesh, options}; }

// Random points of a box, with a seed.
std::vector<Point> points_in(const Point& low, const Point& high, int count, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> part;
    std::vector<Point> points;
    for (int i = 0; i < count; ++i) {
        points.push_back({low.x + part(generator) * (high.x - low.x), low.y + part(generator) * (high.y - low.y),
                          low.z + part(generator) * (high.z - low.z)});
    }
    return points;
}

// A plate with a step: 1 thick up to x = 20, 4 thick beyond.
TriangleMesh stepped_plate() { return prism({{20, 1}, {0, 1}, {0, 0}, {40, 0}, {40, 4}, {20, 4}}, 15.0); }

TEST(Sizes, OfAPlateAreItsThicknessByTheElementsAcross) {
    const TriangleMesh plate = box_mesh({0, 0, 0}, {30, 20, 1});
    for (const SizeMeasure measure : {SizeMeasure::kThickness, SizeMeasure::kFeatureSize}) {
        const SizeField field = field_of(plate, {.measure = measure, .elements_across = 4.0});
        for (const Point& p : points_in({1, 1, 0}, {29, 19, 1}, 500, 1)) {
            EXPECT_GE(field(p), 0.25 * 0.997) << p.x << ' ' << p.y << ' ' << p.z;
            EXPECT_LE(field(p), 0.25 * 1.11) << p.x << ' ' << p.y << ' ' << p.z;
        }
        const auto [least, largest] = std::ranges::minmax(field.surface_sizes());
        EXPECT_NEAR(least, 0.25, 0.25 * 3e-3);
        // The two sides end to face each other half a thickness from the rim: so far is the axis there.
        const bool is_thickness = measure == SizeMeasure::kThickness;
        EXPECT_LE(largest, 0.25 * (is_thickness ? 1.02 : 1.01 * std::sqrt(3.0)));
        EXPECT_NEAR(field({15, 0, 0}), 0.25 * (is_thickness ? 1.0 : std::sqrt(2.0)), 0.01);
    }
}

TEST(Sizes, OfASteppedPlateGrowByTheGradation) {
    const SizeOptions options{.elements_across = 4.0, .gradation = 0.2};
    const SizeField field = field_of(stepped_plate(), options);
    for (const Point& p : points_in({1, 0, 1}, {39, 1, 14}, 1000, 2)) {
        const double asked = p.x < 20.0 ? 0.25 : 1.0;
        const double graded = std::min(asked, 0.25 + 0.2 * std::max(0.0, p.x - 20.0));
        // Beside the step the ball in the thick part touches the thin one: its size counts from up to 4 before it.
        EXPECT_GE(field(p), std::min(graded, 0.25) * 0.997);
        EXPECT_LE(field(p), 1.1 * graded + 0.2 * 0.5) << p.x << ' ' << p.y << ' ' << p.z;
        if (p.x < 18.0 || p.x > 27.0) {
            EXPECT_GE(field(p), 0.95 * graded) << p.x << ' ' << p.y << ' ' << p.z;
            EXPECT_LE(field(p), 1.1 * graded) << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
}

TEST(Sizes, AreLipschitzEverywhere) {
    for (const double gradation : {0.1, 0.3, 1.0}) {
        for (const SizeMeasure measure : {SizeMeasure::kThickness, SizeMeasure::kFeatureSize}) {
            const SizeField field = field_of(
                stepped_plate(), {.measure = measure, .min_size = 0.1, .max_size = 0.9, .gradation = gradation});
            const std::vector<Point> a = points_in({-5, -5, -5}, {45, 9, 20}, 3000, 3);
            const std::vector<Point> b = points_in({-1, -1, -1}, {1, 1, 1}, 3000, 4);
            for (std::size_t i = 0; i < a.size(); ++i) {
                const Point near = a[i] + std::pow(10.0, -static_cast<double>(i % 4)) * b[i];
                EXPECT_LE(std::abs(field(a[i]) - field(near)), gradation * distance(a[i], near) + 1e-9);
                EXPECT_GE(field(a[i]), 0.1 - 1e-12);
                EXPECT_LE(field(a[i]), 0.9 + 1e-12);
            }
        }
    }
}

TEST(Sizes, OfACylinderAreItsDiameterAndOfAHoleItsOwn) {
    // A rod: every point of its mantle is a radius from the axis.
    const TriangleMesh rod = revolved_mesh({{0, 0}, {2, 0}, {2, 20}, {0, 20}}, 96, 0.5);
    for (const SizeMeasure measure : {SizeMeasure::kThickness, SizeMeasure::kFeatureSize}) {
        const SizeField field = field_of(rod, {.measure = measure, .elements_across = 5.0});
        for (double z = 4.0; z < 16.0; z += 0.7) {
            EXPECT_NEAR(field({2.0 * std::cos(z), 2.0 * std::sin(z), z}), 0.8, 0.01);
            EXPECT_NEAR(field({0.0, 0.0, z}), 0.8, 0.08);
        }
    }
    // A thick tube: its wall is 8 thick, and the distance to the axis of its hole 1.
    const TriangleMesh tube = revolved_mesh({{1, 0}, {9, 0}, {9, 20}, {1, 20}}, 96, 0.5);
    const SizeField sizes = field_of(tube, {.measure = SizeMeasure::kFeatureSize, .elements_across = 2.0});
    EXPECT_NEAR(sizes({1.0, 0.0, 10.0}), 1.0, 0.01);
    EXPECT_NEAR(sizes({0.0, -1.0, 5.0}), 1.0, 0.01);
    EXPECT_NEAR(field_of(tube, {.elements_across = 2.0})({1.0, 0.0, 10.0}), 4.0, 0.1);
}

TEST(Sizes, OfABackgroundAreThoseOfTheField) {
    const SizeField field = field_of(stepped_plate(), {.elements_across = 4.0});
    const SizeMesh mesh = field.background();
    ASSERT_EQ(mesh.vertices.size(), mesh.sizes.size());
    double volume = 0.0;
    int inside = 0;
    for (const std::array<Index, 4>& t : mesh.tetrahedra) {
        const auto at = [&](int k) { return mesh.vertices[t[k]]; };
        const double part = dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6.0;
        ASSERT_GT(part, -1e-12);
        volume += part;
        const Point middle = 0.25 * (at(0) + at(1) + at(2) + at(3));
        const bool is_inside = middle.y > 0 && middle.y < (middle.x < 20 ? 1 : 4) && middle.x > 0 && middle.x < 40 &&
                               middle.z > 0 && middle.z < 15;
        if (is_inside && part > 1e-9) {
            ++inside;
            const double size = 0.25 * (mesh.sizes[t[0]] + mesh.sizes[t[1]] + mesh.sizes[t[2]] + mesh.sizes[t[3]]);
            EXPECT_LE(size, 1.2 * field(middle)) << middle.x << ' ' << middle.y << ' ' << middle.z;
            EXPECT_GE(size, 0.75 * field(middle)) << middle.x << ' ' << middle.y << ' ' << middle.z;
        }
    }
    EXPECT_GT(inside, 1000);
    const double margin = 0.2 * std::sqrt(40.0 * 40 + 4 * 4 + 15 * 15);
    EXPECT_NEAR(volume, (40 + margin) * (4 + margin) * (15 + margin), 1e-6 * volume);
}

TEST(Sizes, AreTheSameForAnyNumberOfThreads) {
    const TriangleMesh mesh = stepped_plate();
    const auto solid = mesh_solid(mesh);
    const auto sizes = [&](int threads) {
        return SizeField(*solid, mesh, {.measure = SizeMeasure::kFeatureSize}, {.threads = threads})
            .background({.threads = threads})
            .sizes;
    };
    EXPECT_EQ(sizes(1), sizes(2));
}

TEST(Sizes, RefuseOptionsOutOfRange) {
    const TriangleMesh box = box_mesh({0, 0, 0}, {1, 1, 1});
    for (const SizeOptions& options : std::vector<SizeOptions>{{.elements_across = 0.0},
                                                               {.elements_across = NAN},
                                                               {.min_size = -1.0},
                                                               {.max_size = INFINITY},
                                                               {.min_size = 2.0, .max_size = 1.0},
                                                               {.gradation = 0.0},
                                                               {.angle = 30.0}}) {
        EXPECT_THROW(field_of(box, options), InvalidOption);
    }
}

}  // namespace
}  // namespace scaleaxis
