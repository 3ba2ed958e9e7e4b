// SPDX-License-Identifier: Apache-2.0
/// \file
/// The trilinear interpolant of values at the corners of a cell: that of bit 0 along x, bit 1 along y, bit 2 along z.
#pragma once

#include <array>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Between `a` and `b`. Where both have one sign, so has the result, rounding or not.
inline double lerp(double a, double b, double t) { return (1.0 - t) * a + t * b; }

/// The interpolant at coordinates from 0 to 1.
template <class Number>
double interpolated(const std::array<Number, 8>& v, const Point& p) {
    return lerp(lerp(lerp(v[0], v[1], p.x), lerp(v[2], v[3], p.x), p.y),
                lerp(lerp(v[4], v[5], p.x), lerp(v[6], v[7], p.x), p.y), p.z);
}

/// The gradient of the interpolant at coordinates from 0 to 1, by these coordinates.
inline Point gradient(const std::array<double, 8>& v, const Point& p) {
    return {lerp(lerp(v[1] - v[0], v[3] - v[2], p.y), lerp(v[5] - v[4], v[7] - v[6], p.y), p.z),
            lerp(lerp(v[2] - v[0], v[3] - v[1], p.x), lerp(v[6] - v[4], v[7] - v[5], p.x), p.z),
            lerp(lerp(v[4] - v[0], v[5] - v[1], p.x), lerp(v[6] - v[2], v[7] - v[3], p.x), p.y)};
}

}  // namespace scaleaxis::inline v1
