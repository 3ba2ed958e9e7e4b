// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 2, second part: balls that fit the solid itself instead of its samples, and a union of the right topology.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// Two points of `∂S` that a ball touches.
using Contacts = std::array<Point, 2>;

/// The slack of fitted balls that is small beside all that the sampling leaves, in units of its tolerance.
inline constexpr double kDefaultSlack = 0.01;

struct FitOptions {
    /// Lengths below this do not matter: a ball is fitted when it touches its second contact, and is no farther than
    /// this from its first one. In units of the solid; > 0.
    double slack = 0.0;
};

struct FitStatistics {
    Index outside = 0;   ///< balls dropped: their centres lie outside, or on the boundary
    Index repeated = 0;  ///< balls dropped: another one became the same
    Index inexact = 0;   ///< balls that stay where they were, with the radius that fits there: answers of the solid
                         ///< contradict each other by more than the slack
    std::int64_t queries = 0;  ///< points asked for the nearest one of the boundary
};

/// Balls in the solid: no point of `∂S` is nearer to a centre than the radius, up to rounding (and to what the solid
/// knows of its nearest points). Each touches `∂S` at its contacts, the first one to within the slack.
struct FittedBalls {
    std::vector<Ball> balls;         ///< #B
    std::vector<Contacts> contacts;  ///< #B
    std::vector<Index> given;        ///< #B, ascending; position of the ball that each was fitted from
    FitStatistics statistics;
};

/// \throws UnusableInput if balls cannot be fitted to the solid, since it does not know nearest points
SCALEAXIS_EXPORT void check_knows_nearest(const Solid& solid);

/// Fits balls to a solid. The inscribed ball around a given centre touches `∂S` at one point: that ball is blown up,
/// its centre moving away from the point along the normal there, until `∂S` stops it at a second one. So it becomes a
/// maximal ball. It is found from outside, by shrinking (Ma, Bae, Choi, "3D medial axis point approximation using
/// nearest neighbors and the normal field", 2012).
/// \param balls the radius says how large a ball may become, about: a good guess saves questions
/// \throws UnusableInput if the solid does not know nearest points, or contradicts itself for more than a tenth of the
///     balls; InvalidOption, Cancelled
SCALEAXIS_EXPORT FittedBalls fit(std::span<const Ball> balls, const Solid& solid, const FitOptions& options,
                                 const Execution& execution = {});

/// How far a boundary may be from its union of balls, in tolerances of its samples: what users are promised.
inline constexpr double kPromise = 0.5;

struct RepairOptions {
    /// The topology that the union is to have; unset: not known, or not wanted.
    std::optional<Topology> topology = {};
    /// Rounds of looking for critical points, in each step; [0, 100].
    Index max_rounds = 32;
    /// No more balls are added than this times those given, and 1000; ≥ 0.
    double growth_limit = 8.0;
    /// Slack of the balls that are fitted, see `FitOptions`.
    double slack = 0.0;
    /// The union is judged with its centres moved as `medial_axis` does first: see `MedialAxisOptions`.
    double perturbation = 1e-4;
    std::uint64_t seed = 1;
};

/// What one step of the repair did.
struct RepairStep {
    std::string name;                       ///< "samples", "small balls", "complete 0.5" or 0.25, "islands", "polar"
    Index rounds = 0;                       ///< triangulations
    Index gaps = 0;                         ///< critical points in `S` that no ball covered (A)
    Index missed = 0;                       ///< critical points beside `S` where a thin part of it had no ball (C)
    Index far_samples = 0;                  ///< points of `∂S` farther from the union than the step allows
    Index added = 0;                        ///< balls; below 0 where islands were taken away
    std::optional<Topology> topology = {};  ///< of the union after it
};

/// A place outside the solid, between balls, that the union covers once its balls have grown.
struct Gap {
    Point place;         ///< a critical point of the balls' power distance
    double width = 0.0;  ///< distance from there to the nearest of these balls, and on to the farthest
    double scale = 1.0;  ///< factor by which the balls must grow to cover it
};

struct RepairReport {
    std::vector<RepairStep> steps;  ///< in their order
    std::vector<Gap> gaps;          ///< those that a scale of at most 2 closes, the first to close first
    Topology topology = {};         ///< of the union after them
    Index added = 0;
    bool is_growth_limited = false;  ///< more balls would have been added than allowed
    /// How far polar balls stick out of the solid: where inscribed ones do not get the topology right, and these do.
    double largest_protrusion = 0.0;
    Index points = 0;               ///< of the boundary that were looked at
    Index far_points = 0;           ///< those of them that are farther than `kPromise` from the union in the end
    double largest_distance = 0.0;  ///< from them to the union; 0 if all are near
    Point farthest_point;
    std::int64_t queries = 0;  ///< points asked for the nearest one of the boundary
};

struct RepairedBalls {
    std::vector<Ball> balls;         ///< #B; those given come first, unchanged
    std::vector<Contacts> contacts;  ///< #B
    RepairReport report;
};

/// Adds balls to a union of fitted balls until it has the topology of the solid, or nothing more is found to do.
/// The topology changes at the critical points of the power distance alone, where a simplex of the regular
/// triangulation contains the orthocentre of its balls and no other ball has a smaller power there. The solid is asked
/// about those that no ball covers: one in the solid is a gap, and a maximal ball around it is added; beside one
/// outside there may be a thin part of the solid that has no ball. Parts without any ball near have no critical point:
/// while the topology still differs, balls are grown inwards from points of `∂S` that are far from the union. If it
/// differs in the end, polar balls of the samples close critical points outside, provided that it is right with them.
/// \throws UnusableInput if the solid does not know nearest points, or contradicts itself; InvalidOption, Cancelled
SCALEAXIS_EXPORT RepairedBalls repair(const FittedBalls& fitted, const Samples& samples, const Solid& solid,
                                      const RepairOptions& options, const Execution& execution = {});

/// How a union of inscribed balls compares with its solid.
struct UnionAccuracy {
    double largest_distance = 0.0;  ///< from a sample to the union; in a run, from any point that is looked at
    double mean_distance = 0.0;     ///< of all samples; of balls that touch the boundary nearby, so rather too large
    Point farthest_sample;
    Ball thinnest;
    Ball thickest;
};

/// \param balls at least one \param contacts #B \throws Cancelled
SCALEAXIS_EXPORT UnionAccuracy union_accuracy(std::span<const Ball> balls, std::span<const Contacts> contacts,
                                              const Samples& samples, const Execution& execution = {});

/// The thinnest part of a solid that is thinner than twice the tolerance, as far as balls lie in it. Balls near sharp
/// convex edges and corners are small, too: in a thin part they touch the boundary on opposite sides, and so do all
/// balls around them.
/// \param contacts #B \param tolerance of the samples; > 0 \throws Cancelled
SCALEAXIS_EXPORT std::optional<ThinPart> thin_part(std::span<const Ball> balls, std::span<const Contacts> contacts,
                                                   double tolerance, const Execution& execution = {});

/// What fitting and repair did in a run.
struct FitReport {
    FitStatistics fit;
    RepairReport repair;
    UnionAccuracy accuracy;
    std::optional<ThinPart> thin_part;
    Index not_needed = 0;  ///< fitted balls left out, since the error does not need them
};

}  // namespace scaleaxis::inline v1
