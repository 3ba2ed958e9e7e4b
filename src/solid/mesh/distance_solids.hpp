// SPDX-License-Identifier: Apache-2.0
/// \file
/// Solids of triangles that bound none: by distances, and by generalized winding numbers.
#pragma once

#include <memory>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// All points within half of `thickness` of the triangles.
/// \param name of the option that gives the thickness, for messages
/// \throws InvalidOption if it is too small for a lattice that finds all parts, or too large; Cancelled
std::unique_ptr<Solid> thickened(TriangleMesh mesh, double thickness, const std::string& name,
                                 const Execution& execution);

/// All points inside a closed mesh that are at least so far from it.
/// \throws InvalidOption as above; UnusableInput if there are none; Cancelled
std::unique_ptr<Solid> shrunk(TriangleMesh mesh, double by, const Execution& execution);

/// Where the generalized winding number exceeds 1/2: bounded by triangles, and by its level set in holes.
/// \param mesh oriented
/// \returns null if that is no solid that most of the triangles bound \throws Cancelled
std::unique_ptr<Solid> wound_around(TriangleMesh mesh, const Execution& execution);

}  // namespace scaleaxis::inline v1
