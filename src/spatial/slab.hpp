// SPDX-License-Identifier: Apache-2.0
/// \file
/// Balls interpolated over a simplex: what a medial mesh consists of.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The union of the balls that interpolate those at the corners of a simplex linearly, in centre and radius: a ball, a
/// cone between two balls, or a slab between three (P. Li et al., "Q-MAT: computing medial axis transform by quadratic
/// error minimization", 2015). Corners may coincide, lie on a line, or hold balls inside each other.
struct Slab {
    std::array<Ball, 3> corners;
    int size = 0;  ///< number of corners, 1 to 3

    explicit Slab(std::span<const Ball> balls);
};

/// One of the balls of a slab, and how far a point is from it.
struct SlabBall {
    Ball ball;
    double distance = 0.0;  ///< |p - centre| - radius: negative inside
};

/// At most |p - centre| - radius of every ball of the slab. As a function on the simplex that is convex, and its
/// tangent at the centroid lies below it: close where the simplex is small beside the distance.
double least_distance_bound(const Slab& slab, const Point& p);

/// That |p - centre| - radius of all balls is larger, by more than rounding, as the bound tells; false: perhaps it is
/// too.
bool is_farther(const Slab& slab, const Point& p, double distance);

/// The ball of a slab for which |p - centre| - radius is least. As a function on the simplex that is convex: the least
/// value is where its gradient vanishes, if that is inside, and else on the border.
SlabBall nearest_ball(const Slab& slab, const Point& p);

/// The ball of a slab that must grow by the least factor |p - centre| / radius to reach a point. The factor falls along
/// every line towards the best ball, so that this is where its gradient vanishes, if that is inside, and else on the
/// border. Balls of radius 0 reach nothing: the factor is infinite.
struct GrownBall {
    Ball ball;
    double growth = 0.0;  ///< |p - centre| / radius: at most 1 where the ball contains the point
};
GrownBall least_grown_ball(const Slab& slab, const Point& p);

/// The largest ball of a slab with |p - centre| ≤ `growth` times its radius; nothing if there is none. The balls that
/// reach the point are a convex part of the slab, cut out by a cone over it.
std::optional<Ball> largest_ball(const Slab& slab, const Point& p, double growth = 1.0);

/// How the radius changes along a simplex with more than one corner, and where its balls touch the planes or cones
/// around it.
struct SlabShape {
    Point gradient;      ///< of the radius, along the simplex; shorter than 1
    Point normal;        ///< unit length, 0 for a cone
    double flank = 1.0;  ///< sqrt(1 - gradient²): sine of the angle between the simplex and the radii to the contacts
};

/// Nothing if the simplex is degenerate, or if its gradient is 1 or more: then one of the balls holds the others, or
/// the slab is no more than the cones on its border.
std::optional<SlabShape> shape_of(const Slab& slab);

/// The directions in which the balls of a slab touch the planes on both sides of it; nothing where it has no shape.
std::optional<std::array<Point, 2>> contact_directions(const Slab& slab);

}  // namespace scaleaxis::inline v1
