// SPDX-License-Identifier: Apache-2.0
//
// Tables of points as spreadsheets, loggers and other programs write them. The columns that are wanted are found by
// their names; the cells of others may hold anything.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/formats.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/cloud.hpp"

namespace scaleaxis::io {
namespace {

/// The rest of the current line.
std::string_view line_of(const TextReader& reader) {
    const std::string_view rest = reader.rest();
    return rest.substr(0, rest.find_first_of("\r\n"));
}

/// Cells, without blanks and quotes around them. A separator within quotes is none.
std::vector<std::string_view> cells_of(std::string_view line, char separator) {
    std::vector<std::string_view> cells;
    bool is_quoted = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i == line.size() || (line[i] == separator && !is_quoted)) {
            std::string_view cell = trimmed(line.substr(begin, i - begin));
            if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
                cell = trimmed(cell.substr(1, cell.size() - 2));
            }
            cells.push_back(cell);
            begin = i + 1;
        } else if (line[i] == '"') {
            is_quoted = !is_quoted;
        }
    }
    return cells;
}

using PointColumns = std::array<std::size_t, 3>;

/// The columns of these names, in any case.
std::optional<PointColumns> columns_of(const std::vector<std::string_view>& cells,
                                       const std::array<std::string_view, 3>& names) {
    PointColumns result{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto found = std::ranges::find(cells, names[k], to_lower);
        if (found == cells.end()) {
            return std::nullopt;
        }
        result[k] = static_cast<std::size_t>(found - cells.begin());
    }
    return result;
}

/// What the first line that is no comment says.
struct TableHead {
    char separator = ',';
    std::size_t columns = 0;
    bool has_names = false;
    std::optional<PointColumns> place;
    std::optional<PointColumns> normal;
};

/// A line with the names may stand behind `#` or `//`.
std::string_view without_comment_sign(std::string_view line) {
    line = trimmed(line);
    for (const std::string_view sign : {"#", "//"}) {
        if (line.starts_with(sign)) {
            return trimmed(line.substr(sign.size()));
        }
    }
    return line;
}

bool is_comment(std::string_view line) { return trimmed(line).starts_with('#'); }

/// The head of a table whose first line this is, if it can be one.
std::optional<TableHead> head_of(std::string_view line) {
    constexpr std::size_t kLongest = 1 << 16;  // of anything else, a line may be the whole content
    if (line.size() > kLongest) {
        return std::nullopt;
    }
    const std::string_view text = without_comment_sign(line);
    for (const char separator : {';', '\t', ','}) {
        const std::vector<std::string_view> cells = cells_of(text, separator);
        if (cells.size() < 3) {
            continue;
        }
        TableHead head{separator, cells.size(), false, columns_of(cells, {"x", "y", "z"}), std::nullopt};
        head.has_names = head.place.has_value();
        if (head.has_names) {
            head.normal = columns_of(cells, {"nx", "ny", "nz"});
            return head;
        }
        if (!is_comment(line) && std::ranges::all_of(cells, [](auto cell) { return parse_number(cell).has_value(); })) {
            head.place = PointColumns{0, 1, 2};
            return head;
        }
    }
    return std::nullopt;
}

/// Goes to the first line of the table, behind blank lines and comments.
std::optional<TableHead> find_head(TextReader& reader) {
    do {
        const std::string_view line = line_of(reader);
        if (std::optional<TableHead> head = head_of(line)) {
            return head;
        }
        if (!trimmed(line).empty() && !is_comment(line)) {
            return std::nullopt;
        }
    } while (reader.next_line());
    return std::nullopt;
}

Point vector_of(const TextReader& reader, const std::vector<std::string_view>& cells, const PointColumns& columns) {
    std::array<double, 3> result{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::string_view cell = cells[columns[k]];
        const std::optional<double> value = parse_number(cell);
        if (!value) {
            reader.fail("column " + std::to_string(columns[k] + 1) + ": " + quoted(cell) + " is not a number" +
                        (cell.find(',') != cell.npos ? "; write decimals with a point" : ""));
        }
        result[k] = *value;
    }
    return {result[0], result[1], result[2]};
}

}  // namespace

void drop_colors(PointCloud& cloud) {
    constexpr double kDigits = 0.1;  // no program writes normals with fewer than two
    double largest = 0.0;
    bool are_whole = true;
    bool are_units = true;
    for (const Point& v : cloud.normals) {
        for (const double value : {v.x, v.y, v.z}) {
            if (!(value >= 0.0 && value <= 255.0)) {
                return;
            }
            are_whole = are_whole && value == std::floor(value);
            largest = std::max(largest, value);
        }
        const double length = norm(v);
        are_units = are_units && (length == 0.0 || std::abs(length - 1.0) < kDigits);
    }
    if (largest > 1.0 ? are_whole : !are_units) {
        cloud.normals.clear();
    }
}

/// Is its first line the names of coordinates, or numbers with separators that are no blanks?
bool is_point_table(std::string_view content) {
    TextReader reader(content);
    const std::optional<TableHead> head = find_head(reader);
    return head && (head->has_names || head->separator != '\t');
}

PointCloud read_point_table(std::string_view content) {
    TextReader reader(content);
    std::optional<TableHead> head = find_head(reader);
    if (!head) {
        reader.fail(
            "a table of points begins with the names of its columns, x, y and z among them, or with three "
            "numbers, separated by commas, semicolons or tabs");
    }
    if (!head->has_names && head->columns == 6) {
        head->normal = PointColumns{3, 4, 5};
    } else if (!head->has_names && head->columns != 3) {
        reader.fail("this line has " + std::to_string(head->columns) +
                    " numbers: without the names of its columns in the first line (x, y, z, nx, ny, nz) a table has "
                    "three or six");
    }
    if (head->has_names) {
        reader.next_line();
    }
    PointCloud cloud;
    do {
        const std::string_view line = line_of(reader);
        if (trimmed(line).empty() || is_comment(line)) {
            continue;
        }
        const std::vector<std::string_view> cells = cells_of(line, head->separator);
        if (cells.size() != head->columns) {
            reader.fail("this line has " + std::to_string(cells.size()) + " cells, the first one has " +
                        std::to_string(head->columns));
        }
        cloud.points.push_back(vector_of(reader, cells, *head->place));
        if (head->normal) {
            cloud.normals.push_back(vector_of(reader, cells, *head->normal));
        }
    } while (reader.next_line());
    if (!head->has_names) {
        drop_colors(cloud);
    }
    return cloud;
}

}  // namespace scaleaxis::io
