// SPDX-License-Identifier: Apache-2.0
#include "spatial/spatial_order.hpp"

#include <bit>
#include <utility>

#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "base/random.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {

namespace {

constexpr int kBits = 21;

/// Position along the Hilbert curve through the cube of side 2^21 (J. Skilling, "Programming the Hilbert curve", 2004).
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    for (int bit = kBits - 1; bit > 0; --bit) {
        const std::uint32_t lower = (1U << bit) - 1;
        // All ones or all zeros, so as not to branch.
        const auto has_bit = [&](std::uint32_t coordinate) { return 0U - (coordinate >> bit & 1U); };
        x ^= lower & has_bit(x);
        for (std::uint32_t* const coordinate : {&y, &z}) {
            const std::uint32_t is_set = has_bit(*coordinate);
            const std::uint32_t swap = (x ^ *coordinate) & lower & ~is_set;
            x ^= swap | (lower & is_set);
            *coordinate ^= swap;
        }
    }
    y ^= x;
    z ^= y;
    std::uint32_t gray = 0;
    for (int bit = kBits - 1; bit > 0; --bit) {
        gray ^= ((1U << bit) - 1) & (0U - (z >> bit & 1U));
    }
    return interleaved(z ^ gray, y ^ gray, x ^ gray);
}

struct Keyed {
    std::uint64_t key;
    Index point;
};

std::vector<Keyed> sorted_keys(std::span<const Point> points) {
    const Box box = box_around(points);
    const Point extent = box.max - box.min;
    const double longest = std::max({extent.x, extent.y, extent.z});
    const double cells = static_cast<double>((1U << kBits) - 1);
    const double scale = longest > 1e-290 ? cells / longest : 0;
    const auto cell = [&](double offset) { return static_cast<std::uint32_t>(std::min(offset * scale, cells)); };

    auto keys = mapped<Keyed>(points.size(), [&](std::size_t i) {
        const Point p = points[i] - box.min;
        return Keyed{hilbert_key(cell(p.x), cell(p.y), cell(p.z)), static_cast<Index>(i)};
    });
    radix_sort(keys);
    return keys;
}

}  // namespace

std::vector<Index> hilbert_order(std::span<const Point> points) {
    const std::vector<Keyed> keys = sorted_keys(points);
    return mapped<Index>(keys.size(), [&](std::size_t i) { return keys[i].point; });
}

InsertionOrder insertion_order(std::span<const Point> points) {
    constexpr int kBitsPerRound = 3;             // each round has seven eighths of the points that are left
    constexpr std::size_t kSmallestRound = 500;  // below, the order does not matter

    int rounds = 1;
    for (std::size_t left = points.size(); left > kSmallestRound; left >>= kBitsPerRound) {
        ++rounds;
    }
    const auto round_of = [&](Index point) {
        const int level = std::countr_zero(mixed(static_cast<std::uint64_t>(point))) / kBitsPerRound;
        return static_cast<std::size_t>(rounds - 1 - std::min(level, rounds - 1));
    };

    const std::vector<Keyed> keys = sorted_keys(points);
    CancellationPoint ask_whether_cancelled;
    IndexLists lists = grouped(static_cast<std::size_t>(rounds), [&](const auto& add) {
        for (const Keyed& k : keys) {
            ask_whether_cancelled();
            add(round_of(k.point), k.point);
        }
    });
    return {std::move(lists.items), {lists.offsets.begin() + 1, lists.offsets.end()}};
}

}  // namespace scaleaxis::inline v1
