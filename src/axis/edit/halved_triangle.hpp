// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles some of whose sides are halved.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Calls `add` with the parts of a triangle whose sides end in new vertices in the middle; a quadrangle that is left is
/// cut along its shorter diagonal.
/// \param middles of the sides that begin at each corner; `kNone` if a side stays whole
template <class Add>
void add_halved_triangle(std::span<const Point> vertices, std::array<Index, 3> corners, std::array<Index, 3> middles,
                         const Add& add) {
    const auto halved = 3 - std::ranges::count(middles, kNone);
    // Turned so that the first side is halved, and of two the third is not.
    while (halved > 0 && !(middles[0] != kNone && (halved != 2 || middles[2] == kNone))) {
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
        std::rotate(middles.begin(), middles.begin() + 1, middles.end());
    }
    using Triangle = std::array<Index, 3>;
    const auto& [p, q, r] = corners;
    const auto& [pq, qr, rp] = middles;
    if (halved == 0) {
        add(corners);
    } else if (halved == 1) {
        add(Triangle{p, pq, r});
        add(Triangle{pq, q, r});
    } else if (halved == 2) {
        const bool is_p_nearer =
            squared_distance(vertices[p], vertices[qr]) <= squared_distance(vertices[r], vertices[pq]);
        add(Triangle{pq, q, qr});
        add(is_p_nearer ? Triangle{p, pq, qr} : Triangle{p, pq, r});
        add(is_p_nearer ? Triangle{p, qr, r} : Triangle{pq, qr, r});
    } else {
        add(Triangle{p, pq, rp});
        add(Triangle{pq, q, qr});
        add(Triangle{rp, qr, r});
        add(Triangle{pq, qr, rp});
    }
}

}  // namespace scaleaxis::inline v1
