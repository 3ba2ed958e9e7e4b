// SPDX-License-Identifier: Apache-2.0
/// \file
/// The cells of a lattice close to the zero of a function that is known at the lattice's points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "solid/zero_set/lattice.hpp"

namespace scaleaxis::inline v1 {

/// A function's values at the corners of a cell, in the order of the bits of `SurfaceCell`.
using CornerValues = std::array<double, 8>;

/// Is zero so far from all values, as seen from how they change from one to the other, that the function is hardly zero
/// between them?
bool is_far_from_zero(const CornerValues& values);

/// Cells with corners on both sides, and of the 26 around each those whose corners are not far from zero. In all others
/// the side is that of their corners.
struct NearCells {
    enum class Place : std::uint8_t { kNear, kInside, kOutside };

    std::array<Index, 3> counts{};     ///< of the lattice's cells along each axis
    std::vector<SurfaceCell> cells;    ///< ascending by the last coordinate first
    std::vector<CornerValues> values;  ///< of each cell
    std::vector<std::size_t> rows;     ///< where those of each row along x begin, and their number

    Place place_of(const Cell& cell) const;

    /// Which one of `cells` it is; their number if it is none.
    std::size_t find(const Cell& cell) const;

    /// Those with corners on both sides.
    std::vector<SurfaceCell> crossed() const;

   private:
    /// How many come before this one or are it.
    std::size_t after(const Cell& cell) const;
};

/// \param layer the values at all lattice points of this last coordinate, those along x next to each other; is asked
/// once for each, in their order. The points at the sides of the lattice must be outside (not negative).
NearCells find_near_cells(const std::array<Index, 3>& counts, const std::function<std::vector<double>(Index)>& layer);

}  // namespace scaleaxis::inline v1
