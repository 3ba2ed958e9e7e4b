// SPDX-License-Identifier: Apache-2.0
/// \file
/// A hash table with open addressing.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scaleaxis::inline v1 {

/// Linear probing among a power of two of entries. What an entry is, and which ones are free, is up to the caller.
template <class Entry>
class HashTable {
   public:
    HashTable() = default;
    /// \param capacity how many entries may be in use; at most half of all are then \param free value of a free entry
    explicit HashTable(std::size_t capacity, const Entry& free = {}) { reset(capacity, free); }

    /// Frees all entries.
    void reset(std::size_t capacity, const Entry& free = {}) {
        entries_.assign(std::bit_ceil(2 * capacity + 2), free);
        shift_ = 64 - std::countr_zero(entries_.size());
    }

    std::size_t size() const { return entries_.size(); }
    Entry& operator[](std::size_t place) { return entries_[place]; }
    const Entry& operator[](std::size_t place) const { return entries_[place]; }

    /// The first place from that of the key on for which `is_end(entry)`: where the entry is that the caller looks for,
    /// or a free one. The bits of the key need not be mixed.
    template <class IsEnd>
    std::size_t find(std::uint64_t key, const IsEnd& is_end) const {
        std::size_t place = key * 0x9E3779B97F4A7C15U >> shift_;  // Fibonacci hashing
        while (!is_end(entries_[place])) {
            place = (place + 1) & (entries_.size() - 1);
        }
        return place;
    }

   private:
    std::vector<Entry> entries_;
    int shift_ = 0;
};

}  // namespace scaleaxis::inline v1
