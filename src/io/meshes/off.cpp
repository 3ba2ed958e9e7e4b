// SPDX-License-Identifier: Apache-2.0
/// \file
/// Own code, for CGAL 5.5 reads a coordinate `3.1x5` as 3.1 and a corner `2.9` as 2, and takes as much memory as the
/// counts in the file claim.

#include <cstddef>
#include <string_view>
#include <vector>

#include "io/formats.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/cloud.hpp"

namespace scaleaxis::io {
namespace {

/// Goes behind the keyword at the beginning: `OFF`, after letters for colours, normals, texture. The first count may
/// follow without a blank.
/// \returns the keyword; empty if there is none
std::string_view skip_keyword(TextReader& reader) {
    const std::string_view word = reader.any_word();
    for (const std::string_view keyword :
         {"OFF", "COFF", "NOFF", "CNOFF", "NCOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"}) {
        if (word.starts_with(keyword)) {
            reader.put_back(word.size() - keyword.size());
            return word.substr(0, keyword.size());
        }
    }
    reader.put_back(word.size());
    return {};
}

struct OffHead {
    std::string_view keyword;
    std::size_t vertices = 0;
    std::size_t faces = 0;
};

/// Reads up to the first vertex.
OffHead read_off_head(TextReader& reader) {
    OffHead head;
    head.keyword = skip_keyword(reader);
    if (const std::string_view word = reader.any_word(); word == "BINARY") {
        reader.fail("binary OFF cannot be read; convert it to text, or to PLY", "file.unsupported");
    } else {
        reader.put_back(word.size());
    }
    head.vertices = reader.any_count("vertices", std::string_view("0 0 0 ").size());
    head.faces = reader.any_count("faces", std::string_view("0 ").size());
    reader.next_line();  // the number of edges
    return head;
}

}  // namespace

bool is_off(std::string_view content) {
    TextReader reader(content);
    return !skip_keyword(reader).empty();
}

FileKind off_kind(std::string_view content) {
    TextReader reader(content);
    const OffHead head = read_off_head(reader);
    return head.vertices > 0 && head.faces == 0 ? FileKind::kPoints : FileKind::kMesh;
}

PointCloud read_off_points(std::string_view content) {
    TextReader reader(content);
    const OffHead head = read_off_head(reader);
    const bool has_normals = head.keyword.find('N') != std::string_view::npos;
    PointCloud cloud;
    for (std::size_t v = 0; v < head.vertices; ++v) {
        cloud.points.push_back(reader.any_point());
        if (has_normals) {
            cloud.normals.push_back(reader.any_point());
        }
        reader.next_line();
    }
    return cloud;
}

PolygonMesh read_off_mesh(std::string_view content) {
    TextReader reader(content);
    const OffHead head = read_off_head(reader);

    // What follows on the line of a vertex or face: colours and the like.
    PolygonMesh mesh;
    mesh.vertices.reserve(head.vertices);
    for (std::size_t v = 0; v < head.vertices; ++v) {
        mesh.vertices.push_back(reader.any_point());
        reader.next_line();
    }
    std::vector<Index> corners;
    for (std::size_t f = 0; f < head.faces; ++f) {
        corners.resize(reader.any_count("corners of a face", std::string_view("0 ").size()));
        for (Index& corner : corners) {
            corner = reader.any_index();
        }
        mesh.polygons.push_back(corners);
        reader.next_line();
    }
    return mesh;
}

}  // namespace scaleaxis::io
