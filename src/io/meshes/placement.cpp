// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/placement.hpp"

#include <algorithm>
#include <vector>

namespace scaleaxis::io {

void append_placed(const PolygonMesh& mesh, const Eigen::Affine3d& place, PolygonMesh& to) {
    const auto first = static_cast<Index>(to.vertices.size());
    for (const Point& p : mesh.vertices) {
        const Eigen::Vector3d q = place * Eigen::Vector3d(p.x, p.y, p.z);
        to.vertices.push_back({q.x(), q.y(), q.z()});
    }
    const bool is_mirrored = place.linear().determinant() < 0.0;
    std::vector<Index> corners;
    for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
        corners.clear();
        for (const Index v : mesh.polygons[f]) {
            const bool exists = v != kNone && static_cast<std::size_t>(v) < mesh.vertices.size();
            corners.push_back(exists ? first + v : kNone);
        }
        if (is_mirrored) {
            std::ranges::reverse(corners);
        }
        to.polygons.push_back(corners);
    }
}

}  // namespace scaleaxis::io
