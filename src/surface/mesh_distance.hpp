// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scaleaxis/geometry.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis {

/// The point of the triangle `abc` that is nearest to `p`.
Point nearest_point(const Point& a, const Point& b, const Point& c, const Point& p);

/// Distance to the nearest triangle.
double distance_to_mesh(const Bvh& bvh, const Point& p);

}  // namespace scaleaxis
