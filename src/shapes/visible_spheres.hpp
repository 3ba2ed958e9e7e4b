// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// Random points on the parts of the spheres that no other ball covers: about one for each `area`, evenly spread, and
/// some on every ball that lies alone, however small. Parts smaller than `area` may get none.
/// \param neighbors in the power diagram of the balls
std::vector<Point> visible_points(std::span<const Ball> balls, const IndexLists& neighbors, double area,
                                  std::uint64_t seed);

}  // namespace scaleaxis
