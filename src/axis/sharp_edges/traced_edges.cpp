// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/traced_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/sharp_edges/creases.hpp"
#include "axis/sharp_edges/edge_lines.hpp"
#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Lengths are in tolerances.
// Along an edge, from place to place; nearer ones say the same. With 1 two ends that step towards each other pass.
constexpr double kStep = 0.9;
constexpr double kLinkReach = 2.0;  // so far ahead the next place of an edge may be

// A ball beside an edge sees its faces at the angle of their normals, but for what the union is off: of a hundred balls
// beside the edges of boxes, prisms and cylinders one to five see less than this part of it, and those next to them
// more. With 0.8 of it some lengths are traced from fewer places, half of it saves a quarter as much time.
constexpr double kSeenAngle = 0.7;

// A place on an edge, or a corner.
struct Node {
    Crease crease;                            // without a direction in corners
    Point inside;                             // from where it was seen
    std::array<Index, 2> next{kNone, kNone};  // against and along the direction

    bool is_corner() const { return norm(crease.direction) == 0.0; }
    Point towards(std::size_t side) const { return side == 0 ? -1.0 * crease.direction : crease.direction; }
};

// A side of a place from which the edge goes on to none.
struct End {
    Index node;
    int side;
};

class Tracing {
   public:
    Tracing(const Solid& solid, const SharpEdgeOptions& options) : solid_(solid), options_(options) {}

    std::vector<SharpEdge> run(const std::vector<Point>& points) {
        const std::vector<std::optional<Crease>> creases = creases_near(solid_, points, options_, false);
        std::vector<End> open;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto is_near = [&](const Node& node) {
                return distance(node.crease.place, creases[i]->place) <= kStep * options_.tolerance;
            };
            if (creases[i] && std::ranges::none_of(nodes_, is_near)) {
                open.push_back({static_cast<Index>(nodes_.size()), 0});
                open.push_back({static_cast<Index>(nodes_.size()), 1});
                nodes_.push_back({*creases[i], points[i]});
            }
        }
        if (nodes_.empty()) {
            return {};
        }
        // More than it takes to go around any edge.
        const double most_steps = 4.0 * solid_.bounds().diagonal() / (kStep * options_.tolerance);
        for (double step = 0.0; step < most_steps && !open.empty(); step += 1.0) {
            stop_if_cancelled();
            link(kLinkReach);
            std::erase_if(open, [&](const End& end) { return !is_end(end.node, end.side); });
            open = next_ends(open);
        }
        link(kCreaseReach);
        meet();
        return edges();
    }

   private:
    // Joins ends with the nearest places ahead, those of other ends or corners.
    void link(double reach) {
        const double sight = kLinkReach * options_.tolerance;
        const auto places = each_of<Point>(nodes_, [&](const Node& node) { return node.crease.place; });
        const PointTree tree = build_point_tree(places);
        std::vector<std::tuple<double, Index, int, Index, int>> links;  // distance, place and side of both
        for (Index i = 0; i < static_cast<Index>(nodes_.size()); ++i) {
            for (int side = 0; side < 2; ++side) {
                if (!is_end(i, side)) {
                    continue;
                }
                for_each_point_near(tree, places[i], reach * options_.tolerance, [&](Index at, double squared) {
                    const Index k = tree.order[at];
                    if (k == i || !is_ahead(i, side, places[k])) {
                        return;
                    }
                    const bool is_beyond_sight = squared > sight * sight;
                    for (int other = 0; other < 2; ++other) {
                        if (nodes_[k].is_corner() ? other == 0 && !is_beyond_sight
                                                  : nodes_[k].next[other] == kNone && is_ahead(k, other, places[i]) &&
                                                        (!is_beyond_sight || has_edge_between(i, side, k, other))) {
                            links.emplace_back(squared, i, side, k, other);
                        }
                    }
                });
            }
        }
        std::ranges::sort(links);
        for (const auto& [squared, i, side, k, other] : links) {
            if (nodes_[i].next[side] == kNone && (nodes_[k].is_corner() || nodes_[k].next[other] == kNone)) {
                nodes_[i].next[side] = k;
                if (!nodes_[k].is_corner()) {
                    nodes_[k].next[other] = i;
                }
            }
        }
    }

    // Does the edge go through the middle of the cubic between two ends that look at each other?
    bool has_edge_between(Index i, int side, Index k, int other) const {
        const Node& a = nodes_[i];
        const Node& b = nodes_[k];
        const double length = distance(a.crease.place, b.crease.place);
        return is_convex_at(
            midpoint(a.crease.place, b.crease.place) + (0.125 * length) * (a.towards(side) + b.towards(other)), a);
    }

    bool is_end(Index i, int side) const { return !nodes_[i].is_corner() && nodes_[i].next[side] == kNone; }

    bool is_ahead(Index i, int side, const Point& place) const {
        const Point way = place - nodes_[i].crease.place;
        return dot(way, nodes_[i].towards(side)) >= kSameDirection * norm(way);
    }

    // Near a corner another edge may be what is seen.
    bool goes_on_to(const Crease& crease, Index i, int side) const {
        return is_ahead(i, side, crease.place) &&
               distance(crease.place, nodes_[i].crease.place) <= kLinkReach * options_.tolerance &&
               (norm(crease.direction) == 0.0 ||
                std::abs(dot(crease.direction, nodes_[i].crease.direction)) >= kSameDirection);
    }

    // What is seen some steps ahead of open ends, if it is a place where their edges go on.
    std::vector<std::optional<Crease>> seen_ahead(const std::vector<End>& ends, double steps,
                                                  bool wants_corners) const {
        std::vector<Point> points;
        for (const auto& [i, side] : ends) {
            const Node& node = nodes_[i];
            points.push_back(node.crease.place + kApproach * (node.inside - node.crease.place) +
                             (steps * kStep * options_.tolerance) * node.towards(side));
        }
        std::vector<std::optional<Crease>> creases = creases_near(solid_, points, options_, wants_corners);
        for (std::size_t k = 0; k < ends.size(); ++k) {
            if (creases[k] && !goes_on_to(*creases[k], ends[k].node, ends[k].side)) {
                creases[k].reset();
            }
        }
        return creases;
    }

    // Takes a step from each end, or goes to the corner in which the edge ends. \returns where the steps lead
    std::vector<End> next_ends(const std::vector<End>& ends) {
        const std::vector<std::optional<Crease>> creases = seen_ahead(ends, 1.0, false);
        std::vector<End> next;
        std::vector<End> last;
        for (std::size_t k = 0; k < ends.size(); ++k) {
            const auto& [i, side] = ends[k];
            if (!creases[k]) {
                last.push_back(ends[k]);
                continue;
            }
            // Rims turn: the way inside is that between the faces here.
            const auto& [a, b] = creases[k]->normals;
            const double depth = distance(nodes_[i].inside, nodes_[i].crease.place);
            nodes_.push_back({*creases[k], creases[k]->place - depth * unit(a + b)});
            const Index added = static_cast<Index>(nodes_.size()) - 1;
            nodes_[i].next[side] = added;
            const int back = is_ahead(added, 0, nodes_[i].crease.place) ? 0 : 1;
            nodes_[added].next[back] = i;
            next.push_back({added, 1 - back});
        }
        // Beyond a corner nothing is seen: it is looked for from nearer points as well.
        for (const double steps : {0.5, 0.0, 1.0}) {
            const std::vector<std::optional<Crease>> corners = seen_ahead(last, steps, true);
            std::vector<End> rest;
            for (std::size_t k = 0; k < last.size(); ++k) {
                if (corners[k]) {
                    nodes_[last[k].node].next[last[k].side] = corner_at(corners[k]->place);
                } else {
                    rest.push_back(last[k]);
                }
            }
            last = std::move(rest);
        }
        return next;
    }

    // Ends that have stopped before a place where their edges meet: a corner whose third face is not seen from within,
    // as where a re-entrant edge ends, or one so sharp that no ball near it sees its edges.
    void meet() {
        std::vector<End> ends;
        for (Index i = 0; i < static_cast<Index>(nodes_.size()); ++i) {
            for (int side = 0; side < 2; ++side) {
                if (is_end(i, side)) {
                    ends.push_back({i, side});
                }
            }
        }
        for (std::size_t k = 0; k < ends.size(); ++k) {
            for (std::size_t m = 0; m < k; ++m) {
                const std::optional<Point> place = meeting_of(nodes_[ends[k].node].crease, nodes_[ends[m].node].crease);
                if (place && leads_to(ends[k], *place) && leads_to(ends[m], *place)) {
                    corner_at(*place);
                }
            }
        }
        for (const End& end : ends) {
            Index& next = nodes_[end.node].next[end.side];
            for (const Index corner : corners_) {
                const Point& place = nodes_[corner].crease.place;
                const Point& here = nodes_[end.node].crease.place;
                if ((next == kNone || distance(here, place) < distance(here, nodes_[next].crease.place)) &&
                    leads_to(end, place)) {
                    next = corner;
                }
            }
        }
    }

    // Is a place ahead of an end, or right there, on its line, with the edge in between?
    bool leads_to(const End& end, const Point& place) const {
        const double accuracy = kEdgeAccuracy * options_.tolerance;
        const Node& node = nodes_[end.node];
        const Point way = place - node.crease.place;
        return norm(way) <= kCreaseReach * options_.tolerance && dot(way, node.towards(end.side)) >= -accuracy &&
               norm(cross(way, node.crease.direction)) <= accuracy &&
               is_convex_at(midpoint(place, node.crease.place), node);
    }

    // Is a place on the line of an edge still on the edge?
    bool is_convex_at(const Point& place, const Node& node) const {
        const auto& [a, b] = node.crease.normals;
        const Point little = (kEdgeAccuracy * options_.tolerance) * unit(a + b);
        return solid_.inside(place - little) && !solid_.inside(place + little);
    }

    // Where two edges come as near to each other as places of a corner are, if not in parallel.
    std::optional<Point> meeting_of(const Crease& a, const Crease& b) const {
        const double cosine = dot(a.direction, b.direction);
        if (std::abs(cosine) >= kSameDirection) {
            return std::nullopt;
        }
        const Point way = b.place - a.place;
        const double determinant = 1.0 - cosine * cosine;
        const double along_a = dot(way, a.direction);
        const double along_b = dot(way, b.direction);
        const Point on_a = a.place + ((along_a - cosine * along_b) / determinant) * a.direction;
        const Point on_b = b.place + ((cosine * along_a - along_b) / determinant) * b.direction;
        return distance(on_a, on_b) <= kEdgeAccuracy * options_.tolerance ? std::optional(midpoint(on_a, on_b))
                                                                          : std::nullopt;
    }

    Index corner_at(const Point& place) {
        for (const Index corner : corners_) {
            if (distance(nodes_[corner].crease.place, place) <= kEdgeAccuracy * options_.tolerance) {
                return corner;
            }
        }
        nodes_.push_back({{place, {}, {}}, place});
        corners_.push_back(static_cast<Index>(nodes_.size()) - 1);
        return corners_.back();
    }

    // The corner if the place is nearly there: the way between them would have no direction.
    const Point& place_of(Index i) const {
        for (const Index next : nodes_[i].next) {
            if (next != kNone && nodes_[next].is_corner() &&
                distance(nodes_[i].crease.place, nodes_[next].crease.place) <= kEdgeAccuracy * options_.tolerance) {
                return nodes_[next].crease.place;
            }
        }
        return nodes_[i].crease.place;
    }

    std::vector<SharpEdge> edges() const {
        std::vector<SharpEdge> result;
        for (Index i = 0; i < static_cast<Index>(nodes_.size()); ++i) {
            for (const Index next : nodes_[i].next) {
                if (next != kNone && (i < next || nodes_[next].is_corner()) && place_of(i) != place_of(next)) {
                    result.push_back({{place_of(i), place_of(next)}, nodes_[i].crease.normals});
                }
            }
        }
        return result;
    }

    const Solid& solid_;
    const SharpEdgeOptions& options_;
    std::size_t most_steps_;
    std::vector<Node> nodes_;
    std::vector<Index> corners_;
};

}  // namespace

std::vector<SharpEdge> traced_edges(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options) {
    const std::vector<std::uint8_t> is_on_border = vertices_at_borders(complex);
    std::vector<double> angles(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index v : complex.faces[f]) {
            angles[v] = std::max(angles[v], complex.face_angles[f]);
        }
    }
    std::vector<Point> points;
    for (std::size_t v = 0; v < is_on_border.size(); ++v) {
        if (is_on_border[v] != 0 && angles[v] >= kSeenAngle * options.angle) {
            points.push_back(complex.vertices[v]);
        }
    }
    return Tracing(solid, options).run(points);
}

}  // namespace scaleaxis::inline v1
