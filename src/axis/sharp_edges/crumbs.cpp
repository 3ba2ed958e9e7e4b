// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/crumbs.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "axis/sharp_edges/border.hpp"
#include "axis/sharp_edges/creases.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/sharp_edges.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Collapses the faces of some sheets, from some free edges on, and then the edges that they leave behind.
void collapse_sheets(const MedialComplex& complex, const std::vector<std::uint8_t>& is_chosen,
                     std::span<const Index> edges, Remainder& remainder) {
    const std::vector<std::uint8_t> has_faces = edges_with_faces(complex);
    Collapses collapses(
        complex, remainder,
        [&](const ElementaryCollapse& collapse) {
            return collapse.has_face ? is_chosen[complex.face_sheets[collapse.element]] != 0
                                     : has_faces[collapse.element] != 0;
        },
        [](const ElementaryCollapse&, bool) {});
    for (const Index e : edges) {
        collapses.add_edge(e);
    }
    collapses.run();
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
    collapse_sheets(complex, is_crumb, edges, remainder);
    MedialComplex result = complex_of(remainder, complex);
    label_sheets(result);
    return result;
}

}  // namespace scaleaxis::inline v1
