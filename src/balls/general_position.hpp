// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// The balls grown by 2e-9 of their radii and moved by at most 1e-9 of them: less than a file in single precision can
/// tell, but enough for predicates to be decided without exact arithmetic. Balls that touch still do.
std::vector<Ball> in_general_position(std::span<const Ball> balls);

}  // namespace scaleaxis
