// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/curve_fire.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/parallel.hpp"

namespace scaleaxis {

std::vector<BurntEdge> burn_curves(const MedialComplex& complex, const std::vector<double>& start_times,
                                   Remainder remainder) {
    struct Arrived {
        double time = -std::numeric_limits<double>::infinity();
        Index tip = kNone;         // from which the fire came last
        Index feeder = kNone;      // on this edge
        std::vector<Index> edges;  // all on which it came
    };
    std::vector<BurntEdge> result;
    std::unordered_map<Index, Arrived> arrived;
    using Event = std::tuple<double, Index, Index>;  // time, edge, vertex that it burns from
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
    const auto length_at = [&](const Arrived& here, Index to) {
        return distance(complex.vertices[here.tip], complex.vertices[to]);  // chains of edges zigzag
    };
    const auto time_at = [&](const Arrived& here, Index from, Index to) {
        return std::max({start_times[here.tip] + length_at(here, to), here.time, start_times[from]});
    };
    const auto burn_on_from = [&](Index v) {
        if (remainder.edges_at_vertex[v].count != 1) {
            return;
        }
        const Index edge = remainder.edges_at_vertex[v].combined;
        if (remainder.faces_at_edge[edge].count != 0) {
            return;
        }
        Arrived& here = arrived[v];
        if (here.tip == kNone) {
            here = {start_times[v], v, kNone, {}};
        }
        events.emplace(time_at(here, v, other_end(complex.edges[edge], v)), edge, v);
    };
    for (Index v = 0; v < static_cast<Index>(complex.vertices.size()); ++v) {
        burn_on_from(v);
    }
    CancellationPoint stop_if_cancelled_now_and_then;
    while (!events.empty()) {
        stop_if_cancelled_now_and_then();
        const auto [time, edge, from] = events.top();
        events.pop();
        if (remainder.has_edge[edge] == 0) {
            continue;
        }
        const Index to = other_end(complex.edges[edge], from);
        const auto number = static_cast<Index>(result.size());
        const Arrived here = std::move(arrived[from]);
        const double length = length_at(here, to);
        result.push_back({edge, from, to, here.feeder, kNone, length, time});
        for (const Index before : here.edges) {
            result[before].next = number;
        }
        Arrived& there = arrived[to];
        there.edges.push_back(number);
        if (time > there.time) {
            there.time = time;
            there.tip = here.tip;
            there.feeder = number;
        }
        remainder.remove_edge(complex, edge);
        burn_on_from(to);
    }
    return result;
}

}  // namespace scaleaxis
