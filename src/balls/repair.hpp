// SPDX-License-Identifier: Apache-2.0
/// \file
/// The repair of balls chosen out of the fitted ones.
#pragma once

#include <optional>

#include "scaleaxis/fit.hpp"

namespace scaleaxis::inline v1 {

/// `repair` without looking at all of the boundary, and without balls smaller than a hundredth of the tolerance where
/// the topology can do without them; nothing if it is wrong in the end. \throws as `repair`
std::optional<RepairedBalls> repair_at_samples(const FittedBalls& fitted, const Samples& samples, const Solid& solid,
                                               const RepairOptions& options, const Execution& execution);

}  // namespace scaleaxis::inline v1
