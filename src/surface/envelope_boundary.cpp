// SPDX-License-Identifier: Apache-2.0
#include "surface/envelope_boundary.hpp"

#include <algorithm>
#include <cmath>

#include "base/faults.hpp"
#include "base/vectors.hpp"

namespace scaleaxis::inline v1 {

EnvelopeBoundary::EnvelopeBoundary(const Envelope& envelope, double spacing) : envelope_(envelope), spacing_(spacing) {
    constexpr double kMost = 1e11;
    require(envelope.data().area_of_parts() / (spacing * spacing) < kMost,
            "the spacing would take more than 1e11 points; choose a larger one");
    points_ = envelope.data().boundary_points(spacing);
    const auto places = each_of<Point>(points_, &SurfacePoint::point);
    tree_ = build_point_tree(places);
}

double EnvelopeBoundary::distance(const Point& p) const {
    const double to_contact = envelope_.data().distance_to_contact(p);
    if (to_contact >= 0.0) {
        return to_contact;
    }
    // No ball touches the boundary in a re-entrant edge: the points are all that is known of it.
    return std::max(-to_contact, std::sqrt(nearest_point(tree_, p).squared_distance) - spacing_);
}

}  // namespace scaleaxis::inline v1
