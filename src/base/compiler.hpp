// SPDX-License-Identifier: Apache-2.0
/// \file
/// Extensions of compilers, each with a portable way beside it (which `SCALEAXIS_PORTABLE` asks for).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#if (defined(__GNUC__) || defined(__clang__)) && !defined(SCALEAXIS_PORTABLE)
#define SCALEAXIS_HAS_VECTORS
/// No other pointer of the function points to the same: loops over such arrays are vectorized without a check.
#define SCALEAXIS_RESTRICT __restrict__
#elif defined(_MSC_VER)
#define SCALEAXIS_RESTRICT __restrict
#else
#define SCALEAXIS_RESTRICT
#endif

namespace scaleaxis::inline v1 {

/// Asks for the memory at `address` to be brought into the cache.
inline void prefetch([[maybe_unused]] const void* address) {
#if defined(SCALEAXIS_HAS_VECTORS)
    __builtin_prefetch(address);
#endif
}

#if defined(SCALEAXIS_HAS_VECTORS)

/// Four numbers that are computed with at once.
using Float4 = float __attribute__((vector_size(16)));
/// The outcome of comparing two of them: -1 for true, 0 for false.
using Mask4 = std::int32_t __attribute__((vector_size(16)));

/// Two numbers that are computed with at once.
using Double2 = double __attribute__((vector_size(16)));

constexpr Float4 lesser(Float4 a, Float4 b) { return a < b ? a : b; }
constexpr Float4 greater(Float4 a, Float4 b) { return a > b ? a : b; }

#else

template <class Number>
struct alignas(16) Vector4 {
    std::array<Number, 4> lanes{};

    constexpr Vector4() = default;
    constexpr Vector4(Number a, Number b, Number c, Number d) : lanes{a, b, c, d} {}
    constexpr explicit Vector4(Number all) : lanes{all, all, all, all} {}
    template <class Index>
    constexpr Number& operator[](Index i) {
        return lanes[static_cast<std::size_t>(i)];
    }
    template <class Index>
    constexpr const Number& operator[](Index i) const {
        return lanes[static_cast<std::size_t>(i)];
    }
};
using Float4 = Vector4<float>;
using Mask4 = Vector4<std::int32_t>;

struct alignas(16) Double2 {
    std::array<double, 2> lanes{};

    constexpr Double2() = default;
    constexpr Double2(double a, double b) : lanes{a, b} {}
    template <class Index>
    constexpr const double& operator[](Index i) const {
        return lanes[static_cast<std::size_t>(i)];
    }
};
constexpr Double2 operator+(Double2 a, Double2 b) { return {a[0] + b[0], a[1] + b[1]}; }
constexpr Double2 operator-(Double2 a, Double2 b) { return {a[0] - b[0], a[1] - b[1]}; }
constexpr Double2 operator*(Double2 a, Double2 b) { return {a[0] * b[0], a[1] * b[1]}; }

template <class Out, class Number, class Operation>
constexpr Out lane_by_lane(const Vector4<Number>& a, const Vector4<Number>& b, const Operation& operation) {
    return {operation(a[0], b[0]), operation(a[1], b[1]), operation(a[2], b[2]), operation(a[3], b[3])};
}
constexpr Float4 operator+(Float4 a, Float4 b) {
    return lane_by_lane<Float4>(a, b, [](float x, float y) { return x + y; });
}
constexpr Float4 operator-(Float4 a, Float4 b) {
    return lane_by_lane<Float4>(a, b, [](float x, float y) { return x - y; });
}
constexpr Float4 operator*(Float4 a, Float4 b) {
    return lane_by_lane<Float4>(a, b, [](float x, float y) { return x * y; });
}
constexpr Float4 operator+(Float4 a, float b) { return a + Float4(b); }
constexpr Float4 operator-(Float4 a, float b) { return a - Float4(b); }
constexpr Float4 operator-(float a, Float4 b) { return Float4(a) - b; }
constexpr Float4 operator*(Float4 a, float b) { return a * Float4(b); }
constexpr Float4& operator+=(Float4& a, Float4 b) { return a = a + b; }
constexpr Mask4 operator<=(Float4 a, Float4 b) {
    return lane_by_lane<Mask4>(a, b, [](float x, float y) { return x <= y ? -1 : 0; });
}
constexpr Mask4 operator<=(Float4 a, float b) { return a <= Float4(b); }
constexpr Mask4 operator>=(Float4 a, float b) { return Float4(b) <= a; }
constexpr Mask4 operator&(Mask4 a, Mask4 b) {
    return lane_by_lane<Mask4>(a, b, [](std::int32_t x, std::int32_t y) { return x & y; });
}
constexpr Mask4& operator&=(Mask4& a, Mask4 b) { return a = a & b; }
constexpr Float4 lesser(Float4 a, Float4 b) {
    return lane_by_lane<Float4>(a, b, [](float x, float y) { return x < y ? x : y; });
}
constexpr Float4 greater(Float4 a, Float4 b) {
    return lane_by_lane<Float4>(a, b, [](float x, float y) { return x > y ? x : y; });
}

#endif

}  // namespace scaleaxis::inline v1
