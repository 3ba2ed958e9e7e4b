// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/triangulation.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// The dual complex of a union of balls: the simplices of the regular triangulation whose balls have a common point in
/// their common power cell (Edelsbrunner, "The union of balls and its dual shape", 1995; the alpha complex at α = 0).
/// It has the homotopy type of the union.
struct DualComplex {
    Triangulation triangulation;
    std::vector<std::uint8_t> has_cell;                ///< #C; 1 if the tetrahedron belongs to the complex
    std::vector<std::uint8_t> facets;                  ///< #C; bit `k`: the facet opposite to vertex `k` does
    std::vector<std::array<Index, 2>> edges;           ///< all its edges
    std::vector<std::array<Index, 2>> singular_edges;  ///< those without a triangle
    std::vector<Index> singular_vertices;              ///< its vertices without an edge
    Index hidden_balls = 0;                            ///< balls that the regular triangulation does not have
    Index tetrahedra = 0;
    Index triangles = 0;
    Index vertices = 0;
    Topology topology;
    Point origin;  ///< where the triangulation's origin lies
};

DualComplex dual_complex(std::span<const Ball> balls);

/// \param triangulation the regular one of the balls
DualComplex dual_complex(Triangulation triangulation, std::span<const Ball> balls);

}  // namespace scaleaxis::inline v1
