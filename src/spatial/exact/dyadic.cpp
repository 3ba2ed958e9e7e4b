// SPDX-License-Identifier: Apache-2.0
#include "spatial/exact/dyadic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace scaleaxis::inline v1 {

namespace {

constexpr int kLimbBits = 32;

}  // namespace

Dyadic::Dyadic(double value) {
    if (value == 0.0) {
        return;
    }
    constexpr int kDigits = std::numeric_limits<double>::digits;
    int exponent = 0;
    const double fraction = std::frexp(std::abs(value), &exponent);
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, kDigits));
    exponent -= kDigits;
    lowest_ = exponent >= 0 ? exponent / kLimbBits : -((kLimbBits - 1 - exponent) / kLimbBits);  // rounded down
    const int shift = exponent - kLimbBits * lowest_;
    const std::uint64_t low = mantissa << shift;
    few_[0] = static_cast<Limb>(low);
    few_[1] = static_cast<Limb>(low >> kLimbBits);
    few_[2] = static_cast<Limb>(mantissa >> (kLimbBits - 1) >> (kLimbBits + 1 - shift));
    size_ = 3;
    sign_ = value < 0.0 ? -1 : 1;
    trim();
}

Dyadic::Dyadic(const Dyadic& other) : sign_(other.sign_), lowest_(other.lowest_) {
    reserve(other.size_);
    std::copy_n(other.limbs(), other.size_, limbs());
}

Dyadic& Dyadic::operator=(Dyadic other) {
    sign_ = other.sign_;
    lowest_ = other.lowest_;
    size_ = other.size_;
    more_ = std::move(other.more_);
    if (!more_) {
        std::copy_n(other.few_.data(), size_, few_.data());
    }
    return *this;
}

/// The limb of weight 2^(32 · place).
Dyadic::Limb Dyadic::limb(int place) const {
    const int i = place - lowest_;
    return i >= 0 && i < size_ ? limbs()[i] : 0;
}

/// Sets the size; the limbs are not set.
void Dyadic::reserve(int size) {
    size_ = size;
    if (size > kFew) {
        more_ = std::make_unique_for_overwrite<Limb[]>(static_cast<std::size_t>(size));
    }
}

/// Removes zero limbs at both ends.
void Dyadic::trim() {
    Limb* const begin = limbs();
    while (size_ > 0 && begin[size_ - 1] == 0) {
        --size_;
    }
    int zeros = 0;
    while (zeros < size_ && begin[zeros] == 0) {
        ++zeros;
    }
    if (zeros > 0) {
        std::copy(begin + zeros, begin + size_, begin);
        size_ -= zeros;
        lowest_ += zeros;
    }
    if (size_ == 0) {
        sign_ = 0;
    }
}

int Dyadic::compare_magnitudes(const Dyadic& a, const Dyadic& b) {
    if (a.sign_ == 0 || b.sign_ == 0) {
        return std::abs(a.sign_) - std::abs(b.sign_);
    }
    const int top = a.lowest_ + a.size_;
    if (top != b.lowest_ + b.size_) {
        return top > b.lowest_ + b.size_ ? 1 : -1;
    }
    for (int place = top - 1; place >= std::min(a.lowest_, b.lowest_); --place) {
        const Limb x = a.limb(place), y = b.limb(place);
        if (x != y) {
            return x > y ? 1 : -1;
        }
    }
    return 0;
}

Dyadic Dyadic::sum(const Dyadic& a, const Dyadic& b, int sign_of_b) {
    if (sign_of_b == 0) {
        return a;
    }
    if (a.sign_ == 0) {
        Dyadic result = b;
        result.sign_ = sign_of_b;
        return result;
    }
    const int order = a.sign_ == sign_of_b ? 1 : compare_magnitudes(a, b);
    const Dyadic& large = order >= 0 ? a : b;
    const Dyadic& small = order >= 0 ? b : a;
    Dyadic result;
    result.sign_ = order >= 0 ? a.sign_ : sign_of_b;
    result.lowest_ = std::min(a.lowest_, b.lowest_);
    result.reserve(std::max(a.lowest_ + a.size_, b.lowest_ + b.size_) + 1 - result.lowest_);
    Limb* const limbs = result.limbs();
    // A borrow is a negative carry: shifts of negative numbers are arithmetic.
    const std::int64_t factor = a.sign_ == sign_of_b ? 1 : -1;
    std::int64_t carry = 0;
    for (int i = 0; i < result.size_; ++i) {
        const int place = result.lowest_ + i;
        carry += static_cast<std::int64_t>(large.limb(place)) + factor * static_cast<std::int64_t>(small.limb(place));
        limbs[i] = static_cast<Limb>(carry);
        carry >>= kLimbBits;
    }
    result.trim();
    return result;
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    Dyadic result;
    if (a.sign_ == 0 || b.sign_ == 0) {
        return result;
    }
    result.sign_ = a.sign_ * b.sign_;
    result.lowest_ = a.lowest_ + b.lowest_;
    result.reserve(a.size_ + b.size_);
    Dyadic::Limb* const limbs = result.limbs();
    std::fill_n(limbs, b.size_, 0);
    for (int i = 0; i < a.size_; ++i) {
        const std::uint64_t factor = a.limbs()[i];
        std::uint64_t carry = 0;
        for (int j = 0; j < b.size_; ++j) {
            carry += factor * b.limbs()[j] + limbs[i + j];
            limbs[i + j] = static_cast<Dyadic::Limb>(carry);
            carry >>= kLimbBits;
        }
        limbs[i + b.size_] = static_cast<Dyadic::Limb>(carry);
    }
    result.trim();
    return result;
}

/// The magnitude is the returned number times 2^exponent, up to rounding.
double Dyadic::leading(int& exponent) const {
    double value = 0.0;
    const int top = lowest_ + size_;
    for (int place = top - 1; place >= top - 3; --place) {
        value = 0x1p32 * value + limb(place);
    }
    exponent = kLimbBits * (top - 3);
    return value;
}

double quotient(const Dyadic& numerator, const Dyadic& denominator) {
    if (numerator.sign_ == 0) {
        return 0.0;
    }
    int exponent = 0, exponent_of_denominator = 0;
    const double approximate = numerator.leading(exponent) / denominator.leading(exponent_of_denominator);
    double magnitude = std::ldexp(approximate, exponent - exponent_of_denominator);
    const auto is_too_large = [&](double q) {
        return Dyadic::compare_magnitudes(Dyadic(q) * denominator, numerator) > 0;
    };
    constexpr double kMost = std::numeric_limits<double>::max();
    magnitude = std::min(magnitude, kMost);
    while (is_too_large(magnitude)) {
        magnitude = std::nextafter(magnitude, 0.0);
    }
    while (magnitude < kMost && !is_too_large(std::nextafter(magnitude, kMost))) {
        magnitude = std::nextafter(magnitude, kMost);
    }
    return numerator.sign_ * denominator.sign_ * magnitude;
}

}  // namespace scaleaxis::inline v1
