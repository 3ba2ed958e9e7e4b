// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {

inline Point nearest_on_segment(const Point& a, const Point& b, const Point& p) {
    const Point d = b - a;
    const double square = squared_norm(d);
    return square > 0.0 ? a + std::clamp(dot(p - a, d) / square, 0.0, 1.0) * d : a;
}

inline double triangle_area(const Point& a, const Point& b, const Point& c) { return 0.5 * norm(cross(b - a, c - a)); }

inline double triangle_area(const TriangleMesh& mesh, const std::array<Index, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    return triangle_area(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
}

/// "mesh.not_finite": that a vertex has a coordinate that is not usable.
inline Diagnostic bad_vertex(Index vertex) {
    return {"mesh.not_finite", "vertex " + std::to_string(vertex) + " (counted from 0) " + kUnusableCoordinate,
            "vertex", vertex};
}

/// "mesh.no_such_vertex": the first triangle with a vertex that the mesh does not have; empty if there is none.
inline Diagnostic find_bad_triangle(const TriangleMesh& mesh) {
    const auto vertex_count = static_cast<Index>(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const Index v : mesh.triangles[t]) {
            if (v < 0 || v >= vertex_count) {
                return {"mesh.no_such_vertex",
                        "triangle " + std::to_string(t) + " (counted from 0) refers to vertex " + std::to_string(v) +
                            ", which does not exist",
                        "triangle", static_cast<std::int64_t>(t)};
            }
        }
    }
    return {};
}

/// \throws UnusableInput with `find_bad_triangle`, if that is not empty
inline void check_triangles(const TriangleMesh& mesh) {
    if (Diagnostic fault = find_bad_triangle(mesh); !fault.empty()) {
        throw UnusableInput(std::move(fault));
    }
}

/// \throws UnusableInput as `check_triangles`, and with `bad_vertex` if a vertex is not finite
inline void check_mesh(const TriangleMesh& mesh) {
    check_triangles(mesh);
    const auto bad = std::ranges::find_if_not(mesh.vertices, is_finite);
    if (bad != mesh.vertices.end()) {
        throw UnusableInput(bad_vertex(static_cast<Index>(bad - mesh.vertices.begin())));
    }
}

/// The vertices of a surface, joined into its connected parts.
inline DisjointSets parts_of(const TriangleMesh& mesh) {
    DisjointSets parts(mesh.vertices.size());
    for (const auto& [u, v, w] : mesh.triangles) {
        parts.join(u, v);
        parts.join(u, w);
    }
    return parts;
}

}  // namespace scaleaxis::inline v1
