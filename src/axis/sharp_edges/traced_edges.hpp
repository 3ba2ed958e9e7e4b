// SPDX-License-Identifier: Apache-2.0
/// \file
/// The sharp edges of a solid that has no list of them.
#pragma once

#include <vector>

#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// The convex edges that balls at the border of an axis see, traced on in steps of the tolerance until they meet,
/// close, or end in a corner or where they are no longer sharp. Common ends are equal.
std::vector<SharpEdge> traced_edges(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options);

}  // namespace scaleaxis::inline v1
