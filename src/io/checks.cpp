// SPDX-License-Identifier: Apache-2.0
#include "io/checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/faults.hpp"
#include "base/text.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::io {
namespace {

[[noreturn]] void fail(const char* kind, std::size_t i, std::size_t count, const std::string& what) {
    throw bad_value(std::string(kind) + ' ' + std::to_string(i + 1) + " of " + std::to_string(count) + ' ' + what, kind,
                    static_cast<std::int64_t>(i + 1));
}

bool is_vertex(Index v, std::size_t vertex_count) { return v >= 0 && static_cast<std::size_t>(v) < vertex_count; }

std::string no_such_vertex(std::size_t vertex_count) {
    return "refers to a vertex that does not exist (there are " + std::to_string(vertex_count) + "); export it again";
}

/// No face has a corner twice, and no two have the same corners.
void check_distinct(IndexLists faces) {
    const std::size_t count = faces.size();
    const auto corners = [&](std::size_t f) {
        return std::span(faces.items).subspan(faces.offsets[f], faces[f].size());
    };
    std::vector<std::size_t> order(count);
    for (std::size_t f = 0; f < count; ++f) {
        order[f] = f;
        std::ranges::sort(corners(f));
        if (std::ranges::adjacent_find(corners(f)) != corners(f).end()) {
            fail("face", f, count, "has a corner twice; remove it");
        }
    }
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return std::ranges::lexicographical_compare(corners(a), corners(b));
    });
    for (std::size_t k = 1; k < count; ++k) {
        if (std::ranges::equal(corners(order[k - 1]), corners(order[k]))) {
            fail("face", order[k], count, "has the same corners as another; remove one of them");
        }
    }
}

}  // namespace

void check_vertices(std::span<const Point> vertices) {
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (!is_usable(vertices[v])) {
            fail("vertex", v, vertices.size(), kUnusableCoordinate);
        }
    }
}

void check_polygons(const IndexLists& polygons, std::size_t vertex_count) {
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        if (polygons[f].size() < 3) {
            fail("face", f, polygons.size(), "has fewer than three corners; remove it");
        }
        if (!std::ranges::all_of(polygons[f], [&](Index v) { return is_vertex(v, vertex_count); })) {
            fail("face", f, polygons.size(), no_such_vertex(vertex_count));
        }
    }
}

void check_axis(const MedialComplex& complex) {
    const std::size_t vertices = complex.vertices.size();
    check_vertices(complex.vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        if (!(complex.radii[v] >= 0.0) || !(complex.radii[v] <= kLargestCoordinate)) {
            fail("vertex", v, vertices,
                 "has the radius " + to_text(complex.radii[v]) + ", which is not a finite number from 0 to 1e18");
        }
    }
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        const auto& [a, b] = complex.edges[e];
        if (!is_vertex(a, vertices) || !is_vertex(b, vertices)) {
            fail("edge", e, complex.edges.size(), no_such_vertex(vertices));
        }
        if (a == b) {
            fail("edge", e, complex.edges.size(), "joins a vertex with itself; remove it");
        }
    }
    const std::size_t faces = complex.faces.size();
    check_polygons(complex.faces, vertices);
    check_distinct(complex.faces);
    for (std::size_t f = 0; f < complex.face_sheets.size(); ++f) {
        if (complex.face_sheets[f] < 0 || static_cast<std::size_t>(complex.face_sheets[f]) >= faces) {
            fail("face", f, faces, "has a sheet that is not a number from 0 up and below that of the faces");
        }
    }
    for (std::size_t f = 0; f < complex.face_angles.size(); ++f) {
        if (!std::isfinite(complex.face_angles[f])) {
            fail("face", f, faces, "has an angle that is not a finite number");
        }
    }
}

}  // namespace scaleaxis::io
