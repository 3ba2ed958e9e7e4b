// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

namespace scaleaxis::inline v1 {

std::string to_text(double value, int digits) {
    std::array<char, 32> text;
#ifdef __wasm__
    // The same by printf, which knows one locale there: no part of the library then needs the longer function.
    char* const end = text.data() + std::snprintf(text.data(), text.size(), "%.*g", digits, value);
#else
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits).ptr;
#endif
    return {text.data(), end};
}

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

std::string percentage(double part, double whole) {
    const double percent = whole > 0 ? 100 * part / whole : 0.0;
    const auto tenths = static_cast<std::int64_t>(std::nearbyint(10 * percent));
    return std::to_string(tenths / 10) + '.' + std::to_string(tenths % 10) + " %";
}

std::string to_text(const Point& p) {
    std::string result = "(";
    for (const double coordinate : {p.x, p.y, p.z}) {
        result.append(to_text(coordinate, 9)).append(" ");
    }
    result.back() = ')';
    return result;
}

}  // namespace scaleaxis::inline v1
