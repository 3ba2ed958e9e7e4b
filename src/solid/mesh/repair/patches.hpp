// SPDX-License-Identifier: Apache-2.0
/// \file
/// Connected parts of a closed surface, and what they say about the solid that it bounds.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/topology.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// Triangles that are connected and that nothing else meets: either all of them bound the solid or none does.
struct Patch {
    std::int64_t vertices = 0;
    std::int64_t triangles = 0;
    double volume = 0.0;      ///< signed, times six; meaningful for a closed patch
    Index largest = kNone;    ///< its largest triangle
    double area = 0.0;        ///< of the largest triangle, times two
    int winding_outside = 0;  ///< winding number on the side that the normals point to
};

struct Patches {
    std::vector<Patch> patches;
    std::vector<Index> of_vertex;  ///< `kNone` where all triangles are cut
};

/// \param box of the surface
/// \param is_cut for each triangle whether another one meets it; empty if none does
Patches find_patches(const Bvh& bvh, const Box& box, const std::vector<std::uint8_t>& is_cut);

/// Topology of the solid, from the components of a surface that does not meet itself: a component is part of the
/// boundary if the solid is on one side of it alone, either around a piece of the solid or around a cavity. Nothing if
/// some component has no volume.
std::optional<Topology> solid_topology(const std::vector<Patch>& components);

}  // namespace scaleaxis::inline v1
