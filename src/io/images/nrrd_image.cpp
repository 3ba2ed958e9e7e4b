// SPDX-License-Identifier: Apache-2.0
//
// NRRD ("Definition of NRRD File Format", Teem): lines `field: value`, `key:=value` and comments, up to an empty one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "io/formats.hpp"
#include "io/images/image_head.hpp"
#include "io/images/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

/// Names of fields without blanks: some are written with and without.
constexpr std::string_view kNrrdNames =
    "content number type blocksize dimension space sizes spacings thicknesses axismins axismaxs centers centerings "
    "spacedimension kinds labels units min max oldmin oldmax endian encoding lineskip byteskip spaceunits sampleunits "
    "spaceorigin datafile spacedirections measurementframe";
/// The same of types, without `signed`, and with `u` for `unsigned`.
constexpr std::string_view kNrrdTypes =
    "char i1 int8 i1 int8_t i1 uchar u1 uint8 u1 uint8_t u1 short i2 shortint i2 int16 i2 int16_t i2 "
    "ushort u2 ushortint u2 uint16 u2 uint16_t u2 int i4 int32 i4 int32_t i4 uint u4 uint32 u4 uint32_t u4 "
    "longlong i8 longlongint i8 int64 i8 int64_t i8 ulonglong u8 ulonglongint u8 uint64 u8 uint64_t u8 "
    "float f4 double f8";

std::string without_blanks(std::string_view text) {
    std::string result(text);
    std::erase(result, ' ');
    return result;
}

/// Takes the head off the content; if its last field is a list of files, up to there.
ImageHead take_nrrd_head(std::string_view& content) {
    const std::vector<std::string_view> names = words_of(kNrrdNames);
    ImageHead head;
    take_line(content);
    for (std::size_t number = 2; !content.empty(); ++number) {
        const std::string_view line = take_line(content);
        if (line.empty()) {
            break;
        }
        const std::size_t colon = std::min(line.find(": "), line.size());
        const HeadField field{without_blanks(to_lower(line.substr(0, colon))),
                              trimmed(line.substr(std::min(colon + 1, line.size()))), number};
        if (const std::size_t end = line.find(":="); end != line.npos && line.starts_with("Segment")) {
            head.add({std::string(line.substr(0, end)), trimmed(line.substr(end + 2)), number});  // of 3D Slicer
        } else if (colon < line.size() && std::ranges::find(names, field.name) != names.end()) {
            head.add(field);
            if (field.name == "datafile" && field.value.starts_with("LIST")) {
                break;
            }
        } else if (!line.starts_with('#') && line.find(":=") == std::string_view::npos) {
            field.fail(io::quoted(line) + " is no field of NRRD");
        }
    }
    return head;
}

/// The words of a field that has one of each axis; none if there is no such field.
std::vector<std::string_view> words_of_axes(const ImageHead& head, std::string_view name, std::size_t dimension) {
    const HeadField* field = head.find(name);
    return field == nullptr ? std::vector<std::string_view>() : field->words(dimension);
}

/// NaN where they are absent.
std::vector<double> numbers_of_axes(const ImageHead& head, std::string_view name, std::size_t dimension) {
    const std::vector<std::string_view> words = words_of_axes(head, name, dimension);
    return words.empty() ? std::vector<double>(dimension, NAN) : head.find(name)->numbers(words, true);
}

/// The vectors `(x,y,z)` of a field, of which those that are `none` have NaN; none if there is no such field.
std::vector<Point> vectors_of(const ImageHead& head, std::string_view name, std::size_t count) {
    std::vector<Point> vectors;
    const HeadField* field = head.find(name);
    if (field == nullptr) {
        return vectors;
    }
    for (std::string_view text = field->value; !text.empty(); text = trimmed(text)) {
        const bool is_vector = text.starts_with('(');
        const std::size_t end = std::min(text.find_first_of(is_vector ? ")" : " \t("), text.size());
        const std::vector<double> numbers = field->numbers(words_of(text.substr(0, end), " \t(,"), true);
        if (is_vector && (numbers.size() < 3 || end == text.size())) {
            field->fail(io::quoted(text) + " needs three numbers in parentheses");
        }
        vectors.push_back(is_vector ? Point{numbers[0], numbers[1], numbers[2]} : Point{NAN, NAN, NAN});
        text.remove_prefix(std::min(end + (is_vector ? 1 : 0), text.size()));
    }
    if (vectors.size() != count) {
        field->fail(io::quoted(name) + " needs " + std::to_string(count) + " vectors, not " +
                    std::to_string(vectors.size()));
    }
    return vectors;
}

/// Which axes are those of the image: others, as of colours, are said to be something else, or to have no direction.
std::vector<std::size_t> axes_of_space(const ImageHead& head, const std::vector<Point>& directions,
                                       std::size_t dimension) {
    constexpr auto kKinds = std::to_array<std::string_view>({"domain", "space", "time", "???", "none"});
    const std::vector<std::string_view> kinds = words_of_axes(head, "kinds", dimension);
    std::vector<std::size_t> axes;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
        const bool is_kind = kinds.empty() || std::ranges::find(kKinds, to_lower(kinds[axis])) != kKinds.end();
        const bool has_direction = dimension <= 3 || directions.empty() || is_finite(directions[axis]);
        if (is_kind && has_direction) {
            axes.push_back(axis);
        }
    }
    return axes;
}

/// Where an image without directions lies: `axes` of it are those of space.
void place_by_numbers(const ImageHead& head, const std::vector<std::size_t>& axes, std::size_t dimension,
                      Image& frame) {
    const std::vector<double> spacings = numbers_of_axes(head, "spacings", dimension);
    const std::vector<double> mins = numbers_of_axes(head, "axismins", dimension);
    const std::vector<double> maxs = numbers_of_axes(head, "axismaxs", dimension);
    const std::vector<double> sizes = numbers_of_axes(head, "sizes", dimension);
    const std::vector<std::string_view> centers =
        words_of_axes(head, head.find("centers") != nullptr ? "centers" : "centerings", dimension);
    std::array<double, 3> origin{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t axis = axes[k];
        const bool is_node = !centers.empty() && to_lower(centers[axis]) == "node";
        const double range = (maxs[axis] - mins[axis]) / std::max(1.0, sizes[axis] - (is_node ? 1.0 : 0.0));
        const double spacing = std::isnan(spacings[axis]) ? range : spacings[axis];
        if (!std::isnan(spacing)) {
            frame.steps[k] = spacing * frame.steps[k] + Point();  // no -0
        }
        if (!std::isnan(mins[axis])) {
            origin[k] = mins[axis] + (is_node || std::isnan(spacing) ? 0.0 : 0.5 * spacing);
        }
    }
    frame.origin = {origin[0], origin[1], origin[2]};
}

/// The unit of lengths, if it is the same for all three.
std::string nrrd_unit(const ImageHead& head) {
    const HeadField* units = head.find(head.find("spaceunits") != nullptr ? "spaceunits" : "units");
    const std::vector<std::string_view> words = words_of(units == nullptr ? "" : units->value, "\" \t");
    const bool is_one = words.size() == 3 && words[0] == words[1] && words[0] == words[2];
    return is_one && words[0] != "???" ? std::string(words[0]) : std::string();
}

constexpr std::string_view kTimeOfSpace = "-time";

std::string nrrd_space(const ImageHead& head) {
    const std::string name = head.text("space");
    const bool has_time = name.size() == 4 && name.ends_with('t');
    const std::string letters = has_time ? name.substr(0, 3) : name;
    const std::string words = letters == "ras"   ? "right-anterior-superior"
                              : letters == "las" ? "left-anterior-superior"
                              : letters == "lps" ? "left-posterior-superior"
                                                 : "";
    return words.empty() ? name : words + std::string(has_time ? kTimeOfSpace : "");
}

/// A segment of 3D Slicer.
struct Segment {
    std::string name;
    std::int64_t label = 0;  ///< the value of its voxels …
    std::int64_t layer = 0;  ///< … in this one of the values that each voxel has
};

std::vector<Segment> segments_of(const ImageHead& head) {
    constexpr auto kMostLabel = static_cast<std::int64_t>(kMostExactFloat);
    std::vector<Segment> segments;
    for (std::size_t i = 0;; ++i) {
        const std::string key = "Segment" + std::to_string(i);
        const HeadField* label = head.find(key + "_LabelValue");
        const HeadField* name = head.find(key + "_Name");
        if (label == nullptr || name == nullptr) {
            return segments;
        }
        segments.push_back(
            {std::string(name->value), label->integer(0, kMostLabel), head.integer(key + "_Layer", 0, 0)});
    }
}

std::vector<LabelName> names_of(const std::vector<Segment>& segments) {
    return each_of<LabelName>(segments, [&](const Segment& segment) {
        return LabelName{static_cast<float>(segment.label), segment.name};
    });
}

/// An image with the layers of each voxel after each other becomes one with segments numbered from 1.
/// \throws FileError if segments overlap
void join_layers(std::vector<Segment> segments, std::size_t layers, Image& image) {
    std::map<std::pair<std::int64_t, float>, std::size_t> segment_of;
    for (std::size_t s = 0; s < segments.size(); ++s) {
        segment_of[{segments[s].layer, static_cast<float>(segments[s].label)}] = s;
        segments[s].label = static_cast<std::int64_t>(s) + 1;
    }
    image.sizes[0] /= static_cast<Index>(layers);
    std::pair<std::size_t, std::size_t> overlapping;
    std::int64_t overlaps = 0;
    for (std::size_t voxel = 0; voxel < image.values.size() / layers; ++voxel) {
        float joined = 0.0F;
        for (std::size_t layer = 0; layer < layers; ++layer) {
            const float value = image.values[voxel * layers + layer];
            const auto found = segment_of.find({static_cast<std::int64_t>(layer), value});
            if (value == 0.0F || found == segment_of.end()) {
                continue;
            }
            if (joined != 0.0F) {
                overlapping = {static_cast<std::size_t>(joined) - 1, found->second};
                ++overlaps;
            }
            joined = static_cast<float>(segments[found->second].label);
        }
        image.values[voxel] = joined;
    }
    if (overlaps > 0) {
        throw unsupported("segments of this segmentation of 3D Slicer overlap, as " +
                          io::quoted(segments[overlapping.first].name) + " and " +
                          io::quoted(segments[overlapping.second].name) + " (" + counted(overlaps, "voxel") +
                          " in all): in its module Segmentations, export each segment to a label map of its own");
    }
    image.values.resize(image.values.size() / layers);
    image.label_names = names_of(segments);
}

void read_nrrd_place(const ImageHead& head, StoredImage& stored) {
    constexpr std::int64_t kMostDimensions = 16;
    const auto dimension = static_cast<std::size_t>(head.at("dimension").integer(1, kMostDimensions));
    const std::vector<std::int64_t> sizes = head.at("sizes").sizes(dimension);
    const std::vector<Point> directions = vectors_of(head, "spacedirections", dimension);
    const std::vector<std::size_t> axes = axes_of_space(head, directions, dimension);
    for (std::size_t axis = 0; axis < dimension; ++axis) {
        if (std::ranges::find(axes, axis) != axes.end()) {
            stored.sizes.push_back(sizes[axis]);
        } else if (sizes[axis] > 1) {
            stored.channels = sizes[axis];
        }
    }
    stored.frame.unit = nrrd_unit(head);
    stored.frame.space = nrrd_space(head);
    if (axes.size() < 3) {
        return;  // which is refused
    }
    if (directions.empty()) {
        place_by_numbers(head, axes, dimension, stored.frame);
    }
    for (std::size_t k = 0; k < 3 && !directions.empty(); ++k) {
        if (is_finite(directions[axes[k]])) {
            stored.frame.steps[k] = directions[axes[k]];
        }
    }
    const std::vector<Point> origin = vectors_of(head, "spaceorigin", 1);
    if (!origin.empty()) {
        stored.frame.origin = is_finite(origin[0]) ? origin[0] : Point();
    }
}

NumberType nrrd_type(const HeadField& field) {
    std::string name = without_blanks(to_lower(field.value));
    for (const std::string_view sign : {"unsigned", "signed"}) {
        if (name.starts_with(sign)) {
            name.replace(0, sign.size(), sign == "signed" ? "" : "u");
        }
    }
    return field.type(kNrrdTypes, name);
}

Packing nrrd_packing(const HeadField& field) {
    const std::string name = to_lower(field.value);
    const bool is_text = name == "text" || name == "txt" || name == "ascii";
    if (name != "raw" && name != "hex" && !is_text && !name.starts_with("gz") && !name.starts_with("bz")) {
        field.fail("the encoding " + io::quoted(field.value) + " cannot be read");
    }
    return name == "raw"            ? Packing::kNone
           : name == "hex"          ? Packing::kHex
           : is_text                ? Packing::kText
           : name.starts_with("gz") ? Packing::kZlib
                                    : Packing::kBzip2;
}

}  // namespace

bool is_nrrd(std::string_view content) { return content.starts_with("NRRD000"); }

Image read_nrrd_image(std::string_view content, const std::filesystem::path& file) {
    std::string_view rest = content;
    const ImageHead head = take_nrrd_head(rest);
    StoredImage stored;
    read_nrrd_place(head, stored);
    stored.type = nrrd_type(head.at("type"));
    stored.packing = nrrd_packing(head.at("encoding"));
    if (bytes_per_number(stored.type) > 1 && stored.packing != Packing::kText) {
        const HeadField& endian = head.at("endian");
        if (endian.value != "little" && endian.value != "big") {
            endian.fail(io::quoted(endian.value) + " is neither `little` nor `big`");
        }
        stored.order = endian.value == "big" ? std::endian::big : std::endian::little;
    }
    stored.skipped_lines = head.integer("lineskip", 0, 0);
    stored.skipped_bytes = head.integer("byteskip", -1, 0);
    const HeadField* data = head.find("datafile");
    stored.parts =
        data == nullptr ? std::vector{data_behind_head(rest, content, file)} : data_files(data->value, rest, file);
    const std::vector<Segment> segments = segments_of(head);
    stored.frame.label_names = names_of(segments);
    const std::int64_t layers = stored.channels;
    const bool has_layers = layers > 1 && !segments.empty() && stored.sizes.size() == 3 &&
                            words_of(head.at("sizes").value)[0] == std::to_string(layers);
    if (has_layers) {
        stored.channels = 1;
        frame_of(stored);  // throws for sizes that no image has
        stored.sizes[0] *= layers;
    }
    Image image = read_stored(stored);
    if (has_layers) {
        join_layers(segments, static_cast<std::size_t>(layers), image);
    }
    return image;
}

void write_nrrd_image(OutputFile& out, const Image& image) {
    // Either the space or its dimension. Without the space, viewers take NRRD as left, posterior, superior.
    constexpr std::array kSpaces{"right-anterior-superior", "left-anterior-superior", "left-posterior-superior",
                                 "scanner-xyz"};
    std::string_view space = image.space;  // that of one volume of a series
    space.remove_suffix(space.ends_with(kTimeOfSpace) ? kTimeOfSpace.size() : 0);
    const bool has_space = std::ranges::find(kSpaces, space) != kSpaces.end();
    const Point& origin = image.origin;
    const auto& [a, b, c] = image.steps;
    const std::string quoted = '"' + image.unit + '"';
    const std::string units = image.unit.empty() ? "" : "space units: " + quoted + ' ' + quoted + ' ' + quoted + '\n';
    out.text("NRRD0004\n# made by scaleaxis\ntype: float\ndimension: 3\n",
             has_space ? "space: " + std::string(space) : "space dimension: 3", "\nsizes: ", image.sizes[0], ' ',
             image.sizes[1], ' ', image.sizes[2], "\nspace directions: (", a.x, ',', a.y, ',', a.z, ") (", b.x, ',',
             b.y, ',', b.z, ") (", c.x, ',', c.y, ',', c.z, ")\nkinds: domain domain domain\n",
             "endian: little\nencoding: raw\nspace origin: (", origin.x, ',', origin.y, ',', origin.z, ")\n", units,
             '\n');
    for (const float value : image.values) {
        out.binary(value);
    }
}

}  // namespace scaleaxis::io
