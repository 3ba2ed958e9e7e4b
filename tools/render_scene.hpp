// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a file holds, as the renderer sees it.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::render {

enum class Kind { Axis, Balls, Mesh };

struct Scene {
    Kind kind = Kind::Mesh;
    std::vector<Point> vertices;              ///< #V; centres, of balls
    std::vector<double> radii;                ///< #V; empty for a mesh
    IndexLists faces;                         ///< #F convex polygons
    std::vector<Index> face_sheets;           ///< #F of an axis
    std::vector<double> face_angles;          ///< #F, or empty if the file names none
    std::vector<Index> labels;                ///< #V, or empty if the file names none
    std::vector<std::array<Index, 2>> edges;  ///< #E of an axis, all of them
};

/// What `file_kind` says that it is. Indices are valid and coordinates finite.
/// \throws FileError
Scene read_scene(const std::filesystem::path& file);

}  // namespace scaleaxis::render
