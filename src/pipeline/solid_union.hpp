// SPDX-License-Identifier: Apache-2.0
/// \file
/// Samples → the union of balls that stands for the solid.
#pragma once

#include <optional>
#include <string>

#include "pipeline/run.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::inline v1 {

// Rough share in the time of a run, for the progress only.
inline constexpr double kSamplingWork = 3.0;
inline constexpr double kBallsWork = 0.2;
inline constexpr double kFitWork = 6.0;

/// A number of three digits that is no larger.
std::string rounded_down(double value);

/// Are balls to be fitted? \param solid null if only its samples are known
bool fits_balls(const Solid* solid, const std::optional<UnionKind>& kind);

/// See `union_of`. \param solid null if only its samples are known
SolidUnion solid_union(const Samples& samples, const Solid* solid, const UnionOptions& options, Run& run);

/// Samples of sizes that the tolerance allows, and their union. \param options its topology has no effect
SampledUnion union_of_sizes(const Solid& solid, const SamplingOptions& sampling, const UnionOptions& options, Run& run);

/// The same with samples closer to each other in parts that are much thinner than the tolerance, where their topology
/// takes it.
SampledUnion sampled_union(const Solid& solid, const SamplingOptions& sampling, const UnionOptions& options, Run& run);

/// The work of `sampled_union`.
double sampled_union_work(bool is_fitted);

}  // namespace scaleaxis::inline v1
