// SPDX-License-Identifier: Apache-2.0
/// \file
/// Angles by sums, products, quotients and square roots alone, which are the same on all platforms: the trigonometric
/// functions of C libraries differ in the last bit, as do those of powers.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Cosine of 26 degrees: directions that differ by less are the same. An edge goes on where the way to its next place
/// differs by less from it: a rim of a radius of two tolerances turns by less, and an edge beside it that is as far as
/// the step is not in the way. Parts of a wall, of its rim, or of a curve, which differ by less where they meet, are
/// one: half of a bend that a shell can take.
inline constexpr double kSameDirection = 0.9;

/// A vector of length 1 at right angles to another one, which is not 0.
inline Point any_normal_to(const Point& v) {
    const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
    return unit(cross(v, x <= y && x <= z ? Point{1, 0, 0} : y <= z ? Point{0, 1, 0} : Point{0, 0, 1}));
}

/// Two unit vectors at right angles to a third one and to each other.
inline std::array<Point, 2> across(const Point& direction) {
    const Point other = std::abs(direction.x) < 0.6 ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0};
    const Point first = unit(cross(direction, other));
    return {first, cross(direction, first)};
}

/// Cosine and sine of a number of right angles, and `x` more: up to pi/4.
inline std::array<double, 2> on_circle(double quarters, double x) {
    constexpr int kMostPower = 17;  // powers above are below the last bit
    constexpr auto kInverse = [] {
        std::array<double, kMostPower> inverse{};
        for (int k = 1; k < kMostPower; ++k) {
            inverse[k] = 1.0 / (k * (k + 1));
        }
        return inverse;
    }();
    double cosine = 1.0;
    double sine = 1.0;
    for (int k = kMostPower - 1; k > 0; k -= 2) {
        cosine = 1.0 - x * x * kInverse[k - 1] * cosine;
        sine = 1.0 - x * x * kInverse[k] * sine;
    }
    sine *= x;
    switch (static_cast<int>(std::fmod(quarters, 4.0)) & 3) {
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

/// Cosine and sine of an angle in full turns.
inline std::array<double, 2> on_circle(double turns) {
    const double quarters = std::floor(4.0 * turns + 0.5);
    return on_circle(quarters, 2.0 * std::numbers::pi * (turns - 0.25 * quarters));
}

/// Cosine and sine of an angle in radians.
inline std::array<double, 2> at_angle(double radians) {
    // A right angle in three parts; products of the first two with numbers up to 2^20 are exact.
    constexpr std::array<double, 3> kQuarter{0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};
    if (!(std::abs(radians) < 1e6)) {
        radians = std::isfinite(radians) ? std::fmod(radians, 2.0 * std::numbers::pi) : 0.0 * radians;
        if (std::isnan(radians)) {
            return {radians, radians};
        }
    }
    const double quarters = std::floor(radians / (0.5 * std::numbers::pi) + 0.5);
    return on_circle(quarters, radians - quarters * kQuarter[0] - quarters * kQuarter[1] - quarters * kQuarter[2]);
}

inline double cosine_of(double radians) { return at_angle(radians)[0]; }
inline double cosine_of_degrees(double degrees) { return on_circle(degrees / 360.0)[0]; }

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

/// The same below the x axis: (-pi, pi].
inline double signed_angle_of(double x, double y) { return y < 0.0 ? -angle_of(x, -y) : angle_of(x, y); }

/// The angle with a cosine in [-1, 1], in radians.
inline double angle_of_cosine(double cosine) { return angle_of(cosine, std::sqrt((1.0 - cosine) * (1.0 + cosine))); }

}  // namespace scaleaxis::inline v1
