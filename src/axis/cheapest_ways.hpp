// SPDX-License-Identifier: Apache-2.0
/// \file
/// Cheapest ways along the edges of a graph.
#pragma once

#include <functional>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The cheapest ways from some vertices to others, up to the first goal (E. Dijkstra, 1959).
struct CheapestWays {
    struct Arrival {
        double cost = 0.0;
        Index previous = kNone;  ///< the vertex before on the way; `kNone`: it begins here
    };
    std::unordered_map<Index, Arrival> arrivals;  ///< at each vertex that was reached
    Index goal = kNone;                           ///< `kNone`: none was reached

    /// \param neighbors of each vertex \param from where ways may begin \param is_goal may they end at this vertex?
    /// \param cost_of(v, next) of a step, ≥ 0; infinity: there is none
    template <class IsGoal, class CostOf>
    CheapestWays(const IndexLists& neighbors, std::span<const Index> from, const IsGoal& is_goal,
                 const CostOf& cost_of) {
        using Entry = std::pair<double, Index>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
        for (const Index v : from) {
            arrivals[v] = {};
            front.emplace(0.0, v);
        }
        while (!front.empty() && goal == kNone) {
            const auto [cost, v] = front.top();
            front.pop();
            if (is_goal(v)) {
                goal = v;
            } else if (cost == arrivals.at(v).cost) {
                for (const Index next : neighbors[v]) {
                    const double all = cost + cost_of(v, next);
                    const auto known = arrivals.find(next);
                    if (all < (known == arrivals.end() ? kInfinity : known->second.cost)) {
                        arrivals[next] = {all, v};
                        front.emplace(all, next);
                    }
                }
            }
        }
    }

    /// The vertices from the start of the way to a vertex that was reached, both included.
    std::vector<Index> way_to(Index v) const {
        std::vector<Index> way;
        for (; v != kNone; v = arrivals.at(v).previous) {
            way.push_back(v);
        }
        return {way.rbegin(), way.rend()};
    }
};

}  // namespace scaleaxis::inline v1
