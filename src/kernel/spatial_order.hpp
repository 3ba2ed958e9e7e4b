// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The order in which points are inserted into a triangulation.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::kernel {

/// Sorts points along a Hilbert curve, so that consecutive ones are near to each other. Equal points keep their order.
/// \returns the indices of the points in this order
std::vector<Index> hilbert_order(std::span<const Point> points);

/// A biased randomized insertion order (N. Amenta, S. Choi, G. Rote, "Incremental Constructions con BRIO", 2003).
struct InsertionOrder {
    std::vector<Index> points;        ///< round after round, each sorted along the Hilbert curve
    std::vector<std::size_t> rounds;  ///< where each round ends; each is several times larger than all before it
};
InsertionOrder insertion_order(std::span<const Point> points);

}  // namespace scaleaxis::kernel
