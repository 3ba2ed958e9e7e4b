// SPDX-License-Identifier: Apache-2.0
/// \file
/// Orders of points in which neighbours are near to each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The lower 21 bits of three coordinates in turn, those of `x` lowest: near cells get near numbers (Morton).
constexpr std::uint64_t interleaved(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    const auto spread = [](std::uint64_t bits) {  // bit `i` becomes bit `3 i`
        bits &= 0x1FFFFF;
        bits = (bits | bits << 32) & 0x001F00000000FFFFU;
        bits = (bits | bits << 16) & 0x001F0000FF0000FFU;
        bits = (bits | bits << 8) & 0x100F00F00F00F00FU;
        bits = (bits | bits << 4) & 0x10C30C30C30C30C3U;
        return (bits | bits << 2) & 0x1249249249249249U;
    };
    return spread(x) | spread(y) << 1 | spread(z) << 2;
}

/// Sorts points along a Hilbert curve, so that consecutive ones are near to each other. Equal points keep their order.
/// \returns the indices of the points in this order
std::vector<Index> hilbert_order(std::span<const Point> points);

/// A biased randomized insertion order (N. Amenta, S. Choi, G. Rote, "Incremental Constructions con BRIO", 2003).
struct InsertionOrder {
    std::vector<Index> points;        ///< round after round, each sorted along the Hilbert curve
    std::vector<std::size_t> rounds;  ///< where each round ends; each is several times larger than all before it
};
InsertionOrder insertion_order(std::span<const Point> points);

}  // namespace scaleaxis::inline v1
