// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "io/polygon_mesh.hpp"

namespace scaleaxis::io {

/// A cone between two points, with a radius at each.
struct Beam {
    std::array<Point, 2> ends;
    std::array<double, 2> radii{};
    std::array<bool, 2> is_round{};  ///< ends in a half ball, else in a disc
};

/// Adds closed surfaces of triangles, one for each beam: they overlap where beams meet. \throws FileError
void append_beams(std::span<const Beam> beams, PolygonMesh& to);

}  // namespace scaleaxis::io
