// SPDX-License-Identifier: Apache-2.0
// Axis → curve skeleton.
#include "scaleaxis/skeleton.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::python {
namespace {

SkeletonOptions options_of(double spacing, double significance, double scale, const std::string& radius) {
    constexpr std::pair<std::string_view, SkeletonRadius> kRadii[]{{"inscribed", SkeletonRadius::kInscribed},
                                                                   {"mean", SkeletonRadius::kMean}};
    return {spacing, significance, scale, value_of("radius", radius, kRadii)};
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
    m.def("skeleton", [](const Fields& complex, double spacing, double significance, double scale,
                         const std::string& radius, int threads, Tell progress) {
        return computed(complex, options_of(spacing, significance, scale, radius), threads, std::move(progress));
    });
    m.def("skeleton_in_union", [](const Fields& complex, const BallUnion& balls, double spacing, double significance,
                                  double scale, const std::string& radius, int threads, Tell progress) {
        return computed(complex, options_of(spacing, significance, scale, radius), threads, std::move(progress), balls);
    });
    m.def("skeleton_in_solid", [](const Fields& complex, const Solid& solid, double spacing, double significance,
                                  double scale, const std::string& radius, int threads, Tell progress) {
        return computed(complex, options_of(spacing, significance, scale, radius), threads, std::move(progress), solid);
    });
    m.def("write_skeleton",
          [](const std::filesystem::path& file, const PointsIn& nodes, const DoublesIn& radii, const RowsIn<2>& edges,
             const IndicesIn& branch_offsets, const IndicesIn& branch_nodes, const IndicesIn& node_branches,
             const IndicesIn& node_components, const IndicesIn& face_offsets, const IndicesIn& face_nodes) {
              const auto numbers = [](const IndicesIn& given) {
                  return std::vector<Index>(given.data(), given.data() + given.size());
              };
              Skeleton skeleton;
              skeleton.nodes = copy(points(nodes));
              skeleton.radii = {radii.data(), radii.data() + radii.size()};
              skeleton.edges = copy(index_rows<2>(edges));
              skeleton.branches = {numbers(branch_offsets), numbers(branch_nodes)};
              skeleton.node_branches = numbers(node_branches);
              skeleton.node_components = numbers(node_components);
              skeleton.faces = {numbers(face_offsets), numbers(face_nodes)};
              unlocked([&] { write_skeleton(file, skeleton); });
          });
    m.def("check_skeleton_output", [](const std::filesystem::path& file) { check_skeleton_output(file); });
}

}  // namespace scaleaxis::python
