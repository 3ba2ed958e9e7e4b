// SPDX-License-Identifier: Apache-2.0
/// \file
/// Makes a surface with holes, walls and edges of many triangles the closed boundary of a solid.
///
/// Every side of a triangle is an arrow. Where arrows cancel at each edge, the surface winds around every point a whole
/// number of times, however many triangles meet there. Arrows that do not cancel make up rims, since at each vertex as
/// many come in as go out; so a patch for each rim closes any surface.
#pragma once

#include <cstdint>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/mesh.hpp"
#include "solid/mesh/triangle_edges.hpp"

namespace scaleaxis::inline v1 {

struct Closing {
    std::vector<Hole> holes;            ///< the widest first
    std::int64_t wall_triangles = 0;    ///< left out
    std::int64_t sheet_triangles = 0;   ///< of sheets beside parts with an inside, left out
    std::int64_t turned_triangles = 0;  ///< of parts that faced away from the outside
    std::vector<Triangle> left_out;     ///< those of walls and sheets
    std::vector<Triangle> open;         ///< the triangles before there were patches
};

/// Turns open parts outward, as seen from outside, leaves out walls between parts and sheets beside them, and closes
/// all holes.
/// \param mesh every part that is connected across edges of two triangles oriented coherently
/// \returns the mesh with its arrows in balance at every edge
Closing close_holes(TriangleMesh& mesh);

/// For each side the one that follows across its edge; of several the first on the way around it through what is
/// inside, so that four triangles are the edges of two parts that touch. \pre arrows are in balance at every edge
std::vector<Index> paired_sides(const TriangleMesh& mesh, const IndexLists& edges);

}  // namespace scaleaxis::inline v1
