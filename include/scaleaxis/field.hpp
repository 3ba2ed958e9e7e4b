// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The implicit form of a union of balls: its signed distance, for many points at once and as an image.
///
/// The signed distance is the least of |p - centre| - radius over all balls: negative inside, 0 on the boundary.
/// Outside it is the distance to the union. Inside its magnitude is at most the distance to the boundary: it is the
/// depth in the one ball in which `p` is deepest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis {

struct NearestBall {
    Index ball = kNone;
    double distance = 0.0;  ///< signed
};

/// For each point the ball to which the signed distance is least (of several the first). That is the signed distance of
/// the union, and the point lies in the union where it is not positive.
/// \throws UnusableShape if there are no balls, or naming the first that is none (see `cleaned`)
std::vector<NearestBall> nearest_balls(std::span<const Ball> balls, std::span<const Point> points,
                                       const Execution& execution = {});

/// The signed distance of the union on a grid around it, with `resolution` points along the longest side. The outermost
/// two points on each side lie outside of the balls' box.
/// \param resolution at least 8
/// \throws UnusableShape, InvalidOption, Cancelled
Image signed_distance_image(std::span<const Ball> balls, Index resolution, const Execution& execution = {});

}  // namespace scaleaxis
