// SPDX-License-Identifier: Apache-2.0
/// \file
/// Distances between two surfaces: triangle meshes, boundaries of unions of balls, envelopes of medial meshes, in any
/// combination.
#pragma once

#include <algorithm>
#include <cstdint>
#include <variant>
#include <vector>

#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The triangles of a mesh, which may be open and intersect itself; or the boundary of a union of balls, or of the
/// envelope of a medial mesh.
using Surface = std::variant<TriangleMesh, BallUnion, Envelope>;

/// The box around the surface; empty if it has no triangles or balls.
SCALEAXIS_EXPORT Box surface_bounds(const Surface& surface);

/// The distances of the points of one surface to the other surface, in units of the surfaces.
struct OneSidedDistance {
    double max = 0.0;    ///< one-sided Hausdorff distance: that of `farthest`
    double error = 0.0;  ///< the true one is between `max` and `max + error`
    double mean = 0.0;   ///< over the area
    double rms = 0.0;    ///< root of the mean square, over the area
    Point farthest;
    std::int64_t samples = 0;  ///< points whose distance was computed
};

struct SurfaceDistance {
    OneSidedDistance a_to_b;  ///< of A's points to B
    OneSidedDistance b_to_a;  ///< of B's points to A

    /// Two-sided Hausdorff distance.
    double max() const { return std::max(a_to_b.max, b_to_a.max); }
    double error() const { return std::max(a_to_b.max + a_to_b.error, b_to_a.max + b_to_a.error) - max(); }
};

struct DistanceOptions {
    /// Every point of a surface is at most this far from a point whose distance is computed; length, > 0.
    double spacing = 0.0;
    /// Parts of a mesh are divided further while they may hold a point that is farther by this than all points known,
    /// up to three times as many points; length, ≥ 0.
    double accuracy = 0.0;
    std::uint64_t seed = 1;  ///< of the points on a union of balls
};

/// Distances between surfaces, both ways: for points spread over one surface the distance to the nearest point of the
/// other, which is exact up to rounding (on unions of balls 1e-8 of the radii; inside of an envelope, where a
/// re-entrant edge of it is nearest, up to the spacing too small). Means are over the points computed. On the boundary
/// of a union the points are samples as `sample` makes them, so that tiny parts (balls, tunnels, crevices below the
/// spacing) may be missed; on that of an envelope they lie on its balls, cones and slabs. \returns lengths in the units
/// of the surfaces \throws InvalidOption (spacing or accuracy out of range, or more than 1e10 points), UnusableInput (a
/// mesh without
///     triangles, an empty union), Cancelled
SCALEAXIS_EXPORT SurfaceDistance surface_distance(const Surface& a, const Surface& b, const DistanceOptions& options,
                                                  const Execution& execution = {});

}  // namespace scaleaxis::inline v1
