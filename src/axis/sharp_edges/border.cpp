// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/border.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "axis/complex.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/sharp_edges.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Gaps in a row of places on an edge.
constexpr std::size_t kMostInGap = 6;
constexpr double kMostWidth = 4.0;  // tolerances
constexpr double kSag = 0.05;       // of the width: how far from the edge the middle may be

// Cosine of the angle from which on two edges are different ones.
const double kOtherDirection = std::cos(25.0 * std::numbers::pi / 180.0);

// A few vertices of the border that see no edge, or none, between two that see one.
struct BorderGap {
    std::vector<Index> inside;
    Index before;
    Index after;
};

std::vector<BorderGap> gaps_of(const Border& border) {
    const auto is_open = [&](Index i) {
        const BorderVertex& at = border.vertices[i];
        return at.is_plain() && !at.crease && !at.corner;
    };
    std::vector<BorderGap> gaps;
    for (Index i = 0; i < static_cast<Index>(border.vertices.size()); ++i) {
        for (const Index first : border.vertices[i].neighbors) {
            if (!border.vertices[i].crease || first == kNone) {
                continue;
            }
            BorderGap gap{{}, i, first};
            for (Index last = i; is_open(gap.after) && gap.inside.size() <= kMostInGap;) {
                gap.inside.push_back(gap.after);
                const auto& [p, q] = border.vertices[gap.after].neighbors;
                gap.after = std::exchange(last, gap.after) == p ? q : p;
            }
            if (border.vertices[gap.after].crease && gap.after > i && gap.inside.size() <= kMostInGap) {
                gaps.push_back(std::move(gap));
            }
        }
    }
    return gaps;
}

// Has gaps go to the places beside them, if the edge goes on there.
void close_gaps(const Solid& solid, double most_width, Border& border) {
    std::vector<BorderGap> gaps = gaps_of(border);
    std::erase_if(gaps, [&](const BorderGap& gap) {
        if (gap.inside.empty()) {
            return true;
        }
        const Crease& before = *border.vertices[gap.before].crease;
        const Crease& after = *border.vertices[gap.after].crease;
        const Point way = after.place - before.place;
        return norm(way) > most_width || std::abs(dot(way, before.direction)) < kSameDirection * norm(way) ||
               std::abs(dot(way, after.direction)) < kSameDirection * norm(way);
    });
    std::vector<Point> points;
    std::vector<double> bounds;
    for (const BorderGap& gap : gaps) {
        const Point& a = border.vertices[gap.before].crease->place;
        const Point& b = border.vertices[gap.after].crease->place;
        points.push_back(midpoint(a, b));
        bounds.push_back(kSag * distance(a, b));
    }
    const std::vector<std::optional<Point>> answers = nearest_of(solid, points, bounds);
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const std::vector<Index>& inside = gaps[i].inside;
        for (std::size_t k = 0; answers[i] && k < inside.size(); ++k) {
            const Index beside = 2 * k < inside.size() ? gaps[i].before : gaps[i].after;
            border.vertices[inside[k]].crease = border.vertices[beside].crease;
        }
    }
}

// Where the lines of two edges meet, unless they are so close in direction that a row goes on from one to the other.
std::optional<Point> meeting_of(const Crease& a, const Crease& b, double same_place) {
    const Point way = b.place - a.place;
    const double cosine = dot(a.direction, b.direction);
    const double determinant = 1.0 - cosine * cosine;
    if (std::abs(cosine) > kSameDirection) {
        return std::nullopt;
    }
    const double along_a = dot(way, a.direction);
    const double along_b = dot(way, b.direction);
    const Point on_a = a.place + ((along_a - cosine * along_b) / determinant) * a.direction;
    const Point on_b = b.place + ((cosine * along_a - along_b) / determinant) * b.direction;
    return distance(on_a, on_b) <= same_place ? std::optional(midpoint(on_a, on_b)) : std::nullopt;
}

// Between two edges that end in one point of the boundary: where a re-entrant edge ends there as well, balls around it
// touch that edge and no third plane. The gap goes to the point, if both edges go on up to it.
void close_gaps_at_saddles(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                           Border& border) {
    const double same_place = kSamePlace * options.tolerance;
    std::vector<BorderGap> gaps;
    std::vector<Point> places;
    std::vector<Point> points;  // on the way there along both edges
    for (BorderGap& gap : gaps_of(border)) {
        const std::array ends{&border.vertices[gap.before], &border.vertices[gap.after]};
        if (ends[0]->corner || ends[1]->corner) {
            continue;
        }
        const std::optional<Point> place = meeting_of(*ends[0]->crease, *ends[1]->crease, same_place);
        if (!place || std::ranges::any_of(ends, [&](const BorderVertex* end) {
                return distance(*place, end->crease->place) > kMostWidth * options.tolerance;
            })) {
            continue;
        }
        for (const BorderVertex* end : ends) {
            const Point& edge = end->crease->place;
            points.push_back(midpoint(edge, *place) + kAsideOfEdge * (complex.vertices[end->vertex] - edge));
        }
        gaps.push_back(std::move(gap));
        places.push_back(*place);
    }
    const std::vector<std::optional<Crease>> creases = creases_near(solid, points, options, false);
    const std::vector<std::optional<Point>> nearest =
        nearest_of(solid, places, std::vector<double>(places.size(), same_place));
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const auto goes_on = [&](Index end, const std::optional<Crease>& seen) {
            const Crease& edge = *border.vertices[end].crease;
            const Point way = seen ? seen->place - edge.place : Point();
            return seen && norm(way - dot(way, edge.direction) * edge.direction) <= same_place;
        };
        if (nearest[i] && goes_on(gaps[i].before, creases[2 * i]) && goes_on(gaps[i].after, creases[2 * i + 1])) {
            std::vector<Index> inside = gaps[i].inside;
            if (inside.empty()) {
                const auto from_place = [&](Index v) { return distance(border.vertices[v].crease->place, places[i]); };
                inside = {std::min(gaps[i].before, gaps[i].after,
                                   [&](Index v, Index w) { return from_place(v) < from_place(w); })};
            }
            for (const Index v : inside) {
                border.vertices[v].corner = Crease{places[i], {}, border.vertices[gaps[i].before].crease->angle};
            }
        }
    }
}

}  // namespace

std::vector<std::uint8_t> small_sheets(const MedialComplex& complex, double size) {
    std::vector<Box> boxes(complex.sheets);
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index v : complex.faces[f]) {
            boxes[complex.face_sheets[f]].extend(complex.vertices[v]);
        }
    }
    std::vector<std::uint8_t> result(boxes.size());
    std::ranges::transform(boxes, result.begin(), [&](const Box& box) { return box.diagonal() < size ? 1 : 0; });
    return result;
}

Border border_of(const MedialComplex& complex, double least_sheet) {
    const std::vector<std::uint8_t> is_small = small_sheets(complex, least_sheet);
    std::vector<Index> faces_at(complex.edges.size());
    std::vector<Index> face_of(complex.edges.size());
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        for (const Index e : complex.face_edges[f]) {
            face_of[e] = f;
        }
    }
    for (const Index e : complex.face_edges.items) {
        ++faces_at[e];
    }
    Border border;
    border.positions.assign(complex.vertices.size(), kNone);
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (faces_at[e] != 1 || is_small[complex.face_sheets[face_of[e]]] != 0) {
            continue;
        }
        std::array<Index, 2> ends{};
        for (int k = 0; k < 2; ++k) {
            Index& position = border.positions[complex.edges[e][k]];
            if (position == kNone) {
                position = static_cast<Index>(border.vertices.size());
                border.vertices.emplace_back().vertex = complex.edges[e][k];
            }
            ends[k] = position;
        }
        border.edges.push_back(ends);
        for (int k = 0; k < 2; ++k) {
            BorderVertex& at = border.vertices[ends[k]];
            if (at.border_edges < 2) {
                at.neighbors[at.border_edges] = ends[1 - k];
            }
            ++at.border_edges;
        }
    }
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        for (const Index v : complex.faces[f]) {
            if (border.positions[v] != kNone) {
                border.vertices[border.positions[v]].face = f;
            }
        }
    }
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        for (const Index v : complex.edges[e]) {
            if (faces_at[e] > 2 && border.positions[v] != kNone) {
                border.vertices[border.positions[v]].is_at_seam = true;
            }
        }
    }
    return border;
}

void find_creases(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options, Border& border) {
    const auto search = [&](bool wants_corners, const auto& is_wanted, auto result) {
        std::vector<Index> chosen;
        std::vector<Point> points;
        for (Index i = 0; i < static_cast<Index>(border.vertices.size()); ++i) {
            if (is_wanted(border.vertices[i])) {
                chosen.push_back(i);
                points.push_back(complex.vertices[border.vertices[i].vertex]);
            }
        }
        std::vector<std::optional<Crease>> found = creases_near(solid, points, options, wants_corners);
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            border.vertices[chosen[k]].*result = found[k];
        }
    };
    search(
        false, [](const BorderVertex& at) { return at.is_plain(); }, &BorderVertex::crease);
    search(
        true,
        [&](const BorderVertex& at) {
            if (!at.is_plain()) {
                return true;
            }
            return at.crease && std::ranges::any_of(at.neighbors, [&](Index neighbor) {
                       const std::optional<Crease>& other = border.vertices[neighbor].crease;
                       return other && std::abs(dot(at.crease->direction, other->direction)) < kOtherDirection;
                   });
        },
        &BorderVertex::corner);
    close_gaps(solid, kMostWidth * options.tolerance, border);
    close_gaps_at_saddles(complex, solid, options, border);
}

}  // namespace scaleaxis::inline v1
