// SPDX-License-Identifier: Apache-2.0
/// \file
/// Own code, for CGAL 5.5 reads an absent coordinate as 0, crashes on an integer one, refuses NaN in normals, takes as
/// much memory as the length of a list claims, and has no public function for edges and the properties of faces.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "io/formats.hpp"
#include "io/ply_elements.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/cloud.hpp"

namespace scaleaxis::io {
namespace {

std::vector<Point> points(const PlyElement& element) { return vectors(element, "x", "y", "z"); }

/// The corners of the items, for which there are two names.
const PlyProperty& corner_lists(const PlyElement& element) {
    const PlyProperty* corners = find_list(element, "vertex_indices");
    if (corners == nullptr) {
        corners = find_list(element, "vertex_index");
    }
    if (corners == nullptr) {
        throw damaged("the element " + quoted(element.name) + " has no list 'vertex_indices'");
    }
    return *corners;
}

IndexLists polygons(const PlyElement& element) {
    const PlyProperty& corners = corner_lists(element);
    return {{corners.offsets.begin(), corners.offsets.end()}, to_indices(corners.values)};
}

/// Adds the triangles of strips; -1 ends a strip within a list.
void add_strips(const PlyElement& element, IndexLists& triangles) {
    constexpr double kEnd = -1.0;
    const PlyProperty& corners = corner_lists(element);
    const std::vector<Index> indices = to_indices(corners.values);
    const std::span<const Index> all(indices);
    for (std::size_t s = 0; s < element.count; ++s) {
        std::size_t begin = corners.offsets[s];
        for (std::size_t i = begin; i <= corners.offsets[s + 1]; ++i) {
            if (i == corners.offsets[s + 1] || corners.values[i] == kEnd) {
                add_strip(all.subspan(begin, i - begin), triangles);
                begin = i + 1;
            }
        }
    }
}

/// Any whole numbers, unlike indices.
std::vector<Index> labels_of(const std::vector<double>& values) {
    std::vector<Index> labels;
    for (const double value : values) {
        if (!(value >= std::numeric_limits<Index>::min() && value <= std::numeric_limits<Index>::max())) {
            throw damaged("a label is no whole number of 32 bits");
        }
        labels.push_back(static_cast<Index>(value));
    }
    return labels;
}

/// Does `triangle` go on with the fan of triangles that `polygon` is the outline of?
bool continues(std::span<const Index> polygon, std::span<const Index> triangle) {
    return triangle[0] == polygon[0] && triangle[1] == polygon.back() &&
           std::ranges::find(polygon, triangle[2]) == polygon.end();
}

/// The faces and their properties. Triangles of one `polygon`, one fan after the other, are put together; a triangle
/// (a, b, b) is an edge without faces.
void read_faces(const PlyElement& element, MedialComplex& complex, StoredScales& scales) {
    const IndexLists lists = polygons(element);
    const PlyProperty* polygon_of = find_number(element, "polygon");
    const PlyProperty* scale = find_number(element, kVanishingScale);
    std::vector<std::size_t> firsts;  // of each face, the first list that it consists of
    std::vector<Index> face;
    const auto end_face = [&] {
        if (!face.empty()) {
            complex.faces.push_back(face);
            face.clear();
        }
    };
    for (std::size_t i = 0; i < lists.size(); ++i) {
        const std::span<const Index> list = lists[i];
        if (list.size() == 3 && list[1] == list[2]) {
            complex.edges.push_back({list[0], list[1]});
            if (scale != nullptr) {
                scales.edges.push_back(scale->values[i]);
            }
            continue;
        }
        const bool is_part = polygon_of != nullptr && !face.empty() && list.size() == 3 &&
                             polygon_of->values[i] == polygon_of->values[firsts.back()];
        if (is_part && continues(face, list)) {
            face.push_back(list[2]);
            continue;
        }
        end_face();
        face.assign(list.begin(), list.end());
        firsts.push_back(i);
    }
    end_face();

    const auto of_faces = [&](const std::vector<double>& values) {
        const auto result = each_of<double>(firsts, [&](std::size_t i) { return values[i]; });
        return result;
    };
    if (const PlyProperty* sheet = find_number(element, "sheet")) {
        complex.face_sheets = to_indices(of_faces(sheet->values));
    }
    if (const PlyProperty* angle = find_number(element, "angle")) {
        complex.face_angles = of_faces(angle->values);
    }
    if (scale != nullptr) {
        scales.faces = of_faces(scale->values);
    }
}

/// The numbers of one item after the other: bytes, or lines of text.
class ItemWriter {
   public:
    ItemWriter(OutputFile& out, bool is_text) : out_(out), is_text_(is_text) {}

    template <class... Numbers>
    void add(Numbers... numbers) {
        if (is_text_) {
            (add_word(numbers), ...);
        } else {
            out_.binary(numbers...);
        }
    }
    void end() {
        if (is_text_) {
            out_.text('\n');
        }
        is_first_ = true;
    }

   private:
    template <class Number>
    void add_word(Number number) {
        if (!std::exchange(is_first_, false)) {
            out_.text(' ');
        }
        out_.text(number);
    }

    OutputFile& out_;
    bool is_text_;
    bool is_first_ = true;
};

void write_header(OutputFile& out, bool is_text = false) {
    out.text("ply\nformat ", is_text ? "ascii" : "binary_little_endian", " 1.0\ncomment made by scaleaxis\n");
}

void write_ball_properties(OutputFile& out, std::size_t count) {
    out.text("element vertex ", count,
             "\nproperty double x\nproperty double y\nproperty double z\nproperty double radius\n");
}

const char* label_property(const MedialComplex& complex) {
    return complex.vertex_labels.empty() ? "" : "property int label\n";
}

/// Comments that have the scale up to which a filtration knows its levels, and by which the balls had been grown.
constexpr std::string_view kLargestScale = "\ncomment largest_scale ";
constexpr std::string_view kScale = "\ncomment scale ";

/// Up to the properties of faces.
void begin_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options, bool is_text) {
    write_header(out, is_text);
    if (complex.scale != 1.0) {
        out.text(kScale.substr(1), complex.scale, '\n');
    }
    if (options.largest_scale) {
        out.text(kLargestScale.substr(1), *options.largest_scale, '\n');
    }
    write_ball_properties(out, complex.vertices.size());
    for (const VertexValues& attribute : options.vertex_values) {
        out.text("property double ", attribute.name, '\n');
    }
    out.text("property int ball\n", label_property(complex));
}

std::optional<double> scale_in_comment(std::string_view content, std::string_view comment) {
    const std::string_view head = content.substr(0, content.find("\nend_header"));
    const std::size_t at = head.find(comment);
    if (at == std::string_view::npos) {
        return std::nullopt;
    }
    const std::optional<double> scale = parse_number(TextReader(head.substr(at + comment.size())).word());
    return scale && *scale >= 1.0 && std::isfinite(*scale) ? scale : std::nullopt;
}

std::string scale_property(const AxisFileOptions& options) {
    return !options.edge_scales.empty() || !options.face_scales.empty()
               ? "property double " + std::string(kVanishingScale) + '\n'
               : std::string();
}

void add_scale(ItemWriter& items, const std::vector<double>& scales, Index item) {
    if (!scales.empty()) {
        items.add(finite_or_minus_one(scales[item]));
    }
}

/// The label of an item, if there are labels, and its end.
void end_item(ItemWriter& items, const MedialComplex& complex, Index vertex) {
    if (!complex.vertex_labels.empty()) {
        items.add(complex.vertex_labels[vertex]);
    }
    items.end();
}

void write_vertices(ItemWriter& items, const MedialComplex& complex, const AxisFileOptions& options) {
    for (Index v = 0; v < static_cast<Index>(complex.vertices.size()); ++v) {
        const Point& p = complex.vertices[v];
        items.add(p.x, p.y, p.z, complex.radii[v]);
        for (const VertexValues& attribute : options.vertex_values) {
            items.add(finite_or_minus_one(attribute.values[v]));
        }
        items.add(stored_number(complex.vertex_origins[v]));
        end_item(items, complex, v);
    }
}

/// Polygons and edges, in binary.
void write_polygons(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options) {
    std::size_t most_corners = 0;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        most_corners = std::max(most_corners, complex.faces[f].size());
    }
    // Some programs read no other type of length than the usual one.
    const bool is_small = most_corners <= std::numeric_limits<std::uint8_t>::max();

    begin_axis(out, complex, options, false);
    out.text("element face ", complex.faces.size(), "\nproperty list ", is_small ? "uchar" : "int",
             " int vertex_indices\nproperty int sheet\nproperty double angle\n", scale_property(options),
             label_property(complex));
    out.text("element edge ", complex.edges.size(), "\nproperty int vertex1\nproperty int vertex2\n",
             scale_property(options), label_property(complex), "end_header\n");

    ItemWriter items(out, false);
    write_vertices(items, complex, options);
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        if (is_small) {
            items.add(static_cast<std::uint8_t>(corners.size()));
        } else {
            items.add(static_cast<Index>(corners.size()));
        }
        for (const Index v : corners) {
            items.add(v);
        }
        items.add(complex.face_sheets[f], complex.face_angles[f]);
        add_scale(items, options.face_scales, static_cast<Index>(f));
        end_item(items, complex, corners.front());
    }
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        const auto& [a, b] = complex.edges[e];
        items.add(a, b);
        add_scale(items, options.edge_scales, e);
        end_item(items, complex, a);
    }
}

/// Vertices and triangles alone, as text: all else makes some program fail or forget what it has read
/// (docs/formats.md). Each triangle says which polygon it is of. An edge without faces is a triangle (a, b, b), of no
/// sheet and polygon.
void write_triangles(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options) {
    const std::vector<Index> edges = listed_edges(complex, options);
    const std::size_t triangle_count = complex.faces.items.size() - 2 * complex.faces.size();
    begin_axis(out, complex, options, true);
    out.text("element face ", triangle_count + edges.size(),
             "\nproperty list uchar int vertex_indices\nproperty int sheet\nproperty double angle\n"
             "property int polygon\n",
             scale_property(options), label_property(complex), "end_header\n");

    ItemWriter items(out, true);
    write_vertices(items, complex, options);
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        for (std::size_t k = 2; k < corners.size(); ++k) {
            items.add(3, corners[0], corners[k - 1], corners[k], complex.face_sheets[f], complex.face_angles[f], f);
            add_scale(items, options.face_scales, f);
            end_item(items, complex, corners[0]);
        }
    }
    for (const Index e : edges) {
        const auto& [a, b] = complex.edges[e];
        items.add(3, a, b, b, kNone, 0.0, kNone);
        add_scale(items, options.edge_scales, e);
        end_item(items, complex, a);
    }
}

}  // namespace

bool is_ply(std::string_view content) {
    TextReader reader(content);
    return reader.word() == "ply" && reader.word().empty();
}

FileKind ply_kind(std::string_view content) {
    const std::vector<PlyElement> elements = read_ply_head(content);
    const PlyElement* vertex = find_element(elements, "vertex");
    if (vertex == nullptr || find_number(*vertex, "radius") == nullptr) {
        const PlyElement* face = find_element(elements, "face");
        const bool has_faces = (face != nullptr && face->count > 0) || find_element(elements, "tristrips") != nullptr;
        return vertex == nullptr || has_faces ? FileKind::kMesh : FileKind::kPoints;
    }
    const bool has_cells = find_element(elements, "edge") != nullptr || find_element(elements, "face") != nullptr;
    return has_cells ? FileKind::kAxis : FileKind::kBalls;
}

PolygonMesh read_ply_mesh(std::string_view content) {
    const std::vector<PlyElement> elements = read_ply_elements(content);
    PolygonMesh mesh;
    if (const PlyElement* vertex = find_element(elements, "vertex")) {
        mesh.vertices = points(*vertex);
    }
    if (const PlyElement* face = find_element(elements, "face")) {
        mesh.polygons = polygons(*face);
    }
    if (const PlyElement* strips = find_element(elements, "tristrips")) {
        add_strips(*strips, mesh.polygons);
    }
    return mesh;
}

PointCloud read_ply_points(std::string_view content) {
    const std::vector<PlyElement> elements = read_ply_elements(content);
    PointCloud cloud;
    if (const PlyElement* vertex = find_element(elements, "vertex")) {
        cloud.points = points(*vertex);
        if (find_number(*vertex, "nx") != nullptr) {
            cloud.normals = vectors(*vertex, "nx", "ny", "nz");
        }
    }
    return cloud;
}

std::vector<Ball> read_ply_balls(std::string_view content) {
    const std::vector<PlyElement> elements = read_ply_elements(content);
    std::vector<Ball> balls;
    if (const PlyElement* vertex = find_element(elements, "vertex")) {
        const std::vector<Point> centers = points(*vertex);
        const std::vector<double>& radii = numbers(*vertex, "radius");
        for (std::size_t i = 0; i < centers.size(); ++i) {
            balls.push_back({centers[i], radii[i]});
        }
    }
    return balls;
}

bool is_ply_filtration(std::string_view content) {
    const std::vector<PlyElement> elements = read_ply_head(content);
    const PlyElement* vertex = find_element(elements, "vertex");
    return vertex != nullptr && find_number(*vertex, kVanishingScale) != nullptr;
}

std::vector<VertexValues> read_ply_values(std::string_view content) {
    static constexpr std::array<std::string_view, 7> kOthers{"x", "y", "z", "red", "green", "blue", "alpha"};
    const std::vector<PlyElement> elements = read_ply_elements(content);
    std::vector<VertexValues> values;
    if (const PlyElement* vertex = find_element(elements, "vertex")) {
        for (const PlyProperty& property : vertex->properties) {
            if (!property.length_type && std::ranges::find(kOthers, property.name) == kOthers.end()) {
                values.push_back({std::string(property.name), property.values});
            }
        }
    }
    return values;
}

std::optional<double> read_ply_scale(std::string_view content) { return scale_in_comment(content, kScale); }

MedialComplex read_ply_axis(std::string_view content) {
    StoredScales unused;
    return read_ply_axis(content, unused);
}

MedialComplex read_ply_axis(std::string_view content, StoredScales& scales) {
    const std::vector<PlyElement> elements = read_ply_elements(content);
    scales.largest = scale_in_comment(content, kLargestScale);
    MedialComplex complex;
    complex.scale = read_ply_scale(content).value_or(1.0);
    if (const PlyElement* vertex = find_element(elements, "vertex")) {
        complex.vertices = points(*vertex);
        complex.radii = numbers(*vertex, "radius");
        if (const PlyProperty* ball = find_number(*vertex, "ball")) {
            const std::vector<Index> balls = to_indices(ball->values);
            for (std::size_t v = 0; v < balls.size(); ++v) {
                const Index number = ball->values[v] == kStoredLinear ? kStoredLinear : balls[v];
                complex.vertex_origins.push_back(origin_of(number, complex.radii[v]));
            }
        }
        if (const PlyProperty* label = find_number(*vertex, "label")) {
            complex.vertex_labels = labels_of(label->values);
        }
        if (const PlyProperty* scale = find_number(*vertex, kVanishingScale)) {
            scales.vertices = scale->values;
        }
        if (const PlyProperty* scale = find_number(*vertex, "ball_scale")) {
            scales.balls = scale->values;
        }
    }
    if (const PlyElement* face = find_element(elements, "face")) {
        read_faces(*face, complex, scales);
    }
    if (const PlyElement* edge = find_element(elements, "edge")) {
        const std::vector<Index> from = to_indices(numbers(*edge, "vertex1"));
        const std::vector<Index> to = to_indices(numbers(*edge, "vertex2"));
        for (std::size_t e = 0; e < edge->count; ++e) {
            complex.edges.push_back({from[e], to[e]});
        }
        if (const PlyProperty* scale = find_number(*edge, kVanishingScale)) {
            append(scales.edges, scale->values);
        }
    }
    return complex;
}

void write_ply_balls(OutputFile& out, std::span<const Ball> balls) {
    write_header(out);
    write_ball_properties(out, balls.size());
    out.text("end_header\n");
    for (const Ball& ball : balls) {
        out.binary(ball.center.x, ball.center.y, ball.center.z, ball.radius);
    }
}

void write_ply_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options) {
    if (options.has_polygons) {
        write_polygons(out, complex, options);
    } else {
        write_triangles(out, complex, options);
    }
}

}  // namespace scaleaxis::io
