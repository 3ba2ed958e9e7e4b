// SPDX-License-Identifier: Apache-2.0
#include "spatial/weld.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/disjoint_sets.hpp"
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

std::vector<Index> weld(std::vector<Point>& points, double tolerance) {
    if (!(tolerance > 0.0)) {
        return weld(points);
    }
    // In cells as wide as the tolerance, so that neighbours are in neighbouring ones.
    const auto cell_of = [&](const Point& p) {
        return Point{std::floor(p.x / tolerance), std::floor(p.y / tolerance), std::floor(p.z / tolerance)};
    };
    struct Entry {
        Point cell;
        Index last = kNone;  ///< of the points in the cell
    };
    HashTable<Entry> table(points.size());
    const auto place_of = [&](const Point& cell) {
        return table.find(hash(cell), [&](const Entry& entry) { return entry.last == kNone || entry.cell == cell; });
    };
    DisjointSets sets(points.size());
    std::vector<Index> previous(points.size(), kNone);  // in the same cell
    CancellationPoint stop(1 << 14);
    for (std::size_t i = 0; i < points.size(); ++i, stop()) {
        const Point cell = cell_of(points[i]);
        for (int k = 0; k < 27; ++k) {
            const Point near = cell + Point{k % 3 - 1.0, k / 3 % 3 - 1.0, k / 9 - 1.0};
            for (Index j = table[place_of(near)].last; j != kNone; j = previous[j]) {
                if (squared_distance(points[i], points[j]) <= tolerance * tolerance) {
                    sets.join(static_cast<Index>(i), j);
                }
            }
        }
        Entry& entry = table[place_of(cell)];
        previous[i] = entry.last;
        entry = {cell, static_cast<Index>(i)};
    }
    std::vector<Index> position(points.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Index first = sets.find(static_cast<Index>(i));
        if (first == static_cast<Index>(i)) {
            points[kept] = points[i];
            position[i] = static_cast<Index>(kept++);
        } else {
            position[i] = position[first];
        }
    }
    points.resize(kept);
    return position;
}

}  // namespace scaleaxis
