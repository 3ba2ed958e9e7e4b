// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

using Edge = std::array<Index, 2>;

/// The edges that cut the polygons into fans and are no edges of the complex, each once.
std::vector<Edge> new_diagonals(const MedialComplex& complex) {
    std::vector<Edge> diagonals;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        for (std::size_t k = 2; k + 1 < corners.size(); ++k) {
            diagonals.push_back({std::min(corners[0], corners[k]), std::max(corners[0], corners[k])});
        }
    }
    std::ranges::sort(diagonals);
    const auto repeated = std::ranges::unique(diagonals);
    diagonals.erase(repeated.begin(), repeated.end());
    std::vector<Edge> edges = complex.edges;
    std::ranges::sort(edges);
    std::vector<Edge> result;
    std::ranges::set_difference(diagonals, edges, std::back_inserter(result));
    return result;
}

}  // namespace

void write_ma_axis(OutputFile& out, const MedialComplex& complex) {
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
