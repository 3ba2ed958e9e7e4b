// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles some of whose sides are halved.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Calls `add(a, b, c)` with the parts of a triangle some of whose sides are halved; a quadrangle that is left is cut
/// along its shorter diagonal. \param middle_of the middle of the side from corner `k` to the next one; nothing if it
/// stays whole \param place_of a corner or a middle \returns whether there was a side to halve
template <class Corner, class MiddleOf, class PlaceOf, class Add>
bool split_triangle(std::array<Corner, 3> corners, const MiddleOf& middle_of, const PlaceOf& place_of, const Add& add) {
    std::array<std::optional<Corner>, 3> middles;
    int halved = 0;
    for (int k = 0; k < 3; ++k) {
        middles[k] = middle_of(k);
        halved += middles[k] ? 1 : 0;
    }
    if (halved == 0) {
        return false;
    }
    // Turned so that the first side is halved, and of two the third is not.
    while (!(middles[0] && (halved != 2 || !middles[2]))) {
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
        std::rotate(middles.begin(), middles.begin() + 1, middles.end());
    }
    const auto& [p, q, r] = corners;
    const auto& [pq, qr, rp] = middles;
    if (halved == 1) {
        add(p, *pq, r);
        add(*pq, q, r);
    } else if (halved == 2) {
        add(*pq, q, *qr);
        if (squared_distance(place_of(p), place_of(*qr)) <= squared_distance(place_of(r), place_of(*pq))) {
            add(p, *pq, *qr);
            add(p, *qr, r);
        } else {
            add(p, *pq, r);
            add(*pq, *qr, r);
        }
    } else {
        add(p, *pq, *rp);
        add(*pq, q, *qr);
        add(*rp, *qr, r);
        add(*pq, *qr, *rp);
    }
    return true;
}

}  // namespace scaleaxis::inline v1
