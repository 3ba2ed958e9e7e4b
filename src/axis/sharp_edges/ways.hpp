// SPDX-License-Identifier: Apache-2.0
/// \file
/// Shortest ways along the edges of a complex.
#pragma once

#include <functional>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// The vertices of the cheapest way along edges, both ends included; empty if there is none.
/// \param neighbors of each vertex \param from where it may begin \param is_goal may it end at this vertex?
/// \param cost_of(v, next) of a step, ≥ 0; infinity: there is none
template <class IsGoal, class CostOf>
std::vector<Index> cheapest_way(const IndexLists& neighbors, std::span<const Index> from, const IsGoal& is_goal,
                                const CostOf& cost_of) {
    std::unordered_map<Index, std::pair<double, Index>> reached;  // cost, vertex before
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    for (const Index v : from) {
        reached[v] = {0.0, kNone};
        front.emplace(0.0, v);
    }
    while (!front.empty() && !is_goal(front.top().second)) {
        const auto [cost, v] = front.top();
        front.pop();
        if (cost > reached.at(v).first) {
            continue;
        }
        for (const Index next : neighbors[v]) {
            const double all = cost + cost_of(v, next);
            if (all == kInfinity) {
                continue;
            }
            const auto [known, is_new] = reached.try_emplace(next, all, v);
            if (is_new || all < known->second.first) {
                known->second = {all, v};
                front.emplace(all, next);
            }
        }
    }
    std::vector<Index> way;
    for (Index v = front.empty() ? kNone : front.top().second; v != kNone; v = reached.at(v).second) {
        way.push_back(v);
    }
    return {way.rbegin(), way.rend()};
}

}  // namespace scaleaxis::inline v1
