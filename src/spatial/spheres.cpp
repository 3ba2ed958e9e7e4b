// SPDX-License-Identifier: Apache-2.0
#include "spatial/spheres.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "spatial/exact/dyadic.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Rounding errors of the expressions below stay under this many units of the sum of the absolute values of their terms.
constexpr double kSphereRounding = 16 * std::numeric_limits<double>::epsilon();

Circumsphere exact_circumsphere(const Point& a, const Point& b, const Point& c, const Point& d, double limit) {
    const DyadicVector e1 = exact_difference(b, a), e2 = exact_difference(c, a), e3 = exact_difference(d, a);
    const DyadicVector n23 = cross(e2, e3);
    const Dyadic volume = Dyadic(2.0) * dot(e1, n23);
    if (volume.sign() == 0) {
        return {{}, std::numeric_limits<double>::infinity()};
    }
    const DyadicVector numerator =
        squared_norm(e1) * n23 + squared_norm(e2) * cross(e3, e1) + squared_norm(e3) * cross(e1, e2);
    const Point offset{quotient(numerator.x, volume), quotient(numerator.y, volume), quotient(numerator.z, volume)};
    const double radius = norm(offset);
    return radius <= limit ? Circumsphere{a + offset, radius}
                           : Circumsphere{{}, std::numeric_limits<double>::infinity()};
}

// The power of the smallest orthogonal sphere of two, three, four balls, and a bound on its error. All in coordinates
// relative to the first centre.
struct BoundedPower {
    Point to_center;  // from the first ball's centre
    double power;
    double error;
};

// Half of what the plane of equal power to `a` and to `b` has as its right-hand side: x·(b - a) = radical_offset.
double radical_offset(const Ball& a, const Ball& b) {
    return 0.5 * (squared_distance(a.center, b.center) + (a.radius - b.radius) * (a.radius + b.radius));
}

BoundedPower bounded_power(const Ball& a, const Point& to_center, double condition) {
    const double square = squared_norm(to_center);
    const double weight = a.radius * a.radius;
    return {to_center, square - weight, kSphereRounding * condition * (square + weight)};
}

BoundedPower power_of(const Ball& a, const Ball& b) {
    const Point e = b.center - a.center;
    const double length = squared_norm(e);
    const double magnitude = length + a.radius * a.radius + b.radius * b.radius;
    return bounded_power(a, (radical_offset(a, b) / length) * e, magnitude / length);
}

BoundedPower power_of(const Ball& a, const Ball& b, const Ball& c) {
    const Point e1 = b.center - a.center;
    const Point e2 = c.center - a.center;
    const Point n = cross(e1, e2);
    const double area = squared_norm(n);
    const double h1 = radical_offset(a, b);
    const double h2 = radical_offset(a, c);
    const Point to_center = (1.0 / area) * (h1 * cross(e2, n) + h2 * cross(n, e1));
    const double l1 = squared_norm(e1);
    const double l2 = squared_norm(e2);
    const double magnitude = l1 + l2 + a.radius * a.radius + b.radius * b.radius + c.radius * c.radius;
    return bounded_power(a, to_center, magnitude * std::max(l1, l2) / area);
}

BoundedPower power_of(const Ball& a, const Ball& b, const Ball& c, const Ball& d) {
    const Point e1 = b.center - a.center;
    const Point e2 = c.center - a.center;
    const Point e3 = d.center - a.center;
    const Point n23 = cross(e2, e3);
    const double volume = dot(e1, n23);
    const Point to_center = (1.0 / volume) * (radical_offset(a, b) * n23 + radical_offset(a, c) * cross(e3, e1) +
                                              radical_offset(a, d) * cross(e1, e2));
    const double length = std::max({squared_norm(e1), squared_norm(e2), squared_norm(e3)});
    const double magnitude =
        length + a.radius * a.radius + b.radius * b.radius + c.radius * c.radius + d.radius * d.radius;
    const double flatness = length * length * length / (volume * volume);
    return bounded_power(a, to_center, magnitude / length * flatness);
}

std::optional<bool> certain_meeting(const BoundedPower& p) {
    // The comparison is false for NaN, too.
    if (std::abs(p.power) > p.error) {
        return p.power < 0.0;
    }
    return std::nullopt;
}

// Numbers so small that underflow may have spoiled them tell nothing.
constexpr double kSmallest = 1e-140;

std::optional<bool> certain_sign(double value, double magnitude) {
    if (std::abs(value) > kSphereRounding * magnitude + kSmallest) {
        return value < 0.0;
    }
    return std::nullopt;
}

// The sum of the absolute values.
double size_of(const Point& p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z); }

// What bounds a radical offset, and with `kSphereRounding` its error.
double radical_size(const Ball& a, const Ball& b, const Point& b_from_a) {
    return 0.5 * (squared_norm(b_from_a) + a.radius * a.radius + b.radius * b.radius);
}

// Does the last ball conflict with the smallest sphere orthogonal to the others? The power product of the two, times
// half the square of what the centres of the others span (their distance, twice their area): as in exact arithmetic
// there is nothing to be divided by.
std::optional<bool> certain_conflict(const Ball& a, const Ball& other) {
    return certain_sign(radical_offset(a, other), radical_size(a, other, other.center - a.center));
}

std::optional<bool> certain_conflict(const Ball& a, const Ball& b, const Ball& other) {
    const Point e = b.center - a.center;
    const Point o = other.center - a.center;
    const double square = squared_norm(e);
    return certain_sign(radical_offset(a, other) * square - radical_offset(a, b) * dot(e, o),
                        radical_size(a, other, o) * square + radical_size(a, b, e) * size_of(e) * size_of(o));
}

std::optional<bool> certain_conflict(const Ball& a, const Ball& b, const Ball& c, const Ball& other) {
    const Point e1 = b.center - a.center;
    const Point e2 = c.center - a.center;
    const Point o = other.center - a.center;
    const Point n = cross(e1, e2);
    const Point numerator = cross(radical_offset(a, b) * e2 - radical_offset(a, c) * e1, n);
    const double s1 = size_of(e1);
    const double s2 = size_of(e2);
    return certain_sign(radical_offset(a, other) * squared_norm(n) - dot(numerator, o),
                        s1 * s2 *
                            (radical_size(a, other, o) * s1 * s2 +
                             (radical_size(a, b, e1) * s2 + radical_size(a, c, e2) * s1) * size_of(o)));
}

// The same in exact arithmetic. The weight of a ball is its squared radius in double precision.
double weight_of(const Ball& ball) { return ball.radius * ball.radius; }

// The plane of equal power to `a` and to `b` has x·(b - a) = half of this, relative to a's centre.
Dyadic exact_radical_offset(const Ball& a, const Ball& b, const DyadicVector& b_from_a) {
    return squared_norm(b_from_a) + (Dyadic(weight_of(a)) - weight_of(b));
}

// The centre of the smallest sphere orthogonal to some balls, relative to that of the first one, is
// numerator / (2 · denominator); the denominator of up to three balls is not negative.
struct ExactCenter {
    DyadicVector numerator;
    Dyadic denominator;
};

ExactCenter exact_center(const Ball&) { return {{}, 1.0}; }

ExactCenter exact_center(const Ball& a, const Ball& b) {
    const DyadicVector e = exact_difference(b.center, a.center);
    return {exact_radical_offset(a, b, e) * e, squared_norm(e)};
}

ExactCenter exact_center(const Ball& a, const Ball& b, const Ball& c) {
    const DyadicVector e1 = exact_difference(b.center, a.center), e2 = exact_difference(c.center, a.center);
    const DyadicVector n = cross(e1, e2);
    return {cross(exact_radical_offset(a, b, e1) * e2 - exact_radical_offset(a, c, e2) * e1, n), squared_norm(n)};
}

ExactCenter exact_center(const Ball& a, const Ball& b, const Ball& c, const Ball& d) {
    const DyadicVector e1 = exact_difference(b.center, a.center), e2 = exact_difference(c.center, a.center),
                       e3 = exact_difference(d.center, a.center);
    const DyadicVector n23 = cross(e2, e3);
    return {exact_radical_offset(a, b, e1) * n23 + exact_radical_offset(a, c, e2) * cross(e3, e1) +
                exact_radical_offset(a, d, e3) * cross(e1, e2),
            dot(e1, n23)};
}

// Is the squared distance of the sphere's centre from that of `a`, less the weight of `a`, at most 0?
template <class... Balls>
bool exactly_meet(const Ball& a, const Balls&... others) {
    const auto [numerator, denominator] = exact_center(a, others...);
    const Dyadic twice = Dyadic(2.0) * denominator;
    return (squared_norm(numerator) - twice * twice * weight_of(a)).sign() <= 0;
}

// The power product of the sphere with `other`, times the denominator. The squared distance of the centre from that of
// the first ball cancels.
bool is_conflict(const ExactCenter& center, const Ball& first, const Ball& other) {
    const DyadicVector o = exact_difference(other.center, first.center);
    const Dyadic product = center.denominator * exact_radical_offset(first, other, o) - dot(center.numerator, o);
    return product.sign() < 0;
}

bool exactly_conflict(const Ball& a, const Ball& other) { return is_conflict(exact_center(a), a, other); }
bool exactly_conflict(const Ball& a, const Ball& b, const Ball& other) {
    return is_conflict(exact_center(a, b), a, other);
}
bool exactly_conflict(const Ball& a, const Ball& b, const Ball& c, const Ball& other) {
    return is_conflict(exact_center(a, b, c), a, other);
}

}  // namespace

Circumsphere circumsphere(const Point& a, const Point& b, const Point& c, const Point& d, double limit) {
    const Point e1 = b - a;
    const Point e2 = c - a;
    const Point e3 = d - a;
    const double l1 = squared_norm(e1);
    const double l2 = squared_norm(e2);
    const double l3 = squared_norm(e3);
    const Point n23 = cross(e2, e3);
    const Point n31 = cross(e3, e1);
    const Point n12 = cross(e1, e2);
    const double volume = 2.0 * dot(e1, n23);
    const Point numerator = l1 * n23 + l2 * n31 + l3 * n12;

    const double longest = std::max({l1, l2, l3});
    const double volume_error = kSphereRounding * longest * std::sqrt(longest);
    const double numerator_error = kSphereRounding * 3.0 * longest * longest;
    const double numerator_length = norm(numerator);
    if (numerator_length - numerator_error > limit * (std::abs(volume) + volume_error)) {
        return {{}, std::numeric_limits<double>::infinity()};
    }
    // One part in 10⁶ of the radius is more than enough for a centre; flatter tetrahedra are rare.
    const double tolerance = 1e-6;
    if (!(volume_error < tolerance * std::abs(volume) && numerator_error < tolerance * numerator_length)) {
        return exact_circumsphere(a, b, c, d, limit);
    }
    const Point offset = (1.0 / volume) * numerator;
    const double radius = norm(offset);
    return radius <= limit ? Circumsphere{a + offset, radius}
                           : Circumsphere{{}, std::numeric_limits<double>::infinity()};
}

OrthogonalSphere orthogonal_sphere(const Ball& a, const Ball& b) {
    const BoundedPower p = power_of(a, b);
    return {a.center + p.to_center, p.power};
}

OrthogonalSphere orthogonal_sphere(const Ball& a, const Ball& b, const Ball& c) {
    const BoundedPower p = power_of(a, b, c);
    return {a.center + p.to_center, p.power};
}

OrthogonalSphere orthogonal_sphere(const Ball& a, const Ball& b, const Ball& c, const Ball& d) {
    const BoundedPower p = power_of(a, b, c, d);
    return {a.center + p.to_center, p.power};
}

bool meet(const Ball& a, const Ball& b) {
    const std::optional<bool> certain = certain_meeting(power_of(a, b));
    return certain ? *certain : exactly_meet(a, b);
}

bool meet(const Ball& a, const Ball& b, const Ball& c) {
    const std::optional<bool> certain = certain_meeting(power_of(a, b, c));
    return certain ? *certain : exactly_meet(a, b, c);
}

bool meet(const Ball& a, const Ball& b, const Ball& c, const Ball& d) {
    const std::optional<bool> certain = certain_meeting(power_of(a, b, c, d));
    return certain ? *certain : exactly_meet(a, b, c, d);
}

bool conflicts(const Ball& a, const Ball& other) {
    const std::optional<bool> certain = certain_conflict(a, other);
    return certain ? *certain : exactly_conflict(a, other);
}

bool conflicts(const Ball& a, const Ball& b, const Ball& other) {
    const std::optional<bool> certain = certain_conflict(a, b, other);
    return certain ? *certain : exactly_conflict(a, b, other);
}

bool conflicts(const Ball& a, const Ball& b, const Ball& c, const Ball& other) {
    const std::optional<bool> certain = certain_conflict(a, b, c, other);
    return certain ? *certain : exactly_conflict(a, b, c, other);
}

unsigned conflicts_of_corners(const Ball& a, const Ball& b, const Ball& c, const Ball& d) {
    // Ball k is in conflict if the centre of the sphere orthogonal to all four lies beyond the facet opposite, where
    // its barycentric coordinate is negative. These are computed together, times the square of the volume.
    const Point e1 = b.center - a.center;
    const Point e2 = c.center - a.center;
    const Point e3 = d.center - a.center;
    const Point n1 = cross(e2, e3);
    const Point n2 = cross(e3, e1);
    const Point n3 = cross(e1, e2);
    const Point numerator = radical_offset(a, b) * n1 + radical_offset(a, c) * n2 + radical_offset(a, d) * n3;
    const double volume = dot(e1, n1);
    const double at1 = dot(numerator, n1);
    const double at2 = dot(numerator, n2);
    const double at3 = dot(numerator, n3);

    const double s1 = size_of(e1);
    const double s2 = size_of(e2);
    const double s3 = size_of(e3);
    const double size = radical_size(a, b, e1) * s2 * s3 + radical_size(a, c, e2) * s3 * s1 +
                        radical_size(a, d, e3) * s1 * s2;  // of the numerator
    const double normals = s2 * s3 + s3 * s1 + s1 * s2;
    const auto bit = [](std::optional<bool> certain, int k, const auto& exactly) {
        return (certain ? *certain : exactly()) ? 1U << k : 0U;
    };
    return bit(certain_sign(volume * volume - (at1 + at2 + at3), s1 * s2 * s3 * (s1 * s2 * s3) + size * normals), 0,
               [&] { return exactly_conflict(b, c, d, a); }) |
           bit(certain_sign(at1, size * s2 * s3), 1, [&] { return exactly_conflict(a, c, d, b); }) |
           bit(certain_sign(at2, size * s3 * s1), 2, [&] { return exactly_conflict(a, b, d, c); }) |
           bit(certain_sign(at3, size * s1 * s2), 3, [&] { return exactly_conflict(a, b, c, d); });
}

}  // namespace scaleaxis::inline v1
