// SPDX-License-Identifier: Apache-2.0
/// \file
/// Back to a surface: samples → triangle mesh of the boundary.
#pragma once

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

struct BoundaryMesh {
    /// Closed, every edge with exactly two triangles, every vertex with one fan of them, oriented outward; no two
    /// triangles meet but in common edges and vertices (copies of a vertex, see below, lie in the same place).
    TriangleMesh mesh;
    Index copied_vertices = 0;  ///< copies of samples at which several fans of triangles meet, one for each further fan
    Index parted_edges = 0;     ///< edges in the same place as another edge, which got a vertex in the middle
    Index lost_samples = 0;     ///< samples without a triangle: their part of the boundary is too small
};

/// How to sample the boundary of a union of balls for its mesh: as a manifold, with facets within an eighth of the
/// tolerance of the surface (`SamplingOptions::facet_distance`).
/// \param tolerance bound on the radius of every surface Delaunay ball; length in units of the balls, > 0
SCALEAXIS_EXPORT SamplingOptions boundary_sampling(double tolerance);

/// The restricted Delaunay triangles of the samples (Boissonnat and Oudot, "Provably good sampling and meshing of
/// surfaces", 2005). With `SamplingOptions::needs_manifold` the mesh has the topology of the boundary wherever that is
/// a manifold. Where it is not (balls that touch in a point), or the sampling was not made to yield a manifold, the
/// surface is cut into fans of triangles.
/// \param samples of the boundary of any solid; not empty
/// \returns vertices in units of the samples
/// \throws Cancelled
SCALEAXIS_EXPORT BoundaryMesh boundary_mesh(const Samples& samples, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
