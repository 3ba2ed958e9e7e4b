// SPDX-License-Identifier: Apache-2.0
/// \file
/// A signed distance on a cubic grid.
#pragma once

#include <functional>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis::inline v1 {

/// The signed distance of a point, if it is less than a limit; else the limit.
using DistanceWithin = std::function<double(const Point& p, double limit)>;

/// See `signed_distance_image`. \param box around what the distance is to
Image distance_image(const Box& box, Index resolution, const DistanceWithin& distance, const Execution& execution);

}  // namespace scaleaxis::inline v1
