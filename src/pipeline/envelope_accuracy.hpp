// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far a solid and the envelope of its axis are apart.
#pragma once

#include <span>

#include "scaleaxis/envelope.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// \param samples of the boundary of the solid \param solid null, or knows nearest points
/// \param spacing of the points on the envelope
EnvelopeAccuracy accuracy_of(const Envelope& envelope, std::span<const Point> samples, const Solid* solid,
                             double spacing);

/// How far the envelope is from points of the boundary of a solid about `spacing` apart, at most, some of them on the
/// sharp edges of a mesh, where the envelope ends first. Adaptive samples are farther apart than that.
/// \param solid knows nearest points
double largest_distance_from(const Solid& solid, const Envelope& envelope, double spacing, const Execution& execution);

}  // namespace scaleaxis::inline v1
