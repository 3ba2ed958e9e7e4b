// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernel/disjoint_sets.hpp"
#include "scaleaxis/mesh.hpp"
#include "shapes/mesh_cleaning.hpp"
#include "shapes/mesh_orientation.hpp"
#include "shapes/self_intersections.hpp"
#include "shapes/triangle_edges.hpp"

namespace scaleaxis {
namespace {

// Below this part of the largest coordinate, differences of coordinates have too few digits left.
constexpr double kSmallestRelativeSize = 1e-9;
// Products of five lengths, as the predicates form them, have to stay within the range of a double.
constexpr double kSmallestSize = 1e-40;
constexpr double kLargestSize = 1e40;
// Below this mean thickness relative to the diagonal, the volume is rounding error.
constexpr double kSmallestRelativeThickness = 1e-12;

std::string counted(std::int64_t count, std::string_view one, std::string_view many) {
    return std::to_string(count) + ' ' + std::string(count == 1 ? one : many);
}

std::string to_text(const Point& p) {
    std::string result = "(";
    for (const double coordinate : {p.x, p.y, p.z}) {
        constexpr int kDigits = 9;
        std::array<char, 32> digits;
        const auto end =
            std::to_chars(digits.begin(), digits.end(), coordinate, std::chars_format::general, kDigits).ptr;
        result.append(digits.begin(), end).append(" ");
    }
    result.back() = ')';
    return result;
}

/// Why the arrays are no mesh at all; empty if they are.
std::string find_bad_data(const TriangleMesh& mesh) {
    constexpr std::size_t kMostTriangles = std::numeric_limits<Index>::max() / 3;
    if (mesh.triangles.size() > kMostTriangles) {
        return "too many triangles: " + std::to_string(mesh.triangles.size()) + "; reduce them to " +
               std::to_string(kMostTriangles);
    }
    const auto vertex_count = static_cast<Index>(mesh.vertices.size());
    for (Index v = 0; v < vertex_count; ++v) {
        if (!is_finite(mesh.vertices[v])) {
            return "vertex " + std::to_string(v) + " (counted from 0) has a coordinate that is not a finite number";
        }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const Index v : mesh.triangles[t]) {
            if (v < 0 || v >= vertex_count) {
                return "triangle " + std::to_string(t) + " (counted from 0) refers to vertex " + std::to_string(v) +
                       ", which does not exist";
            }
        }
    }
    return {};
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

/// The edge that comes first in the order of the triangles among those with a number of triangles that `is_meant`
/// takes.
template <class Predicate>
std::string first_edge(const TriangleMesh& mesh, const IndexLists& edges, const Predicate& is_meant) {
    Index first = std::numeric_limits<Index>::max();
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (is_meant(edges[e].size())) {
            first = std::min(first, edges[e][0]);
        }
    }
    return "the first from " + to_text(mesh.vertices[start_of(mesh.triangles, first)]) + " to " +
           to_text(mesh.vertices[end_of(mesh.triangles, first)]);
}

/// The number of connected pieces of the boundary.
std::int64_t count_loops(const std::vector<Triangle>& triangles, const IndexLists& edges, std::size_t vertex_count) {
    DisjointSets pieces(vertex_count);
    std::vector<char> is_met(vertex_count, 0);
    std::int64_t loops = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges[e].size() != 1) {
            continue;
        }
        const Index a = start_of(triangles, edges[e][0]);
        const Index b = end_of(triangles, edges[e][0]);
        for (const Index v : {a, b}) {
            loops += is_met[v] ? 0 : 1;
            is_met[v] = 1;
        }
        loops -= pieces.join(a, b) ? 1 : 0;
    }
    return loops;
}

/// Why the surface has no inside; empty if it has one.
std::string find_topological_fault(const TriangleMesh& mesh, const IndexLists& edges, const MeshReport& report,
                                   Index one_sided) {
    if (mesh.triangles.empty()) {
        return report.triangles == 0
                   ? "no triangles: there is no surface to bound a solid"
                   : "no volume: the triangles have equal corners or cover each other from both sides";
    }
    std::string fault;
    const auto add = [&](const std::string& text) { fault += (fault.empty() ? "" : "; ") + text; };
    if (report.non_manifold_edges > 0) {
        add("non-manifold: " + counted(report.non_manifold_edges, "edge", "edges") + " with more than two triangles, " +
            first_edge(mesh, edges, [](std::size_t triangles) { return triangles > 2; }) +
            "; remove inner walls, and separate parts that share an edge");
    }
    if (report.boundary_edges > 0) {
        add("open: " + counted(report.boundary_edges, "boundary edge", "boundary edges") + " in " +
            counted(count_loops(mesh.triangles, edges, mesh.vertices.size()), "loop", "loops") + ", " +
            first_edge(mesh, edges, [](std::size_t triangles) { return triangles == 1; }) + "; close the holes");
    }
    if (one_sided != kNone) {
        add("one-sided: the surface through " + to_text(mesh.vertices[mesh.triangles[one_sided][0]]) +
            " cannot be oriented; cut it, or remove it");
    }
    return fault;
}

/// Why a closed surface bounds no solid that can be computed with; empty if it does.
std::string find_metric_fault(const MeshReport& report, const std::vector<double>& volumes) {
    const double diagonal = report.bounds.diagonal();
    const Point& low = report.bounds.min;
    const Point& high = report.bounds.max;
    const double farthest = std::max(
        {std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y), std::abs(high.z)});
    if (diagonal == 0.0) {
        return "no extent: all vertices lie at " + to_text(low);
    }
    if (diagonal < kSmallestRelativeSize * farthest) {
        return "too far from the origin for its size: the coordinates of its vertices, near " + to_text(low) +
               ", have too few digits to tell them apart; translate the model to the origin before it is saved";
    }
    if (!(diagonal > kSmallestSize && diagonal < kLargestSize)) {
        return "too small or too large to compute with, from " + to_text(low) + " to " + to_text(high) +
               "; scale the model";
    }
    double volume = 0.0;
    for (const double volume_of_component : volumes) {
        volume += std::abs(volume_of_component);
    }
    if (volume <= kSmallestRelativeThickness * report.area * diagonal) {
        return "no volume: the surface encloses nothing; give it a thickness";
    }
    return {};
}

}  // namespace

std::vector<std::string> MeshReport::warnings() const {
    std::vector<std::string> lines;
    const auto add = [&](std::int64_t count, std::string_view one, std::string_view many, std::string_view what) {
        if (count > 0) {
            lines.push_back(counted(count, one, many) + std::string(what));
        }
    };
    add(isolated_vertices, "isolated vertex", "isolated vertices", " left out");
    add(duplicate_vertices, "duplicate vertex", "duplicate vertices", " welded");
    add(degenerate_triangles, "degenerate triangle", "degenerate triangles",
        " (without area, or with two equal corners)");
    add(duplicate_triangles, "duplicate triangle", "duplicate triangles", " left out");
    add(split_vertices, "non-manifold vertex", "non-manifold vertices", " split");
    add(reversed_triangles, "triangle", "triangles", " turned to agree with the neighbours");
    add(reversed_components, "inward-oriented component", "inward-oriented components", " turned outward");
    add(self_intersections, "pair", "pairs",
        " of triangles that intersect: every point that the surface winds around counts as inside");
    return lines;
}

RepairedMesh repair(TriangleMesh mesh, const Execution& execution) {
    MeshReport report;
    report.vertices = static_cast<std::int64_t>(mesh.vertices.size());
    report.triangles = static_cast<std::int64_t>(mesh.triangles.size());
    report.fault = find_bad_data(mesh);
    if (!report.fault.empty()) {
        return {std::move(mesh), std::move(report)};
    }
    report.isolated_vertices = drop_isolated_vertices(mesh);
    for (const Point& p : mesh.vertices) {
        report.bounds.extend(p);
    }

    Surface surface = clean_surface(mesh.triangles, mesh.vertices.size());
    report.duplicate_vertices = weld_boundary(mesh, surface);
    if (report.duplicate_vertices > 0) {
        surface = clean_surface(mesh.triangles, mesh.vertices.size());
    }
    mesh.triangles = std::move(surface.triangles);
    drop_isolated_vertices(mesh);  // those of the triangles left out
    report.duplicate_triangles = surface.copies;
    report.degenerate_triangles = surface.collapsed;
    add_area(mesh, report);
    const IndexLists& edges = surface.edges;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        report.boundary_edges += edges[e].size() == 1 ? 1 : 0;
        report.non_manifold_edges += edges[e].size() > 2 ? 1 : 0;
    }

    std::vector<Index> opposite = opposite_sides(edges);
    const Orientation orientation = orient(mesh.triangles, opposite);
    report.components = orientation.components;
    report.fault = find_topological_fault(mesh, edges, report, orientation.one_sided);
    if (report.fault.empty()) {
        report.reversed_triangles = reverse_marked(mesh.triangles, orientation.is_reversed);
        report.reversed_components = turn_outward(mesh, orientation);
        const std::vector<double> volumes = component_volumes(mesh, orientation);
        report.volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
        report.fault = find_metric_fault(report, volumes);
    }
    if (report.fault.empty()) {
        // Before the fans of a vertex are taken apart: they touch there, but do not intersect.
        report.self_intersections = count_self_intersections(mesh, execution);
        if (report.reversed_triangles > 0 || report.reversed_components > 0) {  // their sides have other numbers now
            opposite = opposite_sides(sides_of_edges(mesh.triangles, mesh.vertices.size()));
        }
        report.split_vertices = split_vertices(mesh, opposite);
    }
    report.euler = static_cast<std::int64_t>(mesh.vertices.size()) - static_cast<std::int64_t>(edges.size()) +
                   static_cast<std::int64_t>(mesh.triangles.size());
    report.genus = report.fault.empty() ? report.components - report.euler / 2 : 0;
    return {std::move(mesh), std::move(report)};
}

}  // namespace scaleaxis
