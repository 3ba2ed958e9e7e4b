// SPDX-License-Identifier: Apache-2.0
/// \file
/// Complexes that are cut where a function changes its sign.
#pragma once

#include <span>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// The part of a complex where a function is not negative. Edges are cut where it is zero if it is linear along them.
/// \param values of the function, #V
MedialComplex clipped(const MedialComplex& complex, std::span<const double> values);

}  // namespace scaleaxis::inline v1
