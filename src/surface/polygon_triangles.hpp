// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Adds the triangles that a polygon of three corners or more is cut into, without new vertices: a fan where one covers
/// it, else ears. The boundary stays, whatever the polygon is like.
void triangulate(const std::vector<Point>& vertices, std::span<const Index> polygon,
                 std::vector<std::array<Index, 3>>& triangles);

}  // namespace scaleaxis::inline v1
