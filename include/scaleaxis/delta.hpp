// SPDX-License-Identifier: Apache-2.0
/// \file
/// The choice of the tolerance δ: what was tried and what was taken. See `choose_delta`.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// Tolerances to choose from: the coarsest one, this divided by √2, 2, √8 … as long as it is larger than the finest
/// one, and that one.
struct DeltaRange {
    Length coarsest = Length::relative(0.02);
    Length finest = Length::relative(0.0025);
};

/// What one tolerance led to.
struct DeltaAttempt {
    double delta = 0.0;                      ///< relative to the diagonal
    double tolerance = 0.0;                  ///< as a length
    Index samples = 0;                       ///< 0 if there is no union: see `fault`
    Index balls = 0;                         ///< 0 if there is no union
    std::optional<Topology> solid;           ///< of the solid; where it does not know, of its samples, if that is known
    std::optional<Topology> balls_topology;  ///< of the union; unset if there is none
    double largest_distance = 0.0;           ///< from a sample to the union
    Diagnostic fault;                        ///< the requirement that is not met; empty: all are
    double seconds = 0.0;
};

struct DeltaChoice {
    DeltaRange range;                    ///< relative
    std::vector<DeltaAttempt> attempts;  ///< from the coarsest on
    std::size_t chosen = 0;              ///< position in `attempts`; its fault is empty unless all have one
};

}  // namespace scaleaxis::inline v1
