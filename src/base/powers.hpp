// SPDX-License-Identifier: Apache-2.0
/// \file
/// Powers and logarithms, which are the same on all platforms, as in angles.hpp; correct but for the last bits.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

namespace scaleaxis::inline v1 {

// ln 2 in two parts; products of the first with numbers up to 2^11 are exact.
inline constexpr double kLn2 = 0x1.62e42fefa38p-1;
inline constexpr double kLn2Rest = 0x1.ef35793c7673p-45;

/// The area hyperbolic tangent of a number up to 0.2.
inline double small_artanh(double x) {
    double sum = 0.0;
    for (int k = 23; k > 0; k -= 2) {  // powers above 0.2^23 are below the last bit
        sum = 1.0 / k + x * x * sum;
    }
    return x * sum;
}

/// e^x
inline double exponential(double x) {
    if (!(x > -746.0)) {
        return std::isnan(x) ? x : 0.0;
    }
    if (x > 710.0) {
        return std::numeric_limits<double>::infinity();
    }
    const double twos = std::floor(x / std::numbers::ln2 + 0.5);
    const double rest = x - twos * kLn2 - twos * kLn2Rest;  // up to ln 2 / 2
    double sum = 1.0;
    for (int k = 14; k > 0; --k) {  // powers above are below the last bit
        sum = 1.0 + rest * sum / k;
    }
    return std::ldexp(sum, static_cast<int>(twos));
}

/// The natural logarithm.
inline double logarithm(double x) {
    if (!(x > 0.0)) {
        return x == 0.0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    }
    if (std::isinf(x)) {
        return x;
    }
    int twos = 0;
    double part = std::frexp(x, &twos);
    if (part < 0.5 * std::numbers::sqrt2) {
        part *= 2.0;
        --twos;
    }
    return twos * kLn2 + (2.0 * small_artanh((part - 1.0) / (part + 1.0)) + twos * kLn2Rest);
}

/// base^exponent; NaN of a base below 0 and a broken exponent
inline double power(double base, double exponent) {
    constexpr double kMostFactors = 64.0;  // until products round more than logarithms
    if (std::abs(exponent) <= kMostFactors && exponent == std::floor(exponent)) {
        double product = 1.0;
        double square = base;
        for (auto rest = static_cast<int>(std::abs(exponent)); rest > 0; rest /= 2, square *= square) {
            product *= rest % 2 != 0 ? square : 1.0;
        }
        return exponent < 0.0 ? 1.0 / product : product;
    }
    if (base < 0.0 && exponent == std::floor(exponent)) {
        const double size = exponential(exponent * logarithm(-base));
        return std::fmod(exponent, 2.0) != 0.0 ? -size : size;
    }
    return base == 1.0 ? 1.0 : exponential(exponent * logarithm(base));
}

inline double cube_root(double x) {
    if (x == 0.0 || !std::isfinite(x)) {
        return x;
    }
    const double size = std::abs(x);
    const double root = exponential(logarithm(size) / 3.0);
    return std::copysign(root - (root - size / (root * root)) / 3.0, x);
}

}  // namespace scaleaxis::inline v1
