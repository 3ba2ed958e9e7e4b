// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/umbrellas.hpp"

#include <algorithm>
#include <atomic>
#include <span>
#include <tuple>
#include <utility>

#include "kernel/parallel.hpp"

namespace scaleaxis {
namespace {

using Edge = std::array<Index, 2>;

// Do the edges (of the link of a vertex) form exactly one closed cycle?
bool is_single_cycle(std::span<const Edge> edges) {
    if (edges.size() < 3) {
        return false;
    }
    const auto next = [&](Index from, std::size_t edge) -> std::pair<Index, std::size_t> {
        const Index to = edges[edge][0] == from ? edges[edge][1] : edges[edge][0];
        std::size_t found = edges.size();
        for (std::size_t other = 0; other < edges.size(); ++other) {
            if (other != edge && (edges[other][0] == to || edges[other][1] == to)) {
                if (found != edges.size()) {
                    return {to, edges.size()};  // three edges meet
                }
                found = other;
            }
        }
        return {to, found};
    };
    Index vertex = edges[0][0];
    std::size_t edge = 0;
    for (std::size_t length = 1; length <= edges.size(); ++length) {
        std::tie(vertex, edge) = next(vertex, edge);
        if (edge == edges.size()) {
            return false;
        }
        if (edge == 0) {
            return length == edges.size();
        }
    }
    return false;
}

}  // namespace

void count_umbrellas(Samples& samples) {
    struct Corner {
        Index vertex;
        Edge opposite;
    };
    const auto corners =
        kernel::collect<std::vector<Corner>>(samples.tetrahedra.size(), [&](std::size_t t, std::vector<Corner>& out) {
            for (int k = 0; samples.inside[t] != 0 && k < 4; ++k) {
                const Index neighbor = samples.neighbors[t][k];
                if (neighbor == kNone || samples.inside[neighbor] == 0) {
                    const auto& v = samples.tetrahedra[t];
                    for (int j = 1; j < 4; ++j) {
                        const int next = j % 3 + 1;
                        const int after = next % 3 + 1;
                        out.push_back({v[(k + j) & 3], {v[(k + next) & 3], v[(k + after) & 3]}});
                    }
                }
            }
        });

    std::vector<Index> offsets(samples.points.size() + 1);
    for (const Corner& corner : corners) {
        ++offsets[corner.vertex + 1];
    }
    for (std::size_t v = 0; v < samples.points.size(); ++v) {
        offsets[v + 1] += offsets[v];
    }
    std::vector<Edge> links(corners.size());
    std::vector<Index> next(offsets.begin(), offsets.end() - 1);
    for (const Corner& corner : corners) {
        links[next[corner.vertex]++] = corner.opposite;
    }
    std::atomic<Index> irregular = 0;
    kernel::for_each_index(samples.points.size(), [&](std::size_t v) {
        const std::span<const Edge> link(links.data() + offsets[v], links.data() + offsets[v + 1]);
        irregular += is_single_cycle(link) ? 0 : 1;
    });
    samples.statistics.restricted_facets = static_cast<Index>(corners.size() / 3);
    samples.statistics.irregular_samples = irregular;
}

}  // namespace scaleaxis
