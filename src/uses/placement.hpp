// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where the centres of a few balls should be: an additively weighted k-centre problem.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// The largest ball around a centre that lies inside the solid. \param center in the solid
Ball inscribed_ball(const Solid& solid, const Point& center);

/// Inscribed balls, and which of them each point is nearest to, by |p - centre| - radius: negative inside.
struct Placement {
    std::vector<Ball> balls;          ///< inscribed
    std::vector<Index> nearest;       ///< #P
    std::vector<double> distances;    ///< #P, to the nearest one
    std::vector<double> otherwise;    ///< #P, to the nearest other one
    std::vector<double> ball_errors;  ///< #B, the largest of the distances of its points; negative infinity: no points
    double error = 0.0;               ///< the largest of all
};

/// \param balls at least one
Placement placed(std::vector<Ball> balls, std::span<const Point> points);

/// Moves each centre to where the largest distance to its points is least, and gives each point to the nearest ball
/// again, until that hardly changes anything. The error only decreases.
/// \param has_moved which balls, or whose points, have changed since that was done last
Placement settled(Placement placement, std::span<const Point> points, const Solid& solid,
                  const std::vector<char>& has_moved, int max_rounds);

/// Moves balls from where they are missed least to the farthest points, and settles them, while that makes the error
/// smaller and it is larger than `goal`.
Placement improved(Placement placement, std::span<const Point> points, std::span<const Ball> candidates,
                   const Solid& solid, double goal);

/// One ball more, for the farthest points. Nothing is settled.
std::vector<Ball> with_one_more(const Placement& placement, std::span<const Point> points,
                                std::span<const Ball> candidates);

/// The balls in the order in which they are missed: by the largest distance of their points to other balls.
std::vector<Index> by_need(const Placement& placement);

}  // namespace scaleaxis::inline v1
