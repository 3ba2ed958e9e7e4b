// SPDX-License-Identifier: Apache-2.0
//
// Times the question for the nearest point of the boundary: the same solid as a mesh, an image, a cloud, a union of
// balls, and a function.
#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/random.hpp"
#include "bench_common.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "spatial/spatial_order.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::filesystem::path mesh;
    double delta = 0.01;
    int count = 20000;
    int repeat = 3;
    Outputs outputs;
};

const Execution kOneThread{1, {}};

/// Points inside, those near to each other in a row, as the stages ask.
std::vector<Point> points_inside(const Solid& solid, int count) {
    const Box box = solid.bounds();
    const Point side = box.max - box.min;
    std::vector<Point> points;
    for (std::uint64_t i = 0; points.size() < static_cast<std::size_t>(count); ++i) {
        const Point p = box.min + Point{random_unit(1, i, 0) * side.x, random_unit(1, i, 1) * side.y,
                                        random_unit(1, i, 2) * side.z};
        if (solid.inside(p)) {
            points.push_back(p);
        }
    }
    std::vector<Point> result;
    for (const Index i : hilbert_order(points)) {
        result.push_back(points[i]);
    }
    return result;
}

/// Negative inside.
double signed_distance(const Solid& solid, const Point& p) {
    return (solid.inside(p) ? -1.0 : 1.0) * distance(p, *solid.nearest(p));
}

std::unique_ptr<Solid> as_image(const Solid& solid, double voxel) {
    const Box box = solid.bounds();
    const auto size = [&](double side) { return static_cast<Index>(std::ceil(side / voxel)) + 4; };
    Image image;
    image.sizes = {size(box.max.x - box.min.x), size(box.max.y - box.min.y), size(box.max.z - box.min.z)};
    image.origin = box.min - Point{1.5 * voxel, 1.5 * voxel, 1.5 * voxel};
    image.steps = {Point{voxel, 0, 0}, Point{0, voxel, 0}, Point{0, 0, voxel}};
    for (Index k = 0; k < image.sizes[2]; ++k) {
        for (Index j = 0; j < image.sizes[1]; ++j) {
            for (Index i = 0; i < image.sizes[0]; ++i) {
                const Point p = image.origin + voxel * Point{1.0 * i, 1.0 * j, 1.0 * k};
                image.values.push_back(static_cast<float>(signed_distance(solid, p)));
            }
        }
    }
    return image_solid(std::move(image), Level{0.0, true}, kOneThread);
}

/// What is inside `solid` by its own distance: as costly as functions are.
std::unique_ptr<Solid> as_function(const Solid& solid, double feature) {
    const Box box = solid.bounds();
    const Point margin = 0.05 * (box.max - box.min);
    const std::function<double(const Point&)> function = [&](const Point& p) { return signed_distance(solid, p); };
    return function_solid(function, {{box.min - margin, box.max + margin}, feature}, kOneThread);
}

void run(const Settings& settings) {
    const auto mesh = mesh_solid(read_solid(settings.mesh), kOneThread);
    const double tolerance = settings.delta * mesh->bounds().diagonal();
    const Samples samples = sample(*mesh, {.tolerance = tolerance, .sizing = Sizing::kUniform}, kOneThread);
    std::vector<std::pair<std::string, std::unique_ptr<Solid>>> solids;
    solids.emplace_back("image", as_image(*mesh, tolerance));
    solids.emplace_back("cloud", cloud_solid(prepare(PointCloud{samples.points, {}}, {}, kOneThread), {}, kOneThread));
    solids.emplace_back("union", union_solid(inner_balls(samples), kOneThread));
    solids.emplace_back("function", as_function(*mesh, tolerance));
    solids.emplace_back("mesh", mesh_solid(read_solid(settings.mesh), kOneThread));

    const std::vector<Point> points = points_inside(*mesh, settings.count);
    std::string table = markdown_header({"solid", "preparation, s", "no bound, µs", "1 % above, µs"});
    Json report;
    for (const auto& [name, solid] : solids) {
        std::vector<std::optional<Point>> nearest(points.size());
        std::vector<double> bounds(points.size(), std::numeric_limits<double>::infinity());
        const auto ask = [&] {
            const double seconds = seconds_of([&] { solid->nearest(points, bounds, nearest); });
            return 1e6 * seconds / static_cast<double>(points.size());
        };
        const double preparation = seconds_of([&] { solid->prepare_nearest(); });
        std::vector<double> unbounded, bounded;
        for (int i = 0; i < settings.repeat; ++i) {
            unbounded.push_back(ask());
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            bounds[i] = nearest[i] ? 1.01 * distance(points[i], *nearest[i]) : bounds[i];
        }
        for (int i = 0; i < settings.repeat; ++i) {
            bounded.push_back(ask());
        }
        report[name] = {
            {"preparation", preparation}, {"unbounded", measured(unbounded)}, {"bounded", measured(bounded)}};
        table += markdown_row({name, fixed(preparation, 3), fixed(median(unbounded), 2), fixed(median(bounded), 2)});
    }
    publish(settings.outputs, table, report);
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Times the question for the nearest point of the boundary, one thread.");
    program.add_option("mesh", settings.mesh, "Closed triangle mesh")->required();
    program.add_option("--delta", settings.delta, "Samples, voxels and features, relative to the bounding box")
        ->capture_default_str();
    program.add_option("--points", settings.count, "Questions")->capture_default_str();
    program.add_option("--repeat", settings.repeat, "Repetitions")->capture_default_str()->check(CLI::PositiveNumber);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    return exit_status([&] { run(settings); });
}
