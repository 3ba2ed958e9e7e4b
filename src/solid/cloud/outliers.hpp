// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points of a cloud that belong to no surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Which points are so far from most others that in a tree of all these would fall into few boxes? To find neighbours
/// would take time quadratic in their number.
std::vector<std::uint8_t> find_far_points(std::span<const Point> points);

/// Which points lie apart from the surface that the others describe? Suspected are points whose neighbours are much
/// farther away than these have theirs (density relative to that of the neighbours, as by M. M. Breunig and others,
/// "LOF", 2000), points in places as thinly filled as few others that lie in no surface, and points whose distance from
/// the quadric through their neighbours is far above that of these (T. Weyrich and others, "Post-processing of scanned
/// 3D surface data", 2004). They are outliers if the points that are above suspicion say so: if these are far away, or
/// their surface is.
/// \param points distinct ones
/// \param given of these `points` were thinned, or the same: they tell how dense the points were
/// \param neighbors as many look like a piece of a surface; see `fit_locally`
std::vector<std::uint8_t> find_outliers(const std::vector<Point>& points, const std::vector<Point>& given,
                                        std::size_t neighbors);

}  // namespace scaleaxis::inline v1
