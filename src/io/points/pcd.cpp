// SPDX-License-Identifier: Apache-2.0
/// \file
/// Own code, for the library that defines the format brings VTK, OpenMPI and a hundred other packages with it.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/faults.hpp"
#include "io/formats.hpp"
#include "io/number_type.hpp"
#include "io/ply_elements.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/cloud.hpp"

namespace scaleaxis::io {
namespace {

struct Field {
    std::string_view name;
    std::size_t size = 4;               ///< bytes of a number
    char kind = 'F';                    ///< F, I, U
    std::size_t count = 1;              ///< numbers of a point
    NumberType type = NumberType::kF4;  ///< as its kind and size say
    std::size_t width() const { return size * count; }
};

struct PcdHead {
    std::vector<Field> fields;
    std::size_t points = 0;
    std::string_view encoding;
};

/// A count, which no file exceeds, so that sums and products of some do not overflow.
std::size_t read_count(TextReader& reader, std::string_view word, Index least = 0) {
    const auto value = parse_integer(word);
    if (!value || *value < least || *value > std::numeric_limits<Index>::max()) {
        reader.fail(quoted(word) + " is not a count" + (least > 0 ? " from " + std::to_string(least) + " up" : ""));
    }
    return static_cast<std::size_t>(*value);
}

/// Calls `set(field, word)` with the words of a line, one for each field.
template <class Set>
void read_of_fields(TextReader& reader, std::vector<Field>& fields, const Set& set) {
    for (Field& field : fields) {
        const std::string_view word = reader.word();
        if (word.empty()) {
            reader.fail("one value for each of the " + std::to_string(fields.size()) + " fields is needed");
        }
        set(field, word);
    }
}

/// Reads up to the line `DATA`.
PcdHead read_pcd_head(TextReader& reader) {
    PcdHead head;
    std::optional<std::size_t> points;
    std::size_t grid = 1;
    do {
        const std::string_view keyword = reader.word();
        if (keyword == "FIELDS" || keyword == "COLUMNS") {
            for (std::string_view name = reader.word(); !name.empty(); name = reader.word()) {
                head.fields.push_back({.name = name});
            }
        } else if (keyword == "SIZE") {
            read_of_fields(reader, head.fields,
                           [&](Field& field, std::string_view word) { field.size = read_count(reader, word); });
        } else if (keyword == "TYPE") {
            read_of_fields(reader, head.fields, [](Field& field, std::string_view word) { field.kind = word[0]; });
        } else if (keyword == "COUNT") {
            read_of_fields(reader, head.fields,
                           [&](Field& field, std::string_view word) { field.count = read_count(reader, word, 1); });
        } else if (keyword == "WIDTH" || keyword == "HEIGHT") {
            grid *= read_count(reader, reader.word());
        } else if (keyword == "POINTS") {
            points = read_count(reader, reader.word());
        } else if (keyword == "DATA") {
            head.encoding = reader.word();
            head.points = points.value_or(grid);
            return head;
        } else if (!keyword.empty() && keyword != "VERSION" && keyword != "VIEWPOINT") {
            reader.fail("unknown keyword " + quoted(keyword) + " in the PCD header");
        }
    } while (reader.next_line());
    reader.fail("the file ends within the PCD header: it is truncated", "file.truncated");
}

/// The bytes that Marc Lehmann's LZF has packed: copies of bytes that follow, and of some that came before.
std::string unpacked(std::string_view packed, std::size_t size) {
    const auto fail = [] { throw damaged("the compressed data are damaged"); };
    std::string out;
    out.reserve(size);
    for (std::size_t i = 0; i < packed.size();) {
        const auto next = [&] {
            if (i == packed.size()) {
                fail();
            }
            return static_cast<std::size_t>(static_cast<unsigned char>(packed[i++]));
        };
        const std::size_t control = next();
        if (control < 32) {
            const std::size_t length = control + 1;
            if (length > packed.size() - i || out.size() + length > size) {
                fail();
            }
            out.append(packed.substr(i, length));
            i += length;
            continue;
        }
        const std::size_t length = (control >> 5) + (control >> 5 == 7 ? next() : 0) + 2;
        const std::size_t back = ((control & 31) << 8) + next() + 1;
        if (back > out.size() || out.size() + length > size) {
            fail();
        }
        for (std::size_t k = 0; k < length; ++k) {
            out += out[out.size() - back];
        }
    }
    if (out.size() != size) {
        fail();
    }
    return out;
}

/// The fields of all points as numbers, at most one a point and field: those with more are not needed.
PlyElement columns_of(const PcdHead& head) {
    PlyElement result{"points", head.points, {}};
    for (const Field& field : head.fields) {
        result.properties.push_back({field.name, NumberType::kF8, {}, {}, {}});
    }
    return result;
}

PlyElement read_pcd_ascii(TextReader& reader, const PcdHead& head) {
    if (head.points > reader.rest().size()) {
        reader.fail("the header announces " + std::to_string(head.points) + " points: the file is truncated",
                    "file.truncated");
    }
    PlyElement columns = columns_of(head);
    for (std::size_t i = 0; i < head.points; ++i) {
        for (std::size_t f = 0; f < head.fields.size(); ++f) {
            for (std::size_t k = 0; k < head.fields[f].count; ++k) {
                const double value = reader.any_number();
                if (k == 0) {
                    columns.properties[f].values.push_back(value);
                }
            }
        }
    }
    return columns;
}

/// \param is_by_field all values of the first field come first, then those of the second one…; else point by point
PlyElement read_pcd_binary(std::string_view bytes, const PcdHead& head, bool is_by_field) {
    std::size_t stride = 0;
    for (const Field& field : head.fields) {
        stride += field.width();
    }
    if (stride == 0 || bytes.size() / stride < head.points) {
        throw truncated("the header announces " + std::to_string(head.points) + " points of " + std::to_string(stride) +
                        " bytes, for which the file is too short: it is truncated");
    }
    PlyElement columns = columns_of(head);
    std::size_t begin = 0;
    for (std::size_t f = 0; f < head.fields.size(); ++f) {
        const std::size_t step = is_by_field ? head.fields[f].width() : stride;
        for (std::size_t i = 0; i < head.points; ++i) {
            columns.properties[f].values.push_back(
                number_at(bytes.data() + begin + i * step, head.fields[f].type, std::endian::little));
        }
        begin += is_by_field ? head.points * head.fields[f].width() : head.fields[f].width();
    }
    return columns;
}

PlyElement read_columns(TextReader& reader, const PcdHead& head) {
    if (head.encoding == "ascii") {
        reader.next_line();
        return read_pcd_ascii(reader, head);
    }
    const std::string_view body = reader.after_line();
    if (head.encoding == "binary") {
        return read_pcd_binary(body, head, false);
    }
    if (head.encoding != "binary_compressed") {
        reader.fail("unknown encoding " + quoted(head.encoding) + " of the PCD data", "file.unsupported");
    }
    if (body.size() < 8) {
        throw truncated("the file is truncated");
    }
    const auto packed_size = from_bytes<std::uint32_t>(body.data(), std::endian::little);
    const auto size = from_bytes<std::uint32_t>(body.data() + 4, std::endian::little);
    if (packed_size > body.size() - 8) {
        throw truncated("the compressed data have " + std::to_string(packed_size) + " bytes, the file has " +
                        std::to_string(body.size() - 8) + " of them: it is truncated");
    }
    // Three packed bytes make 264 at most: nothing is reserved for what a damaged file claims.
    if (size / 88 > packed_size) {
        throw damaged("the compressed data are damaged");
    }
    return read_pcd_binary(unpacked(body.substr(8, packed_size), size), head, true);
}

}  // namespace

bool is_pcd(std::string_view content) {
    TextReader reader(content);
    const std::string_view word = reader.any_word();
    return word == "VERSION" ? reader.word().find('.') != std::string_view::npos
                             : (word == "FIELDS" || word == "COLUMNS") && reader.word() == "x";
}

PointCloud read_pcd_points(std::string_view content) {
    TextReader reader(content);
    PcdHead head = read_pcd_head(reader);
    for (Field& field : head.fields) {
        const std::optional<NumberType> type = number_type(to_lower({&field.kind, 1}) + std::to_string(field.size));
        if (!type || type == NumberType::kF2) {
            reader.fail("the field " + quoted(field.name) + " has an unknown type or size");
        }
        field.type = *type;
    }
    const auto has = [&](std::string_view name) {
        return std::ranges::find(head.fields, name, &Field::name) != head.fields.end();
    };
    if (!has("x") || !has("y") || !has("z")) {
        reader.fail("the fields 'x', 'y', 'z' are needed");
    }
    const PlyElement columns = read_columns(reader, head);
    PointCloud cloud{vectors(columns, "x", "y", "z"), {}};
    if (has("normal_x") && has("normal_y") && has("normal_z")) {
        cloud.normals = vectors(columns, "normal_x", "normal_y", "normal_z");
    }
    return cloud;
}

}  // namespace scaleaxis::io
