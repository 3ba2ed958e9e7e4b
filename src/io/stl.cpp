// SPDX-License-Identifier: Apache-2.0
/// \file
/// Own code, for CGAL 5.5 passes over facets whose keywords it does not know, reads a coordinate `3.1x5` as 3.1, and
/// puts a corner with a NaN where another corner is.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/faults.hpp"
#include "io/formats.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/cloud.hpp"
#include "spatial/weld.hpp"

namespace scaleaxis::io {
namespace {

// Binary: a comment, the number of facets; for each facet the normal, three corners and two bytes for anything.
constexpr std::size_t kCommentSize = 80;
constexpr std::size_t kHeaderSize = kCommentSize + sizeof(std::uint32_t);
constexpr std::size_t kNormalSize = 3 * sizeof(float);
constexpr std::size_t kFacetSize = 4 * kNormalSize + sizeof(std::uint16_t);

std::size_t facet_count(std::string_view content) {
    return from_bytes<std::uint32_t>(content.data() + kCommentSize, std::endian::little);
}

/// Has the file the size that its number of facets demands? The comment of a binary file may well begin with `solid`.
bool is_exact_binary(std::string_view content) {
    return content.size() >= kHeaderSize && content.size() == kHeaderSize + kFacetSize * facet_count(content);
}

bool is_ascii(std::string_view content) {
    constexpr std::size_t kLookAhead = 1024;
    const std::string_view beginning = content.substr(0, kLookAhead);
    return to_lower(TextReader(beginning).any_word()) == "solid" && beginning.find('\0') == beginning.npos;
}

/// Three corners after each other for each facet.
std::vector<Point> read_stl_binary(std::string_view content) {
    if (content.size() < kHeaderSize) {
        throw truncated("the file is too short for a binary STL file, and no ascii one");
    }
    const std::size_t count = facet_count(content);
    const std::size_t present = (content.size() - kHeaderSize) / kFacetSize;
    if (count > present) {
        throw truncated("the file ends after " + std::to_string(present) + " of " + std::to_string(count) +
                        " facets: it is truncated, or no STL file");
    }
    std::vector<Point> corners;
    corners.reserve(3 * count);
    for (std::size_t f = 0; f < count; ++f) {
        const char* facet = content.data() + kHeaderSize + f * kFacetSize + kNormalSize;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto coordinate = [&](std::size_t i) {
                return from_bytes<float>(facet + (3 * k + i) * sizeof(float), std::endian::little);
            };
            corners.push_back({coordinate(0), coordinate(1), coordinate(2)});
        }
    }
    return corners;
}

/// The same from text, of which every word is checked but names and normals.
std::vector<Point> read_stl_ascii(std::string_view content) {
    std::vector<Point> corners;
    TextReader reader(content);
    const auto expect = [&](std::string_view keyword) { reader.expect(keyword, '`' + std::string(keyword) + '`'); };
    do {
        expect("solid");
        reader.next_line();  // a name
        while (!reader.is_next("endsolid")) {
            expect("facet");
            reader.next_line();  // a normal
            expect("outer");
            expect("loop");
            for (int k = 0; k < 3; ++k) {
                expect("vertex");
                corners.push_back(reader.point());
            }
            expect("endloop");
            expect("endfacet");
        }
        reader.next_line();  // a name
    } while (!reader.is_next(""));
    return corners;
}

std::vector<Point> read_corners(std::string_view content) {
    const bool is_text = !is_exact_binary(content) && is_ascii(content);
    return is_text ? read_stl_ascii(content) : read_stl_binary(content);
}

}  // namespace

bool is_stl(std::string_view content) { return is_exact_binary(content) || is_ascii(content); }

PolygonMesh read_stl_mesh(std::string_view content) {
    PolygonMesh mesh{read_corners(content), {}};
    const std::vector<Index> corners = weld(mesh.vertices);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        mesh.polygons.push_back(std::span(corners).subspan(i, 3));
    }
    return mesh;
}

/// Its normals are those of facets, not of points.
PointCloud read_stl_points(std::string_view content) {
    PointCloud cloud{read_corners(content), {}};
    weld(cloud.points);
    return cloud;
}

}  // namespace scaleaxis::io
