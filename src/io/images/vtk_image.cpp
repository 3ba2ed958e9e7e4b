// SPDX-License-Identifier: Apache-2.0
//
// VTK's structured points ("VTK File Formats", simple legacy formats): lines of keywords up to that of the values.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/faults.hpp"
#include "io/formats.hpp"
#include "io/images/image_head.hpp"
#include "io/images/stored_image.hpp"
#include "io/text_reader.hpp"
#include "io/vtk_legacy.hpp"

namespace scaleaxis::io {
namespace {

HeadField take_vtk_line(std::string_view& content, std::size_t& number) {
    const std::optional<HeadField> field = take_vtk_field(content, number);
    return field ? *field : throw truncated("its head does not end: a line `SCALARS` should follow");
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

std::optional<HeadField> take_vtk_field(std::string_view& content, std::size_t& number) {
    while (!content.empty()) {
        const std::string_view line = trimmed(take_line(content));
        ++number;
        if (!line.empty()) {
            const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
            return HeadField{to_lower(line.substr(0, end)), trimmed(line.substr(end)), number};
        }
    }
    return std::nullopt;
}

void take_vtk_head(std::string_view& content, std::string_view kind, bool& is_text, std::size_t& lines) {
    take_line(content);
    take_line(content);
    lines = 2;
    const HeadField encoding = take_vtk_line(content, lines);
    if (encoding.name != "ascii" && encoding.name != "binary") {
        encoding.fail(io::quoted(encoding.name) + " stands where `ASCII` or `BINARY` should");
    }
    is_text = encoding.name == "ascii";
    const HeadField dataset = take_vtk_line(content, lines);
    if (dataset.name != "dataset") {
        dataset.fail(io::quoted(dataset.name) + " stands where `DATASET` should");
    }
    if (!to_lower(dataset.value).starts_with(kind)) {
        throw unsupported("its data are " + io::quoted(dataset.value) +
                          "; images (STRUCTURED_POINTS) and surfaces (POLYDATA) of VTK are read: take the surface of a "
                          "grid, by the filter Extract Surface of ParaView, and save it as .vtp, STL or PLY");
    }
}

bool is_vtk_legacy(std::string_view content, std::string_view kind) {
    return content.starts_with("# vtk DataFile") &&
           to_lower(content.substr(0, 1024)).find("dataset " + std::string(kind)) != std::string::npos;
}

bool is_vtk_image(std::string_view content) { return is_vtk_legacy(content, "structured_points"); }

Image read_vtk_image(std::string_view content, const std::filesystem::path& file) {
    std::string_view rest = content;
    bool is_text = false;
    std::size_t number = 0;
    take_vtk_head(rest, "structured_points", is_text, number);
    StoredImage stored;
    stored.order = std::endian::big;
    stored.packing = is_text ? Packing::kText : Packing::kNone;
    while (read_vtk_line(take_vtk_line(rest, number), stored)) {
    }
    if (to_lower(rest.substr(0, 12)) == "lookup_table") {
        take_line(rest);
    }
    stored.parts = {data_behind_head(rest, content, file)};
    return read_stored(stored);
}

}  // namespace scaleaxis::io
