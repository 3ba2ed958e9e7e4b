// SPDX-License-Identifier: GPL-3.0-or-later
#include "kernel/predicates.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace scaleaxis::kernel::predicate_details {

namespace {

using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;

Exact::Point_3 exact(const Point& p) { return {p.x, p.y, p.z}; }
Exact::Weighted_point_3 exact(const Point& p, double w) { return {exact(p), w}; }

/// An unevaluated sum of two doubles of which the second is tiny: about 106 bits.
struct DoubleDouble {
    double high;
    double low;
};

DoubleDouble two_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

DoubleDouble quick_two_sum(double large, double small) {
    const double sum = large + small;
    return {sum, small - (sum - large)};
}

DoubleDouble two_product(double a, double b) {
    constexpr double kSplitter = 134217729.0;  // 2^27 + 1 (Dekker)
    const double product = a * b;
    const double ca = kSplitter * a, cb = kSplitter * b;
    const double a_high = ca - (ca - a), b_high = cb - (cb - b);
    const double a_low = a - a_high, b_low = b - b_high;
    return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

DoubleDouble difference(double a, double b) { return two_sum(a, -b); }

// The error of a sum is at most 4 ε² (|a| + |b|), that of a product at most 8 ε² |a b|.
DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble sum = two_sum(a.high, b.high);
    return quick_two_sum(sum.high, sum.low + (a.low + b.low));
}
DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble product = two_product(a.high, b.high);
    return quick_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/// Row of a determinant: a difference of two points, exactly, and its lift.
struct Row {
    DoubleDouble x, y, z, lift;
    double lift_magnitude;  ///< the terms of the lift, all taken positive
};

Row row(const Point& a, const Point& e) {
    Row r{difference(a.x, e.x), difference(a.y, e.y), difference(a.z, e.z), {}, 0.0};
    r.lift = r.x * r.x + r.y * r.y + r.z * r.z;
    r.lift_magnitude = r.lift.high;
    return r;
}

Row row(const Point& a, double wa, const Point& e, double we) {
    Row r = row(a, e);
    const DoubleDouble weight = difference(wa, we);
    r.lift = r.lift - weight;
    r.lift_magnitude += std::abs(weight.high);
    return r;
}

/// Sign of the determinant of four rows, or 0 if its value is too small to tell. Added up along its deepest branch
/// the error is below 70 ε² times the permanent.
int lifted_sign(const Row& a, const Row& b, const Row& c, const Row& d) {
    const DoubleDouble ab = a.x * b.y - b.x * a.y;
    const DoubleDouble bc = b.x * c.y - c.x * b.y;
    const DoubleDouble cd = c.x * d.y - d.x * c.y;
    const DoubleDouble da = d.x * a.y - a.x * d.y;
    const DoubleDouble ac = a.x * c.y - c.x * a.y;
    const DoubleDouble bd = b.x * d.y - d.x * b.y;
    const DoubleDouble abc = a.z * bc - b.z * ac + c.z * ab;
    const DoubleDouble bcd = b.z * cd - c.z * bd + d.z * bc;
    const DoubleDouble cda = c.z * da + d.z * ac + a.z * cd;
    const DoubleDouble dab = d.z * ab + a.z * bd + b.z * da;
    const DoubleDouble value = (c.lift * dab - d.lift * abc) + (a.lift * bcd - b.lift * cda);

    const auto point = [](const Row& r) { return Point{r.x.high, r.y.high, r.z.high}; };
    const double permanent = lifted_determinant(point(a), 0, a.lift_magnitude, point(b), 0, b.lift_magnitude,  //
                                                point(c), 0, c.lift_magnitude, point(d), 0, d.lift_magnitude)
                                 .permanent;
    const double bound = 128 * kEpsilon * kEpsilon * permanent + kUnderflow;
    return value.high > bound ? 1 : value.high < -bound ? -1 : 0;
}

}  // namespace

int orientation_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d) {
    return static_cast<int>(Exact().orientation_3_object()(exact(a), exact(b), exact(c), exact(d)));
}

int in_sphere_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e) {
    const int sign = lifted_sign(row(a, e), row(b, e), row(c, e), row(d, e));
    if (sign != 0) {
        return sign;
    }
    return static_cast<int>(
        Exact().side_of_oriented_sphere_3_object()(exact(a), exact(b), exact(c), exact(d), exact(e)));
}

int in_power_sphere_beyond_filter(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc,
                                  const Point& d, double wd, const Point& e, double we) {
    const int sign = lifted_sign(row(a, wa, e, we), row(b, wb, e, we), row(c, wc, e, we), row(d, wd, e, we));
    if (sign != 0) {
        return sign;
    }
    return static_cast<int>(Exact().power_side_of_oriented_power_sphere_3_object()(
        exact(a, wa), exact(b, wb), exact(c, wc), exact(d, wd), exact(e, we)));
}

}  // namespace scaleaxis::kernel::predicate_details
