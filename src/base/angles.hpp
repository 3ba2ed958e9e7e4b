// SPDX-License-Identifier: Apache-2.0
/// \file
/// Angles by sums, products, quotients and square roots alone, which are the same on all platforms: the trigonometric
/// functions of C libraries differ in the last bit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace scaleaxis::inline v1 {

/// Cosine and sine of an angle in full turns, ≥ 0.
inline std::array<double, 2> on_circle(double turns) {
    const double quarters = std::floor(4.0 * turns + 0.5);
    const double x = 2.0 * std::numbers::pi * (turns - 0.25 * quarters);  // up to pi/4
    double cosine = 1.0;
    double sine = 1.0;
    for (int k = 16; k > 0; k -= 2) {  // powers above x^17 are below the last bit
        cosine = 1.0 - x * x / ((k - 1) * k) * cosine;
        sine = 1.0 - x * x / (k * (k + 1)) * sine;
    }
    sine *= x;
    switch (static_cast<int>(quarters) % 4) {
        case 0:
            return {cosine, sine};
        case 1:
            return {-sine, cosine};
        case 2:
            return {-cosine, -sine};
        default:
            return {sine, -cosine};
    }
}

/// The angle between (x, y) and the x axis, in radians, [0, pi]; 0 of (0, 0). \param y ≥ 0
inline double angle_of(double x, double y) {
    const double largest = std::max(std::abs(x), y);
    if (!(largest > 0.0)) {
        return 0.0;
    }
    const bool is_steep = y > std::abs(x);
    double tangent = std::min(std::abs(x), y) / largest;
    for (int i = 0; i < 2; ++i) {
        tangent /= 1.0 + std::sqrt(1.0 + tangent * tangent);  // of half the angle: at last up to 0.2
    }
    double sum = 0.0;
    for (int k = 25; k > 0; k -= 2) {  // powers above 0.2^25 are below the last bit
        sum = 1.0 / k - tangent * tangent * sum;
    }
    const double part = 4.0 * tangent * sum;
    const double angle = is_steep ? 0.5 * std::numbers::pi - part : part;
    return x < 0.0 ? std::numbers::pi - angle : angle;
}

/// The angle with a cosine in [-1, 1], in radians.
inline double angle_of_cosine(double cosine) { return angle_of(cosine, std::sqrt((1.0 - cosine) * (1.0 + cosine))); }

}  // namespace scaleaxis::inline v1
