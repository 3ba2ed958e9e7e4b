// SPDX-License-Identifier: Apache-2.0
/// \file
/// A few balls in place of a solid: that cover it, as robots need them, or that lie inside it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

enum class FewBallsKind : std::uint8_t {
    kCover,   ///< their union covers the solid; the error is how far one of them sticks out of it, at most
    kInside,  ///< all of them lie inside the solid; the error is how far a point of it is from their union, at most
};

/// The points `x` with `normal · x ≥ offset`. \param normal not 0; its length does not matter
struct HalfSpace {
    Point normal;
    double offset = 0.0;  ///< along the normal, as if that had length 1
};

struct FewBallsOptions {
    FewBallsKind kind = FewBallsKind::kCover;
    /// Number of balls, ≥ 1; unset: as few as the error allows. One of the two must be set. Of covering balls both may
    /// be: as many balls that stick out no farther than the error, and leave uncovered what they do not reach then.
    std::optional<Index> count = {};
    /// Error that is not to be exceeded, > 0, in units of the solid.
    std::optional<double> error = {};
    /// No ball reaches out of these, as through the floor that a robot stands on. What lies outside is not covered, and
    /// what is nearer to a plane than the error may be left over, for a ball touches a plane in one point.
    std::vector<HalfSpace> clip = {};
    /// Points of the surface that the search looks at, about, at most, and candidates; ≥ 100. All points count in the
    /// end.
    Index search_size = 3000;
    /// How long the search goes on, relative to the default; (0, 1e6].
    double effort = 1.0;
    /// Whether what greedy set cover chooses is improved. If not, the result is that, all radii enlarged by the same
    /// error, and need not cover more than the points of the search: for comparison.
    bool improves = true;
    /// Whether all points count in the end. If not, those of the search alone are covered, or measured at: for
    /// comparison with methods that look at a few thousand points.
    bool checks_all = true;
};

struct FewBallsStatistics {
    /// The error: of covering balls the largest radius - distance from the centre to the surface, which no ball sticks
    /// out farther than; of inner balls the largest distance of a point that was looked at to the union.
    double error = 0.0;
    /// What greedy set cover alone reaches, with as many balls as asked for; or with the error asked for, the number of
    /// balls that it takes. Of the same candidates and points, those of the search.
    double greedy_error = 0.0;
    Index greedy_count = 0;
    /// No fewer candidates come within `error` of the points of the search (Lagrangian relaxation of set cover). Balls
    /// whose centres were moved are no candidates: where they do with fewer, `count_bound` is more than there are
    /// balls.
    Index count_bound = 0;
    Index candidates = 0;      ///< in the search
    Index search_points = 0;   ///< in the search
    Index checked_points = 0;  ///< that the result is made to cover, or was measured at
};

struct FewBalls {
    std::vector<Ball> balls;
    FewBallsStatistics statistics;
};

/// Balls that stand for a solid. A ball around a centre `c` inside the solid, which is `ρ(c)` from the surface, lies
/// inside up to the radius `ρ(c)`, and sticks out by at most `δ` up to `ρ(c) + δ`. So it is one question for both
/// kinds: the centres for which the largest distance `|p - c| - ρ(c)` of a point `p` of the solid to the nearest ball
/// is least, an additively weighted k-centre problem. It is begun with greedy set cover of the candidates (Z. Dou et
/// al., "Coverage Axis: inner point selection for 3D shape skeletonization", 2022, and G. Bradshaw, C. O'Sullivan,
/// "Adaptive medial-axis approximation for sphere-tree construction", 2004, cover by medial balls, too), and improved:
/// each centre is moved to where it serves the points that are nearest to it best, and balls go from where they are
/// missed least to where the error is largest.
///
/// Covering balls cover all points checked, of which there are about ten times those of the search, and every vertex
/// of the boundary of their own union lies outside the solid or on its surface: where the surface is covered, so is
/// the inside.
/// \param candidates balls inside the solid, best maximal ones (see `fit`); at least one
/// \param points of the surface, best as dense as the samples that the candidates are of; at least one
/// \throws InvalidOption; UnusableInput if there are no candidates or points, or the solid does not know the nearest
///     points of its boundary; Cancelled
SCALEAXIS_EXPORT FewBalls few_balls(std::span<const Ball> candidates, std::span<const Point> points, const Solid& solid,
                                    const FewBallsOptions& options, const Execution& execution = {});

/// A solid among several that share a number of balls. \param candidates, points see `few_balls`
struct Sharer {
    std::span<const Ball> candidates;
    std::span<const Point> points;
    const Solid* solid = nullptr;
    std::vector<HalfSpace> clip = {};
};

/// Balls for several solids, as the links of a robot, so that the largest of all errors is small: each next ball goes
/// to the solid with the largest error. As no error grows with the number of balls, that leads to the least largest
/// error that such a number allows. It is done with the errors of greedy set cover, which are cheap; then single balls
/// change hands as long as that helps.
/// \param total number of balls, at least one for each solid
/// \param options count, error and clip have no effect
/// \throws as `few_balls`
SCALEAXIS_EXPORT std::vector<FewBalls> shared_balls(std::span<const Sharer> solids, Index total,
                                                    const FewBallsOptions& options, const Execution& execution = {});

/// A few large balls that contain all of these, as the upper level of a hierarchy: the two groups whose common ball is
/// smallest become one until so many are left. The ball of a group is at most 0.1 % larger than it need be.
/// \param balls at least one \param count ≥ 1; no more come back than there are balls
SCALEAXIS_EXPORT std::vector<Ball> enclosing_balls(std::span<const Ball> balls, Index count);

/// How balls stand for a solid, as robotics has it. Shares of volume are those of points on a jittered grid.
struct BallScores {
    double coverage = 0.0;            ///< share of the volume of the solid in the balls
    double surface_coverage = 0.0;    ///< share of the points of the surface
    double largest_gap = 0.0;         ///< of a point of the solid or its surface to the union
    double mean_gap = 0.0;            ///< of the points of the surface
    double largest_protrusion = 0.0;  ///< distance of a point of the union's boundary to the solid; 0 inside
    double mean_protrusion = 0.0;     ///< by area
    double protrusion_95 = 0.0;       ///< 95 % quantile, by area
    double volume_ratio = 0.0;        ///< volume of the union / volume of the solid
    double outside_share = 0.0;       ///< share of the volume of the union outside the solid
    Index volume_points = 0;          ///< in the solid
    Index surface_points = 0;
    Index union_points = 0;  ///< of the union's boundary
};

/// Points of triangles that lie outside a solid made of them, as on sheets that were left out: what covers the solid
/// need not cover these. About ten for each `spacing²`, but no more than three million. \throws UnusableInput if the
/// solid does not know the nearest points of its boundary; Cancelled
SCALEAXIS_EXPORT std::vector<Point> points_left_out(const MeshView& triangles, const Solid& solid, double spacing,
                                                    std::uint64_t seed = 1, const Execution& execution = {});

/// \param balls at least one \param points of the surface, other than those that the balls were made for; at least one
/// \throws as `few_balls`
SCALEAXIS_EXPORT BallScores ball_scores(std::span<const Ball> balls, std::span<const Point> points, const Solid& solid,
                                        std::uint64_t seed = 1, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
