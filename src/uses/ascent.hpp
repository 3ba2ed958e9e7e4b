// SPDX-License-Identifier: Apache-2.0
/// \file
/// What tells a sheet between two sides of a solid from one that runs into an edge.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// Small beside a radius, a thickness or a way. Places that differ by less in thickness, or from a plane, are of one
/// wall: 5 % change its stiffness by less than 1 %. A ball is seen from a point if balls along the way leave no more
/// than this part of it uncovered, a step that is shorter meets a surface, and the middle between two sides is no
/// farther than this from where `uphill` stops. Half of it costs a third more queries at sharp edges; at twice of it,
/// walls a tenth as thick as the limit may be leapt over.
inline constexpr double kSmallPart = 0.05;

/// From which vertices on the radius grows as fast as in an edge: 1, else 0. All vertices nearby are looked at. \param
/// edges of the complex, or of its triangles \param slope growth of the radius along the way, more than which is steep
std::vector<std::uint8_t> steep_vertices(const MedialComplex& complex, std::span<const std::array<Index, 2>> edges,
                                         double slope);

}  // namespace scaleaxis::inline v1
