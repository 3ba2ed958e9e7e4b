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

namespace scaleaxis {

struct FaceTriangle {
    std::array<Index, 3> corners;
    Index face;  ///< of the complex
};

/// Cuts a polygon along diagonals, the shortest first, so that triangles are as round as they can be: calls `add` with
/// the positions of the corners of each, in order.
template <class Add>
void cut_into_triangles(std::span<const Point> vertices, std::span<const Index> polygon, const Add& add) {
    std::vector<std::size_t> rest(polygon.size());
    std::iota(rest.begin(), rest.end(), std::size_t{0});
    while (rest.size() > 3) {
        const auto before = [&](std::size_t k) { return rest[k == 0 ? rest.size() - 1 : k - 1]; };
        const auto after = [&](std::size_t k) { return rest[k + 1 < rest.size() ? k + 1 : 0]; };
        std::size_t ear = 0;
        double shortest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < rest.size(); ++k) {
            const double square = squared_distance(vertices[polygon[before(k)]], vertices[polygon[after(k)]]);
            if (square < shortest) {
                shortest = square;
                ear = k;
            }
        }
        add(std::array{before(ear), rest[ear], after(ear)});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    add(std::array{rest[0], rest[1], rest[2]});
}

/// All faces, cut into triangles.
std::vector<FaceTriangle> face_triangles(const MedialComplex& complex);

}  // namespace scaleaxis
