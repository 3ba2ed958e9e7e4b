// SPDX-License-Identifier: Apache-2.0
#include "spatial/predicates.hpp"

#include <array>
#include <utility>

#include "spatial/dyadic.hpp"

namespace scaleaxis::predicate_details {

namespace {

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

/// Row of a lifted determinant: a point relative to `e`, and its squared length less its weight relative to `e`.
template <class Number>
struct Row {
    Number x, y, z, lift;
};

using Rows = std::array<Row<DoubleDouble>, 4>;
using ExactRows = std::array<Row<Dyadic>, 4>;

template <class Number>
Number determinant(const std::array<Row<Number>, 4>& rows) {
    const auto& [a, b, c, d] = rows;
    const Number ab = a.x * b.y - b.x * a.y;
    const Number bc = b.x * c.y - c.x * b.y;
    const Number cd = c.x * d.y - d.x * c.y;
    const Number da = d.x * a.y - a.x * d.y;
    const Number ac = a.x * c.y - c.x * a.y;
    const Number bd = b.x * d.y - d.x * b.y;
    const Number abc = a.z * bc - b.z * ac + c.z * ab;
    const Number bcd = b.z * cd - c.z * bd + d.z * bc;
    const Number cda = c.z * da + d.z * ac + a.z * cd;
    const Number dab = d.z * ab + a.z * bd + b.z * da;
    return (c.lift * dab - d.lift * abc) + (a.lift * bcd - b.lift * cda);
}

Row<DoubleDouble> row(const Point& p, const Point& e) {
    Row<DoubleDouble> r{difference(p.x, e.x), difference(p.y, e.y), difference(p.z, e.z), {}};
    r.lift = r.x * r.x + r.y * r.y + r.z * r.z;
    return r;
}

Row<Dyadic> exact_row(const Point& p, const Point& e) {
    DyadicVector v = exact_difference(p, e);
    Dyadic lift = squared_norm(v);
    return {std::move(v.x), std::move(v.y), std::move(v.z), std::move(lift)};
}

/// Sign of the determinant, or 0 if its value is too small to tell. Added up along its deepest branch the error is
/// below 70 ε² times the permanent. \param lifts the terms of each row's lift, all taken positive
int certain_sign(const Rows& rows, const std::array<double, 4>& lifts) {
    const auto point = [&](int i) { return Point{rows[i].x.high, rows[i].y.high, rows[i].z.high}; };
    const double permanent = lifted_determinant(point(0), 0, lifts[0], point(1), 0, lifts[1],  //
                                                point(2), 0, lifts[2], point(3), 0, lifts[3])
                                 .permanent;
    const double bound = 128 * kEpsilon * kEpsilon * permanent + kUnderflow;
    const double value = determinant(rows).high;
    return value > bound ? 1 : value < -bound ? -1 : 0;
}

}  // namespace

int orientation_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d) {
    return determinant(exact_difference(b, a), exact_difference(c, a), exact_difference(d, a)).sign();
}

int in_sphere_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e) {
    const Rows rows{row(a, e), row(b, e), row(c, e), row(d, e)};
    const int sign = certain_sign(rows, {rows[0].lift.high, rows[1].lift.high, rows[2].lift.high, rows[3].lift.high});
    return sign != 0
               ? sign
               : determinant(ExactRows{exact_row(a, e), exact_row(b, e), exact_row(c, e), exact_row(d, e)}).sign();
}

int in_power_sphere_beyond_filter(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc,
                                  const Point& d, double wd, const Point& e, double we) {
    const std::array<double, 4> weights{wa, wb, wc, wd};
    Rows rows{row(a, e), row(b, e), row(c, e), row(d, e)};
    std::array<double, 4> lifts;
    for (int i = 0; i < 4; ++i) {
        const DoubleDouble weight = difference(weights[i], we);
        lifts[i] = rows[i].lift.high + std::abs(weight.high);
        rows[i].lift = rows[i].lift - weight;
    }
    const int sign = certain_sign(rows, lifts);
    if (sign != 0) {
        return sign;
    }
    ExactRows exact{exact_row(a, e), exact_row(b, e), exact_row(c, e), exact_row(d, e)};
    for (int i = 0; i < 4; ++i) {
        exact[i].lift = exact[i].lift - (Dyadic(weights[i]) - we);
    }
    return determinant(exact).sign();
}

}  // namespace scaleaxis::predicate_details
