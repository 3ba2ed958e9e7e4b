// SPDX-License-Identifier: Apache-2.0
//
// Arrays of NumPy ("NumPy Enhancement Proposal 1: a simple file format for NumPy arrays"): a head that is a dictionary
// of Python, and the numbers; or several of them in an archive. The first index runs along x.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "base/faults.hpp"
#include "io/archive.hpp"
#include "io/formats.hpp"
#include "io/images/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::string_view kNumpyMagic = "\x93NUMPY";

FileError damaged_head() { return damaged("its head is none that NumPy writes"); }

/// What follows `'key':` in the head.
std::string_view value_in(std::string_view head, const std::string& key) {
    const std::size_t at = head.find('\'' + key + "':");
    if (at == std::string_view::npos) {
        throw damaged_head();
    }
    head.remove_prefix(at + key.size() + 3);
    head.remove_prefix(std::min(head.find_first_not_of(' '), head.size()));
    return head;
}

/// `'<u2'`: the order of bytes, and the type.
void read_numpy_type(std::string_view value, StoredImage& stored) {
    const std::size_t end = value.find('\'', 1);
    if (!value.starts_with('\'') || end == std::string_view::npos) {
        throw unsupported("the array has several values an element (a structure?); one is needed");
    }
    const std::string_view descriptor = value.substr(1, end - 1);
    const std::string_view name = descriptor.substr(std::min<std::size_t>(1, descriptor.size()));
    const std::optional<NumberType> type = number_type(name == "b1" ? "u1" : name);
    if (!type) {
        throw unsupported("elements of the type " + io::quoted(descriptor) +
                          " cannot be read: save the array as float32, or as integers");
    }
    stored.type = *type;
    stored.order = descriptor[0] == '>' ? std::endian::big : std::endian::little;
}

/// The head, and the numbers that follow it.
StoredImage read_numpy_head(std::string_view content, const std::filesystem::path& file = {}) {
    const auto get = [&](std::size_t at, auto zero) -> std::size_t {
        if (content.size() < at + sizeof(zero)) {
            throw truncated("its head does not end");
        }
        return from_bytes<decltype(zero)>(content.data() + at, std::endian::little);
    };
    const bool is_first = get(6, std::uint8_t{}) == 1;
    const std::size_t size = is_first ? get(8, std::uint16_t{}) : get(8, std::uint32_t{});
    const std::size_t begin = is_first ? 10 : 12;
    if (size > content.size() - begin) {
        throw truncated("its head does not end");
    }
    const std::string_view head = content.substr(begin, size);
    StoredImage stored;
    read_numpy_type(value_in(head, "descr"), stored);
    stored.is_last_axis_fastest = !value_in(head, "fortran_order").starts_with("True");
    std::string_view shape = value_in(head, "shape");
    const std::size_t end = shape.find(')');
    if (!shape.starts_with('(') || end == std::string_view::npos) {
        throw damaged_head();
    }
    for (const std::string_view word : words_of(shape.substr(1, end - 1), " ,")) {
        const std::optional<std::int64_t> length = parse_integer(word);
        if (!length || stored.sizes.size() > 64) {
            throw damaged_head();
        }
        stored.sizes.push_back(*length);
    }
    stored.parts = {data_behind_head(content.substr(begin + size), content, file)};
    return stored;
}

}  // namespace

bool is_npy(std::string_view content) { return content.starts_with(kNumpyMagic); }

Image read_npy_image(std::string_view content, const std::filesystem::path& file) {
    return read_stored(read_numpy_head(content, file));
}

bool is_npz(std::string_view content) {
    constexpr std::size_t kName = 30;  // of the first file, in its head
    return content.starts_with("PK\x03\x04") && content.substr(0, kName + 256).find(".npy") != std::string_view::npos;
}

/// The one array of three dimensions: others may say where it lies.
Image read_npz_image(std::string_view content, const std::filesystem::path&) {
    std::vector<std::string> names;
    std::string array;
    for (const ArchivePart& part : archive_parts(content)) {
        if (!part.name.ends_with(".npy")) {
            continue;
        }
        std::string bytes = unpacked(part);
        if (is_npy(bytes) && read_numpy_head(bytes).sizes.size() >= 3) {
            names.push_back(io::quoted(part.name.substr(0, part.name.size() - 4)));
            array = std::move(bytes);
        }
    }
    if (names.size() != 1) {
        std::string list;
        for (const std::string& name : names) {
            list += (list.empty() ? ", " : " and ") + name;
        }
        throw unsupported("it has " + std::to_string(names.size()) + " arrays of three dimensions" + list +
                          ": save the one that is the image by itself");
    }
    return read_npy_image(array, {});
}

}  // namespace scaleaxis::io
