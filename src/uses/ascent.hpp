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

/// Of the radius, half of what is between a place of the axis and the boundary: nearer places tell the same of the
/// solid, and single simplices or slopes between neighbours are noisy where the axis is denser.
inline constexpr double kNearby = 0.5;

/// Of the radius: what is less is an error of the sampling. Half of it leaves seams where four sheets meet as clusters
/// of short seams; twice of it makes one of the sheets of thin panels.
inline constexpr double kSamplingError = 0.1;

/// From which vertices on the radius grows as fast as in an edge: 1, else 0. All vertices nearby are looked at. \param
/// edges of the complex, or of its triangles \param slope growth of the radius along the way, more than which is steep
std::vector<std::uint8_t> steep_vertices(const MedialComplex& complex, std::span<const std::array<Index, 2>> edges,
                                         double slope);

}  // namespace scaleaxis::inline v1
