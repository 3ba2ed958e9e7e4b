// SPDX-License-Identifier: Apache-2.0
/// \file
/// The facets and edges of a positively oriented tetrahedron, by the positions 0…3 of its vertices.
#pragma once

#include <algorithm>
#include <array>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The facet opposite to each vertex, counter-clockwise as seen from that vertex: with it as the fourth, the four are
/// positively oriented.
inline constexpr std::array<std::array<int, 3>, 4> kFacetsOfCell{{{1, 3, 2}, {3, 0, 2}, {1, 0, 3}, {0, 1, 2}}};

/// The six edges; the other two positions follow so that all four are an even permutation.
inline constexpr std::array<std::array<int, 4>, 6> kEdgesOfCell{
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

/// The vertices of the facet opposite to position `k`, counter-clockwise as seen from the vertex there, from the
/// smallest one on.
inline std::array<Index, 3> facet_of_cell(const std::array<Index, 4>& cell, int k) {
    const auto& at = kFacetsOfCell[k];
    std::array<Index, 3> facet{cell[at[0]], cell[at[1]], cell[at[2]]};
    std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    return facet;
}

/// The position in a cell where `item` stands, which occurs there. Branches would be mispredicted.
inline int position_of(const std::array<Index, 4>& cell, Index item) {
    return (cell[1] == item ? 1 : 0) + (cell[2] == item ? 2 : 0) + (cell[3] == item ? 3 : 0);
}

}  // namespace scaleaxis::inline v1
