// SPDX-License-Identifier: Apache-2.0
/// \file
/// The volume of what lies above a level of an image, where that is near 0.5.
#pragma once

#include "scaleaxis/image.hpp"

namespace scaleaxis::inline v1 {

/// How much volume has values of the trilinear interpolant above a level, in voxels. At its border the image goes on
/// for half a voxel, as the solid does that is closed there. \param volume about that of the solid: it is known to a
/// part of it
double volume_above(const ImageView& image, float level, double volume);

/// The level above which there is such a volume.
float level_with_volume(const ImageView& image, double volume);

/// By how many voxels the volume of a mask may differ from their number: two standard deviations, if the boundary cuts
/// off any part of a voxel at each side between inside and outside, independently of the others.
double volume_uncertainty(const ImageView& mask);

}  // namespace scaleaxis::inline v1
