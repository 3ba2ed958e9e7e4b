// SPDX-License-Identifier: Apache-2.0
//
// VTK's XML format of images ("VTK File Formats", Kitware): an extent of a grid, where it is, and arrays of values at
// its points or in its cells, which stand in the element itself or together at the end of the file, as text, as bytes,
// or as bytes in base64, packed in blocks or not.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/base64.hpp"
#include "base/xml.hpp"
#include "io/bytes.hpp"
#include "io/compressed.hpp"
#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace vti {
namespace {

using pugi::xml_node;

constexpr double kMostVoxels = 0x1p32;

/// The file as a tree, and what follows the `_` at which the data begin that are not within the tree.
struct Document {
    pugi::xml_document tree;
    std::string_view appended;

    xml_node file() const { return tree.child("VTKFile"); }
    xml_node image_data() const { return file().child("ImageData"); }
    std::string appended_encoding() const { return file().child("AppendedData").attribute("encoding").value(); }
};

std::string attribute(const xml_node& element, const char* name, const char* otherwise = "") {
    return element.attribute(name).as_string(otherwise);
}

Document read_document(std::string_view content) {
    // The data at the end may be any bytes, which no parser of XML takes.
    const std::size_t begin = content.find("<AppendedData");
    Document document;
    if (begin == content.npos) {
        document.tree = parsed_xml(content);
    } else {
        const std::size_t end = content.find('>', begin);
        const std::size_t data = end == content.npos ? end : content.find('_', end);
        if (data == content.npos) {
            throw truncated("there are no data in its AppendedData");
        }
        document.appended = content.substr(data + 1);
        document.tree = parsed_xml(std::string(content.substr(0, end)) + "/></VTKFile>");
    }
    if (!document.image_data()) {
        throw damaged("it has no element ImageData in an element VTKFile");
    }
    return document;
}

/// The numbers of an attribute; absent ones are `otherwise`.
template <std::size_t count>
std::array<double, count> numbers_of_attribute(const xml_node& element, const char* name,
                                               const std::array<double, count>& otherwise, bool (*is_right)(double)) {
    const std::string text = attribute(element, name);
    if (text.empty()) {
        return otherwise;
    }
    std::array<double, count> numbers{};
    TextReader reader(text);
    for (double& number : numbers) {
        const std::optional<double> found = parse_number(reader.any_word());
        if (!found || !is_right(*found)) {
            throw damaged("its " + std::string(name) + ' ' + io::quoted(text) + " is not what an image can have");
        }
        number = *found;
    }
    return numbers;
}

using Extent = std::array<std::int64_t, 6>;  ///< the first and the last point along each axis

Extent extent_of(const xml_node& element, const char* name) {
    Extent extent{};
    const std::string text = attribute(element, name);
    TextReader reader(text);
    for (std::size_t i = 0; i < extent.size(); ++i) {
        constexpr std::int64_t kMost = std::numeric_limits<Index>::max();
        const std::optional<std::int64_t> found = parse_integer(reader.any_word());
        if (!found || *found < -kMost || *found > kMost || (i % 2 == 1 && *found < extent[i - 1])) {
            throw damaged("its " + std::string(name) + ' ' + io::quoted(text) + " is none that an image can have");
        }
        extent[i] = *found;
    }
    return extent;
}

xml_node only_piece(const xml_node& image_data) {
    const auto pieces = image_data.children("Piece");
    if (const auto count = std::distance(pieces.begin(), pieces.end()); count != 1) {
        throw unsupported("it has " + std::to_string(count) +
                          " pieces; one is needed: save it as a whole, by ParaView for instance");
    }
    if (extent_of(*pieces.begin(), "Extent") != extent_of(image_data, "WholeExtent")) {
        throw unsupported("its piece is a part of the image only: save it as a whole, by ParaView for instance");
    }
    return *pieces.begin();
}

struct Scalars {
    xml_node array;
    bool is_of_cells = false;
};

/// The array that the file says are its scalars, those of the points first; or the only array there is.
Scalars scalars_of(const xml_node& piece) {
    std::vector<Scalars> all;
    std::string names;
    for (const bool is_of_cells : {false, true}) {
        const xml_node part = piece.child(is_of_cells ? "CellData" : "PointData");
        const std::string active = attribute(part, "Scalars");
        for (const xml_node& array : part.children("DataArray")) {
            const std::string array_name = attribute(array, "Name");
            if (!active.empty() && array_name == active) {
                return {array, is_of_cells};
            }
            all.push_back({array, is_of_cells});
            names += (names.empty() ? "" : ", ") + io::quoted(array_name);
        }
    }
    if (all.size() != 1) {
        throw unsupported(all.empty() ? "it has no array of values"
                                      : "none of its arrays " + names +
                                            " is named as its Scalars: make one of them the active scalars");
    }
    return all.front();
}

/// Bytes that stand for themselves or in base64, from the first to the last.
class ByteReader {
   public:
    ByteReader(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

    /// No more bytes are left than these.
    std::size_t most_left() const { return decoded_.size() + (is_base64_ ? text_.size() / 4 * 3 : text_.size()); }

    std::string take(std::size_t count) {
        if (count > most_left()) {
            throw truncated("its values end too early");
        }
        if (!is_base64_) {
            const std::string bytes(text_.substr(0, count));
            text_.remove_prefix(count);
            return bytes;
        }
        std::string bytes;
        bytes.reserve(count);
        bytes = std::exchange(decoded_, {});
        while (bytes.size() < count) {
            decode_base64(text_, bytes);
        }
        decoded_ = bytes.substr(count);
        bytes.resize(count);
        return bytes;
    }

   private:
    std::string_view text_;
    bool is_base64_ = false;
    std::string decoded_;  ///< of the last group what was not asked for
};

/// How all arrays of a file are stored.
struct Storage {
    std::endian order = std::endian::little;
    bool has_long_words = false;  ///< numbers before the data have 8 bytes
    bool is_packed = false;
};

Storage storage_of(const xml_node& file) {
    const std::string words = attribute(file, "header_type", "UInt32");
    const std::string packer = attribute(file, "compressor");
    if (words != "UInt32" && words != "UInt64") {
        throw damaged("its header_type is " + io::quoted(words));
    }
    if (!packer.empty() && packer != "vtkZLibDataCompressor") {
        throw unsupported("it is packed by " + io::quoted(packer) + ": save it packed by zlib, or not packed");
    }
    return {attribute(file, "byte_order", "LittleEndian") == "BigEndian" ? std::endian::big : std::endian::little,
            words == "UInt64", !packer.empty()};
}

std::uint64_t read_word(ByteReader& bytes, const Storage& storage) {
    return storage.has_long_words ? from_bytes<std::uint64_t>(bytes.take(8).data(), storage.order)
                                  : from_bytes<std::uint32_t>(bytes.take(4).data(), storage.order);
}

void check_promised(std::uint64_t promised, std::size_t needed) {
    if (promised != needed) {
        throw damaged("its extent needs " + std::to_string(needed) + " bytes of values, but there are " +
                      std::to_string(promised));
    }
}

/// Blocks of equal size, the last of which may be smaller, each packed on its own.
std::string read_packed(ByteReader& bytes, const Storage& storage, std::size_t needed) {
    const std::uint64_t count = read_word(bytes, storage);
    const std::uint64_t block = read_word(bytes, storage);
    const std::uint64_t last = read_word(bytes, storage);
    if (count == 0 || count > bytes.most_left() / (storage.has_long_words ? 8 : 4) || block > needed + last) {
        throw damaged("it says that its values are " + std::to_string(count) + " blocks of " + std::to_string(block) +
                      " bytes");
    }
    check_promised((count - 1) * block + (last == 0 ? block : last), needed);
    std::vector<std::size_t> packed_sizes(count);
    std::uint64_t packed = 0;
    for (std::size_t& size : packed_sizes) {
        size = read_word(bytes, storage);
        if (size > bytes.most_left()) {
            throw truncated("its values end too early");
        }
        packed += size;
    }
    check_packed_bytes(needed, packed);
    std::string values;
    values.reserve(needed);
    for (std::size_t i = 0; i < packed_sizes.size(); ++i) {
        const std::size_t size = i + 1 < packed_sizes.size() || last == 0 ? block : last;
        const std::string part = inflated(bytes.take(packed_sizes[i]), size + 1);
        check_promised(part.size(), size);
        values += part;
    }
    return values;
}

std::string read_bytes_of(ByteReader bytes, const Storage& storage, std::size_t needed) {
    if (storage.is_packed) {
        return read_packed(bytes, storage, needed);
    }
    check_promised(read_word(bytes, storage), needed);
    return bytes.take(needed);
}

std::vector<float> read_vti_text(std::string_view text, std::size_t count) {
    constexpr std::size_t kShortest = 2;  // a digit and a blank
    if (count > text.size() / kShortest + 1) {
        throw truncated("its extent needs " + std::to_string(count) + " values, for which the file is too short");
    }
    TextReader reader(text);
    std::vector<float> values(count);
    for (float& value : values) {
        const std::string_view word = reader.any_word();
        const std::optional<double> number = parse_number(word);
        if (!number) {
            throw damaged(word.empty() ? "there are fewer values than its extent needs, " + std::to_string(count)
                                       : "its value " + io::quoted(word) + " is no number");
        }
        value = static_cast<float>(*number);
    }
    if (!reader.any_word().empty()) {
        throw damaged("there are more values than its extent needs, " + std::to_string(count));
    }
    return values;
}

template <class T>
std::vector<float> converted(const std::string& bytes, std::endian order) {
    std::vector<float> values(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = static_cast<float>(from_bytes<T>(bytes.data() + i * sizeof(T), order));
    }
    return values;
}

struct ValueType {
    std::string_view name;
    std::size_t size = 0;
    std::vector<float> (*convert)(const std::string& bytes, std::endian order) = nullptr;
};

template <class T>
constexpr ValueType value_type(std::string_view name) {
    return {name, sizeof(T), converted<T>};
}

constexpr std::array kValueTypes{value_type<std::int8_t>("Int8"),   value_type<std::uint8_t>("UInt8"),
                                 value_type<std::int16_t>("Int16"), value_type<std::uint16_t>("UInt16"),
                                 value_type<std::int32_t>("Int32"), value_type<std::uint32_t>("UInt32"),
                                 value_type<std::int64_t>("Int64"), value_type<std::uint64_t>("UInt64"),
                                 value_type<float>("Float32"),      value_type<double>("Float64")};

std::vector<float> values_of(const xml_node& array, const Document& document, std::size_t count) {
    const std::string type = attribute(array, "type");
    const auto found = std::ranges::find(kValueTypes, type, &ValueType::name);
    if (found == kValueTypes.end()) {
        throw unsupported("values of type " + io::quoted(type) + " cannot be read");
    }
    if (const std::string components = attribute(array, "NumberOfComponents", "1"); components != "1") {
        throw unsupported("the image has " + io::quoted(components) +
                          " values a voxel (colours, vectors?); one is needed");
    }
    const std::string format = attribute(array, "format", "ascii");
    if (format == "ascii") {
        return read_vti_text(array.child_value(), count);
    }
    const Storage storage = storage_of(document.file());
    const std::size_t needed = count * found->size;
    if (format == "binary") {
        return found->convert(read_bytes_of({array.child_value(), true}, storage, needed), storage.order);
    }
    const std::string place = attribute(array, "offset");
    const std::optional<std::int64_t> offset = parse_integer(place);
    const std::string encoding = document.appended_encoding();
    const bool is_base64 = encoding == "base64";
    if (format != "appended" || !(is_base64 || encoding == "raw")) {
        throw damaged("its values are " + io::quoted(format) + ' ' + io::quoted(encoding) + ", which are not known");
    }
    if (!offset || *offset < 0 || static_cast<std::uint64_t>(*offset) > document.appended.size()) {
        throw damaged("its values begin at " + io::quoted(place) + " of the appended data, where there are none");
    }
    const std::string_view data = document.appended.substr(static_cast<std::size_t>(*offset));
    return found->convert(read_bytes_of({data, is_base64}, storage, needed), storage.order);
}

}  // namespace
}  // namespace vti

bool is_vti(std::string_view content) {
    const std::string_view head = content.substr(0, 1024);
    const std::size_t file = head.find("<VTKFile");
    return file != std::string_view::npos && head.substr(0, head.find('>', file)).find("ImageData", file) < head.size();
}

Image read_vti_image(std::string_view content) {
    using namespace vti;
    const Document document = read_document(content);
    const xml_node image_data = document.image_data();
    const xml_node piece = only_piece(image_data);
    const Extent extent = extent_of(piece, "Extent");
    const auto [array, is_of_cells] = scalars_of(piece);
    const std::array<double, 3> origin = numbers_of_attribute<3>(image_data, "Origin", {0, 0, 0}, is_of_place);
    const std::array<double, 3> spacing = numbers_of_attribute<3>(image_data, "Spacing", {1, 1, 1}, is_spacing);
    const std::array<double, 9> directions =
        numbers_of_attribute<9>(image_data, "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1}, is_of_place);

    Image image;
    image.origin = {origin[0], origin[1], origin[2]};
    double voxels = 1.0;
    for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t size = extent[2 * a + 1] - extent[2 * a] + (is_of_cells ? 0 : 1);
        if (size < 1 || size > std::numeric_limits<Index>::max()) {
            throw damaged("its extent is none that a 3D image can have");
        }
        image.sizes[a] = static_cast<Index>(size);
        voxels *= static_cast<double>(size);
        image.steps[a] = spacing[a] * Point{directions[a], directions[3 + a], directions[6 + a]};
        // Cells have their values in the middle.
        image.origin = image.origin + (static_cast<double>(extent[2 * a]) + (is_of_cells ? 0.5 : 0.0)) * image.steps[a];
    }
    if (!(voxels < kMostVoxels)) {
        throw damaged("its extent is one that no image has");
    }
    image.values = values_of(array, document, static_cast<std::size_t>(voxels));
    return image;
}

}  // namespace scaleaxis::io
