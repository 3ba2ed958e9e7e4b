// SPDX-License-Identifier: Apache-2.0
/// \file
/// Components of a surface, and which way they face.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "solid/mesh/triangle_edges.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// Connected components, and what it takes to orient each coherently.
struct Orientation {
    std::vector<Index> component;   ///< #F
    std::vector<char> is_reversed;  ///< #F; to be turned: the minority in its component
    Index components = 0;
    Index one_sided = kNone;  ///< a triangle of a component that cannot be oriented
};

/// \param opposite see `opposite_sides`
Orientation orient(const std::vector<Triangle>& triangles, const std::vector<Index>& opposite);

/// Turns a triangle over. Its sides have other numbers then.
inline void reverse(Triangle& triangle) { std::swap(triangle[1], triangle[2]); }

/// Gives every fan of triangles around a vertex a vertex of its own. Returns the number of vertices with several fans.
/// The surface has to be closed, manifold at the edges and coherently oriented.
std::int64_t split_vertices(TriangleMesh& mesh, const std::vector<Index>& opposite);

/// The signed volume within each component of a closed and coherently oriented surface.
std::vector<double> component_volumes(const TriangleMesh& mesh, const Orientation& orientation);

/// For each component, does it lie within a solid that others bound? 1: yes; -1: yes, and these are oriented inward;
/// 0: no, or only in part. A cavity may touch or overlap other cavities, and lie against the boundary of the solid.
/// \param bvh of the mesh, which is closed \param volumes of the components
std::vector<int> sides_within_others(const Bvh& bvh, const TriangleMesh& mesh, const Orientation& orientation,
                                     std::span<const double> volumes);

/// Turns inward-oriented components outward. A component within the solid that others bound is a cavity or an
/// inclusion, and is turned only together with them. Returns how many were turned.
/// \param bvh of the mesh
std::int64_t turn_outward(TriangleMesh& mesh, const Orientation& orientation, const Bvh& bvh);

}  // namespace scaleaxis::inline v1
