// SPDX-License-Identifier: Apache-2.0
// scaleaxis walls: a solid → its thin and thick walls and narrow gaps, with their places.
#include "scaleaxis/walls.hpp"

#include <algorithm>
#include <filesystem>
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
#include "io/output_file.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "page.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/view.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr auto kWallsSchema = "scaleaxis.walls/1";
constexpr std::size_t kMostTold = 10;  // findings in the summary

struct WallsCommandOptions {
    fs::path input;
    SourceOptions source;
    std::string output;  ///< the document; empty: none
    std::string mesh;    ///< the coloured surface; empty: none
    std::string view;
    std::optional<Length> delta;
    WallOptions walls;
    bool exits_zero = false;
    CommonOptions common;
};

struct WallsFiles {
    std::optional<fs::path> document;
    std::optional<fs::path> mesh;
    fs::path page;  ///< empty: none
};

std::optional<fs::path> planned_output(const std::string& output, const Source& source, const std::string& extension,
                                       const OutputCheck& check, std::vector<Output>& outputs) {
    if (output.empty()) {
        return std::nullopt;
    }
    const fs::path file = expand(output_pattern(output, "walls", false, "", extension), source.name, 1.0);
    check_output(file, check);
    outputs.push_back({file, source.name});
    return file;
}

void check_document(const fs::path& file) {
    if (!is_stdout(file) && file.extension() != ".json") {
        throw FileError("cannot write " + file.string() + ": findings are written to .json");
    }
    io::check_output_file(file);
}

WallsFiles walls_files_of(const WallsCommandOptions& options, const Source& source, std::vector<Output>& outputs) {
    WallsFiles files;
    files.document = planned_output(options.output, source, "json", check_document, outputs);
    files.mesh = planned_output(
        options.mesh, source, "ply", [](const fs::path& file) { check_surface_output(file, written_format(file, "")); },
        outputs);
    files.page = page_output(options.view, source.name, 1.0);
    if (!files.page.empty()) {
        outputs.push_back({files.page, source.name});
    }
    return files;
}

/// What is opposite each vertex, the nearer of both sides.
std::vector<double> nearer_of(const Walls& walls) {
    std::vector<double> values = walls.wall.empty() ? walls.gap : walls.wall;
    for (std::size_t v = 0; v < walls.gap.size(); ++v) {
        values[v] = std::min(values[v], walls.gap[v]);
    }
    return values;
}

std::vector<Index> finding_of_vertices(const Walls& walls) {
    std::vector<Index> findings = walls.wall.empty() ? walls.gap_findings : walls.wall_findings;
    for (std::size_t v = 0; v < walls.gap_findings.size(); ++v) {
        findings[v] = findings[v] == kNone ? walls.gap_findings[v] : findings[v];
    }
    return findings;
}

void write_colored(const fs::path& file, const Walls& walls) {
    std::vector<VertexValues> values;
    if (!walls.wall.empty()) {
        values.push_back({"wall", walls.wall});
    }
    if (!walls.gap.empty()) {
        values.push_back({"gap", walls.gap});
    }
    const std::vector<Index> findings = finding_of_vertices(walls);
    values.push_back({"finding", {findings.begin(), findings.end()}});
    write_surface(file, walls.surface, values, written_format(file, ""));
}

void tell(std::ostringstream& text, const Walls& walls, const std::string& unit) {
    if (walls.findings.empty()) {
        label(text, "findings") << "none\n";
    }
    for (std::size_t i = 0; i < std::min(walls.findings.size(), kMostTold); ++i) {
        const Finding& finding = walls.findings[i];
        label(text, i == 0 ? "findings" : "")
            << name_of(finding.kind) << ": " << finding.value << unit << " at " << text_of_place(finding.ball.center)
            << ", limit " << finding.limit << ", area " << finding.area << ", across "
            << text_of_place(finding.direction) << '\n';
    }
    if (walls.findings.size() > kMostTold) {
        label(text, "") << "and " << walls.findings.size() - kMostTold << " more\n";
    }
}

Json json_of_limit(const std::optional<double>& limit) { return limit ? Json(*limit) : Json(nullptr); }

SourceResult run_walls_of(const WallsCommandOptions& options, const Source& source, const WallsFiles& files,
                          const Listener& listener, const std::stop_token& cancel) {
    LoadedSolid input = load_source(source, listener.execution({0.0, 0.3}), listener.warn_about(source.name), true);
    if (!input.solid) {
        throw InvalidOption("walls need a solid: take --points mls");
    }
    Stopwatch watch;
    const std::string unit = unit_of(input.input);
    TriangleMesh surface = take_surface(input, options.delta, options.common.seed, listener.execution({0.3, 0.5}));
    const Execution execution = listener.execution({0.5, 1.0});
    Walls walls = find_walls(*input.solid, std::move(surface), options.walls, execution);
    input.costs.push_back(watch.lap("walls"));
    stop_if_requested(cancel);

    SourceResult result;
    result.status = walls.findings.empty() || options.exits_zero ? kDone : kFindings;
    result.entry = {{"input", source.name.string()},
                    {"unit", unit.empty() ? Json(nullptr) : Json(unit)},
                    {"limits",
                     {{"min_wall", json_of_limit(options.walls.min_wall)},
                      {"max_wall", json_of_limit(options.walls.max_wall)},
                      {"min_gap", json_of_limit(options.walls.min_gap)},
                      {"angle", options.walls.angle}}},
                    {"file", files.document ? Json(files.document->string()) : Json(nullptr)},
                    {"mesh", files.mesh ? Json(files.mesh->string()) : Json(nullptr)},
                    {"view", files.page.empty() ? Json(nullptr) : Json(files.page.string())},
                    {"warnings", json_of(input.warnings)}};
    result.entry.update(json_of(walls));
    Json document = new_document(kWallsSchema);
    document.update(result.entry);
    if (files.document) {
        write_text(*files.document, to_text(document));
    }
    if (files.mesh) {
        write_colored(*files.mesh, walls);
    }
    input.costs.push_back(watch.lap("writing"));
    result.entry["costs"] = json_of(input.costs);

    std::ostringstream text;
    text << source.name.string() << '\n';
    tell(text, walls, unit.empty() ? "" : " " + unit);
    print(text, input.costs);
    if (!files.page.empty()) {
        const std::optional<double> limit = options.walls.min_wall ? options.walls.min_wall : options.walls.min_gap;
        const std::vector<double> values = nearer_of(walls);
        ViewedModel model{source.name.stem().string(), {}, {}, to_text(document)};
        model.thickness = ViewedThickness{values, values, finding_of_vertices(walls), limit};
        model.shape = std::move(walls.surface);
        write_page(files.page, model, false, execution);
        text << text_of_page(files.page);
    }
    result.summary = text.str();
    return result;
}

Status run_walls(WallsCommandOptions options, const std::stop_token& cancel) {
    if (!options.walls.min_wall && !options.walls.max_wall && !options.walls.min_gap) {
        throw InvalidOption("nothing to look for: give --min-wall, --min-gap or --max-wall");
    }
    const std::vector<Source> sources = sources_of_one(options.input, options.source);
    std::vector<Output> outputs;
    std::vector<WallsFiles> files;
    for (const Source& source : sources) {
        files.push_back(walls_files_of(options, source, outputs));
    }
    check_all_outputs(outputs, options.common);
    return run_sources(sources, options.source, options.common, new_document(kWallsSchema), cancel,
                       [&](std::size_t i, const Listener& listener) {
                           return run_walls_of(options, sources[i], files[i], listener, cancel);
                       });
}

}  // namespace

Command walls_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("walls", "Walls that are too thin or too thick and gaps that are too narrow");
    auto options = std::make_shared<WallsCommandOptions>();
    command.add_option("INPUT", options->input, "A solid as for scaleaxis axis;\nnone with --implicit").value_text(" ");
    add_positive_length(command, "--min-wall", options->walls.min_wall,
                        "Find walls that are thinner, a length in units of the input");
    add_positive_length(command, "--min-gap", options->walls.min_gap, "Find gaps outside the solid that are narrower");
    add_positive_length(command, "--max-wall", options->walls.max_wall, "Find walls that are thicker");
    command
        .add_option("-o,--output", options->output,
                    "What is found, as JSON: .json, - for stdout; a folder gets {name}-walls.json;\n"
                    "{name} is filled in")
        .value_text("FILE");
    command
        .add_option("--mesh", options->mesh,
                    "Also write the surface, coloured by the wall or gap at each vertex: .ply, .vtp or .glb;\n"
                    "a folder gets {name}-walls.ply")
        .value_text("FILE");
    command
        .add_option("--view", options->view,
                    "Also write a page that any browser shows, the surface coloured: .html;\n"
                    "a folder gets {name}-view.html")
        .value_text("FILE");
    add_number(command, "--angle", options->walls.angle,
               "Least angle between two contacts of a ball for which they lie on opposite sides: walls and\n"
               "gaps that meet at less than 180 degrees minus this are thin; degrees",
               kWallAngleRange, "A");
    add_number(command, "--edge", options->walls.edge,
               "Divide the triangles of the surface until no edge is longer, relative to the diagonal of the\n"
               "bounding box; they are divided further where something thin may be",
               kWallEdgeRange, "R");
    command.add_flag("--exit-zero", options->exits_zero, "Exit with status 0 whatever is found");
    add_delta_options(command, options->delta, nullptr);
    add_source_options(command, options->source);
    add_common_options(command, options->common);
    command.footer(
        "A wall is what lies between two opposite sides of the solid, a gap the same outside. Exit status 6: there is\n"
        "something to find.\n"
        "Examples:\n"
        "  scaleaxis walls part.stl --min-wall 0.8 --min-gap 0.6 -o findings.json\n"
        "  scaleaxis walls assembly.3mf --each-object --min-wall 1 --max-wall 4 -o results/\n"
        "  scaleaxis walls part.stl --min-wall 0.8 --mesh part-walls.glb --view part.html");
    return {command, [options](const std::stop_token& cancel) { return run_walls(*options, cancel); }};
}

}  // namespace scaleaxis::app
