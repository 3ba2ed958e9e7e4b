// SPDX-License-Identifier: Apache-2.0
/// \file
/// Surfaces that are found from values at the points of a lattice: what functions and images have in common.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Lines of each axis for each square of the spacing that seeds are asked for: about ten seeds.
inline constexpr double kSeedLines = 6.0;

/// The points `origin + i steps[0] + j steps[1] + k steps[2]`.
struct Lattice {
    Point origin;
    std::array<Point, 3> steps;

    Point at(const Point& index) const { return origin + index.x * steps[0] + index.y * steps[1] + index.z * steps[2]; }
};

/// The length of the shortest of the three steps.
inline double shortest_step(const Lattice& lattice) {
    return std::min({norm(lattice.steps[0]), norm(lattice.steps[1]), norm(lattice.steps[2])});
}

/// The cell between the lattice point of this index and the next one along each axis.
using Cell = std::array<Index, 3>;

/// A cell, and which of its corners are inside: bit `c` for the corner that is farther along x if `c & 1`, y if `c &
/// 2`, z if `c & 4`.
struct SurfaceCell {
    Cell cell{};
    std::uint8_t inside = 0;
};

/// Where a surface crosses a line in a cell: the line through `p` (an index) along `axis`, and the place as that
/// coordinate of an index. To be asked from several threads at once.
using RootInCell = std::function<std::optional<double>(const Cell& cell, int axis, const Point& p)>;

/// A line in a cell as `RootInCell` is asked for it.
struct LineInCell {
    Cell cell{};
    int axis = 0;
    Point point;
};

/// Random bits that belong to a cell.
std::uint64_t stream_of(const Cell& cell, std::uint64_t seed);

/// How many lines of each axis go through a cell, `density` for each unit of area across.
std::array<double, 3> lines_through_cell(const Lattice& lattice, double density);

/// \throws InvalidOption if there would be more lines of this density in `cells` cells than indices
void check_number_of_lines(const Lattice& lattice, std::size_t cells, double density);

/// Points where random lines along the axes of the lattice cross a surface, `density` lines of each axis for each unit
/// of area across: 1 to 1.7 `density` points a unit of the surface's area.
std::vector<Point> points_on_lines(const Lattice& lattice, const std::vector<SurfaceCell>& cells, double density,
                                   std::uint64_t seed, const RootInCell& root);

/// The edges of some cells of every part of a surface.
/// \param cells those with corners on both sides, ascending by the last coordinate first
std::vector<LineInCell> landmark_edges(const std::vector<SurfaceCell>& cells);

/// Some points of every part of a surface, where edges of the lattice cross it.
/// \param cells those with corners on both sides, ascending by the last coordinate first
std::vector<Point> landmark_points(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                                   const RootInCell& root);

/// The box around points of a surface that lie closely where it is outermost, widened.
/// \param landmarks points of each part of the surface
/// \param margin by how much, in steps of the lattice
Box extent_of(const Lattice& lattice, const std::vector<SurfaceCell>& cells, const std::vector<Point>& landmarks,
              const RootInCell& root, double margin);

}  // namespace scaleaxis::inline v1
