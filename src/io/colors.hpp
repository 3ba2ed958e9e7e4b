// SPDX-License-Identifier: Apache-2.0
/// \file
/// The colours of sheets and of values in files.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "base/angles.hpp"
#include "base/powers.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// A colour of the perceptual space OKLab (Ottosson, "A perceptual color space for image processing", 2020) by its
/// lightness, chroma and hue (in turns), as linear red, green and blue.
inline std::array<double, 3> oklch(double lightness, double chroma, double hue) {
    const auto [cosine, sine] = on_circle(hue);
    const double a = chroma * cosine;
    const double b = chroma * sine;
    const auto cube = [](double x) { return x * x * x; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

/// A hue for each sheet, all of one lightness and chroma: multiples of the golden ratio fill the circle evenly,
/// whatever the number of sheets.
inline std::array<double, 3> sheet_color(Index sheet) {
    const double turns = static_cast<double>(sheet) / std::numbers::phi;
    return oklch(0.77, 0.115, 0.72 + turns - std::floor(turns));
}

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
    const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * power(c, 1.0 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(255.0 * s));
}

}  // namespace scaleaxis::inline v1
