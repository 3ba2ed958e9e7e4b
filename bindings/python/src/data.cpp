// SPDX-License-Identifier: Apache-2.0
#include "data.hpp"

#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>

#include "scaleaxis/report.hpp"

namespace scaleaxis::python {
namespace {

template <class Array>
Array field(const Fields& fields, const char* name) {
    return nb::cast<Array>(fields[name]);
}

template <int K>
std::vector<std::array<Index, K>> index_rows_of(const Fields& fields, const char* name) {
    return copy(index_rows<K>(field<RowsIn<K>>(fields, name)));
}
std::vector<Point> points_of(const Fields& fields, const char* name) {
    return copy(points(field<PointsIn>(fields, name)));
}
std::vector<double> doubles_of(const Fields& fields, const char* name) {
    return vector_of(field<DoublesIn>(fields, name));
}
std::vector<Index> indices_of(const Fields& fields, const char* name) {
    return vector_of(field<IndicesIn>(fields, name));
}

constexpr std::pair<const char*, Index SamplingStatistics::*> kSamplingCounts[]{
    {"seeds", &SamplingStatistics::seeds},
    {"rounds", &SamplingStatistics::rounds},
    {"thickness_facets", &SamplingStatistics::thickness_facets},
    {"gap_facets", &SamplingStatistics::gap_facets},
    {"dip_facets", &SamplingStatistics::dip_facets},
    {"bent_facets", &SamplingStatistics::bent_facets},
    {"far_samples", &SamplingStatistics::far_samples},
    {"deviation_samples", &SamplingStatistics::deviation_samples},
    {"manifold_samples", &SamplingStatistics::manifold_samples},
    {"conflicts", &SamplingStatistics::conflicts},
    {"relabelled", &SamplingStatistics::relabelled},
    {"restricted_facets", &SamplingStatistics::restricted_facets},
    {"irregular_samples", &SamplingStatistics::irregular_samples}};

SamplingStatistics statistics_of(const Fields& fields) {
    SamplingStatistics statistics;
    for (const auto& [name, member] : kSamplingCounts) {
        statistics.*member = field<Index>(fields, name);
    }
    statistics.is_growth_limited = field<bool>(fields, "is_growth_limited");
    statistics.facet_sizes = field<std::vector<Index>>(fields, "facet_sizes");
    statistics.inside_queries = field<std::int64_t>(fields, "inside_queries");
    statistics.crossing_queries = field<std::int64_t>(fields, "crossing_queries");
    return statistics;
}

/// The stages rely on what `sample` guarantees.
void check_samples(const Samples& samples) {
    const std::size_t count = samples.tetrahedra.size();
    const auto are_in_range = [](const auto& rows, Index least, std::size_t end) {
        return std::ranges::all_of(rows, [&](const std::array<Index, 4>& row) {
            return std::ranges::all_of(row,
                                       [&](Index i) { return i >= least && i < static_cast<std::ptrdiff_t>(end); });
        });
    };
    if (samples.neighbors.size() != count || samples.centers.size() != count || samples.radii.size() != count ||
        samples.inside.size() != count) {
        throw UnusableInput(
            "the samples are not valid: their tetrahedra, neighbors, centers, radii and inside differ in length");
    }
    if (!are_in_range(samples.tetrahedra, 0, samples.points.size()) || !are_in_range(samples.neighbors, kNone, count)) {
        throw UnusableInput("the samples are not valid: an index of tetrahedra or neighbors is out of range");
    }
}

}  // namespace

TopologyTuple tuple_of(const Topology& topology) {
    return {topology.components, topology.euler, topology.tunnels, topology.voids};
}

std::optional<TopologyTuple> tuple_of(const std::optional<Topology>& topology) {
    return topology ? std::optional(tuple_of(*topology)) : std::nullopt;
}

std::optional<Topology> topology_of(const std::optional<TopologyTuple>& tuple) {
    if (!tuple) {
        return std::nullopt;
    }
    const auto& [components, euler, tunnels, voids] = *tuple;
    return Topology{components, euler, tunnels, voids};
}

std::optional<Length> length_of(const LengthIn& given) {
    if (!given) {
        return std::nullopt;
    }
    return given->second ? Length::absolute(given->first) : Length::relative(given->first);
}

Fields fields_of(MedialComplex complex) {
    Fields fields;
    fields["vertices"] = array_of(std::move(complex.vertices));
    fields["radii"] = array_of(std::move(complex.radii));
    std::vector<Index> numbers(complex.vertex_origins.size());
    std::ranges::transform(complex.vertex_origins, numbers.begin(), stored_number);
    fields["vertex_balls"] = array_of(std::move(numbers));
    fields["edges"] = array_of(std::move(complex.edges));
    fields["face_offsets"] = array_of(std::move(complex.faces.offsets));
    fields["face_vertices"] = array_of(std::move(complex.faces.items));
    fields["face_edges"] = array_of(std::move(complex.face_edges.items));
    fields["face_angles"] = array_of(std::move(complex.face_angles));
    fields["face_sheets"] = array_of(std::move(complex.face_sheets));
    fields["face_contacts"] = array_of(std::move(complex.face_contacts));
    fields["boundary_vertices"] = array_of(std::move(complex.boundary_vertices));
    fields["boundary_vertex_balls"] = array_of(std::move(complex.boundary_vertex_balls));
    fields["sheets"] = complex.sheets;
    fields["scale"] = complex.scale;
    return fields;
}

MedialComplex complex_of(const Fields& fields) {
    MedialComplex complex;
    complex.vertices = points_of(fields, "vertices");
    complex.radii = doubles_of(fields, "radii");
    const std::vector<Index> numbers = indices_of(fields, "vertex_balls");
    complex.vertex_origins.resize(numbers.size());
    std::ranges::transform(numbers, complex.radii, complex.vertex_origins.begin(), origin_of);
    complex.edges = index_rows_of<2>(fields, "edges");
    complex.faces = lists_of(field<IndicesIn>(fields, "face_offsets"), field<IndicesIn>(fields, "face_vertices"));
    complex.face_edges = lists_of(field<IndicesIn>(fields, "face_offsets"), field<IndicesIn>(fields, "face_edges"));
    complex.face_angles = doubles_of(fields, "face_angles");
    complex.face_sheets = indices_of(fields, "face_sheets");
    complex.face_contacts = index_rows_of<2>(fields, "face_contacts");
    complex.boundary_vertices = points_of(fields, "boundary_vertices");
    complex.boundary_vertex_balls = index_rows_of<3>(fields, "boundary_vertex_balls");
    complex.sheets = field<Index>(fields, "sheets");
    complex.scale = field<double>(fields, "scale");
    return complex;
}

Fields fields_of(ShellMesh shells) {
    Fields fields;
    add_sheets(fields, shells.sheets);
    fields["vertices"] = array_of(std::move(shells.mesh.vertices));
    fields["triangles"] = array_of(std::move(shells.mesh.triangles));
    fields["thickness"] = array_of(std::move(shells.thickness));
    fields["triangle_sheets"] = array_of(std::move(shells.triangle_sheets));
    fields["middles"] = array_of(std::move(shells.middles));
    fields["triangle_middles"] = array_of(std::move(shells.triangle_middles));
    fields["seam_length"] = shells.seam_length;
    fields["border_length"] = shells.border_length;
    fields["least_angle"] = shells.least_angle;
    fields["mean_edge"] = shells.mean_edge;
    return fields;
}

ShellMesh shells_of(const Fields& fields) {
    ShellMesh shells;
    shells.mesh = {points_of(fields, "vertices"), index_rows_of<3>(fields, "triangles")};
    for (const Point& corners : points_of(fields, "thickness")) {
        shells.thickness.push_back({corners.x, corners.y, corners.z});
    }
    shells.triangle_sheets = indices_of(fields, "triangle_sheets");
    shells.middles = points_of(fields, "middles");
    shells.triangle_middles = index_rows_of<3>(fields, "triangle_middles");
    const std::vector<double> areas = doubles_of(fields, "areas");
    const std::vector<double> means = doubles_of(fields, "means");
    const std::vector<double> minima = doubles_of(fields, "minima");
    const std::vector<double> maxima = doubles_of(fields, "maxima");
    for (std::size_t s = 0; s < areas.size(); ++s) {
        shells.sheets.push_back({areas[s], means[s], minima[s], maxima[s]});
    }
    return shells;
}

void add_sheets(Fields& fields, const std::vector<MidsurfaceSheet>& sheets) {
    std::vector<double> areas;
    std::vector<double> means;
    std::vector<double> minima;
    std::vector<double> maxima;
    for (const MidsurfaceSheet& sheet : sheets) {
        areas.push_back(sheet.area);
        means.push_back(sheet.mean);
        minima.push_back(sheet.min);
        maxima.push_back(sheet.max);
    }
    fields["areas"] = array_of(std::move(areas));
    fields["means"] = array_of(std::move(means));
    fields["minima"] = array_of(std::move(minima));
    fields["maxima"] = array_of(std::move(maxima));
}

Skeleton skeleton_of(const Fields& fields) {
    Skeleton skeleton;
    skeleton.nodes = points_of(fields, "nodes");
    skeleton.radii = doubles_of(fields, "radii");
    skeleton.edges = index_rows_of<2>(fields, "edges");
    skeleton.branches = lists_of(field<IndicesIn>(fields, "branch_offsets"), field<IndicesIn>(fields, "branch_nodes"));
    skeleton.node_branches = indices_of(fields, "node_branches");
    skeleton.node_components = indices_of(fields, "node_components");
    skeleton.faces = lists_of(field<IndicesIn>(fields, "face_offsets"), field<IndicesIn>(fields, "face_nodes"));
    skeleton.vertex_nodes = indices_of(fields, "vertex_nodes");
    skeleton.root = field<Index>(fields, "root");
    if (skeleton.root < kNone || skeleton.root >= static_cast<Index>(skeleton.nodes.size())) {
        throw InvalidOption("the root of a skeleton must be one of its nodes, or -1");
    }
    const auto sections = field<BallsIn>(fields, "section_values");
    for (const auto& [area, least, largest, closed] : rows<std::array<double, 4>>(sections)) {
        skeleton.sections.push_back({area, least, largest, closed != 0.0});
    }
    return skeleton;
}

Filtration filtration_of(const Fields& complex, const ScalesIn& scales) {
    const auto& [balls, vertices, edges, faces, largest] = scales;
    return {complex_of(complex), vector_of(balls), vector_of(vertices), vector_of(edges), vector_of(faces), largest};
}

std::vector<HalfSpace> half_spaces_of(const std::vector<std::pair<PointTuple, double>>& planes) {
    std::vector<HalfSpace> spaces;
    for (const auto& [normal, offset] : planes) {
        const auto& [x, y, z] = normal;
        spaces.push_back({{x, y, z}, offset});
    }
    return spaces;
}

Sizing sizing_of(std::string_view name) {
    constexpr std::pair<std::string_view, Sizing> kSizings[]{{"adaptive", Sizing::kAdaptive},
                                                             {"uniform", Sizing::kUniform}};
    return value_of("sampling", name, kSizings);
}

Fields fields_of(Samples samples) {
    Fields fields;
    fields["points"] = array_of(std::move(samples.points));
    fields["tetrahedra"] = array_of(std::move(samples.tetrahedra));
    fields["neighbors"] = array_of(std::move(samples.neighbors));
    fields["centers"] = array_of(std::move(samples.centers));
    fields["radii"] = array_of(std::move(samples.radii));
    fields["inside"] = array_of(std::move(samples.inside));
    fields["tolerance"] = samples.tolerance;
    fields["statistics"] = to_json(samples.statistics);
    return fields;
}

Samples samples_of(const Fields& fields) {
    Samples samples;
    samples.points = points_of(fields, "points");
    samples.tetrahedra = index_rows_of<4>(fields, "tetrahedra");
    samples.neighbors = index_rows_of<4>(fields, "neighbors");
    samples.centers = points_of(fields, "centers");
    samples.radii = doubles_of(fields, "radii");
    samples.inside = copy(rows<std::uint8_t>(field<BytesIn>(fields, "inside")));
    samples.tolerance = field<double>(fields, "tolerance");
    samples.statistics = statistics_of(field<Fields>(fields, "statistics"));
    check_samples(samples);
    return samples;
}

Fields fields_of(TriangleMesh mesh) {
    Fields fields;
    fields["vertices"] = array_of(std::move(mesh.vertices));
    fields["triangles"] = array_of(std::move(mesh.triangles));
    return fields;
}

Fields fields_of(Image image) {
    Fields fields;
    fields["sizes"] = nb::make_tuple(image.sizes[0], image.sizes[1], image.sizes[2]);
    fields["place"] = array_of(std::vector<Point>{image.origin, image.steps[0], image.steps[1], image.steps[2]});
    fields["values"] = array_of(std::move(image.values));
    fields["unit"] = image.unit;
    fields["space"] = image.space;
    return fields;
}

TriangleMesh mesh_of(const PointsIn& vertices, const RowsIn<3>& triangles) {
    return {copy(points(vertices)), copy(index_rows<3>(triangles))};
}

Out<double, 3> array_of(const Box& box) { return array_of(std::vector<Point>{box.min, box.max}); }

std::pair<Out<Index>, Out<Index>> arrays_of(IndexLists lists) {
    return {array_of(std::move(lists.offsets)), array_of(std::move(lists.items))};
}

IndexLists lists_of(const IndicesIn& offsets, const IndicesIn& indices) {
    return {copy(rows<Index>(offsets)), copy(rows<Index>(indices))};
}

}  // namespace scaleaxis::python
