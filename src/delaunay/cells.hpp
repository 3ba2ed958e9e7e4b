// SPDX-License-Identifier: Apache-2.0
/// \file
/// The points and cells of a triangulation that is being built.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The ghosts precede all other points.
constexpr Index kGhosts = 4;

/// A face of a cell: 4 · cell + the position of the opposite vertex in the cell.
using Face = Index;
constexpr Face face_of(Index cell, int opposite) { return 4 * cell + opposite; }
constexpr Index cell_of(Face face) { return face >> 2; }
constexpr int opposite_of(Face face) { return face & 3; }

/// What becomes of a cell: `kIdle` or `kEmpty` (a slot without a cell) at rest; during an insertion, cells that have
/// been looked at bear one of the two marks of the worker that does it, and belong to it alone.
enum Mark : std::uint8_t { kIdle, kEmpty, kNotACell, kFirstWorker = 4 };

/// One line of the processor's cache.
struct alignas(64) Cell {
    std::array<Index, 4> vertices;
    std::array<Face, 4> neighbors;  ///< the same faces, seen from the other side
    /// Twice the center of the (orthogonal) sphere, relative to the last vertex, and a bound of its coordinates'
    /// errors. No `Point`, which would set all of a new array to 0.
    std::array<double, 3> center;
    float error;
    Mark mark;
    std::uint16_t batch;  ///< which call of `insert_vertices` made it
};

/// Slot 0 is no cell: it stands for all that is beyond the ghosts, so that every face has another side.
constexpr Index kBeyond = 0;

struct Cells {
    bool is_weighted;
    bool has_ideal_ghosts;          ///< they lie infinitely far, and have no coordinates (NaN)
    std::vector<Point> points;      ///< point of vertex `v` at `v + kGhosts`
    std::vector<double> weights;    ///< empty if not weighted
    std::unique_ptr<Cell[]> slots;  ///< `capacity` of them, the first `used` of which have been in use
    Index capacity = 0;
    Index used = 0;
    std::vector<Index> empty;  ///< slots among the used ones that have no cell
    std::uint16_t batch = 0;   ///< the number of the last call of `insert_vertices`, which counts on from 0 in the end

    Cell& operator[](Index slot) { return slots.get()[slot]; }
    const Cell& operator[](Index slot) const { return slots.get()[slot]; }
    const Point& point(Index vertex) const { return points.data()[vertex + kGhosts]; }
    double weight(Index vertex) const { return weights.data()[vertex + kGhosts]; }
};

/// The tetrahedron of the ghosts around `box`.
Cells ghost_cells(const Box& box, bool is_weighted);

/// The tetrahedron of ghosts that lie infinitely far, around everything: the cells without ghosts then fill the convex
/// hull of the points.
Cells ideal_ghost_cells(bool is_weighted);

/// Inserts the vertices from `first` on, whose points and weights are there already, with all threads of the arena.
void insert_vertices(Cells& cells, Index first);

}  // namespace scaleaxis::inline v1
