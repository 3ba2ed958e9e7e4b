// SPDX-License-Identifier: Apache-2.0
#include "axis/edit/triangulated.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace scaleaxis::inline v1 {

std::vector<FaceTriangle> face_triangles(const MedialComplex& complex) {
    std::vector<FaceTriangle> triangles;
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        cut_into_triangles(complex.vertices, corners, [&](const std::array<std::size_t, 3>& at) {
            triangles.push_back({{corners[at[0]], corners[at[1]], corners[at[2]]}, f});
        });
    }
    return triangles;
}

}  // namespace scaleaxis::inline v1
