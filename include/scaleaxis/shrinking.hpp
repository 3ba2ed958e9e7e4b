// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stage 5: medial complex of the grown balls → discrete scale axis.
#pragma once

#include "scaleaxis/execution.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

struct ShrinkOptions {
    /// Factor `s` by which the balls had been grown, ≥ 1. All radii are divided by it.
    double scale = 1.0;
    /// Shrunk balls at the ends of an edge must meet at this angle at least; degrees, [90, 175].
    double meeting_angle = 150.0;
};

/// Samples the complex until the shrunk balls at the ends of every edge meet at the angle asked for, and shrinks
/// (the paper, section 4.3). Faces that need new points are split into triangles. New points have exact radii.
/// \throws InvalidOption, Cancelled
MedialComplex shrink(const MedialComplex& complex, const ShrinkOptions& options, const Execution& execution = {});

}  // namespace scaleaxis
