// SPDX-License-Identifier: Apache-2.0
/// \file
/// Exact signs of determinants: a filter in double precision, then in double-double, then exact arithmetic
/// (`Dyadic`). The coordinates and weights must be finite.
///
/// The bounds of the filters are those of J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
/// Geometric Predicates" (1997): a multiple of the permanent, which is the determinant with all terms taken positive.
/// They hold as long as nothing is contracted or reordered by the compiler. Where a term overflows, or the result is so
/// small that underflow may have spoiled it, exact arithmetic decides.
#pragma once

#include <cmath>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

namespace predicate_details {

constexpr double kEpsilon = 0x1p-53;
constexpr double kUnderflow = 1e-140;

// What the inline filters below cannot decide.
int orientation_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d);
int in_sphere_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e);
int in_power_sphere_beyond_filter(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc,
                                  const Point& d, double wd, const Point& e, double we);

/// The sign that `in_power_sphere` has (with weights of 0 that of `in_sphere`), or 0 where it is too small to tell.
/// Cheap for points that are almost on the sphere, as all around one ball of a union are: with the power to the sphere
/// for their lifts, which leaves the determinant as it is, double precision is enough for all but these. \param
/// twice_center about twice the center of the sphere, relative to `d`
int sign_near_sphere(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc, const Point& d,
                     double wd, const Point& e, double we, const Point& twice_center);

/// Determinant of the rows (a, la), (b, lb), (c, lc), (d, ld), and its permanent with `pa` … `pd` for |la| … |ld|.
struct Determinant {
    double value;
    double permanent;
};
inline Determinant lifted_determinant(const Point& a, double la, double pa, const Point& b, double lb, double pb,
                                      const Point& c, double lc, double pc, const Point& d, double ld, double pd) {
    const double axby = a.x * b.y, bxay = b.x * a.y, ab = axby - bxay, pab = std::abs(axby) + std::abs(bxay);
    const double bxcy = b.x * c.y, cxby = c.x * b.y, bc = bxcy - cxby, pbc = std::abs(bxcy) + std::abs(cxby);
    const double cxdy = c.x * d.y, dxcy = d.x * c.y, cd = cxdy - dxcy, pcd = std::abs(cxdy) + std::abs(dxcy);
    const double dxay = d.x * a.y, axdy = a.x * d.y, da = dxay - axdy, pda = std::abs(dxay) + std::abs(axdy);
    const double axcy = a.x * c.y, cxay = c.x * a.y, ac = axcy - cxay, pac = std::abs(axcy) + std::abs(cxay);
    const double bxdy = b.x * d.y, dxby = d.x * b.y, bd = bxdy - dxby, pbd = std::abs(bxdy) + std::abs(dxby);
    const double az = std::abs(a.z), bz = std::abs(b.z), cz = std::abs(c.z), dz = std::abs(d.z);

    const double abc = a.z * bc - b.z * ac + c.z * ab;
    const double bcd = b.z * cd - c.z * bd + d.z * bc;
    const double cda = c.z * da + d.z * ac + a.z * cd;
    const double dab = d.z * ab + a.z * bd + b.z * da;
    const double value = (lc * dab - ld * abc) + (la * bcd - lb * cda);
    const double permanent = (az * pbc + bz * pac + cz * pab) * pd + (dz * pab + az * pbd + bz * pda) * pc +
                             (cz * pda + dz * pac + az * pcd) * pb + (bz * pcd + cz * pbd + dz * pbc) * pa;
    return {value, permanent};
}

}  // namespace predicate_details

/// Sign of the volume of the tetrahedron `abcd`, of det[b - a, c - a, d - a]: +1 if it is positively oriented.
inline int orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
    using namespace predicate_details;
    const Point u = b - a, v = c - a, w = d - a;
    const double vxwy = v.x * w.y, wxvy = w.x * v.y;
    const double wxuy = w.x * u.y, uxwy = u.x * w.y;
    const double uxvy = u.x * v.y, vxuy = v.x * u.y;
    const double value = u.z * (vxwy - wxvy) + v.z * (wxuy - uxwy) + w.z * (uxvy - vxuy);
    const double permanent = std::abs(u.z) * (std::abs(vxwy) + std::abs(wxvy)) +
                             std::abs(v.z) * (std::abs(wxuy) + std::abs(uxwy)) +
                             std::abs(w.z) * (std::abs(uxvy) + std::abs(vxuy));
    const double bound = 8 * kEpsilon * permanent + kUnderflow;
    if (value > bound) {
        return 1;
    }
    return value < -bound ? -1 : orientation_beyond_filter(a, b, c, d);
}

/// On which side of the sphere through the positively oriented tetrahedron `abcd` does `e` lie? +1: inside.
inline int in_sphere(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e) {
    using namespace predicate_details;
    const Point ae = a - e, be = b - e, ce = c - e, de = d - e;
    const double la = squared_norm(ae), lb = squared_norm(be), lc = squared_norm(ce), ld = squared_norm(de);
    const auto [value, permanent] = lifted_determinant(ae, la, la, be, lb, lb, ce, lc, lc, de, ld, ld);
    const double bound = 17 * kEpsilon * permanent + kUnderflow;
    if (value > bound) {
        return 1;
    }
    return value < -bound ? -1 : in_sphere_beyond_filter(a, b, c, d, e);
}

/// The same for weighted points: +1 if the power product of `e`, of weight `we`, with the orthogonal sphere of `abcd`
/// is negative, that is, if `e` is in conflict with that cell of a regular triangulation.
inline int in_power_sphere(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc,
                           const Point& d, double wd, const Point& e, double we) {
    using namespace predicate_details;
    const Point ae = a - e, be = b - e, ce = c - e, de = d - e;
    const double sa = squared_norm(ae), sb = squared_norm(be), sc = squared_norm(ce), sd = squared_norm(de);
    const double va = wa - we, vb = wb - we, vc = wc - we, vd = wd - we;
    const auto [value, permanent] =
        lifted_determinant(ae, sa - va, sa + std::abs(va), be, sb - vb, sb + std::abs(vb),  //
                           ce, sc - vc, sc + std::abs(vc), de, sd - vd, sd + std::abs(vd));
    const double bound = 20 * kEpsilon * permanent + kUnderflow;
    if (value > bound) {
        return 1;
    }
    return value < -bound ? -1 : in_power_sphere_beyond_filter(a, wa, b, wb, c, wc, d, wd, e, we);
}

}  // namespace scaleaxis::inline v1
