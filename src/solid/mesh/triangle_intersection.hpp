// SPDX-License-Identifier: Apache-2.0
/// \file
/// Do two triangles, or a triangle and a segment, have a point in common? Exact; both are closed.
#pragma once

#include <array>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

using Corners = std::array<Point, 3>;  ///< of a triangle
using Ends = std::array<Point, 2>;     ///< of a segment

/// \param a, b of finite coordinates, with an area
bool intersect(const Corners& a, const Corners& b);

/// \param t of finite coordinates, with an area \param s of finite coordinates, of different ends
bool intersect(const Corners& t, const Ends& s);

}  // namespace scaleaxis::inline v1
