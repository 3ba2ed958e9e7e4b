// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Winding numbers of some parts of a surface around points of another one.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

struct WindingQuery {
    Point point;
    Index excluded_part = kNone;  ///< the part that the point lies on
};

/// How often the surface without the excluded part winds around each point. Exact but for rounding where a point nearly
/// lies on the surface.
/// \param part_of_triangle #F; each part is closed and coherently oriented
std::vector<int> winding_numbers(const TriangleMesh& mesh, std::span<const Index> part_of_triangle,
                                 std::span<const WindingQuery> queries);

}  // namespace scaleaxis
