// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// A cone between two points, with a radius at each.
struct Beam {
    std::array<Point, 2> ends;
    std::array<double, 2> radii{};
    std::array<bool, 2> is_round{};  ///< ends in a half ball, else in a disc
};

/// Closed surfaces of triangles, one for each beam: they overlap where beams meet.
TriangleMesh beam_mesh(std::span<const Beam> beams);

}  // namespace scaleaxis::inline v1
