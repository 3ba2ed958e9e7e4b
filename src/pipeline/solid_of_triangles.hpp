// SPDX-License-Identifier: Apache-2.0
/// \file
/// The second step from triangles to a solid.
#pragma once

#include "scaleaxis/execution.hpp"
#include "scaleaxis/mesh.hpp"

namespace scaleaxis::inline v1 {

/// The solid of a repaired mesh. Where that bounds none, being a sheet, its pieces may still wind around one.
SolidOfTriangles solid_of_repaired(RepairedMesh mesh, const Execution& execution);

}  // namespace scaleaxis::inline v1
