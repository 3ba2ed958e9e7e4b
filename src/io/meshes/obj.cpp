// SPDX-License-Identifier: Apache-2.0
/// \file
/// Own code, for CGAL 5.5 reads a corner `4.5` as 4, drops the rest of a face behind a corner that it cannot read, and
/// refuses tabs in faces, joined lines, hexadecimal numbers and lines `l`; tinyobjloader reads absent coordinates as 0.

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/remainder.hpp"
#include "io/formats.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/cloud.hpp"

namespace scaleaxis::io {
namespace {

Index read_index(const TextReader& reader, std::string_view word, std::string_view text, std::size_t count) {
    const auto number = parse_integer(text);
    if (!number || *number == 0) {
        reader.fail(quoted(word) + " is not a corner of a face; indices begin with 1");
    }
    return to_index(*number > 0 ? *number - 1 : static_cast<std::int64_t>(count) + *number);
}

/// Reads the corner `17`, `17/3`, `17//5` or `17/3/5` of a face; negative indices count back from the latest vertex.
Index read_corner(const TextReader& reader, std::string_view word, std::size_t vertex_count) {
    return read_index(reader, word, word.substr(0, word.find('/')), vertex_count);
}

/// The normal of such a corner; `kNone` if it has none.
Index read_normal(const TextReader& reader, std::string_view word, std::size_t normal_count) {
    const std::size_t slash = word.rfind('/');
    const bool has_normal = slash != word.npos && word.find('/') != slash;
    return has_normal ? read_index(reader, word, word.substr(slash + 1), normal_count) : kNone;
}

bool is_identifier(std::string_view word) {
    return std::ranges::all_of(word,
                               [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }) &&
           std::isalpha(static_cast<unsigned char>(word.front())) != 0;
}

bool is_keyword_of_face(std::string_view keyword) { return keyword == "f" || keyword == "fo"; }

struct ObjMesh {
    PolygonMesh mesh;
    std::vector<Point> normals;
    std::vector<std::array<Index, 2>> corners;  ///< of faces that have normals: vertex and normal
};

/// \param has_normals otherwise they are passed over, whatever they are
ObjMesh read_obj(std::string_view content, bool has_normals) {
    ObjMesh obj;
    std::vector<Point>& vertices = obj.mesh.vertices;
    const auto exists = [](Index i, const std::vector<Point>& list) {
        return i != kNone && static_cast<std::size_t>(i) < list.size();
    };
    std::vector<Index> polygon;
    TextReader reader(content, true);
    for (std::string_view keyword = reader.any_word(); !keyword.empty(); keyword = reader.any_word()) {
        if (keyword == "v") {
            vertices.push_back(reader.point());
        } else if (has_normals && keyword == "vn") {
            obj.normals.push_back(reader.point());
        } else if (is_keyword_of_face(keyword)) {
            polygon.clear();
            for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
                polygon.push_back(read_corner(reader, word, vertices.size()));
                const Index normal = has_normals ? read_normal(reader, word, obj.normals.size()) : kNone;
                if (exists(polygon.back(), vertices) && exists(normal, obj.normals)) {
                    obj.corners.push_back({polygon.back(), normal});
                }
            }
            obj.mesh.polygons.push_back(polygon);
        } else if (!is_identifier(keyword)) {
            reader.fail("a line of an OBJ file cannot begin with " + quoted(keyword));
        }
        reader.next_line();
    }
    if (vertices.empty()) {
        reader.fail("the file ends without a vertex (`v x y z`); is it an OBJ file?");
    }
    return obj;
}

}  // namespace

bool is_obj(std::string_view content) {
    constexpr std::array<std::string_view, 10> kFirstKeywords{"v", "vt",     "vn",     "o", "g",
                                                              "s", "mtllib", "usemtl", "f", "l"};
    return std::ranges::find(kFirstKeywords, TextReader(content, true).any_word()) != kFirstKeywords.end();
}

FileKind obj_kind(std::string_view content) {
    TextReader reader(content, true);
    bool has_vertices = false;
    for (std::string_view keyword = reader.any_word(); !keyword.empty(); keyword = reader.any_word()) {
        if (is_keyword_of_face(keyword) || keyword == "l") {
            return FileKind::kMesh;
        }
        has_vertices = has_vertices || keyword == "v";
        reader.next_line();
    }
    return has_vertices ? FileKind::kPoints : FileKind::kMesh;
}

/// With the normals that faces give to all vertices, or of which there are as many.
PointCloud read_obj_points(std::string_view content) {
    const ObjMesh obj = read_obj(content, true);
    PointCloud cloud{obj.mesh.vertices, {}};
    if (obj.corners.empty()) {
        cloud.normals = obj.normals.size() == cloud.points.size() ? obj.normals : std::vector<Point>();
        return cloud;
    }
    cloud.normals.resize(cloud.points.size());
    std::vector<char> has_normal(cloud.points.size());
    for (const auto& [vertex, normal] : obj.corners) {
        cloud.normals[vertex] = cloud.normals[vertex] + obj.normals[normal];
        has_normal[vertex] = 1;
    }
    if (std::ranges::find(has_normal, 0) != has_normal.end()) {
        cloud.normals.clear();
    }
    return cloud;
}

PolygonMesh read_obj_mesh(std::string_view content) { return read_obj(content, false).mesh; }

/// The radius of a vertex is a comment after it, `#r 0.5`, which every reader skips. Each curve and each sheet is a
/// group.
void write_obj_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions&) {
    out.text("# medial axis made by scaleaxis; #r is the radius of the vertex before it\n");
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        const Point& p = complex.vertices[v];
        out.text("v ", p.x, ' ', p.y, ' ', p.z, "\n#r ", complex.radii[v], '\n');
    }
    const IndexLists curves = find_curves(complex, Remainder(complex));
    for (std::size_t c = 0; c < curves.size(); ++c) {
        out.text("g curve_", c, '\n');
        for (const Index e : curves[c]) {
            out.text("l ", complex.edges[e][0] + 1, ' ', complex.edges[e][1] + 1, '\n');
        }
    }
    const IndexLists sheets = faces_of_sheets(complex);
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        if (!sheets[s].empty()) {
            out.text("g sheet_", s, '\n');
        }
        for (const Index f : sheets[s]) {
            out.text('f');
            for (const Index v : complex.faces[f]) {
                out.text(' ', v + 1);
            }
            out.text('\n');
        }
    }
}

}  // namespace scaleaxis::io
