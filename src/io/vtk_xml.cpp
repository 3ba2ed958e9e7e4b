// SPDX-License-Identifier: Apache-2.0
#include "io/vtk_xml.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/bytes.hpp"
#include "base/faults.hpp"
#include "base/formats/base64.hpp"
#include "base/formats/compressed.hpp"
#include "io/images/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace vtk_xml {
namespace {

using pugi::xml_node;

constexpr std::string_view kXmlTypes =
    "Int8 i1 UInt8 u1 Int16 i2 UInt16 u2 Int32 i4 UInt32 u4 Int64 i8 UInt64 u8 Float32 f4 Float64 f8";

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
    const std::string words = vtk_attribute(file, "header_type", "UInt32");
    const std::string packer = vtk_attribute(file, "compressor");
    if (words != "UInt32" && words != "UInt64") {
        throw damaged("its header_type is " + io::quoted(words));
    }
    if (!packer.empty() && packer != "vtkZLibDataCompressor") {
        throw unsupported("it is packed by " + io::quoted(packer) + ": save it packed by zlib, or not packed");
    }
    return {vtk_attribute(file, "byte_order", "LittleEndian") == "BigEndian" ? std::endian::big : std::endian::little,
            words == "UInt64", !packer.empty()};
}

std::uint64_t take_word(std::string_view& bytes, const Storage& storage) {
    return storage.has_long_words ? from_bytes<std::uint64_t>(take(bytes, 8).data(), storage.order)
                                  : from_bytes<std::uint32_t>(take(bytes, 4).data(), storage.order);
}

void check_promised(std::uint64_t promised, std::size_t needed) {
    if (promised != needed) {
        throw damaged("its values should be " + std::to_string(needed) + " bytes, but there are " +
                      std::to_string(promised));
    }
}

/// Blocks of equal size, the last of which may be smaller, each packed on its own.
std::string read_packed(std::string_view bytes, const Storage& storage, std::size_t needed) {
    const std::uint64_t count = take_word(bytes, storage);
    const std::uint64_t block = take_word(bytes, storage);
    const std::uint64_t last = take_word(bytes, storage);
    if (count == 0 || count > bytes.size() / (storage.has_long_words ? 8 : 4) || (count > 1 && block > needed)) {
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
std::string_view appended_of(const xml_node& array, const VtkDocument& document) {
    const std::string place = vtk_attribute(array, "offset");
    const std::optional<std::int64_t> offset = parse_integer(place);
    if (!offset || *offset < 0 || static_cast<std::uint64_t>(*offset) > document.appended.size()) {
        throw damaged("its values begin at " + io::quoted(place) + " of the appended data, where there are none");
    }
    return document.appended.substr(static_cast<std::size_t>(*offset));
}

}  // namespace
}  // namespace vtk_xml

bool is_vtk_document(std::string_view content, std::string_view data) {
    const std::string_view head = content.substr(0, 1024);
    const std::size_t file = head.find("<VTKFile");
    return file != std::string_view::npos && head.substr(0, head.find('>', file)).find(data, file) < head.size();
}

std::string vtk_attribute(const pugi::xml_node& element, const char* name, const char* otherwise) {
    return element.attribute(name).as_string(otherwise);
}

VtkDocument read_vtk_document(std::string_view content, const char* data_name) {
    // The data at the end may be any bytes, which no parser of XML takes.
    const std::size_t begin = content.find("<AppendedData");
    VtkDocument document;
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
    if (!document.file().child(data_name)) {
        throw damaged("it has no element " + std::string(data_name) + " in an element VTKFile");
    }
    return document;
}

VtkArray read_vtk_array(const pugi::xml_node& array, const VtkDocument& document, std::size_t count) {
    using namespace vtk_xml;
    VtkArray result;
    const std::string type = vtk_attribute(array, "type");
    const std::optional<NumberType> known = number_type_in(kXmlTypes, type);
    result.type = known ? *known : throw unsupported("values of type " + io::quoted(type) + " cannot be read");
    const std::string format = vtk_attribute(array, "format", "ascii");
    if (format == "ascii") {
        result.is_text = true;
        result.stored = array.child_value();
        return result;
    }
    const std::string encoding = format == "binary" ? "base64" : document.appended_encoding();
    const bool is_base64 = encoding == "base64";
    if ((format != "binary" && format != "appended") || !(is_base64 || encoding == "raw")) {
        throw damaged("its values are " + io::quoted(format) + ' ' + io::quoted(encoding) + ", which are not known");
    }
    const Storage storage = storage_of(document.file());
    result.order = storage.order;
    const std::string_view text = format == "binary" ? array.child_value() : appended_of(array, document);
    const std::size_t needed = count * bytes_per_number(result.type);
    std::string decoded = is_base64 ? decoded_base64(text.substr(0, text.find('<'))) : std::string();
    std::string_view values = is_base64 ? decoded : text;
    if (storage.is_packed) {
        result.unpacked = read_packed(values, storage, needed);
    } else {
        check_promised(take_word(values, storage), needed);
        values = take(values, needed);
        if (is_base64) {
            result.unpacked = values;
        } else {
            result.stored = values;
        }
    }
    return result;
}

std::vector<double> vtk_numbers(const pugi::xml_node& array, const VtkDocument& document, std::size_t count) {
    std::vector<double> numbers;
    if (count == 0) {
        return numbers;
    }
    const VtkArray values = read_vtk_array(array, document, count);
    if (values.is_text) {
        TextReader reader(values.bytes());
        numbers.reserve(std::min(count, values.bytes().size() / 2 + 1));  // a digit and a blank each
        while (numbers.size() < count) {
            const std::string_view word = reader.any_word();
            const std::optional<double> number = parse_number(word);
            if (!number || !is_of_type(*number, values.type)) {
                throw word.empty()
                    ? truncated("its array " + io::quoted(vtk_attribute(array, "Name")) + " should have " +
                                std::to_string(count) + " numbers, but there are " + std::to_string(numbers.size()))
                    : damaged("its array " + io::quoted(vtk_attribute(array, "Name")) + " has " + io::quoted(word) +
                              ", which is no number of its type");
            }
            numbers.push_back(*number);
        }
        return numbers;
    }
    numbers.resize(count);
    const std::size_t size = bytes_per_number(values.type);
    for (std::size_t i = 0; i < count; ++i) {
        numbers[i] = number_at(values.bytes().data() + i * size, values.type, values.order);
    }
    return numbers;
}

}  // namespace scaleaxis::io
