// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/polygon_mesh.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "io/checks.hpp"
#include "surface/polygon_triangles.hpp"

namespace scaleaxis::io {

void add_strip(std::span<const Index> strip, IndexLists& triangles) {
    for (std::size_t i = 2; i < strip.size(); ++i) {
        const bool is_turned = i % 2 != 0;
        const Index a = strip[i - (is_turned ? 1 : 2)];
        const Index b = strip[i - (is_turned ? 2 : 1)];
        const Index c = strip[i];
        const bool is_damaged = a == kNone || b == kNone || c == kNone;
        if (is_damaged || (a != b && b != c && c != a)) {
            triangles.push_back(std::array{a, b, c});
        }
    }
}

TriangleMesh triangulated(PolygonMesh mesh) {
    check_vertices(mesh.vertices);
    check_polygons(mesh.polygons, mesh.vertices.size());
    TriangleMesh result;
    result.triangles.reserve(mesh.polygons.items.size() - 2 * mesh.polygons.size());
    for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
        triangulate(mesh.vertices, mesh.polygons[f], result.triangles);
    }
    result.vertices = std::move(mesh.vertices);
    return result;
}

}  // namespace scaleaxis::io
