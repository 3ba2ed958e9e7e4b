// SPDX-License-Identifier: Apache-2.0
/// \file
/// Compact medial meshes that follow a solid more closely than the axis they were made from.
#pragma once

#include <optional>

#include "axis/complex.hpp"
#include "axis/stages/stages.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

struct RefitOptions {
    double tolerance = 0.0;   // of the sampling: no vertex moves farther
    double error = 0.0;       // how far from touching the solid balls may be, in the middle of edges and triangles
    Index most_vertices = 0;  // of the result
    Feet feet = Feet::kComeToSeams;
};

/// Has the balls at the vertices of a compact mesh touch the solid, as `center` does, and halves edges until those in
/// between touch it too; nothing if that takes too many vertices. The topology stays.
std::optional<MedialComplex> refitted(MedialComplex complex, const Solid& solid, const RefitOptions& options,
                                      const Execution& execution);

}  // namespace scaleaxis::inline v1
