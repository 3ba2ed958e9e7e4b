// SPDX-License-Identifier: Apache-2.0
/// \file
/// The topology of a solid between voxels.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/topology.hpp"
#include "solid/zero_set/lattice.hpp"

namespace scaleaxis::inline v1 {

/// The topology of the solid where the trilinear interpolant of values on a lattice is negative: that of the
/// interpolant itself, inside its cells too, in time linear in the number of values.
/// \param values x fastest; not negative on the border of the lattice
/// \param cells those that have corners on both sides
Topology interpolant_topology(const std::array<Index, 3>& sizes, std::span<const float> values,
                              std::span<const SurfaceCell> cells);

}  // namespace scaleaxis::inline v1
