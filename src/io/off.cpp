// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Own code, for CGAL 5.5 reads a coordinate `3.1x5` as 3.1 and a corner `2.9` as 2, and takes as much memory as the
/// counts in the file claim.

#include <cstddef>
#include <string_view>
#include <vector>

#include "io/formats.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

/// Goes behind the keyword at the beginning: `OFF`, after letters for colours, normals, texture. The first count may
/// follow without a blank.
bool skip_keyword(TextReader& reader) {
    const std::string_view word = reader.any_word();
    for (const std::string_view keyword :
         {"OFF", "COFF", "NOFF", "CNOFF", "NCOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"}) {
        if (word.starts_with(keyword)) {
            reader.put_back(word.size() - keyword.size());
            return true;
        }
    }
    reader.put_back(word.size());
    return false;
}

}  // namespace

bool is_off(std::string_view content) {
    TextReader reader(content);
    return skip_keyword(reader);
}

PolygonMesh read_off_mesh(std::string_view content) {
    TextReader reader(content);
    skip_keyword(reader);
    if (const std::string_view word = reader.any_word(); word == "BINARY") {
        reader.fail("binary OFF cannot be read; convert it to text, or to PLY");
    } else {
        reader.put_back(word.size());
    }
    const std::size_t vertex_count = reader.any_count("vertices", std::string_view("0 0 0 ").size());
    const std::size_t face_count = reader.any_count("faces", std::string_view("0 ").size());
    reader.next_line();  // the number of edges

    // What follows on the line of a vertex or face: colours and the like.
    PolygonMesh mesh;
    mesh.vertices.reserve(vertex_count);
    for (std::size_t v = 0; v < vertex_count; ++v) {
        const double x = reader.any_number();
        const double y = reader.any_number();
        const double z = reader.any_number();
        mesh.vertices.push_back({x, y, z});
        reader.next_line();
    }
    std::vector<Index> corners;
    for (std::size_t f = 0; f < face_count; ++f) {
        corners.resize(reader.any_count("corners of a face", std::string_view("0 ").size()));
        for (Index& corner : corners) {
            corner = to_index(reader.any_integer());
        }
        mesh.polygons.push_back(corners);
        reader.next_line();
    }
    return mesh;
}

}  // namespace scaleaxis::io
