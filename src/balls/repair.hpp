// SPDX-License-Identifier: Apache-2.0
/// \file
/// The first part of the repair of fitted balls.
#pragma once

#include <optional>

#include "scaleaxis/fit.hpp"

namespace scaleaxis::inline v1 {

/// `repair` if what the samples show is enough for the topology; nothing if all of the boundary would have to be looked
/// at. \throws as `repair`
std::optional<RepairedBalls> repair_at_samples(const FittedBalls& fitted, const Samples& samples, const Solid& solid,
                                               const RepairOptions& options, const Execution& execution);

}  // namespace scaleaxis::inline v1
