// SPDX-License-Identifier: Apache-2.0
#include "axis/edit/slivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/halving.hpp"
#include "axis/edit/triangulated.hpp"
#include "base/faults.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/cleaning.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr double kMostWidth = 0.5;     // tolerances: as far as balls of a union are off
constexpr double kMostRoom = 2.0 / 3;  // tolerances: on either side as far as balls of a union are inside the solid
constexpr double kMostEdge = 20.0;     // widths: as long as the edges of seams, on which contractions leave their ends

// Cosine of the angle, 130 degrees, below which the sides of a seam's end are two sheets. In the corner of a box all
// three meet at 120; with 150 sheets of smooth shapes fall apart where a branch ends on them.
constexpr double kTurn = -0.643;

struct Sliver {
    double area = 0.0;
    Index sheet = kNone;
    double width = 0.0;  // that narrower sheets have
};

// Whether a disc of that diameter fits between the edges around a sheet, with its center in that of a face or an edge.
bool has_room_for(double diameter, const MedialComplex& complex, std::span<const Index> faces,
                  std::span<const Index> outline) {
    const auto is_inside = [&](const Point& center) {
        return std::ranges::all_of(outline, [&](Index e) {
            const auto& [p, q] = complex.edges[e];
            return 2.0 * segment_distance(center, complex.vertices[p], complex.vertices[q]) >= diameter;
        });
    };
    return std::ranges::any_of(faces, [&](Index f) {
        return is_inside(center_of_face(complex, f)) || std::ranges::any_of(complex.face_edges[f], [&](Index e) {
                   const auto& [p, q] = complex.edges[e];
                   return is_inside(midpoint(complex.vertices[p], complex.vertices[q]));
               });
    });
}

// What is smaller than the disc that sheets have room for is a crumb, whatever its radii: in an apex they are small.
bool is_crumb(double area, double tolerance) {
    const double room = kMostRoom * tolerance;
    return room < kInfinity && area < 0.25 * std::numbers::pi * room * room;
}

// Crumbs, and sheets that are narrow in the mean, and wide nowhere: in a corner where bars meet is one that is three
// times as wide in its middle as in the mean along its jagged outline. The smallest first, so that the numbers of
// sheets do not matter.
std::vector<Sliver> slivers_of(const MedialComplex& complex, double tolerance) {
    const IndexLists faces_of = faces_of_sheets(complex);
    std::vector<std::uint8_t> is_outer(complex.edges.size());
    std::vector<Sliver> slivers;
    for (Index sheet = 0; sheet < complex.sheets; ++sheet) {
        double area = 0.0;
        for (const Index f : faces_of[sheet]) {
            area += face_area(complex, f);
            std::ranges::for_each(complex.face_edges[f], [&](Index e) { is_outer[e] ^= 1; });
        }
        // Along the outline, for the radii at its ends can differ much.
        double perimeter = 0.0;
        double most = 0.0;
        std::vector<Index> outline;
        for (const Index f : faces_of[sheet]) {
            for (const Index e : complex.face_edges[f]) {
                if (std::exchange(is_outer[e], 0) != 0) {
                    const auto& [p, q] = complex.edges[e];
                    const double length = distance(complex.vertices[p], complex.vertices[q]);
                    const double radius = 0.5 * (complex.radii[p] + complex.radii[q]);
                    outline.push_back(e);
                    // None of the balls between the sides of what is narrower tells it from a seam.
                    perimeter += length;
                    most += length * std::min(kMostWidth * tolerance, kNearby * radius);
                }
            }
        }
        if (is_crumb(area, tolerance)) {
            slivers.push_back({area, sheet, kMostWidth * tolerance});
        } else if (2.0 * area < most && !has_room_for(kMostRoom * tolerance, complex, faces_of[sheet], outline)) {
            slivers.push_back({area, sheet, most / perimeter});
        }
    }
    std::ranges::stable_sort(slivers, {}, &Sliver::area);
    return slivers;
}

struct TriangleShape {
    double twice_area = 0.0;
    double squared_length = 0.0;  // of the longest side

    TriangleShape(const Point& a, const Point& b, const Point& c)
        : twice_area(norm(cross(b - a, c - a))),
          squared_length(std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)})) {}
    double roundness() const { return squared_length > 0.0 ? twice_area / squared_length : 0.0; }
    double height() const { return squared_length > 0.0 ? twice_area / std::sqrt(squared_length) : 0.0; }
};

using Flags = std::vector<std::uint8_t>;

// The vertices of some sheets.
Flags vertices_of_slivers(const std::vector<Sliver>& slivers, const MedialComplex& complex) {
    Flags is_sliver(static_cast<std::size_t>(complex.sheets));
    for (const Sliver& sliver : slivers) {
        is_sliver[sliver.sheet] = 1;
    }
    Flags result(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index v : complex.faces[f]) {
            result[v] |= is_sliver[complex.face_sheets[f]];
        }
    }
    return result;
}

// Polygons at some vertices become triangles. Polygons that have two edges in common stand in the way of contractions,
// triangles that have two are the same.
MedialComplex with_triangles_at(const Flags& is_asked, const MedialComplex& complex) {
    const std::vector<std::array<Index, 2>> curves = curve_edges(complex);
    MedialComplex result = vertices_of(complex);
    // Three corners on a line, as there are in seams, are cut off last.
    const auto flatness = [&](Index a, Index b, Index c) {
        return -TriangleShape(complex.vertices[a], complex.vertices[b], complex.vertices[c]).roundness();
    };
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        const FaceValues values = values_of(complex, f);
        const auto add = [&](std::span<const Index> corners) { add_face(result, corners, values); };
        const std::span<const Index> corners = complex.faces[f];
        if (std::ranges::none_of(corners, [&](Index v) { return is_asked[v] != 0; })) {
            add(corners);
            continue;
        }
        cut_ears(corners, flatness, [&](const std::array<std::size_t, 3>& at) {
            add(std::array{corners[at[0]], corners[at[1]], corners[at[2]]});
        });
    }
    build_edges(result, curves);
    return result;
}

class Contraction {
   public:
    explicit Contraction(MedialComplex complex)
        : complex_(std::move(complex)), cells_(complex_.faces), has_vertex_(complex_.vertices.size(), 1) {
        for (const auto& edge : curve_edges(complex_)) {
            cells_.push_back(edge);
        }
        for (Index c = 0; c < static_cast<Index>(cells_.size()); ++c) {
            sizes_.push_back(cells_.offsets[c + 1] - cells_.offsets[c]);
        }
        stars_ = grouped(complex_.vertices.size(), [&](const auto& add) {
            for (Index c = 0; c < static_cast<Index>(cells_.size()); ++c) {
                for (const Index v : cells_[c]) {
                    add(v, c);
                }
            }
        });
    }

    // Contracts the edges of some faces that are shorter than `size_of(an end, the other end)`, the shortest first.
    // Returns whether there was one.
    template <class SizeOf>
    bool contract(std::span<const Index> faces, const SizeOf& size_of) {
        bool is_any_changed = false;
        for (bool is_changed = true; is_changed; is_any_changed |= is_changed) {
            is_changed = false;
            std::vector<std::pair<double, std::array<Index, 2>>> edges;
            for (const Index f : faces) {
                const std::span<const Index> cell = corners_of(f);
                for (std::size_t k = 0; cell.size() > 2 && k < cell.size(); ++k) {
                    const Index p = cell[k];
                    const Index q = cell[(k + 1) % cell.size()];
                    if (const double length = distance(complex_.vertices[p], complex_.vertices[q]);
                        length < size_of(p, q)) {
                        edges.push_back({length, {std::min(p, q), std::max(p, q)}});
                    }
                }
            }
            std::ranges::sort(edges);
            for (const auto& [length, edge] : edges) {
                const auto& [p, q] = edge;
                is_changed |= contract(p, q);
            }
        }
        return is_any_changed;
    }

    // Contracts an edge if its ends are still there and it may go. Returns whether it has.
    bool contract(Index p, Index q) {
        const bool may_go = !star(p).empty() && !star(q).empty() && may_contract(p, q);
        if (may_go) {
            contract_edge(p, q);
        }
        return may_go;
    }

    // The faces at the vertices of some.
    std::vector<Index> faces_at(std::span<const Index> faces) const {
        std::vector<Index> result;
        for (const Index f : faces) {
            for (const Index v : corners_of(f)) {
                std::ranges::copy_if(star(v), std::back_inserter(result),
                                     [&](Index cell) { return cell < static_cast<Index>(complex_.faces.size()); });
            }
        }
        sort_unique(result);
        return result;
    }

    bool is_any_left(std::span<const Index> faces) const {
        return std::ranges::any_of(faces, [&](Index f) { return sizes_[f] != 0; });
    }

    // Those of some faces that are triangles less high than `height`.
    std::vector<Index> flat_ones(std::span<const Index> faces, double height) const {
        std::vector<Index> result;
        std::ranges::copy_if(faces, std::back_inserter(result),
                             [&](Index f) { return sizes_[f] == 3 && height_of(corners_of(f)) < height; });
        return result;
    }

    MedialComplex result() && {
        MedialComplex result = vertices_of(complex_);
        for (Index f = 0; f < static_cast<Index>(complex_.faces.size()); ++f) {
            if (sizes_[f] != 0) {
                add_face(result, corners_of(f), values_of(complex_, f));
            }
        }
        std::vector<std::array<Index, 2>> curves;
        for (std::size_t c = complex_.faces.size(); c < cells_.size(); ++c) {
            const std::span<const Index> ends = cells_[c];
            curves.push_back({std::min(ends[0], ends[1]), std::max(ends[0], ends[1])});
        }
        build_edges(result, curves);
        const std::vector<std::uint8_t> all_edges(result.edges.size(), 1);
        const std::vector<std::uint8_t> all_faces(result.faces.size(), 1);
        result = subcomplex(result, has_vertex_, all_edges, all_faces);
        label_sheets(result);
        return result;
    }

   private:
    std::span<const Index> corners_of(Index cell) const {
        return cells_[cell].first(static_cast<std::size_t>(sizes_[cell]));
    }

    double height_of(std::span<const Index> corners) const {
        const auto at = [&](int k) { return complex_.vertices[corners[k]]; };
        return TriangleShape(at(0), at(1), at(2)).height();
    }

    void erase_corner(Index cell, Index v) {
        const auto begin = cells_.items.begin() + cells_.offsets[cell];
        sizes_[cell] = static_cast<Index>(std::remove(begin, begin + sizes_[cell], v) - begin);
    }

    void replace_corner(Index cell, Index from, Index to) {
        const auto begin = cells_.items.begin() + cells_.offsets[cell];
        std::replace(begin, begin + sizes_[cell], from, to);
    }

    // The cells at a vertex.
    std::span<const Index> star(Index v) const {
        const auto changed = changed_stars_.find(v);
        return changed != changed_stars_.end() ? changed->second : stars_[v];
    }

    std::vector<Index>& star_to_change(Index v) {
        return changed_stars_.try_emplace(v, stars_[v].begin(), stars_[v].end()).first->second;
    }

    bool has(Index cell, Index v) const {
        const std::span<const Index> corners = corners_of(cell);
        return std::ranges::find(corners, v) != corners.end();
    }

    static bool are_adjacent(std::span<const Index> corners, Index p, Index q) {
        const auto k = static_cast<std::size_t>(std::ranges::find(corners, p) - corners.begin());
        return k < corners.size() &&
               (corners[(k + 1) % corners.size()] == q || corners[(k + corners.size() - 1) % corners.size()] == q);
    }

    bool has_edge(Index cell, Index p, Index q) const { return are_adjacent(corners_of(cell), p, q); }

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
        return sizes_[cell] == 3 && has(cell, p) && has(cell, q);
    }

    std::vector<Index> neighbors(Index v) const {
        std::vector<Index> result;
        for (const Index cell : star(v)) {
            for (const Index w : corners_of(cell)) {
                if (w != v && has_edge(cell, v, w)) {
                    result.push_back(w);
                }
            }
        }
        sort_unique(result);
        return result;
    }

    // An edge becomes a point, and triangles at it become edges: the homotopy type stays if nothing else meets itself,
    // and what is left is still a complex. Sheets still end on the sharp edges of the solid.
    bool may_contract(Index p, Index q) const {
        if (is_on_sharp_edge(complex_, p) || is_on_sharp_edge(complex_, q)) {
            return false;
        }
        std::vector<std::vector<Index>> cells;  // what the others become
        for (const Index v : {p, q}) {
            for (const Index cell : star(v)) {
                const bool has_both = has(cell, p) && has(cell, q);
                if ((has_both && v == q) || is_triangle_at(cell, p, q)) {
                    continue;
                }
                if (has_both && !has_edge(cell, p, q)) {
                    return false;
                }
                const std::span<const Index> before = corners_of(cell);
                std::vector<Index> corners(before.begin(), before.end());
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
            return std::ranges::any_of(star(p),
                                       [&](Index cell) { return is_triangle_at(cell, p, q) && has(cell, x); }) &&
                   std::ranges::any_of(star(x),
                                       [&](Index cell) { return !has(cell, p) != !has(cell, q) && is_beside(cell); });
        });
    }

    // How many sheets and curves meet at a vertex.
    std::size_t rank(Index v) const {
        std::vector<Index> sheets;
        std::size_t curves = 0;
        for (const Index cell : star(v)) {
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
        for (const Index cell : star(q)) {
            if (is_triangle_at(cell, p, q)) {
                for (const Index v : corners_of(cell)) {
                    if (v != q) {
                        std::erase(star_to_change(v), cell);
                    }
                }
                sizes_[cell] = 0;
            } else if (has(cell, p)) {
                erase_corner(cell, q);
            } else {
                replace_corner(cell, q, p);
                star_to_change(p).push_back(cell);
            }
        }
        star_to_change(q).clear();
        has_vertex_[q] = 0;
    }

    // Junctions stay where they are, and beside them larger balls: no vertex gets a ball that none had.
    void place(Index p, Index q) {
        if (std::pair(rank(p), complex_.radii[p]) < std::pair(rank(q), complex_.radii[q])) {
            complex_.vertices[p] = complex_.vertices[q];
            complex_.radii[p] = complex_.radii[q];
            complex_.vertex_origins[p] = complex_.vertex_origins[q];
        }
    }

    MedialComplex complex_;
    IndexLists cells_;                                             // faces, then edges without faces
    std::vector<Index> sizes_;                                     // how many corners the cells still have; 0: gone
    IndexLists stars_;                                             // the cells at each vertex, before anything changed
    std::unordered_map<Index, std::vector<Index>> changed_stars_;  // few
    std::vector<std::uint8_t> has_vertex_;
};

// Of triangles without height: the longest side, and the corner beside it.
std::vector<std::array<Index, 2>> flat_triangles(const MedialComplex& complex, const std::vector<Sliver>& slivers) {
    std::vector<std::array<Index, 2>> result;
    const IndexLists faces_of = faces_of_sheets(complex);
    for (const Sliver& sliver : slivers) {
        for (const Index f : faces_of[sliver.sheet]) {
            const std::span<const Index> corners = complex.faces[f];
            const auto side_of = [&](Index e) {
                return complex.vertices[complex.edges[e][1]] - complex.vertices[complex.edges[e][0]];
            };
            const Index e =
                *std::ranges::max_element(complex.face_edges[f], {}, [&](Index k) { return norm(side_of(k)); });
            const Index v =
                *std::ranges::find_if(corners, [&](Index k) { return std::ranges::count(complex.edges[e], k) == 0; });
            const Point from = complex.vertices[v] - complex.vertices[complex.edges[e][0]];
            const double part = dot(from, side_of(e)) / squared_norm(side_of(e));
            if (corners.size() == 3 && part > 0.0 && part < 1.0 &&
                norm(from - part * side_of(e)) < sliver.width / kMostEdge) {
                result.push_back({e, v});
            }
        }
    }
    return result;
}

// Cuts the longest side of each flat triangle at the corner beside it, and contracts it there: between three seams none
// of its sides may be. Those that may not either stay whole.
MedialComplex without_flat_triangles(const MedialComplex& complex, std::vector<std::array<Index, 2>> flat) {
    while (!flat.empty()) {
        std::vector<Index> corner_at(complex.edges.size(), kNone);
        Halving cuts{std::vector<std::uint8_t>(complex.edges.size()), std::vector<double>(complex.edges.size())};
        for (const auto& [e, v] : flat) {
            corner_at[e] = v;
            cuts.is_halved[e] = 1;
        }
        MedialComplex cut = halved(complex, cuts);
        std::vector<std::array<Index, 3>> pairs;  // the corner, the new vertex, which is the corner once more; the side
        for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
            if (const Index v = corner_at[e]; v != kNone) {
                const Index added = static_cast<Index>(complex.vertices.size() + pairs.size());
                cut.vertices[added] = complex.vertices[v];
                cut.radii[added] = complex.radii[v];
                cut.vertex_origins[added] = complex.vertex_origins[v];
                pairs.push_back({v, added, e});
            }
        }
        Contraction contraction(std::move(cut));
        flat.clear();
        for (const auto& [v, added, e] : pairs) {
            if (contraction.contract(v, added)) {
                flat.push_back({e, v});
            }
        }
        if (flat.size() == pairs.size()) {
            return std::move(contraction).result();
        }
    }
    return complex;
}

MedialComplex contracted(MedialComplex complex, const std::vector<Sliver>& slivers) {
    complex = with_triangles_at(vertices_of_slivers(slivers, complex), complex);
    const IndexLists faces_of = faces_of_sheets(complex);
    Contraction contraction(std::move(complex));
    std::vector<std::vector<Index>> faces_around;
    std::ranges::transform(slivers, std::back_inserter(faces_around),
                           [&](const Sliver& sliver) { return contraction.faces_at(faces_of[sliver.sheet]); });
    for (bool is_changed = true; is_changed;) {  // what one leaves behind, others may free
        is_changed = false;
        for (std::size_t k = 0; k < slivers.size(); ++k) {
            const auto& [area, sheet, width] = slivers[k];
            // Across first; where that would change the homotopy type, along. Other sheets may stand in the way, with
            // edges as short, or with triangles as flat as a folded seam makes them.
            for (const auto& [length, height] :
                 {std::pair(width, kInfinity), std::pair(kMostEdge * width, width / kMostEdge)}) {
                const auto size_of = [size = length](Index, Index) { return size; };
                is_changed |= contraction.contract(faces_of[sheet], size_of);
                if (contraction.is_any_left(faces_of[sheet])) {
                    is_changed |= contraction.contract(contraction.flat_ones(faces_around[k], height), size_of);
                }
            }
        }
    }
    return std::move(contraction).result();
}

// Contracts the edges of crumbs that are shorter than these may be wide.
MedialComplex with_crumbs_contracted(MedialComplex complex, double tolerance) {
    const std::vector<Sliver> slivers = slivers_of(complex, tolerance);
    const IndexLists faces_of = faces_of_sheets(complex);
    Contraction contraction(std::move(complex));
    for (const Sliver& sliver : slivers) {
        if (is_crumb(sliver.area, tolerance)) {
            contraction.contract(faces_of[sliver.sheet], [&](Index, Index) { return sliver.width; });
        }
    }
    return std::move(contraction).result();
}

// Halves the edges that lead away from slivers and cuts the faces there at their centers. Then no two vertices of a
// sliver have a neighbor in common beside it, which would stand in the way of contractions.
MedialComplex with_room_around(const std::vector<Sliver>& slivers, const MedialComplex& complex) {
    Flags is_sliver(static_cast<std::size_t>(complex.sheets));
    std::ranges::for_each(slivers, [&](const Sliver& sliver) { is_sliver[sliver.sheet] = 1; });
    const auto is_in_sliver = [&](std::size_t f) { return is_sliver[complex.face_sheets[f]] != 0; };
    const Flags is_at_sliver = vertices_of_slivers(slivers, complex);
    Flags is_side(complex.edges.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index e : is_in_sliver(f) ? complex.face_edges[f] : std::span<const Index>()) {
            is_side[e] = 1;
        }
    }
    const std::vector<Index> faces_at = face_counts(complex);
    MedialComplex result = vertices_of(complex);
    std::vector<Index> middles(complex.edges.size(), kNone);
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        const auto& [a, b] = complex.edges[e];
        if (is_side[e] == 0 && faces_at[e] > 0 && (is_at_sliver[a] != 0 || is_at_sliver[b] != 0)) {
            middles[e] = add_vertex(result, mean_ball(complex, complex.edges[e]),
                                    origin_between(complex.vertex_origins[a], complex.vertex_origins[b]));
        }
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const FaceValues values = values_of(complex, static_cast<Index>(f));
        const std::span<const Index> corners = complex.faces[f];
        if (is_in_sliver(f) || std::ranges::none_of(corners, [&](Index v) { return is_at_sliver[v] != 0; })) {
            add_face(result, corners, values);
            continue;
        }
        std::vector<Index> around;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            around.push_back(corners[k]);
            if (const Index middle = middles[complex.face_edges[f][k]]; middle != kNone) {
                around.push_back(middle);
            }
        }
        const Ball mean = mean_ball(complex, corners);
        const Index center = add_vertex(result, mean, linear_vertex(mean.radius));
        for (std::size_t k = 0; k < around.size(); ++k) {
            add_face(result, std::array{center, around[k], around[(k + 1) % around.size()]}, values);
        }
    }
    build_edges(result, curve_edges(complex));
    label_sheets(result);
    return result;
}

// Where a seam ends and a sheet goes on around it, from one side of it to the other: the shortest edge from there to
// the border of that sheet.
std::vector<std::array<Index, 2>> edges_around_ends(const MedialComplex& complex, std::span<const double> most,
                                                    double factor, bool may_be_flat) {
    const IndexLists faces_at = faces_at_edges(complex);
    const Flags is_at_border = vertices_at_borders(complex);
    const auto next_edge = [&](Index face, Index edge, Index v) {
        return *std::ranges::find_if(complex.face_edges[face], [&](Index e) {
            return e != edge && (complex.edges[e][0] == v || complex.edges[e][1] == v);
        });
    };
    const auto is_turn = [&](Index seam, Index f, Index g) {
        const Point a = inward(complex, f, seam);
        const Point b = inward(complex, g, seam);
        return dot(a, b) > kTurn * norm(a) * norm(b);
    };
    std::vector<std::pair<double, std::array<Index, 2>>> found;
    for (Index seam = 0; seam < static_cast<Index>(complex.edges.size()); ++seam) {
        for (const Index v : complex.edges[seam]) {
            for (const Index first : faces_at[seam].size() > 2 ? faces_at[seam] : std::span<const Index>()) {
                std::pair<double, std::array<Index, 2>> shortest{factor * most[v], {kNone, kNone}};
                Index face = first;
                Index edge = next_edge(face, seam, v);
                while (faces_at[edge].size() == 2) {
                    const Index w = complex.edges[edge][complex.edges[edge][0] == v ? 1 : 0];
                    if (is_at_border[w] != 0 && !is_on_sharp_edge(complex, w)) {
                        shortest =
                            std::min(shortest, {distance(complex.vertices[v], complex.vertices[w]), std::array{v, w}});
                    }
                    face = faces_at[edge][faces_at[edge][0] == face ? 1 : 0];
                    edge = next_edge(face, edge, v);
                }
                if (edge == seam && shortest.second[0] != kNone && (may_be_flat || is_turn(seam, first, face))) {
                    found.push_back(shortest);
                }
            }
        }
    }
    std::ranges::sort(found);
    std::vector<std::array<Index, 2>> edges;
    std::ranges::transform(found, std::back_inserter(edges), [](const auto& item) { return item.second; });
    return edges;
}

}  // namespace

MedialComplex without_slivers(MedialComplex complex, double tolerance) {
    std::vector<Sliver> slivers = slivers_of(complex, tolerance);
    if (slivers.empty()) {
        return complex;
    }
    complex = contracted(std::move(complex), slivers);
    if (slivers = slivers_of(complex, tolerance); slivers.empty()) {
        return complex;
    }
    complex = without_flat_triangles(complex, flat_triangles(complex, slivers));
    // Once others are gone there may be room where there was none.
    for (slivers = slivers_of(complex, tolerance); !slivers.empty();) {
        MedialComplex with_room = with_crumbs_contracted(with_room_around(slivers, complex), tolerance);
        with_room = without_flat_triangles(with_room, flat_triangles(with_room, slivers_of(with_room, tolerance)));
        std::vector<Sliver> left = slivers_of(with_room, tolerance);
        if (left.size() >= slivers.size()) {
            return complex;
        }
        complex = std::move(with_room);
        slivers = std::move(left);
    }
    return complex;
}

MedialComplex with_seams_to_borders(MedialComplex complex, double tolerance) {
    // With half of the tolerance four seams in ten stay open that end too early.
    const std::vector<double> reaches(complex.vertices.size(), tolerance);
    return with_seams_to_borders(std::move(complex), reaches, false);
}

MedialComplex with_seams_to_borders(MedialComplex complex, std::span<const double> reaches, bool may_be_flat) {
    // Polygons are cut first: then more edges lead there.
    const auto ends = edges_around_ends(complex, reaches, 2.0, may_be_flat);
    if (ends.empty()) {
        return complex;
    }
    Flags is_end(complex.vertices.size());
    for (const auto& [p, q] : ends) {
        is_end[p] = is_end[q] = 1;
    }
    complex = with_triangles_at(is_end, complex);
    label_sheets(complex);
    const auto edges = edges_around_ends(complex, reaches, 1.0, may_be_flat);
    Contraction contraction(std::move(complex));
    for (const auto& [p, q] : edges) {
        contraction.contract(p, q);
    }
    return std::move(contraction).result();
}

MedialComplex without_short_edges_at_seams(MedialComplex complex, double part) {
    const Flags is_in_seam = vertices_at_seams(complex);
    complex = with_triangles_at(Flags(complex.vertices.size(), 1), complex);
    std::vector<Index> faces;
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        if (std::ranges::any_of(complex.faces[f], [&](Index v) { return is_in_seam[v] != 0; })) {
            faces.push_back(f);
        }
    }
    const std::vector<double> radii = complex.radii;
    Contraction contraction(std::move(complex));
    contraction.contract(faces, [&](Index p, Index q) {
        return is_in_seam[p] != 0 || is_in_seam[q] != 0 ? part * std::min(radii[p], radii[q]) : 0.0;
    });
    return std::move(contraction).result();
}

MedialComplex contract_slivers(const MedialComplex& complex, double tolerance, const Execution& execution) {
    require(tolerance > 0.0, "the tolerance must be a positive number");
    return in_arena(execution, [&] {
        check(complex);
        return without_slivers(with_seams_to_borders(complex, tolerance), tolerance);
    });
}

}  // namespace scaleaxis::inline v1
