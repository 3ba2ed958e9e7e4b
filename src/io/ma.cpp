// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "base/vectors.hpp"
#include "io/formats.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

using Edge = std::array<Index, 2>;
using Triangle = std::array<Index, 3>;

/// The edges that cut the polygons into fans and are no edges of the complex, each once.
std::vector<Edge> new_diagonals(const MedialComplex& complex) {
    std::vector<Edge> diagonals;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        for (std::size_t k = 2; k + 1 < corners.size(); ++k) {
            diagonals.push_back({std::min(corners[0], corners[k]), std::max(corners[0], corners[k])});
        }
    }
    sort_unique(diagonals);
    std::vector<Edge> edges = complex.edges;
    std::ranges::sort(edges);
    std::vector<Edge> result;
    std::ranges::set_difference(diagonals, edges, std::back_inserter(result));
    return result;
}

}  // namespace

/// Is the first line three counts, and the next one a vertex, if there is one?
bool is_ma(std::string_view content) {
    TextReader reader(content);
    for (std::string_view word : {reader.any_word(), reader.word(), reader.word()}) {
        if (!parse_integer(word)) {
            return false;
        }
    }
    const std::string_view next = reader.any_word();
    return next == "v" || next.empty();
}

MedialComplex read_ma_axis(std::string_view content) {
    TextReader reader(content);
    const auto end_line = [&] {
        if (const std::string_view word = reader.word(); !word.empty()) {
            reader.fail(quoted(word) + " stands where the line should end");
        }
    };
    const auto expect = [&](std::string_view keyword) {
        end_line();
        reader.expect(keyword, "a line `" + std::string(keyword) + "`");
    };

    const std::size_t vertex_count = reader.any_count("vertices", std::string_view("v 0 0 0 0 ").size());
    const std::size_t edge_count = reader.any_count("edges", std::string_view("e 0 0 ").size());
    const std::size_t face_count = reader.any_count("faces", std::string_view("f 0 0 0 ").size());
    MedialComplex complex;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        expect("v");
        complex.vertices.push_back(reader.point());
        complex.radii.push_back(reader.number());
    }
    for (std::size_t e = 0; e < edge_count; ++e) {
        expect("e");
        const Index from = reader.any_index();
        complex.edges.push_back({from, reader.any_index()});
    }
    for (std::size_t f = 0; f < face_count; ++f) {
        expect("f");
        const Index a = reader.any_index();
        const Index b = reader.any_index();
        complex.faces.push_back(Triangle{a, b, reader.any_index()});
    }
    end_line();
    if (const std::string_view word = reader.any_word(); !word.empty()) {
        reader.fail(quoted(word) + " stands where the file should end: the counts in its first line are wrong");
    }
    return complex;
}

void write_ma_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions&) {
    const std::vector<Edge> diagonals = new_diagonals(complex);
    const std::size_t triangle_count = complex.faces.items.size() - 2 * complex.faces.size();
    out.text(complex.vertices.size(), ' ', complex.edges.size() + diagonals.size(), ' ', triangle_count, '\n');
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        const Point& p = complex.vertices[v];
        out.text("v ", p.x, ' ', p.y, ' ', p.z, ' ', complex.radii[v], '\n');
    }
    for (const std::vector<Edge>* edges : {&complex.edges, &diagonals}) {
        for (const auto& [a, b] : *edges) {
            out.text("e ", a, ' ', b, '\n');
        }
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
            out.text("f ", corners[0], ' ', corners[k], ' ', corners[k + 1], '\n');
        }
    }
}

}  // namespace scaleaxis::io
