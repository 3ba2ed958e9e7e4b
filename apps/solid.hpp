// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A file as a solid, the first step of several subcommands.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/points.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/shape.hpp"

namespace scaleaxis::app {

/// How a point cloud becomes a solid.
struct PointOptions {
    std::optional<CloudMethod> method;  ///< none: what suits the points
    std::optional<double> kernel;       ///< of moving least squares; none: what suits the points
};

struct Solid {
    MeshReport report;
    std::optional<CloudReport> cloud;
    std::optional<Samples> samples;
    std::unique_ptr<Shape> shape;
    std::vector<StageCost> costs;
};

/// Reads and repairs the mesh, and prints a warning for each kind of repair.
/// \throws FileError, UnusableShape, Cancelled
Solid read_solid(const std::filesystem::path& file, const Execution& execution, const PointOptions& points = {});

/// The balls at the vertices of an axis: of the simplified shape.
std::vector<Ball> balls_of(const MedialComplex& complex);

/// The balls of a file that holds balls or an axis.
/// \throws FileError
std::vector<Ball> read_union(const std::filesystem::path& file);

}  // namespace scaleaxis::app
