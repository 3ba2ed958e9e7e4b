// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which sheets of axes at several scales are the same to the eye.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::view {

/// The number of a colour for each sheet of each axis. A sheet has that of the sheet of the axis before on which most
/// of its area lies: within half the radius of its balls. If it lies on none, or another one with more area lies on the
/// same, the number is new, so that sheets that meet can be told apart.
/// \param axes valid (see `check`), by ascending scale \returns #axes × #sheets; of the first axis the sheets' numbers
std::vector<std::vector<Index>> sheet_colors(std::span<const MedialComplex* const> axes);

}  // namespace scaleaxis::view
