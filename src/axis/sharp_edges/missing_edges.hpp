// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sharp edges that the solid knows and that no row of the border has reached.
#pragma once

#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Adds a strip to each part of a sharp edge between places that are reached, or corners, along the way through the
/// complex that is nearest to it. A corner that is not reached gets an edge to the vertex nearest to it first, and all
/// strips that end in it begin there. What was added goes to `points`, `corners` and `length` of the statistics.
/// \param complex with balls of radius 0 where edges are reached
void reach_missing_edges(MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                         SharpEdgeStatistics& statistics);

}  // namespace scaleaxis::inline v1
