// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sizes and places that double precision can compute with.
#pragma once

#include <span>
#include <string_view>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Larger coordinates are marks of absent data, as FLT_MAX and 1e30 are, or damage. Squares of those up to it stay
/// within single precision, in which trees compare distances.
inline constexpr double kLargestCoordinate = 1e18;

/// Are all coordinates finite and not beyond `kLargestCoordinate`?
bool is_usable(const Point& p);

/// What to say of a point that is not usable, whatever it is part of.
inline constexpr const char* kUnusableCoordinate =
    "has a coordinate that is not a finite number up to 1e18, perhaps a mark of absent data; correct or remove it, or "
    "scale the model";

/// Empty if there are no points.
Box box_around(std::span<const Point> points);

/// Why an input with these bounds cannot be computed with; empty if it can. Products of five lengths have to stay
/// within the range of a double, and differences of coordinates need enough digits. Codes: "size.none", "size.too_far"
/// (from the origin), "size.too_small", "size.too_large". \param box finite, not empty \param elements what the box is
/// around, for the message: "vertices", "points"…
Diagnostic extent_fault(const Box& box, std::string_view elements = "points");

}  // namespace scaleaxis::inline v1
