// SPDX-License-Identifier: Apache-2.0
// scaleaxis skeleton: solid, or stored axis → curve skeleton.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "page.hpp"
#include "readable.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/skeleton.hpp"
#include "scaleaxis/view.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
#include "stored_axis.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

const Choices<SkeletonRadius> kRadiusNames{{"inscribed", SkeletonRadius::kInscribed}, {"mean", SkeletonRadius::kMean}};

struct CurveOptions {
    fs::path input;
    SourceOptions source;
    std::string output;
    std::string output_format;
    std::string parts;  ///< where to write the surface in parts; empty: nowhere
    std::string view;   ///< where to write the interactive page; empty: nowhere
    ScaleAxisOptions pipeline;
    double scale = 1.1;
    bool has_scale = false;
    std::optional<Length> spacing;
    double significance = SkeletonOptions().significance;
    SkeletonRadius radius = SkeletonRadius::kInscribed;
    CommonOptions common;
};

/// An input and its skeleton.
struct FoundSkeleton {
    MedialComplex complex;
    Skeleton skeleton;
    TriangleMesh surface;  ///< of the input, where parts or a page are asked for
    double scale = 1.0;
    std::vector<StageCost> costs;
};

SkeletonOptions skeleton_options(const CurveOptions& options, double scale, double diagonal) {
    return {.spacing = options.spacing ? options.spacing->of(diagonal) : 0.0,
            .significance = options.significance,
            .scale = scale,
            .radius = options.radius};
}

/// Options that say how an axis is computed have no effect on one that is stored.
bool has_axis_options(const CurveOptions& options) {
    return has_sampling_options(options.pipeline) || options.pipeline.cleaning || !options.parts.empty();
}

FoundSkeleton of_stored_axis(const CurveOptions& options, const fs::path& path, ProgressBar& bar,
                             const std::stop_token& cancel) {
    if (has_axis_options(options)) {
        throw InvalidOption(options.input.string() +
                            " is an axis: --delta, --clean, --sampling and --parts are for solids");
    }
    check_unused(options.source, "an axis that is there already", {"--as", "--format"});
    FoundSkeleton outcome;
    Stopwatch watch;
    outcome.complex = read_stored_axis(path);
    for (const Diagnostic& warning : coarse_axis_warning(outcome.complex)) {
        warn_above(bar, options.input)(warning);
    }
    outcome.costs.push_back(watch.lap("reading"));
    outcome.scale = scale_of_axis(path, options.has_scale ? std::optional(options.scale) : std::nullopt);
    outcome.skeleton = skeleton(outcome.complex,
                                skeleton_options(options, outcome.scale, report_of(outcome.complex).bounds.diagonal()),
                                bar.execution(options.common.threads, cancel));
    outcome.costs.push_back(watch.lap("skeleton"));
    return outcome;
}

ScaleAxis axis_of(LoadedSolid& input, ScaleAxisOptions options, const Execution& execution) {
    if (!input.samples) {
        return scale_axis(*input.solid, options, execution);
    }
    return scale_axis(std::move(*input.samples), without_sampling_options(options), execution);
}

FoundSkeleton of_solid(const CurveOptions& options, const Source& source, ProgressBar& bar,
                       const std::stop_token& cancel) {
    const auto warn = warn_above(bar, source.name);
    const bool has_surface = !options.parts.empty() || !options.view.empty();
    const auto execution = [&](double begin, double end) {
        return bar.execution(options.common.threads, cancel, {begin, end});
    };
    LoadedSolid input = load_source(source, execution(0.0, 0.1), warn, has_surface);
    ScaleAxisOptions pipeline = options.pipeline;
    pipeline.scales = {options.scale};
    pipeline.seed = options.common.seed;
    pipeline.reaches_sharp_edges = false;
    pipeline.keeps_samples = has_surface && input.mesh.triangles.empty();
    ScaleAxis axis = axis_of(input, pipeline, execution(0.1, 0.8));
    const std::size_t told = input.solid ? input.solid->warnings().size() : 0;
    std::for_each(axis.warnings.begin() + static_cast<std::ptrdiff_t>(told), axis.warnings.end(), warn);
    FoundSkeleton outcome;
    outcome.scale = options.scale;
    outcome.costs = input.costs;
    outcome.costs.insert(outcome.costs.end(), axis.costs.begin(), axis.costs.end());
    outcome.costs.insert(outcome.costs.end(), axis.axes[0].costs.begin(), axis.axes[0].costs.end());
    Stopwatch watch;
    outcome.complex = std::move(axis.axes[0].complex);
    const SkeletonOptions curve_options = skeleton_options(options, options.scale, axis.diagonal);
    outcome.skeleton = input.solid && input.solid->knows_nearest()
                           ? skeleton(outcome.complex, *input.solid, curve_options, execution(0.8, 1.0))
                           : skeleton(outcome.complex, BallUnion(scaled(axis.balls, options.scale)), curve_options,
                                      execution(0.8, 1.0));
    outcome.costs.push_back(watch.lap("skeleton"));
    if (has_surface) {
        outcome.surface = input.mesh.triangles.empty() ? boundary_mesh(*axis.kept_samples).mesh : std::move(input.mesh);
    }
    return outcome;
}

void warn_of_sheets(const SkeletonStatistics& statistics, ProgressBar& bar, const fs::path& input) {
    if (statistics.faces > 0) {
        warn_above(bar, input)(Diagnostic{
            "skeleton.sheets", "the solid has voids, around which no curve can stand for it: " +
                                   std::to_string(statistics.faces) + " faces of sheets stay in the skeleton"});
    }
}

Status run_skeleton(CurveOptions options, const std::stop_token& cancel) {
    std::vector<Input> inputs;
    if (!options.input.empty()) {
        inputs.push_back({options.input, {}});
    }
    const std::vector<Source> sources = sources_of(inputs, options.source);
    if (sources.size() != 1) {
        throw InvalidOption("scaleaxis skeleton takes one solid at a time: choose one by --label or --object");
    }
    const fs::path& name = sources.front().name;
    const fs::path output = checked_output(
        output_pattern(options.output, "skeleton", false, options.output_format, "swc"), name, options.scale,
        options.common.statistics, with_format(check_skeleton_output, options.output_format, "swc"));
    options.common.has_data_on_stdout = is_stdout(output);
    std::vector<fs::path> outputs{output};
    fs::path parts;
    if (!options.parts.empty()) {
        parts = expand(output_pattern(options.parts, "parts", false), name, options.scale);
        check_output(parts, with_format(check_parts_output, {}));
        outputs.push_back(parts);
    }
    const fs::path page = page_output(options.view, name, options.scale);
    if (!page.empty()) {
        outputs.push_back(page);
    }
    check_distinct({name}, outputs);
    ProgressBar bar(name.filename().string(), options.common.verbosity());
    FoundSkeleton outcome;
    const bool is_axis = !sources.front().file.empty() && !fs::is_directory(options.input) &&
                         reading(options.input, options.source.format,
                                 [](const fs::path& path) { return file_kind(path); }) == FileKind::kAxis;
    if (is_axis) {
        outcome = reading(options.input, options.source.format,
                          [&](const fs::path& path) { return of_stored_axis(options, path, bar, cancel); });
    } else {
        outcome = of_solid(options, sources.front(), bar, cancel);
    }
    const SkeletonStatistics statistics = statistics_of(outcome.skeleton, outcome.complex);
    warn_of_sheets(statistics, bar, name);
    bar.erase();
    stop_if_requested(cancel);
    Stopwatch watch;
    write_skeleton(output, outcome.skeleton, written_format(output, options.output_format, "swc"));
    if (!parts.empty()) {
        write_parts(parts, outcome.surface, outcome.skeleton,
                    nearest_nodes(outcome.skeleton, outcome.complex, outcome.surface.vertices,
                                  {options.common.threads, {}, cancel}),
                    written_format(parts, {}));
    }
    outcome.costs.push_back(watch.lap("writing"));
    if (options.common.has_summary()) {
        std::ostringstream text;
        text << name.string() << " -> " << output.string() << '\n';
        print(text, statistics);
        print(text, outcome.costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.skeleton/1");
    document.update({{"input", name.string()},
                     {"file", output.string()},
                     {"view", page.empty() ? Json(nullptr) : Json(page.string())},
                     {"seed", options.common.seed},
                     {"significance", options.significance},
                     {"skeleton", json_of(statistics)},
                     {"costs", json_of(outcome.costs)}});
    write_statistics(options.common.statistics, document);
    if (!page.empty()) {
        ViewedModel model{name.stem().string(), std::move(outcome.surface), {}, to_text(document)};
        model.axes.push_back({outcome.scale, complex_of(outcome.skeleton), {}, {}});
        write_page(page, model, options.common.has_summary(), {options.common.threads, {}, cancel});
    }
    return kDone;
}

}  // namespace

Command skeleton_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("skeleton", "Curve skeleton of a solid or of a stored axis, with radii");
    auto options = std::make_shared<CurveOptions>();
    command
        .add_option("INPUT", options->input,
                    "A solid, as for scaleaxis axis (mesh, 3D image, points...), or an axis: .ply or .ma;\n"
                    "none with --implicit")
        .value_text(" ");
    add_output_option(command, options->output, options->output_format,
                      "Skeleton: .swc, .graphml, .json, .vtp or .ply; a folder gets {name}-skeleton.swc;\n"
                      "{name} and {scale} are filled in");
    command
        .add_option("--parts", options->parts,
                    "Also write the surface, cut into the parts that belong to the branches: .ply, with colours,\n"
                    "and the node and the branch of each vertex; a folder gets {name}-parts.ply")
        .value_text("FILE");
    command
        .add_option("--view", options->view,
                    "Also write a page that any browser shows, with the shape around the skeleton: .html;\n"
                    "a folder gets {name}-view.html")
        .value_text("FILE");
    add_length_options(command, "--spacing", options->spacing, kSpacingRange,
                       "Distance of the nodes along branches, at most; relative to the diagonal of the bounding box\n"
                       "[1e-06 ... 1; default 0.01]");
    command
        .add_option("--significance", options->significance,
                    "How far a branch sticks out of the others to stay, relative to its own radius; 0: all of them" +
                        range_and_default(kSignificanceRange, options->significance))
        .check(in_range(kSignificanceRange))
        .value_text("F");
    add_choice(command, "--radius", options->radius, kRadiusNames,
               "Of a node: 'inscribed': of the largest ball in the solid around it; 'mean': mean distance to the\n"
               "surface in the plane normal to the branch, which noise does not make smaller\n[default inscribed]");
    add_delta_options(command, options->pipeline.delta, &options->pipeline.delta_range);
    add_sampling_option(command, options->pipeline.sizing);
    const Option scale =
        command
            .add_option("--scale", options->scale,
                        "Factor by which balls are grown, so that small features go; of an axis: by which they had "
                        "been,\nby default as the file says, or else 1" +
                            range_and_default(kScaleRange, options->scale))
            .check(in_range(kScaleRange))
            .value_text("S");
    add_clean_options(command, options->pipeline.cleaning, "half of delta");
    add_source_options(command, options->source);
    add_common_options(command, options->common);
    command.footer(
        "Loops of the solid stay loops; SWC files have trees, and say in a comment where a loop was cut.\n"
        "Examples:\n"
        "  scaleaxis skeleton vessels.nii.gz --label 1 -o vessels.swc\n"
        "  scaleaxis skeleton octopus.off -o octopus.vtp --parts octopus-parts.ply --view octopus.html\n"
        "  scaleaxis skeleton hand-axis.ply --significance 2 -o hand.graphml");
    return {command, [options, scale](const std::stop_token& cancel) {
                options->has_scale = scale.count() > 0;
                return run_skeleton(*options, cancel);
            }};
}

}  // namespace scaleaxis::app
