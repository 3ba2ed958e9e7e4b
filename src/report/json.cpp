// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.hpp"

namespace scaleaxis::app {

namespace {

Json coordinates(const Point& p) { return {p.x, p.y, p.z}; }

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json dual_complex_to_json(const MedialAxisStatistics& medial) {
    return {{"tetrahedra", medial.dual_tetrahedra},
            {"triangles", medial.dual_triangles},
            {"edges", medial.dual_edges},
            {"vertices", medial.dual_vertices},
            {"topology", to_json(medial.dual_complex)}};
}

Json medial_complex_to_json(const MedialAxisStatistics& medial) {
    return {{"boundary_vertices", medial.boundary_vertices},
            {"cells", medial.cells},
            {"inside_cells", medial.inside_cells},
            {"flat_cells", medial.flat_cells},
            {"vertices", medial.vertices},
            {"edges", medial.edges},
            {"faces", medial.faces},
            {"perturbation", medial.perturbation},
            {"retries", medial.retries},
            {"topology", to_json(medial.medial_complex)}};
}

Json filter_to_json(const FilterStatistics& filter) {
    return {{"sheets_before", filter.sheets_before},
            {"sheets_after", filter.sheets_after},
            {"faces_removed", filter.faces_removed},
            {"topology", to_json(filter.topology)}};
}

}  // namespace

Json to_json(const Box& box) {
    if (box.is_empty()) {
        return nullptr;
    }
    return {{"min", coordinates(box.min)}, {"max", coordinates(box.max)}, {"diagonal", box.diagonal()}};
}

Json to_json(const Topology& topology) {
    return {{"components", topology.components},
            {"euler", topology.euler},
            {"tunnels", or_null(topology.tunnels)},
            {"voids", or_null(topology.voids)}};
}

Json to_json(const MeshReport& mesh) {
    return {{"vertices", mesh.vertices},
            {"triangles", mesh.triangles},
            {"bounds", to_json(mesh.bounds)},
            {"repaired",
             {{"isolated_vertices", mesh.isolated_vertices},
              {"duplicate_vertices", mesh.duplicate_vertices},
              {"degenerate_triangles", mesh.degenerate_triangles},
              {"duplicate_triangles", mesh.duplicate_triangles},
              {"split_vertices", mesh.split_vertices},
              {"reversed_triangles", mesh.reversed_triangles},
              {"reversed_components", mesh.reversed_components}}},
            {"boundary_edges", mesh.boundary_edges},
            {"non_manifold_edges", mesh.non_manifold_edges},
            {"self_intersections", mesh.self_intersections},
            {"components", mesh.components},
            {"genus", mesh.genus},
            {"euler", mesh.euler},
            {"area", mesh.area},
            {"volume", mesh.volume},
            {"fault", mesh.fault.empty() ? Json(nullptr) : Json(mesh.fault)}};
}

Json to_json(const CloudReport& cloud) {
    return {{"points", cloud.points},
            {"duplicates", cloud.duplicates},
            {"outliers", cloud.outliers},
            {"bounds", to_json(cloud.bounds)},
            {"has_normals", cloud.has_normals},
            {"unknown_normals", cloud.unknown_normals},
            {"are_normals_flipped", cloud.are_normals_flipped},
            {"oriented_parts", cloud.parts},
            {"border_points", cloud.border_points},
            {"spacing", cloud.spacing},
            {"noise", cloud.noise},
            {"kernel", cloud.kernel},
            {"fault", cloud.fault.empty() ? Json(nullptr) : Json(cloud.fault)}};
}

Json to_json(const SamplingStatistics& sampling) {
    return {{"seeds", sampling.seeds},
            {"rounds", sampling.rounds},
            {"feature_samples", sampling.feature_samples},
            {"deviation_samples", sampling.deviation_samples},
            {"is_growth_limited", sampling.is_growth_limited},
            {"manifold_samples", sampling.manifold_samples},
            {"conflicts", sampling.conflicts},
            {"relabelled", sampling.relabelled},
            {"restricted_facets", sampling.restricted_facets},
            {"irregular_samples", sampling.irregular_samples},
            {"inside_queries", sampling.inside_queries},
            {"crossing_queries", sampling.crossing_queries}};
}

Json to_json(const std::vector<StageCost>& costs) {
    Json list = Json::array();
    for (const StageCost& cost : costs) {
        list.push_back({{"stage", cost.stage}, {"seconds", cost.seconds}, {"peak_memory", cost.peak_memory}});
    }
    return list;
}

Json to_json(const AxisReport& axis) {
    const Agreement agrees = agreement(axis);
    return {
        {"scale", axis.scale},
        {"file", axis.file.string()},
        {"balls", axis.medial.balls},
        {"hidden_balls", axis.medial.hidden_balls},
        {"dual_complex", dual_complex_to_json(axis.medial)},
        {"medial_complex", medial_complex_to_json(axis.medial)},
        {"filter", axis.filter ? filter_to_json(*axis.filter) : Json(nullptr)},
        {"result", {{"balls", axis.vertices}, {"edges", axis.edges}, {"faces", axis.faces}, {"sheets", axis.sheets}}},
        {"agreement",
         {{"solid_and_dual", or_null(agrees.solid_and_dual)},
          {"dual_and_medial", agrees.dual_and_medial},
          {"medial_and_filtered", or_null(agrees.medial_and_filtered)}}},
        {"costs", to_json(axis.costs)}};
}

}  // namespace scaleaxis::app
