// SPDX-License-Identifier: GPL-3.0-or-later
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
    std::vector<Index> face_sheets;           ///< #F, or empty if the file names none
    std::vector<double> face_angles;          ///< #F, or empty if the file names none
    std::vector<std::array<Index, 2>> edges;  ///< those that the file lists, among them all that have no face
};

/// An axis (PLY with radii and faces or edges, .ma), balls (PLY with radii only, .balls, .txt, .xyzr, .woff), or a mesh
/// (everything else that `read_mesh` takes). Indices are valid and coordinates finite.
/// \throws FileError
Scene read_scene(const std::filesystem::path& file);

}  // namespace scaleaxis::render
