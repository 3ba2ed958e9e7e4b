// SPDX-License-Identifier: Apache-2.0
/// \file
/// The whole pipeline in one call: solid, δ, s → discrete scale axis.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scaleaxis/balls.hpp"
#include "scaleaxis/centering.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/delta.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/fit.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/ranges.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/shrinking.hpp"
#include "scaleaxis/simplification.hpp"
#include "scaleaxis/smoothing.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// What makes a part of the axis worth keeping.
enum class Method {
    kScale,   ///< the discrete scale axis: growing by `scales`, and the filter by `filter_angle`, which keeps the
              ///< topology
    kAngle,   ///< for comparison: the medial axis, and of it what has an object angle of `filter_angle` at least
    kLambda,  ///< for comparison: the medial axis, and of it what has a circumradius of `lambda` at least
};

/// Which balls stand for the solid.
enum class UnionKind {
    kPolar,   ///< polar balls of the samples, as the paper has them: `inner_balls`
    kFitted,  ///< the same fitted to the solid itself, and repaired until the union has its topology: `fit`, `repair`;
              ///< for solids that know the nearest points of their boundary
};

/// How compact an axis is to be: see `SimplifyOptions`.
struct CompactOptions {
    /// Relative to the diagonal of the solid's bounding box or absolute, > 0; unset: a quarter of δ, or if there is a
    /// number of vertices as large as that asks for.
    std::optional<Length> error = {};
    std::optional<Index> vertices = {};
};

/// Ranges: `ranges.hpp`. An option that has no effect is refused.
struct ScaleAxisOptions {
    /// Tolerance δ of the sampling, relative to the diagonal of the solid's bounding box or absolute; unset:
    /// `kDefaultDelta`.
    std::optional<Length> delta = {};
    /// In place of `delta`: the coarsest tolerance of a range that meets the requirements of `choose_delta`.
    std::optional<DeltaRange> delta_range = {};
    /// Unset: `default_union`.
    std::optional<UnionKind> union_kind = {};
    Method method = Method::kScale;
    /// Scales s; at least one. All of them share the sampling. The local methods, which grow nothing, need {1}.
    std::vector<double> scales{1.1};
    /// Object angle below which sheets are spurious, degrees; 0 keeps everything; unset: `FilterOptions::angle`. Not
    /// for `Method::kLambda`.
    std::optional<double> filter_angle = {};
    /// λ of `Method::kLambda`, the radius of the smallest ball around the closest boundary points, relative to the
    /// diagonal of the solid's bounding box or absolute; unset: `kDefaultLambda`.
    std::optional<Length> lambda = {};
    /// Whether sheets go on from the filtered axis into convex sharp edges of the solid (see `extend_to_sharp_edges`).
    /// Has an effect with fitted balls and `Method::kScale` only.
    bool reaches_sharp_edges = true;
    /// Least angle between the normals at such an edge, degrees; unset: see `sharp_angle_of`.
    std::optional<double> sharp_angle = {};
    /// Erosion thickness below which parts of sheets are spurious (see `CleanOptions`), relative to the diagonal of the
    /// solid's bounding box or absolute; 0: nothing is cleaned; unset: half of δ for `Method::kScale`, else 0.
    std::optional<Length> cleaning = {};
    /// Samples the axis until its balls overlap well (see `densify`), as the paper does; else it is a medial mesh,
    /// which keeps the vertices of the filtered medial axis.
    bool is_dense = false;
    /// Rounds of smoothing of the sheets' boundaries and of curves; unset: `kDefaultSmoothing` if the axis is cleaned,
    /// else 0.
    std::optional<Index> smoothing_rounds = {};
    /// Whether the balls of the axis are made to touch the solid (see `center`). Has an effect with fitted balls where
    /// the axis is cleaned, unless it is dense.
    bool is_centered = true;
    /// Simplifies the axis to a compact medial mesh.
    std::optional<CompactOptions> compact = {};
    /// How large the facets between samples may be.
    Sizing sizing = Sizing::kAdaptive;
    /// Whether the result holds the samples.
    bool keeps_samples = false;
    /// Seed of sampling and perturbation.
    std::uint64_t seed = 1;
};

inline constexpr Length kDefaultDelta = Length::relative(0.01);
inline constexpr Length kDefaultLambda = Length::relative(0.02);
inline constexpr Index kDefaultSmoothing = 40;

/// Time and memory that one stage took.
struct StageCost {
    std::string stage;
    double seconds = 0.0;
    std::uint64_t peak_memory = 0;  ///< of the process up to the end of the stage, bytes; 0 if unknown
};

/// The largest resident memory that the process has had so far, in bytes; 0 if the system does not tell.
SCALEAXIS_EXPORT std::uint64_t peak_memory();

/// Fitted balls for solids that know the nearest points of their boundary, polar ones for others.
SCALEAXIS_EXPORT UnionKind default_union(const Solid& solid);

struct UnionOptions {
    /// Unset: `default_union`.
    std::optional<UnionKind> kind = {};
    /// Topology of the solid; unset: not known.
    std::optional<Topology> topology = {};
    std::uint64_t seed = 1;
    /// Whether fitted balls stay that the error does not need, as candidates for another choice.
    bool keeps_all = false;
};

/// The union of balls that stands for a solid.
struct SolidUnion {
    std::vector<Ball> balls;
    std::vector<Contacts> contacts;  ///< of each ball, if they were fitted; else empty
    std::optional<FitReport> fit;    ///< if they were fitted
    std::vector<StageCost> costs;
    std::vector<Diagnostic> warnings;
};

/// Samples → balls as `scale_axis` takes them: `inner_balls`, and where balls are fitted `fit`, a choice of as many as
/// it takes for the error, and `repair`. If the
/// kind is not given, and the solid turns out to contradict itself about nearest points, polar balls are taken, with a
/// warning.
/// \throws UnusableInput, Cancelled
SCALEAXIS_EXPORT SolidUnion union_of(const Samples& samples, const Solid& solid, const UnionOptions& options = {},
                                     const Execution& execution = {});

/// Samples of a solid, and the union of balls that stands for it.
struct SampledUnion {
    Samples samples;
    SolidUnion balls;
    std::optional<Topology> topology;  ///< of the solid; where it does not know, of its samples, if that is known
    std::vector<StageCost> costs;      ///< of samples and balls
};

/// `sample` and `union_of`; balls of uniform samples are all kept. \param options its topology has no effect \throws as
/// these
SCALEAXIS_EXPORT SampledUnion sampled_union(const Solid& solid, const SamplingOptions& sampling,
                                            const UnionOptions& options = {}, const Execution& execution = {});

struct ChosenUnion {
    SampledUnion chosen;
    DeltaChoice choice;
};

/// Samples a solid and makes the union of balls with the coarsest tolerance for which
/// - the union has the topology of the solid. Where the solid does not know it: that of the surface that the samples
///   span, if this is a manifold, and the next finer tolerance leads to the same;
/// - no sample is farther than the tolerance from the union.
/// If no tolerance meets both, the finest one is taken that led to a union, with a warning that says what fails.
/// \param sampling its tolerance has no effect \param options its topology has no effect
/// \throws as `sampled_union`; InvalidOption if the range is none, or leaves `kDeltaRange`
SCALEAXIS_EXPORT ChosenUnion choose_delta(const Solid& solid, const DeltaRange& range = {},
                                          const SamplingOptions& sampling = {}, const UnionOptions& options = {},
                                          const Execution& execution = {});

/// How far the boundary of a solid and that of the envelope of its axis are from each other, in the units of the solid.
struct EnvelopeAccuracy {
    /// From points of the boundary of the solid half of δ apart, at most; from its samples where it does not know the
    /// nearest points of its boundary.
    double solid_to_envelope = 0.0;
    double mean_solid_to_envelope = 0.0;  ///< from the samples
    /// From points of the envelope no farther apart than half of δ, at most; unset where the solid does not know the
    /// nearest points of its boundary.
    std::optional<double> envelope_to_solid = {};
    std::optional<double> mean_envelope_to_solid = {};
};

/// The discrete scale axis for one s, the `scale` of its complex.
struct AxisAtScale {
    /// Vertices and radii are the balls of the simplified solid; its faces, edges and radii are those of the shrunk
    /// complex. `vertex_origins` and `boundary_vertex_balls` refer to `ScaleAxis::balls`.
    MedialComplex complex;
    MedialAxisStatistics medial_statistics;
    FilterStatistics filter_statistics;
    std::optional<SharpEdgeStatistics> sharp_statistics;    ///< if sharp edges were looked for
    std::optional<CleanStatistics> clean_statistics;        ///< if the axis was cleaned
    std::optional<CenterStatistics> center_statistics;      ///< if its balls were made to touch the solid
    std::optional<FilterStatistics> narrow_statistics;      ///< if it was filtered again (`SheetAngle::kByArea`)
    std::optional<SimplifyStatistics> simplify_statistics;  ///< if it was made compact …
    std::optional<EnvelopeAccuracy> accuracy;               ///< … and then also how far it is from the solid
    /// Where growing the balls may have changed the topology of the union: gaps that it has closed, the first to close
    /// first. Empty if the topology is that of the union before, or not compared (polar balls).
    std::vector<Gap> closed_gaps;
    std::vector<StageCost> costs;
};

struct ScaleAxis {
    std::vector<Ball> balls;                  ///< the union of balls that approximates the solid, not perturbed
    std::vector<Contacts> contacts;           ///< of each ball, if they were fitted; else empty
    std::optional<FitReport> fit;             ///< if they were fitted
    double tolerance = 0.0;                   ///< δ as a length
    std::optional<DeltaChoice> delta_choice;  ///< if δ was chosen (`options.delta_range`)
    double diagonal = 0.0;                    ///< of the solid's bounding box
    std::vector<AxisAtScale> axes;            ///< one for each of `options.scales`, in their order
    Index samples = 0;
    std::optional<Samples> kept_samples;  ///< if `options.keeps_samples`
    SamplingStatistics sampling_statistics;
    std::optional<Topology> solid_topology;  ///< of the input solid, if it is known
    std::vector<StageCost> costs;            ///< of the stages that all scales share
    std::vector<Diagnostic> warnings;
};

/// Checks what can be checked before the size of the solid is known: `scale_axis` does the same.
/// \throws InvalidOption naming the option that is out of range or has no effect
SCALEAXIS_EXPORT void validate(const ScaleAxisOptions& options);

/// Least angle between the normals at edges that sheets go on to, degrees: `sharp_angle`; or, unset, that from which on
/// the filter leaves the sheets, twice its angle and a degree, but at least `SharpEdgeOptions::angle`, which it is for
/// uniform samples.
SCALEAXIS_EXPORT double sharp_angle_of(const ScaleAxisOptions& options);

/// \throws InvalidOption if it is relative, and no range or leaves `kDeltaRange`
SCALEAXIS_EXPORT void validate(const DeltaRange& range);

/// The tolerance δ of a solid whose bounding box has this diagonal, in its units.
/// \throws InvalidOption if it is out of `kDeltaRange` diagonals; UnusableInput if the diagonal is no positive number
SCALEAXIS_EXPORT double tolerance_of(const Length& delta, double diagonal);

/// The finest tolerance that a solid may be sampled with.
SCALEAXIS_EXPORT Length finest_delta(const ScaleAxisOptions& options);

/// Discrete scale axis of a solid (Miklos, Giesen, Pauly, "Discrete scale axis representations for 3D geometry", 2010).
/// \throws InvalidOption, UnusableInput, InconsistentResult, Cancelled
SCALEAXIS_EXPORT ScaleAxis scale_axis(const Solid& solid, const ScaleAxisOptions& options = {},
                                      const Execution& execution = {});

/// The same from samples of the boundary, as by `crust`. Their tolerance takes the place of `options.delta`, which is
/// refused like all other options of the sampling, and their bounding box that of the solid. \throws as above
SCALEAXIS_EXPORT ScaleAxis scale_axis(Samples samples, const ScaleAxisOptions& options = {},
                                      const Execution& execution = {});

}  // namespace scaleaxis::inline v1
