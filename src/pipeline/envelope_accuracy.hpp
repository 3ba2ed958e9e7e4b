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

}  // namespace scaleaxis::inline v1
