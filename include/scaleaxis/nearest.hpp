// SPDX-License-Identifier: Apache-2.0
/// \file
/// The nearest points of a triangle mesh: the kernel beneath the stages, for itself.
#pragma once

#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// One entry for each point that was asked for.
struct NearestOnMesh {
    std::vector<Point> points;      ///< of the mesh
    std::vector<double> distances;  ///< to these
    std::vector<Index> triangles;   ///< that they lie on
};

/// The point of a mesh that is nearest to each of some points, exact to rounding. Of several triangles that are equally
/// near it is always the same one.
/// \param mesh any triangles: open, intersecting or without area; finite
/// \throws UnusableInput if it has no triangles, or a point is not finite; Cancelled
SCALEAXIS_EXPORT NearestOnMesh nearest(const TriangleMesh& mesh, std::span<const Point> points,
                                       const Execution& execution = {});

}  // namespace scaleaxis::inline v1
