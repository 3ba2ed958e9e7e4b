// SPDX-License-Identifier: Apache-2.0
//
// VTK's structured points ("VTK File Formats", simple legacy formats): lines of keywords up to that of the values.
#include <algorithm>
#include <cmath>
#include <cstdint>
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

/// What the head says.
struct VtkHead {
    StoredImage stored;
    bool is_of_cells = false;  ///< the values lie in their middles
    bool has_ended = false;    ///< arrays of values follow
    bool has_shares = false;   ///< as text they are parts of 255
};

/// One array of values: its number of components and its type, as words of a line.
void read_vtk_array(const HeadField& line, std::string_view channels, std::string_view type, StoredImage& stored) {
    stored.type = line.type(kVtkTypes, type);
    stored.channels = channels.empty() ? 1 : HeadField{line.name, channels, line.line}.integer(1);
}

/// What a line of the head says; false: the values follow it.
bool read_vtk_line(const HeadField& line, std::string_view& rest, std::size_t& number, VtkHead& head) {
    StoredImage& stored = head.stored;
    const std::vector<std::string_view> words = words_of(line.value);
    const auto word = [&](std::size_t i) { return i < words.size() ? words[i] : std::string_view(); };
    const auto point = [&] {
        const std::vector<double> numbers = line.numbers(line.words(3));
        return Point{numbers[0], numbers[1], numbers[2]};
    };
    const bool is_text = stored.packing == Packing::kText;
    if (line.name == "dimensions") {
        stored.sizes = line.sizes(3);
    } else if (line.name == "spacing" || line.name == "aspect_ratio") {
        const Point spacing = point();
        stored.frame.steps = {Point{spacing.x, 0, 0}, Point{0, spacing.y, 0}, Point{0, 0, spacing.z}};
    } else if (line.name == "origin") {
        stored.frame.origin = point();
    } else if (line.name == "point_data" || line.name == "cell_data") {
        head.is_of_cells = line.name == "cell_data";
        head.has_ended = true;
    } else if (line.name == "field" && !head.has_ended) {
        skip_vtk_fields(rest, line, is_text, number);
    } else if (line.name == "field") {
        const HeadField array = take_vtk_line(rest, number);  // its name, then components, tuples, type
        const std::vector<std::string_view> described = array.words(3);
        read_vtk_array(array, described[0], described[2], stored);
        return false;
    } else if (line.name == "metadata") {
        skip_vtk_metadata(rest, number);
    } else if (line.name == "scalars") {  // name, type, and perhaps a number of components
        read_vtk_array(line, word(2), word(1), stored);
        return false;
    } else if (line.name == "color_scalars") {  // as VTK writes arrays of bytes: name, number of components
        read_vtk_array(line, word(1), is_text ? "float" : "unsigned_char", stored);
        head.has_shares = is_text;
        return false;
    } else {
        line.fail(io::quoted(line.name) + " cannot be read: the values have to be SCALARS of points or cells");
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

void skip_vtk_metadata(std::string_view& content, std::size_t& number) {
    do {
        ++number;
    } while (!content.empty() && !trimmed(take_line(content)).empty());
}

void skip_vtk_fields(std::string_view& content, const HeadField& field, bool is_text, std::size_t& number) {
    constexpr std::string_view kBlanks = " \t\r\n\v\f";
    const auto next = [&] {
        const std::optional<HeadField> line = take_vtk_field(content, number);
        return line ? *line : throw truncated("its data end within a field");
    };
    const std::vector<std::string_view> words = field.words(2);
    const std::int64_t arrays = HeadField{field.name, words[1], field.line}.integer(0);
    for (std::int64_t i = 0; i < arrays; ++i) {
        HeadField array = next();
        if (array.name == "metadata") {
            skip_vtk_metadata(content, number);
            array = next();
        }
        const std::vector<std::string_view> described = array.words(3);  // components, tuples, type
        const auto count_in = [&](std::size_t w) {
            return static_cast<std::size_t>(HeadField{array.name, described[w], array.line}.integer(0));
        };
        const std::size_t size = bytes_per_number(array.type(kVtkTypes, described[2]));
        const std::size_t count = count_in(0) * count_in(1);  // of 31 bits each
        if (count > content.size() / (is_text ? 1 : size)) {
            throw truncated("its data end within a field");
        }
        for (std::size_t n = 0; is_text && n < count; ++n) {
            const std::size_t begin = std::min(content.find_first_not_of(kBlanks), content.size());
            number += static_cast<std::size_t>(std::ranges::count(content.substr(0, begin), '\n'));
            content.remove_prefix(begin);
            content.remove_prefix(std::min(content.find_first_of(kBlanks), content.size()));
        }
        content.remove_prefix(is_text ? 0 : count * size);
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
    VtkHead head;
    StoredImage& stored = head.stored;
    stored.order = std::endian::big;
    stored.packing = is_text ? Packing::kText : Packing::kNone;
    while (read_vtk_line(take_vtk_line(rest, number), rest, number, head)) {
    }
    if (to_lower(rest.substr(0, 12)) == "lookup_table") {
        take_line(rest);
    }
    for (std::size_t axis = 0; head.is_of_cells && axis < stored.sizes.size(); ++axis) {
        --stored.sizes[axis];
        stored.frame.origin = stored.frame.origin + 0.5 * stored.frame.steps[axis];
    }
    stored.parts = {data_behind_head(rest, content, file)};
    Image image = read_stored(stored);
    if (head.has_shares) {
        std::ranges::transform(image.values, image.values.begin(), [](float v) { return std::round(255.0F * v); });
    }
    return image;
}

}  // namespace scaleaxis::io
