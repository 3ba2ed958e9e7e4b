// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sizes and places that double precision can compute with.
#pragma once

#include <span>
#include <string_view>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// Empty if there are no points.
Box box_around(std::span<const Point> points);

/// Why an input with these bounds cannot be computed with; empty if it can. Products of five lengths have to stay
/// within the range of a double, and differences of coordinates need enough digits. Codes: "size.none", "size.too_far"
/// (from the origin), "size.too_small", "size.too_large". \param box finite, not empty \param elements what the box is
/// around, for the message: "vertices", "points"…
Diagnostic extent_fault(const Box& box, std::string_view elements = "points");

}  // namespace scaleaxis
