// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far it is from a point in a solid to the boundary, all around in a plane.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Two directions that are normal to a vector and to each other.
std::array<Point, 2> normals_to(const Point& direction);

/// The distances to the boundary in `ways` directions in the plane normal to `direction`, at even angles; infinity
/// where the end of the way is inside. \param reaches lengths of the ways, ascending: the next is tried where one ends
/// inside
std::vector<double> ways_out(const Solid& solid, const Point& p, const Point& direction, int ways,
                             std::span<const double> reaches);

}  // namespace scaleaxis::inline v1
