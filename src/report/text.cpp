// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/files.hpp"
#include "base/text.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::inline v1 {

namespace {

std::string or_dash(const std::optional<std::int64_t>& value) { return value ? std::to_string(*value) : "-"; }

void print_topology(std::ostream& out, std::string_view name, const Topology& topology) {
    label(out, "") << std::left << std::setw(18) << name << std::right << std::setw(10) << topology.components
                   << std::setw(8) << topology.euler << std::setw(9) << or_dash(topology.tunnels) << std::setw(7)
                   << or_dash(topology.voids) << '\n';
}

std::string_view verdict(const std::optional<bool>& agrees) { return !agrees ? "unknown" : *agrees ? "yes" : "NO"; }

std::string text_of(const Point& p) {
    std::ostringstream text;
    text << '(' << p.x << ", " << p.y << ", " << p.z << ')';
    return text.str();
}

void print_extent(std::ostream& out, std::int64_t count, double least_radius, double most_radius, const Box& bounds) {
    if (count > 0) {
        label(out, "radius") << least_radius << " ... " << most_radius << '\n';
        print(out, bounds);
    }
}

void print_filter(std::ostream& out, const char* name, const FilterStatistics& filter) {
    label(out, name) << counted(filter.sheets_before, "sheet") << " -> " << filter.sheets_after << ", "
                     << counted(filter.faces_removed, "face") << " removed\n";
}

void print_labels(std::ostream& out, const std::vector<LabelCount>& labels) {
    constexpr std::size_t kMost = 256;
    constexpr std::size_t kShown = 12;
    if (labels.empty() || labels.size() > kMost) {
        return;
    }
    label(out, "labels");
    for (std::size_t i = 0; i < std::min(labels.size(), kShown); ++i) {
        out << (i == 0 ? "" : ", ") << static_cast<std::int64_t>(labels[i].label)
            << (labels[i].name.empty() ? "" : " '" + labels[i].name + "'") << " (" << labels[i].voxels << " voxels)";
    }
    out << (labels.size() > kShown ? ", ... " + std::to_string(labels.size()) + " in all\n" : "\n");
}

void print(std::ostream& out, const EnvelopeAccuracy& accuracy) {
    label(out, "") << "from the input to the envelope " << accuracy.solid_to_envelope
                   << " at most at points half of delta apart, " << accuracy.mean_solid_to_envelope << " on average";
    if (accuracy.envelope_to_solid) {
        out << "; back " << *accuracy.envelope_to_solid << " and " << *accuracy.mean_envelope_to_solid;
    }
    out << '\n';
}

}  // namespace

std::ostream& label(std::ostream& out, std::string_view name) {
    return out << "  " << std::left << std::setw(12) << name << std::right;
}

void print(std::ostream& out, const Box& box) {
    const Point size = box.is_empty() ? Point{} : box.max - box.min;
    label(out, "bounds") << size.x << " x " << size.y << " x " << size.z << ", diagonal " << box.diagonal() << '\n';
}

// Holes of a mesh or a cloud that are listed.
constexpr std::size_t kShown = 5;

void print(std::ostream& out, const MeshReport& mesh) {
    label(out, "mesh") << mesh.vertices << " vertices, " << mesh.triangles << " triangles; "
                       << counted(mesh.components, "component") << ", genus " << mesh.genus << ", Euler characteristic "
                       << mesh.euler << '\n';
    print(out, mesh.bounds);
    if (!mesh.unit.empty()) {
        label(out, "lengths") << "in " << mesh.unit << '\n';
    }
    label(out, "volume") << mesh.volume << ", area " << mesh.area << '\n';

    const std::array<std::pair<std::int64_t, std::string>, 10> repairs{{
        {mesh.isolated_vertices, counted(mesh.isolated_vertices, "isolated vertex", "isolated vertices")},
        {mesh.duplicate_vertices, counted(mesh.duplicate_vertices, "duplicate vertex", "duplicate vertices")},
        {mesh.degenerate_triangles, counted(mesh.degenerate_triangles, "degenerate triangle")},
        {mesh.duplicate_triangles, counted(mesh.duplicate_triangles, "duplicate triangle")},
        {mesh.split_vertices, counted(mesh.split_vertices, "non-manifold vertex", "non-manifold vertices")},
        {mesh.reversed_triangles, counted(mesh.reversed_triangles, "reversed triangle")},
        {mesh.reversed_components, counted(mesh.reversed_components, "inward component")},
        {mesh.wall_triangles, counted(mesh.wall_triangles, "triangle") + " of inner walls"},
        {mesh.sheet_triangles, counted(mesh.sheet_triangles, "triangle") + " of sheets"},
        {std::ssize(mesh.holes), counted(std::ssize(mesh.holes), "hole")},
    }};
    std::string list;
    for (const auto& [count, text] : repairs) {
        if (count > 0) {
            list += (list.empty() ? "" : ", ") + text;
        }
    }
    label(out, "repaired") << (list.empty() ? "nothing" : list) << '\n';
    for (std::size_t i = 0; i < std::min(kShown, mesh.holes.size()); ++i) {
        const Hole& hole = mesh.holes[i];
        label(out, i == 0 ? "holes" : "") << hole.width << " across, area " << hole.area << ", "
                                          << counted(hole.edges, "edge") << ", at " << text_of(hole.place) << '\n';
    }
    if (mesh.holes.size() > kShown) {
        label(out, "") << "... " << mesh.holes.size() << " in all, " << percentage(mesh.hole_area(), mesh.area)
                       << " of the area\n";
    }
    if (mesh.kind != SolidKind::kAuto) {
        label(out, "method") << name_of(mesh.kind) << ": " << mesh.reason << '\n';
    }
    label(out, "found") << counted(mesh.boundary_edges, "boundary edge") << ", "
                        << counted(mesh.non_manifold_edges, "non-manifold edge") << ", "
                        << counted(mesh.self_intersections, "self-intersection") << '\n';
}

void print(std::ostream& out, const PointsReport& points) {
    const CloudReport& cloud = points.cloud;
    label(out, "points") << cloud.points << ", " << cloud.not_finite << " not finite, " << cloud.thinned << " thinned, "
                         << counted(cloud.duplicates, "duplicate") << ", " << counted(cloud.outliers, "outlier") << ", "
                         << counted(cloud.border_points, "point") << " on a border\n";
    for (std::size_t i = 0; i < std::min(kShown, cloud.holes.size()); ++i) {
        const CloudHole& hole = cloud.holes[i];
        label(out, i == 0 ? "holes" : "")
            << hole.width << " across, " << counted(hole.points, "point") << ", at " << text_of(hole.place) << '\n';
    }
    if (cloud.holes.size() > kShown) {
        label(out, "") << "... " << cloud.holes.size() << " in all\n";
    }
    print(out, cloud.bounds);
    if (cloud.fault.empty()) {
        label(out, "spacing") << cloud.spacing << ", noise " << cloud.noise << " and kernel " << cloud.kernel
                              << " spacings\n";
        label(out, "normals") << cloud.note() << '\n';
    }
    if (points.method) {
        label(out, "method") << (*points.method == CloudMethod::kCrust ? "crust" : "moving least squares") << ": "
                             << points.reason << '\n';
    }
}

void print(std::ostream& out, const ImageReport& image) {
    const auto& [nx, ny, nz] = image.sizes;
    const auto& [dx, dy, dz] = image.spacing;
    label(out, "image") << nx << " x " << ny << " x " << nz << " voxels of " << dx << " x " << dy << " x " << dz
                        << '\n';
    label(out, "origin") << text_of(image.origin) << '\n';
    label(out, "directions") << text_of(image.directions[0]) << ", " << text_of(image.directions[1]) << ", "
                             << text_of(image.directions[2]) << '\n';
    if (!image.unit.empty() || !image.space.empty()) {
        label(out, "lengths") << (image.unit.empty() ? "" : "in " + image.unit)
                              << (image.unit.empty() || image.space.empty() ? "" : ", ")
                              << (image.space.empty() ? "" : "x, y, z to " + image.space) << '\n';
    }
    label(out, "values") << image.min << " ... " << image.max << '\n';
    print_labels(out, image.labels);
}

void print(std::ostream& out, const UnionReport& balls) {
    print_balls(out, static_cast<std::size_t>(balls.balls));
    label(out, "distinct") << balls.distinct << '\n';
    print_extent(out, balls.distinct, balls.min_radius, balls.max_radius, balls.bounds);
}

void print(std::ostream& out, const FunctionReport& function) {
    label(out, "function") << function.expression << '\n';
    print(out, function.bounds);
}

void print(std::ostream& out, const InputReport& input) {
    std::visit([&out](const auto& report) { print(out, report); }, input);
}

void print_solid(std::ostream& out, const Diagnostic& fault, const std::optional<Topology>& topology) {
    label(out, "solid");
    if (!fault.empty()) {
        out << "none: " << fault.message << '\n';
    } else if (!topology) {
        out << "of unknown topology\n";
    } else {
        out << in_words(*topology) << '\n';
    }
}

void print_samples(std::ostream& out, Index samples, double tolerance, const SamplingStatistics& sampling) {
    label(out, "samples") << samples << " at delta = " << tolerance << " (" << sampling.seeds << " seeds, "
                          << counted(sampling.rounds, "round") << " of refinement)\n";
    label(out, "") << counted(sampling.restricted_facets, "restricted facet") << ", "
                   << counted(sampling.conflicts, "conflict") << ", " << counted(sampling.relabelled, "label")
                   << " corrected, " << counted(sampling.irregular_samples, "irregular sample") << '\n';
    label(out, "") << sampling.inside_queries << " inside and " << sampling.crossing_queries << " crossing queries\n";
}

void print(std::ostream& out, const DeltaChoice& choice) {
    const DeltaAttempt& chosen = choice.attempts[choice.chosen];
    label(out, "delta") << chosen.delta << " chosen of " << choice.range.coarsest.value() << " ... "
                        << choice.range.finest.value()
                        << (chosen.fault.empty() ? "" : ", though it does not meet the requirements") << '\n';
    for (const DeltaAttempt& attempt : choice.attempts) {
        label(out, "") << attempt.delta << ": " << counted(attempt.balls, "ball") << "; "
                       << (attempt.fault.empty() ? "meets the requirements" : attempt.fault.message) << '\n';
    }
}

void print_balls(std::ostream& out, std::size_t balls, const std::filesystem::path& file) {
    label(out, "balls") << balls << (file.empty() ? std::string() : " -> " + utf8_of(file)) << '\n';
}

void print(std::ostream& out, const FewBallsStatistics& statistics) {
    label(out, "error") << statistics.error << "; greedy set cover, at the points of the search alone: "
                        << counted(statistics.greedy_count, "ball") << ", error " << statistics.greedy_error << '\n';
    label(out, "bound") << "at least " << statistics.count_bound << " of the " << statistics.candidates
                        << " candidates are needed for this error\n";
}

void print(std::ostream& out, const BallScores& scores) {
    label(out, "coverage") << percentage(scores.coverage, 1.0) << " of the volume, "
                           << percentage(scores.surface_coverage, 1.0) << " of the surface; largest gap "
                           << scores.largest_gap << '\n';
    label(out, "protrusion") << scores.largest_protrusion << " at most, " << scores.mean_protrusion
                             << " on average, 95 % below " << scores.protrusion_95 << '\n';
    label(out, "volume") << scores.volume_ratio << " times that of the solid\n";
}

void print(std::ostream& out, const FitReport& fit) {
    label(out, "fit") << counted(fit.fit.outside, "ball") << " outside, " << fit.fit.repeated << " repeated, "
                      << fit.fit.inexact << " inexact; " << fit.not_needed << " not needed; " << fit.repair.added
                      << " added by the repair\n";
    for (const RepairStep& step : fit.repair.steps) {
        label(out, "repair") << step.name << ": " << counted(step.gaps, "gap") << ", " << step.missed
                             << " missed parts, " << counted(step.far_samples, "far sample") << ", "
                             << counted(step.added, "ball") << " added in " << counted(step.rounds, "round")
                             << (step.topology ? " -> " + in_words(*step.topology) : "") << '\n';
    }
    const UnionAccuracy& accuracy = fit.accuracy;
    label(out, "accuracy") << "boundary up to " << accuracy.largest_distance << " outside the union, samples "
                           << accuracy.mean_distance << " on average, farthest at " << text_of(accuracy.farthest_sample)
                           << '\n';
    label(out, "thickness") << 2.0 * accuracy.thinnest.radius << " at " << text_of(accuracy.thinnest.center) << " ... "
                            << 2.0 * accuracy.thickest.radius << " at " << text_of(accuracy.thickest.center) << '\n';
}

void print(std::ostream& out, const AxisReport& axis) {
    const MedialAxisStatistics& medial = axis.medial;
    out << "\nscale " << axis.scale << " -> " << utf8_of(axis.file) << '\n';
    label(out, "union") << counted(medial.balls, "ball") << ", " << medial.hidden_balls << " hidden ("
                        << percentage(medial.hidden_balls, medial.balls) << "); "
                        << counted(medial.boundary_vertices, "boundary vertex", "boundary vertices") << '\n';
    label(out, "dual") << counted(medial.dual_tetrahedra, "tetrahedron", "tetrahedra") << ", "
                       << counted(medial.dual_triangles, "triangle") << ", " << counted(medial.dual_edges, "edge")
                       << ", " << counted(medial.dual_vertices, "vertex", "vertices") << '\n';
    label(out, "medial axis") << counted(medial.faces, "face") << ", " << counted(medial.edges, "edge") << ", "
                              << counted(medial.vertices, "vertex", "vertices") << "; of "
                              << counted(medial.cells, "cell") << " " << medial.inside_cells << " inside, "
                              << medial.flat_cells << " flat; perturbation " << medial.perturbation << ", "
                              << counted(medial.retries, "retry", "retries") << '\n';
    if (axis.filter) {
        print(out, *axis.filter);
    }
    if (axis.sharp) {
        label(out, "sharp edges") << "a length of " << axis.sharp->length << " reached in "
                                  << counted(axis.sharp->points, "point") << ", "
                                  << counted(axis.sharp->corners, "corner") << "; from " << axis.sharp->angle
                                  << " degrees; " << counted(axis.sharp->sheets, "sheet");
        if (axis.sharp->known > 0.0) {
            out << "; the solid knows a length of " << axis.sharp->known;
        }
        out << '\n';
    }
    if (axis.clean) {
        print(out, *axis.clean);
    }
    if (axis.center) {
        label(out, "centering") << counted(axis.center->fitted, "ball") << " touch the solid now, "
                                << axis.center->mean_growth << " larger on average; moved by "
                                << axis.center->largest_move << " at most";
        if (axis.center->halved > 0) {
            out << "; " << counted(axis.center->halved, "edge") << " halved";
        }
        out << '\n';
    }
    if (axis.narrow && axis.narrow->faces_removed > 0) {
        print_filter(out, "narrow", *axis.narrow);
    }
    if (axis.simplify) {
        print(out, *axis.simplify);
    }
    if (axis.accuracy) {
        print(out, *axis.accuracy);
    }
    label(out, "result") << counted(axis.vertices, "ball") << ", " << counted(axis.edges, "edge") << ", "
                         << counted(axis.faces, "face") << ", " << counted(axis.sheets, "sheet") << '\n';

    label(out, "topology") << std::setw(28) << "components" << std::setw(8) << "euler" << std::setw(9) << "tunnels"
                           << std::setw(7) << "voids" << '\n';
    if (axis.solid) {
        print_topology(out, "input solid", *axis.solid);
    }
    print_topology(out, "union (dual)", medial.dual_complex);
    print_topology(out, "medial axis", medial.medial_complex);
    if (axis.filter) {
        print_topology(out, "filtered", axis.filter->topology);
    }
    if (axis.sharp) {
        print_topology(out, "up to sharp edges", axis.sharp->topology);
    }
    if (axis.clean) {
        print_topology(out, "cleaned", axis.clean->topology);
    }
    if (axis.simplify) {
        print_topology(out, "compact", axis.simplify->topology);
    }
    const Agreement agrees = agreement(axis);
    label(out, "agreement") << "solid = union: " << verdict(agrees.solid_and_dual)
                            << ", union = medial axis: " << verdict(agrees.dual_and_medial)
                            << ", medial axis = filtered: " << verdict(agrees.medial_and_filtered);
    if (agrees.filtered_and_sharp) {
        out << ", filtered = up to sharp edges: " << verdict(agrees.filtered_and_sharp);
    }
    if (agrees.filtered_and_cleaned) {
        out << ", filtered = cleaned: " << verdict(agrees.filtered_and_cleaned);
    }
    if (agrees.compact_and_before) {
        out << ", compact = before: " << verdict(agrees.compact_and_before);
    }
    out << '\n';
    print(out, std::span(axis.costs));
}

void print(std::ostream& out, const FilterStatistics& filter) { print_filter(out, "filter", filter); }

void print(std::ostream& out, const CleanStatistics& clean) {
    label(out, "cleaning") << counted(clean.sheets_before, "sheet") << " -> " << clean.sheets_after << ", "
                           << counted(clean.curves, "curve") << ", "
                           << counted(clean.vertices_removed, "vertex", "vertices") << " removed\n";
    label(out, "") << "below an erosion thickness of " << clean.thickness << ": area " << clean.area_removed
                   << ", up to " << clean.largest_retreat << " from the rest\n";
    label(out, "") << "their balls stick out of the others by " << clean.largest_loss << " at most, " << clean.mean_loss
                   << " on average\n";
}

void print(std::ostream& out, const SimplifyStatistics& simplify) {
    label(out, "compact") << counted(simplify.vertices_before, "vertex", "vertices") << " -> "
                          << simplify.vertices_after << ", " << counted(simplify.triangles, "triangle") << ", "
                          << counted(simplify.curve_edges, "edge") << " of curves\n";
    label(out, "") << "within " << simplify.error << ": balls before stick out by " << simplify.largest_gap
                   << " at most, balls now by " << simplify.largest_protrusion << '\n';
}

void print(std::ostream& out, const SkeletonStatistics& skeleton) {
    label(out, "skeleton") << counted(skeleton.nodes, "node") << ", "
                           << counted(skeleton.branches, "branch", "branches") << ", " << counted(skeleton.ends, "end")
                           << ", " << counted(skeleton.junctions, "junction") << '\n';
    label(out, "length") << skeleton.length << '\n';
    label(out, "radius") << skeleton.least_radius << " ... " << skeleton.largest_radius << ", " << skeleton.mean_radius
                         << " on average\n";
    label(out, "topology") << in_words(skeleton.topology)
                           << "; that of the axis: " << verdict(agree(skeleton.complex_topology, skeleton.topology))
                           << '\n';
}

void print(std::ostream& out, const ComplexReport& complex) {
    label(out, "axis") << counted(complex.vertices, "vertex", "vertices") << ", " << counted(complex.edges, "edge")
                       << ", " << counted(complex.faces, "face") << ", " << counted(complex.sheets, "sheet") << '\n';
    label(out, "topology") << in_words(complex.topology) << '\n';
    print_extent(out, complex.vertices, complex.min_radius, complex.max_radius, complex.bounds);
}

void print(std::ostream& out, const UnionMesh& mesh, const std::filesystem::path& file) {
    print_solid(out, {}, mesh.solid);
    print_samples(out, mesh.samples, mesh.tolerance, mesh.sampling);
    label(out, "surface") << "-> " << utf8_of(file) << '\n';
    print(out, mesh.report);
}

void print(std::ostream& out, std::span<const StageCost> costs) {
    for (std::size_t i = 0; i < costs.size(); ++i) {
        std::ostringstream line;
        line << std::left << std::setw(14) << costs[i].stage << std::right << std::fixed << std::setprecision(3)
             << std::setw(9) << costs[i].seconds << " s, peak memory " << std::setprecision(0) << std::setw(6)
             << static_cast<double>(costs[i].peak_memory) / 1e6 << " MB";
        label(out, i == 0 ? "costs" : "") << line.str() << '\n';
    }
}

}  // namespace scaleaxis::inline v1
