// SPDX-License-Identifier: Apache-2.0
// The library as core.js calls it: bytes and options go in, JSON with arrays comes out. No exception leaves.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "answer.hpp"
#include "base/progress.hpp"
#include "io/memory/without_files.hpp"
#include "options.hpp"
#include "scaleaxis/scaleaxis.hpp"

#define EXPORTED(name) extern "C" __attribute__((export_name(#name), visibility("default")))

/// \returns 0 to cancel
extern "C" __attribute__((import_module("scaleaxis"), import_name("progress"))) int host_progress(const char* stage,
                                                                                                  std::size_t length,
                                                                                                  double fraction);

namespace scaleaxis::wasm {
namespace {

struct Call {
    FileBytes file;
    Options options;
    Execution execution;
};

Json json_of(const auto& value) { return Json::parse(to_json(value)); }
Json json_of(const std::vector<Diagnostic>& all) { return Json::parse(to_json(std::span<const Diagnostic>(all))); }
Json json_of(const std::vector<StageCost>& costs) { return Json::parse(to_json(std::span<const StageCost>(costs))); }

template <class T>
void append_to(std::vector<T>& all, const std::vector<T>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

std::string stem_of(const std::string& name) { return name.substr(0, name.find('.')); }

std::string file_of(const std::string& format) { return "file." + format; }

/// The same bytes as the program writes.
std::string axis_file(const MedialComplex& complex, const std::string& format, const Execution& execution) {
    AxisFileOptions options;
    if (format == "ply" || format == "vtp") {
        options.vertex_values.push_back({"erosion_thickness", erosion_thickness(complex, execution).thickness});
    }
    write_axis(file_of(format), complex, format, options);
    return io::take_written();
}

Json files_of(Answer& answer, const Call& call, const auto& file) {
    Json files = Json::object();
    for (const std::string& format : call.options.outputs.formats) {
        files[format] = answer.array(file(format));
    }
    return files;
}

Json lists_of(Answer& answer, const IndexLists& lists) {
    Json json = Json::object();
    json["offsets"] = answer.array(lists.offsets);
    json["items"] = answer.array(lists.items);
    return json;
}

Json mesh_of(Answer& answer, const TriangleMesh& mesh) {
    Json json = Json::object();
    json["vertices"] = answer.array(mesh.vertices);
    json["triangles"] = answer.array(mesh.triangles);
    return json;
}

/// Polygons as fans, and the sheet of each triangle.
void add_triangles(Answer& answer, Json& json, const MedialComplex& complex) {
    std::vector<std::array<Index, 3>> triangles;
    std::vector<Index> sheets;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> face = complex.faces[f];
        for (std::size_t k = 2; k < face.size(); ++k) {
            triangles.push_back({face[0], face[k - 1], face[k]});
            sheets.push_back(complex.face_sheets[f]);
        }
    }
    json["triangles"] = answer.array(std::move(triangles));
    json["triangleSheets"] = answer.array(std::move(sheets));
}

Json complex_json(Answer& answer, const MedialComplex& complex) {
    Json json = Json::object();
    json["vertices"] = answer.array(complex.vertices);
    json["radii"] = answer.array(complex.radii);
    json["edges"] = answer.array(complex.edges);
    json["faces"] = lists_of(answer, complex.faces);
    json["faceSheets"] = answer.array(complex.face_sheets);
    json["faceAngles"] = answer.array(complex.face_angles);
    json["sheets"] = complex.sheets;
    add_triangles(answer, json, complex);
    return json;
}

/// A solid, its axes, and the surface of the input.
struct Computed {
    LoadedSolid input;
    ScaleAxis axis;
    TriangleMesh surface;
    std::vector<Diagnostic> warnings;
    std::vector<StageCost> costs;

    const AxisAtScale& first() const { return axis.axes.front(); }
};

/// \param end of the progress
Computed computed(const Call& call, ScaleAxisOptions pipeline, bool has_surface, double end) {
    constexpr double kLoading = 0.15;  // its share of the progress, as in the program
    validate(pipeline);
    LoadOptions load = call.options.load;
    load.delta = finest_delta(pipeline);
    load.keeps_mesh = has_surface;
    Computed result;
    result.input = load_solid(call.file, load, part_of(call.execution, 0.0, kLoading));
    LoadedSolid& input = result.input;
    pipeline.keeps_samples = has_surface && input.mesh.triangles.empty();
    const Execution execution = part_of(call.execution, kLoading, end);
    std::size_t told = 0;
    if (input.solid) {
        result.axis = scale_axis(*input.solid, pipeline, execution);
        told = input.solid->warnings().size();  // when it was loaded
    } else {
        pipeline.delta.reset();
        pipeline.sizing = Sizing::kAdaptive;
        pipeline.union_kind.reset();
        result.axis = scale_axis(std::move(*input.samples), pipeline, execution);
    }
    result.warnings = input.warnings;
    result.warnings.insert(result.warnings.end(), result.axis.warnings.begin() + static_cast<std::ptrdiff_t>(told),
                           result.axis.warnings.end());
    result.costs = input.costs;
    append_to(result.costs, result.axis.costs);
    if (has_surface) {
        result.surface = input.mesh.triangles.empty() ? boundary_mesh(*result.axis.kept_samples, call.execution).mesh
                                                      : std::move(input.mesh);
    }
    return result;
}

Json statistics_of(const Computed& computed) {
    const ScaleAxis& axis = computed.axis;
    const std::string unit = unit_of(computed.input.input);
    Json json = Json::object();
    json[name_of(computed.input.input)] = json_of(computed.input.input);
    json["solid"] = axis.solid_topology ? json_of(*axis.solid_topology) : Json();
    json["unit"] = unit.empty() ? Json() : Json(unit);
    json["tolerance"] = axis.tolerance;
    json["diagonal"] = axis.diagonal;
    json["samples"] = axis.samples;
    json["sampling"] = json_of(axis.sampling_statistics);
    json["balls"] = axis.balls.size();
    json["fit"] = axis.fit ? json_of(*axis.fit) : Json();
    json["costs"] = json_of(computed.costs);
    json["warnings"] = json_of(computed.warnings);
    return json;
}

Json view_of(Answer& answer, ViewedModel model, const Execution& execution) {
    return answer.array(view_data(model, execution));
}

void axis_into(Answer& answer, const Call& call) {
    const bool has_view = call.options.outputs.has_view;
    Computed found = computed(call, call.options.pipeline, has_view, 1.0);
    Json statistics = statistics_of(found);
    Json axes = Json::array();
    ViewedModel model{stem_of(call.file.name), std::move(found.surface), {}, statistics.dump()};
    for (AxisAtScale& axis : found.axis.axes) {
        Json json = complex_json(answer, axis.complex);
        json["scale"] = axis.complex.scale;
        json["statistics"] = json_of(report_of(axis, found.axis.solid_topology));
        json["files"] = files_of(
            answer, call, [&](const std::string& format) { return axis_file(axis.complex, format, call.execution); });
        if (has_view) {
            model.axes.push_back({std::move(axis.complex), {}, json.at("statistics").dump()});
        }
        axes.push_back(std::move(json));
    }
    answer.value["axes"] = std::move(axes);
    answer.value["balls"] = answer.array(std::move(found.axis.balls));
    answer.value["statistics"] = std::move(statistics);
    if (has_view) {
        answer.value["view"] = view_of(answer, std::move(model), call.execution);
    }
}

void filtration_into(Answer& answer, const Call& call) {
    constexpr double kAxis = 0.8;  // its share of the progress
    const bool has_view = call.options.outputs.has_view;
    ScaleAxisOptions pipeline = call.options.pipeline;
    pipeline.scales = {1.0};
    Computed found = computed(call, pipeline, has_view, kAxis);
    Filtration nested = filtration(std::move(found.axis.axes[0].complex), {}, part_of(call.execution, kAxis, 1.0));
    std::vector<FiltrationLevel> levels = profile(nested);
    append_to(found.costs, found.first().costs);
    Json& value = answer.value;
    value = complex_json(answer, nested.complex);
    value["vertexScales"] = answer.array(nested.vertex_scales);
    value["edgeScales"] = answer.array(nested.edge_scales);
    value["faceScales"] = answer.array(nested.face_scales);
    value["levels"] = Json::parse(to_json(std::span<const FiltrationLevel>(levels)));
    value["plateau"] = json_of(longest_plateau(levels));
    value["statistics"] = statistics_of(found);
    value["files"] = files_of(answer, call, [&](const std::string& format) {
        write_filtration(file_of(format), nested, format);
        return io::take_written();
    });
    if (has_view) {
        ViewedModel model{stem_of(call.file.name), std::move(found.surface), {}, value.at("statistics").dump()};
        model.axes.push_back(viewed(std::move(nested), std::move(levels)));
        value["view"] = view_of(answer, std::move(model), call.execution);
    }
}

std::vector<double> values_of(std::span<const PointThickness> points, double PointThickness::*value) {
    std::vector<double> values(points.size());
    std::ranges::transform(points, values.begin(), value);
    return values;
}

void thickness_into(Answer& answer, const Call& call) {
    constexpr double kAxis = 0.9;  // its share of the progress
    Computed found = computed(call, call.options.pipeline, true, kAxis);
    if (!found.input.solid) {
        throw InvalidOption("thickness needs a solid: choose the points method mls");
    }
    Box box;
    std::ranges::for_each(found.surface.vertices, [&](const Point& p) { box.extend(p); });
    if (call.options.edge > 0.0) {
        found.surface = with_short_edges(std::move(found.surface), call.options.edge * box.diagonal(),
                                         part_of(call.execution, kAxis, kAxis));
    }
    const AxisAtScale& axis = found.first();
    append_to(found.costs, axis.costs);
    const Thickness thickness(axis.complex, call.options.thickness);
    const std::vector<PointThickness> points =
        thickness.at_surface(found.surface.vertices, *found.input.solid, part_of(call.execution, kAxis, 1.0));
    std::vector<double> local = values_of(points, &PointThickness::thickness);
    std::vector<double> foot = values_of(points, &PointThickness::foot);
    const SurfaceValues values = surface_values(found.surface, local);
    Json& value = answer.value;
    value = mesh_of(answer, found.surface);
    value["local"] = answer.array(local);
    value["foot"] = answer.array(foot);
    Json statistics = statistics_of(found);
    Json summary = Json::object();
    summary["area"] = values.area;
    summary["mean"] = values.mean;
    summary["deviation"] = values.deviation;
    summary["minimum"] = values.min;
    summary["maximum"] = values.max;
    summary["minimum_vertex"] = values.min_vertex;
    statistics["thickness"] = std::move(summary);
    value["files"] = files_of(answer, call, [&](const std::string& format) {
        const std::vector<VertexValues> all{{"local_thickness", local}, {"foot_thickness", foot}};
        write_surface(file_of(format), found.surface, all, format);
        return io::take_written();
    });
    if (call.options.outputs.has_view) {
        ViewedModel model{stem_of(call.file.name), std::move(found.surface), {}, statistics.dump()};
        model.axes.push_back({axis.complex, {}, {}});
        model.thickness = ViewedThickness{std::move(local), std::move(foot)};
        value["view"] = view_of(answer, std::move(model), call.execution);
    }
    value["statistics"] = std::move(statistics);
}

void skeleton_into(Answer& answer, const Call& call) {
    constexpr double kAxis = 0.8;  // its share of the progress
    const bool has_view = call.options.outputs.has_view;
    ScaleAxisOptions pipeline = call.options.pipeline;
    pipeline.reaches_sharp_edges = false;  // best so, see `skeleton`
    Computed found = computed(call, pipeline, has_view, kAxis);
    const AxisAtScale& axis = found.first();
    append_to(found.costs, axis.costs);
    SkeletonOptions options = call.options.skeleton;
    options.spacing = call.options.node_spacing ? call.options.node_spacing->of(found.axis.diagonal) : 0.0;
    const Execution execution = part_of(call.execution, kAxis, 1.0);
    const Solid* const solid = found.input.solid.get();
    const Skeleton curves =
        solid != nullptr && solid->knows_nearest()
            ? skeleton(axis.complex, *solid, options, execution)
            : skeleton(axis.complex, BallUnion(scaled(found.axis.balls, axis.complex.scale)), options, execution);
    Json& value = answer.value;
    value["nodes"] = answer.array(curves.nodes);
    value["radii"] = answer.array(curves.radii);
    value["edges"] = answer.array(curves.edges);
    value["branches"] = lists_of(answer, curves.branches);
    value["nodeBranches"] = answer.array(curves.node_branches);
    value["faces"] = lists_of(answer, curves.faces);
    Json statistics = statistics_of(found);
    statistics["skeleton"] = json_of(statistics_of(curves, axis.complex));
    value["files"] = files_of(answer, call, [&](const std::string& format) {
        write_skeleton(file_of(format), curves, format);
        return io::take_written();
    });
    if (has_view) {
        ViewedModel model{stem_of(call.file.name), std::move(found.surface), {}, statistics.dump()};
        model.axes.push_back({complex_of(curves), {}, {}});
        model.axes.back().complex.scale = axis.complex.scale;
        value["view"] = view_of(answer, std::move(model), call.execution);
    }
    value["statistics"] = std::move(statistics);
}

void convert_into(Answer& answer, const Call& call) {
    const MedialComplex complex = read_axis(call.file);
    answer.value["files"] =
        files_of(answer, call, [&](const std::string& format) { return axis_file(complex, format, call.execution); });
}

constexpr std::pair<std::string_view, void (*)(Answer&, const Call&)> kFunctions[]{
    {"axis", axis_into},         {"filtration", filtration_into}, {"thickness", thickness_into},
    {"skeleton", skeleton_into}, {"convert", convert_into},
};

void answer_into(Answer& answer, std::string_view function, const Call& call) {
    const auto known =
        std::ranges::find(kFunctions, function, &std::pair<std::string_view, void (*)(Answer&, const Call&)>::first);
    if (known == std::end(kFunctions)) {
        throw InvalidOption("there is no function " + std::string(function));
    }
    known->second(answer, call);
}

bool tell(std::string_view stage, double fraction) { return host_progress(stage.data(), stage.size(), fraction) != 0; }

/// Of the last call.
struct Last {
    Answer answer;
    std::string json;
};
Last& last() {
    static Last last;
    return last;
}

void fail(const Diagnostic& diagnostic) {
    last() = {};
    last().json = to_json(diagnostic);
}

}  // namespace
}  // namespace scaleaxis::wasm

using namespace scaleaxis;
using namespace scaleaxis::wasm;

EXPORTED(allocate) void* allocate(std::size_t bytes) { return std::malloc(bytes); }
EXPORTED(release) void release(void* bytes) { std::free(bytes); }
EXPORTED(version) const char* version() { return SCALEAXIS_VERSION; }

/// The texts end with 0. \returns whether it is done; `output` then is the answer, and else a diagnostic
EXPORTED(run)
int run(const char* function, const char* name, const char* options, const std::byte* bytes, std::size_t size) {
    last() = {};
    try {
        const Call call{{{bytes, size}, name}, read_options(Json::parse(options)), {1, tell, {}}};
        answer_into(last().answer, function, call);
        last().json = last().answer.value.dump();
        return 1;
    } catch (const Error& error) {
        fail(error.diagnostic());
    } catch (const std::bad_alloc&) {
        fail({"memory", "there is not enough memory: WebAssembly has 4 GiB; a larger delta takes less"});
    } catch (const std::exception& error) {
        fail({"failure", error.what()});
    }
    return 0;
}

EXPORTED(output) const char* output() { return last().json.data(); }
EXPORTED(output_size) std::size_t output_size() { return last().json.size(); }
EXPORTED(clear) void clear() { last() = {}; }
