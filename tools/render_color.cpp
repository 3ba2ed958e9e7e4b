// SPDX-License-Identifier: Apache-2.0
#include "render_color.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace scaleaxis::render {
namespace {

double srgb_of_linear(double value) {
    const double v = std::clamp(value, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

/// A colour of the perceptual space OKLab (Ottosson, "A perceptual color space for image processing", 2020) by its
/// lightness, chroma and hue (in turns).
Color oklch(double lightness, double chroma, double hue) {
    const double a = chroma * std::cos(2.0 * std::numbers::pi * hue);
    const double b = chroma * std::sin(2.0 * std::numbers::pi * hue);
    const auto cube = [](double x) { return x * x * x; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    return {static_cast<float>(srgb_of_linear(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s)),
            static_cast<float>(srgb_of_linear(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s)),
            static_cast<float>(srgb_of_linear(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s))};
}

}  // namespace

double on_scale(double value, double end) { return value > 0.0 ? std::min(value / end, 1.0) : 0.0; }

Color viridis(double t) {
    // Nine of its colours, at equal distances; linear in between is closer than the eye sees.
    static constexpr std::array<std::array<int, 3>, 9> kStops{{{68, 1, 84},
                                                               {71, 45, 123},
                                                               {59, 82, 139},
                                                               {44, 114, 142},
                                                               {33, 145, 140},
                                                               {40, 174, 128},
                                                               {94, 201, 98},
                                                               {173, 220, 48},
                                                               {253, 231, 37}}};
    const double position = std::clamp(t, 0.0, 1.0) * (kStops.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
    const auto stop = [](const std::array<int, 3>& c) {
        return (1.0F / 255.0F) * Color{static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
    };
    return mix(stop(kStops[i]), stop(kStops[i + 1]), static_cast<float>(position - static_cast<double>(i)));
}

Color sheet_color(Index sheet) {
    // Multiples of the golden ratio fill the circle evenly, whatever the number of sheets.
    const double turns = static_cast<double>(sheet) / std::numbers::phi;
    return oklch(0.77, 0.115, 0.72 + turns - std::floor(turns));
}

}  // namespace scaleaxis::render
