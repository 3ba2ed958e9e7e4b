// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/segment_crossing.hpp"

#include <CGAL/Exact_rational.h>

#include <utility>

#include "kernel/predicates.hpp"

namespace scaleaxis {
namespace {

using Exact = CGAL::Exact_rational;

/// Sign of (b - a) × (d - c) of a plane, given by two axes.
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
    // The type is named because Exact may have expression templates, which must not outlive their operands.
    const auto difference = [](double p, double q) -> Exact { return Exact(p) - Exact(q); };
    return static_cast<int>(CGAL::compare(difference(b.*x, a.*x) * difference(d.*y, c.*y),
                                          difference(b.*y, a.*y) * difference(d.*x, c.*x)));
}

/// On which side of the line `uv` does the moved segment `ab` pass? Moved by t, it changes orientation(a, b, u, v) by
/// t · ((b - a) × (v - u)). Where that is 0 too, the segment is parallel to the edge and crosses no triangle at it.
int side_of_edge(const Point& a, const Point& b, const Point& u, const Point& v) {
    const int sign = kernel::orientation(a, b, u, v);
    return sign != 0 ? sign : first_sign_of_cross(a, b, u, v);
}

/// On which side of the plane `uvw` does the moved point lie? Moved by t, it changes orientation(u, v, w, p) by
/// t · normal.
int side_of_plane(const Point& u, const Point& v, const Point& w, const Point& p) {
    const int sign = kernel::orientation(u, v, w, p);
    return sign != 0 ? sign : first_sign_of_cross(u, v, u, w);
}

struct ExactVector {
    Exact x, y, z;
};
ExactVector difference(const Point& p, const Point& q) {
    return {Exact(p.x) - Exact(q.x), Exact(p.y) - Exact(q.y), Exact(p.z) - Exact(q.z)};
}
Exact determinant(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

}  // namespace

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
    const ExactVector d = difference(b, a), du = difference(u, a), dv = difference(v, a), dw = difference(w, a);
    const Exact at_u = determinant(d, dv, dw), at_v = determinant(d, dw, du), at_w = determinant(d, du, dv);
    const Exact sum = at_u + at_v + at_w;
    return {sign,
            CGAL::to_double(determinant(du, dv, dw) / sum),
            {CGAL::to_double(at_u / sum), CGAL::to_double(at_v / sum), CGAL::to_double(at_w / sum)}};
}

}  // namespace scaleaxis
