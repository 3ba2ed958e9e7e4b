// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far a ball is from touching some planes, as a quadratic function of centre and radius.
#pragma once

#include <Eigen/Core>

#include "scaleaxis/geometry.hpp"
#include "spatial/slab.hpp"

namespace scaleaxis::inline v1 {

/// The sum of weight · (u · centre + radius - offset)² over planes with unit normal u (P. Li et al., "Q-MAT", 2015,
/// section 4): 0 for a ball that touches all of them from inside.
struct SlabQuadric {
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    Eigen::Vector4d b = Eigen::Vector4d::Zero();
    double c = 0.0;
    double weight = 0.0;

    /// The plane with this normal that a ball touches.
    void add_plane(const Point& normal, const Ball& ball, double plane_weight);

    SlabQuadric& operator+=(const SlabQuadric& other);

    double operator()(const Ball& ball) const;

    /// The ball for which it is least. Where many are about as good, the one nearest to `guess`.
    Ball least(const Ball& guess) const;
};

/// Steeper slabs have unstable planes; and no triangle may become thinner (twice its area in squares of its longest
/// side), unless it was.
inline constexpr double kLeastSine = 0.02;

/// The planes at both sides of a slab with three corners, or at four sides of a cone.
SlabQuadric quadric_of(const Slab& slab);

/// The plane at the border of a slab, across the edge from corner 0 to corner 1.
SlabQuadric border_quadric(const Slab& slab);

}  // namespace scaleaxis::inline v1
