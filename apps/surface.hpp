// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Balls back to a triangle mesh, the way of several subcommands, and what there is to tell about it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "report.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::app {

/// The boundary of a union of balls.
struct Surface {
    BoundaryMesh boundary;
    MeshReport report;  ///< of this mesh, as if it had been read from a file
    std::optional<Topology> solid;
    double tolerance = 0.0;
    Index samples = 0;
    SamplingStatistics sampling;
    std::vector<StageCost> costs;
    std::vector<std::string> warnings;
};

/// \param is_tight see `boundary_sampling`
/// \throws UnusableShape, Cancelled
Surface surface_of(std::vector<Ball> balls, double tolerance, bool is_tight, std::uint64_t seed,
                   const Execution& execution);

Json to_json(const Surface& surface, const std::filesystem::path& file);
void print(std::ostream& out, const Surface& surface, const std::filesystem::path& file);

}  // namespace scaleaxis::app
