// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/bridges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "axis/sharp_edges/border.hpp"
#include "axis/sharp_edges/chains.hpp"
#include "axis/sharp_edges/creases.hpp"
#include "axis/sharp_edges/edge_lines.hpp"
#include "axis/sharp_edges/ways.hpp"
#include "base/grouped.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr double kMostBridgedWidth = 64.0;  // tolerances: longer gaps are not bridged
constexpr double kBridgeStep = 1.0;         // tolerances: how far apart the edge is looked at
constexpr double kBeside = 0.1;             // of the width of a gap: how far from it rows may be that are in it
constexpr double kMaxBridgeStretch = 1.5;   // of a step of the edge, and of the way through the complex

// Two ends between which the edge may go on, and the places that were seen on it.
struct EdgeGap {
    Index from;
    Index to;
    std::vector<Point> places;  // in order, both ends included
};

double way_to_edge(const RowEnd& end, const MedialComplex& complex) {
    return distance(end.place, complex.vertices[end.vertex]);
}

class BridgeSearch {
   public:
    BridgeSearch(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options, double same_place,
                 std::span<const RowEnd> ends, std::unordered_map<Index, RowsOfTarget> rows)
        : complex_(complex),
          solid_(solid),
          options_(options),
          same_place_(same_place),
          ends_(ends),
          rows_(std::move(rows)) {
        for (const RowEnd& end : ends) {
            if (end.is_corner) {
                leaving_[end.target].push_back(end.direction);
            }
        }
    }

    std::vector<Bridge> run() {
        std::vector<EdgeGap> gaps = find_gaps();
        look_at_edges(gaps);
        std::vector<Bridge> bridges;
        for (const EdgeGap& gap : gaps) {
            if (!lead_together(ends_[gap.from], ends_[gap.to])) {
                continue;  // another bridge goes there
            }
            if (Bridge bridge = bridge_over(gap); !bridge.way.empty()) {
                bridges.push_back(std::move(bridge));
            }
        }
        return bridges;
    }

   private:
    // Does an edge without a row go on from an end to a place?
    bool leads_to(const RowEnd& end, const Point& place) const {
        const Point way = place - end.place;
        const auto is_along = [&](const Point& direction) { return dot(way, direction) >= kSameDirection * norm(way); };
        return end.is_corner ? std::ranges::none_of(leaving_.at(end.target), is_along) : is_along(end.direction);
    }

    bool lead_together(const RowEnd& a, const RowEnd& b) const {
        return distance(a.place, b.place) > same_place_ && leads_to(a, b.place) && leads_to(b, a.place);
    }

    // Each end of a row with the nearest that it leads to and that leads to it, or with a corner. Then corners near
    // each other, with no row between them.
    std::vector<EdgeGap> find_gaps() const {
        std::vector<Index> order;
        for (Index i = 0; i < static_cast<Index>(ends_.size()); ++i) {
            order.push_back(i);
        }
        std::ranges::stable_sort(order, {}, [&](Index i) { return ends_[i].place.x; });
        const double most = kMostBridgedWidth * options_.tolerance;
        std::vector<std::pair<double, Index>> nearest(ends_.size(), {most, kNone});
        std::vector<EdgeGap> between_corners;
        for (auto first = order.begin(); first != order.end(); ++first) {
            const RowEnd& a = ends_[*first];
            for (auto second = first + 1; second != order.end() && ends_[*second].place.x - a.place.x <= most;
                 ++second) {
                const RowEnd& b = ends_[*second];
                if (!lead_together(a, b)) {
                    continue;
                }
                const double width = distance(a.place, b.place);
                if (!a.is_corner || !b.is_corner) {
                    nearest[*first] = std::min(nearest[*first], {width, *second});
                    nearest[*second] = std::min(nearest[*second], {width, *first});
                } else if (width <= kCreaseReach * options_.tolerance) {
                    between_corners.push_back({std::min(*first, *second), std::max(*first, *second), {}});
                }
            }
        }
        std::vector<EdgeGap> gaps;
        for (Index i = 0; i < static_cast<Index>(ends_.size()); ++i) {
            const Index other = nearest[i].second;
            if (!ends_[i].is_corner && other != kNone &&
                (ends_[other].is_corner || (nearest[other].second == i && i < other))) {
                gaps.push_back({i, other, {}});
            }
        }
        std::ranges::sort(between_corners, {}, [](const EdgeGap& gap) { return std::pair(gap.from, gap.to); });
        std::ranges::copy_if(between_corners, std::back_inserter(gaps), [&](const EdgeGap& gap) {
            return std::ranges::none_of(ends_,
                                        [&](const RowEnd& end) { return !end.is_corner && lies_in(gap, end.place); });
        });
        return gaps;
    }

    bool lies_in(const EdgeGap& gap, const Point& place) const {
        const Point& a = ends_[gap.from].place;
        const Point way = ends_[gap.to].place - a;
        const double t = std::clamp(dot(place - a, way) / dot(way, way), 0.0, 1.0);
        return distance(place, a + t * way) <= kBeside * norm(way);
    }

    // Keeps the gaps along which the edge is sharp.
    void look_at_edges(std::vector<EdgeGap>& gaps) const {
        std::vector<Point> points;
        std::vector<std::size_t> first_points;
        for (const EdgeGap& gap : gaps) {
            first_points.push_back(points.size());
            const RowEnd& a = ends_[gap.from];
            const RowEnd& b = ends_[gap.to];
            const Point aside_a = kAsideOfEdge * (complex_.vertices[a.vertex] - a.place);
            const Point aside_b = kAsideOfEdge * (complex_.vertices[b.vertex] - b.place);
            const double width = distance(a.place, b.place);
            const int steps = std::max(2, static_cast<int>(std::ceil(width / (kBridgeStep * options_.tolerance))));
            for (int k = 1; k < steps; ++k) {
                const double t = static_cast<double>(k) / steps;
                points.push_back((1.0 - t) * (a.place + aside_a) + t * (b.place + aside_b));
            }
        }
        first_points.push_back(points.size());
        const std::vector<std::optional<Crease>> creases = creases_near(solid_, points, options_, false);
        std::vector<EdgeGap> kept;
        for (std::size_t i = 0; i < gaps.size(); ++i) {
            EdgeGap& gap = gaps[i];
            const Point& end = ends_[gap.to].place;
            gap.places.push_back(ends_[gap.from].place);
            const std::size_t count = first_points[i + 1] - first_points[i];
            const double step = distance(gap.places[0], end) / static_cast<double>(count + 1);
            bool goes_on = true;
            const auto add = [&](const Point& place, const Point& direction) {
                const Point way = place - gap.places.back();
                goes_on = goes_on && norm(way) <= kMaxBridgeStretch * step &&
                          std::abs(dot(way, direction)) >= kSameDirection * norm(way) && norm(way) > same_place_;
                gap.places.push_back(place);
            };
            for (std::size_t k = first_points[i]; k < first_points[i + 1] && goes_on; ++k) {
                goes_on = creases[k].has_value();
                if (goes_on) {
                    add(creases[k]->place, creases[k]->direction);
                }
            }
            if (goes_on) {
                add(end, creases[first_points[i + 1] - 1]->direction);
            }
            if (goes_on) {
                kept.push_back(std::move(gap));
            }
        }
        gaps = std::move(kept);
    }

    Bridge bridge_over(const EdgeGap& gap) {
        const RowEnd& a = ends_[gap.from];
        const RowEnd& b = ends_[gap.to];
        if (neighbors_.empty()) {
            neighbors_ = grouped_both_ways(complex_.vertices.size(), complex_.edges);
            is_taken_.resize(complex_.vertices.size());
        }
        double width = 0.0;
        for (std::size_t k = 1; k < gap.places.size(); ++k) {
            width += distance(gap.places[k - 1], gap.places[k]);
        }
        const double most = kMaxBridgeStretch * (width + way_to_edge(a, complex_) + way_to_edge(b, complex_));
        Bridge bridge{gap.from, gap.to, way_between(a, b, most), {}, {}};
        for (const Index v : bridge.way) {
            const auto [place, position] = nearest_on(gap.places, complex_.vertices[v]);
            bridge.places.push_back(place);
            bridge.positions.push_back(position);
        }
        const std::vector<std::array<std::size_t, 2>> blocks = blocks_of(bridge.positions, same_place_);
        if (blocks.size() < 2) {
            return {};
        }
        for (std::size_t k = 0; k <= blocks.front()[1] + 1; ++k) {
            RowsOfTarget& rows = rows_[a.target];
            (k <= blocks.front()[1] ? rows.feet : rows.others).push_back(bridge.way[k]);
        }
        for (std::size_t k = blocks.back()[0] - 1; k < bridge.way.size(); ++k) {
            RowsOfTarget& rows = rows_[b.target];
            (k >= blocks.back()[0] ? rows.feet : rows.others).push_back(bridge.way[k]);
        }
        leaving_[a.target].push_back(unit(b.place - a.place));
        leaving_[b.target].push_back(unit(a.place - b.place));
        return bridge;
    }

    // The shortest way from a vertex that goes to the one target to one that goes to the other. In between it meets
    // nothing that has an edge to one of them: the strip is glued on along an arc, as it must be.
    std::vector<Index> way_between(const RowEnd& a, const RowEnd& b, double most) {
        const RowsOfTarget& rows_a = rows_[a.target];
        const RowsOfTarget& rows_b = rows_[b.target];
        const auto mark = [&](std::uint8_t value) {
            for (const RowsOfTarget* rows : {&rows_a, &rows_b}) {
                for (const Index v : rows->others) {
                    is_taken_[v] = value;
                }
            }
        };
        mark(1);
        const auto has = [](const std::vector<Index>& vertices, Index v) {
            return std::ranges::find(vertices, v) != vertices.end();
        };
        const auto is_free = [&](Index v) { return is_taken_[v] == 0 || has(rows_a.feet, v) || has(rows_b.feet, v); };
        std::vector<Index> way = shortest_way(complex_, neighbors_, a.vertex, b.vertex, most, is_free);
        mark(0);
        if (way.empty()) {
            return {};
        }
        const auto last_foot = std::find_if(way.rbegin(), way.rend(), [&](Index v) { return has(rows_a.feet, v); });
        way.erase(way.begin(), last_foot.base() - 1);
        way.erase(std::ranges::find_if(way, [&](Index v) { return has(rows_b.feet, v); }) + 1, way.end());
        const bool has_one_foot_each =
            !has(rows_b.feet, way.front()) && !has(rows_b.others, way.front()) && !has(rows_a.others, way.back());
        return has_one_foot_each ? way : std::vector<Index>();
    }

    const MedialComplex& complex_;
    const Solid& solid_;
    const SharpEdgeOptions& options_;
    double same_place_;
    std::span<const RowEnd> ends_;
    std::unordered_map<Index, RowsOfTarget> rows_;
    std::unordered_map<Index, std::vector<Point>> leaving_;  // from corners: ways along edges that have a row
    IndexLists neighbors_;
    std::vector<std::uint8_t> is_taken_;  // of each vertex, for the bridge at hand
};

}  // namespace

std::vector<Bridge> bridges_between(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                                    double same_place, std::span<const RowEnd> ends,
                                    std::unordered_map<Index, RowsOfTarget> rows) {
    return BridgeSearch(complex, solid, options, same_place, ends, std::move(rows)).run();
}

}  // namespace scaleaxis::inline v1
