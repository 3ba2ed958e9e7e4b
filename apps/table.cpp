// SPDX-License-Identifier: Apache-2.0
// scaleaxis table: solids → a table of their sizes, thickness, branches and topology.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "batch.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "inputs.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/measures.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/thickness.hpp"
#include "scaleaxis/topology.hpp"
#include "source.hpp"
#include "status.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

// Thickness is asked at vertices no farther apart than this part of the diagonal.
constexpr double kEdge = 0.01;

// What of its area and volume a mesh may have twice, where parts touch or overlap: as exact are the sizes of surfaces
// that are sampled. Beyond that, triangles inside the solid count for its surface.
constexpr double kOverlap = 0.02;

const Choices<MeasuredPieces> kRowNames{
    {"input", MeasuredPieces::kWhole}, {"component", MeasuredPieces::kComponents}, {"part", MeasuredPieces::kParts}};

struct TableOptions {
    std::vector<fs::path> inputs;
    SourceOptions source;
    std::string output;
    std::string output_format;
    std::optional<Length> delta;
    Sizing sizing = Sizing::kAdaptive;
    double scale = 1.1;
    MeasureOptions measures;
    CommonOptions common;
};

/// The surface of a solid whose sizes are told.
struct Surface {
    TriangleMesh mesh;                    ///< where thickness is asked
    std::optional<TriangleMesh> bulging;  ///< closer, with vertices that lie beyond the solid; nothing: `mesh` itself
};

/// Does each component of a surface bound the solid, and each of its triangles?
bool is_boundary(const MeshReport& report, const Solid& solid) {
    const std::optional<Topology> topology = solid.topology();
    return report.self_intersections == 0 && topology &&
           report.components == topology->components + topology->voids.value_or(0);
}

/// The triangles of the input. Where there are none, or many lie inside the solid, the boundary of its samples.
Surface surface_of(LoadedSolid& input, const Samples& samples, const Execution& execution) {
    const auto* report = std::get_if<MeshReport>(&input.input);
    const bool has_triangles = !input.mesh.triangles.empty();
    if (has_triangles && (report == nullptr || is_boundary(*report, *input.solid))) {
        return {std::move(input.mesh), std::nullopt};
    }
    Surface surface{boundary_mesh(samples).mesh, std::nullopt};
    if (input.solid->knows_nearest()) {
        surface.bulging = with_bulging_edges(surface.mesh, *input.solid, execution);
    }
    if (has_triangles) {
        const MeshReport boundary = repair(surface.bulging.value_or(surface.mesh)).report;
        if (report->volume <= (1.0 + kOverlap) * boundary.volume && report->area <= (1.0 + kOverlap) * boundary.area) {
            return {std::move(input.mesh), std::nullopt};
        }
    }
    return surface;
}

/// Local thickness at the vertices of a surface.
std::vector<double> thickness_of(const MedialComplex& axis, const TriangleMesh& surface, const Solid& solid,
                                 const TableOptions& options, const Execution& execution) {
    const std::vector<PointThickness> found =
        Thickness(axis, options.measures.thickness).at_surface(surface.vertices, solid, execution);
    std::vector<double> thickness(found.size());
    std::ranges::transform(found, thickness.begin(), &PointThickness::thickness);
    return thickness;
}

Json row_of(const Source& source, MeasuredPieces pieces, std::size_t i, const std::string& unit,
            const Measures& measures) {
    Json row{{"input", source.name.string()}};
    row["label"] = source.label ? Json(static_cast<std::int64_t>(source.label->label)) : Json(nullptr);
    row["component"] = pieces == MeasuredPieces::kComponents ? Json(i) : Json(nullptr);
    row["part"] = pieces == MeasuredPieces::kParts ? Json(i) : Json(nullptr);
    row["unit"] = unit.empty() ? Json(nullptr) : Json(unit);
    row.update(json_of(measures));
    return row;
}

/// The rows of one solid.
std::vector<Json> rows_of(const TableOptions& options, Source source, const Listener& listener) {
    const auto execution = [&](double begin, double end) { return listener.execution({begin, end}); };
    const auto warn = listener.warn_about(source.name);
    // Skeletons are those of axes that end before sharp edges, and balls in these say nothing of thickness.
    const ScaleAxisOptions pipeline{.delta = options.delta,
                                    .scales = {options.scale},
                                    .reaches_sharp_edges = false,
                                    .sizing = options.sizing,
                                    .keeps_samples = true,
                                    .seed = options.common.seed};
    source.options.load.delta = finest_delta(pipeline);
    LoadedSolid input = load_source(source, execution(0.0, 0.1), warn, true);
    if (!input.solid) {
        throw InvalidOption("a table needs solids: take --points mls");
    }
    const std::size_t told = input.solid->warnings().size();
    const ScaleAxis axis = scale_axis(*input.solid, pipeline, execution(0.1, 0.8));
    std::for_each(axis.warnings.begin() + static_cast<std::ptrdiff_t>(told), axis.warnings.end(), warn);
    const MedialComplex& complex = axis.axes[0].complex;
    const SkeletonOptions skeleton_options;
    const Skeleton curves =
        input.solid->knows_nearest()
            ? skeleton(complex, *input.solid, skeleton_options, execution(0.8, 0.9))
            : skeleton(complex, BallUnion(scaled(axis.balls, options.scale)), skeleton_options, execution(0.8, 0.9));
    auto [surface, bulging] = surface_of(input, *axis.kept_samples, execution(0.9, 0.9));
    surface = with_short_edges(std::move(surface), kEdge * axis.diagonal, execution(0.9, 0.9));
    std::vector<Measures> all;
    if (input.solid->knows_nearest()) {
        const std::vector<double> thickness =
            thickness_of(complex, surface, *input.solid, options, execution(0.9, 0.95));
        if (const auto* image = std::get_if<ImageReport>(&input.input); image != nullptr && !source.options.load.iso) {
            if (const auto warning = unresolved_thickness(surface, thickness, steps_of(*image))) {
                warn(*warning);
            }
        }
        all = measures(complex, curves, surface, thickness, bulging.value_or(surface), options.measures,
                       execution(0.95, 1.0));
    } else {
        all = measures(complex, curves, surface, options.measures, execution(0.9, 1.0));
    }
    const std::string unit = unit_of(input.input);
    std::vector<Json> rows;
    for (std::size_t i = 0; i < all.size(); ++i) {
        rows.push_back(row_of(source, options.measures.pieces, i, unit, all[i]));
    }
    return rows;
}

/// Texts are quoted where commas, quotes or line ends make it necessary; `null` is nothing.
std::string csv_cell(const Json& value) {
    if (value.is_null()) {
        return {};
    }
    if (!value.is_string()) {
        return value.dump();
    }
    const auto text = value.get<std::string>();
    if (text.find_first_of(",\"\n\r") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    }
    return quoted + '"';
}

std::string to_csv(const std::vector<Json>& rows) {
    std::string text;
    const auto add_line = [&](const auto& cell_of, const Json& row) {
        std::string separator;
        for (const auto& [name, value] : row.members()) {
            text += separator + cell_of(name, value);
            separator = ",";
        }
        text += '\n';
    };
    add_line([](const std::string& name, const Json&) { return name; }, rows.front());
    for (const Json& row : rows) {
        add_line([](const std::string&, const Json& value) { return csv_cell(value); }, row);
    }
    return text;
}

bool is_json(const fs::path& file, const std::string& format) {
    return format == "json" || (format.empty() && file.extension() == ".json");
}

void check_table_name(const fs::path& file, const std::string& format) {
    if (!is_stdout(file) && format.empty() && file.extension() != ".csv" && file.extension() != ".json") {
        throw InvalidOption(file.string() + ": tables are written to .csv and .json");
    }
}

/// The rows of all sources; what went wrong with one of them is told, and the others follow.
Status collect_rows(const TableOptions& options, const std::vector<Source>& sources, const std::stop_token& cancel,
                    std::vector<Json>& rows) {
    std::vector<std::vector<Json>> found(sources.size());
    std::vector<std::string> errors(sources.size());
    std::vector<Status> states(sources.size(), kDone);
    const auto work = [&](std::size_t i, const Listener& listener) {
        try {
            found[i] = rows_of(options, sources[i], listener);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            errors[i] = describe(error, sources[i].name);
            states[i] = status_of(error);
        }
    };
    for_each_source(sources, options.common, cancel, work, [&](std::size_t i) {
        std::ranges::move(found[i], std::back_inserter(rows));
        if (!errors[i].empty()) {
            print_error(errors[i]);
        }
    });
    return std::ranges::max(states);
}

Status run_table(TableOptions options, const std::stop_token& cancel) {
    const std::vector<Source> sources = sources_of(expanded(options.inputs), options.source);
    const fs::path file = expand(output_pattern(options.output, "table", false, options.output_format, "csv"),
                                 sources.front().name, options.scale);
    check_table_name(file, options.output_format);
    options.common.has_data_on_stdout = is_stdout(file);
    std::vector<Output> outputs;
    add_statistics_file(is_stdout(file) ? "-" : file.string(), outputs);
    add_statistics_file(options.common.statistics, outputs);
    check_distinct(outputs);
    std::vector<Json> rows;
    const Status worst = collect_rows(options, sources, cancel, rows);
    stop_if_requested(cancel);
    if (rows.empty()) {
        return worst;
    }
    Json document = new_document("scaleaxis.table/1");
    document["scale"] = options.scale;
    document["rows"] = rows;
    const std::string text = is_json(file, options.output_format) ? to_text(document) : to_csv(rows);
    if (is_stdout(file)) {
        print_text(text);
    } else {
        write_text(file, text);
    }
    write_statistics(options.common.statistics, document);
    if (options.common.has_summary()) {
        print_text(std::to_string(rows.size()) + (rows.size() == 1 ? " row -> " : " rows -> ") + file.string() + '\n');
    }
    return worst;
}

}  // namespace

Command table_command(CommandLine program) {
    const CommandLine command = program.add_subcommand(
        "table", "Size, thickness, branches and topology of solids, their components or parts, as a table");
    auto options = std::make_shared<TableOptions>();
    command.add_option("INPUT", options->inputs, "Solids as for scaleaxis axis; none with --implicit")
        .value_text("...");
    add_output_option(command, options->output, options->output_format,
                      "Table, .csv or .json; a folder gets {name}-table.csv; {name} is that of the first input");
    add_choice(command, "--rows", options->measures.pieces, kRowNames,
               "One row for each input (each label or object, with --each-label or --each-object), each component\n"
               "of it, or each part: what belongs to a branch of its skeleton\n[default input]");
    add_number(command, "--angle", options->measures.thickness.angle,
               "Least angle between two contacts of a ball, seen from its centre, for which it counts for\n"
               "thickness, as of scaleaxis thickness; degrees",
               kContactAngleRange, "A");
    add_measured_scale_option(command, options->scale);
    add_delta_options(command, options->delta, nullptr);
    add_sampling_option(command, options->sizing);
    add_source_options(command, options->source);
    add_common_options(command, options->common);
    command.footer(
        "Examples:\n"
        "  scaleaxis table parts/*.stl -o parts.csv\n"
        "  scaleaxis table cells.nrrd --each-label -o cells.csv\n"
        "  scaleaxis table tree.ply --rows part -o -");
    return {command, [options](const std::stop_token& cancel) { return run_table(*options, cancel); }};
}

}  // namespace scaleaxis::app
