// SPDX-License-Identifier: Apache-2.0
/// \file
/// Exact arithmetic for signs that floating-point filters cannot decide.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// A dyadic rational, an integer times a power of two, of any size: sums, differences and products of finite doubles
/// are exact, without overflow or underflow.
class Dyadic {
   public:
    Dyadic() = default;  ///< 0
    Dyadic(double value);
    Dyadic(const Dyadic& other);
    Dyadic(Dyadic&&) = default;
    Dyadic& operator=(Dyadic other);
    ~Dyadic() = default;

    /// -1, 0 or +1.
    int sign() const { return sign_; }

    friend Dyadic operator+(const Dyadic& a, const Dyadic& b) { return sum(a, b, b.sign_); }
    friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return sum(a, b, -b.sign_); }
    friend Dyadic operator*(const Dyadic& a, const Dyadic& b);

    /// `numerator` / `denominator` rounded towards zero. \param denominator not 0
    friend double quotient(const Dyadic& numerator, const Dyadic& denominator);

   private:
    using Limb = std::uint32_t;

    Limb* limbs() { return more_ ? more_.get() : few_.data(); }
    const Limb* limbs() const { return more_ ? more_.get() : few_.data(); }
    Limb limb(int place) const;
    void reserve(int size);
    void trim();
    static Dyadic sum(const Dyadic& a, const Dyadic& b, int sign_of_b);
    static int compare_magnitudes(const Dyadic& a, const Dyadic& b);
    double leading(int& exponent) const;

    // The value is sign · Σ limb[i] · 2^(32 (lowest + i)); the first and the last limb are not 0.
    static constexpr int kFew = 32;  // enough for coordinates of similar magnitude
    int sign_ = 0;
    int lowest_ = 0;
    int size_ = 0;
    std::array<Limb, kFew> few_;
    std::unique_ptr<Limb[]> more_;
};

/// A vector with exact coordinates.
struct DyadicVector {
    Dyadic x, y, z;
};

/// The vector from `p` to `q`.
inline DyadicVector exact_difference(const Point& q, const Point& p) {
    return {Dyadic(q.x) - p.x, Dyadic(q.y) - p.y, Dyadic(q.z) - p.z};
}
inline DyadicVector operator+(const DyadicVector& a, const DyadicVector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline DyadicVector operator-(const DyadicVector& a, const DyadicVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline DyadicVector operator*(const Dyadic& s, const DyadicVector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Dyadic dot(const DyadicVector& a, const DyadicVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline DyadicVector cross(const DyadicVector& a, const DyadicVector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Dyadic squared_norm(const DyadicVector& a) { return dot(a, a); }
inline Dyadic determinant(const DyadicVector& a, const DyadicVector& b, const DyadicVector& c) {
    return dot(a, cross(b, c));
}

}  // namespace scaleaxis::inline v1
