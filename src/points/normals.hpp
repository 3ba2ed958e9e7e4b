// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the neighbours of points tell about the surface that they were taken from. The only place that knows CGAL's
/// point-set processing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/point_tree.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// A quadric fitted to the nearest points of a point.
struct LocalFit {
    Point normal;           ///< at the point; of length 1, of either direction
    double residual = 0.0;  ///< standard deviation of the neighbours from the quadric
    double radius = 0.0;    ///< distance of the farthest neighbour
    double gap = 0.0;       ///< the largest angle, in the tangent plane, between neighbours next to each other; radians
};

/// \param neighbors how many nearest points to take, without the point itself; ≥ 3
LocalFit fit_locally(const kernel::PointTree& tree, const Point& p, std::size_t neighbors,
                     std::vector<kernel::NearPoint>& memory);

/// Parts of a point set whose normals have been made consistent, each on its own.
struct OrientedParts {
    std::vector<Index> part;  ///< #P
    Index count = 0;
};

/// Flips normals so that those of neighbours point to the same side (H. Hoppe and others, "Surface reconstruction from
/// unorganized points", 1992).
OrientedParts orient_consistently(std::span<const Point> points, std::vector<Point>& normals, std::size_t neighbors);

/// Do all points lie in a plane, to within rounding?
bool are_coplanar(std::span<const Point> points);

}  // namespace scaleaxis
