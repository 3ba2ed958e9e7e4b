// SPDX-License-Identifier: Apache-2.0
//
// The head of MetaImage: lines `Key = value`, of which `ElementDataFile` is the last one.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/compressed.hpp"
#include "io/faults.hpp"
#include "io/input_file.hpp"
#include "io/itk_checks.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {
namespace {

struct Field {
    std::string_view key;
    std::string_view value;
    std::size_t line = 0;
};

struct Head {
    std::vector<Field> fields;
    std::string_view data;  ///< what follows the head
};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

Head read_head(std::string_view content) {
    Head head;
    for (std::size_t number = 1; !content.empty(); ++number) {
        const std::size_t end = std::min(content.find('\n'), content.size());
        const std::string_view line = trimmed(content.substr(0, end));
        content.remove_prefix(std::min(end + 1, content.size()));
        if (line.empty()) {
            continue;
        }
        const std::size_t separator = line.find_first_of("=:");
        if (separator == std::string_view::npos) {
            fail_at_line(number, io::quoted(line) + " stands where a line `Key = value` should");
        }
        head.fields.push_back({trimmed(line.substr(0, separator)), trimmed(line.substr(separator + 1)), number});
        if (head.fields.back().key == "ElementDataFile") {
            head.data = content;
            return head;
        }
    }
    throw truncated("its head has no line `ElementDataFile`");
}

std::string_view value_of(const Head& head, std::string_view key) {
    const auto found = std::ranges::find(head.fields, key, &Field::key);
    return found == head.fields.end() ? std::string_view() : found->value;
}

bool is_true(std::string_view value) {
    return value.starts_with('T') || value.starts_with('t') || value.starts_with('1');
}

std::int64_t integer_of(const Field& field, std::int64_t least, std::int64_t most) {
    const std::optional<std::int64_t> value = parse_integer(field.value);
    if (!value || *value < least || *value > most) {
        fail_at_line(field.line, io::quoted(field.value) + " cannot be the " + std::string(field.key) + " of an image");
    }
    return *value;
}

/// The numbers of a field that needs `count` of them.
std::vector<double> numbers_of(const Field& field, std::size_t count) {
    std::vector<double> numbers;
    TextReader reader(field.value);
    for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
        const std::optional<double> number = parse_number(word);
        if (!number || !is_of_place(*number)) {
            fail_at_line(field.line, io::quoted(word) + " cannot be a number of the " + std::string(field.key));
        }
        numbers.push_back(*number);
    }
    if (numbers.size() != count) {
        fail_at_line(field.line, std::string(field.key) + " needs " + std::to_string(count) + " numbers, not " +
                                     std::to_string(numbers.size()));
    }
    return numbers;
}

void check_sizes(const Field& field, std::size_t dimensions) {
    double voxels = 1.0;
    for (const double size : numbers_of(field, dimensions)) {
        if (!(size >= 1.0 && size <= std::numeric_limits<Index>::max() && size == std::floor(size))) {
            fail_at_line(field.line, "an image cannot have the sizes " + io::quoted(field.value));
        }
        voxels *= size;
    }
    if (!(voxels < 0x1p40)) {
        fail_at_line(field.line, "an image cannot have the sizes " + io::quoted(field.value));
    }
}

template <class Names>
bool is_one_of(std::string_view key, const Names& names) {
    return std::ranges::find(names, key) != names.end();
}

/// \param dimensions as the fields before say; 0 if none has
void check_field(const Field& field, std::size_t dimensions) {
    constexpr auto kVectors = std::to_array<std::string_view>(
        {"Offset", "Position", "Origin", "CenterOfRotation", "ElementSize", "SequenceID"});
    constexpr auto kMatrices = std::to_array<std::string_view>({"TransformMatrix", "Rotation", "Orientation"});
    constexpr auto kNumbers =
        std::to_array<std::string_view>({"ElementMin", "ElementMax", "ElementToIntensityFunctionSlope",
                                         "ElementToIntensityFunctionOffset", "ID", "ParentID"});
    constexpr std::int64_t kMostBytes = std::int64_t{1} << 40;
    constexpr std::size_t kLongest = 250;  // the toolkit copies values into places of 255
    const bool needs_dimensions = field.key == "DimSize" || field.key == "ElementSpacing" ||
                                  is_one_of(field.key, kVectors) || is_one_of(field.key, kMatrices);
    if (needs_dimensions && dimensions == 0) {
        fail_at_line(field.line, std::string(field.key) + " stands before NDims");
    }
    if (field.key == "DimSize") {
        check_sizes(field, dimensions);
    } else if (field.key == "ElementSpacing") {
        for (const double spacing : numbers_of(field, dimensions)) {
            if (!is_spacing(spacing)) {
                fail_at_line(field.line, "an image cannot have the spacing " + io::quoted(field.value));
            }
        }
    } else if (is_one_of(field.key, kVectors)) {
        numbers_of(field, dimensions);
    } else if (is_one_of(field.key, kMatrices)) {
        numbers_of(field, dimensions * dimensions);
    } else if (is_one_of(field.key, kNumbers)) {
        numbers_of(field, 1);
    } else if (field.key == "HeaderSize") {
        integer_of(field, -1, kMostBytes);
    } else if (field.key == "CompressedDataSize") {
        integer_of(field, 0, kMostBytes);
    } else if (field.key == "ElementNumberOfChannels") {
        integer_of(field, 1, 1000);
    } else if (field.key.size() + field.value.size() > kLongest) {
        fail_at_line(field.line, "the value of " + io::quoted(field.key) + " is too long");
    }
}

}  // namespace

void check_meta_image_head(std::string_view content) {
    constexpr std::int64_t kMostDimensions = 10;
    const Head head = read_head(content);
    std::size_t dimensions = 0;
    for (const Field& field : head.fields) {
        if (field.key == "NDims") {
            dimensions = static_cast<std::size_t>(integer_of(field, 1, kMostDimensions));
        }
        check_field(field, dimensions);
        const auto first = std::ranges::find(head.fields, field.key, &Field::key);
        if (first->line != field.line) {
            fail_at_line(field.line, io::quoted(field.key) + " is there twice");
        }
    }
    for (const std::string_view key : {"DimSize", "ElementType"}) {
        if (value_of(head, key).empty()) {
            throw damaged("its head has no line `" + std::string(key) + '`');
        }
    }
    const std::string_view data = value_of(head, "ElementDataFile");
    if (data.find_first_of(" %") != std::string_view::npos) {
        throw unsupported("its data are in several files, " + io::quoted(data) +
                          ": this is only read with their names in a LIST");
    }
    const bool is_packed = is_true(value_of(head, "CompressedData"));
    if (is_packed && to_lower(data) == "local" && value_of(head, "CompressedDataSize").empty()) {
        throw damaged("its head says no CompressedDataSize");
    }
}

std::string meta_image_unit(std::string_view content) {
    const std::string_view unit = value_of(read_head(content), "DistanceUnits");
    return is_one_of(unit, std::to_array<std::string_view>({"um", "mm", "cm"})) ? std::string(unit) : std::string();
}

std::string meta_image_data_file(std::string_view content) {
    const std::string data(value_of(read_head(content), "ElementDataFile"));
    return to_lower(data) == "local" ? std::string() : data;
}

void check_meta_image_length(const std::filesystem::path& file, std::string_view content, std::uintmax_t bytes) {
    const Head head = read_head(content);
    const std::string data = meta_image_data_file(content);
    if (data == "LIST") {
        check_bytes(bytes, size_of_list(file, head.data));
    } else if (is_true(value_of(head, "CompressedData"))) {
        check_bytes(bytes,
                    data.empty() ? inflated_size(head.data) : inflated_size(read_file(file.parent_path() / data)));
    } else {
        const std::uintmax_t found = data.empty() ? head.data.size() : size_of_data(file.parent_path() / data);
        const std::int64_t skipped = parse_integer(value_of(head, "HeaderSize")).value_or(0);
        check_bytes(bytes, found - std::min(found, static_cast<std::uintmax_t>(std::max<std::int64_t>(0, skipped))));
    }
}

}  // namespace scaleaxis::io
