// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The boundary of a union of balls, to ask for distances.
#pragma once

#include <vector>

#include "kernel/box_tree.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// The boundary consists of patches, one for each ball that is not covered by others (not always connected), of arcs
/// between them on the circles of two balls, and of vertices at their ends. An arc and a vertex are looked for with the
/// patch of the first of their balls alone.
struct UnionBoundary {
    std::vector<Ball> balls;
    IndexLists neighbors;         ///< of each ball: in the dual complex
    std::vector<Point> vertices;  ///< where three spheres meet that no ball covers
    struct Patch {
        Index ball;
        Box box;
    };
    std::vector<Patch> patches;  ///< in the order of the tree's leaves
    IndexLists arcs;             ///< of each patch: the neighbors on the other side
    IndexLists ends;             ///< of each patch: vertices
    kernel::BoxTree tree;        ///< boxes around the patches
};

/// \param balls in general position
UnionBoundary union_boundary(std::vector<Ball> balls);

/// How far the boundary is from `p`.
double distance_to(const UnionBoundary& boundary, const Point& p);

}  // namespace scaleaxis
