// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Disjoint sets of indices, joined pair by pair. The representative of a set is its smallest index.
class DisjointSets {
   public:
    explicit DisjointSets(std::size_t size) : parents_(size) { std::iota(parents_.begin(), parents_.end(), 0); }

    Index find(Index i) {
        while (parents_[i] != i) {
            parents_[i] = parents_[parents_[i]];
            i = parents_[i];
        }
        return i;
    }

    /// The representative of each index.
    std::vector<Index> all() {
        for (Index& parent : parents_) {
            parent = find(parent);
        }
        return parents_;
    }

    /// The set of each index as a number, and how many there are: numbered by their smallest indices.
    std::pair<std::vector<Index>, Index> numbered() {
        std::vector<Index> numbers = all();
        Index count = 0;
        for (Index i = 0; i < std::ssize(numbers); ++i) {
            numbers[i] = numbers[i] == i ? count++ : numbers[numbers[i]];  // a representative has its number before
        }
        return {std::move(numbers), count};
    }

    /// Returns false if the two were in one set already.
    bool join(Index a, Index b) {
        a = find(a);
        b = find(b);
        if (a == b) {
            return false;
        }
        if (b < a) {
            std::swap(a, b);
        }
        parents_[b] = a;
        return true;
    }

   private:
    std::vector<Index> parents_;
};

}  // namespace scaleaxis::inline v1
