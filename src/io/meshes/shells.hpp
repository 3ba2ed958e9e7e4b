// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the files of shell meshes have in common.
#pragma once

#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/shells.hpp"

namespace scaleaxis::io {

/// The nodes of a shell mesh, and those of each triangle: its corners, and then the middles of its sides if wanted.
struct ShellNodes {
    std::vector<Point> places;
    std::vector<double> thickness;  ///< the mean of those of the triangles there
    IndexLists triangles;
};
ShellNodes shell_nodes(const ShellMesh& shells, bool has_middles);

double mean_thickness(const ShellMesh& shells, std::size_t triangle);

}  // namespace scaleaxis::io
