// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/solid.hpp"

#include "scaleaxis/errors.hpp"

namespace scaleaxis {

void Solid::nearest(std::span<const Point>, std::span<const double>, std::span<std::optional<Point>>) const {
    throw UnusableInput(
        Diagnostic{"solid.nearest_unknown", "this solid does not know the nearest points of its boundary"});
}

}  // namespace scaleaxis
