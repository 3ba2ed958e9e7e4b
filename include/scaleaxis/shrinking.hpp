// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 5: medial complex of the grown balls → discrete scale axis.
#pragma once

#include <optional>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

struct ShrinkOptions {
    /// Factor `s` by which the balls had been grown, ≥ 1. All radii are divided by it.
    double scale = 1.0;
    /// Shrunk balls at the ends of an edge must meet at this angle at least; degrees, [90, 175].
    double meeting_angle = 150.0;
    /// Limit of the number of vertices of the result, [1, 1e8]. Unset: ten times those of the complex, but at least a
    /// million and at most 1e8. Where balls barely overlap after shrinking (few balls, large scale), many are needed.
    std::optional<Index> most_vertices = {};
};

/// Samples the complex until the shrunk balls at the ends of every edge meet at the angle asked for, and shrinks
/// (the paper, section 4.3). Faces that need new points are split into triangles. New points have exact radii.
/// \throws InvalidOption, UnusableInput (see `check`; or more than `most_vertices`, found out before they are made),
/// Cancelled
SCALEAXIS_EXPORT MedialComplex shrink(const MedialComplex& complex, const ShrinkOptions& options,
                                      const Execution& execution = {});

}  // namespace scaleaxis
