// SPDX-License-Identifier: Apache-2.0
#include "spatial/weld.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/disjoint_sets.hpp"
#include "base/hash_table.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {
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

/// The same for whole numbers, whose last bits are all 0.
std::uint64_t hash_of_cell(const Point& cell) {
    std::uint64_t result = 0;
    for (const double coordinate : {cell.x, cell.y, cell.z}) {
        result = mixed(result + std::bit_cast<std::uint64_t>(coordinate + 0.0));
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
    // In cells so wide that few points are near the next one.
    const double width = 8.0 * tolerance;
    const Box box = box_around(points);
    const auto cell_of = [&](const Point& p) {
        const Point d = (1.0 / width) * (p - box.min);
        return Point{std::floor(d.x), std::floor(d.y), std::floor(d.z)};
    };
    struct Entry {
        Point cell;
        Index last = kNone;  ///< of the points in the cell
    };
    HashTable<Entry> table(points.size());
    const auto place_of = [&](const Point& cell) {
        return table.find(hash_of_cell(cell),
                          [&](const Entry& entry) { return entry.last == kNone || entry.cell == cell; });
    };
    const Point reach{tolerance, tolerance, tolerance};
    DisjointSets sets(points.size());
    std::vector<Index> previous(points.size(), kNone);  // in the same cell
    CancellationPoint stop(1 << 14);
    for (std::size_t i = 0; i < points.size(); ++i, stop()) {
        const Point low = cell_of(points[i] - reach);
        const Point high = cell_of(points[i] + reach);
        Point near = low;
        for (near.x = low.x; near.x <= high.x; ++near.x) {
            for (near.y = low.y; near.y <= high.y; ++near.y) {
                for (near.z = low.z; near.z <= high.z; ++near.z) {
                    for (Index j = table[place_of(near)].last; j != kNone; j = previous[j]) {
                        if (squared_distance(points[i], points[j]) <= tolerance * tolerance) {
                            sets.join(static_cast<Index>(i), j);
                        }
                    }
                }
            }
        }
        const Point cell = cell_of(points[i]);
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

}  // namespace scaleaxis::inline v1
