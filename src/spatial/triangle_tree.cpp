// SPDX-License-Identifier: Apache-2.0
#include "spatial/triangle_tree.hpp"

#include <vector>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

TriangleMesh reordered(const TriangleMesh& mesh, const std::vector<Index>& order) {
    TriangleMesh result;
    result.triangles.resize(order.size());
    result.vertices.reserve(mesh.vertices.size());
    std::vector<Index> new_index(mesh.vertices.size(), kNone);
    for (std::size_t t = 0; t < order.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const Index v = mesh.triangles[order[t]][k];
            if (new_index[v] == kNone) {
                new_index[v] = static_cast<Index>(result.vertices.size());
                result.vertices.push_back(mesh.vertices[v]);
            }
            result.triangles[t][k] = new_index[v];
        }
    }
    return result;
}

}  // namespace

Bvh build_bvh(TriangleMesh mesh) {
    const auto boxes =
        mapped<Box>(mesh.triangles.size(), [&](std::size_t t) { return box_of_triangle(mesh, static_cast<Index>(t)); });
    Bvh bvh{build_box_tree(boxes), {}};
    bvh.mesh = reordered(mesh, bvh.order);
    return bvh;
}

}  // namespace scaleaxis::inline v1
