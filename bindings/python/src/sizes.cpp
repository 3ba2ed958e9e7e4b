// SPDX-License-Identifier: Apache-2.0
// Sizes of elements.
#include "scaleaxis/sizes.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::python {

void bind_sizes(nb::module_& m) {
    nb::class_<SizeField>(m, "SizeField")
        .def("at",
             [](const SizeField& field, double x, double y, double z) {
                 return field({x, y, z});
             })
        .def("sizes",
             [](const SizeField& field, const PointsIn& given, int threads) {
                 return array_of(run({threads, std::nullopt},
                                     [&](const Execution& execution) { return field(points(given), execution); }));
             })
        .def("surface",
             [](const SizeField& field) {
                 Fields fields = fields_of(TriangleMesh(field.surface()));
                 fields["sizes"] = array_of(std::vector<double>(field.surface_sizes()));
                 return fields;
             })
        .def("background",
             [](const SizeField& field, int threads, Tell progress) {
                 SizeMesh mesh = run({threads, std::move(progress)},
                                     [&](const Execution& execution) { return field.background(execution); });
                 Fields fields;
                 fields["vertices"] = array_of(std::move(mesh.vertices));
                 fields["sizes"] = array_of(std::move(mesh.sizes));
                 fields["tetrahedra"] = array_of(std::move(mesh.tetrahedra));
                 return fields;
             })
        .def("write", [](const SizeField& field, const std::filesystem::path& file,
                         const std::optional<std::filesystem::path>& mesh) {
            unlocked([&] {
                if (mesh) {
                    write_sizes_at(file, field, *mesh);
                } else {
                    write_sizes(file, field);
                }
            });
        });
    m.def("size_field", [](const Solid& solid, const PointsIn& vertices, const RowsIn<3>& triangles, bool is_thickness,
                           double elements_across, std::optional<double> min_size, std::optional<double> max_size,
                           double gradation, double angle, int threads, Tell progress) {
        const SizeOptions options{is_thickness ? SizeMeasure::kThickness : SizeMeasure::kFeatureSize,
                                  elements_across,
                                  min_size,
                                  max_size,
                                  gradation,
                                  angle};
        TriangleMesh surface = mesh_of(vertices, triangles);
        return run({threads, std::move(progress)}, [&](const Execution& execution) {
            return SizeField(solid, std::move(surface), options, execution);
        });
    });
}

}  // namespace scaleaxis::python
