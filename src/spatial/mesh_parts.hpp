// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "base/disjoint_sets.hpp"
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
