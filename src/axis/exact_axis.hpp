// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "balls/union/union_complex.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

struct ExactAxis {
    MedialComplex complex;
    MedialAxisStatistics statistics;
};

/// The medial axis of a union whose balls are in general position.
/// \returns nothing if the result contradicts itself: then rounding has moved a centre across the boundary
std::optional<ExactAxis> exact_axis(const UnionComplex& parts, const std::function<void(double)>& report_progress);

}  // namespace scaleaxis::inline v1
