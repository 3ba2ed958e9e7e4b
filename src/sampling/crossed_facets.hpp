// SPDX-License-Identifier: Apache-2.0
/// \file
/// Restricted facets with their surface Delaunay balls.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "sampling/labelled_triangulation.hpp"
#include "sampling/questions.hpp"
#include "sampling/umbrellas.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"

namespace scaleaxis::inline v1 {

/// A restricted facet with its surface Delaunay ball.
struct CrossedFacet {
    Facet vertices{};  ///< ascending: the key of the canonical order
    Point crossing;    ///< of its dual edge and `∂S`: the centre of the ball
    double radius = 0.0;
    RestrictedFacet facet{kNone, 0};
};

/// What became of facets that were asked for.
struct AskedFacets {
    std::vector<CrossedFacet> crossed;       ///< those that are wanted
    std::vector<RestrictedFacet> uncrossed;  ///< their dual edges do not cross the surface: a label is wrong
};

inline AskedFacets join(std::vector<AskedFacets>& parts) {
    return {joined(parts, &AskedFacets::crossed), joined(parts, &AskedFacets::uncrossed)};
}

/// Asks for the crossings of facets. \param is_wanted says which to return
template <class IsWanted>
AskedFacets ask_facets(const LabelledTriangulation& triangulation, std::span<const RestrictedFacet> facets,
                       SamplingStatistics& statistics, const IsWanted& is_wanted) {
    statistics.crossing_queries += static_cast<std::int64_t>(facets.size());
    return collect_crossings<AskedFacets>(
        triangulation.solid(), facets.size(), [&](std::size_t f) { return triangulation.dual_edge(facets[f]); },
        [&](std::size_t f, const Chord& chord, const std::optional<Point>& crossing, AskedFacets& out) {
            if (!crossing) {
                out.uncrossed.push_back(facets[f]);
                return;
            }
            const CrossedFacet facet{triangulation.vertices(facets[f]), *crossing, distance(*crossing, chord.reference),
                                     facets[f]};
            if (is_wanted(facet)) {
                out.crossed.push_back(facet);
            }
        });
}

/// The crossed facets that the last `insert` has made, each asked for once. Where labels contradict the solid, they are
/// asked for and corrected. \param spacing of the first samples \param statistics counts conflicts, corrected labels
/// and questions
std::vector<CrossedFacet> ask_fresh_facets(LabelledTriangulation& triangulation, double spacing,
                                           SamplingStatistics& statistics);

/// Brings a list of all crossed facets up to date after an `insert`, likewise: only what is fresh is asked for.
void ask_again(std::vector<CrossedFacet>& facets, LabelledTriangulation& triangulation, double spacing,
               SamplingStatistics& statistics);

}  // namespace scaleaxis::inline v1
