// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which triangles meet at which edges. Side `3 t + k` of triangle `t` runs from its corner `k` to the next.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

using Triangle = std::array<Index, 3>;

inline Index next_side(Index side) { return side % 3 == 2 ? side - 2 : side + 1; }
inline Index start_of(const std::vector<Triangle>& triangles, Index side) { return triangles[side / 3][side % 3]; }
inline Index end_of(const std::vector<Triangle>& triangles, Index side) { return start_of(triangles, next_side(side)); }
inline Index apex_of(const std::vector<Triangle>& triangles, Index side) { return end_of(triangles, next_side(side)); }

/// For each edge the sides that run along it, in ascending order.
IndexLists sides_of_edges(const std::vector<Triangle>& triangles, std::size_t vertex_count);

/// For each side the one on the other side of its edge; `kNone` where the edge has not exactly two.
std::vector<Index> opposite_sides(const IndexLists& sides_of_edges);

}  // namespace scaleaxis::inline v1
