// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <array>
#include <charconv>
#include <iomanip>
#include <optional>
#include <sstream>

namespace scaleaxis::inline v1 {
namespace {

std::string text_of(double value, int digits) {
    std::array<char, 32> text;
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits).ptr;
    return {text.data(), end};
}

}  // namespace

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

std::string to_text(double value) { return text_of(value, 3); }

std::string percentage(double part, double whole) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << (whole > 0 ? 100 * part / whole : 0.0) << " %";
    return text.str();
}

std::string to_text(const Point& p) {
    std::string result = "(";
    for (const double coordinate : {p.x, p.y, p.z}) {
        result.append(text_of(coordinate, 9)).append(" ");
    }
    result.back() = ')';
    return result;
}

}  // namespace scaleaxis::inline v1
