// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The boundary of a union of balls, to ask for distances from inside.
#pragma once

#include <vector>

#include "kernel/box_tree.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

/// The boundary consists of patches, one for each ball that no other balls cover (not always connected). What bounds a
/// patch are arcs of the circles with neighbors, which are the other ends of edges of the dual complex, and vertices.
struct UnionBoundary {
    std::vector<Ball> balls;
    IndexLists neighbors;          ///< of each ball
    std::vector<Point> vertices;   ///< where three spheres meet that no ball covers
    IndexLists vertices_of_balls;  ///< of each ball
    std::vector<Index> patches;    ///< the balls with a patch, in the order of the tree's boxes
    kernel::BoxTree tree;          ///< boxes around the patches
};

/// Of the union of `axis.balls`.
UnionBoundary union_boundary(const MedialAxis& axis);

/// How far the boundary is from `p`.
double distance_to(const UnionBoundary& boundary, const Point& p);

}  // namespace scaleaxis
