// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 1: solid → loose δ-sample of its boundary, with the Delaunay tetrahedra inside and outside.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis {

struct SamplingOptions {
    /// Bound `δD` on the radius of every surface Delaunay ball, in units of the solid; > 0.
    double tolerance = 0.0;
    /// Seed of the random choices.
    std::uint64_t seed = 1;
    /// Also refine around samples whose restricted facets do not form one disk, so that the restricted facets become a
    /// closed manifold surface (Boissonnat and Oudot's other criterion), down to surface Delaunay balls of 1/32 of the
    /// tolerance. What is left is counted in `irregular_samples`: places where `∂S` itself is no manifold, or a detail
    /// is smaller than that.
    bool needs_manifold = false;
    /// Also refine where a restricted facet is large for the features of the solid around it: its surface Delaunay ball
    /// is larger than the distance of a corner to its nearer pole (an estimate of the distance to the medial axis,
    /// inside or outside), down to 1/8 of the tolerance. Finds thin parts, gaps and tunnels that the tolerance alone
    /// misses.
    bool suits_features = false;
    /// Also refine where the union of the balls (see `inner_balls`) will be far from `∂S`: the centre of a surface
    /// Delaunay ball becomes a sample where it is deeper in the union than 1/4 of the tolerance, or farther outside,
    /// down to surface Delaunay balls of 1/8 of the tolerance.
    bool limits_deviation = false;
    /// Also refine where the centre of a surface Delaunay ball is farther than this from the plane of its facet, down
    /// to surface Delaunay balls of 1/8 of the tolerance, so that the facets follow sharp edges; in units of the solid,
    /// > 0.
    double facet_distance = std::numeric_limits<double>::infinity();
    /// Segments of sharp edges of `∂S` that are to be edges of the restricted facets; one whose ends are the same is a
    /// corner. Their ends become samples, and so many points between them that every segment is a chain of Delaunay
    /// edges (J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", 1995), but for
    /// pieces of less than 1/16 of the tolerance, near corners with an acute angle.
    std::vector<std::array<Point, 2>> creases{};
    /// The samples that `suits_features`, `limits_deviation` and `facet_distance` take are at most so many times those
    /// that the tolerance alone takes; ≥ 1.
    double growth_limit = 2.0;
    /// More samples than this are an error; ≥ 1. What the triangulation has room for, about, by default.
    Index max_samples = 1 << 26;
};

struct SamplingStatistics {
    Index seeds = 0;              ///< points of the first triangulation
    Index rounds = 0;             ///< batches inserted after it
    Index feature_samples = 0;    ///< samples among these that were inserted to suit the features
    Index deviation_samples = 0;  ///< samples among these that were inserted where balls or facets were far from `∂S`
    bool is_growth_limited = false;  ///< these would have taken more samples than allowed
    Index manifold_samples = 0;      ///< samples among these that were inserted to make the surface a manifold
    Index conflicts = 0;             ///< facets whose labels contradicted the solid, before relabelling (0 is usual)
    Index relabelled = 0;            ///< labels that the solid corrected
    Index restricted_facets = 0;     ///< facets that separate inside from outside
    Index irregular_samples = 0;     ///< samples whose restricted facets form no single disk (bad umbrellas)
    std::int64_t inside_queries = 0;
    std::int64_t crossing_queries = 0;
};

/// A loose δ-sample `P` of `∂S` and the Delaunay tetrahedra of `P`, labelled by the side of their circumcentres.
/// A facet between an inside tetrahedron and an outside one (or none) is a restricted Delaunay facet.
struct Samples {
    std::vector<Point> points;                     ///< #P
    std::vector<std::array<Index, 4>> tetrahedra;  ///< #T×4 vertices, positively oriented
    std::vector<std::array<Index, 4>> neighbors;   ///< #T×4; `[t][k]` lies opposite to vertex `k`; `kNone` at the hull
    std::vector<Point> centers;                    ///< #T circumcentres
    std::vector<double> radii;                     ///< #T circumradii
    std::vector<std::uint8_t> inside;              ///< #T; 1 if the circumcentre lies in `S`
    double tolerance = 0.0;                        ///< the bound that was asked for
    SamplingStatistics statistics;
};

/// Samples `∂S` so that every restricted Delaunay facet has a surface Delaunay ball of radius ≤ `options.tolerance`
/// (Boissonnat and Oudot, "Provably good sampling and meshing of surfaces", 2005), by Delaunay refinement in batches.
/// The solid is asked in batches, from several threads at once.
/// \throws InvalidOption, Cancelled
/// \throws UnusableInput if no boundary was found, if it takes more than `max_samples`, or if the solid contradicts
/// itself so that refinement does not end, or leaves its bounds
SCALEAXIS_EXPORT Samples sample(const Solid& solid, const SamplingOptions& options, const Execution& execution = {});

/// Topology of what the restricted facets bound, if they form a closed manifold surface: where no sample is irregular.
/// It is that of the solid unless the solid has details smaller than the tolerance.
SCALEAXIS_EXPORT std::optional<Topology> topology(const Samples& samples);

}  // namespace scaleaxis
