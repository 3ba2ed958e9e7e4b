// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The point farthest from `reference` among those added; the first of several.
struct FarthestPoint {
    Point reference;
    std::optional<Point> point = {};

    void add(const Point& p) {
        if (!point || squared_distance(p, reference) > squared_distance(*point, reference)) {
            point = p;
        }
    }
};

}  // namespace scaleaxis::inline v1
