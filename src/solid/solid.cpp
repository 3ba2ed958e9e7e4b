// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/solid.hpp"

#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {

void Solid::nearest(std::span<const Point> points, std::span<const double> bounds,
                    std::span<std::optional<Point>> nearest) const {
    const NearestPoints* search = nearest_points();
    if (search == nullptr) {
        throw UnusableInput(
            Diagnostic{"solid.nearest_unknown", "this solid does not know the nearest points of its boundary"});
    }
    search->find(points, bounds, nearest);
}

}  // namespace scaleaxis::inline v1
