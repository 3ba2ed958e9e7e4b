// SPDX-License-Identifier: Apache-2.0
/// \file
/// A patch for a hole.
#pragma once

#include <vector>

#include "scaleaxis/geometry.hpp"
#include "solid/mesh/triangle_edges.hpp"

namespace scaleaxis::inline v1 {

/// A closed loop of at least three vertices.
struct Loop {
    std::vector<Index> corners;
    std::vector<Index> apexes;  ///< the third corner of the triangle beyond the side from each corner to the next
};

/// Triangles without new vertices that a loop bounds: of least area and least bent, within and against the triangles
/// beyond (after G. Barequet, M. Sharir, "Filling gaps in the boundary of a polyhedron", 1995, and P. Liepa, "Filling
/// holes in meshes", 2003). Of a loop of more than some hundred corners those with little area are cut off first.
std::vector<Triangle> patch_of(const std::vector<Point>& vertices, const Loop& loop);

}  // namespace scaleaxis::inline v1
