// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points at exactly the same place become one.
#pragma once

#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// Removes all points but the first at each place; the others stay in order. Returns the new position of each.
std::vector<Index> weld(std::vector<Point>& points);

}  // namespace scaleaxis
