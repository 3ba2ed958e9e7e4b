// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stage 2: samples → union of balls, and operations on unions of balls.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"

namespace scaleaxis {

/// The inner polar balls of the samples (Amenta, Choi, Kolluri, "The power crust", 2001: the ball of the farthest
/// Voronoi vertex inside the shape), and those inner Voronoi balls that close the holes which the poles leave where the
/// solid is as thin as the samples are apart. Coinciding balls are merged.
std::vector<Ball> inner_balls(const Samples& samples, const Execution& execution = {});

/// Balls with all radii multiplied by `factor` (> 0).
std::vector<Ball> scaled(std::span<const Ball> balls, double factor);

/// Balls with every centre moved by at most `amount` × its radius, in a direction that depends on `seed` and the ball's
/// position in the array alone. Brings the balls into general position.
std::vector<Ball> perturbed(std::span<const Ball> balls, double amount, std::uint64_t seed);

/// \throws UnusableShape naming the first ball that has a NaN, an infinite coordinate or a radius that is not positive
void check_balls(std::span<const Ball> balls);

/// Balls of positive finite radius, coinciding ones (to 1e-9 of the diagonal of the centres' and radii's box) once.
/// \throws UnusableShape naming the first ball that has a NaN, an infinite coordinate or a radius that is not positive
std::vector<Ball> cleaned(std::span<const Ball> balls);

/// The box around the balls.
Box bounds(std::span<const Ball> balls);

}  // namespace scaleaxis
