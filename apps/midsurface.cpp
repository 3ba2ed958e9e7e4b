// SPDX-License-Identifier: Apache-2.0
// scaleaxis midsurface: solid of walls, or its axis → surface halfway between their sides, with thickness.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
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
#include "scaleaxis/shells.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
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
    std::vector<std::string> shells;  ///< where to write shell meshes; empty: nowhere
    std::optional<double> size;       ///< of their edges
    ShellFileOptions shell_files;
    CommonOptions common;
};

struct FoundMidsurface {
    Midsurface surface;
    ShellMesh shells;
    std::vector<StageCost> costs;
};

/// The files that one solid leads to.
struct MidsurfaceFiles {
    std::optional<fs::path> surface;
    std::vector<fs::path> shells;
};

bool is_mesh_format(const fs::path& file, const std::string& format) {
    const std::string kind = format_of(file, format);
    return kind == "stl" || kind == "off";
}

void check_midsurface_output(const fs::path& file, const std::string& format) {
    if (is_mesh_format(file, format)) {
        check_mesh_output(file, format);
        return;
    }
    try {
        check_axis_output(file, format);
    } catch (const FileError& error) {
        throw error.diagnostic().code == "file.format" ? FileError(std::string(error.what()) + ", .stl, .off") : error;
    }
}

void write_midsurface(const fs::path& file, const Midsurface& surface, const std::string& format) {
    if (is_mesh_format(file, format)) {
        write_mesh(file, surface.mesh, format);
    } else {
        write_axis(file, complex_of(surface), format, {.vertex_values = {{"thickness", surface.thickness}}});
    }
}

/// The midsurface of an axis, and the shells as far as they are wanted. \param solid null: that of the axis
void find_surfaces(const MedialComplex& complex, const Solid* solid, const MidsurfaceCommandOptions& options,
                   const Execution& execution, FoundMidsurface& outcome) {
    Stopwatch watch;
    outcome.surface = solid != nullptr ? midsurface(complex, *solid, options.midsurface, execution)
                                       : midsurface(complex, options.midsurface, execution);
    outcome.costs.push_back(watch.lap("midsurface"));
    if (options.size) {
        const ShellOptions shells{*options.size, options.midsurface.angle};
        outcome.shells =
            solid != nullptr ? shell_mesh(complex, *solid, shells, execution) : shell_mesh(complex, shells, execution);
        outcome.costs.push_back(watch.lap("shells"));
    }
}

FoundMidsurface of_stored_axis(const MidsurfaceCommandOptions& options, const fs::path& path,
                               const Listener& listener) {
    check_unused_beside_axis(options.source);
    FoundMidsurface outcome;
    Stopwatch watch;
    MedialComplex complex = read_axis(path);
    if (std::ranges::any_of(complex.face_angles, [](double angle) { return !(angle > 0.0); })) {
        complex = with_object_angles(std::move(complex));
    }
    outcome.costs.push_back(watch.lap("reading"));
    find_surfaces(complex, nullptr, options, listener.execution({}), outcome);
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
    find_surfaces(axis.axes[0].complex, input.solid.get(), options, execution(0.9, 1.0), outcome);
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

void print_shells(std::ostream& out, const ShellMesh& shells) {
    label(out, "shells") << shells.mesh.triangles.size() << " triangles, " << shells.sheets.size()
                         << (shells.sheets.size() == 1 ? " sheet" : " sheets") << ", edges " << shells.mean_edge
                         << " on average, angles from " << shells.least_angle << " degrees on\n";
}

Json json_of_sheets(const std::vector<MidsurfaceSheet>& all) {
    Json sheets = Json::array();
    for (const MidsurfaceSheet& sheet : all) {
        sheets.push_back({{"area", sheet.area},
                          {"mean_thickness", sheet.mean},
                          {"minimum_thickness", sheet.min},
                          {"maximum_thickness", sheet.max}});
    }
    return sheets;
}

Json json_of_shells(const ShellMesh& shells, double size, const std::vector<fs::path>& files) {
    Json names = Json::array();
    for (const fs::path& file : files) {
        names.push_back(file.string());
    }
    return {{"files", std::move(names)},
            {"size", size},
            {"vertices", shells.mesh.vertices.size()},
            {"triangles", shells.mesh.triangles.size()},
            {"sheets", json_of_sheets(shells.sheets)},
            {"seam_length", shells.seam_length},
            {"border_length", shells.border_length},
            {"mean_edge", shells.mean_edge},
            {"least_angle", shells.least_angle}};
}

Json json_of_midsurface(const Midsurface& surface) {
    return {{"vertices", surface.mesh.vertices.size()},  {"triangles", surface.mesh.triangles.size()},
            {"sheets", json_of_sheets(surface.sheets)},  {"seams", surface.seams},
            {"seam_length", surface.seam_length},        {"border_length", surface.border_length},
            {"left_out_area", surface.left_out_area},    {"left_out_curves", surface.left_out_curves},
            {"left_out_length", surface.left_out_length}};
}

SourceResult run_source(const MidsurfaceCommandOptions& options, const Source& source, const MidsurfaceFiles& files,
                        const Listener& listener, const std::stop_token& cancel) {
    const bool is_axis = source.is_axis;
    FoundMidsurface outcome =
        is_axis ? reading(source, [&](const fs::path& path) { return of_stored_axis(options, path, listener); })
                : of_solid(options, source, listener);
    stop_if_requested(cancel);
    const Midsurface& surface = outcome.surface;
    if (surface.sheets.empty()) {
        throw UnusableInput(source.name.string() +
                            ": no part of it lies between two opposite sides as a wall does, so that it has no "
                            "midsurface; scaleaxis skeleton has curves for rods, and a smaller --angle takes more");
    }
    if (options.size && outcome.shells.sheets.empty()) {
        throw UnusableInput(source.name.string() +
                            ": its walls are smaller than a quarter of the size of the elements, so that none is left");
    }
    Stopwatch watch;
    std::ostringstream text;
    text << source.name.string();
    if (files.surface) {
        write_midsurface(*files.surface, surface, written_format(*files.surface, options.output_format));
        text << " -> " << files.surface->string();
    }
    for (const fs::path& file : files.shells) {
        write_shells(file, outcome.shells, options.shell_files, written_format(file, "", "inp"));
        text << " -> " << file.string();
    }
    outcome.costs.push_back(watch.lap("writing"));
    text << '\n';
    print_midsurface(text, surface);
    if (options.size) {
        print_shells(text, outcome.shells);
    }
    print(text, outcome.costs);
    return {{{"input", source.name.string()},
             {"file", files.surface ? Json(files.surface->string()) : Json(nullptr)},
             {"seed", options.common.seed},
             {"scale", is_axis ? Json(nullptr) : Json(options.scale)},
             {"angle", options.midsurface.angle},
             {"is_extended", options.midsurface.extends},
             {"midsurface", json_of_midsurface(surface)},
             {"shells", options.size ? json_of_shells(outcome.shells, *options.size, files.shells) : Json(nullptr)},
             {"costs", json_of(outcome.costs)}},
            text.str()};
}

MidsurfaceFiles files_of_midsurface(const MidsurfaceCommandOptions& options, const Source& source,
                                    std::vector<Output>& outputs) {
    const auto planned = [&](const std::string& pattern, const OutputCheck& check) {
        const fs::path file = expand(pattern, source.name, options.scale);
        check_output(file, check);
        outputs.push_back({file, source.name});
        return file;
    };
    MidsurfaceFiles files;
    if (!options.output.empty()) {
        files.surface = planned(output_pattern(options.output, "midsurface", false, options.output_format),
                                with_format(check_midsurface_output, options.output_format));
    }
    for (const std::string& shells : options.shells) {
        files.shells.push_back(
            planned(output_pattern(shells, "shells", false, "", "inp"), with_format(check_shells_output, "", "inp")));
    }
    return files;
}

Status run_midsurface(MidsurfaceCommandOptions options, const std::stop_token& cancel) {
    if (options.output.empty() && options.shells.empty()) {
        throw InvalidOption("nothing to write: give -o or --shells");
    }
    if (options.shells.empty() && options.shell_files.order > 0) {
        throw InvalidOption("--order is for --shells");
    }
    if (options.shells.empty() == options.size.has_value()) {
        throw InvalidOption(options.size ? "--size is for --shells" : "--shells needs --size, the length of edges");
    }
    const std::vector<Source> sources = sources_of_one(options.input, options.source);
    std::vector<MidsurfaceFiles> files;
    std::vector<Output> outputs;
    for (const Source& source : sources) {
        files.push_back(files_of_midsurface(options, source, outputs));
    }
    check_all_outputs(outputs, options.common);
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
                      ".stl or .off; a folder gets {name}-midsurface.ply; {name} and {scale} are filled in")
        .required(false);
    command
        .add_option("--shells", options->shells,
                    "Shell mesh for the finite-element method, several times for several formats: .inp (CalculiX,\n"
                    "Abaqus), .bdf (Nastran), .msh (Gmsh) or .vtu, with thickness and an element set for each sheet;\n"
                    "a folder gets {name}-shells.inp")
        .one_text_each()
        .value_text("FILE");
    add_positive_length(command, "--size", options->size, "Length of the edges of the shell mesh");
    command
        .add_option("--order", options->shell_files.order,
                    "Of the elements: 1, three nodes; 2, six; without it 2 in .inp, 1 in other formats")
        .check(is_one_of({"1", "2"}))
        .value_text("N");
    add_number(command, "--angle", options->midsurface.angle,
               "Least object angle of what counts as a wall: half the angle between its contacts; sheets that\n"
               "run into edges of a box have 45; degrees",
               kWallAngleRange, "A");
    command
        .add_flag_callback(
            "--no-extend", [options] { options->midsurface.extends = false; },
            "End where balls touch the rim of a wall, instead of going on from there to the surface of the solid")
        .value_text(" ");
    add_delta_options(command, options->pipeline.delta, &options->pipeline.delta_range);
    add_sampling_option(command, options->pipeline.sizing);
    add_number(command, "--scale", options->scale, "Factor by which balls are grown, so that small features go",
               kScaleRange, "S");
    add_source_options(command, options->source, {"--delta", "--delta-abs", "--sampling", "--scale"});
    add_common_options(command, options->common);
    command.footer(
        "Walls want samples closer than they are thick: choose --delta below a third of the least thickness.\n"
        "Examples:\n"
        "  scaleaxis midsurface bracket.stl -o bracket-mid.obj --stats bracket.json\n"
        "  scaleaxis midsurface bracket-axis.ply -o bracket-mid.vtp --no-extend\n"
        "  scaleaxis midsurface bracket.stl --shells bracket.inp --size 2");
    return {command, [options](const std::stop_token& cancel) { return run_midsurface(*options, cancel); }};
}

}  // namespace scaleaxis::app
