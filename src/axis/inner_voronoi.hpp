// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/spheres.hpp"
#include "medial_axis/dual_complex.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// The vertices of the boundary of a union of balls: where three spheres meet that no ball covers.
struct BoundaryVertices {
    std::vector<Point> points;
    std::vector<std::array<Index, 3>> balls;  ///< the three, ascending
    /// Triangles of the dual complex on both sides of which there is no tetrahedron of it: they have two boundary
    /// vertices, and are faces of the medial axis themselves.
    std::vector<std::array<Index, 2>> pairs;
};

BoundaryVertices boundary_vertices(const DualComplex& complex, std::span<const Ball> balls);

/// The boundary vertices on each ball.
IndexLists vertices_of_balls(const BoundaryVertices& vertices, std::size_t balls);

/// The Voronoi diagram of the boundary vertices inside the union. Its vertices are named by *centres*: a number below
/// that of the balls is the centre of that ball; the balls are followed by the centres of `spheres`.
struct InnerVoronoi {
    Index cells = 0;
    Index inside_cells = 0;  ///< with a centre inside the union, centres of balls included
    Index flat_cells = 0;
    std::vector<kernel::Circumsphere> spheres;   ///< of Delaunay cells
    IndexLists polygons;                         ///< convex, of three centres or more
    std::vector<std::array<Index, 2>> contacts;  ///< the two boundary vertices that each polygon is closest to
    std::vector<std::array<Index, 2>> edges;     ///< polygons that are a mere edge
    /// False if the labels contradict what must hold: rounding has moved a centre across the boundary.
    bool is_consistent = true;
};

InnerVoronoi inner_voronoi(const BoundaryVertices& vertices, const DualComplex& complex, std::span<const Ball> balls);

}  // namespace scaleaxis
