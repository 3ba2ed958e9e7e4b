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

/// From which vertices on the radius grows as fast as in an edge: 1, else 0. Angles of single simplices are noisy where
/// these are small, and so are slopes between neighbours: all vertices around are looked at, up to about half a radius
/// away. \param edges of the complex, or of its triangles \param slope growth of the radius along the way, more than
/// which is steep
std::vector<std::uint8_t> steep_vertices(const MedialComplex& complex, std::span<const std::array<Index, 2>> edges,
                                         double slope);

}  // namespace scaleaxis::inline v1
