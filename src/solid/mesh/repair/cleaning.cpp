// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/repair/cleaning.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "spatial/weld.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// Removes the triangles with two equal corners. Returns how many.
std::int64_t drop_collapsed_triangles(std::vector<Triangle>& triangles) {
    return static_cast<std::int64_t>(
        std::erase_if(triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }));
}

/// Triangles with the same three corners.
struct Copies {
    std::vector<char> is_extra;  ///< #F: has an earlier one the same corners?
    std::vector<Index> firsts;   ///< those that have copies
};

Copies find_copies(const std::vector<Triangle>& triangles, const IndexLists& edges) {
    Copies copies{std::vector<char>(triangles.size(), 0), {}};
    std::vector<std::array<Index, 2>> by_apex;
    CancellationPoint cancellation;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        cancellation();
        // Each triangle appears once: at the edge opposite to its largest corner.
        by_apex.clear();
        for (const Index s : edges[e]) {
            const Index apex = apex_of(triangles, s);
            if (apex > start_of(triangles, s) && apex > end_of(triangles, s)) {
                by_apex.push_back({apex, s / 3});
            }
        }
        std::ranges::sort(by_apex);
        for (std::size_t begin = 0, end = 0; begin < by_apex.size(); begin = end) {
            for (end = begin + 1; end < by_apex.size() && by_apex[end][0] == by_apex[begin][0]; ++end) {
                copies.is_extra[by_apex[end][1]] = 1;
            }
            if (end - begin > 1) {
                copies.firsts.push_back(by_apex[begin][1]);
            }
        }
    }
    return copies;
}

/// Which triangles to leave out as copies of others; see `clean_surface`.
std::vector<char> copies_to_drop(const std::vector<Triangle>& triangles, const IndexLists& edges) {
    auto [is_dropped, candidates] = find_copies(triangles, edges);
    if (candidates.empty()) {
        return std::move(is_dropped);
    }
    std::vector<Index> edge_of_side(edges.items.size());
    std::vector<Index> triangles_left(edges.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        for (const Index s : edges[e]) {
            edge_of_side[s] = static_cast<Index>(e);
            triangles_left[e] += is_dropped[s / 3] ? 0 : 1;
        }
    }
    const auto is_odd = [&](Index side) { return triangles_left[edge_of_side[side]] % 2 == 1; };
    std::vector<char> may_go(triangles.size(), 0);
    for (const Index t : candidates) {
        may_go[t] = 1;
    }
    std::vector<char> is_dropped_too = is_dropped;
    CancellationPoint cancellation;
    while (!candidates.empty()) {
        cancellation();
        const Index t = candidates.back();
        candidates.pop_back();
        if (!may_go[t] || !(is_odd(3 * t) || is_odd(3 * t + 1) || is_odd(3 * t + 2))) {
            continue;
        }
        may_go[t] = 0;
        is_dropped_too[t] = 1;
        for (const Index side : {3 * t, 3 * t + 1, 3 * t + 2}) {
            const std::size_t e = edge_of_side[side];
            --triangles_left[e];
            for (const Index s : edges[e]) {
                if (may_go[s / 3]) {
                    candidates.push_back(s / 3);
                }
            }
        }
    }
    const bool is_closed = std::ranges::all_of(triangles_left, [](Index count) { return count % 2 == 0; });
    return is_closed ? std::move(is_dropped_too) : std::move(is_dropped);
}

}  // namespace

std::int64_t drop_isolated_vertices(TriangleMesh& mesh) {
    std::vector<Index> position(mesh.vertices.size(), kNone);
    for (const Triangle& triangle : mesh.triangles) {
        for (const Index v : triangle) {
            position[v] = 0;
        }
    }
    std::size_t kept = 0;
    for (std::size_t v = 0; v < position.size(); ++v) {
        if (position[v] != kNone) {
            mesh.vertices[kept] = mesh.vertices[v];
            position[v] = static_cast<Index>(kept++);
        }
    }
    for (Triangle& triangle : mesh.triangles) {
        for (Index& v : triangle) {
            v = position[v];
        }
    }
    const auto dropped = static_cast<std::int64_t>(mesh.vertices.size() - kept);
    mesh.vertices.resize(kept);
    return dropped;
}

CleanSurface clean_surface(std::vector<Triangle> triangles, std::size_t vertex_count) {
    CleanSurface surface;
    surface.collapsed = drop_collapsed_triangles(triangles);
    surface.edges = sides_of_edges(triangles, vertex_count);
    const std::vector<char> is_dropped = copies_to_drop(triangles, surface.edges);
    surface.copies = std::ranges::count(is_dropped, 1);
    if (surface.copies > 0) {
        erase_marked(triangles, is_dropped);
        surface.edges = sides_of_edges(triangles, vertex_count);
    }
    surface.triangles = std::move(triangles);
    return surface;
}

std::int64_t weld_boundary(TriangleMesh& mesh, const CleanSurface& surface, double tolerance) {
    stop_if_cancelled();
    std::vector<char> is_boundary(mesh.vertices.size(), 0);
    for (std::size_t e = 0; e < surface.edges.size(); ++e) {
        if (surface.edges[e].size() == 1) {
            is_boundary[start_of(surface.triangles, surface.edges[e][0])] = 1;
            is_boundary[end_of(surface.triangles, surface.edges[e][0])] = 1;
        }
    }
    std::vector<Index> vertices;
    std::vector<Point> points;
    for (std::size_t v = 0; v < is_boundary.size(); ++v) {
        if (is_boundary[v]) {
            vertices.push_back(static_cast<Index>(v));
            points.push_back(mesh.vertices[v]);
        }
    }
    if (vertices.empty()) {
        return 0;
    }
    const std::vector<Index> place = weld(points, tolerance);
    stop_if_cancelled();
    std::vector<Index> at_place(points.size(), kNone);
    std::vector<Index> replacement(mesh.vertices.size());
    std::iota(replacement.begin(), replacement.end(), 0);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        Index& first = at_place[place[i]];
        first = first == kNone ? vertices[i] : first;
        replacement[vertices[i]] = first;
    }
    for (Triangle& triangle : mesh.triangles) {
        for (Index& v : triangle) {
            v = replacement[v];
        }
    }
    return static_cast<std::int64_t>(vertices.size() - points.size());
}

}  // namespace scaleaxis::inline v1
