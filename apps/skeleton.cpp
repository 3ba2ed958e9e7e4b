// SPDX-License-Identifier: Apache-2.0
// scaleaxis skeleton: solid, or stored axis → curve skeleton.
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "batch.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "page.hpp"
#include "readable.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/centerlines.hpp"
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

constexpr auto kSkeletonSchema = "scaleaxis.skeleton/1";

constexpr double kNodeSpacing = 0.01;  // of the diagonal, where none is given

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
    bool leads_to_openings = false;
    std::vector<std::array<double, 3>> root;  ///< one; empty: the thickest end
    std::vector<std::array<double, 3>> path;  ///< its ends; empty: all curves
    std::optional<Length> step;
    bool has_sections = false;
    CommonOptions common;
};

/// An input and its skeleton.
struct FoundSkeleton {
    MedialComplex complex;
    Skeleton skeleton;
    TriangleMesh surface;  ///< of the input, where parts or a page are asked for
    std::vector<StageCost> costs;
};

SkeletonOptions skeleton_options(const CurveOptions& options, double diagonal) {
    return {.spacing = options.spacing ? options.spacing->of(diagonal) : 0.0,
            .significance = options.significance,
            .radius = options.radius};
}

/// The root, the path between two places, even steps.
Skeleton derived(Skeleton skeleton, const CurveOptions& options, double diagonal) {
    const auto place = [](const std::array<double, 3>& p) { return Point{p[0], p[1], p[2]}; };
    if (!options.root.empty()) {
        skeleton.root = nearest_node(skeleton, place(options.root[0]));
    }
    if (!options.path.empty()) {
        skeleton = path_between(skeleton, place(options.path[0]), place(options.path[1]));
    }
    return options.step ? resampled(skeleton, options.step->of(diagonal)) : skeleton;
}

FoundSkeleton of_stored_axis(const CurveOptions& options, const fs::path& path, const Listener& listener) {
    check_unused_beside_axis(options.source);
    FoundSkeleton outcome;
    Stopwatch watch;
    outcome.complex = read_axis(path, options.has_scale ? std::optional(options.scale) : std::nullopt);
    for (const Diagnostic& warning : coarse_axis_warning(outcome.complex)) {
        listener.warn(options.input, warning);
    }
    outcome.costs.push_back(watch.lap("reading"));
    const double diagonal = report_of(outcome.complex).bounds.diagonal();
    outcome.skeleton = derived(skeleton(outcome.complex, skeleton_options(options, diagonal), listener.execution({})),
                               options, diagonal);
    outcome.costs.push_back(watch.lap("skeleton"));
    return outcome;
}

ScaleAxis axis_of(LoadedSolid& input, ScaleAxisOptions options, const Execution& execution) {
    if (!input.samples) {
        return scale_axis(*input.solid, options, execution);
    }
    return scale_axis(std::move(*input.samples), without_sampling_options(options), execution);
}

FoundSkeleton of_solid(const CurveOptions& options, const Source& source, const Listener& listener) {
    const auto warn = listener.warn_about(source.name);
    const bool has_surface = !options.parts.empty() || !options.view.empty();
    const auto execution = [&](double begin, double end) { return listener.execution({begin, end}); };
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
    outcome.costs = input.costs;
    outcome.costs.insert(outcome.costs.end(), axis.costs.begin(), axis.costs.end());
    outcome.costs.insert(outcome.costs.end(), axis.axes[0].costs.begin(), axis.axes[0].costs.end());
    Stopwatch watch;
    outcome.complex = std::move(axis.axes[0].complex);
    const SkeletonOptions curve_options = skeleton_options(options, axis.diagonal);
    outcome.skeleton = input.solid && input.solid->knows_nearest()
                           ? skeleton(outcome.complex, *input.solid, curve_options, execution(0.8, 1.0))
                           : skeleton(outcome.complex, BallUnion(scaled(axis.balls, options.scale)), curve_options,
                                      execution(0.8, 1.0));
    if (options.leads_to_openings) {
        const auto* mesh = std::get_if<MeshReport>(&input.input);
        if (mesh == nullptr || mesh->holes.empty()) {
            throw InvalidOption(
                "--to-openings has no effect on " + source.name.string() +
                (mesh == nullptr ? ", which is no mesh: leave it out" : ", no hole of which was closed: leave it out"));
        }
        const double spacing = curve_options.spacing > 0.0 ? curve_options.spacing : kNodeSpacing * axis.diagonal;
        outcome.skeleton = led_to_openings(std::move(outcome.skeleton), mesh->holes, spacing);
    }
    outcome.skeleton = derived(std::move(outcome.skeleton), options, axis.diagonal);
    outcome.costs.push_back(watch.lap("skeleton"));
    if (options.has_sections) {
        const Execution all = execution(1.0, 1.0);
        add_sections(outcome.skeleton, input.solid ? *input.solid : *union_solid(axis.balls, all), all);
        outcome.costs.push_back(watch.lap("sections"));
    }
    if (has_surface) {
        outcome.surface = input.mesh.triangles.empty() ? boundary_mesh(*axis.kept_samples).mesh : std::move(input.mesh);
    }
    return outcome;
}

void warn_of_sheets(const SkeletonStatistics& statistics, const fs::path& input, const Listener& listener) {
    if (statistics.faces > 0) {
        listener.warn(
            input, {"skeleton.sheets", "the solid has voids, around which no curve can stand for it: " +
                                           std::to_string(statistics.faces) + " faces of sheets stay in the skeleton"});
    }
}

/// The files that one solid leads to.
struct SkeletonFiles {
    fs::path skeleton;
    fs::path parts;  ///< empty: none
    fs::path page;   ///< empty: none
};

SkeletonFiles files_of(const CurveOptions& options, const Source& source, std::vector<Output>& outputs) {
    const auto add = [&](const std::string& pattern, const OutputCheck& check) {
        const fs::path file = expand(pattern, source.name, options.scale);
        check_output(file, check);
        outputs.push_back({file, source.name});
        return file;
    };
    SkeletonFiles files;
    files.skeleton = add(output_pattern(options.output, "skeleton", false, options.output_format, "swc"),
                         with_format(check_skeleton_output, options.output_format, "swc"));
    const std::string format = format_of(files.skeleton, written_format(files.skeleton, options.output_format, "swc"));
    if (options.has_sections && format != "vtp" && format != "json") {
        throw InvalidOption("--sections has no effect on ." + format +
                            ": write .vtp or .json, which have room for them");
    }
    if (!options.root.empty() && (format == "graphml" || format == "ply")) {
        throw InvalidOption("--root has no effect on ." + format +
                            ", which has no trees: write .swc, .csv, .vtp or .json");
    }
    if (!options.parts.empty()) {
        files.parts = add(output_pattern(options.parts, "parts", false), with_format(check_parts_output, {}));
    }
    if (!options.view.empty()) {
        files.page = page_output(options.view, source.name, options.scale);
        outputs.push_back({files.page, source.name});
    }
    return files;
}

SourceResult run_source(const CurveOptions& options, const Source& source, const SkeletonFiles& files,
                        const Listener& listener, const std::stop_token& cancel) {
    FoundSkeleton outcome =
        source.is_axis ? reading(source, [&](const fs::path& path) { return of_stored_axis(options, path, listener); })
                       : of_solid(options, source, listener);
    const SkeletonStatistics statistics = statistics_of(outcome.skeleton, outcome.complex);
    warn_of_sheets(statistics, source.name, listener);
    stop_if_requested(cancel);
    Stopwatch watch;
    for (const Diagnostic& warning : write_skeleton(files.skeleton, outcome.skeleton,
                                                    written_format(files.skeleton, options.output_format, "swc"))) {
        listener.warn(source.name, warning);
    }
    if (!files.parts.empty()) {
        write_parts(files.parts, outcome.surface, outcome.skeleton,
                    nearest_nodes(outcome.skeleton, outcome.complex, outcome.surface.vertices, listener.execution({})),
                    written_format(files.parts, {}));
    }
    outcome.costs.push_back(watch.lap("writing"));
    std::ostringstream text;
    text << source.name.string() << " -> " << files.skeleton.string() << '\n';
    print(text, statistics);
    print(text, outcome.costs);
    SourceResult result{{{"input", source.name.string()},
                         {"file", files.skeleton.string()},
                         {"view", files.page.empty() ? Json(nullptr) : Json(files.page.string())},
                         {"seed", options.common.seed},
                         {"significance", options.significance},
                         {"skeleton", json_of(statistics)},
                         {"costs", json_of(outcome.costs)}},
                        {}};
    if (!files.page.empty()) {
        Json document = new_document(kSkeletonSchema);
        document.update(result.entry);
        ViewedModel model{source.name.stem().string(), std::move(outcome.surface), {}, to_text(document)};
        model.axes.push_back({complex_of(outcome.skeleton), {}, {}});
        model.axes.back().complex.scale = outcome.complex.scale;
        write_page(files.page, model, false, listener.execution({1.0, 1.0}));
        text << text_of_page(files.page);
    }
    result.summary = text.str();
    return result;
}

Status run_skeleton(CurveOptions options, const std::stop_token& cancel) {
    if (!options.path.empty() && !options.parts.empty()) {
        throw InvalidOption("--parts needs all branches, and --path leaves out most: ask for one of them");
    }
    const std::vector<Source> sources = sources_of_one(options.input, options.source);
    std::vector<Output> outputs;
    std::vector<SkeletonFiles> files;
    for (const Source& source : sources) {
        files.push_back(files_of(options, source, outputs));
    }
    check_all_outputs(outputs, options.common);
    return run_sources(sources, options.source, options.common, new_document(kSkeletonSchema), cancel,
                       [&](std::size_t i, const Listener& listener) {
                           return run_source(options, sources[i], files[i], listener, cancel);
                       });
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
                      "Skeleton: .swc, .graphml, .json, .vtp, .csv or .ply; a folder gets {name}-skeleton.swc;\n"
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
    add_number(command, "--significance", options->significance,
               "How far a branch sticks out of the others to stay, relative to its own radius; 0: all of them",
               kSignificanceRange, "F");
    add_choice(command, "--radius", options->radius, kRadiusNames,
               "Of a node: 'inscribed': of the largest ball in the solid around it; 'mean': mean distance to the\n"
               "surface in the plane normal to the branch, which noise does not make smaller\n[default inscribed]");
    command.add_flag(
        "--to-openings", options->leads_to_openings,
        "Lead curves on to the middles of the holes of an open mesh, which are closed, as of vessels that\n"
        "are cut: by themselves they end a radius before");
    command
        .add_option(
            "--root", options->root,
            "Trees of SWC and CSV, and centerlines of VTP, lead away from the node nearest to this place, as an\n"
            "inlet or a soma, which JSON names; of other parts, and by default, from the thickest end")
        .delimiter(',')
        .expected(1)
        .value_text("X,Y,Z");
    command
        .add_option("--path", options->path,
                    "Only the shortest way along the curves between the nodes nearest to two places")
        .delimiter(',')
        .expected(2)
        .value_text("X,Y,Z X,Y,Z");
    add_length_options(command, "--step", options->step, kSpacingRange,
                       "Even steps: nodes are moved along their branches to equal distances of at most this;\n"
                       "relative to the diagonal [1e-06 ... 1]");
    command.add_flag("--sections", options->has_sections,
                     "Area and widths of the solid's cross-section at each node, in VTP and JSON");
    add_delta_options(command, options->pipeline.delta, &options->pipeline.delta_range);
    add_sampling_option(command, options->pipeline.sizing);
    const Option scale =
        add_number(command, "--scale", options->scale,
                   "Factor by which balls are grown, so that small features go; of an axis: by which they had "
                   "been,\nby default as the file says, or else 1",
                   kScaleRange, "S");
    add_clean_options(command, options->pipeline.cleaning, "half of delta");
    add_source_options(
        command, options->source,
        {"--delta", "--delta-abs", "--sampling", "--clean", "--clean-abs", "--parts", "--to-openings", "--sections"});
    add_common_options(command, options->common);
    command.footer(
        "VTP has a line for each branch, with VMTK's arrays. Loops of the solid stay loops, but SWC and CSV "
        "(cylinders, as\n"
        "TreeQSM has them) have trees: a warning, and in SWC comments, say where a loop was cut.\n"
        "Examples:\n"
        "  scaleaxis skeleton vessels.nii.gz --label 1 -o vessels.swc\n"
        "  scaleaxis skeleton neurons.nrrd --each-label -o swc/\n"
        "  scaleaxis skeleton octopus.off -o octopus.vtp --parts octopus-parts.ply --view octopus.html\n"
        "  scaleaxis skeleton aorta.stl --to-openings --sections --step-abs 0.5 -o aorta.vtp\n"
        "  scaleaxis skeleton aorta.stl --path 223,170,24 215,101,28 -o path.vtp\n"
        "  scaleaxis skeleton hand-axis.ply --significance 2 -o hand.graphml");
    return {command, [options, scale](const std::stop_token& cancel) {
                options->has_scale = scale.count() > 0;
                return run_skeleton(*options, cancel);
            }};
}

}  // namespace scaleaxis::app
