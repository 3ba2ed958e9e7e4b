// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/curve_fire.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "axis/edit/collapse.hpp"

namespace scaleaxis::inline v1 {

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
    const auto length_at = [&](const Arrived& here, Index to) {
        return distance(complex.vertices[here.tip], complex.vertices[to]);  // chains of edges zigzag
    };
    const auto time_at = [&](const Arrived& here, Index from, Index to) {
        return std::max({start_times[here.tip] + length_at(here, to), here.time, start_times[from]});
    };
    const auto key_of = [&](const ElementaryCollapse& collapse) {
        const auto& [has_face, edge, from] = collapse;
        if (has_face) {
            return std::optional<double>();
        }
        Arrived& here = arrived[from];
        if (here.tip == kNone) {
            here = {start_times[from], from, kNone, {}};
        }
        return std::optional(time_at(here, from, other_end(complex.edges[edge], from)));
    };
    const auto burn = [&](const ElementaryCollapse& collapse, std::optional<double> key) {
        const double time = *key;
        const auto& [has_face, edge, from] = collapse;
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
    };
    Collapses collapses(complex, remainder, key_of, burn);
    collapses.add_all();
    collapses.run();
    return result;
}

}  // namespace scaleaxis::inline v1
