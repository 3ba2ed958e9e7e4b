// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far two surfaces are from each other: triangle meshes and boundaries of unions of balls, in any combination.
#pragma once

#include <algorithm>
#include <cstdint>
#include <variant>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// The triangles of a mesh, which may be open and intersect itself; or the boundary of the union of balls.
using Surface = std::variant<TriangleMesh, std::vector<Ball>>;

/// The box around the surface; empty if it has no triangles or balls.
Box surface_bounds(const Surface& surface);

/// The distances of the points of one surface to another one.
struct OneSidedDistance {
    double max = 0.0;    ///< one-sided Hausdorff distance: that of `farthest`
    double error = 0.0;  ///< the true one is between `max` and `max + error`
    double mean = 0.0;   ///< over the area
    double rms = 0.0;    ///< root of the mean square, over the area
    Point farthest;
    std::int64_t samples = 0;  ///< points whose distance was computed
};

struct SurfaceDistance {
    OneSidedDistance there;  ///< of A's points to B
    OneSidedDistance back;   ///< of B's points to A

    /// Two-sided Hausdorff distance.
    double max() const { return std::max(there.max, back.max); }
    double error() const { return std::max(there.max + there.error, back.max + back.error) - max(); }
};

struct DistanceOptions {
    /// Every point of a surface is at most this far from a point whose distance is computed; length, > 0.
    double spacing = 0.0;
    /// Parts of a mesh are divided further while they may hold a point that is farther by this than all others known,
    /// as long as that takes no more points than before; length, ≥ 0.
    double accuracy = 0.0;
    std::uint64_t seed = 1;  ///< of the points on a union of balls
};

/// Distances of points to the nearest point of a surface are exact but for rounding (on unions of balls 1e-8 of the
/// radii); means are over the points computed. On the boundary of a union of balls points are samples as `sample` makes
/// them, so that tiny parts (balls, tunnels, crevices below the spacing) may be missed.
/// \throws InvalidOption, UnusableShape (a mesh without triangles, no balls, or one that is none), Cancelled
SurfaceDistance surface_distance(const Surface& a, const Surface& b, const DistanceOptions& options,
                                 const Execution& execution = {});

}  // namespace scaleaxis
