// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid.hpp"

#include <utility>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

Solid read_solid(const std::filesystem::path& file, const Execution& execution, bool keeps_mesh) {
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
    if (keeps_mesh) {
        solid.mesh = repaired.mesh;
    }
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
