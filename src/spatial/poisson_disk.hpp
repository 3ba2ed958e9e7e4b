// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// A maximal subset of the points no two of which are closer than `radius`, a random one that depends on the seed. The
/// result is in an order with locality, and the same for any number of threads.
std::vector<Point> poisson_disk_subset(const std::vector<Point>& points, double radius, std::uint64_t seed);

}  // namespace scaleaxis::inline v1
