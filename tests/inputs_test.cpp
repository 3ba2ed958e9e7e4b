// SPDX-License-Identifier: Apache-2.0
//
// The same solids as meshes, images, functions and points: every kind of input leads to the same union of balls and the
// same topology.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "images.hpp"
#include "meshes.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr double kScale = 1.05;

struct Model {
    double tolerance;
    ImplicitSolid solid;
    TriangleMesh mesh;
    double mesh_error;  ///< how far the triangles are from the curved boundary
};

/// What an input has led to.
struct Result {
    std::string input;
    ScaleAxis axis;
    double error;  ///< how far the boundary of the union may be from that of the solid
};

/// Inscribed in an arc.
double sagitta(double radius, int segments) { return radius * (1.0 - std::cos(std::numbers::pi / segments)); }

ScaleAxisOptions with_tolerance(double tolerance) {
    ScaleAxisOptions options;
    options.delta = Length::absolute(tolerance);
    options.scales = {kScale};
    return options;
}

std::vector<Result> results_of(const Model& model) {
    const Box box = model.solid.bounds();
    const Point margin{0.2, 0.2, 0.2};
    const Box around{box.min - margin, box.max + margin};
    const ScaleAxisOptions options = with_tolerance(model.tolerance);
    std::vector<Result> results;
    const auto add = [&](const std::string& input, ScaleAxis axis, double error) {
        results.push_back({input, std::move(axis), model.tolerance + error});
    };
    add("mesh", scale_axis(*mesh_solid(model.mesh), options), model.mesh_error);
    add("function", scale_axis(*function_solid(model.solid.function(), {.bounds = around}), options), 0.0);

    // The interpolant is a mean of the values at the corners of a voxel. These are half the diagonal away or less, in
    // the mean, and the function changes no faster than one moves.
    const Image grey = sampled(model.solid.function(), around, 48);
    const double half_diagonal = 0.5 * norm(grey.steps[0] + grey.steps[1] + grey.steps[2]);
    add("grey image", scale_axis(*image_solid(grey, {0.0, true}), options), half_diagonal);
    // Of a mask, no more is known than between which voxels the boundary is.
    const Image mask = sampled(as_mask(model.solid.function()), around, 48);
    add("mask", scale_axis(*image_solid(smoothed_mask(mask), {}), options), half_diagonal);

    // Between points, no more is known than that there is a point within their distance.
    PointCloud points{sample(model.solid, {.tolerance = model.tolerance, .sizing = Sizing::kUniform}).points, {}};
    add("points", axis_of(points, options), model.tolerance);
    for (const Point& p : points.points) {
        points.normals.push_back(difference_quotient(model.solid.function(), p, 1e-6));
    }
    add("points with normals", axis_of(points, options), model.tolerance);
    return results;
}

void expect_the_same(const Model& model) {
    const Topology truth = *model.solid.topology();
    const std::vector<Result> results = results_of(model);
    const std::vector<Point> boundary =
        sample(model.solid, {.tolerance = 0.3 * model.tolerance, .sizing = Sizing::kUniform}).points;
    for (const auto& [input, axis, error] : results) {
        SCOPED_TRACE(input);
        EXPECT_EQ(axis.axes.at(0).medial_statistics.dual_complex, truth);
        EXPECT_EQ(axis.axes.at(0).medial_statistics.medial_complex, truth);
        EXPECT_EQ(topology(axis.axes.at(0).complex), truth);

        // The union and the solid: neither reaches farther beyond the other.
        for (const auto& [center, radius] : axis.balls) {
            EXPECT_LE(model.solid.value(center) + radius, error);
        }
        EXPECT_LE(farthest(boundary, axis.balls), error);
        // The unions: each with each in both directions.
        const std::vector<Point> points = points_of(axis.balls);
        for (const Result& other : results) {
            EXPECT_LE(farthest(points, other.axis.balls), error + other.error) << other.input;
        }
    }
}

constexpr int kSegments = 48;

TEST(Inputs, OfABallAreTheSame) {
    expect_the_same({0.08, ball_solid(1.0), ball_mesh(1.0, kSegments), 2.0 * sagitta(1.0, kSegments)});
}

TEST(Inputs, OfATorusAreTheSame) {
    expect_the_same({0.08, torus_solid(1.0, 0.4), torus_mesh(1.0, 0.4, kSegments), 2.0 * sagitta(1.4, kSegments)});
}

TEST(Inputs, OfABoxAreTheSame) {
    const Point half{1.0, 0.7, 0.4};
    expect_the_same({0.05, box_solid(half), box_mesh(-1.0 * half, half), 0.0});
}

TEST(Inputs, OfASlabWithThreeHolesAreTheSame) {
    const double hole = 0.25;
    expect_the_same({0.06, holed_solid(hole), holed_mesh(hole, kSegments / 4), 2.0 * sagitta(hole, kSegments / 2)});
}

}  // namespace
}  // namespace scaleaxis
