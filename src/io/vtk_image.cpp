// SPDX-License-Identifier: Apache-2.0
//
// VTK's structured points ("VTK File Formats", simple legacy formats): lines of keywords up to that of the values.
#include <vector>

#include "base/faults.hpp"
#include "io/formats.hpp"
#include "io/image_head.hpp"
#include "io/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::string_view kVtkTypes =
    "char i1 signed_char i1 unsigned_char u1 short i2 unsigned_short u2 int i4 unsigned_int u4 long i8 vtktypeint64 i8 "
    "unsigned_long u8 vtktypeuint64 u8 float f4 double f8";

/// The next line that is not empty, taken off the text: a keyword in lower case, and what follows it.
HeadField take_vtk_line(std::string_view& content, std::size_t& number) {
    while (!content.empty()) {
        const std::string_view line = trimmed(take_line(content));
        ++number;
        if (!line.empty()) {
            const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
            return {to_lower(line.substr(0, end)), trimmed(line.substr(end)), number};
        }
    }
    throw truncated("its head does not end: a line `SCALARS` should follow");
}

/// What a line of the head says; false: the values follow it.
bool read_vtk_line(const HeadField& line, StoredImage& stored) {
    const auto point = [&] {
        const std::vector<double> numbers = line.numbers(line.words(3));
        return Point{numbers[0], numbers[1], numbers[2]};
    };
    if (line.name == "dimensions") {
        stored.sizes = line.sizes(3);
    } else if (line.name == "spacing" || line.name == "aspect_ratio") {
        const Point spacing = point();
        stored.frame.steps = {Point{spacing.x, 0, 0}, Point{0, spacing.y, 0}, Point{0, 0, spacing.z}};
    } else if (line.name == "origin") {
        stored.frame.origin = point();
    } else if (line.name == "scalars") {  // name, type, and perhaps a number of components
        const std::vector<std::string_view> words = words_of(line.value);
        stored.type = line.type(kVtkTypes, words.size() < 2 ? "" : words[1]);
        stored.channels = words.size() < 3 ? 1 : HeadField{line.name, words[2], line.line}.integer(1);
        return false;
    } else if (line.name != "point_data") {
        line.fail(io::quoted(line.name) + " cannot be read: the values have to be SCALARS of points");
    }
    return true;
}

}  // namespace

bool is_vtk_image(std::string_view content) {
    return content.starts_with("# vtk DataFile") &&
           content.substr(0, 1024).find("STRUCTURED_POINTS") != std::string_view::npos;
}

Image read_vtk_image(std::string_view content, const std::filesystem::path&) {
    take_line(content);
    take_line(content);
    std::size_t number = 2;
    const HeadField encoding = take_vtk_line(content, number);
    if (encoding.name != "ascii" && encoding.name != "binary") {
        encoding.fail(io::quoted(encoding.name) + " stands where `ASCII` or `BINARY` should");
    }
    const HeadField dataset = take_vtk_line(content, number);
    if (dataset.name != "dataset" || !to_lower(dataset.value).starts_with("structured_points")) {
        dataset.fail(io::quoted(dataset.name) + " stands where `DATASET STRUCTURED_POINTS` should");
    }
    StoredImage stored;
    stored.order = std::endian::big;
    stored.packing = encoding.name == "ascii" ? Packing::kText : Packing::kNone;
    while (read_vtk_line(take_vtk_line(content, number), stored)) {
    }
    if (to_lower(content.substr(0, 12)) == "lookup_table") {
        take_line(content);
    }
    stored.parts = {StoredData{content}};
    return read_stored(stored);
}

}  // namespace scaleaxis::io
