// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The trilinear interpolant of values at the corners of a cell: that of bit 0 along x, bit 1 along y, bit 2 along z.
#pragma once

#include <array>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// Between `a` and `b`. Where both have one sign, so has the result, rounding or not.
inline double mixed(double a, double b, double t) { return (1.0 - t) * a + t * b; }

/// The interpolant at coordinates from 0 to 1.
template <class Number>
double interpolated(const std::array<Number, 8>& v, const Point& p) {
    return mixed(mixed(mixed(v[0], v[1], p.x), mixed(v[2], v[3], p.x), p.y),
                 mixed(mixed(v[4], v[5], p.x), mixed(v[6], v[7], p.x), p.y), p.z);
}

}  // namespace scaleaxis
