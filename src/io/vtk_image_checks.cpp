// SPDX-License-Identifier: Apache-2.0
//
// The head of VTK's structured points ("VTK File Formats", simple legacy formats): lines up to that of the values.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/itk_checks.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

struct Line {
    std::string text;  ///< in lower case
    std::size_t number = 0;
};

struct Head {
    std::vector<Line> lines;  ///< those that are not empty; the last one begins the values
    std::string_view data;    ///< what follows
};

/// The keywords that the toolkit looks for, anywhere in a line and in this order.
constexpr auto kKeywords = std::to_array<std::string_view>(
    {"spacing", "aspect_ratio", "origin", "vector", "color_scalars", "scalars", "tensors"});
constexpr std::size_t kPlaces = 3;  // the first of them are no values

std::size_t keyword_in(std::string_view line) {
    return static_cast<std::size_t>(
        std::ranges::find_if(kKeywords, [&](std::string_view k) { return line.find(k) != std::string_view::npos; }) -
        kKeywords.begin());
}

/// Takes the next line that is not empty off the text.
Line take_line(std::string_view& content, std::size_t& number) {
    constexpr std::size_t kLongest = 256;  // the title, says the format
    while (!content.empty()) {
        const std::size_t end = std::min(content.find('\n'), content.size());
        std::string_view line = content.substr(0, end);
        content.remove_prefix(std::min(end + 1, content.size()));
        ++number;
        if (line.size() > kLongest) {
            fail_at_line(number,
                         "the line has " + std::to_string(line.size()) + " characters: is this still the head?");
        }
        if (!line.empty()) {
            return {to_lower(line), number};
        }
    }
    throw truncated("its head does not end: a line `SCALARS` should follow");
}

/// The three numbers after the keyword of a line.
std::array<double, 3> numbers_of(const Line& line) {
    TextReader reader(line.text);
    reader.word();
    std::array<double, 3> numbers{};
    for (double& number : numbers) {
        const std::string_view word = reader.word();
        const std::optional<double> value = parse_number(word);
        if (!value || !is_of_place(*value)) {
            fail_at_line(line.number, io::quoted(line.text) + " needs three numbers that an image can have");
        }
        number = *value;
    }
    return numbers;
}

void check_line(const Line& line) {
    const std::size_t keyword = keyword_in(line.text);
    if (keyword == kKeywords.size()) {
        return;
    }
    TextReader reader(line.text);
    const std::string_view first = reader.word();
    if (first.find(kKeywords[keyword]) == std::string_view::npos) {
        fail_at_line(line.number, io::quoted(line.text) + " has the word '" + std::string(kKeywords[keyword]) +
                                      "' where it cannot be told from a keyword; take another name");
    }
    if (keyword < kPlaces) {
        const std::array<double, 3> numbers = numbers_of(line);
        if (kKeywords[keyword] != "origin" && !std::ranges::all_of(numbers, is_spacing)) {
            fail_at_line(line.number, "an image cannot have the " + io::quoted(line.text));
        }
    } else if (kKeywords[keyword] == "scalars") {
        reader.word();
        const std::string_view type = reader.word();
        const std::string_view components = reader.word();
        const std::optional<std::int64_t> count = parse_integer(components);
        if (type.empty() || (!components.empty() && (!count || *count < 1 || *count > 1000))) {
            fail_at_line(line.number,
                         io::quoted(line.text) + " needs a name, a type, and perhaps a number of components");
        }
    }
}

Head read_head(std::string_view content) {
    constexpr std::size_t kFixedLines = 5;  // version, title, encoding, dataset, dimensions
    constexpr std::size_t kMostLines = 30;
    Head head;
    std::size_t number = 0;
    while (head.lines.size() < kMostLines) {
        head.lines.push_back(take_line(content, number));
        if (head.lines.size() > kFixedLines) {
            check_line(head.lines.back());
        }
        const std::size_t keyword = keyword_in(head.lines.back().text);
        if (head.lines.size() > kFixedLines && keyword >= kPlaces && keyword < kKeywords.size()) {
            std::string_view rest = content;
            if (!rest.empty() && to_lower(rest.substr(0, 256)).starts_with("lookup_table")) {
                take_line(rest, number);
                content = rest;
            }
            head.data = content;
            return head;
        }
    }
    throw damaged("its head does not end: a line `SCALARS` should follow");
}

void check_dimensions(const Line& line) {
    const std::array<double, 3> sizes = numbers_of(line);
    for (const double size : sizes) {
        if (!(size >= 1.0 && size <= std::numeric_limits<Index>::max() && size == std::floor(size))) {
            fail_at_line(line.number, "an image cannot have the " + io::quoted(line.text));
        }
    }
    if (!(sizes[0] * sizes[1] * sizes[2] < 0x1p40)) {
        fail_at_line(line.number, "an image cannot have the " + io::quoted(line.text));
    }
}

bool is_ascii(const Head& head) { return head.lines[2].text.starts_with("ascii"); }

}  // namespace

void check_vtk_image_head(std::string_view content) {
    const Head head = read_head(content);
    const auto expect = [&](std::size_t line, bool is_right, const std::string& expected) {
        if (!is_right) {
            fail_at_line(head.lines[line].number,
                         io::quoted(head.lines[line].text) + " stands where " + expected + " should");
        }
    };
    expect(2, is_ascii(head) || head.lines[2].text.starts_with("binary"), "`ASCII` or `BINARY`");
    expect(3, head.lines[3].text.starts_with("dataset structured_points"), "`DATASET STRUCTURED_POINTS`");
    expect(4, head.lines[4].text.starts_with("dimensions "), "`DIMENSIONS`");
    check_dimensions(head.lines[4]);
}

void check_vtk_image_length(std::string_view content, std::uintmax_t voxels, std::uintmax_t bytes) {
    const Head head = read_head(content);
    if (!is_ascii(head)) {
        check_bytes(bytes, head.data.size());
        return;
    }
    TextReader words(head.data);
    std::uintmax_t found = 0;
    while (found < voxels && !words.any_word().empty()) {
        ++found;
    }
    if (found < voxels) {
        throw truncated("its head says " + std::to_string(voxels) + " values, but there are " + std::to_string(found));
    }
}

}  // namespace scaleaxis::io
