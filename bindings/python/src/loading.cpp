// SPDX-License-Identifier: Apache-2.0
// Inputs of any kind → solids, with what there is to tell about them.
#include "scaleaxis/load.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "images.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::python {
namespace {

constexpr std::pair<std::string_view, FileKind> kFileKinds[]{{"mesh", FileKind::kMesh},
                                                             {"points", FileKind::kPoints},
                                                             {"balls", FileKind::kBalls},
                                                             {"axis", FileKind::kAxis},
                                                             {"image", FileKind::kImage}};

LoadOptions image_options(std::optional<double> iso, bool is_below, std::vector<float> labels, bool is_nonzero,
                          std::optional<double> mask_smoothing, bool fills_voids) {
    LoadOptions options;
    options.iso = iso;
    options.is_below = is_below;
    options.labels = std::move(labels);
    options.is_nonzero = is_nonzero;
    options.mask_smoothing = mask_smoothing;
    options.fills_voids = fills_voids;
    return options;
}

SolidOptions solid_options(const std::optional<std::string>& kind, double opening, double thickness) {
    constexpr std::pair<std::string_view, SolidKind> kSolidKinds[]{{"auto", SolidKind::kAuto},
                                                                   {"winding", SolidKind::kWinding},
                                                                   {"wrap", SolidKind::kWrap},
                                                                   {"thicken", SolidKind::kThicken}};
    return {kind ? value_of("triangles", *kind, kSolidKinds) : SolidKind::kAuto, opening, thickness};
}

/// As `load_solid` does for a file with a mesh.
LoadedSolid load_mesh(const MeshView& mesh, const SolidOptions& options, const Execution& execution) {
    LoadedSolid loaded;
    SolidOfTriangles made = solid_of_triangles(mesh, options, execution);
    if (!made.solid) {
        throw UnusableInput(made.report.fault);
    }
    loaded.warnings = made.report.warnings();
    loaded.input = std::move(made.report);
    loaded.mesh = std::move(made.mesh);
    loaded.left_out = std::move(made.left_out);
    loaded.solid = std::move(made.solid);
    return loaded;
}

/// As `load_solid` does for a file with points.
LoadedSolid load_points(const CloudView& points, std::optional<CloudMethod> method, std::optional<double> kernel,
                        const std::optional<Length>& delta, const Execution& execution) {
    LoadOptions options;
    options.cloud_method = method;
    options.kernel = kernel;
    validate(options, "points");
    LoadedSolid loaded;
    const PreparedCloud cloud = prepare(points, prepare_options(points.points, delta), execution);
    loaded.warnings = cloud.report.warnings();
    if (!cloud.report.fault.empty()) {
        throw UnusableInput(cloud.report.fault);
    }
    CloudChoice choice = method ? CloudChoice{*method, "as asked for", std::nullopt} : choose_method(cloud, execution);
    if (choice.method == CloudMethod::kCrust) {
        if (kernel) {
            throw InvalidOption("the kernel has no effect, since the crust suits these points (" + choice.reason +
                                "): leave it out, or choose the points method mls");
        }
        loaded.samples = choice.samples ? std::move(*choice.samples) : crust(cloud, execution);
    } else {
        loaded.solid = cloud_solid(cloud, {kernel}, execution);
    }
    loaded.input = PointsReport{cloud.report, choice.method, choice.reason};
    return loaded;
}

std::optional<CloudMethod> cloud_method_of(const std::optional<std::string>& name) {
    constexpr std::pair<std::string_view, CloudMethod> kMethods[]{{"mls", CloudMethod::kMovingLeastSquares},
                                                                  {"crust", CloudMethod::kCrust}};
    return name ? std::optional(value_of("points", *name, kMethods)) : std::nullopt;
}

}  // namespace

Fields fields_of(LoadedSolid loaded) {
    Fields fields;
    fields["kind"] = nb::str(name_of(loaded.input).data(), name_of(loaded.input).size());
    fields["input"] = to_json(loaded.input);
    fields["solid"] = nb::none();
    if (loaded.solid) {
        fields["solid"] = nb::cast(loaded.solid.release(), nb::rv_policy::take_ownership);
    }
    fields["samples"] = nb::none();
    if (loaded.samples) {
        fields["samples"] = fields_of(std::move(*loaded.samples));
    }
    fields["mesh"] = fields_of(std::move(loaded.mesh));
    fields["left_out"] = fields_of(std::move(loaded.left_out));
    std::vector<Ball> holes;
    if (const auto* mesh = std::get_if<MeshReport>(&loaded.input)) {
        std::ranges::transform(mesh->holes, std::back_inserter(holes), [](const Hole& hole) {
            return Ball{hole.center, hole.width};
        });
    }
    fields["holes"] = array_of(std::move(holes));
    fields["warnings"] = to_json(std::span<const Diagnostic>(loaded.warnings));
    fields["costs"] = to_json(std::span<const StageCost>(loaded.costs));
    return fields;
}

void bind_loading(nb::module_& m) {
    m.def("load_file", [](const std::filesystem::path& file, const std::optional<std::string>& kind,
                          std::optional<double> iso, bool is_below, std::vector<float> labels, bool is_nonzero,
                          std::optional<double> mask_smoothing, bool fills_voids,
                          const std::optional<std::string>& method, std::optional<double> kernel, const LengthIn& delta,
                          const std::optional<std::string>& solid, double opening, double thickness,
                          std::vector<Index> objects, int threads, Tell progress) {
        LoadOptions options = image_options(iso, is_below, std::move(labels), is_nonzero, mask_smoothing, fills_voids);
        options.kind = kind ? std::optional(value_of("kind", *kind, kFileKinds)) : std::nullopt;
        options.cloud_method = cloud_method_of(method);
        options.kernel = kernel;
        options.delta = length_of(delta);
        options.solid = solid_options(solid, opening, thickness);
        options.objects = std::move(objects);
        options.keeps_mesh = true;
        return fields_of(run({threads, std::move(progress)},
                             [&](const Execution& execution) { return load_solid(file, options, execution); }));
    });
    m.def("load_image", [](const FloatsIn& values, const PointsIn& place, const FrameIn& frame,
                           std::optional<double> iso, bool is_below, std::vector<float> labels, bool is_nonzero,
                           std::optional<double> mask_smoothing, bool fills_voids, int threads, Tell progress) {
        const LoadOptions options =
            image_options(iso, is_below, std::move(labels), is_nonzero, mask_smoothing, fills_voids);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return load_solid(image_of(values, place, frame), options, execution);
        }));
    });
    m.def("load_mesh", [](const PointsIn& vertices, const RowsIn<3>& triangles, const std::optional<std::string>& solid,
                          double opening, double thickness, int threads, Tell progress) {
        const MeshView mesh{points(vertices), index_rows<3>(triangles)};
        const SolidOptions options = solid_options(solid, opening, thickness);
        return fields_of(run({threads, std::move(progress)},
                             [&](const Execution& execution) { return load_mesh(mesh, options, execution); }));
    });
    m.def("load_points", [](const PointsIn& given, const PointsIn& normals, const std::optional<std::string>& method,
                            std::optional<double> kernel, const LengthIn& delta, int threads, Tell progress) {
        const CloudView cloud{points(given), points(normals)};
        const std::optional<CloudMethod> chosen = cloud_method_of(method);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return load_points(cloud, chosen, kernel, length_of(delta), execution);
        }));
    });
    m.def("crust", [](const PointsIn& given, const PointsIn& normals, int threads, Tell progress) {
        const CloudView cloud{points(given), points(normals)};
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return crust(prepare(cloud, {}, execution), execution);
        }));
    });
    m.def("file_kind", [](const std::filesystem::path& file) {
        return std::string(name_of(unlocked([&] { return file_kind(file); })));
    });
    m.def("repair_mesh", [](const PointsIn& vertices, const RowsIn<3>& triangles, int threads, Tell progress) {
        const MeshView mesh{points(vertices), index_rows<3>(triangles)};
        RepairedMesh repaired =
            run({threads, std::move(progress)}, [&](const Execution& execution) { return repair(mesh, execution); });
        Fields fields = fields_of(std::move(repaired.mesh));
        fields["report"] = to_json(repaired.report);
        fields["warnings"] = to_json(std::span<const Diagnostic>(repaired.report.warnings()));
        return fields;
    });
}

}  // namespace scaleaxis::python
