// SPDX-License-Identifier: Apache-2.0
#include "sampling/crossed_facets.hpp"

#include <algorithm>
#include <iterator>

namespace scaleaxis::inline v1 {
namespace {

// Where the samples are sparser than labels rely on, labels are in doubt whose circumspheres are smaller than this, in
// spacings of the first samples: the group of a larger one has been asked for at one that is deeper still.
constexpr double kDoubtfulRadius = 3.0;

/// The cells on both sides of facets, in pairs.
std::vector<Index> cells_beside(const LabelledTriangulation& triangulation, std::span<const RestrictedFacet> facets) {
    std::vector<Index> cells;
    for (const RestrictedFacet& facet : facets) {
        const Index neighbor = triangulation.neighbor(facet);
        append(cells, {facet.cell, neighbor != kNone ? neighbor : facet.cell});
    }
    return cells;
}

/// Facets that no label explains: their dual edges cross the surface nowhere, although one end was said to be inside
/// and the other one outside. Their circumcentres lie on the surface to within rounding, and bisection finds it.
std::vector<CrossedFacet> bisected(const LabelledTriangulation& triangulation,
                                   std::span<const RestrictedFacet> facets) {
    constexpr int kSteps = 60;
    std::vector<Point> inside(facets.size());
    std::vector<Point> outside(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const Chord chord = triangulation.dual_edge(facets[f]);
        inside[f] = chord.inside_end;
        outside[f] = chord.outside_end;
    }
    std::vector<Point> middles(facets.size());
    for (int step = 0; step < kSteps && !facets.empty(); ++step) {
        std::ranges::transform(inside, outside, middles.begin(), midpoint);
        const std::vector<std::uint8_t> sides = sides_of(triangulation.solid(), middles);
        for (std::size_t f = 0; f < facets.size(); ++f) {
            (sides[f] != 0 ? inside : outside)[f] = middles[f];
        }
    }
    std::vector<CrossedFacet> result;
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const Facet vertices = triangulation.vertices(facets[f]);
        result.push_back({vertices, inside[f], distance(inside[f], triangulation.point(vertices[0])), facets[f]});
    }
    return result;
}

}  // namespace

// If the solid corrects a label beside an uncrossed facet, the samples are sparser than labels rely on, and it is asked
// for every fresh cell near the surface; if that was not enough, for all of them.
std::vector<CrossedFacet> ask_fresh_facets(LabelledTriangulation& triangulation, double spacing,
                                           SamplingStatistics& statistics) {
    const auto ask = [&] {
        return ask_facets(triangulation, triangulation.fresh_restricted_facets(), statistics,
                          [](const CrossedFacet&) { return true; });
    };
    const auto relabel = [&](std::span<const Index> cells) {
        const Index corrected = triangulation.relabel(cells);
        statistics.relabelled += corrected;
        return corrected > 0;
    };
    AskedFacets facets = ask();
    statistics.conflicts += static_cast<Index>(facets.uncrossed.size());
    if (relabel(cells_beside(triangulation, facets.uncrossed))) {
        std::vector<Index> doubtful;
        std::ranges::copy_if(triangulation.fresh_cells(), std::back_inserter(doubtful),
                             [&](Index cell) { return triangulation.radius(cell) <= kDoubtfulRadius * spacing; });
        relabel(doubtful);
        facets = ask();
        if (relabel(cells_beside(triangulation, facets.uncrossed))) {
            relabel(triangulation.fresh_cells());
            facets = ask();
        }
    }
    append(facets.crossed, bisected(triangulation, facets.uncrossed));
    return std::move(facets.crossed);
}

void ask_again(std::vector<CrossedFacet>& facets, LabelledTriangulation& triangulation, double spacing,
               SamplingStatistics& statistics) {
    const Index corrected = statistics.relabelled;
    std::erase_if(facets, [&](const CrossedFacet& facet) { return !triangulation.is_left(facet.facet); });
    const std::vector<CrossedFacet> fresh = ask_fresh_facets(triangulation, spacing, statistics);
    if (statistics.relabelled == corrected) {
        append(facets, fresh);
        return;
    }
    // Labels of older cells may have changed, too.
    AskedFacets all = ask_facets(triangulation, triangulation.restricted_facets(), statistics,
                                 [](const CrossedFacet&) { return true; });
    facets = std::move(all.crossed);
    append(facets, bisected(triangulation, all.uncrossed));
}

}  // namespace scaleaxis::inline v1
