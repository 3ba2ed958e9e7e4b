// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/segment_crossing.hpp"

#include "spatial/exact/dyadic.hpp"
#include "spatial/exact/predicates.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// On which side of the line `uv` does the moved segment `ab` pass? Moved by t, it changes orientation(a, b, u, v) by
/// t · ((b - a) × (v - u)). Where that is 0 too, the segment is parallel to the edge and crosses no triangle at it.
int side_of_edge(const Point& a, const Point& b, const Point& u, const Point& v) {
    const int sign = orientation(a, b, u, v);
    return sign != 0 ? sign : first_sign_of_cross(a, b, u, v);
}

/// On which side of the plane `uvw` does the moved point lie? Moved by t, it changes orientation(u, v, w, p) by
/// t · normal.
int side_of_plane(const Point& u, const Point& v, const Point& w, const Point& p) {
    const int sign = orientation(u, v, w, p);
    return sign != 0 ? sign : first_sign_of_cross(u, v, u, w);
}

}  // namespace

int sign_of_cross(const Point& a, const Point& b, const Point& c, const Point& d, double Point::*x, double Point::*y) {
    const double left_1 = b.*x - a.*x, left_2 = d.*y - c.*y;
    const double right_1 = b.*y - a.*y, right_2 = d.*x - c.*x;
    if ((left_1 == 0.0 || left_2 == 0.0) && (right_1 == 0.0 || right_2 == 0.0)) {
        return 0;
    }
    const double left = left_1 * left_2, right = right_1 * right_2;
    const double bound = 0x1p-50 * (std::abs(left) + std::abs(right)) + 1e-290;
    if (std::abs(left - right) > bound) {
        return left > right ? 1 : -1;
    }
    const auto difference = [](double p, double q) { return Dyadic(p) - q; };
    return (difference(b.*x, a.*x) * difference(d.*y, c.*y) - difference(b.*y, a.*y) * difference(d.*x, c.*x)).sign();
}

int first_sign_of_cross(const Point& a, const Point& b, const Point& c, const Point& d) {
    if (const int x = sign_of_cross(a, b, c, d, &Point::y, &Point::z)) {
        return x;
    }
    if (const int y = sign_of_cross(a, b, c, d, &Point::z, &Point::x)) {
        return y;
    }
    return sign_of_cross(a, b, c, d, &Point::x, &Point::y);
}

int exact_crossing_sign(const Point& a, const Point& b, const Point& u, const Point& v, const Point& w) {
    const int sign = side_of_edge(a, b, u, v);
    const bool is_through = sign != 0 && side_of_edge(a, b, v, w) == sign && side_of_edge(a, b, w, u) == sign;
    return is_through && side_of_plane(u, v, w, a) != side_of_plane(u, v, w, b) ? sign : 0;
}

SegmentCrossing exact_crossing(const Point& a, const Point& b, const Point& u, const Point& v, const Point& w) {
    const int sign = exact_crossing_sign(a, b, u, v, w);
    if (sign == 0) {
        return {};
    }
    // The ends lie on different sides of the plane, so the determinants do not add up to 0.
    const DyadicVector d = exact_difference(b, a), du = exact_difference(u, a), dv = exact_difference(v, a),
                       dw = exact_difference(w, a);
    const Dyadic at_u = determinant(d, dv, dw), at_v = determinant(d, dw, du), at_w = determinant(d, du, dv);
    const Dyadic sum = at_u + at_v + at_w;
    return {
        sign, quotient(determinant(du, dv, dw), sum), {quotient(at_u, sum), quotient(at_v, sum), quotient(at_w, sum)}};
}

}  // namespace scaleaxis::inline v1
