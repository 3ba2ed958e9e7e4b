// SPDX-License-Identifier: Apache-2.0
// What std::to_chars calls for numbers with a precision, and for large whole ones, by printf, which is as exact. The
// tables of libc++'s own would be 100 kB of the module, and hardly compress.
#include <charconv>
#include <cstdint>
#include <cstdio>

_LIBCPP_BEGIN_NAMESPACE_STD

namespace {

// printf ends with a 0, for which the caller has no room.
to_chars_result printed(char* begin, const char* format, std::uint32_t precision, double value) {
    char text[1100];  // the largest number has 309 digits, the smallest 1074 behind the point
    const int size = std::snprintf(text, sizeof text, format, static_cast<int>(precision), value);
    for (int i = 0; i < size; ++i) {
        begin[i] = text[i];
    }
    return {begin + size, errc()};
}

}  // namespace

to_chars_result __d2fixed_buffered_n(char* begin, char*, double value, std::uint32_t precision) {
    return printed(begin, "%.*f", precision, value);
}

to_chars_result __d2exp_buffered_n(char* begin, char*, double value, std::uint32_t precision) {
    return printed(begin, "%.*e", precision, value);
}

void __append_n_digits(std::uint32_t count, std::uint32_t number, char* begin) {
    for (; count > 0; number /= 10) {
        begin[--count] = static_cast<char>('0' + number % 10);
    }
}

void __append_nine_digits(std::uint32_t number, char* begin) { __append_n_digits(9, number, begin); }

_LIBCPP_END_NAMESPACE_STD
