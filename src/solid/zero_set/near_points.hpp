// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points close to the surface where a function is zero, from few values of the function.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "solid/zero_set/lattice.hpp"
#include "solid/zero_set/near_cells.hpp"

namespace scaleaxis::inline v1 {

/// Values of a function at many places.
using BatchFunction = std::function<void(std::span<const Point>, std::span<double>)>;

/// Points where random lines along the axes cross the zero of a function's interpolant in one of the cells, enough for
/// each `spacing²` of the surface to choose a Poisson-disk sample from them. A cell is halved until the
/// function in its middle agrees with the interpolant to a small part of the spacing, or nearly to the spacing itself:
/// so close to the surface are the points, however the function behaves.
/// \param values at the corners of each cell
/// \param function finite; is asked from several threads at once
/// \param batch how many cells are looked at together: the function is asked for their places at once
std::vector<Point> points_near_zero(const Lattice& lattice, std::span<const SurfaceCell> cells,
                                    std::span<const CornerValues> values, const BatchFunction& function,
                                    std::size_t batch, double spacing, std::uint64_t seed);

}  // namespace scaleaxis::inline v1
