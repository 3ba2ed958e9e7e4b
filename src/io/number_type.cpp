// SPDX-License-Identifier: Apache-2.0
#include "io/number_type.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/bytes.hpp"
#include "base/numbers.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

/// A number of 16 bits, as IEEE 754 has them.
struct Half {
    std::uint16_t bits = 0;

    operator float() const {
        const int exponent = bits >> 10 & 31;
        const auto fraction = static_cast<float>(bits & 1023);
        const float size = exponent == 0   ? std::ldexp(fraction, -24)
                           : exponent < 31 ? std::ldexp(fraction + 1024.0F, exponent - 25)
                           : fraction == 0 ? std::numeric_limits<float>::infinity()
                                           : std::numeric_limits<float>::quiet_NaN();
        return (bits & 0x8000) != 0 ? -size : size;
    }
};

/// Calls `use` with a number of that type.
template <class Use>
auto with_type(NumberType type, const Use& use) {
    using Number = std::variant<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t,
                                std::int64_t, std::uint64_t, Half, float, double>;
    static constexpr std::array<Number, std::variant_size_v<Number>> kNumbers{
        std::int8_t{},  std::uint8_t{},  std::int16_t{}, std::uint16_t{}, std::int32_t{}, std::uint32_t{},
        std::int64_t{}, std::uint64_t{}, Half{},         float{},         double{}};
    return std::visit(use, kNumbers[static_cast<std::size_t>(type)]);
}

}  // namespace

std::optional<NumberType> number_type(std::string_view name) {
    constexpr auto kNames =
        std::to_array<std::string_view>({"i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8"});
    const auto found = std::ranges::find(kNames, name);
    return found == kNames.end() ? std::nullopt : std::optional(static_cast<NumberType>(found - kNames.begin()));
}

std::optional<NumberType> number_type_in(std::string_view table, std::string_view name) {
    const std::vector<std::string_view> words = words_of(table);
    for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
        if (words[i] == name) {
            return number_type(words[i + 1]);
        }
    }
    return std::nullopt;
}

std::size_t bytes_per_number(NumberType type) {
    return with_type(type, [](auto zero) { return sizeof(zero); });
}

bool is_of_type(double value, NumberType type) {
    return with_type(type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_integral_v<T>) {
            return value == std::floor(value) && value >= static_cast<double>(std::numeric_limits<T>::min()) &&
                   value <= static_cast<double>(std::numeric_limits<T>::max());
        } else {
            return true;
        }
    });
}

double number_at(const char* from, NumberType type, std::endian order) {
    return with_type(type, [&](auto zero) { return static_cast<double>(from_bytes<decltype(zero)>(from, order)); });
}

float as_float(double value) {
    const auto rounded = static_cast<float>(value);
    const bool is_merged = std::abs(rounded) == kMostExactFloat && std::abs(value) > double{kMostExactFloat};
    return is_merged ? std::nextafter(rounded, 2.0F * rounded) : rounded;
}

void read_numbers(const char* from, std::size_t count, NumberType type, std::endian order, float* to) {
    with_type(type, [&](auto zero) {
        using T = decltype(zero);
        for (std::size_t i = 0; i < count; ++i) {
            const auto number = from_bytes<T>(from + i * sizeof(T), order);
            if constexpr (std::is_convertible_v<T, float> && (sizeof(T) < sizeof(float) || std::is_same_v<T, float>)) {
                to[i] = static_cast<float>(number);
            } else {
                to[i] = as_float(static_cast<double>(number));
            }
        }
    });
}

}  // namespace scaleaxis::io
