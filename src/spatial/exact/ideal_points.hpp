// SPDX-License-Identifier: Apache-2.0
/// \file
/// Exact signs of determinants of points of which some are infinitely far.
#pragma once

#include <array>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// A point; or an ideal one, `M` times a direction, where `M` is larger than every number. All directions have the same
/// length, and ideal points have no weight.
struct ProjectivePoint {
    Point at;  ///< or the direction
    double weight = 0.0;
    bool is_ideal = false;
};

/// `orientation` for large `M`. \param d not ideal
int ideal_orientation(const std::array<ProjectivePoint, 3>& abc, const Point& d);

/// `in_power_sphere` for large `M`. \param e not ideal
int ideal_in_power_sphere(const std::array<ProjectivePoint, 4>& abcd, const ProjectivePoint& e);

}  // namespace scaleaxis::inline v1
