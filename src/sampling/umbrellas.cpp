// SPDX-License-Identifier: Apache-2.0
#include "sampling/umbrellas.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "sampling/restricted_facets.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis::inline v1 {
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

std::vector<Facet> all_facets(const Samples& samples) {
    return each_of<Facet>(restricted_facets(samples),
                          [&](const RestrictedFacet& facet) { return vertices_of(samples, facet); });
}

/// See `SamplingStatistics::facet_sizes`. \param size in tolerances
std::size_t octave_of(double size) {
    constexpr double kMost = 63.0;  // also of flat facets
    if (!(size > 0.0 && std::isfinite(size))) {
        return size > 0.0 ? static_cast<std::size_t>(kMost) : 0;
    }
    int octave = 0;
    const bool is_power = std::frexp(size, &octave) == 0.5;
    return static_cast<std::size_t>(std::clamp(octave - (is_power ? 1.0 : 0.0) + 3.0, 0.0, kMost));
}

}  // namespace

std::vector<Index> irregular_vertices(std::span<const Facet> facets, std::size_t vertices) {
    const Lists<Edge> links = lists_of<Edge>(vertices, [&](const auto& add) {
        for (const Facet& facet : facets) {
            for (int k = 0; k < 3; ++k) {
                add(facet[k], Edge{facet[(k + 1) % 3], facet[(k + 2) % 3]});
            }
        }
    });
    return collect<std::vector<Index>>(vertices, [&](std::size_t v, std::vector<Index>& out) {
        if (!is_single_cycle(links[v])) {
            out.push_back(static_cast<Index>(v));
        }
    });
}

void count_facets(Samples& samples) {
    const std::vector<Facet> facets = all_facets(samples);
    samples.statistics.restricted_facets = static_cast<Index>(facets.size());
    samples.statistics.irregular_samples = static_cast<Index>(irregular_vertices(facets, samples.points.size()).size());
    std::vector<Index>& sizes = samples.statistics.facet_sizes;
    for (const auto& [a, b, c] : facets) {
        const std::size_t octave =
            octave_of(circumradius(samples.points[a], samples.points[b], samples.points[c]) / samples.tolerance);
        sizes.resize(std::max(sizes.size(), octave + 1));
        ++sizes[octave];
    }
}

std::optional<Topology> topology(const Samples& samples) {
    const std::vector<Facet> facets = all_facets(samples);
    if (facets.empty() || !irregular_vertices(facets, samples.points.size()).empty()) {
        return std::nullopt;
    }
    // The parts inside and outside as sets of tetrahedra that share facets; the last one is all beyond the hull.
    const auto tetrahedra = static_cast<Index>(samples.tetrahedra.size());
    const auto is_inside = [&](Index cell) { return cell < tetrahedra && samples.inside[cell] != 0; };
    DisjointSets parts(static_cast<std::size_t>(tetrahedra) + 1);
    for (Index cell = 0; cell < tetrahedra; ++cell) {
        for (const Index neighbor : samples.neighbors[cell]) {
            const Index beyond = neighbor == kNone ? tetrahedra : neighbor;
            if (is_inside(cell) == is_inside(beyond)) {
                parts.join(cell, beyond);
            }
        }
    }
    std::int64_t components = 0;
    std::int64_t voids = -1;
    for (Index cell = 0; cell <= tetrahedra; ++cell) {
        if (parts.find(cell) == cell) {
            ++(is_inside(cell) ? components : voids);
        }
    }
    // A closed surface of F triangles has 3F/2 edges, and twice the Euler characteristic of what it bounds.
    const std::int64_t surface =
        static_cast<std::int64_t>(samples.points.size()) - static_cast<std::int64_t>(facets.size()) / 2;
    const std::int64_t euler = surface / 2;
    return Topology{components, euler, components + voids - euler, voids};
}

}  // namespace scaleaxis::inline v1
