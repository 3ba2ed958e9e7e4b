// SPDX-License-Identifier: Apache-2.0
/// \file
/// Delaunay and regular triangulations of points: the kernel beneath the stages, for itself.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The tetrahedra of a triangulation, in an order that depends on the points alone.
struct Delaunay {
    /// #T: points; positively oriented (det[b - a, c - a, d - a] > 0), the smallest index first, then the second
    /// smallest
    std::vector<std::array<Index, 4>> tetrahedra;
    /// #T: the tetrahedron opposite to each corner; `kNone` beyond the convex hull
    std::vector<std::array<Index, 4>> neighbors;
};

/// The Delaunay triangulation of points; with weights the regular one (weighted Delaunay, dual to the power diagram).
/// It fills the convex hull: no point lies inside the sphere through the corners of a tetrahedron. All signs are exact,
/// and ties are broken by a symbolic perturbation, so that no tetrahedron is flat. Coplanar points have none.
///
/// A point that occurs in no tetrahedron is hidden: one at the place of another (of several the heaviest is kept, then
/// the first), or one whose weight is so small that its power cell is empty.
/// \param points coordinates of at most 1e60
/// \param weights one for each point, as the squared radius of a ball; or empty
/// \throws UnusableInput if a number is not finite or too large, there are not as many weights as points, or more than
///     half a billion tetrahedra; Cancelled
SCALEAXIS_EXPORT Delaunay delaunay(std::span<const Point> points, std::span<const double> weights = {},
                                   const Execution& execution = {});

}  // namespace scaleaxis::inline v1
