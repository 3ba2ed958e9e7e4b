// SPDX-License-Identifier: Apache-2.0
//
// Formats of images with a short text before the values: INRIMAGE, and those of DGtal.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include "base/faults.hpp"
#include "base/formats/compressed.hpp"
#include "io/formats.hpp"
#include "io/images/image_head.hpp"
#include "io/images/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::string_view kInr = "#INRIMAGE-4#{";
constexpr std::size_t kInrHead = 256;

/// The lines `name<separator>value` of a head; of a name that is there twice the last one.
ImageHead head_of(std::string_view text, char separator) {
    ImageHead head;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::string_view line = take_line(text);
        if (const std::size_t at = line.find(separator); at != std::string_view::npos) {
            head.add({std::string(line.substr(0, at)), trimmed(line.substr(at + 1)), number});
        }
    }
    return head;
}

/// 1 where it is not said.
double positive(const ImageHead& head, std::string_view name) {
    const HeadField* field = head.find(name);
    const double number = field == nullptr ? 1.0 : field->numbers({field->value})[0];
    if (!(number > 0.0)) {
        field->fail(io::quoted(field->value) + " is no positive number");
    }
    return number;
}

}  // namespace

bool is_inr(std::string_view content) { return beginning_of(content, kInr.size()) == kInr; }

Image read_inr_image(std::string_view content, const std::filesystem::path& file) {
    constexpr std::size_t kMostOfHead = 64 * kInrHead;
    const std::string head = beginning_of(content, kMostOfHead);
    const std::size_t end = head.find("##}");
    if (end == std::string_view::npos || head.size() < kInrHead) {
        throw truncated("its head does not end");
    }
    const ImageHead fields = head_of(std::string_view(head).substr(0, end), '=');
    StoredImage stored;
    stored.sizes = {fields.integer("XDIM", 1, 1), fields.integer("YDIM", 1, 1), fields.integer("ZDIM", 1, 1)};
    stored.channels = fields.integer("VDIM", 1, 1);
    stored.frame.steps = {Point{positive(fields, "VX"), 0, 0}, Point{0, positive(fields, "VY"), 0},
                          Point{0, 0, positive(fields, "VZ")}};
    const std::string_view type = fields.at("TYPE").value;
    const std::string_view size = fields.at("PIXSIZE").value;
    const std::string kind = type.starts_with("float")    ? "f"
                             : !type.ends_with("fixed")   ? ""
                             : type.starts_with("signed") ? "i"
                                                          : "u";
    const std::int64_t bits = parse_integer(words_of(size).empty() ? "" : words_of(size)[0]).value_or(0);
    const std::optional<NumberType> number = number_type(kind + std::to_string(bits / 8));
    if (!number || bits % 8 != 0) {
        throw unsupported("values of type " + io::quoted(type) + ", " + io::quoted(size) + ", cannot be read");
    }
    stored.type = *number;
    const std::string_view cpu = fields.at("CPU").value;
    stored.order = cpu == "sun" || cpu == "sgi" ? std::endian::big : std::endian::little;
    stored.packing = is_gzip(content) ? Packing::kZlib : Packing::kNone;
    stored.skipped_bytes = static_cast<std::int64_t>((end + 3 + kInrHead) / kInrHead * kInrHead);  // with a line end
    stored.parts = {data_behind_head(content, content, file)};
    stored.is_exact = true;
    return read_stored(stored);
}

bool is_vol(std::string_view content) {
    const std::string_view head = content.substr(0, 1024);
    const std::size_t end = head.find("\n.\n");
    return end != std::string_view::npos &&
           ("\n" + std::string(head.substr(0, end))).find("\nX: ") != std::string::npos;
}

Image read_vol_image(std::string_view content, const std::filesystem::path& file) {
    const std::size_t end = std::min(content.find("\n.\n"), content.size());
    const ImageHead head = head_of(content.substr(0, end), ':');
    StoredImage stored;
    stored.sizes = {head.at("X").integer(1), head.at("Y").integer(1), head.at("Z").integer(1)};
    // Version 2 has the bytes as they are, version 3 packs them. Voxels have no place of their own.
    stored.packing = positive(head, "Version") >= 3 ? Packing::kZlib : Packing::kNone;
    stored.parts = {data_behind_head(content.substr(std::min(end + 3, content.size())), content, file)};
    stored.is_exact = true;
    return read_stored(stored);
}

bool is_pgm3d(std::string_view content) { return content.starts_with("P2-3D"); }

Image read_pgm3d_image(std::string_view content, const std::filesystem::path&) {
    TextReader text(content);
    text.any_word();
    StoredImage head;
    for (int axis = 0; axis < 3; ++axis) {
        head.sizes.push_back(text.any_integer());
    }
    Image image = frame_of(head);
    const std::size_t voxels = static_cast<std::size_t>(image.sizes[0]) * image.sizes[1] * image.sizes[2];
    text.any_integer();                   // the largest value
    constexpr std::size_t kShortest = 2;  // a digit and a blank
    if (voxels > text.rest().size() / kShortest + 1) {
        throw truncated("its head says " + std::to_string(voxels) + " voxels, but the file is too short");
    }
    image.values.resize(voxels);
    for (float& value : image.values) {
        value = as_float(text.any_number());
    }
    if (const std::string_view word = text.any_word(); !word.empty()) {
        text.fail("there are more values than " + std::to_string(image.values.size()));
    }
    return image;
}

}  // namespace scaleaxis::io
