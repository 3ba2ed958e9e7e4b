// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <array>
#include <charconv>
#include <optional>

namespace scaleaxis {

std::string counted(std::int64_t count, std::string_view one, std::string_view many) {
    const std::string number = std::to_string(count) + ' ';
    return count == 1     ? number + std::string(one)
           : many.empty() ? number + std::string(one) + 's'
                          : number + std::string(many);
}

std::string in_words(const Topology& topology) {
    const auto many = [](const std::optional<std::int64_t>& count, std::string_view one, std::string_view several) {
        return count ? counted(*count, one, several) : "- " + std::string(several);
    };
    return counted(topology.components, "component") + ", " + many(topology.tunnels, "tunnel", "tunnels") + ", " +
           many(topology.voids, "void", "voids") + ", Euler characteristic " + std::to_string(topology.euler);
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
