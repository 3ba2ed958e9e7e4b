// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sheets so narrow that they are but a seam, or the border of another one.
#pragma once

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// Draws sheets of a mean width below half of `size` together, by contracting their edges that are shorter than `size`
/// where that keeps the homotopy type. Where balls are small half their radius takes the place of `size`. Sheets at
/// sharp edges of the solid, with balls of radius 0, stay. \param scale factor by which the balls had been grown, whose
/// radii count
MedialComplex without_slivers(MedialComplex complex, double size, double scale);

}  // namespace scaleaxis::inline v1
