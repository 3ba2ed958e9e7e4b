// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random and degenerate sets of points.
#pragma once

#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

using Points = std::vector<Point>;

inline std::mt19937_64 seeded(std::uint64_t seed) {
    std::cout << "seed " << seed << '\n';
    return std::mt19937_64(seed);
}

inline Points in_cube(std::size_t count, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Points points(count);
    for (Point& p : points) {
        p = {uniform(random), uniform(random), uniform(random)};
    }
    return points;
}

inline Points on_unit_sphere(std::size_t count, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Points points(count);
    for (Point& p : points) {
        p = {normal(random), normal(random), normal(random)};
        p = (1 / norm(p)) * p;
    }
    return points;
}

inline Points on_bumpy_surface(std::size_t count, std::mt19937_64& random) {
    Points points = on_unit_sphere(count, random);
    for (Point& p : points) {
        p = (1 + 0.3 * std::sin(5 * p.x) * std::cos(4 * p.y + 1) + 0.2 * std::sin(7 * p.z)) * p;
    }
    return points;
}

/// Points of small integer coordinates: all kinds of degeneracy, and duplicates when there are more points than places.
inline Points on_grid(std::size_t count, int side, std::mt19937_64& random) {
    std::uniform_int_distribution<int> uniform(0, side - 1);
    Points points(count);
    for (Point& p : points) {
        p = {1.0 * uniform(random), 1.0 * uniform(random), 1.0 * uniform(random)};
    }
    return points;
}

/// The 30 integer points at distance 3 from the origin: exactly cospherical.
inline Points on_integer_sphere() {
    Points points;
    for (int x = -3; x <= 3; ++x) {
        for (int y = -3; y <= 3; ++y) {
            for (int z = -3; z <= 3; ++z) {
                if (x * x + y * y + z * z == 9) {
                    points.push_back({1.0 * x, 1.0 * y, 1.0 * z});
                }
            }
        }
    }
    return points;
}

inline Points transformed(Points points, double scale, const Point& offset) {
    for (Point& p : points) {
        p = scale * p + offset;
    }
    return points;
}

}  // namespace scaleaxis
