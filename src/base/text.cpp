// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <array>
#include <charconv>

namespace scaleaxis {

std::string counted(std::int64_t count, std::string_view one, std::string_view many) {
    return std::to_string(count) + ' ' + std::string(count == 1 ? one : many);
}

std::string to_text(const Point& p) {
    std::string result = "(";
    for (const double coordinate : {p.x, p.y, p.z}) {
        constexpr int kDigits = 9;
        std::array<char, 32> digits;
        const auto end =
            std::to_chars(digits.begin(), digits.end(), coordinate, std::chars_format::general, kDigits).ptr;
        result.append(digits.begin(), end).append(" ");
    }
    result.back() = ')';
    return result;
}

}  // namespace scaleaxis
