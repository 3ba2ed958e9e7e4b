// SPDX-License-Identifier: Apache-2.0
//
// The head of NRRD ("Definition of NRRD File Format", Teem): lines `field: value`, `key:=value` and comments, up to an
// empty one.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/faults.hpp"
#include "io/itk_checks.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {
namespace {

struct Field {
    std::string name;  ///< in lower case
    std::string_view value;
    std::size_t line = 0;
};

constexpr auto kNames = std::to_array<std::string_view>({"content",
                                                         "number",
                                                         "type",
                                                         "block size",
                                                         "blocksize",
                                                         "dimension",
                                                         "space",
                                                         "sizes",
                                                         "spacings",
                                                         "thicknesses",
                                                         "space dimension",
                                                         "spacedimension",
                                                         "axis mins",
                                                         "axismins",
                                                         "axis maxs",
                                                         "axismaxs",
                                                         "centers",
                                                         "centerings",
                                                         "space directions",
                                                         "spacedirections",
                                                         "kinds",
                                                         "labels",
                                                         "units",
                                                         "min",
                                                         "max",
                                                         "old min",
                                                         "oldmin",
                                                         "old max",
                                                         "oldmax",
                                                         "endian",
                                                         "encoding",
                                                         "line skip",
                                                         "lineskip",
                                                         "byte skip",
                                                         "byteskip",
                                                         "sample units",
                                                         "sampleunits",
                                                         "space units",
                                                         "spaceunits",
                                                         "space origin",
                                                         "spaceorigin",
                                                         "measurement frame",
                                                         "measurementframe",
                                                         "data file",
                                                         "datafile"});

constexpr auto kTypes = std::to_array<std::string_view>({"signed char",
                                                         "int8",
                                                         "int8_t",
                                                         "uchar",
                                                         "unsigned char",
                                                         "uint8",
                                                         "uint8_t",
                                                         "short",
                                                         "short int",
                                                         "signed short",
                                                         "signed short int",
                                                         "int16",
                                                         "int16_t",
                                                         "ushort",
                                                         "unsigned short",
                                                         "unsigned short int",
                                                         "uint16",
                                                         "uint16_t",
                                                         "int",
                                                         "signed int",
                                                         "int32",
                                                         "int32_t",
                                                         "uint",
                                                         "unsigned int",
                                                         "uint32",
                                                         "uint32_t",
                                                         "longlong",
                                                         "long long",
                                                         "long long int",
                                                         "signed long long",
                                                         "signed long long int",
                                                         "int64",
                                                         "int64_t",
                                                         "ulonglong",
                                                         "unsigned long long",
                                                         "unsigned long long int",
                                                         "uint64",
                                                         "uint64_t",
                                                         "float",
                                                         "double"});

constexpr auto kEncodings = std::to_array<std::string_view>({"raw", "txt", "text", "ascii", "hex", "gzip", "gz"});

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
    return std::ranges::find(words, word) != words.end();
}

/// The next line, without its end; it is taken off the text.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) {
        line.remove_suffix(1);
    }
    return line;
}

/// The fields of the head, and what follows the head.
struct Head {
    std::vector<Field> fields;
    std::string_view data;
};

Head read_head(std::string_view content) {
    Head head;
    std::string_view rest = content;
    take_line(rest);
    for (std::size_t number = 2; !rest.empty(); ++number) {
        const std::string_view line = take_line(rest);
        if (line.empty()) {
            break;
        }
        if (line.starts_with('#')) {
            continue;
        }
        const std::size_t colon = line.find(": ");
        const std::string name = to_lower(line.substr(0, std::min(colon, line.size())));
        if (colon != std::string_view::npos && is_one_of(name, kNames)) {
            std::string_view value = line.substr(colon + 2);
            value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
            head.fields.push_back({name, value, number});
        } else if (line.find(":=") == std::string_view::npos) {
            fail_at_line(number, io::quoted(line) + " is no field of NRRD");
        }
    }
    head.data = rest;
    return head;
}

/// The value of the field that has one of two names; none if there is no such field.
std::optional<Field> find(const Head& head, std::string_view name, std::string_view other_name = {}) {
    const auto found =
        std::ranges::find_if(head.fields, [&](const Field& f) { return f.name == name || f.name == other_name; });
    return found == head.fields.end() ? std::nullopt : std::optional(*found);
}

std::vector<std::string_view> words_of(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> words;
    while (true) {
        const std::size_t begin = text.find_first_not_of(separators);
        if (begin == std::string_view::npos) {
            return words;
        }
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        text.remove_prefix(end);
    }
}

std::int64_t integer_of(const Field& field, std::string_view word, std::int64_t least, std::int64_t most) {
    const std::optional<std::int64_t> value = parse_integer(word);
    if (!value || *value < least || *value > most) {
        fail_at_line(field.line, io::quoted(word) + " cannot be the " + field.name + " of an image");
    }
    return *value;
}

void check_dimension_and_sizes(const Head& head) {
    constexpr std::int64_t kMostDimensions = 16;
    const std::optional<Field> dimension = find(head, "dimension");
    const std::optional<Field> sizes = find(head, "sizes");
    if (!dimension || !sizes || sizes->line < dimension->line) {
        throw damaged("its head needs a line `dimension`, and a line `sizes` after it");
    }
    const std::int64_t count = integer_of(*dimension, dimension->value, 1, kMostDimensions);
    const std::vector<std::string_view> words = words_of(sizes->value, " \t");
    if (words.size() != static_cast<std::size_t>(count)) {
        fail_at_line(sizes->line,
                     "there are " + std::to_string(words.size()) + " sizes in place of " + std::to_string(count));
    }
    double voxels = 1.0;
    for (const std::string_view word : words) {
        voxels *= static_cast<double>(integer_of(*sizes, word, 1, std::numeric_limits<Index>::max()));
    }
    if (!(voxels < 0x1p40)) {
        fail_at_line(sizes->line, "these are sizes that no image has");
    }
}

/// Numbers that place the voxels are in range, `none` or a NaN where there are none.
void check_places(const Field& field) {
    for (const std::string_view word : words_of(field.value, " \t(),")) {
        const std::optional<double> value = parse_number(word);
        const bool is_absent = word == "none" || (value && std::isnan(*value));
        if (!is_absent && !(value && is_of_place(*value))) {
            fail_at_line(field.line, io::quoted(word) + " cannot be a number of the " + field.name);
        }
    }
}

void check_field(const Field& field) {
    // Messages of the toolkit quote fields, in a buffer that overflows.
    constexpr std::size_t kLongest = 500;
    constexpr auto kTexts = std::to_array<std::string_view>({"content", "number", "sample units", "sampleunits"});
    constexpr auto kPlaces = std::to_array<std::string_view>(
        {"spacings", "thicknesses", "axis mins", "axismins", "axis maxs", "axismaxs", "space directions",
         "spacedirections", "space origin", "spaceorigin", "measurement frame", "measurementframe"});
    constexpr std::int64_t kMostSkipped = std::numeric_limits<Index>::max();
    if (field.value.size() > kLongest && !is_one_of(field.name, kTexts)) {
        fail_at_line(field.line, "the field " + io::quoted(field.name) + " has " + std::to_string(field.value.size()) +
                                     " characters, more than any image needs");
    }
    if (is_one_of(field.name, kPlaces)) {
        check_places(field);
    } else if (field.name == "type" && !is_one_of(to_lower(field.value), kTypes)) {
        fail_at_line(field.line, "values of type " + io::quoted(field.value) + " cannot be read");
    } else if (field.name == "encoding" && !is_one_of(to_lower(field.value), kEncodings)) {
        const bool is_bzip2 = to_lower(field.value) == "bzip2" || to_lower(field.value) == "bz2";
        fail_at_line(field.line,
                     "the encoding " + io::quoted(field.value) + " cannot be read" +
                         (is_bzip2 ? "; pack it by gzip: unu save -f nrrd -e gzip -i OLD.nrrd -o NEW.nrrd" : ""));
    } else if (field.name == "line skip" || field.name == "lineskip") {
        integer_of(field, field.value, 0, kMostSkipped);
    } else if (field.name == "byte skip" || field.name == "byteskip") {
        integer_of(field, field.value, -1, kMostSkipped);
    } else if (field.name == "space dimension" || field.name == "spacedimension") {
        integer_of(field, field.value, 1, 8);
    }
}

}  // namespace

void check_nrrd_head(std::string_view content) {
    const Head head = read_head(content);
    std::vector<std::string_view> names;
    for (const Field& field : head.fields) {
        check_field(field);
        if (is_one_of(field.name, names)) {
            fail_at_line(field.line, "the field " + io::quoted(field.name) + " is there twice");
        }
        names.push_back(field.name);
    }
    check_dimension_and_sizes(head);
    for (const std::string_view name : {"type", "encoding"}) {
        if (!find(head, name)) {
            throw damaged("its head has no line `" + std::string(name) + '`');
        }
    }
    if (const std::string data = nrrd_data_file(content); data.find('%') != std::string::npos) {
        throw unsupported("its data are in several files, " + io::quoted(data) +
                          ": this is only read with their names in a LIST");
    }
}

std::string nrrd_data_file(std::string_view content) {
    const std::optional<Field> data = find(read_head(content), "data file", "datafile");
    return data ? std::string(data->value) : std::string();
}

void check_nrrd_length(const std::filesystem::path& file, std::string_view content, std::uintmax_t bytes) {
    const Head head = read_head(content);
    const std::string data = nrrd_data_file(content);
    std::uintmax_t found = head.data.size();
    if (data.starts_with("LIST")) {
        found = size_of_list(file, head.data);
    } else if (!data.empty()) {
        found = size_of_data(file.parent_path() / data);
    }
    const std::optional<Field> encoding = find(head, "encoding");
    if (!encoding || to_lower(encoding->value) != "raw") {
        check_packed_bytes(bytes, found);
        return;
    }
    const std::optional<Field> skip = find(head, "byte skip", "byteskip");
    const auto skipped = static_cast<std::uintmax_t>(skip ? std::max<std::int64_t>(0, *parse_integer(skip->value)) : 0);
    check_bytes(bytes, found - std::min(found, skipped));
}

std::string nrrd_unit(std::string_view content) {
    const Head head = read_head(content);
    std::optional<Field> units = find(head, "space units", "spaceunits");
    if (!units) {
        units = find(head, "units");
    }
    if (!units) {
        return {};
    }
    const std::vector<std::string_view> words = words_of(units->value, "\" \t");
    const bool is_one = words.size() == 3 && words[0] == words[1] && words[0] == words[2];
    return is_one && words[0] != "???" ? std::string(words[0]) : std::string();
}

std::string nrrd_space(std::string_view content) {
    const std::optional<Field> space = find(read_head(content), "space");
    const std::string name = space ? to_lower(space->value) : std::string();
    return name == "ras"   ? "right-anterior-superior"
           : name == "las" ? "left-anterior-superior"
           : name == "lps" ? "left-posterior-superior"
                           : name;
}

}  // namespace scaleaxis::io
