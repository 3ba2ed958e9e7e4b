// SPDX-License-Identifier: Apache-2.0
//
// VTK's XML format of images: an extent of a grid, where it is, and arrays of values at its points or in its cells.
#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/faults.hpp"
#include "io/formats.hpp"
#include "io/images/stored_image.hpp"
#include "io/text_reader.hpp"
#include "io/vtk_xml.hpp"

namespace scaleaxis::io {
namespace vti {
namespace {

using pugi::xml_node;

/// The numbers of an attribute; absent ones are `otherwise`.
template <std::size_t count>
std::array<double, count> numbers_of_attribute(const xml_node& element, const char* name,
                                               const std::array<double, count>& otherwise, bool (*is_right)(double)) {
    const std::string text = vtk_attribute(element, name);
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
    const std::string text = vtk_attribute(element, name);
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
        const std::string active = vtk_attribute(part, "Scalars");
        for (const xml_node& array : part.children("DataArray")) {
            const std::string array_name = vtk_attribute(array, "Name");
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

Image read_values(const xml_node& array, const VtkDocument& document, StoredImage& stored) {
    stored.channels = parse_integer(vtk_attribute(array, "NumberOfComponents", "1")).value_or(0);
    stored.is_exact = true;
    const Image frame = frame_of(stored);
    const std::size_t voxels = static_cast<std::size_t>(frame.sizes[0]) * frame.sizes[1] * frame.sizes[2];
    const VtkArray values = read_vtk_array(array, document, voxels);
    stored.type = values.type;
    stored.order = values.order;
    stored.packing = values.is_text ? Packing::kText : Packing::kNone;
    stored.parts = {StoredData{values.bytes()}};
    return read_stored(stored);
}

}  // namespace
}  // namespace vti

bool is_vti(std::string_view content) { return is_vtk_document(content, "ImageData"); }

Image read_vti_image(std::string_view content, const std::filesystem::path&) {
    using namespace vti;
    const VtkDocument document = read_vtk_document(content, "ImageData");
    const xml_node image_data = document.file().child("ImageData");
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
