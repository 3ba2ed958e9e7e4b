// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles → solid, in two steps.
#pragma once

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/mesh.hpp"

namespace scaleaxis {

/// Leaves out what adds nothing to the surface, and welds it where that closes it. Returns the edges; if the report
/// then has a fault, the arrays are no surface that can be computed with.
IndexLists clean(TriangleMesh& mesh, MeshReport& report);

/// The solid of a repaired mesh. Where that bounds none, being a sheet, its pieces may still wind around one.
SolidOfTriangles solid_of_repaired(RepairedMesh mesh, const Execution& execution);

}  // namespace scaleaxis
