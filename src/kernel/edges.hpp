// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Walks around the edges of a triangulation.
#pragma once

#include <array>

#include "kernel/triangulation.hpp"

namespace scaleaxis::kernel {

/// Position of a vertex in a cell.
inline int position_of(const std::array<Index, 4>& cell, Index vertex) {
    return cell[0] == vertex ? 0 : cell[1] == vertex ? 1 : cell[2] == vertex ? 2 : 3;
}

/// The six edges of a cell, as positions; the other two positions follow so that all four are an even permutation.
inline constexpr std::array<std::array<int, 4>, 6> kEdgesOfCell{
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

/// One of the cells around an edge: the walk leaves it through its facet opposite to vertex position `exit`, which has
/// the edge and the vertex at position `apex`.
struct AroundEdge {
    Index cell = kNone;
    int exit = 0;
    int apex = 0;
};

/// The next cell around the same edge; its cell is `kNone` beyond the ghosts.
inline AroundEdge next_around_edge(const Triangulation& t, const AroundEdge& at) {
    const std::array<Index, 4>& cell = t.vertices[at.cell];
    const Index next = t.neighbors[at.cell][at.exit];
    if (next == kNone) {
        return {};
    }
    // The apex of this cell is the vertex that the walk leaves behind in the next one, and so the next exit's opposite.
    const int exit = position_of(t.vertices[next], cell[at.apex]);
    const std::array<Index, 4>& back = t.neighbors[next];
    const int apex = back[0] == at.cell ? 0 : back[1] == at.cell ? 1 : back[2] == at.cell ? 2 : 3;
    return {next, exit, apex};
}

}  // namespace scaleaxis::kernel
