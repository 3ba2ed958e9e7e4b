// SPDX-License-Identifier: Apache-2.0
/// \file
/// A mask without its staircase.
#pragma once

#include <string_view>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis::inline v1 {

/// What progress is reported of.
inline constexpr std::string_view kMaskStage = "mask";

/// Above it a voxel of a mask is inside.
inline constexpr float kMaskLevel = 0.5F;

/// How many voxels away a smoothing of this width looks.
Index reach_of_smoothing(double width);

/// Makes of a mask a grey image that is above 0.5 inside.
///
/// The mask is blurred by a Gaussian kernel. On the boundary of the mask blurred values are about 0.5 where the solid
/// is thick, lower where it is thin, and higher beside narrow gaps: so the level around a voxel is their mean in a
/// window, and thin parts of thick solids keep their volume. Voxels that would take a part with them, or part one, stay
/// on their side. In the end a constant is added that keeps the volume of the mask.
///
/// \param width of the kernel, in voxels; positive
void smooth_mask(Image& mask, double width, const Execution& execution);

}  // namespace scaleaxis::inline v1
