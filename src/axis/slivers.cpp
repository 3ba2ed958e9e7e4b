// SPDX-License-Identifier: Apache-2.0
#include "axis/slivers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "axis/complex.hpp"

namespace scaleaxis {
namespace {

struct Sliver {
    double area = 0.0;
    Index sheet = kNone;
    double size = 0.0;  // of the longest edge to contract
};

// The smallest first, so that the numbers of sheets do not matter.
std::vector<Sliver> slivers_of(const MedialComplex& complex, double size, double scale) {
    std::vector<double> areas(complex.sheets);
    std::vector<double> perimeters(complex.sheets);
    std::vector<double> least_radii(complex.sheets, std::numeric_limits<double>::infinity());
    const IndexLists faces_of = faces_of_sheets(complex);
    std::vector<std::uint8_t> is_inside(complex.edges.size());
    for (Index sheet = 0; sheet < complex.sheets; ++sheet) {
        for (const Index f : faces_of[sheet]) {
            areas[sheet] += face_area(complex, f);
            for (const Index v : complex.faces[f]) {
                least_radii[sheet] = std::min(least_radii[sheet], complex.radii[v]);
            }
            for (const Index e : complex.face_edges[f]) {
                const double length =
                    distance(complex.vertices[complex.edges[e][0]], complex.vertices[complex.edges[e][1]]);
                perimeters[sheet] += is_inside[e] == 0 ? length : -length;
                is_inside[e] ^= 1;
            }
        }
        for (const Index f : faces_of[sheet]) {
            for (const Index e : complex.face_edges[f]) {
                is_inside[e] = 0;
            }
        }
    }
    std::vector<Sliver> slivers;
    for (Index sheet = 0; sheet < complex.sheets; ++sheet) {
        const double most = std::min(size, 0.5 * scale * least_radii[sheet]);
        if (2.0 * areas[sheet] < 0.5 * most * perimeters[sheet]) {
            slivers.push_back({areas[sheet], sheet, most});
        }
    }
    std::ranges::stable_sort(slivers, {}, &Sliver::area);
    return slivers;
}

class Contraction {
   public:
    explicit Contraction(MedialComplex complex)
        : complex_(std::move(complex)), stars_(complex_.vertices.size()), has_vertex_(complex_.vertices.size(), 1) {
        for (std::size_t f = 0; f < complex_.faces.size(); ++f) {
            add({complex_.faces[f].begin(), complex_.faces[f].end()});
        }
        for (const auto& [a, b] : curve_edges(complex_)) {
            add({a, b});
        }
    }

    // Contracts edges of some faces, the shortest first.
    void contract(std::span<const Index> faces, double size) {
        for (bool is_changed = true; is_changed;) {
            is_changed = false;
            std::vector<std::pair<double, std::array<Index, 2>>> edges;
            for (const Index f : faces) {
                const std::vector<Index>& cell = cells_[f];
                for (std::size_t k = 0; cell.size() > 2 && k < cell.size(); ++k) {
                    const Index p = cell[k];
                    const Index q = cell[(k + 1) % cell.size()];
                    if (const double length = distance(complex_.vertices[p], complex_.vertices[q]); length < size) {
                        edges.push_back({length, {std::min(p, q), std::max(p, q)}});
                    }
                }
            }
            std::ranges::sort(edges);
            for (const auto& [length, edge] : edges) {
                const auto& [p, q] = edge;
                if (!stars_[p].empty() && !stars_[q].empty() && may_contract(p, q)) {
                    contract_edge(p, q);
                    is_changed = true;
                }
            }
        }
    }

    MedialComplex result() && {
        MedialComplex result;
        result.vertices = std::move(complex_.vertices);
        result.radii = std::move(complex_.radii);
        result.vertex_balls = std::move(complex_.vertex_balls);
        result.boundary_vertices = std::move(complex_.boundary_vertices);
        result.boundary_vertex_balls = std::move(complex_.boundary_vertex_balls);
        result.sheets = complex_.sheets;
        for (std::size_t f = 0; f < complex_.faces.size(); ++f) {
            if (cells_[f].empty()) {
                continue;
            }
            result.faces.push_back(cells_[f]);
            result.face_angles.push_back(complex_.face_angles[f]);
            result.face_sheets.push_back(complex_.face_sheets[f]);
            if (complex_.has_contacts()) {
                result.face_contacts.push_back(complex_.face_contacts[f]);
            }
        }
        std::vector<std::array<Index, 2>> curves;
        for (std::size_t c = complex_.faces.size(); c < cells_.size(); ++c) {
            curves.push_back({std::min(cells_[c][0], cells_[c][1]), std::max(cells_[c][0], cells_[c][1])});
        }
        build_edges(result, curves);
        const std::vector<std::uint8_t> all_edges(result.edges.size(), 1);
        const std::vector<std::uint8_t> all_faces(result.faces.size(), 1);
        result = subcomplex(result, has_vertex_, all_edges, all_faces);
        label_sheets(result);
        return result;
    }

   private:
    void add(std::vector<Index> cell) {
        for (const Index v : cell) {
            stars_[v].push_back(static_cast<Index>(cells_.size()));
        }
        cells_.push_back(std::move(cell));
    }

    bool has(Index cell, Index v) const { return std::ranges::find(cells_[cell], v) != cells_[cell].end(); }

    static bool are_adjacent(const std::vector<Index>& corners, Index p, Index q) {
        const auto k = static_cast<std::size_t>(std::ranges::find(corners, p) - corners.begin());
        return k < corners.size() &&
               (corners[(k + 1) % corners.size()] == q || corners[(k + corners.size() - 1) % corners.size()] == q);
    }

    bool has_edge(Index cell, Index p, Index q) const { return are_adjacent(cells_[cell], p, q); }

    // Do two cells at a vertex have nothing else in common, or just one edge? Else they would have a diagonal in common
    // once they are cut into triangles.
    static bool meet_well(const std::vector<Index>& a, const std::vector<Index>& b, Index at) {
        return std::ranges::count_if(a, [&](Index v) { return std::ranges::find(b, v) != b.end(); }) < 3 &&
               std::ranges::all_of(a, [&](Index v) {
                   return v == at || std::ranges::find(b, v) == b.end() ||
                          (are_adjacent(a, at, v) && are_adjacent(b, at, v));
               });
    }

    bool is_triangle_at(Index cell, Index p, Index q) const {
        return cells_[cell].size() == 3 && has(cell, p) && has(cell, q);
    }

    std::vector<Index> neighbors(Index v) const {
        std::vector<Index> result;
        for (const Index cell : stars_[v]) {
            for (const Index w : cells_[cell]) {
                if (w != v && has_edge(cell, v, w)) {
                    result.push_back(w);
                }
            }
        }
        std::ranges::sort(result);
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }

    // An edge becomes a point, and triangles at it become edges: the homotopy type stays if nothing else meets itself,
    // and what is left is still a complex.
    bool may_contract(Index p, Index q) const {
        std::vector<std::vector<Index>> cells;  // what the others become
        for (const Index v : {p, q}) {
            for (const Index cell : stars_[v]) {
                const bool has_both = has(cell, p) && has(cell, q);
                if ((has_both && v == q) || is_triangle_at(cell, p, q)) {
                    continue;
                }
                if (has_both && !has_edge(cell, p, q)) {
                    return false;
                }
                std::vector<Index> corners = cells_[cell];
                if (has_both) {
                    std::erase(corners, q);
                }
                std::ranges::replace(corners, q, p);
                cells.push_back(std::move(corners));
            }
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                if (!meet_well(cells[i], cells[k], p)) {
                    return false;
                }
            }
        }
        std::vector<Index> common;
        std::ranges::set_intersection(neighbors(p), neighbors(q), std::back_inserter(common));
        return std::ranges::all_of(common, [&](Index x) {
            // The triangle goes; its sides, which become one, need another face.
            const auto is_beside = [&](Index cell) { return has_edge(cell, x, p) || has_edge(cell, x, q); };
            return std::ranges::any_of(stars_[p],
                                       [&](Index cell) { return is_triangle_at(cell, p, q) && has(cell, x); }) &&
                   std::ranges::any_of(stars_[x],
                                       [&](Index cell) { return !has(cell, p) != !has(cell, q) && is_beside(cell); });
        });
    }

    // How many sheets and curves meet at a vertex.
    std::size_t rank(Index v) const {
        std::vector<Index> sheets;
        std::size_t curves = 0;
        for (const Index cell : stars_[v]) {
            if (cell < static_cast<Index>(complex_.faces.size())) {
                sheets.push_back(complex_.face_sheets[cell]);
            } else {
                ++curves;
            }
        }
        std::ranges::sort(sheets);
        return curves + static_cast<std::size_t>(std::unique(sheets.begin(), sheets.end()) - sheets.begin());
    }

    void contract_edge(Index p, Index q) {
        place(p, q);
        for (const Index cell : stars_[q]) {
            std::vector<Index>& corners = cells_[cell];
            if (is_triangle_at(cell, p, q)) {
                for (const Index v : corners) {
                    if (v != q) {
                        std::erase(stars_[v], cell);
                    }
                }
                corners.clear();
            } else if (has(cell, p)) {
                std::erase(corners, q);
            } else {
                std::ranges::replace(corners, q, p);
                stars_[p].push_back(cell);
            }
        }
        stars_[q].clear();
        has_vertex_[q] = 0;
    }

    // Junctions stay where they are.
    void place(Index p, Index q) {
        const std::size_t rank_p = rank(p);
        const std::size_t rank_q = rank(q);
        if (rank_p < rank_q) {
            complex_.vertices[p] = complex_.vertices[q];
            complex_.radii[p] = complex_.radii[q];
            complex_.vertex_balls[p] = complex_.vertex_balls[q];
        } else if (rank_p == rank_q) {
            complex_.vertices[p] = midpoint(complex_.vertices[p], complex_.vertices[q]);
            complex_.radii[p] = 0.5 * (complex_.radii[p] + complex_.radii[q]);
            const bool is_linear = complex_.vertex_balls[p] == kMoved || complex_.vertex_balls[q] == kMoved;
            complex_.vertex_balls[p] = is_linear ? kMoved : kNone;
        }
    }

    MedialComplex complex_;
    std::vector<std::vector<Index>> cells_;  // faces, then edges without faces; empty: gone
    std::vector<std::vector<Index>> stars_;  // the cells at each vertex
    std::vector<std::uint8_t> has_vertex_;
};

}  // namespace

MedialComplex without_slivers(MedialComplex complex, double size, double scale) {
    const std::vector<Sliver> slivers = slivers_of(complex, size, scale);
    if (slivers.empty()) {
        return complex;
    }
    const IndexLists faces_of = faces_of_sheets(complex);
    Contraction contraction(std::move(complex));
    for (const Sliver& sliver : slivers) {
        contraction.contract(faces_of[sliver.sheet], sliver.size);
    }
    return std::move(contraction).result();
}

}  // namespace scaleaxis
