// SPDX-License-Identifier: Apache-2.0
//
// Times the distance of two meshes beside what it cannot do without: a hierarchy for each, and a nearest-point query
// for each of about as many points.
#include <CLI/CLI.hpp>
#include <array>

#include "base/random.hpp"
#include "bench_common.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/io.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::array<std::filesystem::path, 2> inputs;
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
    const double ratio = median(distances) / (median(hierarchies) + median(queries));
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
        markdown_row({report["triangles"].dump(), report["samples"].dump(), fixed(median(hierarchies), 3),
                      fixed(median(queries), 3), fixed(median(distances), 3), fixed(ratio, 2)});
    publish(settings.outputs, table, report);
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Times the distance of two meshes, one thread.");
    program.add_option("a", settings.inputs[0], "Mesh")->required();
    program.add_option("b", settings.inputs[1], "Mesh")->required();
    program.add_option("--spacing", settings.spacing, "As of 'scaleaxis compare'")->capture_default_str();
    program.add_option("--repeat", settings.repeat, "Repetitions")->capture_default_str()->check(CLI::PositiveNumber);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    return exit_status([&] { run(settings); });
}
