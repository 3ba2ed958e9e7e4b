// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random numbers that are a pure function of their position, the same for any number of threads, and points.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/angles.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// A well-mixed function of 64 bits (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
constexpr std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
}

/// Number `k` of the stream that belongs to element `i` under this seed.
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t i, std::uint64_t k = 0) {
    return mixed(mixed(mixed(seed) + i) + k);
}

/// The same, uniform in [0, 1).
constexpr double random_unit(std::uint64_t seed, std::uint64_t i, std::uint64_t k = 0) {
    return static_cast<double>(random_bits(seed, i, k) >> 11) * 0x1p-53;
}

/// A point of the cube within the unit ball, for element `i`.
inline Point random_direction(std::uint64_t seed, std::uint64_t i) {
    const auto coordinate = [&](std::uint64_t k) { return 2.0 * random_unit(seed, i, k) - 1.0; };
    return (1.0 / std::sqrt(3.0)) * Point{coordinate(0), coordinate(1), coordinate(2)};
}

/// Direction `k` of element `i`, uniform on the unit sphere.
inline Point random_unit_vector(std::uint64_t seed, std::uint64_t i, std::uint64_t k) {
    const double z = 2.0 * random_unit(seed, i, 2 * k) - 1.0;
    const auto [cosine, sine] = on_circle(random_unit(seed, i, 2 * k + 1));
    const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {across * cosine, across * sine, z};
}

/// A point of the triangle `abc`, uniform if `x` and `y` are, in [0, 1).
inline Point point_of_triangle(const Point& a, const Point& b, const Point& c, double x, double y) {
    if (x + y > 1.0) {
        x = 1.0 - x;
        y = 1.0 - y;
    }
    return a + x * (b - a) + y * (c - a);
}

}  // namespace scaleaxis::inline v1
