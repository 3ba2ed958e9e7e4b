// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scaleaxis/sampling.hpp"

namespace scaleaxis::inline v1 {

using Facet = std::array<Index, 3>;

/// The vertices, ascending, at which the facets do not form exactly one topological disk.
std::vector<Index> irregular_vertices(std::span<const Facet> facets, std::size_t vertices);

/// Counts the restricted facets, all and by their sizes, and the samples at which they do not form exactly one
/// topological disk: there the restricted surface is no manifold.
void count_facets(Samples& samples);

}  // namespace scaleaxis::inline v1
