// SPDX-License-Identifier: Apache-2.0
/// \file
/// The restricted Delaunay facets of samples.
#pragma once

#include <array>
#include <vector>

#include "base/parallel.hpp"
#include "scaleaxis/sampling.hpp"

namespace scaleaxis::inline v1 {

/// A cell inside, and the position of its vertex opposite to the facet.
struct RestrictedFacet {
    Index cell;
    int opposite;
};

/// Is facet `opposite` of a cell inside a restricted one?
inline bool is_restricted(const Samples& samples, Index cell, int opposite) {
    const Index neighbor = samples.neighbors[cell][opposite];
    return neighbor == kNone || samples.inside[neighbor] == 0;
}

inline std::array<Index, 3> vertices_of(const Samples& samples, const RestrictedFacet& facet) {
    const std::array<Index, 4>& v = samples.tetrahedra[facet.cell];
    return {v[(facet.opposite + 1) & 3], v[(facet.opposite + 2) & 3], v[(facet.opposite + 3) & 3]};
}

/// All of them, in the order of their cells.
inline std::vector<RestrictedFacet> restricted_facets(const Samples& samples) {
    return collect<std::vector<RestrictedFacet>>(static_cast<Index>(samples.tetrahedra.size()),
                                                 [&](Index cell, std::vector<RestrictedFacet>& out) {
                                                     for (int k = 0; samples.inside[cell] != 0 && k < 4; ++k) {
                                                         if (is_restricted(samples, cell, k)) {
                                                             out.push_back({cell, k});
                                                         }
                                                     }
                                                 });
}

}  // namespace scaleaxis::inline v1
