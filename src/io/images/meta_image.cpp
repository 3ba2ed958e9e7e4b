// SPDX-License-Identifier: Apache-2.0
//
// MetaImage: lines `Key = value`, of which `ElementDataFile` is the last one.
#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "base/faults.hpp"
#include "io/formats.hpp"
#include "io/images/image_head.hpp"
#include "io/images/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::string_view kMetaTypes =
    "met_char i1 met_uchar u1 met_short i2 met_ushort u2 met_int i4 met_uint u4 met_long i4 met_ulong u4 "
    "met_long_long i8 met_ulong_long u8 met_float f4 met_double f8";

/// Takes the head off the content.
ImageHead take_meta_head(std::string_view& content) {
    ImageHead head;
    for (std::size_t number = 1; !content.empty(); ++number) {
        const std::string_view line = trimmed(take_line(content));
        const std::size_t end = std::min(line.find_first_of("=:"), line.size());
        const HeadField field{std::string(trimmed(line.substr(0, end))),
                              trimmed(line.substr(std::min(end + 1, line.size()))), number};
        if (end == line.size() && !line.empty()) {
            field.fail(io::quoted(line) + " stands where a line `Key = value` should");
        }
        if (!line.empty()) {
            head.add(field);
        }
        if (field.name == "ElementDataFile") {
            return head;
        }
    }
    throw truncated("its head has no line `ElementDataFile`");
}

bool is_true(const ImageHead& head, std::string_view name) {
    const std::string value = head.text(name);
    return value.starts_with('t') || value.starts_with('1');
}

/// The numbers of the first of these fields that is there; none if none is.
std::vector<double> numbers_of(const ImageHead& head, std::initializer_list<std::string_view> names,
                               std::size_t count) {
    for (const std::string_view name : names) {
        if (const HeadField* field = head.find(name)) {
            return field->numbers(field->words(count));
        }
    }
    return {};
}

/// The rows of its matrix are the directions of the axes of the image.
void read_meta_place(const ImageHead& head, std::size_t dimension, Image& frame) {
    const std::vector<double> spacing = numbers_of(head, {"ElementSpacing", "ElementSize"}, dimension);
    const std::vector<double> origin = numbers_of(head, {"Origin", "Position", "Offset"}, dimension);
    const std::vector<double> matrix =
        numbers_of(head, {"Orientation", "Rotation", "TransformMatrix"}, dimension * dimension);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!matrix.empty()) {
            const double* row = matrix.data() + axis * dimension;
            frame.steps[axis] = {row[0], row[1], row[2]};
        }
        if (!spacing.empty()) {
            frame.steps[axis] = spacing[axis] * frame.steps[axis] + Point();  // no -0
        }
    }
    if (!origin.empty()) {
        frame.origin = {origin[0], origin[1], origin[2]};
    }
    frame.space = "left-posterior-superior";  // as of DICOM, which the format follows without saying so
    const std::string unit = head.text("DistanceUnits");
    frame.unit = unit == "um" || unit == "mm" || unit == "cm" ? unit : "";
}

}  // namespace

bool is_meta_image(std::string_view content) {
    const std::string_view head = content.substr(0, 4096);
    return head.find("NDims") < head.find("ElementDataFile") && head.find("DimSize") != std::string_view::npos;
}

Image read_meta_image(std::string_view content, const std::filesystem::path& file) {
    constexpr std::int64_t kMostDimensions = 10;
    std::string_view rest = content;
    const ImageHead head = take_meta_head(rest);
    const auto dimension = static_cast<std::size_t>(head.at("NDims").integer(1, kMostDimensions));
    StoredImage stored;
    stored.sizes = head.at("DimSize").sizes(dimension);
    stored.channels = head.integer("ElementNumberOfChannels", 1, 1);
    if (dimension >= 3) {  // others are refused
        read_meta_place(head, dimension, stored.frame);
    }
    stored.type = head.at("ElementType").type(kMetaTypes);
    const bool is_big = is_true(head, "BinaryDataByteOrderMSB") || is_true(head, "ElementByteOrderMSB");
    stored.order = is_big ? std::endian::big : std::endian::little;
    const bool is_text = head.find("BinaryData") != nullptr && !is_true(head, "BinaryData");
    stored.packing = is_true(head, "CompressedData") ? Packing::kZlib : is_text ? Packing::kText : Packing::kNone;
    stored.skipped_bytes = head.integer("HeaderSize", -1, 0);
    const std::string_view data = head.at("ElementDataFile").value;
    stored.parts =
        to_lower(data) == "local" ? std::vector{data_behind_head(rest, content, file)} : data_files(data, rest, file);
    return read_stored(stored);
}

}  // namespace scaleaxis::io
