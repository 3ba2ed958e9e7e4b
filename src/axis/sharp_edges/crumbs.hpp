// SPDX-License-Identifier: Apache-2.0
/// \file
/// Small sheets in sharp edges.
#pragma once

#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Collapses crumbs in the wedge of a sharp edge, where larger sheets are to go on: sheets smaller than `size` beside
/// large ones, which the filter leaves beside the ends of seams. All vertices of their border see an edge.
MedialComplex without_crumbs(MedialComplex complex, const Solid& solid, const SharpEdgeOptions& options, double size);

}  // namespace scaleaxis::inline v1
