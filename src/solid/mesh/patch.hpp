// SPDX-License-Identifier: Apache-2.0
/// \file
/// A patch for a hole.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "solid/mesh/triangle_edges.hpp"

namespace scaleaxis {

/// Triangles without new vertices that a closed loop of at least three vertices bounds: of least area if there are no
/// more than some hundred; of a longer loop, corners with little area are cut off first (G. Barequet, M. Sharir,
/// "Filling gaps in the boundary of a polyhedron", 1995).
std::vector<Triangle> patch_of(const std::vector<Point>& vertices, std::span<const Index> loop);

}  // namespace scaleaxis
