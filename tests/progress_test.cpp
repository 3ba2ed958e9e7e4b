// SPDX-License-Identifier: Apache-2.0
// Progress of all public functions that take an `Execution`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
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

/// What a call reports: rises from 0 or more, and ends at exactly 1 if there is any report.
void expect_complete(const std::string& name, bool must_report, const std::function<void(const Execution&)>& call) {
    SCOPED_TRACE(name);
    std::vector<double> fractions;
    call({.threads = 2, .progress = [&](std::string_view, double fraction) {
              fractions.push_back(fraction);
              return true;
          }});
    EXPECT_TRUE(std::ranges::is_sorted(fractions)) << testing::PrintToString(fractions);
    if (must_report) {
        ASSERT_FALSE(fractions.empty());
    }
    if (!fractions.empty()) {
        EXPECT_GE(fractions.front(), 0.0);
        EXPECT_EQ(fractions.back(), 1.0);
    }
}

TEST(Progress, OfStagesEndsAtOne) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const Samples samples = sample(torus, {.tolerance = 0.15});
    const std::vector<Ball> balls = inner_balls(samples);
    const MedialAxis axis = medial_axis(balls);
    expect_complete("sample", true, [&](const Execution& e) { sample(torus, {.tolerance = 0.15}, e); });
    expect_complete("inner_balls", true, [&](const Execution& e) { inner_balls(samples, e); });
    expect_complete("medial_axis", true, [&](const Execution& e) { medial_axis(balls, {}, e); });
    expect_complete("filter", true, [&](const Execution& e) { filter(axis.complex, {}, e); });
    expect_complete("densify", true, [&](const Execution& e) { densify(axis.complex, {}, e); });
    expect_complete("smooth", true,
                    [&](const Execution& e) { smooth(axis.complex, axis.ball_union, {.rounds = 2}, e); });
    expect_complete("boundary_mesh", false, [&](const Execution& e) { boundary_mesh(samples, e); });
    expect_complete("signed_distance_image", true,
                    [&](const Execution& e) { signed_distance_image(BallUnion(balls), 16, e); });
    expect_complete("surface_distance", true, [&](const Execution& e) {
        surface_distance(BallUnion(balls), BallUnion(balls), {.spacing = 0.2}, e);
    });
    expect_complete("nearest_balls", false,
                    [&](const Execution& e) { BallUnion(balls).nearest_balls(samples.points, e); });
}

TEST(Progress, OfSolidsEndsAtOne) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const TriangleMesh mesh = torus_mesh(1.0, 0.4, 20);
    const std::vector<Ball> balls{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}};
    const auto value = [&](const Point& p) { return torus.value(p); };
    const Image mask = sampled(as_mask(value), centered_box(2.0, 2.0, 1.0), 32);
    const PreparedCloud cloud = prepare(PointCloud{sample(torus, {.tolerance = 0.1}).points, {}});
    expect_complete("repair", false, [&](const Execution& e) { repair(mesh, e); });
    expect_complete("mesh_solid", false, [&](const Execution& e) { mesh_solid(mesh, e); });
    expect_complete("union_solid", false, [&](const Execution& e) { union_solid(balls, e); });
    expect_complete("function_solid", true, [&](const Execution& e) {
        function_solid(value, {.bounds = centered_box(2.0, 2.0, 1.0), .smallest_feature = 0.2}, e);
    });
    expect_complete("smoothed_mask", true, [&](const Execution& e) { smoothed_mask(mask, {}, e); });
    expect_complete("smoothed_mask of 0", true, [&](const Execution& e) { smoothed_mask(mask, {0.0}, e); });
    expect_complete("image_solid", true, [&](const Execution& e) { image_solid(mask, {}, e); });
    expect_complete("prepare", false, [&](const Execution& e) { prepare(cloud.cloud, {}, e); });
    expect_complete("crust", true, [&](const Execution& e) { crust(cloud, e); });
    expect_complete("choose_method", false, [&](const Execution& e) { choose_method(cloud, e); });
    expect_complete("cloud_solid", false, [&](const Execution& e) { cloud_solid(cloud, {}, e); });
}

class ProgressOfFiles : public FolderTest {};

TEST_F(ProgressOfFiles, AndOfThePipelineEndsAtOne) {
    write_mesh(path("torus.off"), torus_mesh(1.0, 0.4, 20));
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const Samples samples = sample(torus, {.tolerance = 0.15});
    const std::vector<Ball> balls = inner_balls(samples);
    const ScaleAxisOptions options{.scales = {1.0, 1.1, 1.3}, .smoothing_rounds = 2};
    const auto value = [&](const Point& p) { return torus.value(p); };
    const Image mask = sampled(as_mask(value), centered_box(2.0, 2.0, 1.0), 32);
    expect_complete("scale_axis", true, [&](const Execution& e) { scale_axis(torus, {.delta = 0.05}, e); });
    expect_complete("scale_axis of samples", true, [&](const Execution& e) { scale_axis(samples, options, e); });
    expect_complete("union_mesh", true, [&](const Execution& e) { union_mesh(balls, {.delta = 0.05}, e); });
    expect_complete("load_solid", true, [&](const Execution& e) { load_solid(path("torus.off"), {}, e); });
    expect_complete("load_solid of an image", true, [&](const Execution& e) { load_solid(mask, {}, e); });
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

}  // namespace
}  // namespace scaleaxis
