// SPDX-License-Identifier: Apache-2.0
/// \file
/// A medial complex whose polygons are cut into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

struct FaceTriangle {
    std::array<Index, 3> corners;
    Index face;  ///< of the complex
};

/// Cuts ears off a polygon, at each step the one of least `cost(before, corner, after)`: calls `add` with the positions
/// of the corners of each triangle, in order.
template <class Cost, class Add>
void cut_ears(std::span<const Index> polygon, const Cost& cost, const Add& add) {
    std::vector<std::size_t> rest(polygon.size());
    std::iota(rest.begin(), rest.end(), std::size_t{0});
    while (rest.size() > 3) {
        const auto before = [&](std::size_t k) { return rest[k == 0 ? rest.size() - 1 : k - 1]; };
        const auto after = [&](std::size_t k) { return rest[k + 1 < rest.size() ? k + 1 : 0]; };
        std::size_t ear = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < rest.size(); ++k) {
            const double cost_here = cost(polygon[before(k)], polygon[rest[k]], polygon[after(k)]);
            if (cost_here < least) {
                least = cost_here;
                ear = k;
            }
        }
        add(std::array{before(ear), rest[ear], after(ear)});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    add(std::array{rest[0], rest[1], rest[2]});
}

/// The same along the shortest diagonals, so that triangles are as round as they can be.
template <class Add>
void cut_into_triangles(std::span<const Point> vertices, std::span<const Index> polygon, const Add& add) {
    cut_ears(
        polygon, [&](Index before, Index, Index after) { return squared_distance(vertices[before], vertices[after]); },
        add);
}

/// All faces, cut into triangles.
std::vector<FaceTriangle> face_triangles(const MedialComplex& complex);

}  // namespace scaleaxis::inline v1
