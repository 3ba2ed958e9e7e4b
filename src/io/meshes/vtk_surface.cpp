// SPDX-License-Identifier: Apache-2.0
//
// VTK's polygons (PolyData), in XML and in the simple legacy format of versions up to 4, and from 5 on.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "io/formats.hpp"
#include "io/images/image_head.hpp"
#include "io/text_reader.hpp"
#include "io/vtk_legacy.hpp"
#include "io/vtk_xml.hpp"
#include "scaleaxis/cloud.hpp"

namespace scaleaxis::io {
namespace vtk_surface {
namespace {

using pugi::xml_node;

/// What a file holds: the surface, and how many cells are none of it.
struct PolyData {
    PolygonMesh mesh;
    std::vector<Point> normals;  ///< of the points, or none
    std::int64_t vertices = 0;
    std::int64_t lines = 0;
};

enum class Cells { kPolygons, kStrips, kVertices, kLines };

/// Adds cells of one kind. \param ends of each, in `corners` \param first number of the corners' point 0
void add_cells(Cells kind, std::span<const double> corners, std::span<const double> ends, std::size_t first,
               PolyData& data) {
    if (kind == Cells::kVertices || kind == Cells::kLines) {
        (kind == Cells::kVertices ? data.vertices : data.lines) += std::ssize(ends);
        return;
    }
    std::vector<Index> cell;
    std::size_t begin = 0;
    for (const double stored_end : ends) {
        if (!(stored_end >= static_cast<double>(begin) && stored_end <= static_cast<double>(corners.size()))) {
            throw damaged("the offsets of its cells do not cut the " + std::to_string(corners.size()) +
                          " corners into cells; export it again");
        }
        const auto end = static_cast<std::size_t>(stored_end);
        cell.clear();
        for (std::size_t i = begin; i < end; ++i) {  // corners beyond all numbers are found later
            const double corner = corners[i] + static_cast<double>(first);
            cell.push_back(corner >= 0.0 && corner <= std::numeric_limits<Index>::max() ? static_cast<Index>(corner)
                                                                                        : kNone);
        }
        if (kind == Cells::kStrips) {
            add_strip(cell, data.mesh.polygons);
        } else {
            data.mesh.polygons.push_back(cell);
        }
        begin = end;
    }
}

std::vector<Point> points_of(std::span<const double> numbers) {
    std::vector<Point> points(numbers.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    }
    return points;
}

// ---------------------------------------------------------------------------------------------------------------------
// XML
// ---------------------------------------------------------------------------------------------------------------------

std::size_t count_of(const xml_node& piece, const char* name) {
    const std::string text = vtk_attribute(piece, name, "0");
    const std::optional<std::int64_t> count = parse_integer(text);
    if (!count || *count < 0 || *count > std::numeric_limits<Index>::max()) {
        throw damaged("its " + std::string(name) + " is " + io::quoted(text));
    }
    return static_cast<std::size_t>(*count);
}

xml_node array_named(const xml_node& element, std::string_view name) {
    return element.find_child([&](const xml_node& array) { return vtk_attribute(array, "Name") == name; });
}

void read_cells(const VtkDocument& document, const xml_node& piece, const char* element, std::size_t count, Cells kind,
                std::size_t first, PolyData& data) {
    if (count == 0) {
        return;
    }
    const xml_node cells = piece.child(element);
    const std::vector<double> ends = vtk_numbers(array_named(cells, "offsets"), document, count);
    if (!(ends.back() >= 0.0 && ends.back() <= std::numeric_limits<Index>::max())) {
        throw damaged("the offsets of its cells are no numbers of corners; export it again");
    }
    const auto corners = static_cast<std::size_t>(ends.back());
    add_cells(kind, vtk_numbers(array_named(cells, "connectivity"), document, corners), ends, first, data);
}

/// An axis or skeleton that this program has written, whose triangles bound nothing.
bool is_axis(const xml_node& piece) {
    const xml_node cells = piece.child("CellData");
    return array_named(piece.child("PointData"), "radius") &&
           (array_named(cells, "sheet") || array_named(cells, "branch"));
}

PolyData read_xml(std::string_view content) {
    const VtkDocument document = read_vtk_document(content, "PolyData");
    PolyData data;
    bool have_normals = true;
    for (const xml_node& piece : document.file().child("PolyData").children("Piece")) {
        if (is_axis(piece)) {
            throw unsupported("it holds an axis or a skeleton; an axis is read from PLY and .ma: write it as such");
        }
        const std::size_t first = data.mesh.vertices.size();
        const std::size_t points = count_of(piece, "NumberOfPoints");
        const xml_node places = piece.child("Points").child("DataArray");
        std::ranges::copy(points_of(vtk_numbers(places, document, 3 * points)), std::back_inserter(data.mesh.vertices));
        const xml_node values = piece.child("PointData");
        if (const xml_node normals = array_named(values, vtk_attribute(values, "Normals", "Normals")); !normals) {
            have_normals = false;
        } else if (have_normals) {
            std::ranges::copy(points_of(vtk_numbers(normals, document, 3 * points)), std::back_inserter(data.normals));
        }
        read_cells(document, piece, "Verts", count_of(piece, "NumberOfVerts"), Cells::kVertices, first, data);
        read_cells(document, piece, "Lines", count_of(piece, "NumberOfLines"), Cells::kLines, first, data);
        read_cells(document, piece, "Polys", count_of(piece, "NumberOfPolys"), Cells::kPolygons, first, data);
        read_cells(document, piece, "Strips", count_of(piece, "NumberOfStrips"), Cells::kStrips, first, data);
    }
    if (!have_normals) {
        data.normals.clear();
    }
    return data;
}

// ---------------------------------------------------------------------------------------------------------------------
// Legacy
// ---------------------------------------------------------------------------------------------------------------------

/// The body of a file: lines with keywords, each followed by numbers as text or as bytes, the most significant first.
class Body {
   public:
    explicit Body(std::string_view content) : rest_(content) { take_vtk_head(rest_, "polydata", is_text_, line_); }

    /// The next line that is not empty; none at the end.
    std::optional<HeadField> next() { return take_vtk_field(rest_, line_); }

    /// The next line, which has to have that keyword.
    HeadField next(std::string_view keyword) {
        const std::optional<HeadField> field = next();
        if (!field || field->name != keyword) {
            throw truncated("its data end where a line " + io::quoted(keyword) + " should follow");
        }
        return *field;
    }

    void skip_metadata() { skip_vtk_metadata(rest_, line_); }

    void skip_fields(const HeadField& field) { skip_vtk_fields(rest_, field, is_text_, line_); }

    std::vector<double> numbers(std::size_t count, NumberType type) {
        std::vector<double> result;
        const std::size_t size = bytes_per_number(type);
        if (count > rest_.size() / (is_text_ ? 1 : size)) {
            throw truncated("it should have " + std::to_string(count) + " numbers from line " +
                            std::to_string(line_ + 1) + " on, which are more than the rest of the file can hold");
        }
        result.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            result.push_back(is_text_ ? number(type) : number_at(rest_.data() + i * size, type, std::endian::big));
        }
        rest_.remove_prefix(is_text_ ? 0 : count * size);
        return result;
    }

   private:
    double number(NumberType type) {
        std::size_t begin = 0;
        while (begin < rest_.size() && std::string_view(" \t\r\n\v\f").find(rest_[begin]) != std::string_view::npos) {
            line_ += rest_[begin] == '\n' ? 1 : 0;
            ++begin;
        }
        rest_.remove_prefix(begin);
        const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n\v\f"));
        const std::optional<double> found = parse_number(word);
        if (!found || !is_of_type(*found, type)) {
            fail_at_line(line_ + 1, io::quoted(word) + " is no number of its type");
        }
        rest_.remove_prefix(word.size());
        return *found;
    }

    std::string_view rest_;
    std::size_t line_ = 0;  ///< whose end was taken last
    bool is_text_ = false;
};

std::size_t count_in(const HeadField& field, std::size_t word) {
    const std::vector<std::string_view> words = words_of(field.value);
    return static_cast<std::size_t>(
        HeadField{field.name, word < words.size() ? words[word] : std::string_view(), field.line}.integer(0));
}

NumberType type_in(const HeadField& field, std::size_t word) {
    const std::vector<std::string_view> words = words_of(field.value);
    return field.type(kVtkTypes, word < words.size() ? to_lower(words[word]) : std::string());
}

/// \param field the kind of cells and two numbers: of cells and of all that follow; or from version 5 on of the
/// offsets, which are one more than the cells, and of the corners
void read_cells(Body& body, const HeadField& field, bool has_offsets, Cells kind, PolyData& data) {
    const std::size_t count = count_in(field, 0);
    const std::size_t size = count_in(field, 1);
    if (has_offsets) {
        const std::vector<double> offsets = body.numbers(count, type_in(body.next("offsets"), 0));
        const std::vector<double> corners = body.numbers(size, type_in(body.next("connectivity"), 0));
        add_cells(kind, corners, std::span(offsets).subspan(std::min<std::size_t>(1, count)), 0, data);
        return;
    }
    const std::vector<double> all = body.numbers(size, NumberType::kI4);
    std::vector<double> corners;
    std::vector<double> ends;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::size_t left = all.size() - i - 1;
        if (!(all[i] >= 0.0 && all[i] <= static_cast<double>(left))) {
            field.fail("a cell of these should have " + std::to_string(static_cast<std::int64_t>(all[i])) +
                       " corners, but " + std::to_string(left) + " numbers follow");
        }
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i) + 1;
        corners.insert(corners.end(), begin, begin + static_cast<std::ptrdiff_t>(all[i]));
        ends.push_back(static_cast<double>(corners.size()));
        i += static_cast<std::size_t>(all[i]);
    }
    if (ends.size() != count) {
        field.fail("its numbers are " + std::to_string(ends.size()) + " cells, not " + std::to_string(count));
    }
    add_cells(kind, corners, ends, 0, data);
}

PolyData read_legacy(std::string_view content) {
    Body body(content);
    const bool has_offsets = content.substr(0, 64).find("Version 5") != std::string_view::npos;
    PolyData data;
    while (const std::optional<HeadField> field = body.next()) {
        if (field->name == "points") {
            data.mesh.vertices = points_of(body.numbers(3 * count_in(*field, 0), type_in(*field, 1)));
        } else if (field->name == "polygons") {
            read_cells(body, *field, has_offsets, Cells::kPolygons, data);
        } else if (field->name == "triangle_strips") {
            read_cells(body, *field, has_offsets, Cells::kStrips, data);
        } else if (field->name == "vertices") {
            read_cells(body, *field, has_offsets, Cells::kVertices, data);
        } else if (field->name == "lines") {
            read_cells(body, *field, has_offsets, Cells::kLines, data);
        } else if (field->name == "metadata") {
            body.skip_metadata();
        } else if (field->name == "field") {
            body.skip_fields(*field);
        } else if (field->name == "point_data" || field->name == "cell_data") {
            break;  // values, which follow the surface
        } else {
            field->fail(io::quoted(field->name) + " is no keyword of POLYDATA");
        }
    }
    return data;
}

PolyData read_polydata(std::string_view content) {
    return content.starts_with("# vtk") ? read_legacy(content) : read_xml(content);
}

}  // namespace
}  // namespace vtk_surface

bool is_vtk_surface(std::string_view content) {
    return is_vtk_document(content, "PolyData") || is_vtk_legacy(content, "polydata");
}

FileKind vtk_surface_kind(std::string_view content) {
    const vtk_surface::PolyData data = vtk_surface::read_polydata(content);
    return data.mesh.polygons.empty() && data.lines == 0 ? FileKind::kPoints : FileKind::kMesh;
}

PolygonObjects read_vtk_surface(std::string_view content, const std::filesystem::path&) {
    vtk_surface::PolyData data = vtk_surface::read_polydata(content);
    PolygonObjects result;
    if (data.vertices + data.lines > 0) {
        result.warnings.push_back({"mesh.no_faces", std::to_string(data.vertices) + " points and " +
                                                        std::to_string(data.lines) +
                                                        " lines are left out, which bound no solid"});
    }
    result.objects.push_back({{}, std::move(data.mesh)});
    return result;
}

PointCloud read_vtk_surface_points(std::string_view content) {
    vtk_surface::PolyData data = vtk_surface::read_polydata(content);
    return {std::move(data.mesh.vertices), std::move(data.normals)};
}

bool is_vtk(std::string_view content) { return is_vtk_image(content) || is_vtk_legacy(content, "polydata"); }

FileKind vtk_kind(std::string_view content) {
    return is_vtk_surface(content) ? vtk_surface_kind(content) : FileKind::kImage;
}

}  // namespace scaleaxis::io
