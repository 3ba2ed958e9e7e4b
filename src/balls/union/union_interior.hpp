// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far the boundary of a union of balls is, and where, asked from inside near its medial axis.
#pragma once

#include <optional>

#include "balls/union/union_boundary.hpp"
#include "balls/union/union_complex.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {

/// A union of balls consists of its dual complex and of what joins that to the boundary: every vertex of the boundary
/// with a triangle, every arc with an edge, every patch of a sphere with its centre (Edelsbrunner, "The union of balls
/// and its dual shape", 1995). In such a join it is that vertex, arc or patch to which a point is nearest, and in the
/// dual complex a vertex.
struct UnionInterior {
    const UnionComplex& complex;
    const UnionAdjacency& adjacency;
    BallTree balls;      ///< of the balls of the complex
    PointTree vertices;  ///< of the boundary; empty if there are none
};

/// \param complex, adjacency must outlive the result
UnionInterior union_interior(const UnionComplex& complex, const UnionAdjacency& adjacency);

/// The point of the boundary of the union nearest to `p`. Nothing if `p` lies outside, or (hardly ever) in a join with
/// an arc that is not looked at: arcs of the balls of the nearest vertex and of the deepest ball are. Two queries of a
/// tree and a walk in the triangulation, where `nearest_point` of a `UnionBoundary` looks at many patches near the
/// medial axis.
std::optional<NearBoundaryPoint> nearest_from_inside(const UnionInterior& interior, const Point& p);

}  // namespace scaleaxis::inline v1
