// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the seeds of all solids have in common.
#pragma once

#include <limits>
#include <string>

#include "base/faults.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Seeds for each square of the spacing, on solids made of balls. With half as many again there are as many samples in
/// the end, and with fewer more that are asked for one by one.
inline constexpr double kSeedsOfBalls = 6.0;

/// \throws InvalidOption if `count` seeds are more than there are indices
inline void check_number_of_seeds(double count) {
    constexpr Index kMost = std::numeric_limits<Index>::max();
    require(count < kMost, "too many samples: the surface would take more than " + std::to_string(kMost) +
                               " seeds; choose a larger tolerance");
}

}  // namespace scaleaxis::inline v1
