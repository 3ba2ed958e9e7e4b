// SPDX-License-Identifier: Apache-2.0
/// \file
/// Shortest ways along the edges of a complex.
#pragma once

#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

/// The vertices of the shortest way along edges, both ends included; empty if it is longer than `most`.
/// \param neighbors of each vertex \param is_free may the way go through this vertex? not asked for its ends
template <class IsFree>
std::vector<Index> shortest_way(const MedialComplex& complex, const IndexLists& neighbors, Index from, Index to,
                                double most, const IsFree& is_free) {
    std::unordered_map<Index, std::pair<double, Index>> reached{{from, {0.0, kNone}}};  // length, vertex before
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    front.emplace(0.0, from);
    while (!front.empty() && front.top().second != to) {
        const auto [length, v] = front.top();
        front.pop();
        if (length > reached.at(v).first) {
            continue;
        }
        for (const Index next : neighbors[v]) {
            const double longer = length + distance(complex.vertices[v], complex.vertices[next]);
            if (longer > most || !(next == to || is_free(next))) {
                continue;
            }
            const auto [known, is_new] = reached.try_emplace(next, longer, v);
            if (is_new || longer < known->second.first) {
                known->second = {longer, v};
                front.emplace(longer, next);
            }
        }
    }
    std::vector<Index> way;
    for (Index v = front.empty() ? kNone : to; v != kNone; v = reached.at(v).second) {
        way.push_back(v);
    }
    return {way.rbegin(), way.rend()};
}

}  // namespace scaleaxis
