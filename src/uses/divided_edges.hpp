// SPDX-License-Identifier: Apache-2.0
/// \file
/// Edges of triangle meshes, divided.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/vectors.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

using MeshEdge = std::array<Index, 2>;  // the smaller vertex first

/// The edges of a mesh that are wanted, each once, in order.
template <class Wanted>
std::vector<MeshEdge> edges_of(const TriangleMesh& mesh, const Wanted& is_wanted) {
    std::vector<MeshEdge> edges;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            if (is_wanted(a, b)) {
                edges.push_back({a, b});
            }
        }
    }
    sort_unique(edges);
    return edges;
}

/// Divides edges at points, one for each, and the triangles at them. \param edges ascending, each once
void divide(TriangleMesh& mesh, const std::vector<MeshEdge>& edges, const std::vector<Point>& points);

/// Divides them in the middle.
void halve(TriangleMesh& mesh, const std::vector<MeshEdge>& edges);

}  // namespace scaleaxis::inline v1
