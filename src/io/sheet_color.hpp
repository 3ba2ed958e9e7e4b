// SPDX-License-Identifier: Apache-2.0
/// \file
/// The colours of sheets, in files and pictures.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// A colour of the perceptual space OKLab (Ottosson, "A perceptual color space for image processing", 2020) by its
/// lightness, chroma and hue (in turns), as linear red, green and blue.
inline std::array<double, 3> oklch(double lightness, double chroma, double hue) {
    const double a = chroma * std::cos(2.0 * std::numbers::pi * hue);
    const double b = chroma * std::sin(2.0 * std::numbers::pi * hue);
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

}  // namespace scaleaxis
