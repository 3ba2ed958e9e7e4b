// SPDX-License-Identifier: Apache-2.0
/// \file
/// Delaunay and regular triangulations as index arrays. The only place that knows how they are made.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/cells.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Every triangulation has four ghost points besides its own, with the vertex ids -1 … -4: the corners of a large
/// tetrahedron around everything. They make point sets of any number and dimension (one point, collinear, coplanar)
/// ordinary ones, and do not affect what lies within the box that the triangulation was made for.
constexpr bool is_ghost(Index vertex) { return vertex < 0; }

/// A cell of a finished triangulation. Vertices and neighbors share a line of the processor's cache, since walks need
/// both.
struct alignas(32) Tetrahedron {
    std::array<Index, 4> vertices;   ///< positively oriented; negative: ghost
    std::array<Index, 4> neighbors;  ///< opposite to vertex `k`; `kNone` beyond the ghosts

    friend bool operator==(const Tetrahedron&, const Tetrahedron&) = default;
};

/// A finished triangulation; the same arrays for the same points, whatever the number of threads.
struct Triangulation {
    std::vector<Tetrahedron> cells;  ///< for their order see `TriangulationBuilder::finish`
    std::vector<Point> points;       ///< the points (without ghosts), by vertex id
    std::array<Point, 4> ghosts;     ///< ghost `-1 - k` is `ghosts[k]`

    std::size_t size() const { return cells.size(); }
    const Point& point(Index vertex) const {
        return vertex >= 0 ? points[static_cast<std::size_t>(vertex)] : ghosts[static_cast<std::size_t>(-1 - vertex)];
    }
};

/// Builds a Delaunay triangulation, or the regular one of weighted points, in one or several batches.
///
/// Degenerate positions are resolved by a symbolic perturbation of the lifted points in the order of their ids, so the
/// set of cells is a function of the points alone, and no cell is flat. Of points at the same place the one with the
/// largest weight (then the smallest id) is a vertex, the others are hidden: they occur in no cell.
///
/// `insert` runs on the calling thread's TBB arena.
class TriangulationBuilder {
   public:
    /// \param box contains all points that will be inserted (and the balls, if they are weighted); coordinates up to
    /// 1e60 \param is_weighted regular instead of Delaunay triangulation
    TriangulationBuilder(const Box& box, bool is_weighted) : box_(box), cells_(ghost_cells(box, is_weighted)) {}

    /// With ghosts that lie infinitely far, and have no coordinates: the cells without ghosts fill the convex hull.
    /// With others those are missing whose spheres reach a ghost.
    static TriangulationBuilder of_hull(bool is_weighted);

    /// Adds points; they get the next ids in their order. `weights` (squared radii): one for each, if weighted; else
    /// empty. \throws Error if a point lies outside the box, or a weight is not finite
    void insert(std::span<const Point> points, std::span<const double> weights = {});

    // The current cells live in slots, in no particular order, and some slots may be empty.
    Index slots() const { return cells_.used; }
    bool is_cell(Index slot) const { return cells_[slot].mark == kIdle; }
    /// Was the cell made by the last `insert`? (False for cells that were there before.)
    bool is_fresh(Index slot) const { return cells_[slot].batch == cells_.batch; }
    /// Ids as in `Triangulation`; positively oriented.
    const std::array<Index, 4>& vertices(Index slot) const { return cells_[slot].vertices; }
    /// The slot beyond the facet opposite to vertex `k`, or `kNone`.
    Index neighbor(Index slot, int k) const {
        const Index neighbor = cell_of(cells_[slot].neighbors[k]);
        return neighbor == kBeyond ? kNone : neighbor;
    }
    /// The position in the neighbor of the vertex opposite to the same facet.
    int mirror(Index slot, int k) const { return opposite_of(cells_[slot].neighbors[k]); }
    const Point& point(Index vertex) const { return cells_.point(vertex); }

    /// The cells in canonical order: in each cell the smallest vertex id comes first, then the second smallest, the
    /// other two as orientation demands; cells ascend lexicographically by their sorted ids. `slots_of`, if given,
    /// receives the slot of each cell.
    Triangulation finish(std::vector<Index>* slots_of = nullptr) const;

    /// The cells that the last `insert` made and all others around their edges, in canonical order; what is beyond
    /// these is missing (`kNone`). `is_fresh` receives which ones it made. Costs little where it made few.
    Triangulation finish_fresh(std::vector<std::uint8_t>& is_fresh) const;

   private:
    TriangulationBuilder(const Box& box, Cells cells) : box_(box), cells_(std::move(cells)) {}

    /// 1 for the slots of fresh cells and of those around their edges.
    std::vector<std::uint8_t> near_fresh() const;
    template <class IsWanted>
    Triangulation finish_wanted(const IsWanted& is_wanted, std::vector<Index>* slots_of) const;

    Box box_;
    Cells cells_;
};

/// All at once. \param weights as for `TriangulationBuilder::insert`; empty for a Delaunay triangulation
Triangulation triangulate(std::span<const Point> points, std::span<const double> weights = {});

/// A cell that contains `p` (closed), found by a walk from `hint`; `kNone` if `p` lies outside the ghosts' tetrahedron.
Index locate(const Triangulation& triangulation, const Point& p, Index hint);

}  // namespace scaleaxis::inline v1
