// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 2: samples → union of balls, and operations on unions of balls.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"

namespace scaleaxis::inline v1 {

/// The inner polar balls of the samples (Amenta, Choi, Kolluri, "The power crust", 2001: the ball of the farthest
/// Voronoi vertex inside the solid), and those inner Voronoi balls that close the holes which the poles leave where the
/// solid is as thin as the samples are apart. Balls that differ by less than 1e-6 of the sampling tolerance are merged.
/// \returns in the order of their tetrahedra; empty if none lies inside
/// \throws Cancelled
SCALEAXIS_EXPORT std::vector<Ball> inner_balls(const Samples& samples, const Execution& execution = {});

/// The balls with all radii multiplied by a factor.
/// \param factor > 0 \throws InvalidOption
SCALEAXIS_EXPORT std::vector<Ball> scaled(std::span<const Ball> balls, double factor);

/// The balls in general position: every centre is moved in a direction that depends on the seed and the ball's position
/// in the array alone.
/// \param amount the largest move, relative to the ball's radius; ≥ 0 \throws InvalidOption
SCALEAXIS_EXPORT std::vector<Ball> perturbed(std::span<const Ball> balls, double amount, std::uint64_t seed);

/// Why the first that is none is no ball: a coordinate that is not finite, a radius that is not positive and finite.
/// Empty if all are balls.
SCALEAXIS_EXPORT Diagnostic find_bad_ball(std::span<const Ball> balls);

/// \throws UnusableInput with `find_bad_ball`, if that is not empty
SCALEAXIS_EXPORT void check_balls(std::span<const Ball> balls);

/// The balls validated and merged: of several that coincide only the first. Balls coincide if neither their centres nor
/// their radii differ by more than the smaller of 1e-9 of the diagonal of all balls and 1e-6 of the radius, plus the
/// rounding of their coordinates (9e-16 of them).
/// \throws UnusableInput as `check_balls`
SCALEAXIS_EXPORT std::vector<Ball> distinct_balls(std::span<const Ball> balls);

/// Their positions in the array, ascending.
/// \throws UnusableInput as `check_balls`
SCALEAXIS_EXPORT std::vector<Index> distinct_positions(std::span<const Ball> balls);

/// The box around the balls; empty if there are none.
SCALEAXIS_EXPORT Box bounds(std::span<const Ball> balls);

}  // namespace scaleaxis::inline v1
