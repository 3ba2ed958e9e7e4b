// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The whole pipeline in one call: shape, δ, s → discrete scale axis.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scaleaxis/balls.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/shape.hpp"
#include "scaleaxis/shrinking.hpp"
#include "scaleaxis/smoothing.hpp"

namespace scaleaxis {

/// What makes a part of the axis worth keeping.
enum class Method {
    kScale,   ///< the discrete scale axis: growing by `scales`, and the filter by `filter_angle`, which keeps the
              ///< topology
    kAngle,   ///< for comparison: the medial axis, and of it what has an object angle of `filter_angle` at least
    kLambda,  ///< for comparison: the medial axis, and of it what has a circumradius of `lambda` at least
};

struct ScaleAxisOptions {
    /// Tolerance δ relative to the diagonal of the shape's bounding box; [1e-5, 0.5].
    double delta = 0.01;
    /// The same as a length in units of the shape; takes the place of `delta` where set. Range as for `delta`.
    std::optional<double> absolute_delta = {};
    Method method = Method::kScale;
    /// Scales s, each in [1, 10]; at least one. All of them share the sampling. The local methods, which grow nothing,
    /// need {1}.
    std::vector<double> scales{1.1};
    /// Object angle below which sheets are spurious; degrees, [0, 90]; 0 keeps everything.
    double filter_angle = 30.0;
    /// λ of `Method::kLambda`, the radius of the smallest ball around the closest boundary points, relative to the
    /// diagonal of the shape's bounding box; [0, 0.5].
    double lambda = 0.02;
    /// The same as a length in units of the shape; takes the place of `lambda` where set.
    std::optional<double> absolute_lambda = {};
    /// Rounds of smoothing of the sheets' boundaries, [0, 1000].
    Index smoothing_rounds = 0;
    /// Samples more densely where the shape is thin: see `SamplingOptions::suits_features`. At most twice the samples.
    bool suits_features = false;
    /// Samples more densely where the balls are far from the shape: see `SamplingOptions::limits_deviation`. At most
    /// twice the samples.
    bool limits_deviation = false;
    /// Seed of sampling and perturbation.
    std::uint64_t seed = 1;
};

/// Time and memory that one stage took.
struct StageCost {
    std::string stage;
    double seconds = 0.0;
    std::uint64_t peak_memory = 0;  ///< of the process up to the end of the stage, bytes; 0 if unknown
};

/// The discrete scale axis for one s.
struct AxisAtScale {
    double scale = 1.0;
    /// Vertices and radii are the balls of the simplified shape; its faces, edges and radii are those of the shrunk
    /// complex. `vertex_balls` and `boundary_vertex_balls` refer to `ScaleAxis::balls`.
    MedialComplex complex;
    MedialAxisStatistics medial_statistics;
    FilterStatistics filter_statistics;
    std::vector<StageCost> costs;
};

struct ScaleAxis {
    std::vector<Ball> balls;        ///< the union of balls that approximates the shape, not perturbed
    double tolerance = 0.0;         ///< δ as a length
    double diagonal = 0.0;          ///< of the shape's bounding box
    std::vector<AxisAtScale> axes;  ///< one for each of `options.scales`, in their order
    Index samples = 0;
    SamplingStatistics sampling_statistics;
    std::optional<Topology> shape_topology;  ///< of the input solid, if it is known
    std::vector<StageCost> costs;            ///< of the stages that all scales share
    std::vector<std::string> warnings;       ///< one line each
};

/// Discrete scale axis of a shape (Miklos, Giesen, Pauly, "Discrete scale axis representations for 3D geometry", 2010).
/// \throws InvalidOption, UnusableShape, InconsistentResult, Cancelled
ScaleAxis scale_axis(const Shape& shape, const ScaleAxisOptions& options = {}, const Execution& execution = {});

/// The same from samples of the boundary, as by `crust`. Their tolerance takes the place of `options.delta`, and their
/// bounding box that of the shape. \throws as above
ScaleAxis scale_axis(Samples samples, const ScaleAxisOptions& options = {}, const Execution& execution = {});

}  // namespace scaleaxis
