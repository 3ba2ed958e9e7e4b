// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far the boundary of a union of balls is, asked from inside near its medial axis.
#pragma once

#include <optional>
#include <vector>

#include "kernel/ball_tree.hpp"
#include "kernel/point_tree.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

/// A union of balls consists of its dual complex and of what joins that to the boundary: every vertex of the boundary
/// with a triangle, every arc with an edge, every patch of a sphere with its centre (Edelsbrunner, "The union of balls
/// and its dual shape", 1995). In such a join it is that vertex, arc or patch to which a point is nearest, and in the
/// dual complex a vertex.
struct UnionInterior {
    const MedialAxis& axis;
    IndexLists neighbors;       ///< of each ball: in the dual complex
    std::vector<Index> single;  ///< balls without any, ascending
    kernel::BallTree balls;
    kernel::PointTree vertices;  ///< of the boundary; empty if there are none
};

/// \param axis must outlive the result
UnionInterior union_interior(const MedialAxis& axis);

/// The distance from `p` to the boundary of the union. Nothing if `p` lies outside, or (hardly ever) in a join with an
/// arc that is not looked at: arcs of the balls of the nearest vertex and of the deepest ball are.
std::optional<double> distance_to_boundary(const UnionInterior& interior, const Point& p);

}  // namespace scaleaxis
