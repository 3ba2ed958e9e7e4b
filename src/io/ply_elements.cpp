// SPDX-License-Identifier: Apache-2.0
#include "io/ply_elements.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "base/faults.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {

namespace {

constexpr std::string_view kTypes =
    "char i1 int8 i1 uchar u1 uint8 u1 short i2 int16 i2 ushort u2 uint16 u2 int i4 int32 i4 uint u4 uint32 u4 "
    "float f4 float32 f4 double f8 float64 f8";

struct PlyHead {
    std::optional<std::endian> byte_order;  ///< none: ascii
    std::vector<PlyElement> elements;
};

NumberType to_type(const TextReader& reader, std::string_view name) {
    if (const std::optional<NumberType> type = number_type_in(kTypes, name)) {
        return *type;
    }
    reader.fail("unknown type " + quoted(name) + " in the PLY header");
}

std::optional<std::endian> read_byte_order(TextReader& reader) {
    const std::string_view format = reader.word();
    if (format == "ascii") {
        return std::nullopt;
    }
    if (format == "binary_little_endian") {
        return std::endian::little;
    }
    if (format == "binary_big_endian") {
        return std::endian::big;
    }
    reader.fail("unknown PLY format " + quoted(format));
}

PlyProperty read_property(TextReader& reader) {
    PlyProperty property;
    std::string_view type = reader.word();
    if (type == "list") {
        property.length_type = to_type(reader, reader.word());
        if (!is_integer(*property.length_type)) {
            reader.fail("the length of a list has to be an integer");
        }
        property.offsets.push_back(0);
        type = reader.word();
    }
    property.type = to_type(reader, type);
    property.name = reader.word();
    return property;
}

PlyElement read_element(TextReader& reader) {
    const std::string_view name = reader.word();
    const std::string_view count = reader.word();
    const auto value = parse_integer(count);
    if (!value || *value < 0) {
        reader.fail(quoted(count) + " is not a number of elements");
    }
    return {name, static_cast<std::size_t>(*value), {}};
}

/// Reads from the first line to the line `end_header`.
PlyHead read_lines_of_head(TextReader& reader) {
    if (reader.word() != "ply") {
        reader.fail("a PLY file begins with a line `ply`");
    }
    PlyHead head;
    bool has_format = false;
    while (reader.next_line()) {
        const std::string_view keyword = reader.word();
        if (keyword == "end_header") {
            if (!has_format) {
                reader.fail("the PLY header has no line `format`");
            }
            return head;
        }
        if (keyword == "format") {
            head.byte_order = read_byte_order(reader);
            has_format = true;
        } else if (keyword == "element") {
            head.elements.push_back(read_element(reader));
        } else if (keyword == "property") {
            if (head.elements.empty()) {
                reader.fail("a property before the first element");
            }
            head.elements.back().properties.push_back(read_property(reader));
        } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
            reader.fail("unknown keyword " + quoted(keyword) + " in the PLY header");
        }
    }
    reader.fail("the file ends within the PLY header: it is truncated", "file.truncated");
}

/// The values after the head of an ascii file.
class AsciiValues {
   public:
    explicit AsciiValues(TextReader& reader) : reader_(reader) {}

    double next(NumberType) { return reader_.any_number(); }
    std::size_t bytes_left() const { return reader_.rest().size() + 1; }
    static std::size_t smallest_size(NumberType) { return 2; }  // a digit and a separator

   private:
    TextReader& reader_;
};

/// The values after the head of a binary file.
class BinaryValues {
   public:
    BinaryValues(std::string_view bytes, std::endian order) : bytes_(bytes), order_(order) {}

    double next(NumberType type) {
        if (bytes_.size() < bytes_per_number(type)) {
            throw truncated("the file is truncated");
        }
        const double value = number_at(bytes_.data(), type, order_);
        bytes_.remove_prefix(bytes_per_number(type));
        return value;
    }
    std::size_t bytes_left() const { return bytes_.size(); }
    static std::size_t smallest_size(NumberType type) { return bytes_per_number(type); }

   private:
    std::string_view bytes_;
    std::endian order_;
};

template <class Values>
void read_item(Values& values, PlyElement& element) {
    for (PlyProperty& property : element.properties) {
        const NumberType type = property.type;
        if (!property.length_type) {
            property.values.push_back(values.next(type));
            continue;
        }
        const double length = values.next(*property.length_type);
        const std::size_t longest = values.bytes_left() / values.smallest_size(type);
        if (!(length >= 0.0 && length <= static_cast<double>(longest))) {
            throw truncated("a list is longer than the rest of the file: it is truncated or damaged");
        }
        for (double k = 0.0; k < length; ++k) {
            property.values.push_back(values.next(type));
        }
        property.offsets.push_back(property.values.size());
    }
}

template <class Values>
void read_items(Values& values, PlyElement& element) {
    std::size_t smallest_item = 0;
    for (const PlyProperty& property : element.properties) {
        smallest_item += values.smallest_size(property.length_type.value_or(property.type));
    }
    if (smallest_item == 0) {
        element.count = 0;
    } else if (element.count > values.bytes_left() / smallest_item) {
        throw truncated("the header announces " + std::to_string(element.count) + " elements " + quoted(element.name) +
                        ", for which the file is too short: it is truncated or damaged");
    }
    for (PlyProperty& property : element.properties) {
        property.values.reserve(element.count);
    }
    for (std::size_t i = 0; i < element.count; ++i) {
        try {
            read_item(values, element);
        } catch (const FileError& error) {
            Diagnostic diagnostic = error.diagnostic();
            diagnostic.message = "element " + quoted(element.name) + " " + std::to_string(i + 1) + " of " +
                                 std::to_string(element.count) + ": " + diagnostic.message;
            if (diagnostic.element.empty()) {
                diagnostic.element = element.name;
                diagnostic.index = static_cast<std::int64_t>(i + 1);
            }
            throw FileError(std::move(diagnostic));
        }
    }
}

template <class Item>
const Item* find_named(const std::vector<Item>& items, std::string_view name, const auto& is_right) {
    const auto found = std::ranges::find_if(items, [&](const Item& i) { return i.name == name && is_right(i); });
    return found == items.end() ? nullptr : &*found;
}

}  // namespace

std::vector<PlyElement> read_ply_head(std::string_view content) {
    TextReader reader(content);
    return read_lines_of_head(reader).elements;
}

std::vector<PlyElement> read_ply_elements(std::string_view content) {
    TextReader reader(content);
    PlyHead head = read_lines_of_head(reader);
    const auto read_all = [&](auto values) {
        for (PlyElement& element : head.elements) {
            read_items(values, element);
        }
    };
    const std::string_view body = reader.after_line();
    if (head.byte_order) {
        read_all(BinaryValues(body, *head.byte_order));
    } else {
        read_all(AsciiValues(reader));
    }
    return std::move(head.elements);
}

const PlyElement* find_element(const std::vector<PlyElement>& elements, std::string_view name) {
    return find_named(elements, name, [](const PlyElement&) { return true; });
}

const PlyProperty* find_number(const PlyElement& element, std::string_view name) {
    return find_named(element.properties, name, [](const PlyProperty& p) { return !p.length_type; });
}

const PlyProperty* find_list(const PlyElement& element, std::string_view name) {
    return find_named(element.properties, name, [](const PlyProperty& p) { return p.length_type.has_value(); });
}

const std::vector<double>& numbers(const PlyElement& element, std::string_view name) {
    if (const PlyProperty* property = find_number(element, name)) {
        return property->values;
    }
    throw damaged("the element " + quoted(element.name) + " has no property " + quoted(name));
}

std::vector<Point> vectors(const PlyElement& element, std::string_view x_name, std::string_view y_name,
                           std::string_view z_name) {
    const std::vector<double>& x = numbers(element, x_name);
    const std::vector<double>& y = numbers(element, y_name);
    const std::vector<double>& z = numbers(element, z_name);
    std::vector<Point> result(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
        result[i] = {x[i], y[i], z[i]};
    }
    return result;
}

std::vector<Index> to_indices(std::span<const double> values) {
    std::vector<Index> indices(values.size(), kNone);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double value = values[i];
        if (value >= 0.0 && value <= std::numeric_limits<Index>::max() && value == std::floor(value)) {
            indices[i] = static_cast<Index>(value);
        }
    }
    return indices;
}

}  // namespace scaleaxis::io
