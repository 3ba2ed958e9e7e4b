// SPDX-License-Identifier: Apache-2.0
/// \file
/// Strips of triangles between an axis and the sharp edges of its solid.
#pragma once

#include <span>

#include "axis/sharp_edges/edge_lines.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Adds a strip to each line, along the way through the complex that is nearest to it, where the balls of the strip lie
/// in the solid and touch both sides of the edge. All strips that end in a corner begin at the vertices that have an
/// edge to it already, so that each strip is glued on along an arc: the homotopy type stays. What was added goes to
/// `points`, `corners` and `length` of the statistics.
void add_strips(MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                std::span<const EdgeLine> lines, SharpEdgeStatistics& statistics);

}  // namespace scaleaxis::inline v1
