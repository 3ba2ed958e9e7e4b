// SPDX-License-Identifier: Apache-2.0
/// \file
/// The boundary of a union of balls, to ask for distances.
#pragma once

#include <limits>
#include <vector>

#include "balls/union/union_complex.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/box_tree.hpp"

namespace scaleaxis::inline v1 {

/// The boundary consists of patches, one for each ball that is not covered by others (not always connected), of arcs
/// between them on the circles of two balls, and of vertices at their ends. An arc and a vertex are looked for with the
/// patch of the first of their balls alone.
struct UnionBoundary {
    const UnionComplex& complex;
    const UnionAdjacency& adjacency;
    struct Patch {
        Index ball;
        Box box;
    };
    std::vector<Patch> patches;  ///< in the order of the tree's leaves
    IndexLists arcs;             ///< of each patch: the neighbors on the other side
    IndexLists ends;             ///< of each patch: vertices
    BoxTree tree;                ///< boxes around the patches
};

/// \param complex, adjacency must outlive the result
UnionBoundary union_boundary(const UnionComplex& complex, const UnionAdjacency& adjacency);

struct NearBoundaryPoint {
    Point point;  ///< meaningful if the distance is finite
    double distance = std::numeric_limits<double>::infinity();
};

/// The point of the boundary nearest to `p`, which may lie inside or outside; nothing (at an infinite distance) if none
/// is closer than `bound`. Of several always the same one.
NearBoundaryPoint nearest_point(const UnionBoundary& boundary, const Point& p,
                                double bound = std::numeric_limits<double>::infinity());

}  // namespace scaleaxis::inline v1
