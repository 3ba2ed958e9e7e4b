// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbers by name.
#pragma once

#include <limits>
#include <numbers>

namespace scaleaxis {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();
inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< in radians

}  // namespace scaleaxis
