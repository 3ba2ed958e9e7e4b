// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a mesh file holds, and the way from there to triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {

/// A mesh as it stands in a file: #V vertices, #F polygons, unchecked.
struct PolygonMesh {
    std::vector<Point> vertices;
    IndexLists polygons;
};

/// An index as a file gives it; `kNone` where it cannot be one.
constexpr Index to_index(std::int64_t value) {
    return value >= 0 && value <= std::numeric_limits<Index>::max() ? static_cast<Index>(value) : kNone;
}

/// The mesh with its polygons cut into triangles, without new vertices.
/// \throws FileError naming the first coordinate that is not finite, index that is out of range, or polygon that has
///         fewer than three corners
TriangleMesh triangulated(PolygonMesh mesh);

}  // namespace scaleaxis::io
