// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <string_view>
#include <utility>

#include "report.hpp"

namespace scaleaxis::app {

namespace {

// "1 sheet", "2 sheets"
std::string counted(std::int64_t count, const std::string& one, const std::string& many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}
std::string counted(std::int64_t count, const std::string& one) { return counted(count, one, one + "s"); }

std::string percentage(double part, double whole) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << (whole > 0 ? 100 * part / whole : 0.0) << " %";
    return text.str();
}

std::string or_dash(const std::optional<std::int64_t>& value) { return value ? std::to_string(*value) : "-"; }

void print_topology(std::ostream& out, std::string_view name, const Topology& topology) {
    label(out, "") << std::left << std::setw(18) << name << std::right << std::setw(10) << topology.components
                   << std::setw(8) << topology.euler << std::setw(9) << or_dash(topology.tunnels) << std::setw(7)
                   << or_dash(topology.voids) << '\n';
}

std::string in_words(const Topology& topology) {
    return counted(topology.components, "component") + ", " + or_dash(topology.tunnels) + " tunnels, " +
           or_dash(topology.voids) + " voids, Euler characteristic " + std::to_string(topology.euler);
}

std::string_view verdict(const std::optional<bool>& agrees) { return !agrees ? "unknown" : *agrees ? "yes" : "NO"; }

}  // namespace

std::ostream& label(std::ostream& out, std::string_view name) {
    return out << "  " << std::left << std::setw(12) << name << std::right;
}

void print(std::ostream& out, const Box& box) {
    const Point size = box.is_empty() ? Point{} : box.max - box.min;
    label(out, "bounds") << size.x << " x " << size.y << " x " << size.z << ", diagonal " << box.diagonal() << '\n';
}

void print(std::ostream& out, const MeshReport& mesh) {
    label(out, "mesh") << mesh.vertices << " vertices, " << mesh.triangles << " triangles; "
                       << counted(mesh.components, "component") << ", genus " << mesh.genus << ", Euler characteristic "
                       << mesh.euler << '\n';
    print(out, mesh.bounds);
    label(out, "volume") << mesh.volume << ", area " << mesh.area << '\n';

    const std::array<std::pair<std::int64_t, std::string>, 7> repairs{{
        {mesh.isolated_vertices, counted(mesh.isolated_vertices, "isolated vertex", "isolated vertices")},
        {mesh.duplicate_vertices, counted(mesh.duplicate_vertices, "duplicate vertex", "duplicate vertices")},
        {mesh.degenerate_triangles, counted(mesh.degenerate_triangles, "degenerate triangle")},
        {mesh.duplicate_triangles, counted(mesh.duplicate_triangles, "duplicate triangle")},
        {mesh.split_vertices, counted(mesh.split_vertices, "non-manifold vertex", "non-manifold vertices")},
        {mesh.reversed_triangles, counted(mesh.reversed_triangles, "reversed triangle")},
        {mesh.reversed_components, counted(mesh.reversed_components, "inward component")},
    }};
    std::string list;
    for (const auto& [count, text] : repairs) {
        if (count > 0) {
            list += (list.empty() ? "" : ", ") + text;
        }
    }
    label(out, "repaired") << (list.empty() ? "nothing" : list) << '\n';
    label(out, "remaining") << counted(mesh.boundary_edges, "boundary edge") << ", "
                            << counted(mesh.non_manifold_edges, "non-manifold edge") << ", "
                            << counted(mesh.self_intersections, "self-intersection") << '\n';
}

void print(std::ostream& out, const CloudReport& cloud) {
    label(out, "points") << cloud.points << ", " << counted(cloud.duplicates, "duplicate") << ", "
                         << counted(cloud.outliers, "outlier") << ", " << counted(cloud.border_points, "point")
                         << " on a border\n";
    print(out, cloud.bounds);
    if (cloud.fault.empty()) {
        label(out, "spacing") << cloud.spacing << ", noise " << cloud.noise << " and kernel " << cloud.kernel
                              << " spacings\n";
        label(out, "normals") << cloud.note() << '\n';
    }
}

void print_solid(std::ostream& out, const std::string& fault, const std::optional<Topology>& topology) {
    label(out, "solid");
    if (!fault.empty()) {
        out << "none: " << fault << '\n';
    } else if (!topology) {
        out << "of unknown topology\n";
    } else {
        out << in_words(*topology) << '\n';
    }
}

void print(std::ostream& out, Index samples, double tolerance, const SamplingStatistics& sampling) {
    label(out, "samples") << samples << " at delta = " << tolerance << " (" << sampling.seeds << " seeds, "
                          << counted(sampling.rounds, "round") << " of refinement)\n";
    label(out, "") << counted(sampling.restricted_facets, "restricted facet") << ", "
                   << counted(sampling.conflicts, "conflict") << ", " << counted(sampling.relabelled, "label")
                   << " corrected, " << counted(sampling.irregular_samples, "irregular sample") << '\n';
    label(out, "") << sampling.inside_queries << " inside and " << sampling.crossing_queries << " crossing queries\n";
}

void print_balls(std::ostream& out, std::size_t balls, const std::optional<std::filesystem::path>& file) {
    label(out, "balls") << balls << (file ? " -> " + file->string() : std::string()) << '\n';
}

void print(std::ostream& out, const AxisReport& axis) {
    const MedialAxisStatistics& medial = axis.medial;
    out << "\nscale " << axis.scale << " -> " << axis.file.string() << '\n';
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
        label(out, "filter") << counted(axis.filter->sheets_before, "sheet") << " -> " << axis.filter->sheets_after
                             << ", " << counted(axis.filter->faces_removed, "face") << " removed\n";
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
    const Agreement agrees = agreement(axis);
    label(out, "agreement") << "solid = union: " << verdict(agrees.solid_and_dual)
                            << ", union = medial axis: " << verdict(agrees.dual_and_medial)
                            << ", medial axis = filtered: " << verdict(agrees.medial_and_filtered) << '\n';
    print(out, axis.costs);
}

void print(std::ostream& out, const MedialComplex& axis, const Topology& topology) {
    const auto count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    label(out, "axis") << counted(count(axis.vertices.size()), "vertex", "vertices") << ", "
                       << counted(count(axis.edges.size()), "edge") << ", " << counted(count(axis.faces.size()), "face")
                       << ", " << counted(axis.sheets, "sheet") << '\n';
    label(out, "topology") << in_words(topology) << '\n';
}

void print(std::ostream& out, const std::vector<StageCost>& costs) {
    for (std::size_t i = 0; i < costs.size(); ++i) {
        std::ostringstream line;
        line << std::left << std::setw(14) << costs[i].stage << std::right << std::fixed << std::setprecision(3)
             << std::setw(9) << costs[i].seconds << " s, peak memory " << std::setprecision(0) << std::setw(6)
             << static_cast<double>(costs[i].peak_memory) / 1e6 << " MB";
        label(out, i == 0 ? "costs" : "") << line.str() << '\n';
    }
}

}  // namespace scaleaxis::app
