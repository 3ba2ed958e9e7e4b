// SPDX-License-Identifier: Apache-2.0
#include "io/polygon_mesh.hpp"

#include <utility>

#include "io/checks.hpp"
#include "surface/polygon_triangles.hpp"

namespace scaleaxis::io {

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
