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

inline Box box_of_triangle(const TriangleMesh& mesh, Index t) {
    Box box;
    for (const Index v : mesh.triangles[t]) {
        box.extend(mesh.vertices[v]);
    }
    return box;
}

/// Have two boxes a point in common?
inline bool overlap(const Box& a, const Box& b) {
    return (a.min.x <= b.max.x) & (b.min.x <= a.max.x) & (a.min.y <= b.max.y) & (b.min.y <= a.max.y) &
           (a.min.z <= b.max.z) & (b.min.z <= a.max.z);
}

/// \param mesh at least one triangle; finite coordinates
Bvh build_bvh(TriangleMesh mesh);

}  // namespace scaleaxis::inline v1
