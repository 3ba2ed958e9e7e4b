// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Exact signs of determinants: a filter in double precision, then exact arithmetic.
#pragma once

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::kernel {

/// Sign of the volume of the tetrahedron `abcd`: +1 if `d` sees `abc` clockwise… that is, if `abcd` is positively
/// oriented in CGAL's sense (det[b - a, c - a, d - a] > 0).
int orientation(const Point& a, const Point& b, const Point& c, const Point& d);

/// Exact sign of the side of `e` to the sphere through the positively oriented tetrahedron `abcd`: +1 inside.
int in_sphere(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e);

/// The same for weighted points: +1 if `e`, of weight `we`, has a negative power product with the orthogonal sphere of
/// `abcd` (it is in conflict with that cell of a regular triangulation).
int in_power_sphere(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc, const Point& d,
                    double wd, const Point& e, double we);

}  // namespace scaleaxis::kernel
