// SPDX-License-Identifier: Apache-2.0
// Axis → curve skeleton.
#include "scaleaxis/skeleton.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/measures.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::python {
namespace {

SkeletonOptions options_of(double spacing, double significance, const std::string& radius) {
    constexpr std::pair<std::string_view, SkeletonRadius> kRadii[]{{"inscribed", SkeletonRadius::kInscribed},
                                                                   {"mean", SkeletonRadius::kMean}};
    return {spacing, significance, value_of("radius", radius, kRadii)};
}

Fields fields_of(Skeleton skeleton, const MedialComplex& complex) {
    Fields fields;
    fields["statistics"] = to_json(statistics_of(skeleton, complex));
    fields["degrees"] = array_of(degrees(skeleton));
    fields["nodes"] = array_of(std::move(skeleton.nodes));
    fields["radii"] = array_of(std::move(skeleton.radii));
    fields["edges"] = array_of(std::move(skeleton.edges));
    fields["branch_offsets"] = array_of(std::move(skeleton.branches.offsets));
    fields["branch_nodes"] = array_of(std::move(skeleton.branches.items));
    fields["node_branches"] = array_of(std::move(skeleton.node_branches));
    fields["node_components"] = array_of(std::move(skeleton.node_components));
    fields["face_offsets"] = array_of(std::move(skeleton.faces.offsets));
    fields["face_nodes"] = array_of(std::move(skeleton.faces.items));
    fields["vertex_nodes"] = array_of(std::move(skeleton.vertex_nodes));
    return fields;
}

template <class... Source>
Fields computed(const Fields& complex, const SkeletonOptions& options, int threads, Tell progress,
                const Source&... source) {
    const MedialComplex given = complex_of(complex);
    return fields_of(run({threads, std::move(progress)},
                         [&](const Execution& execution) { return skeleton(given, source..., options, execution); }),
                     given);
}

}  // namespace

void bind_skeleton(nb::module_& m) {
    m.def("skeleton", [](const Fields& complex, double spacing, double significance, const std::string& radius,
                         int threads, Tell progress) {
        return computed(complex, options_of(spacing, significance, radius), threads, std::move(progress));
    });
    m.def("skeleton_in_union", [](const Fields& complex, const BallUnion& balls, double spacing, double significance,
                                  const std::string& radius, int threads, Tell progress) {
        return computed(complex, options_of(spacing, significance, radius), threads, std::move(progress), balls);
    });
    m.def("skeleton_in_solid", [](const Fields& complex, const Solid& solid, double spacing, double significance,
                                  const std::string& radius, int threads, Tell progress) {
        return computed(complex, options_of(spacing, significance, radius), threads, std::move(progress), solid);
    });
    m.def("led_to_openings", [](const Fields& complex, const Fields& skeleton, const BallsIn& holes, double spacing) {
        std::vector<Hole> given;
        for (const Ball& hole : balls(holes)) {
            given.push_back({hole.center, hole.radius, 0.0, 0, hole.center});
        }
        return fields_of(led_to_openings(skeleton_of(skeleton), given, spacing), complex_of(complex));
    });
    m.def("skeleton_complex", [](const Fields& skeleton) { return fields_of(complex_of(skeleton_of(skeleton))); });
    m.def("write_skeleton", [](const std::filesystem::path& file, const Fields& skeleton) {
        const Skeleton given = skeleton_of(skeleton);
        unlocked([&] { write_skeleton(file, given); });
    });
    m.def("measures", [](const Fields& complex, const Fields& skeleton, const PointsIn& vertices,
                         const RowsIn<3>& triangles, const DoublesIn& thickness, const std::string& pieces, int threads,
                         Tell progress) {
        constexpr std::pair<std::string_view, MeasuredPieces> kPieces[]{{"whole", MeasuredPieces::kWhole},
                                                                        {"components", MeasuredPieces::kComponents},
                                                                        {"parts", MeasuredPieces::kParts}};
        const MeasureOptions options{value_of("pieces", pieces, kPieces), {}};
        const MedialComplex axis = complex_of(complex);
        const Skeleton given = skeleton_of(skeleton);
        const TriangleMesh surface = mesh_of(vertices, triangles);
        const std::vector<Measures> rows = run({threads, std::move(progress)}, [&](const Execution& execution) {
            return measures(axis, given, surface, python::rows<double>(thickness), surface, options, execution);
        });
        std::vector<std::string> result;
        std::ranges::transform(rows, std::back_inserter(result), [](const Measures& row) { return to_json(row); });
        return result;
    });
    m.def("check_skeleton_output", [](const std::filesystem::path& file) { check_skeleton_output(file); });
}

}  // namespace scaleaxis::python
