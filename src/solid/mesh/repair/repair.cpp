// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "scaleaxis/mesh.hpp"
#include "solid/mesh/repair/cleaning.hpp"
#include "solid/mesh/repair/closing.hpp"
#include "solid/mesh/repair/orientation.hpp"
#include "solid/mesh/repair/repair.hpp"
#include "solid/mesh/self_intersections.hpp"
#include "solid/mesh/triangle_edges.hpp"
#include "solid/mesh/winding.hpp"
#include "spatial/extent.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kRepairStage = "repair";

// Below this mean thickness relative to the diagonal, the volume is rounding error.
constexpr double kSmallestRelativeThickness = 1e-12;

// Vertices this close (fractions of the diagonal) may be meant to be one.
constexpr std::array kWeldTolerances{1e-8, 1e-7, 1e-6, 3e-6, 1e-5};

// A surface with holes or tunnels whose mean thickness is below this (fraction of the diagonal) is a wall.
constexpr double kThinWall = 0.005;

/// The thickness of a wall around something that may be meant, as of a double wall with pin holes; 0 for other solids.
double wall_thickness(const MeshReport& report) {
    const double thickness = report.area > 0.0 ? std::max(0.0, 2.0 * report.volume / report.area) : 0.0;
    const bool is_pierced = !report.holes.empty() || report.genus > 0;
    const double diagonal = report.bounds.diagonal();
    return is_pierced && thickness > kSmallestRelativeThickness * diagonal && thickness < kThinWall * diagonal
               ? thickness
               : 0.0;
}

// Patches this large, as a part of the area, are no longer those of holes: the surface is a sheet.
constexpr double kMostPatches = 2.0 / 3.0;

/// Why the arrays are no mesh at all; empty if they are.
Diagnostic find_bad_data(const TriangleMesh& mesh) {
    constexpr std::size_t kMostTriangles = std::numeric_limits<Index>::max() / 3;
    if (mesh.triangles.size() > kMostTriangles) {
        return {"mesh.too_many_triangles", "too many triangles: " + std::to_string(mesh.triangles.size()) +
                                               "; reduce them to " + std::to_string(kMostTriangles)};
    }
    const auto vertex_count = static_cast<Index>(mesh.vertices.size());
    for (Index v = 0; v < vertex_count; ++v) {
        if (!is_usable(mesh.vertices[v])) {
            return bad_vertex(v);
        }
    }
    return find_bad_triangle(mesh);
}

double doubled_area(const std::vector<Point>& vertices, const Triangle& t) {
    return norm(cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]));
}

/// Does the triangle have no area but what rounding may make of none?
bool has_no_area(const std::vector<Point>& vertices, const Triangle& t) {
    const double longest =
        std::max({squared_distance(vertices[t[0]], vertices[t[1]]), squared_distance(vertices[t[1]], vertices[t[2]]),
                  squared_distance(vertices[t[2]], vertices[t[0]])});
    return doubled_area(vertices, t) <= 4.0 * std::numeric_limits<double>::epsilon() * longest;
}

/// Adds up the area, and counts the triangles without any.
void add_area(const TriangleMesh& mesh, MeshReport& report) {
    for (const Triangle& triangle : mesh.triangles) {
        report.degenerate_triangles += has_no_area(mesh.vertices, triangle) ? 1 : 0;
        report.area += doubled_area(mesh.vertices, triangle) / 2.0;
    }
}

/// Turns the marked triangles over. Returns how many.
std::int64_t reverse_marked(std::vector<Triangle>& triangles, const std::vector<char>& is_marked) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (is_marked[t]) {
            reverse(triangles[t]);
        }
    }
    return std::ranges::count(is_marked, 1);
}

// A thickness or an opening (fraction of the diagonal) that a sampling with the default tolerance of 1/100 can show.
constexpr double kAdvisedLength = 0.025;

/// A surface that has no inside, and what to do about it: 1/40 of the diagonal is a thickness.
Diagnostic without_inside(Diagnostic fault, const Box& bounds) {
    fault.message += "; give it a thickness";
    fault.hints = {{"solid", "thicken"}, {"thickness", to_text(kAdvisedLength * bounds.diagonal(), 2)}};
    return fault;
}

/// A ball for what a wall encloses: wider than the holes that are known, and no finer than the advised thickness.
double wrapping_opening(const MeshReport& report) {
    const double holes = report.holes.empty() ? 0.0 : 1.5 * report.holes[0].width;
    return std::max(kAdvisedLength * report.bounds.diagonal(), holes);
}

/// Why the surface has no inside; empty if it has one.
Diagnostic find_topological_fault(const TriangleMesh& mesh, const MeshReport& report, Index one_sided) {
    if (one_sided != kNone) {
        const Index vertex = mesh.triangles[one_sided][0];
        return without_inside({"mesh.one_sided",
                               "one-sided: the surface through " + to_text(mesh.vertices[vertex]) +
                                   " cannot be oriented, so it has no inside",
                               "vertex", vertex, mesh.vertices[vertex]},
                              report.bounds);
    }
    return extent_fault(report.bounds, "vertices");
}

/// Is the solid on just one side of some triangle?
bool bounds_anything(const Bvh& bvh, const Box& box) {
    const std::vector<Point>& p = bvh.mesh.vertices;
    for (Index t = 0; t < static_cast<Index>(bvh.mesh.triangles.size()); ++t) {
        const auto& [u, v, w] = bvh.mesh.triangles[t];
        if (!has_no_area(p, bvh.mesh.triangles[t]) &&
            is_boundary_at(bvh, box, t, (1.0 / 3.0) * (p[u] + p[v] + p[w]), 0.0)) {
            return true;
        }
    }
    return false;
}

/// Why a closed surface encloses nothing; empty if it encloses something. Signed volumes may cancel within a component
/// that crosses itself.
Diagnostic find_volume_fault(const MeshReport& report, const std::vector<double>& volumes, const Bvh& bvh) {
    double volume = 0.0;
    for (const double volume_of_component : volumes) {
        volume += std::abs(volume_of_component);
    }
    if (volume <= kSmallestRelativeThickness * report.area * report.bounds.diagonal() &&
        !bounds_anything(bvh, report.bounds)) {
        return without_inside({"mesh.no_volume", "no volume: the surface encloses nothing"}, report.bounds);
    }
    return {};
}

/// The number of edges with one triangle.
std::int64_t count_boundary_edges(const IndexLists& edges) {
    std::int64_t count = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        count += edges[e].size() == 1 ? 1 : 0;
    }
    return count;
}

/// Welds vertices of the boundary that are almost at the same place, with the smallest tolerance that leaves the
/// least boundary.
void weld_nearly(TriangleMesh& mesh, CleanSurface& surface, MeshReport& report) {
    std::int64_t least = count_boundary_edges(surface.edges);
    const TriangleMesh given = mesh;
    const CleanSurface given_surface = surface;
    const std::int64_t given_count = report.duplicate_vertices;
    for (const double relative : kWeldTolerances) {
        if (least == 0) {
            return;
        }
        TriangleMesh welded = given;
        const double tolerance = relative * report.bounds.diagonal();
        const std::int64_t count = weld_boundary(welded, given_surface, tolerance);
        if (count == 0) {
            continue;
        }
        CleanSurface result = clean_surface(welded.triangles, welded.vertices.size());
        if (const std::int64_t edges = count_boundary_edges(result.edges); edges < least) {
            least = edges;
            mesh = std::move(welded);
            surface = std::move(result);
            report.duplicate_vertices = given_count + count;
            report.weld_tolerance = tolerance;
        }
    }
}

/// What was done to the surface, in a few words.
std::string reason_of(const MeshReport& report) {
    std::string text = report.is_closed() && report.is_manifold() ? "the surface is closed" : "";
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
    if (!report.holes.empty()) {
        add(counted(std::ssize(report.holes), "hole", "holes") + " closed, " +
            percentage(report.hole_area(), report.area) + " of the area, the widest " + to_text(report.holes[0].width) +
            " across");
    }
    if (report.wall_triangles > 0) {
        add(counted(report.wall_triangles, "triangle", "triangles") + " taken for inner walls");
    }
    if (report.sheet_triangles > 0) {
        add(counted(report.sheet_triangles, "triangle", "triangles") + " of sheets left out");
    }
    if (const double thickness = wall_thickness(report); thickness > 0.0) {
        add("a wall, " + to_text(thickness) + " thick on average");
    }
    if (text.empty()) {
        add("closed except at edges where parts touch");
    }
    return text;
}

/// Leaves out walls and sheets and closes holes; or finds that there would be more patches than surface.
void close(RepairedMesh& repaired) {
    auto& [mesh, report, left_out] = repaired;
    Closing closing = close_holes(mesh);
    report.reversed_triangles += closing.turned_triangles;
    report.wall_triangles = closing.wall_triangles;
    report.sheet_triangles = closing.sheet_triangles;
    report.holes = std::move(closing.holes);
    // Without any triangle left each was its own patch.
    const double patches = mesh.triangles.empty() ? report.area : report.hole_area();
    if (mesh.triangles.empty() || patches > kMostPatches * report.area) {
        mesh.triangles = std::move(closing.open);
        report.wall_triangles = 0;
        report.sheet_triangles = 0;
        report.holes.clear();
        report.fault = without_inside({"mesh.sheet",
                                       "no inside: the surface is open, and to close it would take patches of " +
                                           percentage(patches, report.area) + " of its area",
                                       "vertex", 0, mesh.vertices[0]},
                                      report.bounds);
    } else if (!closing.left_out.empty()) {
        left_out = {mesh.vertices, std::move(closing.left_out)};
        drop_isolated_vertices(left_out);
    }
    drop_isolated_vertices(mesh);  // those of walls
}

/// Orients a closed surface outward and takes apart its vertices with several fans; or finds why it bounds no solid.
void orient_and_split(TriangleMesh& mesh, const Orientation& orientation, std::vector<Index> opposite,
                      MeshReport& report, const Execution& execution) {
    report.reversed_triangles += reverse_marked(mesh.triangles, orientation.is_reversed);
    const Bvh bvh = build_bvh(mesh);
    scaleaxis::report(execution, kRepairStage, 0.6);
    report.reversed_components = turn_outward(mesh, orientation, bvh);
    const std::vector<double> volumes = component_volumes(mesh, orientation);
    report.volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
    report.fault = find_volume_fault(report, volumes, bvh);
    if (!report.fault.empty()) {
        return;
    }
    // Before the fans of a vertex are taken apart: they touch there, but do not intersect.
    report.self_intersections = self_intersections(bvh).pairs;
    scaleaxis::report(execution, kRepairStage, 0.8);
    if (report.reversed_triangles > 0 || report.reversed_components > 0) {  // their sides have other numbers now
        opposite = paired_sides(mesh, sides_of_edges(mesh.triangles, mesh.vertices.size()));
    }
    report.split_vertices = split_vertices(mesh, opposite);
}

}  // namespace

IndexLists clean(TriangleMesh& mesh, MeshReport& report) {
    report.vertices = static_cast<std::int64_t>(mesh.vertices.size());
    report.triangles = static_cast<std::int64_t>(mesh.triangles.size());
    report.fault = find_bad_data(mesh);
    if (!report.fault.empty()) {
        return {};
    }
    report.isolated_vertices = drop_isolated_vertices(mesh);
    for (const Point& p : mesh.vertices) {
        report.bounds.extend(p);
    }
    CleanSurface surface = clean_surface(mesh.triangles, mesh.vertices.size());
    report.duplicate_vertices = weld_boundary(mesh, surface);
    if (report.duplicate_vertices > 0) {
        surface = clean_surface(mesh.triangles, mesh.vertices.size());
    }
    if (count_boundary_edges(surface.edges) > 0) {
        weld_nearly(mesh, surface, report);
    }
    mesh.triangles = std::move(surface.triangles);
    drop_isolated_vertices(mesh);  // those of the triangles left out
    report.duplicate_triangles = surface.copies;
    report.degenerate_triangles = surface.collapsed;
    add_area(mesh, report);
    for (std::size_t e = 0; e < surface.edges.size(); ++e) {
        report.non_manifold_edges += surface.edges[e].size() > 2 ? 1 : 0;
    }
    report.boundary_edges = count_boundary_edges(surface.edges);
    if (mesh.triangles.empty()) {
        report.fault = report.triangles == 0
                           ? Diagnostic{"mesh.empty", "no triangles: there is no surface to bound a solid"}
                           : Diagnostic{"mesh.no_volume",
                                        "no volume: the triangles have equal corners or cover each other from both "
                                        "sides"};
    }
    return std::move(surface.edges);
}

std::vector<Diagnostic> MeshReport::warnings() const {
    std::vector<Diagnostic> result;
    const auto add = [&](const char* code, std::int64_t count, std::string_view one, std::string_view many,
                         std::string_view what) {
        if (count > 0) {
            result.push_back({code, counted(count, one, many) + std::string(what)});
        }
    };
    add("mesh.isolated_vertices", isolated_vertices, "isolated vertex", "isolated vertices", " left out");
    add("mesh.duplicate_vertices", duplicate_vertices, "duplicate vertex", "duplicate vertices",
        weld_tolerance > 0.0 ? " welded, up to " + to_text(weld_tolerance) + " apart" : " welded");
    add("mesh.degenerate_triangles", degenerate_triangles, "degenerate triangle", "degenerate triangles",
        " (without area, or with two equal corners)");
    add("mesh.duplicate_triangles", duplicate_triangles, "duplicate triangle", "duplicate triangles", " left out");
    add("mesh.split_vertices", split_vertices, "non-manifold vertex", "non-manifold vertices", " split");
    add("mesh.reversed_triangles", reversed_triangles, "triangle", "triangles", " turned to agree with the neighbours");
    add("mesh.reversed_components", reversed_components, "inward-oriented component", "inward-oriented components",
        " turned outward");
    add("mesh.walls", wall_triangles, "triangle", "triangles", " of inner walls or fins left out");
    add("mesh.sheets", sheet_triangles, "triangle", "triangles",
        " of sheets left out, which have no inside: a thickness gives them one");
    if (!holes.empty()) {
        result.push_back({"mesh.holes",
                          counted(std::ssize(holes), "hole", "holes") + " closed, of " + percentage(hole_area(), area) +
                              " of the area; the widest, " + to_text(holes[0].width) + " across, at " +
                              to_text(holes[0].place),
                          "", -1, holes[0].place});
    }
    if (const double thickness = wall_thickness(*this); thickness > 0.0) {
        result.push_back(
            {.code = "mesh.shell",
             .message =
                 "the solid is a wall, " + to_text(thickness) +
                 " thick on average: if what it encloses is meant, wrap it by a ball that its holes do not let in",
             .hints = {{"solid", "wrap"}, {"opening", to_text(wrapping_opening(*this))}}});
    }
    add("mesh.non_manifold", non_manifold_edges, "edge", "edges", " with more than two triangles taken apart");
    add("mesh.self_intersections", self_intersections, "pair", "pairs",
        " of triangles that intersect: every point that the surface winds around counts as inside");
    return result;
}

RepairedMesh repair(TriangleMesh input, const Execution& execution) {
    return in_arena(execution, [&] {
        RepairedMesh result{std::move(input), {}};
        TriangleMesh& mesh = result.mesh;
        MeshReport& report = result.report;
        scaleaxis::report(execution, kRepairStage, 0.0);
        IndexLists edges = clean(mesh, report);
        if (report.fault.empty()) {
            scaleaxis::report(execution, kRepairStage, 0.4);
            std::vector<Index> opposite = opposite_sides(edges);
            Orientation orientation = orient(mesh.triangles, opposite);
            report.fault = find_topological_fault(mesh, report, orientation.one_sided);
            if (report.fault.empty() && !(report.is_closed() && report.is_manifold())) {
                report.reversed_triangles = reverse_marked(mesh.triangles, orientation.is_reversed);
                close(result);
                edges = sides_of_edges(mesh.triangles, mesh.vertices.size());
                opposite = paired_sides(mesh, edges);
                orientation = orient(mesh.triangles, opposite);
            }
            report.components = orientation.components;
            if (report.fault.empty()) {
                orient_and_split(mesh, orientation, std::move(opposite), report, execution);
            }
            const auto sides = static_cast<std::int64_t>(edges.items.size());
            report.euler = static_cast<std::int64_t>(mesh.vertices.size()) +
                           static_cast<std::int64_t>(mesh.triangles.size()) -
                           (report.fault.empty() ? sides / 2 : static_cast<std::int64_t>(edges.size()));
            if (report.fault.empty()) {
                report.genus = report.components - report.euler / 2;
                report.kind = SolidKind::kWinding;
                report.reason = reason_of(report);
            }
        }
        scaleaxis::report(execution, kRepairStage, 1.0);
        return result;
    });
}

RepairedMesh repair(const MeshView& mesh, const Execution& execution) {
    return repair(
        TriangleMesh{{mesh.vertices.begin(), mesh.vertices.end()}, {mesh.triangles.begin(), mesh.triangles.end()}},
        execution);
}

}  // namespace scaleaxis::inline v1
