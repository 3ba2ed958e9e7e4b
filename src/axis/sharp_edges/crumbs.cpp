// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/crumbs.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/remainder.hpp"
#include "axis/sharp_edges/border.hpp"
#include "axis/sharp_edges/creases.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/sharp_edges.hpp"

namespace scaleaxis {
namespace {

// Collapses the faces of some sheets, from some free edges on, and then the edges that they leave behind.
void collapse_sheets(const MedialComplex& complex, const std::vector<std::uint8_t>& is_chosen, std::vector<Index> edges,
                     Remainder& remainder) {
    const std::vector<Cofaces> faces_before = remainder.faces_at_edge;
    while (!edges.empty()) {
        const Index edge = edges.back();
        edges.pop_back();
        if (remainder.has_edge[edge] == 0) {
            continue;
        }
        const auto& [p, q] = complex.edges[edge];
        if (const Index face = remainder.only_face(edge); face != kNone && is_chosen[complex.face_sheets[face]] != 0) {
            remainder.remove_face(complex, face);
            edges.insert(edges.end(), complex.face_edges[face].begin(), complex.face_edges[face].end());
        } else if (remainder.faces_at_edge[edge].count == 0 && faces_before[edge].count > 0 &&
                   (remainder.edges_at_vertex[p].count == 1 || remainder.edges_at_vertex[q].count == 1)) {
            remainder.has_vertex[remainder.edges_at_vertex[p].count == 1 ? p : q] = 0;
        } else {
            continue;
        }
        remainder.remove_edge(complex, edge);
        for (const Index v : {p, q}) {
            if (remainder.edges_at_vertex[v].count == 1) {
                edges.push_back(remainder.edges_at_vertex[v].combined);
            }
        }
    }
}

// Crumbs are small sheets beside large ones. Where all are small, the solid is.
std::vector<std::uint8_t> find_crumbs(const MedialComplex& complex, double size) {
    const std::vector<std::uint8_t> is_small = small_sheets(complex, size);
    std::vector<std::uint8_t> is_in_large(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index v : complex.faces[f]) {
            if (is_small[complex.face_sheets[f]] == 0) {
                is_in_large[v] = 1;
            }
        }
    }
    std::vector<std::uint8_t> result(is_small.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const Index sheet = complex.face_sheets[f];
        if (is_small[sheet] != 0 &&
            std::ranges::any_of(complex.faces[f], [&](Index v) { return is_in_large[v] != 0; })) {
            result[sheet] = 1;
        }
    }
    return result;
}

}  // namespace

MedialComplex without_crumbs(MedialComplex complex, const Solid& solid, const SharpEdgeOptions& options, double size) {
    std::vector<std::uint8_t> is_crumb = find_crumbs(complex, size);
    Remainder remainder(complex);
    std::vector<Index> edges;
    std::vector<Point> points;
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        const Index face = remainder.only_face(e);
        if (face != kNone && is_crumb[complex.face_sheets[face]] != 0) {
            edges.push_back(e);
            append(points, {complex.vertices[complex.edges[e][0]], complex.vertices[complex.edges[e][1]]});
        }
    }
    if (edges.empty()) {
        return complex;
    }
    const std::vector<std::optional<Crease>> creases = creases_near(solid, points, options, false);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (!creases[2 * i] || !creases[2 * i + 1]) {
            is_crumb[complex.face_sheets[remainder.only_face(edges[i])]] = 0;
        }
    }
    collapse_sheets(complex, is_crumb, std::move(edges), remainder);
    MedialComplex result = complex_of(remainder, complex);
    label_sheets(result);
    return result;
}

}  // namespace scaleaxis
