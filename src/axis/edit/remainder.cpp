// SPDX-License-Identifier: Apache-2.0
#include "axis/edit/remainder.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "axis/complex.hpp"
#include "base/disjoint_sets.hpp"
#include "base/grouped.hpp"
#include "base/vectors.hpp"

namespace scaleaxis::inline v1 {

Remainder::Remainder(const MedialComplex& complex)
    : faces_at_edge(complex.edges.size()),
      edges_at_vertex(complex.vertices.size()),
      has_vertex(complex.vertices.size(), 1),
      has_edge(complex.edges.size(), 1),
      has_face(complex.faces.size(), 1) {
    run_together(
        [&] {
            for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
                for (const Index e : complex.face_edges[f]) {
                    faces_at_edge[e].add(f);
                }
            }
        },
        [&] {
            for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
                for (const Index v : complex.edges[e]) {
                    edges_at_vertex[v].add(e);
                }
            }
        });
}

MedialComplex complex_of(const Remainder& remainder, const MedialComplex& complex) {
    return subcomplex(complex, remainder.has_vertex, remainder.has_edge, remainder.has_face);
}

IndexLists find_curves(const MedialComplex& complex, const Remainder& remainder) {
    const auto bare =
        indices_where(complex.edges.size(), [&](Index e) { return remainder.faces_at_edge[e].count == 0; });
    DisjointSets chains(bare.size());
    for (Index i = 0; i < static_cast<Index>(bare.size()); ++i) {
        for (const Index v : complex.edges[bare[i]]) {
            const Cofaces& at_vertex = remainder.edges_at_vertex[v];
            const Index other = at_vertex.combined ^ bare[i];
            if (at_vertex.count == 2 && remainder.faces_at_edge[other].count == 0) {
                chains.join(i, static_cast<Index>(std::ranges::lower_bound(bare, other) - bare.begin()));
            }
        }
    }
    const std::pair<std::vector<Index>, Index> chain_of = chains.numbered();
    return grouped(static_cast<std::size_t>(chain_of.second), [&](const auto& add) {
        for (std::size_t i = 0; i < bare.size(); ++i) {
            add(chain_of.first[i], bare[i]);
        }
    });
}

}  // namespace scaleaxis::inline v1
