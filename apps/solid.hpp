// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An input as a solid, the first step of several subcommands.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/points.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/shape.hpp"
#include "source.hpp"

namespace scaleaxis::app {

/// What there is to tell about an input, the same in both forms.
struct Description {
    std::string kind;  ///< "mesh", "image", "points", "balls", "axis" or "function": the key in JSON
    Json json;
    std::string text;
};

Description described(const MeshReport& mesh);
Description described(const Image& image);
Description described(const CloudReport& cloud);
Description described(const std::vector<Ball>& balls);
Description described(const MedialComplex& axis);

struct Solid {
    Description description;
    std::vector<std::string> warnings;  ///< of repairs
    std::unique_ptr<Shape> shape;
    std::optional<Samples> samples;  ///< in place of the shape, where the input is already a sample of its boundary
    TriangleMesh mesh;               ///< of a mesh the repaired one, if it was asked for
    std::vector<StageCost> costs;
};

/// Reads what the source is made from and makes it a solid; prints the warnings.
/// \param keeps_mesh whether `mesh` of the result is filled
/// \throws FileError, UnusableShape, InvalidOption, Cancelled
Solid read_solid(const Source& source, const Execution& execution, bool keeps_mesh = false);

/// The balls at the vertices of an axis: of the simplified shape.
std::vector<Ball> balls_of(const MedialComplex& complex);

/// The balls of a file that holds balls or an axis.
/// \throws FileError
std::vector<Ball> read_union(const std::filesystem::path& file);

}  // namespace scaleaxis::app
