// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "balls/union/union_complex.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis::inline v1 {

/// The Voronoi diagram of the boundary vertices inside the union. Its vertices are named by *centres*: a number below
/// that of the balls is the centre of that ball; the balls are followed by the centres of `spheres`.
struct InnerVoronoi {
    Index cells = 0;
    Index inside_cells = 0;  ///< with a centre inside the union, centres of balls included
    Index flat_cells = 0;
    std::vector<Circumsphere> spheres;           ///< of Delaunay cells
    IndexLists polygons;                         ///< convex, of three centres or more
    std::vector<std::array<Index, 2>> contacts;  ///< the two boundary vertices that each polygon is closest to
    std::vector<std::array<Index, 2>> edges;     ///< polygons that are a mere edge
    /// False if the labels contradict what must hold: rounding has moved a centre across the boundary.
    bool is_consistent = true;
};

InnerVoronoi inner_voronoi(const BoundaryVertices& vertices, const DualComplex& complex, std::span<const Ball> balls);

}  // namespace scaleaxis::inline v1
