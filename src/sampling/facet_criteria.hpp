// SPDX-License-Identifier: Apache-2.0
/// \file
/// What makes a restricted facet bad, and the samples that mend it.
#pragma once

#include <cstdint>
#include <vector>

#include "sampling/creases.hpp"
#include "sampling/crossed_facets.hpp"
#include "sampling/thin_sizes.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"

namespace scaleaxis::inline v1 {

// Facets that are bad.

/// The surface Delaunay ball is larger than the tolerance.
bool is_too_large(const CrossedFacet& facet, double tolerance);

/// The crossing is farther than `distance` from the plane of the facet.
bool is_far_from_plane(const CrossedFacet& facet, const LabelledTriangulation& triangulation, double distance);

// Samples to insert: the crossings of bad facets, thinned. None where there is no bad facet. All lengths are in units
// of the solid, and all results independent of the order of cells.

/// Those of fresh facets that are larger than the tolerance: no other facet can have become so. \param statistics see
/// `ask_fresh_facets`
std::vector<Point> uniform_samples(LabelledTriangulation& triangulation, double tolerance, std::uint64_t seed,
                                   SamplingStatistics& statistics);

/// Those of facets that are larger than the size field allows, or that are far from their planes.
/// \param facets all of before the last `insert`; becomes all there are now \param largest spacing of the first samples
std::vector<Point> adaptive_samples(LabelledTriangulation& triangulation, std::vector<CrossedFacet>& facets,
                                    double tolerance, double largest, const ThinSizes& thin, std::uint64_t seed,
                                    SamplingStatistics& statistics);

/// Of known points of the boundary those near thin parts, about as far apart as facets may be large there.
std::vector<Point> thin_part_samples(std::span<const Point> points, const ThinSizes& thin, std::uint64_t seed);

/// Not crossings but known points of the boundary that are far from the union of the balls that the samples give: of
/// parts that are too thin for the samples to have a ball there.
/// \param points becomes those that are still far, which alone need to be looked at again
std::vector<Point> far_samples(const LabelledTriangulation& triangulation, std::vector<Point>& points, double tolerance,
                               std::uint64_t seed);

/// Those that are farther than `options.facet_distance` from their planes. Only facets are looked at that have a corner
/// at a cell made after round `since`.
std::vector<Point> deviation_samples(const LabelledTriangulation& triangulation, const SamplingOptions& options,
                                     Index since, SamplingStatistics& statistics);

/// Those that make the pieces of creases edges of restricted facets. A piece whose diametral ball is empty is a
/// Delaunay edge, but where a crease is acute, the cell of a sample on one of its sides can reach the other side, and
/// facets lead past the piece: the crossings of facets at its ends that are not flat; if there are none, the middle of
/// the piece.
std::vector<Point> crease_samples(const LabelledTriangulation& triangulation, const Creases& creases, double tolerance,
                                  std::uint64_t seed, SamplingStatistics& statistics);

/// Those that make the restricted facets more of a manifold: at every sample where they form no disk the crossing of
/// its facet with the largest surface Delaunay ball, and points around samples that have no facet.
/// \param floor smaller facets, in tolerances, stay \param attempt how often this was called before; points around
/// samples are looked for closer and closer to them, and at last no more
std::vector<Point> manifold_samples(const LabelledTriangulation& triangulation, double tolerance, double floor,
                                    Index attempt, std::uint64_t seed, SamplingStatistics& statistics);

}  // namespace scaleaxis::inline v1
