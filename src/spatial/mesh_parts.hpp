// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/disjoint_sets.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"

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

/// \throws UnusableInput if a triangle has a vertex that the mesh does not have
inline void check_triangles(const TriangleMesh& mesh) {
    const auto count = static_cast<Index>(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (std::ranges::any_of(mesh.triangles[t], [&](Index v) { return v < 0 || v >= count; })) {
            throw UnusableInput(Diagnostic{"mesh.no_vertex",
                                           "triangle " + std::to_string(t + 1) + " of " +
                                               std::to_string(mesh.triangles.size()) +
                                               " has a vertex that the mesh does not have",
                                           "triangle", static_cast<std::int64_t>(t + 1)});
        }
    }
}

/// \throws UnusableInput as `check_triangles`, and if a vertex is not finite
inline void check_mesh(const TriangleMesh& mesh) {
    check_triangles(mesh);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Point& p = mesh.vertices[v];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            throw UnusableInput(Diagnostic{"mesh.not_finite",
                                           "vertex " + std::to_string(v + 1) + " of " +
                                               std::to_string(mesh.vertices.size()) +
                                               " has a coordinate that is not a finite number",
                                           "vertex", static_cast<std::int64_t>(v + 1)});
        }
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
