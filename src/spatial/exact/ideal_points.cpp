// SPDX-License-Identifier: Apache-2.0
#include "spatial/exact/ideal_points.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "spatial/exact/dyadic.hpp"
#include "spatial/exact/predicates.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// A polynomial in `M`, the coefficient of the lowest power first.
struct Polynomial {
    std::vector<Dyadic> of;

    Dyadic coefficient(std::size_t power) const { return power < of.size() ? of[power] : Dyadic(); }
    int sign() const {
        const auto leading = std::find_if(of.rbegin(), of.rend(), [](const Dyadic& c) { return c.sign() != 0; });
        return leading == of.rend() ? 0 : leading->sign();
    }
    friend Polynomial operator+(const Polynomial& a, const Polynomial& b) {
        Polynomial sum;
        for (std::size_t i = 0; i < std::max(a.of.size(), b.of.size()); ++i) {
            sum.of.push_back(a.coefficient(i) + b.coefficient(i));
        }
        return sum;
    }
    friend Polynomial operator*(const Polynomial& a, const Polynomial& b) {
        Polynomial product{std::vector<Dyadic>(a.of.size() + b.of.size())};
        for (std::size_t i = 0; i < a.of.size(); ++i) {
            for (std::size_t k = 0; k < b.of.size(); ++k) {
                product.of[i + k] = product.of[i + k] + a.of[i] * b.of[k];
            }
        }
        return product;
    }
    friend Polynomial operator-(const Polynomial& a, const Polynomial& b) { return a + Polynomial{{-1.0}} * b; }
};

/// A point relative to another one, in terms of `M`, and its lift.
struct Row {
    std::array<Polynomial, 3> x;
    Polynomial lift;
};

Row row_of(const ProjectivePoint& p, const ProjectivePoint& origin) {
    Row row;
    const DyadicVector offset = exact_difference(p.is_ideal ? Point{} : p.at, origin.at);
    row.x = {Polynomial{{offset.x}}, Polynomial{{offset.y}}, Polynomial{{offset.z}}};
    if (p.is_ideal) {
        row.x[0].of.emplace_back(p.at.x);
        row.x[1].of.emplace_back(p.at.y);
        row.x[2].of.emplace_back(p.at.z);
    }
    row.lift = row.x[0] * row.x[0] + row.x[1] * row.x[1] + row.x[2] * row.x[2] -
               Polynomial{{Dyadic(p.weight) - origin.weight}};
    return row;
}

Polynomial determinant_of(const Row& a, const Row& b, const Row& c) {
    const auto minor = [&](int i, int k) { return b.x[i] * c.x[k] - b.x[k] * c.x[i]; };
    return a.x[0] * minor(1, 2) + a.x[1] * minor(2, 0) + a.x[2] * minor(0, 1);
}

/// What the coordinates of a point relative to `origin` become for large `M`, up to a positive factor.
Point leading_part(const ProjectivePoint& p, const Point& origin) { return p.is_ideal ? p.at : p.at - origin; }

/// The sign of a `lifted_determinant` of rows such as those of the filters in predicates.hpp; 0: too small to tell.
int filtered_sign(const std::array<Point, 4>& rows, const std::array<double, 4>& lifts,
                  const std::array<double, 4>& sizes) {
    using namespace predicate_details;
    const auto [value, permanent] = lifted_determinant(rows[0], lifts[0], sizes[0], rows[1], lifts[1], sizes[1],  //
                                                       rows[2], lifts[2], sizes[2], rows[3], lifts[3], sizes[3]);
    const double bound = 20 * kEpsilon * permanent + kUnderflow;
    return value > bound ? 1 : value < -bound ? -1 : 0;
}

}  // namespace

int ideal_orientation(const std::array<ProjectivePoint, 3>& abc, const Point& d) {
    // The fourth row is one that is no point: the determinant with a lift of 1 there is that of the other three.
    const std::array<Point, 4> rows{leading_part(abc[0], d), leading_part(abc[1], d), leading_part(abc[2], d), {}};
    if (const int sign = filtered_sign(rows, {0, 0, 0, 1}, {0, 0, 0, 1}); sign != 0) {
        return sign;
    }
    const ProjectivePoint origin{d};
    return -determinant_of(row_of(abc[0], origin), row_of(abc[1], origin), row_of(abc[2], origin)).sign();
}

int ideal_in_power_sphere(const std::array<ProjectivePoint, 4>& abcd, const ProjectivePoint& e) {
    // The largest power of `M`: the lifts of ideal points, of which all have the same, times their other coordinates.
    std::array<Point, 4> rows;
    std::array<double, 4> lifts{};
    for (std::size_t i = 0; i < 4; ++i) {
        rows[i] = leading_part(abcd[i], e.at);
        lifts[i] = abcd[i].is_ideal ? 1.0 : 0.0;
    }
    if (const int sign = filtered_sign(rows, lifts, lifts); sign != 0) {
        return sign;
    }
    std::array<Row, 4> exact;
    std::transform(abcd.begin(), abcd.end(), exact.begin(), [&](const ProjectivePoint& p) { return row_of(p, e); });
    const auto& [a, b, c, d] = exact;
    return (a.lift * determinant_of(b, c, d) - b.lift * determinant_of(a, c, d) + c.lift * determinant_of(a, b, d) -
            d.lift * determinant_of(a, b, c))
        .sign();
}

}  // namespace scaleaxis::inline v1
