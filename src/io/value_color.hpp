// SPDX-License-Identifier: Apache-2.0
/// \file
/// The colours of values, in files.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "io/sheet_color.hpp"

namespace scaleaxis {

/// Linear red, green and blue of each value: from red, the least, over yellow and green to blue, the largest, all of
/// about one lightness. Values that are not finite are grey.
inline std::vector<std::array<double, 3>> value_colors(std::span<const double> values) {
    constexpr double kFirstHue = 0.08;
    constexpr double kLastHue = 0.72;
    double least = std::numeric_limits<double>::infinity();
    double largest = -least;
    for (const double value : values) {
        if (std::isfinite(value)) {
            least = std::min(least, value);
            largest = std::max(largest, value);
        }
    }
    std::vector<std::array<double, 3>> colors;
    for (const double value : values) {
        const double part = largest > least ? (value - least) / (largest - least) : 0.5;
        colors.push_back(std::isfinite(part) ? oklch(0.7, 0.13, kFirstHue + (kLastHue - kFirstHue) * part)
                                             : oklch(0.7, 0.0, 0.0));
    }
    return colors;
}

/// A part of linear light, 0…1, as a byte of sRGB.
inline unsigned char srgb_byte(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(255.0 * s));
}

}  // namespace scaleaxis
