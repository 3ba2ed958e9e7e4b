// SPDX-License-Identifier: Apache-2.0
/// \file
/// Walks around the edges of a triangulation.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "base/parallel.hpp"
#include "delaunay/tetrahedron.hpp"
#include "delaunay/triangulation.hpp"

namespace scaleaxis::inline v1 {

/// One of the cells around an edge: the walk leaves it through its facet opposite to vertex position `exit`, which has
/// the edge and the vertex at position `apex`.
struct AroundEdge {
    Index cell = kNone;
    int exit = 0;
    int apex = 0;

    /// Which of `kEdgesOfCell` it is.
    int edge() const {
        constexpr std::array<std::array<std::int8_t, 4>, 4> kOppositeEdge{
            {{-1, 5, 4, 3}, {5, -1, 2, 1}, {4, 2, -1, 0}, {3, 1, 0, -1}}};
        return kOppositeEdge[exit][apex];
    }
};

/// The ends of the edge, in the order of `kEdgesOfCell`.
inline std::array<Index, 2> ends_of_edge(const Triangulation& t, const AroundEdge& at) {
    const std::array<int, 4>& positions = kEdgesOfCell[at.edge()];
    return {t.cells[at.cell].vertices[positions[0]], t.cells[at.cell].vertices[positions[1]]};
}

/// The next cell around the same edge; its cell is `kNone` beyond the ghosts.
inline AroundEdge next_around_edge(const Triangulation& t, const AroundEdge& at) {
    const Tetrahedron& cell = t.cells[at.cell];
    const Index next = cell.neighbors[at.exit];
    if (next == kNone) {
        return {};
    }
    // The apex of this cell is the vertex that the walk leaves behind in the next one, and so the next exit's opposite.
    return {next, position_of(t.cells[next].vertices, cell.vertices[at.apex]),
            position_of(t.cells[next].neighbors, at.cell)};
}

/// Calls `body(around, out)` once for every edge beside a wanted cell, in parallel, and returns all that was appended
/// to `out`, as `collect` does. `around`: the cells around the edge in cyclic order, a vector that the body may change;
/// the walk begins at the wanted cell of the smallest index, with an edge of `kEdgesOfCell` and its third position as
/// the exit. Edges between ghosts are left out.
template <class Out, class IsWanted, class Body>
Out collect_edges(const Triangulation& t, const IsWanted& is_wanted, const Body& body) {
    // Bit `e`: a wanted cell of smaller index has come to edge `e` of the cell. Bits that get lost where two threads
    // meet cost a walk in vain.
    std::vector<std::uint8_t> has_passed(t.size());
    return collect<Out>(static_cast<Index>(t.size()), [&](Index cell, Out& out) {
        if (!is_wanted(cell)) {
            return;
        }
        thread_local std::vector<AroundEdge> around;
        for (int edge = 0; edge < 6; ++edge) {
            if ((std::atomic_ref(has_passed[cell]).load(std::memory_order_relaxed) >> edge & 1) != 0) {
                continue;
            }
            around.clear();
            AroundEdge at{cell, kEdgesOfCell[edge][2], kEdgesOfCell[edge][3]};
            do {
                around.push_back(at);
                at = next_around_edge(t, at);
                if (at.cell <= cell && (at.cell == kNone || is_wanted(at.cell))) {
                    break;
                }
                const std::atomic_ref passed(has_passed[at.cell]);
                passed.store(static_cast<std::uint8_t>(passed.load(std::memory_order_relaxed) | 1 << at.edge()),
                             std::memory_order_relaxed);
            } while (true);
            if (at.cell == cell) {
                body(around, out);
            }
        }
    });
}

}  // namespace scaleaxis::inline v1
