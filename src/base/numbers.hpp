// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbers by name, the one in the middle, and zeros.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace scaleaxis::inline v1 {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();
inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< in radians

/// Relative errors: of lengths computed in double precision, some thousand roundings of 1e-16 and the cancellation in
/// squares; and of coordinates from files of single precision, as STL, where places as near to each other are the same.
inline constexpr double kRelativeRounding = 1e-9;
inline constexpr double kFileRounding = 1e-6;

/// Part of a length, or of a weight, that makes no difference to whoever reads a result: searches end there, and what
/// is nearer than this part of the way is there. Ten times as much would be seen: a wall could miss its limit by a
/// percent. A tenth of it costs searches more steps for digits that nobody reads.
inline constexpr double kNegligible = 1e-3;

/// Up to here all whole numbers are floats: labels beyond it are not told apart.
inline constexpr float kMostExactFloat = 0x1p24F;

/// Where a x² + 2 half_b x + c is 0, without cancellation; one of the places is infinite if a is 0. Nothing where there
/// are not two.
inline std::optional<std::array<double, 2>> quadratic_zeros(double a, double half_b, double c) {
    const double discriminant = half_b * half_b - a * c;
    if (!(discriminant > 0.0)) {
        return std::nullopt;
    }
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    return std::array{q / a, c / q};
}

/// The larger of two in the middle. \param values not empty
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace scaleaxis::inline v1
