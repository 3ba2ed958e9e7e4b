// SPDX-License-Identifier: Apache-2.0
#include "base/formats/base64.hpp"

#include <algorithm>
#include <cstdint>

#include "base/faults.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr int kPadding = 64;

int digit_of(char c) {
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+'             ? 62
           : c == '/'             ? 63
           : c == '='             ? kPadding
                                  : -1;
}

void skip_blanks(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
}

/// Takes the next four digits off a text, blanks before them too, and appends the bytes that they stand for: one or two
/// where padding follows, else three.
void decode_group(std::string_view& text, std::string& bytes) {
    std::uint32_t word = 0;
    int digits = 0;
    for (int i = 0; i < 4; ++i) {
        skip_blanks(text);
        if (text.empty()) {
            throw truncated("its values end too early");
        }
        const int digit = digit_of(text.front());
        text.remove_prefix(1);
        if (digit < 0 || (digit == kPadding && i < 2) || (digit != kPadding && digits < i)) {
            throw damaged("its values are no base64");
        }
        digits += digit == kPadding ? 0 : 1;
        word = word << 6 | static_cast<std::uint32_t>(digit == kPadding ? 0 : digit);
    }
    for (int i = 0; i + 1 < digits; ++i) {
        bytes += static_cast<char>(word >> (16 - 8 * i) & 0xFFU);
    }
}

}  // namespace

std::string decoded_base64(std::string_view text) {
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    for (skip_blanks(text); !text.empty(); skip_blanks(text)) {
        decode_group(text, bytes);
    }
    return bytes;
}

}  // namespace scaleaxis::inline v1
