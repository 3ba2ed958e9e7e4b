// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A bounding-volume hierarchy over the triangles of a mesh.
#pragma once

#include "kernel/box_tree.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// The items of the tree are the triangles.
struct Bvh : kernel::BoxTree {
    TriangleMesh mesh;  ///< triangles in the order of the leaves, vertices in the order of their first use
};

/// \param mesh at least one triangle; finite coordinates
Bvh build_bvh(TriangleMesh mesh);

}  // namespace scaleaxis
