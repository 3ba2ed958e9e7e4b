// SPDX-License-Identifier: Apache-2.0
//
// Formats of images with a short text before the values: INRIMAGE, and those of DGtal.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "io/bytes.hpp"
#include "io/compressed.hpp"
#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::string_view kInr = "#INRIMAGE-4#{";
constexpr std::size_t kInrHead = 256;
constexpr double kMostVoxels = 0x1p32;

using Fields = std::map<std::string, std::string, std::less<>>;

/// The lines `key<separator>value` of a head.
Fields fields_of(std::string_view head, char separator) {
    Fields fields;
    while (!head.empty()) {
        const std::size_t end = std::min(head.find('\n'), head.size());
        const std::string_view line = head.substr(0, end);
        if (const std::size_t at = line.find(separator); at != std::string_view::npos) {
            std::string_view value = line.substr(at + 1);
            while (value.starts_with(' ')) {
                value.remove_prefix(1);
            }
            while (value.ends_with(' ') || value.ends_with('\r')) {
                value.remove_suffix(1);
            }
            fields[std::string(line.substr(0, at))] = value;
        }
        head.remove_prefix(std::min(end + 1, head.size()));
    }
    return fields;
}

const std::string& text_of(const Fields& fields, std::string_view key) {
    const auto field = fields.find(key);
    if (field == fields.end()) {
        throw damaged("its head has no " + std::string(key));
    }
    return field->second;
}

double number_of(const Fields& fields, std::string_view key, double otherwise) {
    if (!fields.contains(key)) {
        return otherwise;
    }
    const std::optional<double> number = parse_number(text_of(fields, key));
    if (!number || !(*number > 0.0) || !std::isfinite(*number)) {
        throw damaged("its head says " + std::string(key) + " " + io::quoted(text_of(fields, key)) +
                      ", which is no positive number");
    }
    return *number;
}

Image image_of(const std::array<double, 3>& sizes) {
    Image image;
    for (int axis = 0; axis < 3; ++axis) {
        const bool is_size = sizes[axis] == std::floor(sizes[axis]) && sizes[axis] <= std::numeric_limits<Index>::max();
        if (!is_size || !(sizes[0] * sizes[1] * sizes[2] < kMostVoxels)) {
            throw damaged("its head says a size that no image has");
        }
        image.sizes[axis] = static_cast<Index>(sizes[axis]);
    }
    return image;
}

std::size_t voxels_of(const Image& image) {
    return static_cast<std::size_t>(image.sizes[0]) * image.sizes[1] * image.sizes[2];
}

void check_length(const Image& image, std::size_t bytes, std::size_t bytes_per_voxel) {
    const std::size_t expected = voxels_of(image) * bytes_per_voxel;
    if (bytes != expected) {
        throw damaged("its head says " + std::to_string(image.sizes[0]) + " x " + std::to_string(image.sizes[1]) +
                      " x " + std::to_string(image.sizes[2]) + " voxels of " + std::to_string(bytes_per_voxel) +
                      (bytes_per_voxel == 1 ? " byte" : " bytes") + ", that is " + std::to_string(expected) +
                      " bytes, but there are " + std::to_string(bytes));
    }
}

template <class T>
void read_values(Image& image, std::string_view data, std::endian order) {
    check_length(image, data.size(), sizeof(T));
    image.values.resize(voxels_of(image));
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        image.values[i] = static_cast<float>(from_bytes<T>(data.data() + i * sizeof(T), order));
    }
}

}  // namespace

bool is_inr(std::string_view content) {
    return content.starts_with(kInr) || (is_gzip(content) && inflated(content, kInr.size(), true) == kInr);
}

namespace {

/// The head of an INRIMAGE file: an image without values, and how these are stored.
struct InrHead {
    Image image;
    std::size_t size = 0;  ///< bytes, a multiple of 256
    std::string type;
    std::string bits;  ///< of a value
    std::endian order = std::endian::little;

    std::size_t bytes_per_voxel() const { return bits == "64" ? 8 : bits == "32" ? 4 : bits == "16" ? 2 : 1; }
};

InrHead read_inr_head(std::string_view content) {
    const std::size_t end = content.find("##}");
    if (end == std::string_view::npos || content.size() < kInrHead) {
        throw truncated("its head does not end");
    }
    InrHead head;
    head.size = (end + 3 + kInrHead) / kInrHead * kInrHead;  // with the line end after it
    const Fields fields = fields_of(content.substr(0, end), '=');
    head.image = image_of({number_of(fields, "XDIM", 1), number_of(fields, "YDIM", 1), number_of(fields, "ZDIM", 1)});
    if (number_of(fields, "VDIM", 1) != 1) {
        throw unsupported("it has several values a voxel; one is needed");
    }
    head.image.steps = {Point{number_of(fields, "VX", 1), 0, 0}, Point{0, number_of(fields, "VY", 1), 0},
                        Point{0, 0, number_of(fields, "VZ", 1)}};
    head.type = text_of(fields, "TYPE");
    head.bits = text_of(fields, "PIXSIZE").substr(0, 2);
    if (!head.bits.empty() && head.bits.back() == ' ') {
        head.bits.pop_back();
    }
    const std::string cpu = text_of(fields, "CPU");
    head.order = cpu == "sun" || cpu == "sgi" ? std::endian::big : std::endian::little;
    return head;
}

}  // namespace

Image read_inr_image(std::string_view content) {
    std::string unpacked;
    if (is_gzip(content)) {
        constexpr std::size_t kMostOfHead = 64 * kInrHead;
        unpacked = inflated(content, kMostOfHead, true);
        const InrHead head = read_inr_head(unpacked);
        // A byte more than the head promises shows that there are too many.
        unpacked = inflated(content, head.size + voxels_of(head.image) * head.bytes_per_voxel() + 1);
        content = unpacked;
    }
    InrHead head = read_inr_head(content);
    Image& image = head.image;
    const std::string_view data = content.substr(std::min(head.size, content.size()));
    const bool is_signed = head.type.starts_with("signed");
    if (head.type.starts_with("float") && head.bits == "32") {
        read_values<float>(image, data, head.order);
    } else if (head.type.starts_with("float") && head.bits == "64") {
        read_values<double>(image, data, head.order);
    } else if (head.type.ends_with("fixed") && head.bits == "8") {
        is_signed ? read_values<std::int8_t>(image, data, head.order)
                  : read_values<std::uint8_t>(image, data, head.order);
    } else if (head.type.ends_with("fixed") && head.bits == "16") {
        is_signed ? read_values<std::int16_t>(image, data, head.order)
                  : read_values<std::uint16_t>(image, data, head.order);
    } else if (head.type.ends_with("fixed") && head.bits == "32") {
        is_signed ? read_values<std::int32_t>(image, data, head.order)
                  : read_values<std::uint32_t>(image, data, head.order);
    } else {
        throw unsupported("values of type " + io::quoted(head.type) + ", " + io::quoted(head.bits) +
                          " bits, cannot be read");
    }
    return image;
}

bool is_vol(std::string_view content) {
    const std::string_view head = content.substr(0, 1024);
    const std::size_t end = head.find("\n.\n");
    return end != std::string_view::npos &&
           ("\n" + std::string(head.substr(0, end))).find("\nX: ") != std::string::npos;
}

Image read_vol_image(std::string_view content) {
    const std::size_t end = std::min(content.find("\n.\n"), content.size());
    const Fields fields = fields_of(content.substr(0, end), ':');
    for (const std::string_view key : {"X", "Y", "Z"}) {
        text_of(fields, key);
    }
    Image image = image_of({number_of(fields, "X", 1), number_of(fields, "Y", 1), number_of(fields, "Z", 1)});
    const std::string_view data = content.substr(std::min(end + 3, content.size()));
    // Version 2 has the bytes as they are, version 3 packs them. Voxels have no place of their own.
    if (number_of(fields, "Version", 2) < 3) {
        read_values<std::uint8_t>(image, data, std::endian::little);
    } else {
        read_values<std::uint8_t>(image, inflated(data, voxels_of(image) + 1), std::endian::little);
    }
    return image;
}

bool is_pgm3d(std::string_view content) { return content.starts_with("P2-3D"); }

Image read_pgm3d_image(std::string_view content) {
    TextReader text(content);
    text.any_word();
    const auto size = [&] { return static_cast<double>(std::max<std::int64_t>(0, text.any_integer())); };
    const double width = size();
    const double height = size();
    Image image = image_of({width, height, size()});
    text.any_integer();                   // the largest value
    constexpr std::size_t kShortest = 2;  // a digit and a blank
    if (voxels_of(image) > text.rest().size() / kShortest + 1) {
        throw truncated("its head says " + std::to_string(voxels_of(image)) + " voxels, but the file is too short");
    }
    image.values.resize(voxels_of(image));
    for (float& value : image.values) {
        value = static_cast<float>(text.any_number());
    }
    if (const std::string_view word = text.any_word(); !word.empty()) {
        text.fail("there are more values than " + std::to_string(image.values.size()));
    }
    return image;
}

}  // namespace scaleaxis::io
