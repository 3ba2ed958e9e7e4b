// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface.hpp"

#include <memory>
#include <ostream>
#include <utility>

#include "scaleaxis/shape.hpp"
#include "stopwatch.hpp"

namespace scaleaxis::app {

namespace {

std::vector<std::string> warnings_of(const Surface& surface) {
    std::vector<std::string> warnings;
    const Index cuts = surface.boundary.copied_vertices + surface.boundary.parted_edges;
    if (cuts > 0) {
        warnings.push_back("the boundary of the balls is no manifold in " + std::to_string(cuts) +
                           " places, where parts touch: the mesh is cut apart there");
    }
    if (surface.boundary.lost_samples > 0) {
        warnings.push_back(std::to_string(surface.boundary.lost_samples) +
                           " samples have no triangle: parts of the boundary that are much smaller than the tolerance "
                           "are left out; use a smaller one to have them");
    }
    // Half the Euler characteristic of the boundary is that of the solid.
    if (surface.solid && surface.report.euler != 2 * surface.solid->euler) {
        warnings.push_back("the Euler characteristic of the mesh is " + std::to_string(surface.report.euler) +
                           ", that of the boundary of the balls is " + std::to_string(2 * surface.solid->euler) +
                           ": they have tunnels, gaps or voids smaller than the tolerance; use a smaller one");
    }
    return warnings;
}

}  // namespace

Surface surface_of(std::vector<Ball> balls, double tolerance, bool is_tight, std::uint64_t seed,
                   const Execution& execution) {
    Surface surface;
    Stopwatch watch;
    const std::unique_ptr<Shape> shape = union_of_balls(std::move(balls), execution);
    surface.solid = shape->topology();
    surface.costs.push_back(watch.lap("union of balls"));
    SamplingOptions options = boundary_sampling(tolerance, is_tight);
    options.seed = seed;
    const Samples samples = sample(*shape, options, execution);
    surface.tolerance = tolerance;
    surface.samples = static_cast<Index>(samples.points.size());
    surface.sampling = samples.statistics;
    surface.costs.push_back(watch.lap("sampling"));
    surface.boundary = boundary_mesh(samples, execution);
    surface.costs.push_back(watch.lap("boundary mesh"));
    surface.report = repair(surface.boundary.mesh, execution).report;
    surface.costs.push_back(watch.lap("mesh check"));
    surface.warnings = warnings_of(surface);
    return surface;
}

Json to_json(const Surface& surface, const std::filesystem::path& file) {
    return {{"file", file.string()},
            {"solid", surface.solid ? to_json(*surface.solid) : Json(nullptr)},
            {"tolerance", surface.tolerance},
            {"samples", surface.samples},
            {"sampling", to_json(surface.sampling)},
            {"mesh", to_json(surface.report)},
            {"copied_vertices", surface.boundary.copied_vertices},
            {"parted_edges", surface.boundary.parted_edges},
            {"lost_samples", surface.boundary.lost_samples},
            {"warnings", surface.warnings}};
}

void print(std::ostream& out, const Surface& surface, const std::filesystem::path& file) {
    print_solid(out, "", surface.solid);
    print(out, surface.samples, surface.tolerance, surface.sampling);
    label(out, "surface") << "-> " << file.string() << '\n';
    print(out, surface.report);
}

}  // namespace scaleaxis::app
