// SPDX-License-Identifier: Apache-2.0
#include "spatial/exact/predicates.hpp"

#include <array>
#include <utility>

#include "base/compiler.hpp"
#include "spatial/exact/dyadic.hpp"

namespace scaleaxis::inline v1::predicate_details {

namespace {

/// A number of each of four rows, computed with at once.
template <class Number>
struct Four {
    std::array<Number, 4> of;

    Number operator[](std::size_t i) const { return of[i]; }
    friend Four operator+(const Four& a, const Four& b) {
        return {a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2], a.of[3] + b.of[3]};
    }
    friend Four operator-(const Four& a, const Four& b) {
        return {a.of[0] - b.of[0], a.of[1] - b.of[1], a.of[2] - b.of[2], a.of[3] - b.of[3]};
    }
    friend Four operator*(const Four& a, const Four& b) {
        return {a.of[0] * b.of[0], a.of[1] * b.of[1], a.of[2] * b.of[2], a.of[3] * b.of[3]};
    }
    /// Of each row the number of the next one, and of the one after that.
    friend Four next(const Four& a) { return {a.of[1], a.of[2], a.of[3], a.of[0]}; }
    friend Four next_but_one(const Four& a) { return {a.of[2], a.of[3], a.of[0], a.of[1]}; }
};

template <>
struct Four<double> {
    Double2 low, high;

    Four(double a, double b, double c, double d) : low{a, b}, high{c, d} {}
    Four(Double2 ab, Double2 cd) : low(ab), high(cd) {}
    double operator[](std::size_t i) const { return i < 2 ? low[i] : high[i - 2]; }
    friend Four operator+(const Four& a, const Four& b) { return {a.low + b.low, a.high + b.high}; }
    friend Four operator-(const Four& a, const Four& b) { return {a.low - b.low, a.high - b.high}; }
    friend Four operator*(const Four& a, const Four& b) { return {a.low * b.low, a.high * b.high}; }
    friend Four next(const Four& a) { return {a.low[1], a.high[0], a.high[1], a.low[0]}; }
    friend Four next_but_one(const Four& a) { return {a.high, a.low}; }
};

/// Unevaluated sums of two doubles of which the second is tiny: about 106 bits.
struct DoubleDouble {
    double high;
    double low;
};

template <>
struct Four<DoubleDouble> {
    Four<double> high;
    Four<double> low;

    DoubleDouble operator[](std::size_t i) const { return {high[i], low[i]}; }
    friend Four next(const Four& a) { return {next(a.high), next(a.low)}; }
    friend Four next_but_one(const Four& a) { return {next_but_one(a.high), next_but_one(a.low)}; }
};

Four<DoubleDouble> two_sum(const Four<double>& a, const Four<double>& b) {
    const Four<double> sum = a + b;
    const Four<double> b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

Four<DoubleDouble> two_difference(const Four<double>& a, const Four<double>& b) {
    const Four<double> difference = a - b;
    const Four<double> b_part = a - difference;
    return {difference, (a - (difference + b_part)) - (b - b_part)};
}

Four<DoubleDouble> quick_two_sum(const Four<double>& large, const Four<double>& small) {
    const Four<double> sum = large + small;
    return {sum, small - (sum - large)};
}

Four<DoubleDouble> two_product(const Four<double>& a, const Four<double>& b) {
    constexpr double kSplitter = 134217729.0;  // 2^27 + 1 (Dekker)
    const Four<double> splitter(kSplitter, kSplitter, kSplitter, kSplitter);
    const Four<double> product = a * b;
    const Four<double> ca = splitter * a, cb = splitter * b;
    const Four<double> a_high = ca - (ca - a), b_high = cb - (cb - b);
    const Four<double> a_low = a - a_high, b_low = b - b_high;
    return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

// The error of a sum is at most 4 ε² (|a| + |b|), that of a product at most 8 ε² |a b|.
Four<DoubleDouble> operator+(const Four<DoubleDouble>& a, const Four<DoubleDouble>& b) {
    const Four<DoubleDouble> sum = two_sum(a.high, b.high);
    return quick_two_sum(sum.high, sum.low + (a.low + b.low));
}
Four<DoubleDouble> operator-(const Four<DoubleDouble>& a, const Four<DoubleDouble>& b) {
    const Four<DoubleDouble> difference = two_difference(a.high, b.high);
    return quick_two_sum(difference.high, difference.low + (a.low - b.low));
}
Four<DoubleDouble> operator*(const Four<DoubleDouble>& a, const Four<DoubleDouble>& b) {
    const Four<DoubleDouble> product = two_product(a.high, b.high);
    return quick_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/// Four rows of a lifted determinant: points relative to `e`, and their squared lengths less their weights relative to
/// that of `e`.
template <class Number>
struct Rows {
    Four<Number> x, y, z, lift;
};

/// The products of a row's lift and the minor of the three other rows. Their determinant is that of the first less that
/// of the second, and so on.
template <class Number>
Four<Number> terms_of_determinant(const Rows<Number>& rows) {
    const auto& [x, y, z, lift] = rows;
    const Four<Number> with_next = x * next(y) - next(x) * y;
    const Four<Number> with_next_but_one = x * next_but_one(y) - next_but_one(x) * y;
    const Four<Number> of_three = z * next(with_next) - next(z) * with_next_but_one + next_but_one(z) * with_next;
    return lift * next(of_three);
}

/// Coordinate `k` of four points relative to `e`.
Four<DoubleDouble> differences(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e,
                               double Point::*k) {
    return two_difference({a.*k, b.*k, c.*k, d.*k}, {e.*k, e.*k, e.*k, e.*k});
}

Rows<DoubleDouble> rows_of(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e) {
    const Four<DoubleDouble> x = differences(a, b, c, d, e, &Point::x);
    const Four<DoubleDouble> y = differences(a, b, c, d, e, &Point::y);
    const Four<DoubleDouble> z = differences(a, b, c, d, e, &Point::z);
    return {x, y, z, x * x + y * y + z * z};
}

Rows<Dyadic> exact_rows_of(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e) {
    Rows<Dyadic> rows;
    const std::array<Point, 4> points{a, b, c, d};
    for (std::size_t i = 0; i < points.size(); ++i) {
        DyadicVector v = exact_difference(points[i], e);
        rows.lift.of[i] = squared_norm(v);
        rows.x.of[i] = std::move(v.x);
        rows.y.of[i] = std::move(v.y);
        rows.z.of[i] = std::move(v.z);
    }
    return rows;
}

/// Sign of the determinant, or 0 if its value is too small to tell. Added up along its deepest branch the error is
/// below 70 ε² times the permanent. \param lifts the terms of each row's lift, all taken positive
int certain_sign(const Rows<DoubleDouble>& rows, const std::array<double, 4>& lifts) {
    const auto point = [&](std::size_t i) { return Point{rows.x.high[i], rows.y.high[i], rows.z.high[i]}; };
    const double permanent = lifted_determinant(point(0), 0, lifts[0], point(1), 0, lifts[1],  //
                                                point(2), 0, lifts[2], point(3), 0, lifts[3])
                                 .permanent;
    const double bound = 128 * kEpsilon * kEpsilon * permanent + kUnderflow;
    const Four<DoubleDouble> terms = terms_of_determinant(rows);
    const Four<DoubleDouble> differences = terms - next(terms);
    const double value = (differences + next_but_one(differences))[0].high;
    return value > bound ? 1 : value < -bound ? -1 : 0;
}

int exact_sign(const Rows<Dyadic>& rows) {
    const Four<Dyadic> terms = terms_of_determinant(rows);
    return ((terms[0] - terms[1]) + (terms[2] - terms[3])).sign();
}

}  // namespace

int orientation_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d) {
    return determinant(exact_difference(b, a), exact_difference(c, a), exact_difference(d, a)).sign();
}

int sign_near_sphere(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc, const Point& d,
                     double wd, const Point& e, double we, const Point& twice_center) {
    const auto same = [](double number) { return Four<double>(number, number, number, number); };
    const Point twice_from_e = twice_center + 2.0 * (d - e);
    const Four<DoubleDouble> x = differences(a, b, c, d, e, &Point::x);
    const Four<DoubleDouble> y = differences(a, b, c, d, e, &Point::y);
    const Four<DoubleDouble> z = differences(a, b, c, d, e, &Point::z);
    const auto power_along = [&](const Four<DoubleDouble>& k, double twice) {
        return k * (k - Four<DoubleDouble>{same(twice), same(0.0)});
    };
    const Four<DoubleDouble> weight = two_difference({wa, wb, wc, wd}, same(we));
    const Four<DoubleDouble> lift =
        power_along(x, twice_from_e.x) + power_along(y, twice_from_e.y) + power_along(z, twice_from_e.z) - weight;
    std::array<Point, 4> points;
    std::array<double, 4> sizes;
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = {x.high[i], y.high[i], z.high[i]};
        const auto size_along = [](double k, double twice) { return std::abs(k) * (std::abs(k) + std::abs(twice)); };
        const double size = size_along(points[i].x, twice_from_e.x) + size_along(points[i].y, twice_from_e.y) +
                            size_along(points[i].z, twice_from_e.z) + std::abs(weight.high[i]);
        sizes[i] = std::abs(lift.high[i]) + 4 * kEpsilon * size;
    }
    const auto [value, permanent] =
        lifted_determinant(points[0], lift.high[0], sizes[0], points[1], lift.high[1], sizes[1],  //
                           points[2], lift.high[2], sizes[2], points[3], lift.high[3], sizes[3]);
    const double bound = 20 * kEpsilon * permanent + kUnderflow;
    return value > bound ? 1 : value < -bound ? -1 : 0;
}

int in_sphere_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d, const Point& e) {
    const Rows<DoubleDouble> rows = rows_of(a, b, c, d, e);
    const Four<double>& lifts = rows.lift.high;
    const int sign = certain_sign(rows, {lifts[0], lifts[1], lifts[2], lifts[3]});
    return sign != 0 ? sign : exact_sign(exact_rows_of(a, b, c, d, e));
}

int in_power_sphere_beyond_filter(const Point& a, double wa, const Point& b, double wb, const Point& c, double wc,
                                  const Point& d, double wd, const Point& e, double we) {
    const std::array<double, 4> weights{wa, wb, wc, wd};
    Rows<DoubleDouble> rows = rows_of(a, b, c, d, e);
    const Four<DoubleDouble> weight = two_difference({wa, wb, wc, wd}, {we, we, we, we});
    std::array<double, 4> lifts;
    for (std::size_t i = 0; i < lifts.size(); ++i) {
        lifts[i] = rows.lift.high[i] + std::abs(weight.high[i]);
    }
    rows.lift = rows.lift - weight;
    const int sign = certain_sign(rows, lifts);
    if (sign != 0) {
        return sign;
    }
    Rows<Dyadic> exact = exact_rows_of(a, b, c, d, e);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        exact.lift.of[i] = exact.lift.of[i] - (Dyadic(weights[i]) - we);
    }
    return exact_sign(exact);
}

}  // namespace scaleaxis::inline v1::predicate_details
