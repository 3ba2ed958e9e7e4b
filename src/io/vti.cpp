// SPDX-License-Identifier: Apache-2.0
//
// VTK's XML format of images ("VTK File Formats", Kitware): an extent of a grid, where it is, and arrays of values at
// its points or in its cells, which stand in the element itself or together at the end of the file, as text, as bytes,
// or as bytes in base64, packed in blocks or not.
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/base64.hpp"
#include "base/bytes.hpp"
#include "base/compressed.hpp"
#include "base/faults.hpp"
#include "base/xml.hpp"
#include "io/formats.hpp"
#include "io/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace vti {
namespace {

using pugi::xml_node;

constexpr std::string_view kTypes =
    "Int8 i1 UInt8 u1 Int16 i2 UInt16 u2 Int32 i4 UInt32 u4 Int64 i8 UInt64 u8 Float32 f4 Float64 f8";

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

/// Takes bytes off the stored ones.
std::string_view take(std::string_view& bytes, std::size_t count) {
    if (count > bytes.size()) {
        throw truncated("its values end too early");
    }
    const std::string_view taken = bytes.substr(0, count);
    bytes.remove_prefix(count);
    return taken;
}

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

std::uint64_t take_word(std::string_view& bytes, const Storage& storage) {
    return storage.has_long_words ? from_bytes<std::uint64_t>(take(bytes, 8).data(), storage.order)
                                  : from_bytes<std::uint32_t>(take(bytes, 4).data(), storage.order);
}

void check_promised(std::uint64_t promised, std::size_t needed) {
    if (promised != needed) {
        throw damaged("its extent needs " + std::to_string(needed) + " bytes of values, but there are " +
                      std::to_string(promised));
    }
}

/// Blocks of equal size, the last of which may be smaller, each packed on its own.
std::string read_packed(std::string_view bytes, const Storage& storage, std::size_t needed) {
    const std::uint64_t count = take_word(bytes, storage);
    const std::uint64_t block = take_word(bytes, storage);
    const std::uint64_t last = take_word(bytes, storage);
    if (count == 0 || count > bytes.size() / (storage.has_long_words ? 8 : 4) || block > needed + last) {
        throw damaged("it says that its values are " + std::to_string(count) + " blocks of " + std::to_string(block) +
                      " bytes");
    }
    check_promised((count - 1) * block + (last == 0 ? block : last), needed);
    std::vector<std::size_t> packed_sizes(count);
    std::uint64_t packed = 0;
    for (std::size_t& size : packed_sizes) {
        size = take_word(bytes, storage);
        if (size > bytes.size()) {
            throw truncated("its values end too early");
        }
        packed += size;
    }
    check_packed_bytes(needed, packed);
    std::string values;
    values.reserve(needed);
    for (std::size_t i = 0; i < packed_sizes.size(); ++i) {
        const std::size_t size = i + 1 < packed_sizes.size() || last == 0 ? block : last;
        const std::string part = inflated(take(bytes, packed_sizes[i]), size + 1);
        check_promised(part.size(), size);
        values += part;
    }
    return values;
}

/// The data that the array says to be those from its offset on.
std::string_view appended_of(const xml_node& array, const Document& document) {
    const std::string place = attribute(array, "offset");
    const std::optional<std::int64_t> offset = parse_integer(place);
    if (!offset || *offset < 0 || static_cast<std::uint64_t>(*offset) > document.appended.size()) {
        throw damaged("its values begin at " + io::quoted(place) + " of the appended data, where there are none");
    }
    return document.appended.substr(static_cast<std::size_t>(*offset));
}

Image read_values(const xml_node& array, const Document& document, StoredImage& stored) {
    const std::string type = attribute(array, "type");
    const std::optional<NumberType> known = number_type_in(kTypes, type);
    stored.type = known ? *known : throw unsupported("values of type " + io::quoted(type) + " cannot be read");
    stored.channels = parse_integer(attribute(array, "NumberOfComponents", "1")).value_or(0);
    stored.is_exact = true;
    const Image frame = frame_of(stored);
    const std::string format = attribute(array, "format", "ascii");
    if (format == "ascii") {
        stored.packing = Packing::kText;
        stored.parts = {StoredData{array.child_value()}};
        return read_stored(stored);
    }
    const std::string encoding = format == "binary" ? "base64" : document.appended_encoding();
    const bool is_base64 = encoding == "base64";
    if ((format != "binary" && format != "appended") || !(is_base64 || encoding == "raw")) {
        throw damaged("its values are " + io::quoted(format) + ' ' + io::quoted(encoding) + ", which are not known");
    }
    const Storage storage = storage_of(document.file());
    stored.order = storage.order;
    const std::string_view text = format == "binary" ? array.child_value() : appended_of(array, document);
    std::string bytes = is_base64 ? decoded_base64(text.substr(0, text.find('<'))) : std::string();
    const std::size_t voxels = static_cast<std::size_t>(frame.sizes[0]) * frame.sizes[1] * frame.sizes[2];
    const std::size_t needed = voxels * bytes_per_number(stored.type);
    std::string_view values = is_base64 ? bytes : text;
    if (storage.is_packed) {
        bytes = read_packed(values, storage, needed);
        values = bytes;
    } else {
        check_promised(take_word(values, storage), needed);
    }
    stored.parts = {StoredData{take(values, needed)}};
    return read_stored(stored);
}

}  // namespace
}  // namespace vti

bool is_vti(std::string_view content) {
    const std::string_view head = content.substr(0, 1024);
    const std::size_t file = head.find("<VTKFile");
    return file != std::string_view::npos && head.substr(0, head.find('>', file)).find("ImageData", file) < head.size();
}

Image read_vti_image(std::string_view content, const std::filesystem::path&) {
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

    StoredImage stored;
    Image& frame = stored.frame;
    frame.origin = {origin[0], origin[1], origin[2]};
    for (std::size_t a = 0; a < 3; ++a) {
        stored.sizes.push_back(extent[2 * a + 1] - extent[2 * a] + (is_of_cells ? 0 : 1));
        frame.steps[a] = spacing[a] * Point{directions[a], directions[3 + a], directions[6 + a]};
        // Cells have their values in the middle.
        frame.origin = frame.origin + (static_cast<double>(extent[2 * a]) + (is_of_cells ? 0.5 : 0.0)) * frame.steps[a];
    }
    return read_values(array, document, stored);
}

}  // namespace scaleaxis::io
