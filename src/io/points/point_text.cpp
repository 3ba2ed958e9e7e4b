// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/formats.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/cloud.hpp"

namespace scaleaxis::io {
namespace {

/// The numbers of the current line.
std::vector<double> read_row(TextReader& reader) {
    std::vector<double> row;
    for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
        reader.put_back(word.size());
        row.push_back(reader.number());
    }
    return row;
}

/// Rows of equally many numbers.
struct Table {
    std::optional<std::int64_t> count;  ///< a single number before the rows
    std::size_t columns = 0;
    std::vector<double> values;

    std::size_t rows() const { return columns > 0 ? values.size() / columns : 0; }
    const double* row(std::size_t i) const { return values.data() + i * columns; }
};

Table read_table(TextReader& reader) {
    Table table;
    bool is_first = true;
    do {
        const std::vector<double> row = read_row(reader);
        if (row.empty()) {
            continue;
        }
        if (is_first && row.size() == 1 && row[0] >= 0.0 && row[0] == std::floor(row[0]) && row[0] < 0x1p31) {
            table.count = static_cast<std::int64_t>(row[0]);
        } else if (table.columns == 0) {
            table.columns = row.size();
            if (table.columns == 4 && !table.count) {
                reader.fail("four numbers a line are balls, x y z r; points have three, or six with their normals");
            }
            const bool has_intensity = table.count && (table.columns == 4 || table.columns == 7);
            if (table.columns != 3 && table.columns != 6 && !has_intensity) {
                reader.fail("a line of a point has three numbers, x y z, or six, x y z nx ny nz; here are " +
                            std::to_string(table.columns));
            }
        } else if (row.size() != table.columns) {
            reader.fail("this line has " + std::to_string(row.size()) + " numbers, those before it have " +
                        std::to_string(table.columns));
        }
        if (table.columns > 0) {
            table.values.insert(table.values.end(), row.begin(), row.end());
        }
        is_first = false;
    } while (reader.next_line());
    return table;
}

std::vector<Point> points(const Table& table, std::size_t begin, std::size_t end, std::size_t column) {
    std::vector<Point> result;
    result.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
        const double* row = table.row(i) + column;
        result.push_back({row[0], row[1], row[2]});
    }
    return result;
}

}  // namespace

/// Is the first line six numbers, or three that are not the counts of a mesh?
bool is_point_text(std::string_view content) {
    TextReader reader(content);
    std::size_t columns = 0;
    bool are_counts = true;
    for (std::string_view word = reader.any_word(); !word.empty(); word = reader.word()) {
        if (!parse_number(word)) {
            return false;
        }
        const auto integer = parse_integer(word);
        are_counts = are_counts && integer && *integer >= 0;
        ++columns;
    }
    return columns == 6 || (columns == 3 && !are_counts);
}

PointCloud read_point_text(std::string_view content) {
    TextReader reader(content);
    const Table table = read_table(reader);
    const std::size_t rows = table.rows();
    const std::size_t count = table.count ? static_cast<std::size_t>(*table.count) : rows;
    const bool has_block_of_normals = table.count && table.columns == 3 && rows == 2 * count;
    if (rows != count && !has_block_of_normals) {
        reader.fail("the first line announces " + std::to_string(count) + " points, but the file has " +
                    std::to_string(rows));
    }
    PointCloud cloud{points(table, 0, count, 0), {}};
    if (has_block_of_normals) {
        cloud.normals = points(table, count, rows, 0);
    } else if (table.columns == 6) {
        cloud.normals = points(table, 0, count, 3);
        drop_colors(cloud);
    }
    return cloud;
}

}  // namespace scaleaxis::io
