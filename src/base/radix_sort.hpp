// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sorting by integer keys.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {

/// Sorts items by their member `key`, an unsigned number; equal ones keep their order. One thread is faster at this
/// than two are with comparisons.
template <class Item>
void radix_sort(std::vector<Item>& items) {
    constexpr int kDigitBits = 8;
    constexpr std::size_t kDigits = 1 << kDigitBits;
    constexpr std::size_t kItemsAtOnce = 1 << 20;  // between two looks at cancellation
    std::uint64_t used_bits = 0;
    for (const Item& item : items) {
        used_bits |= item.key;
    }
    std::vector<Item> sorted(items.size());
    const int bits = static_cast<int>(std::bit_width(used_bits));
    for (int shift = 0; shift < bits; shift += kDigitBits) {
        const auto digit = [shift](const Item& item) { return item.key >> shift & (kDigits - 1); };
        std::array<std::size_t, kDigits> places{};
        for (const Item& item : items) {
            ++places[digit(item)];
        }
        std::size_t sum = 0;
        for (std::size_t& place : places) {
            sum += std::exchange(place, sum);
        }
        for (std::size_t begin = 0; begin < items.size(); begin += kItemsAtOnce) {
            stop_if_cancelled();
            for (std::size_t i = begin; i < std::min(begin + kItemsAtOnce, items.size()); ++i) {
                sorted[places[digit(items[i])]++] = items[i];
            }
        }
        std::swap(items, sorted);
    }
}

}  // namespace scaleaxis::inline v1
