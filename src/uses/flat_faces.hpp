// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles of flat faces.
#pragma once

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The same surface with the triangles in its planes those of a Delaunay triangulation: edges are flipped, vertices
/// stay. Programs of CAD cut flat faces into needles, which take many times the vertices when their edges are divided.
TriangleMesh with_delaunay_faces(TriangleMesh mesh);

}  // namespace scaleaxis::inline v1
