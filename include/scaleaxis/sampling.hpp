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

namespace scaleaxis::inline v1 {

/// How large surface Delaunay balls may be.
enum class Sizing {
    kAdaptive,  ///< as large as the solid lets them be for its union of balls to be within the tolerance
                ///< (docs/dev/sampling.md)
    kUniform,   ///< no larger than the tolerance, as in the paper
};

struct SamplingOptions {
    /// δ in units of the solid; > 0. `kAdaptive`: how far the union of balls may be from the solid, about.
    /// `kUniform`: bound on the radius of every surface Delaunay ball.
    double tolerance = 0.0;
    Sizing sizing = Sizing::kAdaptive;
    /// Seed of the random choices.
    std::uint64_t seed = 1;
    /// Also refine around samples whose restricted facets do not form one disk, so that the restricted facets become a
    /// closed manifold surface (Boissonnat and Oudot's other criterion), down to surface Delaunay balls of 1/32 of the
    /// tolerance. What is left is counted in `irregular_samples`: places where `∂S` itself is no manifold, or a detail
    /// is smaller than that.
    bool needs_manifold = false;
    /// Also refine where the centre of a surface Delaunay ball is farther than this from the plane of its facet, down
    /// to surface Delaunay balls of 1/8 of the tolerance, so that the facets follow sharp edges; in units of the solid,
    /// > 0.
    double facet_distance = std::numeric_limits<double>::infinity();
    /// Segments of sharp edges of `∂S` that are to be edges of the restricted facets; one whose ends are the same is a
    /// corner. Their ends become samples, and as many points between them as make every segment a chain of Delaunay
    /// edges (J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", 1995), except
    /// pieces of less than 1/16 of the tolerance, near corners with an acute angle.
    std::vector<std::array<Point, 2>> creases{};
    /// `facet_distance` and `creases` may multiply the number of samples that sizes alone take by this at most; ≥ 1.
    double growth_limit = 2.0;
    /// More samples than this are an error; ≥ 1. What the triangulation has room for, about, by default.
    Index max_samples = 1 << 26;
};

struct SamplingStatistics {
    Index seeds = 0;   ///< points of the first triangulation
    Index rounds = 0;  ///< batches inserted after it
    // Facets that `kAdaptive` found too large, each counted for the criterion that allows least:
    Index thickness_facets = 0;   ///< the solid is thin there
    Index gap_facets = 0;         ///< a gap is narrow there
    Index dip_facets = 0;         ///< the union would dip too far between its balls
    Index bent_facets = 0;        ///< they are too far from `∂S`
    Index far_samples = 0;        ///< samples that were inserted where `∂S` was far from the union
    Index deviation_samples = 0;  ///< samples that were inserted where facets were far from `∂S` (`facet_distance`)
    bool is_growth_limited = false;  ///< these would have taken more samples than allowed
    Index manifold_samples = 0;      ///< samples that were inserted to make the surface a manifold
    Index conflicts = 0;             ///< facets whose labels contradicted the solid, before relabelling (0 is usual)
    Index relabelled = 0;            ///< labels that the solid corrected
    Index restricted_facets = 0;     ///< facets that separate inside from outside
    Index irregular_samples = 0;     ///< samples whose restricted facets form no single disk (bad umbrellas)
    /// Restricted facets by circumradius: `[k]` those of up to `2^(k-3)` tolerances that are larger than `[k-1]`.
    std::vector<Index> facet_sizes;
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
    double tolerance = 0.0;                        ///< δ that was asked for
    SamplingStatistics statistics;
};

/// Samples `∂S` so that no restricted Delaunay facet has a surface Delaunay ball that is larger than a sizing field
/// allows (Boissonnat and Oudot, "Provably good sampling and meshing of surfaces", 2005), by Delaunay refinement in
/// batches. `Sizing::kUniform` is the field of the paper, which is constant.
/// The solid is asked in batches, from several threads at once.
/// \throws InvalidOption, Cancelled
/// \throws UnusableInput if no boundary was found, if it takes more than `max_samples`, or if the solid contradicts
/// itself so that refinement does not end, or leaves its bounds
SCALEAXIS_EXPORT Samples sample(const Solid& solid, const SamplingOptions& options, const Execution& execution = {});

/// Topology of what the restricted facets bound, if they form a closed manifold surface: where no sample is irregular.
/// It is that of the solid unless the solid has details smaller than the tolerance.
SCALEAXIS_EXPORT std::optional<Topology> topology(const Samples& samples);

}  // namespace scaleaxis::inline v1
