// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernel/ball_tree.hpp"
#include "kernel/box_tree.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// The boundary of a union of balls: patches of spheres, which meet in arcs of circles, which meet in vertices.
struct UnionBoundary {
    struct Circle {
        Point center;
        Point normal;  ///< of length 1
        double radius = 0.0;
        std::array<Index, 2> balls{};
    };

    kernel::BallTree balls;
    std::vector<Circle> circles;  ///< those that are partly visible, in the order of the leaves
    kernel::BoxTree circle_tree;  ///< no nodes where there are no circles
    std::vector<Point> vertices;  ///< likewise
    kernel::BoxTree vertex_tree;
};

/// \param balls in general position
UnionBoundary union_boundary(std::span<const Ball> balls);

/// Distance to the nearest point of the boundary, for points inside and outside.
double distance_to_boundary(const UnionBoundary& boundary, const Point& p);

}  // namespace scaleaxis
