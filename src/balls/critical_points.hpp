// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where the topology of a union of balls changes when the balls grow or shrink together.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/triangulation.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// A critical point of the power distance to some balls, the least of their powers |x - centre|² - radius²; not the
/// centre of a ball. A simplex of the regular triangulation contains the point of equal power in its affine hull in its
/// interior, and no other ball has a smaller power there (it is Gabriel).
struct CriticalPoint {
    std::array<Index, 4> balls;  ///< of the simplex, ascending; `kNone` first where there are two or three
    Point place;
    double power = 0.0;       ///< of the balls there
    bool is_covered = false;  ///< by the balls (power ≤ 0); exact

    /// The balls of the simplex.
    std::span<const Index> simplex() const {
        const std::size_t missing = balls[1] == kNone ? 2 : balls[0] == kNone ? 1 : 0;
        return std::span(balls).subspan(missing);
    }
};

enum class CriticalPoints { kAll, kUncovered };

/// The critical points of index 1 (edges), 2 (triangles) and 3 (tetrahedra). Which simplices are critical is decided
/// exactly: a simplex contains the point of equal power if no ball of it is in conflict with the smallest sphere
/// orthogonal to the others, and is Gabriel if no ball beside it is in conflict with its own.
/// \param triangulation the regular one of the balls
std::vector<CriticalPoint> critical_points(const Triangulation& triangulation, std::span<const Ball> balls,
                                           CriticalPoints wanted = CriticalPoints::kAll);

/// The same of the simplices that belong to some of the cells.
/// \param is_wanted of each cell: 1 or 0
std::vector<CriticalPoint> critical_points_of_cells(const Triangulation& triangulation, std::span<const Ball> balls,
                                                    CriticalPoints wanted, std::span<const std::uint8_t> is_wanted);

}  // namespace scaleaxis::inline v1
