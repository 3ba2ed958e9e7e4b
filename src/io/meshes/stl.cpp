// SPDX-License-Identifier: Apache-2.0
/// \file
/// Own code, for CGAL 5.5 passes over facets whose keywords it does not know, reads a coordinate `3.1x5` as 3.1, and
/// puts a corner with a NaN where another corner is.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
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

/// What a file holds: three corners after each other for each facet, and what was repaired.
struct StlFacets {
    std::vector<Point> corners;
    std::string repair;  ///< empty: nothing
};

Point point_at(const char* from) {
    const auto coordinate = [&](std::size_t i) {
        return from_bytes<float>(from + i * sizeof(float), std::endian::little);
    };
    return {coordinate(0), coordinate(1), coordinate(2)};
}

/// Where `count` facets begin if the two bytes at the end of each say how many follow, as some programs write; none if
/// the file does not end with the last one.
std::vector<std::size_t> facets_with_payload(std::string_view content, std::size_t count) {
    std::vector<std::size_t> begins;
    std::size_t next = kHeaderSize;
    while (begins.size() < count && next + kFacetSize <= content.size()) {
        begins.push_back(next);
        next += kFacetSize;
        next += from_bytes<std::uint16_t>(content.data() + next - sizeof(std::uint16_t), std::endian::little);
    }
    return begins.size() == count && next == content.size() ? begins : std::vector<std::size_t>();
}

std::vector<std::size_t> equal_facets(std::size_t begin, std::size_t count) {
    std::vector<std::size_t> begins(count);
    for (std::size_t f = 0; f < count; ++f) {
        begins[f] = begin + f * kFacetSize;
    }
    return begins;
}

/// Do the normals fit the corners? If the facets begin elsewhere the numbers are those of other things.
bool have_normals(std::string_view content, const std::vector<std::size_t>& begins) {
    constexpr double kLeastCosine = 0.99;  // normals are written with few digits, or in whole degrees
    return std::ranges::all_of(begins, [&](std::size_t begin) {
        const auto at = [&](std::size_t i) { return point_at(content.data() + begin + i * kNormalSize); };
        const Point normal = at(0);
        const Point across = cross(at(2) - at(1), at(3) - at(1));
        return norm(across) == 0.0 || dot(normal, across) > kLeastCosine * norm(normal) * norm(across);
    });
}

/// Where facets begin in a file whose head is wrong: its length tells. \param repair what was made of it
std::vector<std::size_t> facets_by_length(std::string_view content, std::string& repair) {
    const std::size_t count = facet_count(content);
    const std::size_t bytes = content.size() - kHeaderSize;
    const std::size_t present = bytes / kFacetSize;
    const std::string head = "its head says " + std::to_string(count) + (count == 1 ? " facet" : " facets");
    if (std::vector<std::size_t> begins = facets_with_payload(content, count); !begins.empty()) {
        return begins;
    }
    if ((content.size() - kCommentSize) % kFacetSize == 0) {
        std::vector<std::size_t> begins = equal_facets(kCommentSize, (content.size() - kCommentSize) / kFacetSize);
        if (count == 0 || have_normals(content, begins)) {  // otherwise it is cut off there by chance
            repair = "its head lacks the number of facets: all " + std::to_string(begins.size()) + " are read";
            return begins;
        }
    }
    if (count > present) {
        throw truncated("the file ends after " + std::to_string(present) + " of " + std::to_string(count) +
                        " facets: it is truncated, or no STL file");
    }
    if (bytes % kFacetSize == 0) {
        repair = head + ", but there are " + std::to_string(present) + ": all are read";
        return equal_facets(kHeaderSize, present);
    }
    if (count == 0) {
        throw damaged(head + ", but the " + std::to_string(bytes) + " bytes behind it are no facets; export it again");
    }
    repair = head + ": the " + std::to_string(bytes - count * kFacetSize) + " bytes behind them are left out";
    return equal_facets(kHeaderSize, count);
}

StlFacets read_stl_binary(std::string_view content) {
    if (content.size() < kHeaderSize) {
        throw truncated("the file is too short for a binary STL file, and no ascii one");
    }
    StlFacets result;
    const std::vector<std::size_t> begins = is_exact_binary(content) ? equal_facets(kHeaderSize, facet_count(content))
                                                                     : facets_by_length(content, result.repair);
    result.corners.reserve(3 * begins.size());
    for (const std::size_t begin : begins) {
        for (std::size_t k = 1; k <= 3; ++k) {
            result.corners.push_back(point_at(content.data() + begin + k * kNormalSize));
        }
    }
    return result;
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

StlFacets read_facets(std::string_view content) {
    const bool is_text = !is_exact_binary(content) && is_ascii(content);
    return is_text ? StlFacets{read_stl_ascii(content), {}} : read_stl_binary(content);
}

}  // namespace

bool is_stl(std::string_view content) { return is_exact_binary(content) || is_ascii(content); }

PolygonObjects read_stl(std::string_view content, const std::filesystem::path&) {
    StlFacets facets = read_facets(content);
    PolygonObjects result;
    if (!facets.repair.empty()) {
        result.warnings.push_back({"file.repaired", facets.repair});
    }
    PolygonMesh& mesh = result.objects.emplace_back().mesh;
    mesh.vertices = std::move(facets.corners);
    const std::vector<Index> corners = weld(mesh.vertices);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        mesh.polygons.push_back(std::span(corners).subspan(i, 3));
    }
    return result;
}

/// Its normals are those of facets, not of points.
PointCloud read_stl_points(std::string_view content) {
    PointCloud cloud{read_facets(content).corners, {}};
    weld(cloud.points);
    return cloud;
}

}  // namespace scaleaxis::io
