// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/umbrellas.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "kernel/parallel.hpp"
#include "sampling/restricted_facets.hpp"

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

std::vector<Index> irregular_vertices(std::span<const Facet> facets, std::size_t vertices) {
    std::vector<Index> offsets(vertices + 1);
    for (const Facet& facet : facets) {
        for (const Index v : facet) {
            ++offsets[v + 1];
        }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        offsets[v + 1] += offsets[v];
    }
    std::vector<Edge> links(3 * facets.size());
    std::vector<Index> next(offsets.begin(), offsets.end() - 1);
    for (const Facet& facet : facets) {
        for (int k = 0; k < 3; ++k) {
            links[next[facet[k]]++] = {facet[(k + 1) % 3], facet[(k + 2) % 3]};
        }
    }
    return kernel::collect<std::vector<Index>>(vertices, [&](std::size_t v, std::vector<Index>& out) {
        const std::span<const Edge> link(links.data() + offsets[v], links.data() + offsets[v + 1]);
        if (!is_single_cycle(link)) {
            out.push_back(static_cast<Index>(v));
        }
    });
}

void count_umbrellas(Samples& samples) {
    std::vector<Facet> facets;
    for (const RestrictedFacet& facet : restricted_facets(samples)) {
        facets.push_back(vertices_of(samples, facet));
    }
    samples.statistics.restricted_facets = static_cast<Index>(facets.size());
    samples.statistics.irregular_samples = static_cast<Index>(irregular_vertices(facets, samples.points.size()).size());
}

}  // namespace scaleaxis
