// SPDX-License-Identifier: Apache-2.0
/// \file
/// Colours and how values become colours.
#pragma once

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::render {

/// An sRGB colour, each part 0…1.
struct Color {
    float r = 0.0F;
    float g = 0.0F;
    float b = 0.0F;
};

constexpr Color operator*(float s, const Color& c) { return {s * c.r, s * c.g, s * c.b}; }
constexpr Color operator+(const Color& a, const Color& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
constexpr Color operator-(const Color& a, const Color& b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
constexpr Color mix(const Color& a, const Color& b, float t) { return a + t * (b - a); }

inline constexpr Color kWhite{1.0F, 1.0F, 1.0F};

/// Where `value` lies between 0 and `end`, as 0…1; 0 if that cannot be said.
double on_scale(double value, double end);

/// The colour map viridis (Smith and van der Walt, 2015) at `t`, 0…1.
Color viridis(double t);

/// A hue for sheet `sheet`: all of the same lightness and chroma, those of near numbers far apart.
Color sheet_color(Index sheet);

}  // namespace scaleaxis::render
