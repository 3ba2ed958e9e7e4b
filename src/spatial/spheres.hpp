// SPDX-License-Identifier: Apache-2.0
/// \file
/// Spheres through points and orthogonal to balls: coordinates in double precision, signs exact.
#pragma once

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The sphere through the corners of a tetrahedron. Where its radius exceeds `limit` only that is certain: the radius
/// is then infinite and the centre is not set.
struct Circumsphere {
    Point center;
    double radius = 0.0;
};
Circumsphere circumsphere(const Point& a, const Point& b, const Point& c, const Point& d, double limit);

/// Radius of the circle through the corners of a triangle, to within rounding; infinite if it has no area.
inline double circumradius(const Point& a, const Point& b, const Point& c) {
    const Point u = b - a;
    const Point v = c - a;
    return norm(u) * norm(v) * norm(u - v) / (2.0 * norm(cross(u, v)));
}

/// The smallest sphere orthogonal to some balls. `power` is its squared radius, which is negative where the balls have
/// a common point.
struct OrthogonalSphere {
    Point center;
    double power = 0.0;
};
OrthogonalSphere orthogonal_sphere(const Ball& a, const Ball& b);
OrthogonalSphere orthogonal_sphere(const Ball& a, const Ball& b, const Ball& c);
OrthogonalSphere orthogonal_sphere(const Ball& a, const Ball& b, const Ball& c, const Ball& d);

/// Do the balls have a point in common that is equally deep in all of them (is the power of their smallest orthogonal
/// sphere ≤ 0)? Exact.
bool meet(const Ball& a, const Ball& b);
bool meet(const Ball& a, const Ball& b, const Ball& c);
bool meet(const Ball& a, const Ball& b, const Ball& c, const Ball& d);

/// Is the smallest orthogonal sphere of the first balls nearer than orthogonal to the last one (does the last one keep
/// their simplex from being Gabriel)? Exact.
bool conflicts(const Ball& a, const Ball& other);
bool conflicts(const Ball& a, const Ball& b, const Ball& other);
bool conflicts(const Ball& a, const Ball& b, const Ball& c, const Ball& other);

/// Of each of four balls: is it in conflict with the smallest sphere orthogonal to the three others? Bit `k` for ball
/// `k`. As four calls of `conflicts`, but cheaper.
unsigned conflicts_of_corners(const Ball& a, const Ball& b, const Ball& c, const Ball& d);

}  // namespace scaleaxis::inline v1
