// SPDX-License-Identifier: Apache-2.0
//
// Times the distance of two meshes beside what it cannot do without: a hierarchy for each, and a nearest-point query
// for each of about as many points; or that of two unions of nearly equal balls beside the sampling of both.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "bench_common.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/solid.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::array<std::filesystem::path, 2> inputs;
    int balls = 13'000;
    double spacing = 0.002;
    int repeat = 3;
    Outputs outputs;
};

/// One for each triangle.
std::vector<Point> random_points(const TriangleMesh& mesh) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        points.push_back(point_of_triangle(mesh, mesh.triangles[i], random_unit(1, i, 0), random_unit(1, i, 1)));
    }
    return points;
}

void run(const Settings& settings) {
    const std::array<TriangleMesh, 2> meshes{read_mesh(settings.inputs[0]), read_mesh(settings.inputs[1])};
    const std::array<std::vector<Point>, 2> points{random_points(meshes[0]), random_points(meshes[1])};
    const double spacing = settings.spacing * surface_bounds(meshes[0]).diagonal();
    std::vector<double> hierarchies, queries, distances;
    SurfaceDistance result;
    double sum = 0.0;  // so that no query is left out
    for (int i = 0; i < settings.repeat; ++i) {
        std::array<Bvh, 2> trees;
        hierarchies.push_back(seconds_of([&] { trees = {build_bvh(meshes[0]), build_bvh(meshes[1])}; }));
        const std::array<TriangleBounds, 2> bounds{triangle_bounds(trees[0]), triangle_bounds(trees[1])};
        queries.push_back(seconds_of([&] {
            for (const int side : {0, 1}) {
                for (const Point& p : points[side]) {
                    sum += std::sqrt(nearest_triangle(trees[1 - side], bounds[1 - side], p).squared_distance);
                }
            }
        }));
        distances.push_back(seconds_of([&] {
            result = surface_distance(meshes[0], meshes[1], {.spacing = spacing, .accuracy = 0.05 * spacing}, {1, {}});
        }));
    }
    const double ratio = bench::median(distances) / (bench::median(hierarchies) + bench::median(queries));
    const Json report{
        {"triangles", {meshes[0].triangles.size(), meshes[1].triangles.size()}},
        {"queries", points[0].size() + points[1].size()},
        {"mean_of_queries", sum / settings.repeat / static_cast<double>(points[0].size() + points[1].size())},
        {"samples", {result.a_to_b.samples, result.b_to_a.samples}},
        {"hausdorff", result.max()},
        {"error", result.error()},
        {"hierarchies", measured(hierarchies)},
        {"nearest_points", measured(queries)},
        {"distance", measured(distances)},
        {"ratio", ratio}};
    const std::string table =
        markdown_header(
            {"triangles", "points", "hierarchies", "nearest points of as many as triangles", "distance", "ratio"}) +
        markdown_row({report["triangles"].dump(), report["samples"].dump(), fixed(bench::median(hierarchies), 3),
                      fixed(bench::median(queries), 3), fixed(bench::median(distances), 3), fixed(ratio, 2)});
    publish(settings.outputs, table, report);
}

/// As along a limb bent to a ring: radii of 0.2, and rounding of a millionth.
BallUnion limb(int count, std::uint64_t seed) {
    constexpr double kNoise = 1e-6;
    std::vector<Ball> balls;
    for (int i = 0; i < count; ++i) {
        const auto noise = [&](std::uint64_t k) { return kNoise * (random_unit(seed, i, k) - 0.5); };
        const double angle = 2.0 * std::numbers::pi * (i + random_unit(seed, i, 4)) / count;
        balls.push_back({{std::cos(angle) + noise(0), std::sin(angle) + noise(1), noise(2)}, 0.2 + noise(3)});
    }
    return BallUnion(std::move(balls));
}

void run_with_balls(const Settings& settings) {
    std::vector<double> samplings, distances;
    SurfaceDistance result;
    for (int i = 0; i < settings.repeat; ++i) {
        // What is built once is to be built again.
        const std::array<BallUnion, 2> unions{limb(settings.balls, 1), limb(settings.balls, 2)};
        const double spacing = settings.spacing * unions[0].bounds().diagonal();
        samplings.push_back(seconds_of([&] {
            for (const int side : {0, 1}) {
                sample(*union_solid(limb(settings.balls, 1 + side), {1, {}}), {.tolerance = spacing}, {1, {}});
            }
        }));
        distances.push_back(seconds_of([&] {
            result = surface_distance(unions[0], unions[1], {.spacing = spacing, .accuracy = 0.05 * spacing}, {1, {}});
        }));
    }
    const double ratio = bench::median(distances) / bench::median(samplings);
    const Json report{{"balls", settings.balls},         {"samples", {result.a_to_b.samples, result.b_to_a.samples}},
                      {"hausdorff", result.max()},       {"samplings", measured(samplings)},
                      {"distance", measured(distances)}, {"ratio", ratio}};
    publish(settings.outputs,
            markdown_header({"balls", "points", "samplings", "distance", "ratio"}) +
                markdown_row({report["balls"].dump(), report["samples"].dump(), fixed(bench::median(samplings), 3),
                              fixed(bench::median(distances), 3), fixed(ratio, 2)}),
            report);
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Times the distance of two meshes, or without them of two unions of balls; one thread.");
    CLI::Option* a = program.add_option("a", settings.inputs[0], "Mesh");
    CLI::Option* b = program.add_option("b", settings.inputs[1], "Mesh")->needs(a);
    a->needs(b);
    program.add_option("--balls", settings.balls, "Of each union")->capture_default_str()->check(CLI::PositiveNumber);
    program.add_option("--spacing", settings.spacing, "As of 'scaleaxis compare'")->capture_default_str();
    program.add_option("--repeat", settings.repeat, "Repetitions")->capture_default_str()->check(CLI::PositiveNumber);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    return exit_status([&] { settings.inputs[0].empty() ? run_with_balls(settings) : run(settings); });
}
