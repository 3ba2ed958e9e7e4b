// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "io/bytes.hpp"
#include "io/formats.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::io {
namespace {

struct Type {
    std::string_view name;
    std::string_view other_name;
    std::size_t size;
    bool is_integer;
    double (*load)(const char* data, std::endian order);
};

template <class T>
constexpr Type make_type(std::string_view name, std::string_view other_name) {
    return {name, other_name, sizeof(T), std::numeric_limits<T>::is_integer,
            [](const char* data, std::endian order) { return static_cast<double>(from_bytes<T>(data, order)); }};
}

constexpr std::array kTypes{
    make_type<std::int8_t>("char", "int8"),    make_type<std::uint8_t>("uchar", "uint8"),
    make_type<std::int16_t>("short", "int16"), make_type<std::uint16_t>("ushort", "uint16"),
    make_type<std::int32_t>("int", "int32"),   make_type<std::uint32_t>("uint", "uint32"),
    make_type<float>("float", "float32"),      make_type<double>("double", "float64"),
};

struct Property {
    const Type* type = nullptr;
    const Type* count_type = nullptr;  ///< of a list
    std::string_view name;
};

struct Element {
    std::string_view name;
    std::int64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    std::optional<std::endian> byte_order;  ///< none: ascii
    std::vector<Element> elements;
};

const Type* to_type(TextReader& reader, std::string_view name) {
    const auto type =
        std::ranges::find_if(kTypes, [&](const Type& t) { return name == t.name || name == t.other_name; });
    if (type == kTypes.end()) {
        reader.fail("unknown type " + quoted(name) + " in the PLY header");
    }
    return type;
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

Property read_property(TextReader& reader) {
    Property property;
    std::string_view type = reader.word();
    if (type == "list") {
        property.count_type = to_type(reader, reader.word());
        if (!property.count_type->is_integer) {
            reader.fail("the length of a list has to be an integer");
        }
        type = reader.word();
    }
    property.type = to_type(reader, type);
    property.name = reader.word();
    return property;
}

Element read_element_line(TextReader& reader) {
    const std::string_view name = reader.word();
    const std::string_view count = reader.word();
    const auto value = parse_integer(count);
    if (!value || *value < 0) {
        reader.fail(quoted(count) + " is not a number of elements");
    }
    return {name, *value, {}};
}

/// Reads from the first line to the line `end_header`.
Header read_header(TextReader& reader) {
    if (reader.word() != "ply") {
        reader.fail("a PLY file begins with a line `ply`");
    }
    Header header;
    bool has_format = false;
    while (reader.next_line()) {
        const std::string_view keyword = reader.word();
        if (keyword == "end_header") {
            if (!has_format) {
                reader.fail("the PLY header has no line `format`");
            }
            return header;
        }
        if (keyword == "format") {
            header.byte_order = read_byte_order(reader);
            has_format = true;
        } else if (keyword == "element") {
            header.elements.push_back(read_element_line(reader));
        } else if (keyword == "property") {
            if (header.elements.empty()) {
                reader.fail("a property before the first element");
            }
            header.elements.back().properties.push_back(read_property(reader));
        } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
            reader.fail("unknown keyword " + quoted(keyword) + " in the PLY header");
        }
    }
    reader.fail("the file ends within the PLY header: it is truncated");
}

/// The values after the header of an ascii file.
class AsciiValues {
   public:
    explicit AsciiValues(TextReader& reader) : reader_(reader) {}

    double next(const Type&) { return reader_.any_number(); }
    std::size_t bytes_left() const { return reader_.rest().size() + 1; }
    static std::size_t smallest_size(const Type&) { return 2; }  // a digit and a separator

   private:
    TextReader& reader_;
};

/// The values after the header of a binary file.
class BinaryValues {
   public:
    BinaryValues(std::string_view bytes, std::endian order) : bytes_(bytes), order_(order) {}

    double next(const Type& type) {
        if (bytes_.size() < type.size) {
            throw FileError("the file is truncated");
        }
        const double value = type.load(bytes_.data(), order_);
        bytes_.remove_prefix(type.size);
        return value;
    }
    std::size_t bytes_left() const { return bytes_.size(); }
    static std::size_t smallest_size(const Type& type) { return type.size; }

   private:
    std::string_view bytes_;
    std::endian order_;
};

/// An item of an element: the values of its properties, and the items of one of its lists.
struct Item {
    std::vector<double> values;
    std::vector<Index> list;
};

Index to_index(double value) {
    const bool is_index = value >= 0.0 && value <= std::numeric_limits<Index>::max() && value == std::floor(value);
    return is_index ? static_cast<Index>(value) : kNone;
}

/// Position of a property in its element; of a list if `is_list`.
std::size_t find_property(const Element& element, std::string_view name, bool is_list = false) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Property& property = element.properties[i];
        if (property.name == name && (property.count_type != nullptr) == is_list) {
            return i;
        }
    }
    throw FileError("the element " + quoted(element.name) + " has no " + (is_list ? "list " : "property ") +
                    quoted(name));
}

template <class Values>
void read_item(Values& values, const Element& element, std::size_t list_position, Item& item) {
    item.list.clear();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Property& property = element.properties[i];
        if (property.count_type == nullptr) {
            item.values[i] = values.next(*property.type);
            continue;
        }
        const double length = values.next(*property.count_type);
        if (!(length >= 0.0 &&
              length <= static_cast<double>(values.bytes_left() / values.smallest_size(*property.type)))) {
            throw FileError("a list is longer than the rest of the file: it is truncated or damaged");
        }
        for (double k = 0.0; k < length; ++k) {
            const double value = values.next(*property.type);
            if (i == list_position) {
                item.list.push_back(to_index(value));
            }
        }
    }
}

/// Calls `use(item)` for all items of an element. \param list_position of the property that becomes `Item::list`
template <class Values, class Use>
void read_items(Values& values, const Element& element, std::size_t list_position, const Use& use) {
    std::size_t smallest_item = 0;
    for (const Property& property : element.properties) {
        smallest_item += values.smallest_size(property.count_type != nullptr ? *property.count_type : *property.type);
    }
    if (smallest_item == 0) {
        return;
    }
    if (static_cast<std::uint64_t>(element.count) > values.bytes_left() / smallest_item) {
        throw FileError("the header announces " + std::to_string(element.count) + " elements " + quoted(element.name) +
                        ", for which the file is too short: it is truncated or damaged");
    }
    Item item{std::vector<double>(element.properties.size()), {}};
    for (std::int64_t i = 0; i < element.count; ++i) {
        try {
            read_item(values, element, list_position, item);
        } catch (const FileError& error) {
            throw FileError("element " + quoted(element.name) + " " + std::to_string(i + 1) + " of " +
                            std::to_string(element.count) + ": " + error.what());
        }
        use(item);
    }
}

/// Calls `read(values, element)` for every element; `read` has to read all its items.
template <class Read>
void read_elements(std::string_view content, const Read& read) {
    TextReader reader(content);
    const Header header = read_header(reader);
    const auto read_all = [&](auto values) {
        for (const Element& element : header.elements) {
            read(values, element);
        }
    };
    const std::string_view body = reader.after_line();
    if (header.byte_order) {
        read_all(BinaryValues(body, *header.byte_order));
    } else {
        read_all(AsciiValues(reader));
    }
}

constexpr std::size_t kNoList = std::numeric_limits<std::size_t>::max();

template <class Values>
void skip_items(Values& values, const Element& element) {
    read_items(values, element, kNoList, [](const Item&) {});
}

template <class Values, class Use>
void read_points(Values& values, const Element& element, const Use& use) {
    const std::size_t x = find_property(element, "x");
    const std::size_t y = find_property(element, "y");
    const std::size_t z = find_property(element, "z");
    read_items(values, element, kNoList, [&](const Item& item) {
        use(Point{item.values[x], item.values[y], item.values[z]}, item);
    });
}

/// Position of the list of corners, which has one name or the other.
std::size_t find_corners(const Element& element) {
    const bool is_singular =
        std::ranges::any_of(element.properties, [](const Property& p) { return p.name == "vertex_index"; });
    return find_property(element, is_singular ? "vertex_index" : "vertex_indices", true);
}

void write_header(OutputFile& out) { out.text("ply\nformat binary_little_endian 1.0\ncomment made by scaleaxis\n"); }

void write_ball_properties(OutputFile& out, std::size_t count) {
    out.text("element vertex ", count,
             "\nproperty double x\nproperty double y\nproperty double z\nproperty double radius\n");
}

}  // namespace

bool is_ply(std::string_view content) {
    TextReader reader(content);
    return reader.word() == "ply" && reader.word().empty();
}

PolygonMesh read_ply_mesh(std::string_view content) {
    PolygonMesh mesh;
    read_elements(content, [&](auto& values, const Element& element) {
        if (element.name == "vertex") {
            read_points(values, element, [&](const Point& point, const Item&) { mesh.vertices.push_back(point); });
        } else if (element.name == "face") {
            read_items(values, element, find_corners(element),
                       [&](const Item& item) { mesh.polygons.push_back(item.list); });
        } else if (element.name == "tristrips") {
            throw FileError("triangle strips are not supported; convert them to faces");
        } else {
            skip_items(values, element);
        }
    });
    return mesh;
}

std::vector<Ball> read_ply_balls(std::string_view content) {
    std::vector<Ball> balls;
    read_elements(content, [&](auto& values, const Element& element) {
        if (element.name != "vertex") {
            skip_items(values, element);
            return;
        }
        const std::size_t radius = find_property(element, "radius");
        read_points(values, element, [&](const Point& center, const Item& item) {
            balls.push_back({center, item.values[radius]});
        });
    });
    return balls;
}

void write_ply_balls(OutputFile& out, std::span<const Ball> balls) {
    write_header(out);
    write_ball_properties(out, balls.size());
    out.text("end_header\n");
    for (const Ball& ball : balls) {
        out.binary(ball.center.x, ball.center.y, ball.center.z, ball.radius);
    }
}

void write_ply_axis(OutputFile& out, const MedialComplex& complex) {
    std::size_t most_corners = 0;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        most_corners = std::max(most_corners, complex.faces[f].size());
    }
    // Some programs read no other type of length than the usual one.
    const bool is_small = most_corners <= std::numeric_limits<std::uint8_t>::max();

    write_header(out);
    write_ball_properties(out, complex.vertices.size());
    out.text("property int ball\n");
    out.text("element face ", complex.faces.size(), "\nproperty list ", is_small ? "uchar" : "int",
             " int vertex_indices\nproperty int sheet\nproperty double angle\n");
    out.text("element edge ", complex.edges.size(), "\nproperty int vertex1\nproperty int vertex2\nend_header\n");

    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        const Point& p = complex.vertices[v];
        out.binary(p.x, p.y, p.z, complex.radii[v], complex.vertex_balls[v]);
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        if (is_small) {
            out.binary(static_cast<std::uint8_t>(corners.size()));
        } else {
            out.binary(static_cast<Index>(corners.size()));
        }
        for (const Index v : corners) {
            out.binary(v);
        }
        out.binary(complex.face_sheets[f], complex.face_angles[f]);
    }
    for (const auto& [a, b] : complex.edges) {
        out.binary(a, b);
    }
}

}  // namespace scaleaxis::io
