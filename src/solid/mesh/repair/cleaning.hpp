// SPDX-License-Identifier: Apache-2.0
/// \file
/// Makes of a list of triangles the surface that is meant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "solid/mesh/triangle_edges.hpp"

namespace scaleaxis::inline v1 {

/// Removes the vertices that no triangle has. Returns how many.
std::int64_t drop_isolated_vertices(TriangleMesh& mesh);

/// Triangles with three different corners, none twice, and their edges.
struct CleanSurface {
    std::vector<Triangle> triangles;
    IndexLists edges;
    std::int64_t collapsed = 0;  ///< triangles that were left out because of equal corners
    std::int64_t copies = 0;     ///< and as copies
};

/// Leaves out triangles with two equal corners, and of those that have the same three corners as many as it takes.
///
/// A copy too many is one thing (leave it out). A wall between two parts of the solid, or a fin, which has a triangle
/// for either side, is another (leave both out). So one of each is kept at first; those that had copies then go, too,
/// as long as an edge of theirs has an odd number of triangles. If that does not close the surface, they stay.
CleanSurface clean_surface(std::vector<Triangle> triangles, std::size_t vertex_count);

/// Makes one vertex of the ends of boundary edges that lie at the same place, or up to a tolerance apart. Returns how
/// many others that leaves unused. \param surface of the triangles of `mesh`
std::int64_t weld_boundary(TriangleMesh& mesh, const CleanSurface& surface, double tolerance = 0.0);

}  // namespace scaleaxis::inline v1
