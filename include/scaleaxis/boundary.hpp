// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Back to a surface: samples → triangle mesh of the boundary.
#pragma once

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/shape.hpp"

namespace scaleaxis {

struct BoundaryMesh {
    /// Closed, every edge with exactly two triangles, every vertex with one fan of them, oriented outward; no two
    /// triangles meet but in common edges and vertices (copies of a vertex, see below, lie in the same place).
    TriangleMesh mesh;
    Index copied_vertices = 0;  ///< copies of samples at which several fans of triangles meet, one for each further fan
    Index parted_edges = 0;  ///< edges of two triangles, of several in the same place, that got a vertex in the middle
    Index lost_samples = 0;  ///< samples without a triangle: their part of the boundary is too small
};

/// How to sample the boundary of a union of balls for its mesh: as a manifold, with facets that are (`is_tight`) within
/// 1/8 of the tolerance of the surface.
SamplingOptions boundary_sampling(double tolerance, bool is_tight);

/// The restricted Delaunay triangles of the samples. With `SamplingOptions::needs_manifold` it has the topology of the
/// boundary wherever that is a manifold; where it is not (balls that touch in a point), or the sampling was not made to
/// yield a manifold, the surface is cut into fans.
BoundaryMesh boundary_mesh(const Samples& samples, const Execution& execution = {});

}  // namespace scaleaxis
