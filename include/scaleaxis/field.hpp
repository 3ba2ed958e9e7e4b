// SPDX-License-Identifier: Apache-2.0
/// \file
/// The implicit form of a union of balls as an image.
#pragma once

#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis::inline v1 {

/// The signed distance (`BallUnion::signed_distances`) on a cubic grid around the union. The outermost two points on
/// each side lie outside of the balls' box, so that the surface of value 0 is closed.
/// \param resolution number of points along the longest side, at least 8
/// \returns 32-bit values, in units of the balls
/// \throws UnusableInput (the union is empty), InvalidOption (resolution out of range, or more than 2^38 points),
///     Cancelled
SCALEAXIS_EXPORT Image signed_distance_image(const BallUnion& balls, Index resolution, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
