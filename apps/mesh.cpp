// SPDX-License-Identifier: Apache-2.0
// scaleaxis mesh: union of balls, or axis → triangle mesh.
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "balls_or_axis.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/union_mesh.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct MeshOptions {
    BallsOrAxisOptions given;
    std::string output;
    std::string output_format;
    std::optional<Length> delta;
    CommonOptions common;
};

Status run_mesh(MeshOptions options, const std::stop_token& cancel) {
    const fs::path output =
        checked_output(output_pattern(options.output, "mesh", false, options.output_format), options.given.input, 1.0,
                       options.common.statistics, with_format(check_mesh_output, options.output_format));
    const std::string format = written_format(output, options.output_format);
    options.common.has_data_on_stdout = is_stdout(output);

    ProgressBar bar(options.given.input.filename().string(), options.common.verbosity());
    Stopwatch watch;
    const BallsOrAxis given = reading(options.given.input, options.given.format, [&](const fs::path& path) {
        return read_balls_or_axis(path, options.given.takes_balls_only, options.given.scale);
    });
    std::vector<StageCost> costs{watch.lap("reading")};
    const auto meshed = [&](const auto& solid) {
        const double tolerance = tolerance_of(options.delta.value_or(kDefaultDelta), solid.bounds().diagonal());
        const UnionMeshOptions mesh_options{Length::absolute(tolerance), options.common.seed};
        const Execution execution = bar.execution(options.common.threads, cancel);
        if constexpr (std::is_same_v<decltype(solid), const Envelope&>) {
            return envelope_mesh(solid, mesh_options, execution);
        } else {
            return union_mesh({solid.balls().begin(), solid.balls().end()}, mesh_options, execution);
        }
    };
    const UnionMesh mesh = std::visit(meshed, given.solid);
    costs.insert(costs.end(), mesh.costs.begin(), mesh.costs.end());
    for (const Diagnostic& warning : mesh.warnings) {
        warn_above(bar, options.given.input)(warning);
    }
    bar.erase();
    stop_if_requested(cancel);
    watch.lap("");
    write_mesh(output, mesh.boundary.mesh, format);
    costs.push_back(watch.lap("writing"));

    if (options.common.has_summary()) {
        std::ostringstream text;
        text << options.given.input.string() << '\n';
        print_balls(text, given.balls);
        print(text, mesh, output);
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.mesh/2");
    document.update({{"input", options.given.input.string()},
                     {"seed", options.common.seed},
                     {"balls", given.balls},
                     {"surface", Json::parse(to_json(mesh, output))},
                     {"costs", json_of(costs)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace

Command mesh_command(CommandLine program) {
    const CommandLine command = program.add_subcommand(
        "mesh", "Triangle mesh of the boundary of a union of balls, or of the envelope of an axis");
    auto options = std::make_shared<MeshOptions>();
    add_balls_or_axis_options(command, options->given);
    add_output_option(command, options->output, options->output_format,
                      "Mesh: .ply, .obj, .off or .stl;\n"
                      "a folder gets {name}-mesh.ply; {name} is filled in");
    add_delta_options(command, options->delta, nullptr);
    add_common_options(command, options->common);
    command.footer(
        "The mesh is closed and a manifold. Where the boundary of the balls is none, it is cut apart, with a warning.\n"
        "Examples:\n"
        "  scaleaxis mesh cat-balls.ply --delta 0.01 -o cat.off\n"
        "  scaleaxis mesh molecule.xyzr --delta-abs 0.2 -o molecule.stl");
    return {command, [options](const std::stop_token& cancel) { return run_mesh(*options, cancel); }};
}

}  // namespace scaleaxis::app
