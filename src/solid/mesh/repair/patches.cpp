// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/repair/patches.hpp"

#include <array>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "solid/mesh/winding.hpp"

namespace scaleaxis::inline v1 {

Patches find_patches(const Bvh& bvh, const Box& box, const std::vector<std::uint8_t>& is_cut) {
    const std::vector<Point>& vertices = bvh.mesh.vertices;
    const std::vector<std::array<Index, 3>>& triangles = bvh.mesh.triangles;
    const auto is_used = [&](std::size_t t) { return is_cut.empty() || is_cut[t] == 0; };
    DisjointSets sets(vertices.size());
    CancellationPoint cancellation;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        cancellation();
        if (is_used(t)) {
            sets.join(triangles[t][0], triangles[t][1]);
            sets.join(triangles[t][0], triangles[t][2]);
        }
    }

    Patches result;
    std::vector<Patch>& patches = result.patches;
    std::vector<Index>& of_vertex = result.of_vertex;
    of_vertex.resize(vertices.size(), kNone);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        cancellation();
        if (!is_used(t)) {
            continue;
        }
        const auto& [u, v, w] = triangles[t];
        const Index representative = sets.find(u);
        if (of_vertex[representative] == kNone) {
            of_vertex[representative] = static_cast<Index>(patches.size());
            patches.push_back({.vertices = 1});
        }
        Patch& patch = patches[of_vertex[representative]];
        for (const Index vertex : triangles[t]) {
            if (of_vertex[vertex] == kNone) {
                of_vertex[vertex] = of_vertex[representative];
                ++patch.vertices;
            }
        }
        ++patch.triangles;
        const Point normal = cross(vertices[v] - vertices[u], vertices[w] - vertices[u]);
        patch.volume += dot(vertices[u] - vertices[representative], normal);
        const double area = norm(normal);
        if (patch.largest == kNone || area > patch.area) {
            patch.area = area;
            patch.largest = static_cast<Index>(t);
        }
    }

    for_each_index(
        patches.size(),
        [&](std::size_t i) {
            const auto& [u, v, w] = triangles[patches[i].largest];
            const Point center = (1.0 / 3.0) * (vertices[u] + vertices[v] + vertices[w]);
            patches[i].winding_outside = winding_number_outside(bvh, box, patches[i].largest, center);
        },
        std::size_t{16});
    return result;
}

std::optional<Topology> solid_topology(const std::vector<Patch>& components) {
    Topology topology{0, 0, 0, 0};
    for (const Patch& component : components) {
        if (!is_boundary(component.winding_outside)) {
            continue;
        }
        if (component.volume == 0.0) {
            return std::nullopt;
        }
        // The normals point to the unbounded side if the volume is positive.
        const bool is_unbounded_side_empty = (component.winding_outside == 0) == (component.volume > 0.0);
        ++(is_unbounded_side_empty ? topology.components : *topology.voids);
        topology.euler += component.vertices - component.triangles / 2;  // three edges for every two triangles
    }
    topology.euler /= 2;  // of a solid: half that of its boundary
    topology.tunnels = topology.components + *topology.voids - topology.euler;
    return topology;
}

}  // namespace scaleaxis::inline v1
