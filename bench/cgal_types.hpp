// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

inline Kernel::Point_3 to_cgal(const Point& p) { return {p.x, p.y, p.z}; }
inline Point from_cgal(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

inline std::vector<Kernel::Point_3> to_cgal(std::span<const Point> points) {
    std::vector<Kernel::Point_3> converted;
    converted.reserve(points.size());
    for (const Point& p : points) {
        converted.push_back(to_cgal(p));
    }
    return converted;
}

/// \param mesh a manifold, as `repair` returns it
inline SurfaceMesh to_cgal(const TriangleMesh& mesh) {
    SurfaceMesh converted;
    for (const Point& p : mesh.vertices) {
        converted.add_vertex(to_cgal(p));
    }
    for (const auto& t : mesh.triangles) {
        converted.add_face(SurfaceMesh::Vertex_index(t[0]), SurfaceMesh::Vertex_index(t[1]),
                           SurfaceMesh::Vertex_index(t[2]));
    }
    return converted;
}

}  // namespace scaleaxis::bench
