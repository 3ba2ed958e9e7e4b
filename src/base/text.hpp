// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pieces of messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// "1 edge", "2 edges". \param many empty: an s is appended
std::string counted(std::int64_t count, std::string_view one, std::string_view many = {});

/// "1 component, 2 tunnels, 0 voids, Euler characteristic -1".
std::string in_words(const Topology& topology);

/// With three digits.
std::string to_text(double value);

/// "12.3 %" of a whole.
std::string percentage(double part, double whole);

/// "(x y z)", of nine digits each.
std::string to_text(const Point& p);

}  // namespace scaleaxis::inline v1
