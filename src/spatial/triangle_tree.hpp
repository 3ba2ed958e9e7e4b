// SPDX-License-Identifier: Apache-2.0
/// \file
/// A bounding-volume hierarchy over the triangles of a mesh.
#pragma once

#include "scaleaxis/geometry.hpp"
#include "spatial/box_tree.hpp"

namespace scaleaxis::inline v1 {

/// The items of the tree are the triangles.
struct Bvh : BoxTree {
    TriangleMesh mesh;  ///< triangles in the order of the leaves, vertices in the order of their first use
};

/// \param mesh at least one triangle; finite coordinates
Bvh build_bvh(TriangleMesh mesh);

}  // namespace scaleaxis::inline v1
