// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>

#include "base/files.hpp"
#include "base/formats/json.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::inline v1 {

namespace {

Json json_of(const Topology& topology);

Json coordinates(const Point& p) { return {p.x, p.y, p.z}; }

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json dual_complex_of(const MedialAxisStatistics& medial) {
    return {{"tetrahedra", medial.dual_tetrahedra},
            {"triangles", medial.dual_triangles},
            {"edges", medial.dual_edges},
            {"vertices", medial.dual_vertices},
            {"topology", json_of(medial.dual_complex)}};
}

Json medial_complex_of(const MedialAxisStatistics& medial) {
    return {{"boundary_vertices", medial.boundary_vertices},
            {"cells", medial.cells},
            {"inside_cells", medial.inside_cells},
            {"flat_cells", medial.flat_cells},
            {"vertices", medial.vertices},
            {"edges", medial.edges},
            {"faces", medial.faces},
            {"perturbation", medial.perturbation},
            {"retries", medial.retries},
            {"topology", json_of(medial.medial_complex)}};
}

Json filter_of(const FilterStatistics& filter) {
    return {{"sheets_before", filter.sheets_before},
            {"sheets_after", filter.sheets_after},
            {"faces_removed", filter.faces_removed},
            {"topology", json_of(filter.topology)}};
}

Json sharp_of(const SharpEdgeStatistics& sharp) {
    return {{"angle", sharp.angle},
            {"points", sharp.points},
            {"corners", sharp.corners},
            {"length", sharp.length},
            {"known", sharp.known},
            {"sheets", sharp.sheets},
            {"topology", json_of(sharp.topology)}};
}

Json center_of(const CenterStatistics& center) {
    return {{"fitted", center.fitted},           {"moved", center.moved},   {"largest_move", center.largest_move},
            {"mean_growth", center.mean_growth}, {"halved", center.halved}, {"questions", center.questions}};
}

Json clean_of(const CleanStatistics& clean) {
    return {{"thickness", clean.thickness},
            {"sheets_before", clean.sheets_before},
            {"sheets_after", clean.sheets_after},
            {"curves", clean.curves},
            {"vertices_removed", clean.vertices_removed},
            {"area_removed", clean.area_removed},
            {"largest_retreat", clean.largest_retreat},
            {"largest_loss", clean.largest_loss},
            {"mean_loss", clean.mean_loss},
            {"topology", json_of(clean.topology)}};
}

Json accuracy_of(const EnvelopeAccuracy& accuracy) {
    return {{"solid_to_envelope", accuracy.solid_to_envelope},
            {"mean_solid_to_envelope", accuracy.mean_solid_to_envelope},
            {"envelope_to_solid", or_null(accuracy.envelope_to_solid)},
            {"mean_envelope_to_solid", or_null(accuracy.mean_envelope_to_solid)}};
}

Json simplify_of(const SimplifyStatistics& simplify) {
    return {{"error", simplify.error},
            {"vertices_before", simplify.vertices_before},
            {"vertices_after", simplify.vertices_after},
            {"triangles", simplify.triangles},
            {"curve_edges", simplify.curve_edges},
            {"largest_gap", simplify.largest_gap},
            {"largest_protrusion", simplify.largest_protrusion},
            {"topology", json_of(simplify.topology)}};
}

Json skeleton_of(const SkeletonStatistics& skeleton) {
    return {{"nodes", skeleton.nodes},
            {"branches", skeleton.branches},
            {"ends", skeleton.ends},
            {"junctions", skeleton.junctions},
            {"faces", skeleton.faces},
            {"length", skeleton.length},
            {"least_radius", skeleton.least_radius},
            {"mean_radius", skeleton.mean_radius},
            {"largest_radius", skeleton.largest_radius},
            {"complex_topology", json_of(skeleton.complex_topology)},
            {"topology", json_of(skeleton.topology)},
            {"is_homotopic", agree(skeleton.complex_topology, skeleton.topology)}};
}

Json json_of(const Diagnostic& diagnostic) {
    if (diagnostic.empty()) {
        return nullptr;
    }
    Json hints = Json::array();
    for (const auto& [option, value] : diagnostic.hints) {
        hints.push_back({{"option", option}, {"value", value.empty() ? Json(nullptr) : Json(value)}});
    }
    return {{"code", diagnostic.code},
            {"message", diagnostic.message},
            {"element", diagnostic.element.empty() ? Json(nullptr) : Json(diagnostic.element)},
            {"index", diagnostic.index < 0 ? Json(nullptr) : Json(diagnostic.index)},
            {"place", diagnostic.place ? coordinates(*diagnostic.place) : Json(nullptr)},
            {"hints", hints}};
}

Json json_of(std::span<const Diagnostic> diagnostics) {
    return each_of<Json>(diagnostics, [&](const Diagnostic& diagnostic) { return json_of(diagnostic); });
}

Json json_of(const Box& box) {
    if (box.is_empty()) {
        return nullptr;
    }
    return {{"min", coordinates(box.min)}, {"max", coordinates(box.max)}, {"diagonal", box.diagonal()}};
}

Json json_of(const Topology& topology) {
    return {{"components", topology.components},
            {"euler", topology.euler},
            {"tunnels", or_null(topology.tunnels)},
            {"voids", or_null(topology.voids)}};
}

// Holes of a mesh or a cloud that are listed, the widest first.
constexpr std::size_t kMostHoles = 100;

Json json_of(const MeshReport& mesh) {
    Json holes = Json::array();
    for (std::size_t i = 0; i < std::min(kMostHoles, mesh.holes.size()); ++i) {
        const Hole& hole = mesh.holes[i];
        holes.push_back({{"place", coordinates(hole.place)},
                         {"center", coordinates(hole.center)},
                         {"width", hole.width},
                         {"area", hole.area},
                         {"edges", hole.edges}});
    }
    const bool is_solid = mesh.kind != SolidKind::kAuto;
    return {{"vertices", mesh.vertices},
            {"triangles", mesh.triangles},
            {"bounds", json_of(mesh.bounds)},
            {"unit", mesh.unit.empty() ? Json(nullptr) : Json(mesh.unit)},
            {"repaired",
             {{"isolated_vertices", mesh.isolated_vertices},
              {"duplicate_vertices", mesh.duplicate_vertices},
              {"degenerate_triangles", mesh.degenerate_triangles},
              {"duplicate_triangles", mesh.duplicate_triangles},
              {"split_vertices", mesh.split_vertices},
              {"reversed_triangles", mesh.reversed_triangles},
              {"reversed_components", mesh.reversed_components},
              {"weld_tolerance", mesh.weld_tolerance},
              {"wall_triangles", mesh.wall_triangles},
              {"sheet_triangles", mesh.sheet_triangles},
              {"holes", mesh.holes.size()},
              {"hole_area", mesh.hole_area()}}},
            {"holes", std::move(holes)},
            {"method", is_solid ? Json{{"name", name_of(mesh.kind)}, {"reason", mesh.reason}} : Json(nullptr)},
            {"boundary_edges", mesh.boundary_edges},
            {"non_manifold_edges", mesh.non_manifold_edges},
            {"self_intersections", mesh.self_intersections},
            {"components", mesh.components},
            {"genus", mesh.genus},
            {"euler", mesh.euler},
            {"area", mesh.area},
            {"volume", mesh.volume},
            {"fault", json_of(mesh.fault)}};
}

Json json_of(const CloudReport& cloud) {
    Json holes = Json::array();
    for (std::size_t i = 0; i < std::min(kMostHoles, cloud.holes.size()); ++i) {
        const CloudHole& hole = cloud.holes[i];
        holes.push_back({{"place", coordinates(hole.place)}, {"width", hole.width}, {"points", hole.points}});
    }
    return {{"points", cloud.points},
            {"not_finite", cloud.not_finite},
            {"duplicates", cloud.duplicates},
            {"thinned", cloud.thinned},
            {"outliers", cloud.outliers},
            {"bounds", json_of(cloud.bounds)},
            {"has_normals", cloud.has_normals},
            {"unknown_normals", cloud.unknown_normals},
            {"flipped_normals", cloud.flipped_normals},
            {"oriented_parts", cloud.parts},
            {"border_points", cloud.border_points},
            {"holes", std::move(holes)},
            {"spacing", cloud.spacing},
            {"noise", cloud.noise},
            {"kernel", cloud.kernel},
            {"fault", json_of(cloud.fault)}};
}

Json json_of(const PointsReport& points) {
    Json json = json_of(points.cloud);
    if (points.method) {
        json["method"] = {{"name", *points.method == CloudMethod::kCrust ? "crust" : "mls"}, {"reason", points.reason}};
    }
    return json;
}

Json json_of(const ImageReport& image) {
    const Json directions =
        each_of<Json>(image.directions, [&](const Point& direction) { return coordinates(direction); });
    constexpr std::size_t kMostLabels = 256;
    Json labels = Json::array();
    if (image.labels.size() <= kMostLabels) {
        for (const LabelCount& count : image.labels) {
            labels.push_back({{"label", count.label},
                              {"name", count.name.empty() ? Json(nullptr) : Json(count.name)},
                              {"voxels", count.voxels}});
        }
    }
    return {{"sizes", image.sizes},
            {"spacing", image.spacing},
            {"origin", coordinates(image.origin)},
            {"directions", directions},
            {"unit", image.unit.empty() ? Json(nullptr) : Json(image.unit)},
            {"space", image.space.empty() ? Json(nullptr) : Json(image.space)},
            {"values", {{"min", image.min}, {"max", image.max}}},
            {"labels", labels}};
}

/// \param count 0: there is no radius
Json range_of_radii(std::int64_t count, double least, double most) {
    return count == 0 ? Json(nullptr) : Json{{"min", least}, {"max", most}};
}

Json json_of(const UnionReport& balls) {
    return {{"balls", balls.balls},
            {"distinct", balls.distinct},
            {"bounds", json_of(balls.bounds)},
            {"radius", range_of_radii(balls.distinct, balls.min_radius, balls.max_radius)}};
}

Json json_of(const ComplexReport& complex) {
    return {{"vertices", complex.vertices},
            {"edges", complex.edges},
            {"faces", complex.faces},
            {"sheets", complex.sheets},
            {"topology", json_of(complex.topology)},
            {"bounds", json_of(complex.bounds)},
            {"radius", range_of_radii(complex.vertices, complex.min_radius, complex.max_radius)}};
}

Json json_of(const FunctionReport& function) {
    return {{"expression", function.expression}, {"bounds", json_of(function.bounds)}};
}

Json json_of(const SamplingStatistics& sampling) {
    return {{"seeds", sampling.seeds},
            {"rounds", sampling.rounds},
            {"thickness_facets", sampling.thickness_facets},
            {"gap_facets", sampling.gap_facets},
            {"dip_facets", sampling.dip_facets},
            {"bent_facets", sampling.bent_facets},
            {"far_samples", sampling.far_samples},
            {"deviation_samples", sampling.deviation_samples},
            {"is_growth_limited", sampling.is_growth_limited},
            {"manifold_samples", sampling.manifold_samples},
            {"conflicts", sampling.conflicts},
            {"relabelled", sampling.relabelled},
            {"restricted_facets", sampling.restricted_facets},
            {"irregular_samples", sampling.irregular_samples},
            {"facet_sizes", sampling.facet_sizes},
            {"inside_queries", sampling.inside_queries},
            {"crossing_queries", sampling.crossing_queries}};
}

Json json_of(const Ball& ball) { return {{"center", coordinates(ball.center)}, {"radius", ball.radius}}; }

Json json_of(const RepairStep& step) {
    return {{"name", step.name},
            {"rounds", step.rounds},
            {"gaps", step.gaps},
            {"missed", step.missed},
            {"far_samples", step.far_samples},
            {"added", step.added},
            {"topology", step.topology ? json_of(*step.topology) : Json(nullptr)}};
}

Json json_of(const DeltaAttempt& attempt) {
    return {{"delta", attempt.delta},
            {"tolerance", attempt.tolerance},
            {"samples", attempt.samples},
            {"balls", attempt.balls},
            {"solid", attempt.solid ? json_of(*attempt.solid) : Json(nullptr)},
            {"union", attempt.balls_topology ? json_of(*attempt.balls_topology) : Json(nullptr)},
            {"largest_distance", attempt.balls_topology ? Json(attempt.largest_distance) : Json(nullptr)},
            {"fault", json_of(attempt.fault)},
            {"seconds", attempt.seconds}};
}

Json json_of(const DeltaChoice& choice) {
    const Json attempts = each_of<Json>(choice.attempts, [&](const DeltaAttempt& attempt) { return json_of(attempt); });
    return {{"coarsest", choice.range.coarsest.value()},
            {"finest", choice.range.finest.value()},
            {"chosen", choice.attempts[choice.chosen].delta},
            {"attempts", attempts}};
}

Json json_of(const FitReport& fit) {
    const Json steps = each_of<Json>(fit.repair.steps, [&](const RepairStep& step) { return json_of(step); });
    const UnionAccuracy& accuracy = fit.accuracy;
    return {{"outside", fit.fit.outside},
            {"repeated", fit.fit.repeated},
            {"inexact", fit.fit.inexact},
            {"queries", fit.fit.queries},
            {"not_needed", fit.not_needed},
            {"repair",
             {{"topology", json_of(fit.repair.topology)},
              {"added", fit.repair.added},
              {"is_growth_limited", fit.repair.is_growth_limited},
              {"largest_protrusion", fit.repair.largest_protrusion},
              {"points", fit.repair.points},
              {"far_points", fit.repair.far_points},
              {"queries", fit.repair.queries},
              {"steps", steps}}},
            {"accuracy",
             {{"largest_distance", accuracy.largest_distance},
              {"mean_distance", accuracy.mean_distance},
              {"farthest_sample", coordinates(accuracy.farthest_sample)},
              {"thinnest", json_of(accuracy.thinnest)},
              {"thickest", json_of(accuracy.thickest)}}},
            {"thin_part",
             fit.thin_part ? Json{{"place", coordinates(fit.thin_part->place)}, {"thickness", fit.thin_part->thickness}}
                           : Json(nullptr)}};
}

Json json_of(std::span<const StageCost> costs) {
    return each_of<Json>(costs, [&](const StageCost& cost) {
        return Json{{"stage", cost.stage}, {"seconds", cost.seconds}, {"peak_memory", cost.peak_memory}};
    });
}

Json json_of(const AxisReport& axis) {
    const Agreement agrees = agreement(axis);
    const Json gaps = each_of<Json>(axis.closed_gaps, [&](const Gap& gap) {
        return Json{{"place", coordinates(gap.place)}, {"width", gap.width}, {"scale", gap.scale}};
    });
    return {
        {"scale", axis.scale},
        {"file", utf8_of(axis.file)},
        {"balls", axis.medial.balls},
        {"hidden_balls", axis.medial.hidden_balls},
        {"dual_complex", dual_complex_of(axis.medial)},
        {"medial_complex", medial_complex_of(axis.medial)},
        {"filter", axis.filter ? filter_of(*axis.filter) : Json(nullptr)},
        {"sharp_edges", axis.sharp ? sharp_of(*axis.sharp) : Json(nullptr)},
        {"cleaning", axis.clean ? clean_of(*axis.clean) : Json(nullptr)},
        {"centering", axis.center ? center_of(*axis.center) : Json(nullptr)},
        {"narrow_sheets", axis.narrow ? filter_of(*axis.narrow) : Json(nullptr)},
        {"simplification", axis.simplify ? simplify_of(*axis.simplify) : Json(nullptr)},
        {"envelope_accuracy", axis.accuracy ? accuracy_of(*axis.accuracy) : Json(nullptr)},
        {"result", {{"balls", axis.vertices}, {"edges", axis.edges}, {"faces", axis.faces}, {"sheets", axis.sheets}}},
        {"agreement",
         {{"solid_and_dual", or_null(agrees.solid_and_dual)},
          {"dual_and_medial", agrees.dual_and_medial},
          {"medial_and_filtered", or_null(agrees.medial_and_filtered)},
          {"filtered_and_sharp", or_null(agrees.filtered_and_sharp)},
          {"filtered_and_cleaned", or_null(agrees.filtered_and_cleaned)},
          {"compact_and_before", or_null(agrees.compact_and_before)}}},
        {"closed_gaps", gaps},
        {"costs", json_of(std::span(axis.costs))}};
}

Json json_of(const UnionMesh& mesh, const std::filesystem::path& file) {
    return {{"file", utf8_of(file)},
            {"solid", mesh.solid ? json_of(*mesh.solid) : Json(nullptr)},
            {"tolerance", mesh.tolerance},
            {"samples", mesh.samples},
            {"sampling", json_of(mesh.sampling)},
            {"mesh", json_of(mesh.report)},
            {"copied_vertices", mesh.boundary.copied_vertices},
            {"parted_edges", mesh.boundary.parted_edges},
            {"lost_samples", mesh.boundary.lost_samples},
            {"warnings", json_of(std::span(mesh.warnings))}};
}

}  // namespace

std::string to_json(const Box& box) { return json_of(box).dump(); }
std::string to_json(const Topology& topology) { return json_of(topology).dump(); }
std::string to_json(const MeshReport& mesh) { return json_of(mesh).dump(); }
std::string to_json(const ImageReport& image) { return json_of(image).dump(); }
std::string to_json(const PointsReport& points) { return json_of(points).dump(); }
std::string to_json(const UnionReport& balls) { return json_of(balls).dump(); }
std::string to_json(const ComplexReport& complex) { return json_of(complex).dump(); }
std::string to_json(const FunctionReport& function) { return json_of(function).dump(); }
std::string to_json(const InputReport& input) {
    return std::visit([](const auto& report) { return to_json(report); }, input);
}
std::string to_json(const SamplingStatistics& sampling) { return json_of(sampling).dump(); }
std::string to_json(const DeltaChoice& choice) { return json_of(choice).dump(); }
std::string to_json(const FewBallsStatistics& statistics) {
    return Json{{"error", statistics.error},
                {"greedy_error", statistics.greedy_error},
                {"greedy_count", statistics.greedy_count},
                {"count_bound", statistics.count_bound},
                {"candidates", statistics.candidates},
                {"search_points", statistics.search_points},
                {"checked_points", statistics.checked_points}}
        .dump();
}

std::string to_json(const BallScores& scores) {
    return Json{{"coverage", scores.coverage},
                {"surface_coverage", scores.surface_coverage},
                {"largest_gap", scores.largest_gap},
                {"mean_gap", scores.mean_gap},
                {"largest_protrusion", scores.largest_protrusion},
                {"mean_protrusion", scores.mean_protrusion},
                {"protrusion_95", scores.protrusion_95},
                {"volume_ratio", scores.volume_ratio},
                {"outside_share", scores.outside_share},
                {"volume_points", scores.volume_points},
                {"surface_points", scores.surface_points},
                {"union_points", scores.union_points}}
        .dump();
}

std::string to_json(const FitReport& fit) { return json_of(fit).dump(); }
std::string to_json(const FilterStatistics& filter) { return filter_of(filter).dump(); }
std::string to_json(const CleanStatistics& clean) { return clean_of(clean).dump(); }
std::string to_json(const SimplifyStatistics& simplify) { return simplify_of(simplify).dump(); }
std::string to_json(const SkeletonStatistics& skeleton) { return skeleton_of(skeleton).dump(); }

std::string to_json(const Measures& row) {
    const SurfaceValues& thickness = row.thickness;
    return Json({{"volume", or_null(row.volume)},
                 {"area", thickness.area},
                 {"mean_thickness", thickness.mean},
                 {"thickness_deviation", thickness.deviation},
                 {"minimum_thickness", thickness.min},
                 {"maximum_thickness", thickness.max},
                 {"sheets", row.sheets},
                 {"sheet_area", row.sheet_area},
                 {"branches", row.branches},
                 {"curve_length", row.curve_length},
                 {"ends", row.ends},
                 {"junctions", row.junctions},
                 {"components", row.topology.components},
                 {"tunnels", or_null(row.topology.tunnels)},
                 {"voids", or_null(row.topology.voids)}})
        .dump();
}

std::string to_json(const Walls& walls) {
    Json findings = Json::array();
    for (const Finding& finding : walls.findings) {
        std::string kind(name_of(finding.kind));
        std::ranges::replace(kind, ' ', '_');
        findings.push_back(
            {{"kind", kind},
             {"value", finding.value},
             {"limit", finding.limit},
             {"place", coordinates(finding.ball.center)},
             {"direction", coordinates(finding.direction)},
             {"contacts", Json::array({coordinates(finding.contacts[0]), coordinates(finding.contacts[1])})},
             {"ball", {{"center", coordinates(finding.ball.center)}, {"radius", finding.ball.radius}}},
             {"area", finding.area},
             {"extent", json_of(finding.extent)},
             {"vertices", finding.vertices}});
    }
    return Json({{"tolerance", walls.tolerance}, {"findings", findings}}).dump();
}

std::string to_json(std::span<const FiltrationLevel> levels) {
    const Json result = each_of<Json>(levels, [&](const FiltrationLevel& level) {
        return Json{{"scale", level.scale},
                    {"sheets", level.sheets},
                    {"balls", level.balls},
                    {"area", level.area},
                    {"curve_length", level.curve_length},
                    {"volume", level.volume}};
    });
    return result.dump();
}
std::string to_json(const ScalePlateau& plateau) {
    return Json({{"begin", plateau.begin}, {"end", plateau.end}, {"middle", plateau.middle}}).dump();
}

std::string to_json(const AxisReport& axis) { return json_of(axis).dump(); }
std::string to_json(const UnionMesh& mesh, const std::filesystem::path& file) { return json_of(mesh, file).dump(); }
std::string to_json(std::span<const StageCost> costs) { return json_of(costs).dump(); }
std::string to_json(const Diagnostic& diagnostic) { return json_of(diagnostic).dump(); }
std::string to_json(std::span<const Diagnostic> diagnostics) { return json_of(diagnostics).dump(); }

}  // namespace scaleaxis::inline v1
