// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which cells of a power diagram touch, and what a line meets of a union of balls.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "delaunay/triangulation.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The balls whose power cells touch that of ball `i`: `neighbors[i]`. None for a ball without a cell.
IndexLists power_neighbors(const Triangulation& triangulation, std::size_t balls);

/// Parameters (0…1) along a segment where it leaves a union of balls for the first and for the last time.
struct Exits {
    double first = 0.0;
    double last = 0.0;
};

/// Nothing if the segment from `a` to `b` ends within the union.
/// \param neighbors in the power diagram \param dual_neighbors in the dual complex: what they do not cover of the
/// sphere of a ball of that complex is not covered at all \param covering a ball of the dual complex that contains `a`
std::optional<Exits> exits(std::span<const Ball> balls, const IndexLists& neighbors, const IndexLists& dual_neighbors,
                           Index covering, const Point& a, const Point& b);

}  // namespace scaleaxis::inline v1
