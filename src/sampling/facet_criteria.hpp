// SPDX-License-Identifier: Apache-2.0
/// \file
/// What makes a restricted facet bad, and the samples that mend it.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sampling/creases.hpp"
#include "sampling/labelled_triangulation.hpp"
#include "sampling/umbrellas.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"
#include "spatial/ball_tree.hpp"

namespace scaleaxis {

/// A restricted facet with its surface Delaunay ball.
struct CrossedFacet {
    Facet vertices{};  ///< ascending: the key of the canonical order
    Point crossing;    ///< of its dual edge and `∂S`: the centre of the ball
    double radius = 0.0;
};

// Facets that are bad.

/// The surface Delaunay ball is larger than the tolerance.
bool is_too_large(const CrossedFacet& facet, double tolerance);

/// The surface Delaunay ball is larger than the distance of a corner to its nearer pole.
/// \param pole_distances of all samples
bool is_too_large_for_features(const CrossedFacet& facet, const std::vector<double>& pole_distances);

/// The crossing is farther than `distance` from the plane of the facet.
bool is_far_from_plane(const CrossedFacet& facet, const LabelledTriangulation& triangulation, double distance);

/// The crossing is farther than `distance` from the boundary of the union of balls, inside of it or outside.
bool is_far_from_balls(const CrossedFacet& facet, const BallTree& balls, double distance);

// Samples to insert: the crossings of bad facets, thinned. None where there is no bad facet. All lengths are in units
// of the solid, and all results independent of the order of cells.

/// Those of fresh facets that are larger than the tolerance: no other facet can have become so. Where labels contradict
/// the solid, they are asked for and corrected. \param statistics counts conflicts, corrected labels and questions
std::vector<Point> size_samples(LabelledTriangulation& triangulation, double tolerance, std::uint64_t seed,
                                SamplingStatistics& statistics);

/// Those that are too large for the features of the solid.
std::vector<Point> feature_samples(const LabelledTriangulation& triangulation, double tolerance, std::uint64_t seed,
                                   SamplingStatistics& statistics);

/// Those that are far from their planes or (`options.limits_deviation`) from the balls of the samples. Only facets are
/// looked at that have a corner at a cell made after round `since`.
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
/// \param attempt how often this was called before; points around samples are looked for closer and closer to them, and
/// at last no more
std::vector<Point> manifold_samples(const LabelledTriangulation& triangulation, double tolerance, Index attempt,
                                    std::uint64_t seed, SamplingStatistics& statistics);

}  // namespace scaleaxis
