// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/crests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "axis/complex.hpp"
#include "base/disjoint_sets.hpp"
#include "base/vectors.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/point_tree.hpp"
#include "spatial/slab.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Does a ball that stays cover one that goes? \param squared distance of their centres
bool covers(const MedialComplex& complex, Index stays, Index goes, double squared, double cosine) {
    return std::sqrt(squared) + complex.radii[goes] <= complex.radii[stays] / cosine;
}

// An edge of the mesh within 60 degrees of the steepest way up has at least half of its slope.
std::vector<Index> without_steep_edge(const MedialComplex& complex, std::span<const std::uint8_t> is_narrow,
                                      double cosine) {
    std::vector<std::uint8_t> is_flat(is_narrow.begin(), is_narrow.end());
    for (const auto& [p, q] : complex.edges) {
        const double growth = complex.radii[q] - complex.radii[p];
        if (std::abs(growth) > 0.5 * cosine * distance(complex.vertices[p], complex.vertices[q])) {
            is_flat[growth > 0.0 ? p : q] = 0;
        }
    }
    return indices_where(is_flat.size(), [&](Index v) { return is_flat[v] != 0; });
}

void erase_covered_by_others(std::vector<Index>& tops, const MedialComplex& complex,
                             std::span<const std::uint8_t> is_narrow, double cosine) {
    const auto others = indices_where(is_narrow.size(), [&](Index v) { return is_narrow[v] == 0; });
    if (tops.empty() || others.empty()) {
        return;
    }
    const BallTree tree = build_ball_tree(each_of<Ball>(others, [&](Index v) {
        return Ball{complex.vertices[v], complex.radii[v] / cosine};
    }));
    std::erase_if(tops,
                  [&](Index v) { return nearest_ball(tree, complex.vertices[v], -complex.radii[v]).ball != kNone; });
}

// Connected ones together, as places in `tops`, those with the largest balls first.
std::vector<std::vector<Index>> connected(std::span<const Index> tops, const MedialComplex& complex) {
    std::vector<Index> places(complex.vertices.size(), kNone);
    for (Index i = 0; i < std::ssize(tops); ++i) {
        places[tops[i]] = i;
    }
    DisjointSets sets(tops.size());
    for (const auto& [p, q] : complex.edges) {
        if (places[p] != kNone && places[q] != kNone) {
            sets.join(places[p], places[q]);
        }
    }
    const auto [numbers, count] = sets.numbered();
    std::vector<std::vector<Index>> crests(count);
    for (Index i = 0; i < std::ssize(tops); ++i) {
        crests[numbers[i]].push_back(i);
    }
    std::ranges::stable_sort(crests, std::greater<>(), [&](const std::vector<Index>& crest) {
        return std::ranges::max(each_of<double>(crest, [&](Index i) { return complex.radii[tops[i]]; }));
    });
    return crests;
}

// Does one of the balls along an edge that stays cover one that goes?
bool covers(const MedialComplex& complex, Index edge, Index goes, double cosine) {
    const auto grown = [&](Index v) { return Ball{complex.vertices[v], complex.radii[v] / cosine}; };
    const auto& [p, q] = complex.edges[edge];
    return nearest_ball(Slab(std::array{grown(p), grown(q)}), complex.vertices[goes]).distance <= -complex.radii[goes];
}

// A chain of edges from a free end on, and their vertices but that on which it hangs.
struct Hair {
    std::vector<Index> edges;
    std::vector<Index> vertices;
    Index root = kNone;
};

Hair hair_from(Index end, const MedialComplex& complex, const Remainder& remainder) {
    Hair hair{{}, {}, end};
    Index edge = remainder.only_bare_edge(end);
    do {
        hair.edges.push_back(edge);
        hair.vertices.push_back(hair.root);
        hair.root = other_end(complex.edges[edge], hair.root);
        edge ^= remainder.edges_at_vertex[hair.root].combined;  // the other one there, if there are two
    } while (remainder.edges_at_vertex[hair.root].count == 2);
    return hair;
}

}  // namespace

std::vector<std::uint8_t> crests_of_narrow_sheets(const MedialComplex& complex, std::span<const std::uint8_t> is_narrow,
                                                  double cosine) {
    std::vector<std::uint8_t> stays(complex.vertices.size());
    std::vector<Index> tops = without_steep_edge(complex, is_narrow, cosine);
    erase_covered_by_others(tops, complex, is_narrow, cosine);
    if (tops.empty()) {
        return stays;
    }
    const PointTree tree = build_point_tree(each_of<Point>(tops, [&](Index v) { return complex.vertices[v]; }));
    std::vector<std::uint8_t> is_covered(tops.size());
    for (const std::vector<Index>& crest : connected(tops, complex)) {
        if (std::ranges::all_of(crest, [&](Index i) { return is_covered[i] != 0; })) {
            continue;
        }
        for (const Index i : crest) {
            stays[tops[i]] = 1;
            const Ball ball = ball_at(complex, tops[i]);
            for_each_point_near(tree, ball.center, ball.radius / cosine, [&](Index position, double squared) {
                const Index other = tree.order[position];
                if (covers(complex, tops[i], tops[other], squared, cosine)) {
                    is_covered[other] = 1;
                }
            });
        }
    }
    return stays;
}

void remove_hairs(const MedialComplex& complex, std::span<const std::uint8_t> is_narrow, double cosine,
                  Remainder& remainder) {
    std::vector<Index> ends =
        indices_where(complex.vertices.size(), [&](Index v) { return remainder.only_bare_edge(v) != kNone; });
    if (ends.empty()) {
        return;
    }
    std::ranges::stable_sort(ends, {}, [&](Index v) { return complex.radii[v]; });
    const std::vector<Index> curves = indices_where(complex.edges.size(), [&](Index e) {
        return remainder.has_edge[e] != 0 && remainder.faces_at_edge[e].count == 0;
    });
    const auto middles = each_of<Point>(curves, [&](Index e) {
        return midpoint(complex.vertices[complex.edges[e][0]], complex.vertices[complex.edges[e][1]]);
    });
    const double reach = std::ranges::max(each_of<double>(curves, [&](Index e) {
        const auto& [p, q] = complex.edges[e];
        return std::max(complex.radii[p], complex.radii[q]) / cosine +
               0.5 * distance(complex.vertices[p], complex.vertices[q]);
    }));
    const PointTree tree = build_point_tree(middles);
    for (const Index end : ends) {
        const Hair hair = hair_from(end, complex, remainder);
        const auto is_covered = [&](Index v) {
            bool result = false;
            for_each_point_near(tree, complex.vertices[v], reach, [&](Index position, double) {
                const Index e = curves[tree.order[position]];
                result =
                    result || (remainder.has_edge[e] != 0 && std::ranges::find(hair.edges, e) == hair.edges.end() &&
                               covers(complex, e, v, cosine));
            });
            return result;
        };
        if (is_narrow[hair.root] != 0 && remainder.edges_at_vertex[hair.root].count > 2 &&
            std::ranges::all_of(hair.vertices, is_covered)) {
            for (std::size_t i = 0; i < hair.edges.size(); ++i) {
                remainder.remove_edge(complex, hair.edges[i]);
                remainder.has_vertex[hair.vertices[i]] = 0;
            }
        }
    }
}

}  // namespace scaleaxis::inline v1
