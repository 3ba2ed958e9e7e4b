// SPDX-License-Identifier: Apache-2.0
/// \file
/// The volume of what a smoothed mask makes solid.
#pragma once

#include "scaleaxis/image.hpp"

namespace scaleaxis::inline v1 {

/// The volume where the trilinear interpolant of an image lies above a level, in voxels; of lines a fifth of a voxel
/// apart. At its border the image goes on for half a voxel.
double interpolated_volume(const ImageView& image, float level);

}  // namespace scaleaxis::inline v1
