// SPDX-License-Identifier: Apache-2.0
/// \file
/// Union of balls, or envelope of a medial mesh → triangle mesh in one call.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scaleaxis/boundary.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

struct UnionMeshOptions {
    /// Tolerance of the sampling, relative to the diagonal of the box around the balls or absolute; > 0.
    Length delta = kDefaultDelta;
    /// Seed of the sampling.
    std::uint64_t seed = 1;
};

/// The boundary of a union of balls as a closed manifold mesh, and what was measured on the way.
struct UnionMesh {
    BoundaryMesh boundary;
    MeshReport report;              ///< of this mesh, as if it had been read from a file
    std::optional<Topology> solid;  ///< of the union
    double tolerance = 0.0;         ///< as a length
    Index samples = 0;
    SamplingStatistics sampling;
    std::vector<StageCost> costs;
    std::vector<Diagnostic> warnings;
};

/// Samples the boundary of the union and makes a mesh of the samples. Details of the union far below the tolerance are
/// lost, with a warning. \throws InvalidOption, UnusableInput (no balls, or what is none), Cancelled
SCALEAXIS_EXPORT UnionMesh union_mesh(std::vector<Ball> balls, const UnionMeshOptions& options = {},
                                      const Execution& execution = {});

/// The same of the envelope of a medial mesh. Parts thinner than the tolerance may be missed. \throws as above
SCALEAXIS_EXPORT UnionMesh envelope_mesh(const Envelope& envelope, const UnionMeshOptions& options = {},
                                         const Execution& execution = {});

}  // namespace scaleaxis::inline v1
