// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// Where a surface meets itself: pairs of triangles that have a point in common beside the corners and the side that
/// they share as indices. Triangles without area are passed over. Exact.
struct SelfIntersections {
    std::int64_t pairs = 0;
    std::vector<std::uint8_t> is_cut;  ///< for each triangle of the tree: is it one of a pair?
};
SelfIntersections self_intersections(const Bvh& bvh);

/// The number of pairs alone.
/// \param mesh of finite coordinates
std::int64_t count_self_intersections(const TriangleMesh& mesh, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
