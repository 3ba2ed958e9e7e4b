// SPDX-License-Identifier: Apache-2.0
/// \file
/// Balls in parts that are too thin for the samples.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/fit.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Those amid balls much smaller than the tolerance that touch the boundary on opposite sides, up to where the part
/// joins a thick one. Their radii become half the thickness there, which samples are to follow.
/// \param contacts #B
std::vector<Ball> thin_balls(std::span<const Ball> balls, std::span<const Contacts> contacts, double tolerance);

}  // namespace scaleaxis::inline v1
