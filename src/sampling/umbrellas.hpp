// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scaleaxis/sampling.hpp"

namespace scaleaxis {

/// Counts the restricted facets, and the samples at which they do not form exactly one topological disk: there the
/// restricted surface is no manifold.
void count_umbrellas(Samples& samples);

}  // namespace scaleaxis
