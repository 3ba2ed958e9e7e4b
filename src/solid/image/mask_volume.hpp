// SPDX-License-Identifier: Apache-2.0
/// \file
/// The volume of what lies above a level of an image of values from 0 to 1.
#pragma once

#include <cstdint>
#include <vector>

#include "scaleaxis/image.hpp"

namespace scaleaxis::inline v1 {

/// How much volume of an image, in voxels, has which values of the trilinear interpolant. At its border the image goes
/// on for half a voxel, as the solid does that is closed there.
class ValueVolumes {
   public:
    /// \param volume about that of the solid, in voxels
    ValueVolumes(const ImageView& image, double volume);

    double above(float level) const;
    /// The level above which there is such a volume.
    float level_of(double volume) const;

   private:
    std::vector<std::int64_t> classes_;  ///< of points
    std::int64_t points_in_voxel_ = 1;
};

/// By how many voxels the volume of a mask may differ from their number: two standard deviations, if the boundary cuts
/// off any part of a voxel at each side between inside and outside, independently of the others.
double volume_uncertainty(const ImageView& mask);

}  // namespace scaleaxis::inline v1
