// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "io/meshes/polygon_mesh.hpp"

namespace scaleaxis::io {

/// Adds a mesh at its place to another one. Where the place mirrors, polygons are turned round. An index that is out of
/// range stays one: `kNone`.
void append_placed(const PolygonMesh& mesh, const Eigen::Affine3d& place, PolygonMesh& to);

}  // namespace scaleaxis::io
