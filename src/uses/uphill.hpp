// SPDX-License-Identifier: Apache-2.0
/// \file
/// The way from a ball in a solid to larger ones.
#pragma once

#include <limits>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Moves the centre of a ball to where the distance from the boundary grows fastest, for as long as it grows by more
/// than `slope` times the way, and returns the largest ball around that place. A ball whose contacts are 2a apart, as
/// seen from its centre, grows by cos(a): so balls leave convex edges and corners, and stay between opposite sides.
/// \param solid knows the nearest points of its boundary
/// \param slope in (0, 1) \param most radius of interest: a ball as large stays where it is
/// \param known the end of another way, if any: whoever comes near it goes there, and needs not look further
Ball uphill(const Solid& solid, const Ball& start, double slope, double most = std::numeric_limits<double>::infinity(),
            const Ball& known = {});

}  // namespace scaleaxis::inline v1
