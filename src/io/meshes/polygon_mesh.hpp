// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a mesh file holds, and the way from there to triangles.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {

/// A mesh as it stands in a file: #V vertices, #F polygons, unchecked.
struct PolygonMesh {
    std::vector<Point> vertices;
    IndexLists polygons;
};

/// More corners and vertices than this are not made of instances: what a file can hold without them.
inline constexpr std::uint64_t kMostCorners = std::numeric_limits<Index>::max() / (3 * sizeof(float));

/// The things that a file holds, each with a name or none, and what of it was left out.
struct PolygonObjects {
    struct Object {
        std::string name;
        PolygonMesh mesh;
    };
    std::vector<Object> objects;
    std::vector<Diagnostic> warnings;
    std::string unit;  ///< of lengths, as "mm"; empty where the format has none
};

/// Adds the triangles of a strip: three corners after each other, every other time turned round. Those with a corner
/// twice join the parts of a strip, and are none.
void add_strip(std::span<const Index> strip, IndexLists& triangles);

/// The mesh with its polygons cut into triangles, without new vertices.
/// \throws FileError naming the first coordinate that is not finite, index that is out of range, or polygon that has
///         fewer than three corners
TriangleMesh triangulated(PolygonMesh mesh);

}  // namespace scaleaxis::io
