// SPDX-License-Identifier: Apache-2.0
// scaleaxis thickness: a solid, or its axis → thickness of its surface and in it.
#include <algorithm>
#include <charconv>
#include <cmath>
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
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/thickness.hpp"
#include "scaleaxis/union_mesh.hpp"
#include "scaleaxis/view.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr auto kThicknessSchema = "scaleaxis.thickness/1";
constexpr double kDefaultEdge = 0.01;
constexpr Index kDefaultResolution = 128;
constexpr Range kEdgeRange{0.0, 1.0};
constexpr Range kBinsRange{1.0, 10000.0};

struct ThicknessCommandOptions {
    fs::path input;
    SourceOptions source;
    fs::path surface;  ///< beside an axis: the mesh at which its thickness is asked; empty: its envelope
    std::string output;
    std::string output_format;
    std::string image;                ///< empty: none
    std::string view;                 ///< the interactive page; empty: none
    std::optional<Index> resolution;  ///< unset: `kDefaultResolution`
    std::optional<Length> delta;
    Sizing sizing = Sizing::kAdaptive;
    double scale = 1.1;
    ThicknessOptions thickness;
    double edge = kDefaultEdge;
    std::optional<double> limit;
    Index bins = 20;
    CommonOptions common;
};

/// What is asked about.
struct MeasuredSolid {
    MedialComplex axis;
    TriangleMesh surface;
    std::unique_ptr<Solid> solid;  ///< null: the envelope of the axis
    std::optional<Image> grid;     ///< of the input, if it is an image; all values 0
    bool is_mask = false;          ///< that image
    std::string unit;
    std::vector<StageCost> costs;
    std::vector<Diagnostic> warnings;
};

MeasuredSolid read_axis_and_surface(const ThicknessCommandOptions& options, const fs::path& path,
                                    const Execution& execution) {
    MeasuredSolid subject;
    subject.axis = read_axis(path);
    if (!options.surface.empty()) {
        subject.surface = read_mesh_with_warnings(options.surface, options.surface);
        return subject;
    }
    const Envelope envelope(subject.axis);
    UnionMesh mesh = envelope_mesh(envelope, {options.delta.value_or(kDefaultDelta), options.common.seed}, execution);
    subject.surface = std::move(mesh.boundary.mesh);
    subject.warnings = std::move(mesh.warnings);
    return subject;
}

Image grid_of(const ImageReport& report) {
    return {report.sizes, report.origin, steps_of(report), {}, report.unit, report.space};
}

MeasuredSolid computed_axis(const ThicknessCommandOptions& options, Source source, const Listener& listener) {
    const auto warn = listener.warn_about(source.name);
    const ScaleAxisOptions pipeline{.delta = options.delta,
                                    .scales = {options.scale},
                                    .sizing = options.sizing,
                                    .keeps_samples = true,
                                    .seed = options.common.seed};
    source.options.load.delta = finest_delta(pipeline);
    LoadedSolid input = load_source(source, listener.execution({0.0, 0.15}), warn, true);
    if (!input.solid) {
        throw InvalidOption("thickness needs a solid: take --points mls, or scaleaxis axis and then its axis");
    }
    ScaleAxis result = scale_axis(*input.solid, pipeline, listener.execution({0.15, 0.9}));
    MeasuredSolid subject;
    for (std::size_t i = input.solid->warnings().size(); i < result.warnings.size(); ++i) {
        warn(result.warnings[i]);
    }
    subject.axis = std::move(result.axes[0].complex);
    subject.surface = input.mesh.triangles.empty()
                          ? boundary_mesh(*result.kept_samples, listener.execution({0.9, 0.9})).mesh
                          : std::move(input.mesh);
    if (const auto* image = std::get_if<ImageReport>(&input.input)) {
        subject.grid = grid_of(*image);
        subject.is_mask = !source.options.load.iso;
    }
    subject.unit = unit_of(input.input);
    subject.solid = std::move(input.solid);
    subject.costs = std::move(input.costs);
    subject.costs.insert(subject.costs.end(), result.costs.begin(), result.costs.end());
    subject.costs.insert(subject.costs.end(), result.axes[0].costs.begin(), result.axes[0].costs.end());
    subject.warnings = std::move(input.warnings);
    subject.warnings.insert(subject.warnings.end(), result.warnings.begin(), result.warnings.end());
    return subject;
}

/// Local thickness in the solid, on the grid of the input, or on a cubic one around it.
Image thickness_image(const MeasuredSolid& subject, const Thickness& thickness, Index resolution,
                      const Execution& execution) {
    InsideTest inside;
    Box box;
    if (subject.solid) {
        box = subject.solid->bounds();
        inside = [&](std::span<const Point> points, std::span<std::uint8_t> sides) {
            subject.solid->inside(points, sides);
        };
    } else {
        const Envelope envelope(subject.axis);
        box = envelope.bounds();
        inside = [envelope](std::span<const Point> points, std::span<std::uint8_t> sides) {
            std::ranges::copy(envelope.inside(points), sides.begin());
        };
    }
    Image mask = grid_mask(subject.grid ? *subject.grid : cubic_grid(box, resolution), inside, execution);
    Image image = thickness.image(mask, execution);
    image.unit = mask.unit;
    image.space = mask.space;
    return image;
}

/// A line for each vertex.
void write_table(const fs::path& file, const TriangleMesh& mesh, const std::vector<PointThickness>& thickness,
                 const std::vector<Index>& regions) {
    std::string text = "x,y,z,local_thickness,foot_thickness,ball_x,ball_y,ball_z,region\n";
    const auto add = [&](double number, char end) {
        char digits[32];
        text.append(digits, std::to_chars(std::begin(digits), std::end(digits), number).ptr);
        text += end;
    };
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Ball& ball = thickness[v].ball;
        for (const double number : {mesh.vertices[v].x, mesh.vertices[v].y, mesh.vertices[v].z, thickness[v].thickness,
                                    thickness[v].foot, ball.center.x, ball.center.y, ball.center.z}) {
            add(number, ',');
        }
        text += std::to_string(regions.empty() ? kNone : regions[v]) + '\n';
    }
    write_text(file, text);
}

bool is_table(const fs::path& file, const std::string& format) {
    return format == "csv" || (format.empty() && file.extension() == ".csv");
}

void check_thickness_output(const fs::path& file, const std::string& format) {
    if (!is_table(file, format)) {
        check_surface_output(file, format);
    }
}

Json json_of_place(const Point& p) { return {p.x, p.y, p.z}; }

Json json_of_values(const SurfaceValues& values, const TriangleMesh& mesh) {
    return {{"mean", values.mean},   {"deviation", values.deviation},
            {"minimum", values.min}, {"minimum_place", json_of_place(mesh.vertices[values.min_vertex])},
            {"maximum", values.max}, {"maximum_place", json_of_place(mesh.vertices[values.max_vertex])}};
}

/// The files that one solid leads to.
struct ThicknessFiles {
    std::optional<fs::path> surface;
    std::optional<fs::path> image;
    fs::path page;  ///< empty: none
};

ThicknessFiles files_of(const ThicknessCommandOptions& options, const Source& source, std::vector<Output>& outputs) {
    const auto planned = [&](const std::string& output, const std::string& kind, const std::string& format,
                             const std::string& otherwise, const auto& check) -> std::optional<fs::path> {
        if (output.empty()) {
            return std::nullopt;
        }
        const fs::path file =
            expand(output_pattern(output, kind, false, format, otherwise), source.name, options.scale);
        check_output(file, with_format(check, format, otherwise));
        outputs.push_back({file, source.name});
        return file;
    };
    ThicknessFiles files;
    files.surface = planned(options.output, "thickness", options.output_format, "ply", check_thickness_output);
    files.image = planned(options.image, "thickness", "", "nrrd",
                          [](const fs::path& file, const std::string& format) { check_image_output(file, format); });
    files.page = page_output(options.view, source.name, options.scale);
    if (!files.page.empty()) {
        outputs.push_back({files.page, source.name});
    }
    return files;
}

/// An axis that is there already, or that of the solid.
MeasuredSolid measured_solid(const ThicknessCommandOptions& options, const Source& source, const Listener& listener) {
    if (source.is_axis) {
        // Without a surface that of the envelope is made.
        check_unused_beside_axis(options.source, options.surface.empty()
                                                     ? std::vector<std::string>{"--format", "--delta", "--delta-abs"}
                                                     : std::vector<std::string>{"--format"});
        Stopwatch watch;
        MeasuredSolid subject = reading(source, [&](const fs::path& path) {
            return read_axis_and_surface(options, path, listener.execution({0.0, 0.9}));
        });
        subject.costs.push_back(watch.lap("reading"));
        return subject;
    }
    MeasuredSolid subject = computed_axis(options, source, listener);
    if (options.resolution && subject.grid) {
        throw InvalidOption("--resolution has no effect on an image, whose grid is taken: leave it out");
    }
    return subject;
}

SourceResult run_source(const ThicknessCommandOptions& options, const Source& source, const ThicknessFiles& files,
                        const Listener& listener, const std::stop_token& cancel) {
    const auto& [surface_file, image_file, page] = files;
    MeasuredSolid subject = measured_solid(options, source, listener);
    Stopwatch watch;
    const Execution execution = listener.execution({0.9, 1.0});
    if (options.edge > 0.0) {
        Box box;
        std::ranges::for_each(subject.surface.vertices, [&](const Point& p) { box.extend(p); });
        subject.surface = with_short_edges(std::move(subject.surface), options.edge * box.diagonal(), execution);
    }
    const Thickness thickness(subject.axis, options.thickness);
    const std::vector<PointThickness> found =
        subject.solid ? thickness.at_surface(subject.surface.vertices, *subject.solid, execution)
                      : thickness.at_surface(subject.surface, execution);
    std::vector<double> local(found.size());
    std::vector<double> foot(found.size());
    std::ranges::transform(found, local.begin(), &PointThickness::thickness);
    std::ranges::transform(found, foot.begin(), &PointThickness::foot);
    const SurfaceValues values = surface_values(subject.surface, local);
    const SurfaceValues foot_values = surface_values(subject.surface, foot);
    const AreaHistogram histogram = area_histogram(subject.surface, local, options.bins);
    const ThinRegions thin = options.limit ? thin_regions(subject.surface, local, *options.limit) : ThinRegions();
    if (subject.is_mask) {
        if (auto warning = unresolved_thickness(subject.surface, local, subject.grid->steps)) {
            listener.warn_about(source.name)(*warning);
            subject.warnings.push_back(std::move(*warning));
        }
    }
    subject.costs.push_back(watch.lap("thickness"));
    std::optional<Image> image;
    if (image_file) {
        image = thickness_image(subject, thickness, options.resolution.value_or(kDefaultResolution), execution);
        subject.costs.push_back(watch.lap("image"));
    }
    stop_if_requested(cancel);
    if (surface_file && is_table(*surface_file, options.output_format)) {
        write_table(*surface_file, subject.surface, found, thin.vertex_regions);
    } else if (surface_file) {
        std::vector<VertexValues> all{{"local_thickness", local}, {"foot_thickness", foot}};
        if (options.limit) {
            all.push_back({"region", {thin.vertex_regions.begin(), thin.vertex_regions.end()}});
        }
        write_surface(*surface_file, subject.surface, all, written_format(*surface_file, options.output_format));
    }
    if (image_file) {
        write_image(*image_file, *image, written_format(*image_file, "", "nrrd"));
    }
    subject.costs.push_back(watch.lap("writing"));

    const std::string unit = subject.unit.empty() ? "" : " " + subject.unit;
    std::ostringstream text;
    text << source.name.string() << '\n';
    label(text, "thickness") << "minimum " << values.min << unit << " at "
                             << text_of_place(subject.surface.vertices[values.min_vertex]) << ", mean " << values.mean
                             << ", deviation " << values.deviation << ", maximum " << values.max << '\n';
    label(text, "surface") << subject.surface.vertices.size() << " vertices, area " << values.area
                           << (surface_file ? " -> " + surface_file->string() : "") << '\n';
    if (options.limit) {
        double area = 0.0;
        for (const ThinRegion& region : thin.regions) {
            area += region.area;
        }
        label(text, "thin") << thin.regions.size() << (thin.regions.size() == 1 ? " region" : " regions") << " below "
                            << *options.limit << unit << ", area " << area << '\n';
        for (std::size_t i = 0; i < std::min<std::size_t>(thin.regions.size(), 10); ++i) {
            const ThinRegion& region = thin.regions[i];
            label(text, "") << region.min << " at " << text_of_place(subject.surface.vertices[region.min_vertex])
                            << ", area " << region.area << '\n';
        }
    }
    if (image) {
        label(text, "image") << image->sizes[0] << " x " << image->sizes[1] << " x " << image->sizes[2] << " -> "
                             << image_file->string() << '\n';
    }
    print(text, subject.costs);
    Json regions = Json::array();
    for (const ThinRegion& region : thin.regions) {
        const Ball& ball = found[region.min_vertex].ball;
        regions.push_back({{"area", region.area},
                           {"minimum", region.min},
                           {"place", json_of_place(subject.surface.vertices[region.min_vertex])},
                           {"ball", {{"center", json_of_place(ball.center)}, {"radius", ball.radius}}},
                           {"vertices", region.vertices}});
    }
    SourceResult result;
    result.entry = {{"input", source.name.string()},
                    {"unit", subject.unit.empty() ? Json(nullptr) : Json(subject.unit)},
                    {"scale", source.is_axis ? Json(nullptr) : Json(options.scale)},
                    {"angle", options.thickness.angle},
                    {"vertices", subject.surface.vertices.size()},
                    {"area", values.area},
                    {"local", json_of_values(values, subject.surface)},
                    {"foot", json_of_values(foot_values, subject.surface)},
                    {"histogram", {{"width", histogram.width}, {"areas", histogram.areas}}},
                    {"limit", options.limit ? Json(*options.limit) : Json(nullptr)},
                    {"regions", options.limit ? regions : Json(nullptr)},
                    {"file", surface_file ? Json(surface_file->string()) : Json(nullptr)},
                    {"view", page.empty() ? Json(nullptr) : Json(page.string())},
                    {"image_file", image_file ? Json(image_file->string()) : Json(nullptr)},
                    {"warnings", json_of(subject.warnings)},
                    {"costs", json_of(subject.costs)}};
    if (!page.empty()) {
        Json document = new_document(kThicknessSchema);
        document.update(result.entry);
        ViewedModel model{source.name.stem().string(), std::move(subject.surface), {}, to_text(document)};
        model.axes.push_back({std::move(subject.axis), {}, {}});
        model.thickness = ViewedThickness{std::move(local), std::move(foot), thin.vertex_regions, options.limit};
        write_page(page, model, false, execution);
        text << text_of_page(page);
    }
    result.summary = text.str();
    return result;
}

Status run_thickness(ThicknessCommandOptions options, const std::stop_token& cancel) {
    if (options.resolution && options.image.empty()) {
        throw InvalidOption("--resolution has no effect without --image: leave it out, or add --image FILE");
    }
    const std::vector<Source> sources = sources_of_one(options.input, options.source);
    if (!options.surface.empty() && !sources.front().is_axis) {
        throw InvalidOption("--surface has no effect where the axis is computed from a solid: leave it out");
    }
    std::vector<Output> outputs;
    std::vector<ThicknessFiles> files;
    for (const Source& source : sources) {
        files.push_back(files_of(options, source, outputs));
    }
    check_all_outputs(outputs, options.common);
    return run_sources(sources, options.source, options.common, new_document(kThicknessSchema), cancel,
                       [&](std::size_t i, const Listener& listener) {
                           return run_source(options, sources[i], files[i], listener, cancel);
                       });
}

}  // namespace

Command thickness_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("thickness", "Local thickness of a solid, at its surface and as an image; thin regions");
    auto options = std::make_shared<ThicknessCommandOptions>();
    command
        .add_option(
            "INPUT", options->input,
            "A solid as for scaleaxis axis, whose axis is computed; or an axis (.ply, .ma);\nnone with --implicit")
        .value_text(" ");
    add_output_option(command, options->output, options->output_format,
                      "Surface, coloured by thickness: .ply, .vtp or .glb, or a table of its vertices: .csv;\n"
                      "a folder gets {name}-thickness.ply; {name} is filled in");
    command.option("--output").required(false);
    command
        .add_option("--image", options->image,
                    "Also write the local thickness in the solid as an image: .nrrd or .nii, on the grid of the\n"
                    "input if that is an image; a folder gets {name}-thickness.nrrd")
        .value_text("FILE");
    command
        .add_option("--view", options->view,
                    "Also write a page that any browser shows, the surface coloured by thickness: .html;\n"
                    "a folder gets {name}-view.html")
        .value_text("FILE");
    add_number(command, "--resolution", options->resolution,
               "Points along the longest side of the image of an input that is none", kResolutionRange, "N",
               kDefaultResolution);
    command
        .add_option("--limit", options->limit,
                    "Tell the connected regions of the surface that are thinner, a length in units of the input")
        .check([](const std::string& text) {
            double limit = 0.0;
            const bool is_length = parse_value(text, limit) && limit > 0.0 && std::isfinite(limit);
            return is_length ? std::string() : text + " is no positive length";
        })
        .value_text("LENGTH");
    add_number(command, "--angle", options->thickness.angle,
               "Least angle between two contacts of a ball, seen from its centre, for which it counts: those in\n"
               "edges see less, so that these do not read as thin; 0: all balls, the definition of Hildebrand\n"
               "and Rueegsegger; degrees",
               kContactAngleRange, "A");
    add_measured_scale_option(command, options->scale);
    add_delta_options(command, options->delta, nullptr);
    add_sampling_option(command, options->sizing);
    add_number(command, "--edge", options->edge,
               "Divide the triangles of the surface until no edge is longer, relative to the diagonal of the\n"
               "bounding box; 0: leave them as they are",
               kEdgeRange, "R");
    command.add_option("--surface", options->surface, "Beside an axis: the mesh at which its thickness is asked")
        .value_text("MESH");
    add_number(command, "--bins", options->bins, "Bins of the histogram", kBinsRange, "N");
    add_source_options(command, options->source, {"--delta", "--delta-abs", "--sampling", "--scale"});
    add_common_options(command, options->common);
    command.footer(
        "The local thickness at a point is the diameter of the largest ball in the solid that contains it.\n"
        "Examples:\n"
        "  scaleaxis thickness part.stl --limit 1.2 -o part-thickness.ply --view part.html\n"
        "  scaleaxis thickness bone.nii.gz --label 1 --image bone-thickness.nii\n"
        "  scaleaxis thickness part-axis.ply --surface part.stl -o part-thickness.csv");
    return {command, [options](const std::stop_token& cancel) { return run_thickness(*options, cancel); }};
}

}  // namespace scaleaxis::app
