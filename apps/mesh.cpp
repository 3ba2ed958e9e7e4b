// SPDX-License-Identifier: GPL-3.0-or-later
// scaleaxis mesh: union of balls → triangle mesh.
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "report.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/io.hpp"
#include "solid.hpp"
#include "stopwatch.hpp"
#include "surface.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct MeshOptions {
    fs::path input;
    std::string output;
    double delta = ScaleAxisOptions().delta;
    std::optional<double> absolute_delta;
    bool is_tight = false;
    CommonOptions common;
};

Status run_mesh(const MeshOptions& options) {
    const fs::path output = checked_output(output_pattern(options.output, "mesh", false), options.input, 1.0,
                                           options.common.statistics, check_mesh_output);

    ProgressBar bar(options.input.filename().string(), options.common.verbosity());
    const Execution execution = bar.execution(options.common.threads);
    Stopwatch reading;
    const std::vector<Ball> balls = read_union(options.input);
    std::vector<StageCost> costs{reading.lap("reading")};
    stop_if_interrupted();
    const double length = tolerance(bounds(balls).diagonal(), options.delta, options.absolute_delta);
    const Surface surface = surface_of(balls, length, options.is_tight, options.common.seed, execution);
    costs.insert(costs.end(), surface.costs.begin(), surface.costs.end());
    bar.erase();
    for (const std::string& warning : surface.warnings) {
        print_warning(options.input.string() + ": " + warning);
    }
    stop_if_interrupted();
    Stopwatch writing;
    write_mesh(output, surface.boundary.mesh);
    costs.push_back(writing.lap("writing"));

    if (options.common.has_summary()) {
        std::ostringstream text;
        text << options.input.string() << '\n';
        print_balls(text, balls.size(), std::nullopt);
        print(text, surface, output);
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.mesh/1");
    document.update({{"input", options.input.string()},
                     {"seed", options.common.seed},
                     {"balls", balls.size()},
                     {"surface", to_json(surface, output)},
                     {"costs", to_json(costs)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace

Command mesh_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("mesh", "Triangle mesh of the boundary of a union of balls");
    auto options = std::make_shared<MeshOptions>();
    add_union_argument(*command, options->input);
    command
        ->add_option("-o,--output", options->output,
                     "Mesh: .ply, .obj, .off or .stl;\n"
                     "a folder gets {name}-mesh.ply; {name} is filled in")
        ->required()
        ->option_text("OUT");
    add_delta_options(*command, options->delta, options->absolute_delta);
    command
        ->add_flag("--tight", options->is_tight,
                   "Sample more densely than --delta, down to an eighth of it, where the triangles\n"
                   "are farther than an eighth of it from the balls; at most twice the samples")
        ->option_text(" ");
    add_common_options(*command, options->common);
    command->footer(
        "The mesh is closed and a manifold. Where the boundary of the balls is none, it is cut apart, with a warning.\n"
        "Examples:\n"
        "  scaleaxis mesh cat-balls.ply --delta 0.01 -o cat.off\n"
        "  scaleaxis mesh molecule.xyzr --delta-abs 0.2 -o molecule.stl");
    return {command, [options] { return run_mesh(*options); }};
}

}  // namespace scaleaxis::app
