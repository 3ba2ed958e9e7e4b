// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/chains.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "axis/sharp_edges/ways.hpp"
#include "base/grouped.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr double kMaxDetour = 1.5;          // of the way between vertices with the same corner
constexpr double kMaxArrivalStretch = 3.0;  // an edge of the border, where it arrives

constexpr double kMostAside = 0.1;     // tolerances: from the line of an edge, but for its turn
constexpr double kTurnToCorner = 0.2;  // sine: of an edge up to a corner

class CornerSearch {
   public:
    CornerSearch(const MedialComplex& complex, Border& border, double same_place)
        : complex_(complex), border_(border), same_place_(same_place) {}

    CornerTrees run() && {
        result_.sets = DisjointSets(complex_.vertices.size());
        for (const auto& [a, b] : border_.edges) {
            join_beside(border_.vertices[a].vertex, border_.vertices[b].vertex);
        }
        for (const auto& [p, q] : complex_.edges) {
            join_beside(p, q);
        }
        std::vector<Index> known;
        for (const BorderVertex& at : border_.vertices) {
            if (at.corner) {
                known.push_back(at.vertex);
            }
        }
        std::ranges::stable_sort(known, {}, [&](Index v) { return corner_of(v)->place.x; });
        for (std::size_t i = 0; i < known.size(); ++i) {
            for (std::size_t k = i + 1; k < known.size() && are_close_in_x(known[i], known[k]); ++k) {
                if (have_same_corner(known[i], known[k]) &&
                    result_.sets.find(known[i]) != result_.sets.find(known[k])) {
                    join_by_way(known[i], known[k]);
                }
            }
        }
        result_.of_set.assign(complex_.vertices.size(), kNone);
        for (Index i = 0; i < static_cast<Index>(border_.vertices.size()); ++i) {
            if (border_.vertices[i].corner) {
                Index& of_set = result_.of_set[result_.sets.find(border_.vertices[i].vertex)];
                of_set = of_set == kNone ? i : of_set;
            }
        }
        for (BorderVertex& at : border_.vertices) {
            if (const Index other = result_.of_set[result_.sets.find(at.vertex)]; other != kNone) {
                at.corner = border_.vertices[other].corner;
            }
        }
        return std::move(result_);
    }

   private:
    const std::optional<Crease>& corner_of(Index v) const {
        static const std::optional<Crease> kNothing;
        const Index position = border_.positions[v];
        return position == kNone ? kNothing : border_.vertices[position].corner;
    }

    bool are_close_in_x(Index p, Index q) const {
        return std::abs(corner_of(p)->place.x - corner_of(q)->place.x) <= same_place_;
    }

    bool have_same_corner(Index p, Index q) const {
        const std::optional<Crease>& a = corner_of(p);
        const std::optional<Crease>& b = corner_of(q);
        return a && b && distance(a->place, b->place) <= same_place_;
    }

    void join_beside(Index p, Index q) {
        if (have_same_corner(p, q) && result_.sets.join(p, q)) {
            result_.tree_edges.push_back({p, q});
        }
    }

    // May a way to the corner of `from` go through `v`? Not where it would meet another corner's.
    bool is_free(Index from, Index v) {
        return (!corner_of(v) || have_same_corner(from, v)) &&
               (is_on_way_.empty() || is_on_way_[v] == 0 || result_.sets.find(v) == result_.sets.find(from));
    }

    void join_by_way(Index from, Index to) {
        if (neighbors_.empty()) {
            neighbors_ = grouped_both_ways(complex_.vertices.size(), complex_.edges);
        }
        const double most = kMaxDetour * distance(complex_.vertices[from], complex_.vertices[to]);
        const std::vector<Index> way =
            shortest_way(complex_, neighbors_, from, to, most, [&](Index v) { return is_free(from, v); });
        is_on_way_.resize(complex_.vertices.size());
        for (std::size_t k = 1; k < way.size(); ++k) {
            is_on_way_[way[k]] = 1;
            if (result_.sets.join(way[k - 1], way[k])) {
                result_.tree_edges.push_back({way[k], way[k - 1]});
            }
        }
    }

    const MedialComplex& complex_;
    Border& border_;
    double same_place_;
    IndexLists neighbors_;
    std::vector<std::uint8_t> is_on_way_;  // of each vertex, once there is a way
    CornerTrees result_{DisjointSets(0), {}, {}};
};

class Chains {
   public:
    Chains(const MedialComplex& complex, const Border& border, CornerTrees& corners, double tolerance,
           double same_place)
        : complex_(complex), border_(border), corners_(corners), tolerance_(tolerance), same_place_(same_place) {}

    std::vector<Chain> run() {
        std::vector<std::array<Index, 2>> links;
        for (const auto& [a, b] : border_.edges) {
            if (goes_along(a, b)) {
                links.push_back({a, b});
            }
        }
        links_ = grouped(border_.vertices.size(), [&](const auto& add) {
            for (Index link = 0; link < static_cast<Index>(links.size()); ++link) {
                add(links[link][0], link);
                add(links[link][1], link);
            }
        });
        is_used_.assign(links.size(), 0);
        for (const bool wants_closed : {false, true}) {
            for (Index i = 0; i < static_cast<Index>(border_.vertices.size()); ++i) {
                for (const Index link : links_[i]) {
                    if (is_used_[link] == 0 && (wants_closed || is_end(i))) {
                        follow(i, link, links);
                    }
                }
            }
        }
        return std::move(result_);
    }

   private:
    const BorderVertex& vertex(Index i) const { return border_.vertices[i]; }
    const Crease& crease(Index i) const { return vertex(i).corner ? *vertex(i).corner : *vertex(i).crease; }
    const Point& place(Index i) const { return crease(i).place; }
    bool is_end(Index i) const { return vertex(i).corner || links_[i].size() != 2; }

    // Do an edge of the border and the line between the places of its ends lead the same way?
    bool goes_along(Index a, Index b) {
        if (!(vertex(a).corner || vertex(a).crease) || !(vertex(b).corner || vertex(b).crease)) {
            return false;
        }
        if (vertex(a).corner && vertex(b).corner) {
            return corners_.sets.find(vertex(a).vertex) != corners_.sets.find(vertex(b).vertex);
        }
        const Point way = place(b) - place(a);
        const double length = norm(way);
        const double length_before = distance(complex_.vertices[vertex(a).vertex], complex_.vertices[vertex(b).vertex]);
        const bool is_to_corner = vertex(a).corner || vertex(b).corner;
        if (length > kMaxArrivalStretch * length_before + (is_to_corner ? kCreaseReach : 0.5) * tolerance_) {
            return false;
        }
        const auto agrees = [&](Index i) {
            return vertex(i).corner || length <= same_place_ ||
                   std::abs(dot(way, crease(i).direction)) >= kSameDirection * length;
        };
        return agrees(a) && agrees(b) && are_on_one_edge(a, b);
    }

    // From one edge of a narrow face to the other one no strip leads.
    bool are_on_one_edge(Index a, Index b) const {
        const Point way = place(b) - place(a);
        const Point& direction = crease(vertex(a).corner ? b : a).direction;
        const double aside = norm(way - dot(way, direction) * direction);
        const bool is_to_corner = vertex(a).corner || vertex(b).corner;
        const double turn = is_to_corner ? kTurnToCorner : norm(cross(direction, crease(b).direction));
        return aside <= kMostAside * tolerance_ + turn * norm(way);
    }

    void follow(Index start, Index link, const std::vector<std::array<Index, 2>>& links) {
        Chain chain;
        chain.at.push_back(start);
        Index here = start;
        while (link != kNone) {
            is_used_[link] = 1;
            here = links[link][0] == here ? links[link][1] : links[link][0];
            chain.at.push_back(here);
            link = kNone;
            if (!is_end(here)) {
                for (const Index next : links_[here]) {
                    if (is_used_[next] == 0) {
                        link = next;
                    }
                }
            }
        }
        if (here == start && !vertex(start).corner) {
            chain.is_closed = true;
            chain.at.pop_back();
        }
        measure(chain);
        result_.push_back(std::move(chain));
    }

    // Positions along the edge, whose direction is that of the step before.
    void measure(Chain& chain) const {
        Point direction{};
        double position = 0.0;
        chain.positions.push_back(position);
        for (std::size_t k = 1; k < chain.at.size(); ++k) {
            const Point way = place(chain.at[k]) - place(chain.at[k - 1]);
            const Index known = vertex(chain.at[k]).corner ? chain.at[k - 1] : chain.at[k];
            Point along = vertex(known).corner ? unit(way) : crease(known).direction;
            if (dot(along, direction == Point{} ? way : direction) < 0.0) {
                along = -1.0 * along;
            }
            direction = along;
            position += dot(way, along);
            chain.positions.push_back(position);
        }
        if (position < 0.0) {
            for (double& p : chain.positions) {
                p = -p;
            }
        }
    }

    const MedialComplex& complex_;
    const Border& border_;
    CornerTrees& corners_;
    double tolerance_;
    double same_place_;
    IndexLists links_;
    std::vector<std::uint8_t> is_used_;
    std::vector<Chain> result_;
};

}  // namespace

std::vector<std::array<std::size_t, 2>> blocks_of(const std::vector<double>& positions, double same_place) {
    struct Block {
        std::size_t first;
        std::size_t last;
        double mean;
    };
    std::vector<Block> blocks;
    for (std::size_t k = 0; k < positions.size(); ++k) {
        blocks.push_back({k, k, positions[k]});
        while (blocks.size() > 1 && blocks[blocks.size() - 2].mean >= blocks.back().mean - same_place) {
            const Block block = blocks.back();
            blocks.pop_back();
            Block& before = blocks.back();
            const auto size = static_cast<double>(block.last - block.first + 1);
            const auto size_before = static_cast<double>(before.last - before.first + 1);
            before.mean = (size_before * before.mean + size * block.mean) / (size_before + size);
            before.last = block.last;
        }
    }
    std::vector<std::array<std::size_t, 2>> result;
    for (const Block& block : blocks) {
        result.push_back({block.first, block.last});
    }
    return result;
}

CornerTrees corners_of(const MedialComplex& complex, Border& border, double same_place) {
    return CornerSearch(complex, border, same_place).run();
}

std::vector<Chain> chains_of(const MedialComplex& complex, const Border& border, CornerTrees& corners, double tolerance,
                             double same_place) {
    return Chains(complex, border, corners, tolerance, same_place).run();
}

}  // namespace scaleaxis::inline v1
