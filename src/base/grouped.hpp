// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lists of what belongs together, by counting sort.
#pragma once

#include <array>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Lists of items in one flat array: list `i` is `items[offsets[i]] … items[offsets[i + 1] - 1]`.
template <class Item>
struct Lists {
    std::vector<Index> offsets;
    std::vector<Item> items;

    std::span<Item> operator[](std::size_t i) { return {items.data() + offsets[i], items.data() + offsets[i + 1]}; }
    std::span<const Item> operator[](std::size_t i) const {
        return {items.data() + offsets[i], items.data() + offsets[i + 1]};
    }
};

/// Sorts items into `count` lists. `for_each_entry(add)` calls `add(list, item)` for every item and its list, and does
/// so twice, in the same order; the lists keep that order.
template <class Item, class ForEachEntry>
Lists<Item> lists_of(std::size_t count, const ForEachEntry& for_each_entry) {
    Lists<Item> result;
    result.offsets.assign(count + 1, 0);
    for_each_entry([&](auto list, const Item&) { ++result.offsets[static_cast<std::size_t>(list) + 1]; });
    std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
    result.items.resize(static_cast<std::size_t>(result.offsets.back()));
    std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
    for_each_entry([&](auto list, const Item& item) { result.items[next[static_cast<std::size_t>(list)]++] = item; });
    return result;
}

/// The same for indices.
template <class ForEachEntry>
IndexLists grouped(std::size_t count, const ForEachEntry& for_each_entry) {
    Lists<Index> lists = lists_of<Index>(count, for_each_entry);
    return {std::move(lists.offsets), std::move(lists.items)};
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

}  // namespace scaleaxis::inline v1
