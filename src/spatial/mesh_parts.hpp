// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/disjoint_sets.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The vertices of a surface, joined into its connected parts.
inline DisjointSets parts_of(const TriangleMesh& mesh) {
    DisjointSets parts(mesh.vertices.size());
    for (const auto& [u, v, w] : mesh.triangles) {
        parts.join(u, v);
        parts.join(u, w);
    }
    return parts;
}

}  // namespace scaleaxis::inline v1
