// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/complex_parts.hpp"

namespace scaleaxis::io {

std::vector<std::array<Index, 2>> curve_edges(const MedialComplex& complex) {
    std::vector<char> has_face(complex.edges.size(), 0);
    for (const Index e : complex.face_edges.items) {
        has_face[e] = 1;
    }
    std::vector<std::array<Index, 2>> result;
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (!has_face[e]) {
            result.push_back(complex.edges[e]);
        }
    }
    return result;
}

std::vector<Index> isolated_vertices(const MedialComplex& complex) {
    std::vector<char> has_edge(complex.vertices.size(), 0);
    for (const auto& [a, b] : complex.edges) {
        has_edge[a] = 1;
        has_edge[b] = 1;
    }
    std::vector<Index> result;
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        if (!has_edge[v]) {
            result.push_back(static_cast<Index>(v));
        }
    }
    return result;
}

}  // namespace scaleaxis::io
