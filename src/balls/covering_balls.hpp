// SPDX-License-Identifier: Apache-2.0
/// \file
/// As many balls as their union needs.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/fit.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The largest balls first, those without which some of the points would be farther than `reach` from the union of the
/// others taken so far: their positions, ascending. Points that no ball comes as near to do not count.
std::vector<Index> covering_balls(std::span<const Ball> balls, std::span<const Point> points, double reach);

/// Of fitted balls those at some positions, with the statistics of all.
FittedBalls selected(const FittedBalls& fitted, std::span<const Index> positions);

}  // namespace scaleaxis::inline v1
