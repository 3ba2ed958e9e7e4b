// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pieces of messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// "1 edge", "2 edges".
std::string counted(std::int64_t count, std::string_view one, std::string_view many);

/// "(x y z)", of nine digits each.
std::string to_text(const Point& p);

}  // namespace scaleaxis
