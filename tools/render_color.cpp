// SPDX-License-Identifier: Apache-2.0
#include "render_color.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/sheet_color.hpp"

namespace scaleaxis::render {
namespace {

double srgb_of_linear(double value) {
    const double v = std::clamp(value, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
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
    const auto [r, g, b] = scaleaxis::sheet_color(sheet);
    return {static_cast<float>(srgb_of_linear(r)), static_cast<float>(srgb_of_linear(g)),
            static_cast<float>(srgb_of_linear(b))};
}

}  // namespace scaleaxis::render
