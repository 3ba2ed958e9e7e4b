// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/traced_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
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
#include "spatial/weld.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Lengths are in tolerances.
constexpr double kStep = 0.9;       // along an edge, from place to place; nearer ones say the same
constexpr double kLinkReach = 2.5;  // so far ahead the next place of an edge may be

// A ball beside an edge sees its faces at the angle of their normals, but for what the union is off: of a hundred balls
// beside the edges of boxes, prisms and cylinders one to five see less than this part of it, and those next to them
// more. With 0.8 of it some lengths are traced from fewer places, half of it saves a quarter as much time.
constexpr double kSeenAngle = 0.7;

// A place on an edge.
struct Node {
    Crease crease;
    double depth;                             // of where it was seen from
    std::array<std::uint8_t, 2> is_joined{};  // to the next place against and along the direction
};

// A side of a place.
struct End {
    Index node;
    std::size_t side;
};

class Tracing {
   public:
    Tracing(const Solid& solid, const SharpEdgeOptions& options)
        : solid_(solid), options_(options), accuracy_(kEdgeAccuracy * options.tolerance) {}

    std::vector<SharpEdge> run(const std::vector<Point>& points) {
        start(points);
        // More than it takes to go around any edge.
        const double most_steps = 4.0 * solid_.bounds().diagonal() / (kStep * options_.tolerance);
        std::vector<End> open = ends_of_edges();
        for (double step = 0.0; step < most_steps && !open.empty(); step += 1.0) {
            stop_if_cancelled();
            link(kLinkReach);
            open = next_ends(without_joined(open));
        }
        link(kCreaseReach);
        meet();
        return welded_edges();
    }

   private:
    // Places on the edges near points that are not near each other.
    void start(const std::vector<Point>& points) {
        const std::vector<std::optional<Crease>> creases = creases_near(solid_, points, options_, false);
        const std::vector<Index> seen = indices_where(points.size(), [&](Index i) { return creases[i].has_value(); });
        if (seen.empty()) {
            return;
        }
        const PointTree tree = build_point_tree(each_of<Point>(seen, [&](Index i) { return creases[i]->place; }));
        std::vector<std::uint8_t> is_near(seen.size());
        for (std::size_t k = 0; k < seen.size(); ++k) {
            const Crease& crease = *creases[seen[k]];
            if (is_near[k] == 0) {
                nodes_.push_back({crease, distance(points[seen[k]], crease.place)});
                for_each_point_near(tree, crease.place, kStep * options_.tolerance,
                                    [&](Index at, double) { is_near[tree.order[at]] = 1; });
            }
        }
    }

    const Point& place_at(const End& end) const { return nodes_[end.node].crease.place; }

    Point direction_of(const End& end) const {
        return (end.side == 0 ? -1.0 : 1.0) * nodes_[end.node].crease.direction;
    }

    bool is_joined(const End& end) const { return nodes_[end.node].is_joined[end.side] != 0; }

    std::vector<End> without_joined(std::vector<End> ends) const {
        std::erase_if(ends, [&](const End& end) { return is_joined(end); });
        return ends;
    }

    std::vector<End> ends_of_edges() const {
        std::vector<End> ends;
        for (Index i = 0; i < static_cast<Index>(nodes_.size()); ++i) {
            append(ends, {{i, 0}, {i, 1}});
        }
        return without_joined(std::move(ends));
    }

    void join(const End& end, const Point& place) {
        edges_.push_back({{place_at(end), place}, nodes_[end.node].crease.normals});
        nodes_[end.node].is_joined[end.side] = 1;
    }

    // Joins ends that look at each other, the nearest ones first.
    void link(double reach) {
        const std::vector<End> ends = ends_of_edges();
        if (ends.empty()) {
            return;
        }
        const PointTree tree = build_point_tree(each_of<Point>(ends, [&](const End& end) { return place_at(end); }));
        std::vector<std::tuple<double, std::size_t, std::size_t>> links;  // distance, numbers of the ends
        for (std::size_t k = 0; k < ends.size(); ++k) {
            for_each_point_near(tree, place_at(ends[k]), reach * options_.tolerance, [&](Index at, double) {
                const auto m = static_cast<std::size_t>(tree.order[at]);
                const double way = distance(place_at(ends[k]), place_at(ends[m]));
                if (k < m && ends[k].node != ends[m].node && is_ahead(ends[k], place_at(ends[m])) &&
                    is_ahead(ends[m], place_at(ends[k])) &&
                    (way <= kLinkReach * options_.tolerance || has_edge_between(ends[k], ends[m]))) {
                    links.emplace_back(way, k, m);
                }
            });
        }
        std::ranges::sort(links);
        for (const auto& [way, k, m] : links) {
            if (!is_joined(ends[k]) && !is_joined(ends[m])) {
                join(ends[k], place_at(ends[m]));
                nodes_[ends[m].node].is_joined[ends[m].side] = 1;
            }
        }
    }

    bool is_ahead(const End& end, const Point& place) const {
        const Point way = place - place_at(end);
        return dot(way, direction_of(end)) >= kSameDirection * norm(way);
    }

    // Does the edge go through the middle of the cubic between two ends that look at each other?
    bool has_edge_between(const End& a, const End& b) const {
        const double length = distance(place_at(a), place_at(b));
        return is_convex_at(midpoint(place_at(a), place_at(b)) + (0.125 * length) * (direction_of(a) + direction_of(b)),
                            nodes_[a.node]);
    }

    // Is a place on the line of an edge still on the edge?
    bool is_convex_at(const Point& place, const Node& node) const {
        const auto& [a, b] = node.crease.normals;
        const Point little = accuracy_ * unit(a + b);
        return solid_.inside(place - little) && !solid_.inside(place + little);
    }

    // What is seen some steps ahead of ends, if their edges go on there: near a corner another edge may be seen.
    std::vector<std::optional<Crease>> seen_ahead(const std::vector<End>& ends, double steps,
                                                  bool wants_corners) const {
        const auto points = each_of<Point>(ends, [&](const End& end) {
            const auto& [place, direction, normals] = nodes_[end.node].crease;
            return place - (kApproach * nodes_[end.node].depth) * unit(normals[0] + normals[1]) +
                   (steps * kStep * options_.tolerance) * direction_of(end);
        });
        std::vector<std::optional<Crease>> creases = creases_near(solid_, points, options_, wants_corners);
        // Steps are longer around rims. Two ends that take ones of more than half the reach towards each other pass.
        for (std::size_t k = 0; k < ends.size(); ++k) {
            if (creases[k] &&
                !(is_ahead(ends[k], creases[k]->place) &&
                  distance(creases[k]->place, place_at(ends[k])) <= 0.5 * kLinkReach * options_.tolerance &&
                  (wants_corners || std::abs(dot(creases[k]->direction, direction_of(ends[k]))) >= kSameDirection))) {
                creases[k].reset();
            }
        }
        return creases;
    }

    // Takes a step from each end, or goes to the corner in which the edge ends. \returns where the steps lead
    std::vector<End> next_ends(const std::vector<End>& ends) {
        const std::vector<std::optional<Crease>> creases = seen_ahead(ends, 1.0, false);
        std::vector<End> next;
        for (std::size_t k = 0; k < ends.size(); ++k) {
            if (creases[k]) {
                join(ends[k], creases[k]->place);
                nodes_.push_back({*creases[k], nodes_[ends[k].node].depth});
                const Index added = static_cast<Index>(nodes_.size()) - 1;
                const std::size_t back = is_ahead({added, 0}, place_at(ends[k])) ? 0 : 1;
                nodes_[added].is_joined[back] = 1;
                next.push_back({added, 1 - back});
            }
        }
        // Beyond a corner nothing is seen: it is looked for from nearer points as well.
        for (const double steps : {0.5, 0.0, 1.0}) {
            const std::vector<End> last = without_joined(ends);
            const std::vector<std::optional<Crease>> corners = seen_ahead(last, steps, true);
            for (std::size_t k = 0; k < last.size(); ++k) {
                if (corners[k]) {
                    corners_.push_back(corners[k]->place);
                    join(last[k], corners_.back());
                }
            }
        }
        return next;
    }

    // Ends that have stopped before a place where their edges meet: a corner whose third face is not seen from within,
    // as where a re-entrant edge ends, or one so sharp that no ball near it sees its edges.
    void meet() {
        const std::vector<End> ends = ends_of_edges();
        for (std::size_t k = 0; k < ends.size(); ++k) {
            for (std::size_t m = 0; m < k; ++m) {
                if (std::abs(dot(direction_of(ends[k]), direction_of(ends[m]))) < kSameDirection) {
                    const Point place = meeting_of(nodes_[ends[k].node].crease, nodes_[ends[m].node].crease);
                    if (leads_to(ends[k], place) && leads_to(ends[m], place)) {
                        corners_.push_back(place);
                    }
                }
            }
        }
        for (const End& end : ends) {
            std::optional<Point> nearest;
            for (const Point& corner : corners_) {
                if ((!nearest || distance(place_at(end), corner) < distance(place_at(end), *nearest)) &&
                    leads_to(end, corner)) {
                    nearest = corner;
                }
            }
            if (nearest) {
                join(end, *nearest);
            }
        }
    }

    // Where the line of one edge meets that of another, if they do: there it crosses a face of the other one.
    static Point meeting_of(const Crease& a, const Crease& b) {
        const auto crosses = [&](const Point& normal) { return std::abs(dot(normal, a.direction)); };
        const Point& normal = std::ranges::max(b.normals, {}, crosses);
        return a.place + (dot(normal, b.place - a.place) / dot(normal, a.direction)) * a.direction;
    }

    // Is a place ahead of an end, or right there, on its line, with the edge in between?
    bool leads_to(const End& end, const Point& place) const {
        const Point way = place - place_at(end);
        return norm(way) <= kCreaseReach * options_.tolerance && dot(way, direction_of(end)) >= -accuracy_ &&
               norm(cross(way, direction_of(end))) <= accuracy_ &&
               is_convex_at(midpoint(place, place_at(end)), nodes_[end.node]);
    }

    // Ends find a corner at slightly different places, or lie right beside one: these become one, the corner itself.
    std::vector<SharpEdge> welded_edges() {
        std::vector<Point> points = corners_;
        for (const SharpEdge& edge : edges_) {
            points.insert(points.end(), edge.ends.begin(), edge.ends.end());
        }
        const std::vector<Index> places = weld(points, accuracy_);
        auto place = places.begin() + static_cast<std::ptrdiff_t>(corners_.size());
        for (SharpEdge& edge : edges_) {
            std::ranges::generate(edge.ends, [&] { return points[*place++]; });
        }
        std::erase_if(edges_, [](const SharpEdge& edge) { return edge.ends[0] == edge.ends[1]; });
        return std::move(edges_);
    }

    const Solid& solid_;
    const SharpEdgeOptions& options_;
    double accuracy_;
    std::vector<Node> nodes_;
    std::vector<Point> corners_;
    std::vector<SharpEdge> edges_;
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
