// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A file as a solid, the first step of several subcommands.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/shape.hpp"

namespace scaleaxis::app {

struct Solid {
    MeshReport report;
    std::unique_ptr<Shape> shape;
    TriangleMesh mesh;  ///< the repaired one, if it was asked for
    std::vector<StageCost> costs;
};

/// Reads and repairs the mesh, and prints a warning for each kind of repair.
/// \param keeps_mesh whether `mesh` of the result is filled
/// \throws FileError, UnusableShape, Cancelled
Solid read_solid(const std::filesystem::path& file, const Execution& execution, bool keeps_mesh = false);

/// The balls at the vertices of an axis: of the simplified shape.
std::vector<Ball> balls_of(const MedialComplex& complex);

/// The balls of a file that holds balls or an axis.
/// \throws FileError
std::vector<Ball> read_union(const std::filesystem::path& file);

}  // namespace scaleaxis::app
