// SPDX-License-Identifier: Apache-2.0
/// \file
/// A medial complex whose polygons are cut into triangles.
#pragma once

#include <array>
#include <vector>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

struct FaceTriangle {
    std::array<Index, 3> corners;
    Index face;  ///< of the complex
};

/// The faces cut along diagonals, the shortest first, so that triangles are as round as they can be.
std::vector<FaceTriangle> face_triangles(const MedialComplex& complex);

}  // namespace scaleaxis
