// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 5: medial complex of the grown balls → discrete scale axis.
#pragma once

#include <optional>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// Divides all radii by the factor by which the balls had been grown (the paper, section 4.3), and notes it in
/// `MedialComplex::scale`.
///
/// The result is a medial mesh: its meaning between vertices is a ball at every point of an edge or a face. All points
/// of one have the same nearest points of the boundary of the grown union, so that the square of the grown radius minus
/// the square of the place is linear there: what its corners say is exact. `densify` makes balls of it that need no
/// interpolation.
/// \param scale factor `s`, ≥ 1
/// \throws InvalidOption, UnusableInput (see `check`)
SCALEAXIS_EXPORT MedialComplex shrink(MedialComplex complex, double scale);

/// The complex of another program, a medial mesh of spheres, cones and slabs: its radii are linear between vertices,
/// however far apart these are. Changes the kinds of vertices (`linear_vertex`), and nothing else.
SCALEAXIS_EXPORT MedialComplex with_linear_radii(MedialComplex complex);

struct DensifyOptions {
    /// Balls at the ends of an edge must meet at this angle at least; degrees, [90, 175].
    double meeting_angle = 150.0;
    /// Limit of the number of vertices of the result, [1, 1e8]. Unset: ten times those of the complex, but at least a
    /// million and at most 1e8. Where balls barely overlap after shrinking (few balls, large scale), many are needed.
    std::optional<Index> most_vertices = {};
};

/// Samples a shrunk complex until the balls at the ends of every edge meet at the angle asked for (the paper, section
/// 4.3): the union of the balls at its vertices is the simplified solid. Faces that need new points are split into
/// triangles. New points have exact radii.
/// \throws InvalidOption, UnusableInput (see `check`; or more than `most_vertices`, found out before they are made),
/// Cancelled
SCALEAXIS_EXPORT MedialComplex densify(const MedialComplex& complex, const DensifyOptions& options = {},
                                       const Execution& execution = {});

}  // namespace scaleaxis::inline v1
