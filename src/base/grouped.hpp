// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lists of what belongs together.
#pragma once

#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::kernel {

/// Sorts items into lists by counting. `for_each_entry(add)` calls `add(list, item)` for every item and its list, and
/// does so twice, in the same order; the lists keep that order.
template <class ForEachEntry>
IndexLists grouped(std::size_t lists, const ForEachEntry& for_each_entry) {
    IndexLists result;
    result.offsets.assign(lists + 1, 0);
    for_each_entry([&](Index list, Index) { ++result.offsets[list + 1]; });
    std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
    result.items.resize(result.offsets.back());
    std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
    for_each_entry([&](Index list, Index item) { result.items[next[list]++] = item; });
    return result;
}

/// The neighbours of each item, in the order of the edges between items.
inline IndexLists grouped_both_ways(std::size_t items, std::span<const std::array<Index, 2>> edges) {
    return grouped(items, [&](const auto& add) {
        for (const auto& [a, b] : edges) {
            add(a, b);
            add(b, a);
        }
    });
}

}  // namespace scaleaxis::kernel
