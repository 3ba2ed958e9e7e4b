// SPDX-License-Identifier: Apache-2.0
/// \file
/// What comes before holes are closed, for those who do not want them closed.
#pragma once

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/mesh.hpp"

namespace scaleaxis::inline v1 {

/// Leaves out what adds nothing to the surface, and welds it where that closes it. Returns the edges; if the report
/// then has a fault, the arrays are no surface that can be computed with.
IndexLists clean(TriangleMesh& mesh, MeshReport& report);

}  // namespace scaleaxis::inline v1
