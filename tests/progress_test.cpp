// SPDX-License-Identifier: Apache-2.0
// Progress of all public functions that take an `Execution`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "folder.hpp"
#include "images.hpp"
#include "scaleaxis/scaleaxis.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using namespace test;

void expect_cancelled_by_token(const std::function<void(const Execution&)>& call) {
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(call({.cancel = source.get_token()}), Cancelled);
}

std::vector<double> reported_by(const std::function<void(const Execution&)>& call) {
    std::vector<double> fractions;
    call({.threads = 2, .progress = [&](std::string_view, double fraction) {
              fractions.push_back(fraction);
              return true;
          }});
    return fractions;
}

/// Progress rises from 0 or more to exactly 1, and what it returns cancels the call, as a token does.
void expect_observable(const std::string& name, const std::function<void(const Execution&)>& call) {
    SCOPED_TRACE(name);
    const std::vector<double> fractions = reported_by(call);
    ASSERT_FALSE(fractions.empty());
    EXPECT_TRUE(std::ranges::is_sorted(fractions)) << testing::PrintToString(fractions);
    EXPECT_GE(fractions.front(), 0.0);
    EXPECT_EQ(fractions.back(), 1.0);
    EXPECT_THROW(call({.progress = [](std::string_view, double) { return false; }}), Cancelled);
    expect_cancelled_by_token(call);
}

/// What takes a moment, or is a part of others, says nothing. A token cancels it.
void expect_silent(const std::string& name, const std::function<void(const Execution&)>& call) {
    SCOPED_TRACE(name);
    EXPECT_EQ(reported_by(call), std::vector<double>{});
    expect_cancelled_by_token(call);
}

TEST(Progress, OfSamplesAndBalls) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const double tolerance = 0.15;
    const Samples samples = sample(torus, {.tolerance = tolerance});
    const std::vector<Ball> balls = inner_balls(samples);
    const std::unique_ptr<Solid> solid = mesh_solid(torus_mesh(1.0, 0.4, 20));
    const SampledUnion made = sampled_union(*solid, {.tolerance = tolerance});
    const FittedBalls fitted = fit(balls, *solid, {.slack = 0.01 * tolerance});
    const auto ball_union = [&] { return BallUnion(balls); };  // one that has kept nothing for later questions
    expect_observable("sample", [&](const Execution& e) { sample(torus, {.tolerance = tolerance}, e); });
    expect_observable("inner_balls", [&](const Execution& e) { inner_balls(samples, e); });
    expect_observable("fit", [&](const Execution& e) { fit(balls, *solid, {.slack = 0.01}, e); });
    expect_observable("repair", [&](const Execution& e) { repair(fitted, samples, *solid, {.slack = 0.01}, e); });
    expect_observable("union_accuracy",
                      [&](const Execution& e) { union_accuracy(fitted.balls, fitted.contacts, samples, e); });
    expect_observable("thin_part", [&](const Execution& e) { thin_part(fitted.balls, fitted.contacts, tolerance, e); });
    expect_observable("few_balls", [&](const Execution& e) {
        few_balls(made.balls.balls, made.samples.points, *solid, {.count = 4, .search_size = 200}, e);
    });
    expect_observable("ball_scores", [&](const Execution& e) { ball_scores(balls, samples.points, *solid, 1, e); });
    expect_observable("boundary_mesh", [&](const Execution& e) { boundary_mesh(samples, e); });
    expect_observable("BallUnion::topology", [&](const Execution& e) { ball_union().topology(e); });
    expect_observable("BallUnion::neighbors", [&](const Execution& e) { ball_union().neighbors(e); });
    expect_observable("BallUnion::boundary_vertices", [&](const Execution& e) { ball_union().boundary_vertices(e); });
    expect_observable("BallUnion::nearest_balls",
                      [&](const Execution& e) { ball_union().nearest_balls(samples.points, e); });
    expect_observable("BallUnion::signed_distances",
                      [&](const Execution& e) { ball_union().signed_distances(samples.points, e); });
    expect_observable("BallUnion::inside", [&](const Execution& e) { ball_union().inside(samples.points, e); });
    expect_observable("BallUnion::distances_to_boundary",
                      [&](const Execution& e) { ball_union().distances_to_boundary(samples.points, e); });
    expect_observable("signed_distance_image", [&](const Execution& e) { signed_distance_image(ball_union(), 16, e); });
    expect_observable("surface_distance",
                      [&](const Execution& e) { surface_distance(ball_union(), ball_union(), {.spacing = 0.2}, e); });
}

TEST(Progress, OfAxes) {
    const std::unique_ptr<Solid> solid = mesh_solid(torus_mesh(1.0, 0.4, 20));
    const double tolerance = 0.1;
    const SampledUnion made = sampled_union(*solid, {.tolerance = tolerance});
    const std::vector<Ball>& balls = made.balls.balls;
    const MedialAxis axis = medial_axis(balls);
    const MedialComplex& complex = axis.complex;
    const BallUnion ball_union(balls);
    const std::vector<Point> points = made.samples.points;
    const Skeleton curves = skeleton(complex, axis.ball_union);
    const Filtration levels = filtration(complex);
    const TriangleMesh surface = torus_mesh(1.0, 0.4, 20);
    Image grid = cubic_grid(solid->bounds(), 16);
    grid.values.resize(static_cast<std::size_t>(grid.sizes[0]) * grid.sizes[1] * grid.sizes[2]);
    expect_observable("medial_axis", [&](const Execution& e) { medial_axis(balls, {}, e); });
    expect_observable("medial_axis of a union", [&](const Execution& e) { medial_axis(BallUnion(balls), {}, e); });
    expect_observable("filter", [&](const Execution& e) { filter(complex, {}, e); });
    expect_observable("thresholded",
                      [&](const Execution& e) { thresholded(complex, LocalMeasure::kObjectAngle, 30.0, e); });
    expect_observable("extend_to_sharp_edges",
                      [&](const Execution& e) { extend_to_sharp_edges(complex, *solid, {.tolerance = tolerance}, e); });
    expect_observable("erosion_thickness", [&](const Execution& e) { erosion_thickness(complex, e); });
    expect_observable("clean", [&](const Execution& e) { clean(complex, {.thickness = 0.05}, e); });
    expect_observable("vanishing_scales", [&](const Execution& e) { vanishing_scales(balls, {}, e); });
    expect_observable("filtration", [&](const Execution& e) { filtration(complex, {}, e); });
    expect_observable("profile", [&](const Execution& e) { profile(levels, 2.0, 3, e); });
    expect_observable("densify", [&](const Execution& e) { densify(complex, {}, e); });
    expect_observable("smooth", [&](const Execution& e) { smooth(complex, axis.ball_union, {.rounds = 2}, e); });
    expect_observable("smooth alone", [&](const Execution& e) { smooth(complex, {.rounds = 2}, e); });
    expect_observable("center", [&](const Execution& e) { center(complex, *solid, {.tolerance = tolerance}, e); });
    expect_observable("simplify", [&](const Execution& e) { simplify(complex, {.error = 0.05}, e); });
    expect_observable("skeleton", [&](const Execution& e) { skeleton(complex, axis.ball_union, {}, e); });
    expect_observable("skeleton of a solid", [&](const Execution& e) { skeleton(complex, *solid, {}, e); });
    expect_observable("skeleton alone", [&](const Execution& e) { skeleton(complex, {}, e); });
    expect_observable("nearest_nodes", [&](const Execution& e) { nearest_nodes(curves, complex, points, e); });
    expect_observable("midsurface", [&](const Execution& e) { midsurface(complex, {}, e); });
    expect_observable("midsurface of a solid", [&](const Execution& e) { midsurface(complex, *solid, {}, e); });
    expect_observable("Thickness::at_surface", [&](const Execution& e) { Thickness(complex).at_surface(points, e); });
    expect_observable("Thickness::at_surface of a mesh",
                      [&](const Execution& e) { Thickness(complex).at_surface(surface, e); });
    expect_observable("grid_mask", [&](const Execution& e) {
        grid_mask(
            grid, [](std::span<const Point>, std::span<std::uint8_t> sides) { std::ranges::fill(sides, 1); }, e);
    });
    expect_observable("Thickness::image", [&](const Execution& e) {
        Image mask = grid;
        std::ranges::fill(mask.values, 1.0F);
        Thickness(complex).image(mask, e);
    });
    expect_observable("measures", [&](const Execution& e) { measures(complex, curves, surface, {}, e); });
    expect_observable("Envelope::signed_distances",
                      [&](const Execution& e) { Envelope(complex).signed_distances(points, e); });
    expect_observable("Envelope::inside", [&](const Execution& e) { Envelope(complex).inside(points, e); });
    expect_observable("envelope_solid", [&](const Execution& e) { envelope_solid(Envelope(complex), 0.0, e); });
    expect_observable("signed_distance_image of an envelope",
                      [&](const Execution& e) { signed_distance_image(Envelope(complex), 16, e); });
    const ViewedModel viewed_torus{.name = "torus",
                                   .shape = surface,
                                   .axes = {{.complex = complex, .surface = {}, .statistics = {}}},
                                   .statistics = {}};
    expect_silent("with_short_edges", [&](const Execution& e) { with_short_edges(torus_mesh(1.0, 0.4, 20), 0.1, e); });
    expect_silent("view_data", [&](const Execution& e) { view_data(viewed_torus, e); });
}

TEST(Progress, OfSolids) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const TriangleMesh mesh = torus_mesh(1.0, 0.4, 20);
    const std::vector<Ball> balls{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}};
    const auto value = [&](const Point& p) { return torus.value(p); };
    const auto values = [&](std::span<const Point> points, std::span<double> result) {
        std::ranges::transform(points, result.begin(), value);
    };
    const FunctionOptions bounded{.bounds = centered_box(2.0, 2.0, 1.0), .smallest_feature = 0.2};
    const Image mask_of_torus = sampled(as_mask(value), centered_box(2.0, 2.0, 1.0), 32);
    const PreparedCloud cloud = prepare(PointCloud{sample(torus, {.tolerance = 0.1}).points, {}});
    const RepairedMesh repaired = repair(mesh);
    expect_observable("repair", [&](const Execution& e) { repair(mesh, e); });
    expect_observable("mesh_solid", [&](const Execution& e) { mesh_solid(mesh, e); });
    expect_observable("mesh_solid of a repaired mesh", [&](const Execution& e) { mesh_solid(repaired, e); });
    expect_observable("solid_of_triangles", [&](const Execution& e) { solid_of_triangles(mesh, {}, e); });
    expect_observable("union_solid", [&](const Execution& e) { union_solid(balls, e); });
    expect_observable("function_solid", [&](const Execution& e) { function_solid(value, bounded, e); });
    expect_observable("function_solid of many", [&](const Execution& e) { function_solid(values, bounded, e); });
    expect_silent("check of an image", [&](const Execution& e) { check(mask_of_torus, e); });
    expect_silent("labels", [&](const Execution& e) { labels(mask_of_torus, e); });
    expect_silent("mask", [&](const Execution& e) { mask(mask_of_torus, {}, e); });
    expect_observable("smoothed_mask", [&](const Execution& e) { smoothed_mask(mask_of_torus, {}, e); });
    expect_observable("smoothed_mask of 0", [&](const Execution& e) { smoothed_mask(mask_of_torus, {0.0}, e); });
    expect_observable("image_solid", [&](const Execution& e) { image_solid(mask_of_torus, {}, e); });
    expect_silent("topology of an image", [&](const Execution& e) { topology(mask_of_torus, {}, e); });
    expect_observable("prepare", [&](const Execution& e) { prepare(cloud.cloud, {}, e); });
    expect_observable("crust", [&](const Execution& e) { crust(cloud, e); });
    expect_observable("choose_method", [&](const Execution& e) { choose_method(cloud, e); });
    expect_observable("cloud_solid", [&](const Execution& e) { cloud_solid(cloud, {}, e); });
    expect_silent("run_concurrently", [&](const Execution& e) {
        run_concurrently(
            3, [](std::size_t) {}, e);
    });
}

class ProgressOfFiles : public FolderTest {};

TEST_F(ProgressOfFiles, AndOfThePipeline) {
    write_mesh(path("torus.off"), torus_mesh(1.0, 0.4, 20));
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const Samples samples = sample(torus, {.tolerance = 0.15});
    const std::vector<Ball> balls = inner_balls(samples);
    const Envelope envelope(medial_axis(balls).complex);
    const ScaleAxisOptions options{.scales = {1.0, 1.1, 1.3}, .smoothing_rounds = 2};
    const auto value = [&](const Point& p) { return torus.value(p); };
    const Image mask = sampled(as_mask(value), centered_box(2.0, 2.0, 1.0), 32);
    const MeshObjects objects{.objects = {{"torus", torus_mesh(1.0, 0.4, 20)}}, .warnings = {}};
    expect_observable("scale_axis",
                      [&](const Execution& e) { scale_axis(torus, {.delta = Length::relative(0.05)}, e); });
    expect_observable("scale_axis of samples", [&](const Execution& e) { scale_axis(samples, options, e); });
    expect_observable("sampled_union", [&](const Execution& e) { sampled_union(torus, {.tolerance = 0.15}, {}, e); });
    expect_observable("choose_delta", [&](const Execution& e) { choose_delta(torus, {}, {}, {}, e); });
    expect_observable("union_mesh",
                      [&](const Execution& e) { union_mesh(balls, {.delta = Length::relative(0.05)}, e); });
    expect_observable("envelope_mesh",
                      [&](const Execution& e) { envelope_mesh(envelope, {.delta = Length::relative(0.05)}, e); });
    expect_observable("load_solid", [&](const Execution& e) { load_solid(path("torus.off"), {}, e); });
    expect_observable("load_solid of an image", [&](const Execution& e) { load_solid(mask, {}, e); });
    expect_observable("load_label", [&](const Execution& e) { load_label(mask, report_of(mask), 1.0F, {}, e); });
    expect_observable("load_solid of objects", [&](const Execution& e) { load_solid(objects, {}, e); });
}

/// Does `work`, which has no parallel loop, stop if it is cancelled on its way?
void expect_cancellable(const std::function<void()>& work) {
    std::stop_source stop;
    bool has_ended = false;
    const auto run = [&] {
        stop.request_stop();
        work();
        has_ended = true;
    };
    EXPECT_THROW(cancellable(stop.get_token(), run), Cancelled);
    EXPECT_FALSE(has_ended);
}

TEST(Cancellation, IsNoticedWhereGigabytesAreMoved) {
    struct Item {
        std::uint64_t key;
    };
    expect_cancellable([] {
        std::vector<Item> items{{3}, {1}, {2}};
        radix_sort(items);
    });
    expect_cancellable([] {
        std::vector<std::vector<Point>> parts(2);
        join(parts);
    });
}

// However few pieces the range is divided into.
TEST(Cancellation, EndsALoopAfterTheCallsThatHaveBegun) {
    constexpr int kGrain = 4;
    std::stop_source stop;
    int calls = 0;
    const auto loop = [&] {
        for_each_index(
            100'000,
            [&](int) {
                if (++calls == 10) {
                    stop.request_stop();
                }
            },
            kGrain);
    };
    EXPECT_THROW(in_arena({.threads = 1, .cancel = stop.get_token()}, loop), Cancelled);
    EXPECT_LE(calls, 10 + kGrain);
}

}  // namespace
}  // namespace scaleaxis
