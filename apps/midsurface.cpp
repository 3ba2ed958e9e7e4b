// SPDX-License-Identifier: Apache-2.0
// scaleaxis midsurface: solid of walls, or its axis → surface halfway between their sides, with thickness.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "batch.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/midsurface.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
#include "stored_axis.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr Range kWallAngleRange{1.0, 90.0};
constexpr std::size_t kMostRows = 20;

struct MidsurfaceCommandOptions {
    fs::path input;
    SourceOptions source;
    std::string output;
    std::string output_format;
    ScaleAxisOptions pipeline;
    double scale = 1.1;
    MidsurfaceOptions midsurface;
    CommonOptions common;
};

struct FoundMidsurface {
    Midsurface surface;
    std::vector<StageCost> costs;
};

bool is_mesh_format(const fs::path& file, const std::string& format) {
    const std::string extension = format.empty() ? file.extension().string() : "." + format;
    return extension == ".stl" || extension == ".off";
}

void check_midsurface_output(const fs::path& file, const std::string& format) {
    if (is_mesh_format(file, format)) {
        check_mesh_output(file, format);
    } else {
        check_axis_output(file, format);
    }
}

void write_midsurface(const fs::path& file, const Midsurface& surface, const std::string& format) {
    if (is_mesh_format(file, format)) {
        write_mesh(file, surface.mesh, format);
    } else {
        write_axis(file, complex_of(surface), format, {.vertex_values = {{"thickness", surface.thickness}}});
    }
}

FoundMidsurface of_stored_axis(const MidsurfaceCommandOptions& options, const fs::path& path,
                               const Listener& listener) {
    if (has_sampling_options(options.pipeline)) {
        throw InvalidOption(options.input.string() + " is an axis: --delta and --sampling are for solids");
    }
    check_unused(options.source, "an axis that is there already", {"--as", "--format"});
    FoundMidsurface outcome;
    Stopwatch watch;
    MedialComplex complex = read_stored_axis(path);
    if (std::ranges::any_of(complex.face_angles, [](double angle) { return !(angle > 0.0); })) {
        complex = with_object_angles(std::move(complex));
    }
    outcome.costs.push_back(watch.lap("reading"));
    outcome.surface = midsurface(complex, options.midsurface, listener.execution({}));
    outcome.costs.push_back(watch.lap("midsurface"));
    return outcome;
}

FoundMidsurface of_solid(const MidsurfaceCommandOptions& options, const Source& source, const Listener& listener) {
    const auto warn = listener.warn_about(source.name);
    const auto execution = [&](double begin, double end) { return listener.execution({begin, end}); };
    LoadedSolid input = load_source(source, execution(0.0, 0.1), warn);
    if (!input.solid) {
        throw InvalidOption("a midsurface needs a solid: take --points mls, or scaleaxis axis and then its axis");
    }
    ScaleAxisOptions pipeline = options.pipeline;
    pipeline.scales = {options.scale};
    pipeline.seed = options.common.seed;
    const ScaleAxis axis = scale_axis(*input.solid, pipeline, execution(0.1, 0.9));
    std::for_each(axis.warnings.begin() + static_cast<std::ptrdiff_t>(input.solid->warnings().size()),
                  axis.warnings.end(), warn);
    FoundMidsurface outcome;
    outcome.costs = input.costs;
    outcome.costs.insert(outcome.costs.end(), axis.costs.begin(), axis.costs.end());
    outcome.costs.insert(outcome.costs.end(), axis.axes[0].costs.begin(), axis.axes[0].costs.end());
    Stopwatch watch;
    outcome.surface = midsurface(axis.axes[0].complex, *input.solid, options.midsurface, execution(0.9, 1.0));
    outcome.costs.push_back(watch.lap("midsurface"));
    return outcome;
}

void print_midsurface(std::ostream& out, const Midsurface& surface) {
    double area = 0.0;
    for (const MidsurfaceSheet& sheet : surface.sheets) {
        area += sheet.area;
    }
    label(out, "midsurface") << surface.sheets.size() << (surface.sheets.size() == 1 ? " sheet" : " sheets")
                             << ", area " << area << ", " << surface.seams << (surface.seams == 1 ? " seam" : " seams")
                             << " of length " << surface.seam_length << '\n';
    for (std::size_t s = 0; s < std::min(surface.sheets.size(), kMostRows); ++s) {
        const MidsurfaceSheet& sheet = surface.sheets[s];
        label(out, s == 0 ? "sheets" : "") << s << ": area " << sheet.area << ", thickness " << sheet.min << " ... "
                                           << sheet.max << ", " << sheet.mean << " on average\n";
    }
    if (surface.sheets.size() > kMostRows) {
        label(out, "") << "... " << surface.sheets.size() - kMostRows << " more: --stats has all\n";
    }
    label(out, "left out") << "area " << surface.left_out_area << " of sheets into edges; curves of length "
                           << surface.left_out_length << '\n';
}

Json json_of_midsurface(const Midsurface& surface) {
    Json sheets = Json::array();
    for (const MidsurfaceSheet& sheet : surface.sheets) {
        sheets.push_back({{"area", sheet.area},
                          {"mean_thickness", sheet.mean},
                          {"minimum_thickness", sheet.min},
                          {"maximum_thickness", sheet.max}});
    }
    return {{"vertices", surface.mesh.vertices.size()},
            {"triangles", surface.mesh.triangles.size()},
            {"sheets", std::move(sheets)},
            {"seams", surface.seams},
            {"seam_length", surface.seam_length},
            {"border_length", surface.border_length},
            {"left_out_area", surface.left_out_area},
            {"left_out_curves", surface.left_out_curves},
            {"left_out_length", surface.left_out_length}};
}

SourceResult run_source(const MidsurfaceCommandOptions& options, const Source& source, const fs::path& output,
                        const Listener& listener, const std::stop_token& cancel) {
    const bool is_axis = is_stored_axis(source);
    FoundMidsurface outcome =
        is_axis ? reading(source.file, options.source.format,
                          [&](const fs::path& path) { return of_stored_axis(options, path, listener); })
                : of_solid(options, source, listener);
    stop_if_requested(cancel);
    const Midsurface& surface = outcome.surface;
    if (surface.sheets.empty()) {
        throw UnusableInput(source.name.string() +
                            ": no part of it lies between two opposite sides as a wall does, so that it has no "
                            "midsurface; scaleaxis skeleton has curves for rods, and a smaller --angle takes more");
    }
    Stopwatch watch;
    write_midsurface(output, surface, written_format(output, options.output_format));
    outcome.costs.push_back(watch.lap("writing"));
    std::ostringstream text;
    text << source.name.string() << " -> " << output.string() << '\n';
    print_midsurface(text, surface);
    print(text, outcome.costs);
    return {{{"input", source.name.string()},
             {"file", output.string()},
             {"seed", options.common.seed},
             {"scale", is_axis ? Json(nullptr) : Json(options.scale)},
             {"angle", options.midsurface.angle},
             {"is_extended", options.midsurface.extends},
             {"midsurface", json_of_midsurface(surface)},
             {"costs", json_of(outcome.costs)}},
            text.str()};
}

Status run_midsurface(MidsurfaceCommandOptions options, const std::stop_token& cancel) {
    const std::vector<Source> sources = sources_of_one(options.input, options.source);
    const std::string pattern = output_pattern(options.output, "midsurface", false, options.output_format);
    std::vector<fs::path> files;
    for (const Source& source : sources) {
        files.push_back(expand(pattern, source.name, options.scale));
        check_output(files.back(), with_format(check_midsurface_output, options.output_format));
    }
    check_all_outputs(sources, files, options.common);
    return run_sources(sources, options.source, options.common, new_document("scaleaxis.midsurface/1"), cancel,
                       [&](std::size_t i, const Listener& listener) {
                           return run_source(options, sources[i], files[i], listener, cancel);
                       });
}

}  // namespace

Command midsurface_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("midsurface", "Surface halfway between the sides of walls, with their thickness");
    auto options = std::make_shared<MidsurfaceCommandOptions>();
    command
        .add_option("INPUT", options->input,
                    "A solid, as for scaleaxis axis (mesh, 3D image, function...), or an axis: .ply or .ma;\n"
                    "none with --implicit")
        .value_text(" ");
    add_output_option(command, options->output, options->output_format,
                      "Midsurface: .ply or .vtp with thickness and sheets, .obj with a group for each sheet, .glb,\n"
                      ".stl or .off; a folder gets {name}-midsurface.ply; {name} and {scale} are filled in");
    command
        .add_option("--angle", options->midsurface.angle,
                    "Least object angle of what counts as a wall: half the angle between its contacts; sheets that\n"
                    "run into edges of a box have 45; degrees" +
                        range_and_default(kWallAngleRange, options->midsurface.angle))
        .check(in_range(kWallAngleRange))
        .value_text("A");
    command
        .add_flag_callback(
            "--no-extend", [options] { options->midsurface.extends = false; },
            "End where balls touch the rim of a wall, instead of going on from there to the surface of the solid")
        .value_text(" ");
    add_delta_options(command, options->pipeline.delta, &options->pipeline.delta_range);
    add_sampling_option(command, options->pipeline.sizing);
    command
        .add_option("--scale", options->scale,
                    "Factor by which balls are grown, so that small features go" +
                        range_and_default(kScaleRange, options->scale))
        .check(in_range(kScaleRange))
        .value_text("S");
    add_source_options(command, options->source);
    add_common_options(command, options->common);
    command.footer(
        "Walls want samples closer than they are thick: choose --delta below a third of the least thickness.\n"
        "Examples:\n"
        "  scaleaxis midsurface bracket.stl -o bracket-mid.obj --stats bracket.json\n"
        "  scaleaxis midsurface bracket-axis.ply -o bracket-mid.vtp --no-extend");
    return {command, [options](const std::stop_token& cancel) { return run_midsurface(*options, cancel); }};
}

}  // namespace scaleaxis::app
