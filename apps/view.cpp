// SPDX-License-Identifier: Apache-2.0
// scaleaxis view: results that are there → an interactive page.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "page.hpp"
#include "readable.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/view.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct ViewOptions {
    std::vector<fs::path> results;
    std::string output;
    std::vector<fs::path> shapes;
    bool is_quiet = false;
};

/// A file that a model consists of, and what is known about it.
struct AxisSource {
    double scale = 1.0;
    fs::path file;
    std::optional<fs::path> surface;
    Json statistics;              ///< null: none
    bool has_all_scales = false;  ///< it is a filtration
};

/// A model before its files are read.
struct ModelSource {
    std::string name;
    std::optional<fs::path> shape;
    std::vector<AxisSource> axes;
    Json statistics;  ///< null: none
};

/// What the name of a file says, if it is one that `scaleaxis axis` gives: `NAME-axis-sSCALE` or `NAME-axis`.
struct NameParts {
    std::string name;
    std::optional<double> scale;
};

NameParts parts_of(const fs::path& file) {
    NameParts parts{file.stem().string(), std::nullopt};
    if (const std::size_t at = parts.name.rfind("-s"); at != std::string::npos) {
        double scale = 0.0;
        const char* end = parts.name.data() + parts.name.size();
        const auto [rest, error] = std::from_chars(parts.name.data() + at + 2, end, scale);
        if (error == std::errc() && rest == end && scale >= 1.0) {
            parts.scale = scale;
            parts.name.resize(at);
        }
    }
    for (const std::string_view kind : {"-axis", "-medial", "-filtration", "-skeleton"}) {
        if (parts.name.ends_with(kind) && parts.name.size() > kind.size()) {
            parts.name.resize(parts.name.size() - kind.size());
            break;
        }
    }
    return parts;
}

/// A file that statistics name: as it stands, or beside the statistics, which may have moved together with it.
std::optional<fs::path> found(const fs::path& file, const fs::path& statistics) {
    for (const fs::path& candidate :
         {file, statistics.parent_path() / file, statistics.parent_path() / file.filename()}) {
        if (fs::is_regular_file(candidate)) {
            return candidate;
        }
    }
    return std::nullopt;
}

void add_statistics(const Json& document, const fs::path& file, std::vector<ModelSource>& models) {
    for (const Json& result : document.at("results").elements()) {
        if (result.at("status") != Json(0) || result.contains("skipped")) {
            continue;
        }
        const fs::path input = result.at("input").get<std::string>();
        ModelSource model{input.stem().string(), found(input, file), {}, result};
        model.statistics.erase("axes");
        for (const Json& axis : result.at("axes").elements()) {
            const fs::path name = axis.at("file").get<std::string>();
            const std::optional<fs::path> axis_file = found(name, file);
            if (!axis_file) {
                throw FileError(file.string() + ": the axis " + name.string() +
                                " that it names is neither there nor beside it");
            }
            const Json surface = axis.value("surface", Json());
            model.axes.push_back(
                {axis.at("scale").get<double>(), *axis_file,
                 surface.is_object() ? found(surface.at("file").get<std::string>(), file) : std::nullopt, axis});
        }
        models.push_back(std::move(model));
    }
}

/// A filtration is a model of its own, which has all scales.
void add_filtration(const fs::path& file, std::vector<ModelSource>& models) {
    models.push_back({parts_of(file).name, std::nullopt, {{1.0, file, std::nullopt, nullptr, true}}, nullptr});
}

/// Adds an axis to the model of its name, or begins one.
void add_axis(const fs::path& file, std::vector<ModelSource>& models) {
    const NameParts parts = parts_of(file);
    const double scale = parts.scale ? *parts.scale : stored_scale(file).value_or(1.0);
    const auto model = std::ranges::find_if(models, [&](const ModelSource& m) {
        return m.name == parts.name && m.statistics.is_null() && !m.axes.empty() && !m.axes.front().has_all_scales &&
               std::ranges::none_of(m.axes, [&](const AxisSource& a) { return a.scale == scale; });
    });
    AxisSource axis{scale, file, std::nullopt, nullptr};
    if (model == models.end()) {
        models.push_back({parts.name, std::nullopt, {std::move(axis)}, nullptr});
    } else {
        model->axes.push_back(std::move(axis));
    }
}

bool is_statistics(const fs::path& file) { return file.extension() == ".json" || has_lines(file); }

void add_file(const fs::path& file, std::vector<ModelSource>& models) {
    if (is_statistics(file)) {
        const std::optional<Json> document = read_statistics(file);
        if (!document) {
            throw FileError(file.string() + ": these are no statistics of scaleaxis axis (--stats)");
        }
        try {
            add_statistics(*document, file, models);
        } catch (const JsonError& error) {
            throw FileError(file.string() + ": these statistics are damaged: " + error.what());
        }
    } else if (file_kind(file) == FileKind::kMesh) {
        models.push_back({file.stem().string(), file, {}, nullptr});
    } else if (is_filtration(file)) {
        add_filtration(file, models);
    } else {
        add_axis(file, models);
    }
}

/// Statistics in a folder with all that they name, and the axes there that they do not name.
void add_folder(const fs::path& folder, std::vector<ModelSource>& models) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    const std::size_t before = models.size();
    for (const fs::path& file : files) {
        if (is_statistics(file) && read_statistics(file)) {
            add_file(file, models);
        }
    }
    std::vector<fs::path> known;
    for (std::size_t m = before; m < models.size(); ++m) {
        for (const AxisSource& axis : models[m].axes) {
            known.push_back(fs::canonical(axis.file));
        }
    }
    for (const fs::path& file : files) {
        const bool may_be_axis = file.extension() == ".ply" || file.extension() == ".ma";
        if (may_be_axis && std::ranges::find(known, fs::canonical(file)) == known.end() &&
            file_kind(file) == FileKind::kAxis) {
            add_file(file, models);
        }
    }
    if (models.size() == before) {
        throw FileError(folder.string() + ": there is no axis (.ply, .ma) in this folder, and there are no statistics");
    }
}

std::vector<ModelSource> sources_of(const std::vector<fs::path>& results) {
    std::vector<ModelSource> models;
    for (const fs::path& result : results) {
        if (fs::is_directory(result)) {
            add_folder(result, models);
        } else {
            add_file(result, models);
        }
    }
    return models;
}

/// The mesh of a model in a folder of meshes.
std::optional<fs::path> shape_in(const fs::path& folder, const std::string& name) {
    for (const std::string_view extension : {".obj", ".off", ".ply", ".stl"}) {
        const fs::path file = folder / (name + std::string(extension));
        if (fs::is_regular_file(file)) {
            return file;
        }
    }
    return std::nullopt;
}

/// Gives models without a surface of their own, whose values would be lost, the shapes of `--shape`: one for all, one
/// for each, or those in a folder.
void add_shapes(const std::vector<fs::path>& shapes, std::vector<ModelSource>& models) {
    const bool is_folder = shapes.size() == 1 && fs::is_directory(shapes.front());
    if (shapes.size() == 1 || shapes.size() == models.size()) {
        if (std::ranges::all_of(models, [](const ModelSource& m) { return m.shape.has_value(); })) {
            print_warning("--shape has no effect: all models have a surface of their own");
        }
        for (std::size_t m = 0; m < models.size(); ++m) {
            if (!models[m].shape) {
                models[m].shape = is_folder ? shape_in(shapes.front(), models[m].name)
                                            : std::optional(shapes[shapes.size() == 1 ? 0 : m]);
            }
        }
    } else if (!shapes.empty()) {
        throw InvalidOption("--shape: " + std::to_string(shapes.size()) + " shapes for " +
                            std::to_string(models.size()) + " models; give one for all, one for each, or a folder");
    }
}

/// Balls alone as a complex of isolated vertices.
MedialComplex complex_of(const std::vector<Ball>& balls) {
    MedialComplex complex;
    for (const Ball& ball : balls) {
        complex.vertex_origins.push_back({VertexKind::kBall, static_cast<Index>(complex.vertices.size())});
        complex.vertices.push_back(ball.center);
        complex.radii.push_back(ball.radius);
    }
    return complex;
}

ViewedAxis read_viewed_axis(const AxisSource& source) {
    ViewedAxis axis;
    if (source.has_all_scales) {
        Filtration nested = read_filtration(source.file);
        std::vector<FiltrationLevel> levels = profile(nested, nested.largest_scale);
        const Json statistics{{"file", source.file.string()}, {"topology", json_of(topology(nested.complex))}};
        axis = viewed(std::move(nested), std::move(levels));
        axis.statistics = to_text(statistics);
        return axis;
    }
    const bool is_axis = file_kind(source.file) == FileKind::kAxis;
    axis.complex = is_axis ? read_axis(source.file) : complex_of(read_balls(source.file));
    axis.complex.scale = source.scale;
    if (source.surface) {
        axis.surface = read_mesh_with_warnings(*source.surface, *source.surface);
    }
    Json statistics = source.statistics;
    if (statistics.is_null()) {
        statistics = {{"file", source.file.string()}};
        if (is_axis) {
            statistics["topology"] = json_of(topology(axis.complex));
        }
    }
    axis.statistics = to_text(statistics);
    return axis;
}

/// Of a surface that `scaleaxis thickness` has written.
std::optional<ViewedThickness> read_thickness(const fs::path& file, const TriangleMesh& surface) {
    std::optional<std::vector<double>> local, foot;
    std::vector<Index> regions;
    for (VertexValues& values : read_vertex_values(file)) {
        if (values.values.size() != surface.vertices.size()) {
            return std::nullopt;
        }
        if (values.name == "local_thickness") {
            local = std::move(values.values);
        } else if (values.name == "foot_thickness") {
            foot = std::move(values.values);
        } else if (values.name == "region") {
            regions.assign(values.values.begin(), values.values.end());
        }
    }
    if (!local || !foot) {
        return std::nullopt;
    }
    return ViewedThickness{*std::move(local), *std::move(foot), std::move(regions)};
}

std::string read_model(const ModelSource& source, const std::stop_token& cancel) {
    ViewedModel model;
    model.name = source.name;
    if (source.shape) {
        model.shape = read_mesh_with_warnings(*source.shape, *source.shape);
        model.thickness = read_thickness(*source.shape, model.shape);
    }
    for (const AxisSource& axis : source.axes) {
        model.axes.push_back(read_viewed_axis(axis));
    }
    if (!source.statistics.is_null()) {
        model.statistics = to_text(source.statistics);
    }
    return view_data(model, {.cancel = cancel});
}

Status run_view(const ViewOptions& options, const std::stop_token& cancel) {
    check_output(options.output, check_view_output);
    std::vector<ModelSource> models = sources_of(options.results);
    if (models.empty()) {
        throw FileError(options.results.front().string() +
                        ": there is nothing to show, since each of its inputs was skipped or has failed; name axes or "
                        "a folder of them");
    }
    add_shapes(options.shapes, models);

    Page page;
    for (const ModelSource& source : models) {
        stop_if_requested(cancel);
        if (!source.shape && source.statistics.is_object()) {
            print_warning(source.name + ": its input " + source.statistics.value("input", std::string()) +
                          " is not there, so the page has no input shape; --shape names it");
        }
        page.add(source.name, read_model(source, cancel));
    }
    stop_if_requested(cancel);
    page.write(options.output);
    if (!options.is_quiet) {
        print_page(options.output);
    }
    return kDone;
}

}  // namespace

Command view_command(CommandLine program) {
    const CommandLine command = program.add_subcommand("view", "Page that shows results in any browser");
    auto options = std::make_shared<ViewOptions>();
    command
        .add_option("RESULT", options->results,
                    "Statistics of scaleaxis axis (.json or .jsonl, with all files that they name), axes (.ply, .ma),\n"
                    "filtrations, balls, meshes (those of scaleaxis thickness in colours), or folders of these. Files\n"
                    "NAME-axis-s1.1.ply, NAME-axis-s1.5.ply are one model at two scales; up to " +
                        std::to_string(kMostSideBySide) + " models are seen\nside by side, more on a contact sheet")
        .required()
        .value_text("...");
    command.add_option("-o,--output", options->output, "Page: .html").required().value_text("OUT");
    command
        .add_option("--shape", options->shapes,
                    "Mesh of the input shape, for models without a surface: one for all models, one for each\n"
                    "in their order, or a folder with meshes of their names")
        .one_text_each()
        .value_text("MESH");
    command.add_flag("-q,--quiet", options->is_quiet, "No summary").value_text(" ");
    command.footer(
        "Examples:\n"
        "  scaleaxis axis *.off -o results/ --stats results/statistics.json\n"
        "  scaleaxis view results -o sheet.html\n"
        "  scaleaxis view cat-axis-s1.1.ply cat-axis-s1.5.ply --shape cat.obj -o cat.html");
    return {command, [options](const std::stop_token& cancel) { return run_view(*options, cancel); }};
}

}  // namespace scaleaxis::app
