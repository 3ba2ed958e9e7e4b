// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Euler characteristic of a solid between voxels, part by part.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// What some cells add to the Euler characteristic of the solid of `interpolant_topology`: with their lower faces,
/// edges and corners each counts what no other cell does, so that parts of a lattice add up to the whole.
/// \param values negative inside, x fastest \param low the first of the cells \param high the one after the last
std::int64_t interpolant_euler(const std::array<Index, 3>& sizes, std::span<const float> values,
                               const std::array<Index, 3>& low, const std::array<Index, 3>& high);

}  // namespace scaleaxis::inline v1
