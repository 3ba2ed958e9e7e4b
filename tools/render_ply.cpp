// SPDX-License-Identifier: GPL-3.0-or-later
#include "render_ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "render_tokens.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::render {
namespace {

using Type = PlyProperty::Type;

/// How the body of the file is written.
enum class Encoding { Ascii, LittleEndian, BigEndian };

struct Header {
    Encoding encoding = Encoding::Ascii;
    Ply ply;
    std::size_t bytes = 0;
    int lines = 0;
};

Header parse_header(const std::string& file, std::string_view content) {
    Header header;
    const auto fail = [&](const std::string& what) {
        throw FileError(file + ", line " + std::to_string(header.lines) + ": " + what);
    };
    const auto type_of = [&](const std::string& name) {
        static constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                                {"uchar", "uint8"},
                                                                                {"short", "int16"},
                                                                                {"ushort", "uint16"},
                                                                                {"int", "int32"},
                                                                                {"uint", "uint32"},
                                                                                {"float", "float32"},
                                                                                {"double", "float64"}}};
        for (std::size_t i = 0; i < kNames.size(); ++i) {
            if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<Type>(i);
        }
        fail("PLY knows no type '" + name + "'");
        return Type::Float64;
    };

    while (true) {
        const std::size_t end = content.find('\n', header.bytes);
        if (end == std::string_view::npos) fail("the PLY header has no end_header; the file is cut short");
        std::istringstream line{std::string(content.substr(header.bytes, end - header.bytes))};
        header.bytes = end + 1;
        ++header.lines;
        std::string keyword;
        line >> keyword;
        if (header.lines == 1 && keyword != "ply") fail("is no PLY file: it does not start with 'ply'");
        if (keyword == "format") {
            std::string name;
            line >> name;
            if (name == "ascii")
                header.encoding = Encoding::Ascii;
            else if (name == "binary_little_endian")
                header.encoding = Encoding::LittleEndian;
            else if (name == "binary_big_endian")
                header.encoding = Encoding::BigEndian;
            else
                fail("PLY knows no format '" + name + "'");
        } else if (keyword == "element") {
            PlyElement element;
            if (!(line >> element.name >> element.count)) fail("an element needs a name and a count");
            header.ply.elements.push_back(std::move(element));
        } else if (keyword == "property") {
            if (header.ply.elements.empty()) fail("a property stands before the first element");
            PlyProperty property;
            std::string type;
            line >> type;
            if (type == "list") {
                property.is_list = true;
                property.offsets.push_back(0);
                line >> type;
                property.count_type = type_of(type);
                line >> type;
            }
            property.type = type_of(type);
            if (!(line >> property.name)) fail("a property needs a type and a name");
            header.ply.elements.back().properties.push_back(std::move(property));
        } else if (keyword == "end_header") {
            return header;
        }
    }
}

/// The numbers of a binary body, one after the other.
class BinaryNumbers {
   public:
    BinaryNumbers(std::string file, std::string_view bytes, bool is_swapped)
        : file_(std::move(file)), bytes_(bytes), is_swapped_(is_swapped) {}

    double next(Type type) {
        switch (type) {
            case Type::Int8:
                return read<std::int8_t>();
            case Type::UInt8:
                return read<std::uint8_t>();
            case Type::Int16:
                return read<std::int16_t>();
            case Type::UInt16:
                return read<std::uint16_t>();
            case Type::Int32:
                return read<std::int32_t>();
            case Type::UInt32:
                return read<std::uint32_t>();
            case Type::Float32:
                return static_cast<double>(read<float>());
            default:
                return read<double>();
        }
    }

   private:
    template <typename T>
    T read() {
        if (bytes_.size() - position_ < sizeof(T))
            throw FileError(file_ + ": the PLY data end too early; the file is cut short");
        std::array<char, sizeof(T)> raw{};
        std::memcpy(raw.data(), bytes_.data() + position_, sizeof(T));
        if (is_swapped_) std::reverse(raw.begin(), raw.end());
        position_ += sizeof(T);
        return std::bit_cast<T>(raw);
    }

    std::string file_;
    std::string_view bytes_;
    bool is_swapped_;
    std::size_t position_ = 0;
};

/// Fills the properties' values; `next(type)` is the file's next number.
template <typename Next>
void read_body(const std::string& file, Ply& ply, Next next) {
    for (PlyElement& element : ply.elements) {
        // Rows without properties hold nothing, however many the header claims.
        if (element.properties.empty()) element.count = 0;
        for (std::size_t row = 0; row < element.count; ++row) {
            for (PlyProperty& property : element.properties) {
                double length = 1.0;
                if (property.is_list) {
                    length = next(property.count_type);
                    if (!(length >= 0.0)) {
                        throw FileError(file + ": " + element.name + " " + std::to_string(row) +
                                        " has a list of negative length");
                    }
                }
                for (double i = 0.0; i < length; i += 1.0) property.values.push_back(next(property.type));
                if (property.is_list) property.offsets.push_back(property.values.size());
            }
        }
    }
}

template <typename Named>
const Named* find_named(const std::vector<Named>& all, std::string_view name) {
    const auto found = std::ranges::find(all, name, &Named::name);
    return found == all.end() ? nullptr : &*found;
}

}  // namespace

const PlyProperty* PlyElement::find(std::string_view property) const { return find_named(properties, property); }

const PlyElement* Ply::find(std::string_view element) const { return find_named(elements, element); }

Ply read_ply(const std::filesystem::path& file) {
    const std::string content = read_file(file);
    Header header = parse_header(file.string(), content);
    const std::string_view body = std::string_view(content).substr(header.bytes);
    if (header.encoding == Encoding::Ascii) {
        Tokens tokens(file.string(), body, header.lines + 1);
        read_body(file.string(), header.ply, [&](Type) { return tokens.number(); });
    } else {
        const bool is_little = header.encoding == Encoding::LittleEndian;
        BinaryNumbers numbers(file.string(), body, is_little != (std::endian::native == std::endian::little));
        read_body(file.string(), header.ply, [&](Type type) { return numbers.next(type); });
    }
    return std::move(header.ply);
}

}  // namespace scaleaxis::render
