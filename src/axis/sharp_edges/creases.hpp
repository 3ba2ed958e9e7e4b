// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sharp edges and corners of a solid near points inside.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Tolerances: how far from a point its edge may be.
inline constexpr double kCreaseReach = 8.0;

/// Of the way from an edge to a point that sees it: from where it is looked at next, more closely or farther on.
inline constexpr double kApproach = 0.7;

/// A place on a sharp edge.
struct Crease {
    Point place;
    Point direction;                 // of the edge, of length 1; 0 in corners
    std::array<Point, 2> normals{};  // outwards, of length 1
};

/// The sharp edge, or the corner, near each of the points; nothing where there is none.
std::vector<std::optional<Crease>> creases_near(const Solid& solid, std::span<const Point> points,
                                                const SharpEdgeOptions& options, bool wants_corners);

}  // namespace scaleaxis::inline v1
