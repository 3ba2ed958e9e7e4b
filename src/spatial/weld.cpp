// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/weld.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace scaleaxis {
namespace {

/// A hash of the coordinates, spread over all 64 bits; -0 and 0 are the same.
std::uint64_t hash(const Point& p) {
    std::uint64_t result = 0;
    for (const double coordinate : {p.x, p.y, p.z}) {
        result = (result ^ std::bit_cast<std::uint64_t>(coordinate + 0.0)) * 0x9E3779B97F4A7C15u;
        result ^= result >> 32;
    }
    return result;
}

}  // namespace

std::vector<Index> weld(std::vector<Point>& points) {
    // An open hash table of positions among the points kept.
    std::vector<Index> table(std::bit_ceil(2 * points.size() + 1), kNone);
    const std::uint64_t mask = table.size() - 1;
    std::vector<Index> position(points.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::uint64_t slot = hash(points[i]) & mask;
        while (table[slot] != kNone && points[table[slot]] != points[i]) {
            slot = (slot + 1) & mask;
        }
        if (table[slot] == kNone) {
            table[slot] = static_cast<Index>(kept);
            points[kept++] = points[i];
        }
        position[i] = table[slot];
    }
    points.resize(kept);
    return position;
}

}  // namespace scaleaxis
