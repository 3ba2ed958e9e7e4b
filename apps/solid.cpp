// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid.hpp"

#include <utility>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

Solid read_cloud(const std::filesystem::path& file, const Execution& execution, const PointOptions& options) {
    Solid solid;
    Stopwatch watch;
    PointCloud cloud = read_points(file);
    solid.costs.push_back(watch.lap("reading"));
    stop_if_interrupted();

    const PreparedCloud prepared = prepare(std::move(cloud), execution);
    solid.costs.push_back(watch.lap("normals"));
    for (const std::string& warning : prepared.report.warnings()) {
        print_warning(file.string() + ": " + warning);
    }
    if (!prepared.report.fault.empty()) {
        throw UnusableShape(file.string() + ": " + prepared.report.fault);
    }
    solid.cloud = prepared.report;
    const CloudChoice choice = options.method ? CloudChoice{*options.method, "as asked for"} : choose_method(prepared.report);
    print_warning(file.string() + ": " + (choice.method == CloudMethod::kCrust ? "crust: " : "mls: ") + choice.reason);
    print_warning(prepared.report.note() + " kernel " + std::to_string(prepared.report.kernel) + " noise " + std::to_string(prepared.report.noise)+ " border " + std::to_string(prepared.report.border_points)+ " spacing/D " + std::to_string(prepared.report.spacing/prepared.report.bounds.diagonal()));
    if (choice.method == CloudMethod::kCrust) {
        solid.samples = crust(prepared, execution);
        solid.costs.push_back(watch.lap("crust"));
    } else {
        solid.shape = moving_least_squares(prepared, {.kernel = options.kernel}, execution);
        solid.costs.push_back(watch.lap("search tree"));
    }
    return solid;
}

Solid read_solid(const std::filesystem::path& file, const Execution& execution, const PointOptions& points) {
    if (file_kind(file) == FileKind::kPoints) {
        return read_cloud(file, execution, points);
    }
    Solid solid;
    Stopwatch watch;
    TriangleMesh mesh = read_mesh(file);
    solid.costs.push_back(watch.lap("reading"));
    stop_if_interrupted();

    RepairedMesh repaired = repair(std::move(mesh), execution);
    solid.costs.push_back(watch.lap("repair"));
    for (const std::string& warning : repaired.report.warnings()) {
        print_warning(file.string() + ": " + warning);
    }
    if (!repaired.report.fault.empty()) {
        throw UnusableShape(file.string() + ": " + repaired.report.fault);
    }
    solid.report = repaired.report;
    solid.shape = mesh_shape(std::move(repaired), execution);
    solid.costs.push_back(watch.lap("search tree"));
    return solid;
}

std::vector<Ball> balls_of(const MedialComplex& complex) {
    std::vector<Ball> balls(complex.vertices.size());
    for (std::size_t v = 0; v < balls.size(); ++v) {
        balls[v] = {complex.vertices[v], complex.radii[v]};
    }
    return balls;
}

std::vector<Ball> read_union(const std::filesystem::path& file) {
    return file_kind(file) == FileKind::kAxis ? balls_of(read_axis(file)) : read_balls(file);
}

}  // namespace scaleaxis::app
