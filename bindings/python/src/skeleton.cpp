// SPDX-License-Identifier: Apache-2.0
// Axis → curve skeleton.
#include "scaleaxis/skeleton.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/centerlines.hpp"
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
    fields["root"] = nb::int_(skeleton.root);
    // Columns: area, least and largest width, and whether it is closed.
    std::vector<std::array<double, 4>> sections;
    std::ranges::transform(skeleton.sections, std::back_inserter(sections), [](const Section& s) {
        return std::array{s.area, s.least_width, s.largest_width, s.is_closed ? 1.0 : 0.0};
    });
    fields["section_values"] = owning<double, 4>(std::move(sections));
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
        return to_json(std::span<const Diagnostic>(unlocked([&] { return write_skeleton(file, given); })));
    });
    m.def("path_between", [](const Fields& skeleton, const std::array<double, 3>& from,
                             const std::array<double, 3>& to) {
        const Skeleton path = path_between(skeleton_of(skeleton), {from[0], from[1], from[2]}, {to[0], to[1], to[2]});
        return fields_of(path, complex_of(path));
    });
    m.def("nearest_node", [](const Fields& skeleton, const std::array<double, 3>& place) {
        return nearest_node(skeleton_of(skeleton), {place[0], place[1], place[2]});
    });
    m.def("resampled", [](const Fields& skeleton, double step) {
        const Skeleton even = resampled(skeleton_of(skeleton), step);
        return fields_of(even, complex_of(even));
    });
    m.def("with_sections", [](const Fields& skeleton, const Solid& solid, int threads, Tell progress) {
        Skeleton given = skeleton_of(skeleton);
        run({threads, std::move(progress)}, [&](const Execution& execution) {
            add_sections(given, solid, execution);
            return 0;
        });
        return fields_of(given, complex_of(given));
    });
    m.def("branch_geometry", [](const Fields& skeleton, Index branch) {
        BranchGeometry geometry = branch_geometry(skeleton_of(skeleton), branch);
        Fields fields;
        fields["abscissas"] = array_of(std::move(geometry.abscissas));
        fields["curvature"] = array_of(std::move(geometry.curvature));
        fields["torsion"] = array_of(std::move(geometry.torsion));
        fields["tangents"] = array_of(std::move(geometry.tangents));
        fields["normals"] = array_of(std::move(geometry.normals));
        fields["binormals"] = array_of(std::move(geometry.binormals));
        fields["parallel_normals"] = array_of(std::move(geometry.transported));
        fields["length"] = nb::float_(geometry.length);
        fields["tortuosity"] = nb::float_(geometry.tortuosity);
        return fields;
    });
    m.def("skeleton_tree", [](const Fields& skeleton) {
        const Skeleton given = skeleton_of(skeleton);
        SkeletonTree tree = tree_of(given);
        return nb::make_tuple(array_of(std::move(tree.nodes)), array_of(std::move(tree.parents)),
                              to_json(std::span<const Diagnostic>(tree_warnings(given))));
    });
    m.def("cylinders", [](const Fields& skeleton) {
        std::vector<std::array<double, 8>> numbers;
        std::vector<std::array<Index, 4>> places;
        for (const Cylinder& c : cylinders(skeleton_of(skeleton))) {
            numbers.push_back({c.start.x, c.start.y, c.start.z, c.axis.x, c.axis.y, c.axis.z, c.length, c.radius});
            places.push_back({c.parent, c.branch, c.order, c.position});
        }
        return nb::make_tuple(owning<double, 8>(std::move(numbers)), array_of(std::move(places)));
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
