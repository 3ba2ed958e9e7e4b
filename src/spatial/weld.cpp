// SPDX-License-Identifier: Apache-2.0
#include "spatial/weld.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

#include "base/hash_table.hpp"
#include "base/parallel.hpp"

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
    HashTable<Index> table(points.size(), kNone);  // positions among the points kept
    std::vector<Index> position(points.size());
    std::size_t kept = 0;
    CancellationPoint stop(1 << 16);
    for (std::size_t i = 0; i < points.size(); ++i, stop()) {
        const auto is_end = [&](Index other) { return other == kNone || points[other] == points[i]; };
        Index& other = table[table.find(hash(points[i]), is_end)];
        if (other == kNone) {
            other = static_cast<Index>(kept);
            points[kept++] = points[i];
        }
        position[i] = other;
    }
    points.resize(kept);
    return position;
}

}  // namespace scaleaxis
