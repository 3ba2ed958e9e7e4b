// SPDX-License-Identifier: Apache-2.0
/// \file
/// Vectors made of other ranges, and of numbers.
#pragma once

#include <algorithm>
#include <functional>
#include <numeric>
#include <ranges>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// What `of`, a function or a member, says of each item, one after the other.
template <class T, class Items, class Of>
std::vector<T> each_of(Items&& items, const Of& of) {
    std::vector<T> result;
    if constexpr (std::ranges::sized_range<Items>) {
        result.reserve(std::ranges::size(items));
    }
    for (auto&& item : items) {
        result.push_back(static_cast<T>(std::invoke(of, item)));
    }
    return result;
}

/// The numbers from 0 up and below `count` for which `holds(i)`.
template <class Holds>
std::vector<Index> indices_where(std::size_t count, const Holds& holds) {
    std::vector<Index> result;
    for (Index i = 0; i < static_cast<Index>(count); ++i) {
        if (holds(i)) {
            result.push_back(i);
        }
    }
    return result;
}

/// The numbers from 0 up and below `count`, sorted by `key_of(i)`; those with equal keys keep their order.
template <class KeyOf, class Compare = std::ranges::less>
std::vector<Index> sorted_indices(std::size_t count, const KeyOf& key_of, const Compare& compare = {}) {
    std::vector<Index> result(count);
    std::iota(result.begin(), result.end(), 0);
    std::ranges::stable_sort(result, compare, key_of);
    return result;
}

/// At which place of an order each number stands.
inline std::vector<Index> places_in(const std::vector<Index>& order) {
    std::vector<Index> places(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        places[order[k]] = static_cast<Index>(k);
    }
    return places;
}

/// Removes the items that are marked.
template <class T, class Marks>
void erase_marked(std::vector<T>& items, const Marks& is_marked) {
    std::size_t i = 0;
    std::erase_if(items, [&](const T&) { return is_marked[i++] != 0; });
}

/// Sorts the items, and keeps one of those that are equal.
template <class T>
void sort_unique(std::vector<T>& items) {
    std::ranges::sort(items);
    items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace scaleaxis::inline v1
