// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points at the same place, or nearly so, become one.
#pragma once

#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Removes all points but the first at each place; the others stay in order. Returns the new position of each.
std::vector<Index> weld(std::vector<Point>& points);

/// The same for points that are up to a tolerance apart, or connected by others that are. \param tolerance ≥ 0; not
/// less than 1e-12 of the diagonal of the points, unless 0
std::vector<Index> weld(std::vector<Point>& points, double tolerance);

}  // namespace scaleaxis::inline v1
