// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points of the boundary of a solid, and balls to begin with that are to be grown inwards from them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// The points of `∂S` nearest to the centroids of those restricted facets whose centroid is wanted.
/// \param queries counts them
std::vector<Point> points_at_facets(const Samples& samples, const Solid& solid,
                                    const std::function<bool(const Point&)>& is_wanted, std::int64_t& queries);

/// A point of `∂S`, a unit direction that leads inside there, and how far from it there is surely inside.
struct WayInside {
    Point place;
    Point inwards;
    double depth = 0.0;
};

/// How to go inside: in the middle one of the directions that lead inside. Points where none does, down to a small part
/// of the tolerance, have no way.
std::vector<WayInside> ways_inside(std::vector<Point> points, const Solid& solid, double tolerance);

/// A small ball inside beside each point.
std::vector<Ball> shallow_seeds(std::span<const WayInside> ways, double tolerance);

/// A ball for each point, as far inside as the largest one around its centre still comes within `limit` of the point.
/// Beside edges such a ball is far larger than one that touches the boundary there, and meets its neighbours.
/// \param queries counts the nearest points
std::vector<Ball> deep_seeds(std::span<const WayInside> ways, const Solid& solid, double tolerance, double limit,
                             std::int64_t& queries);

}  // namespace scaleaxis::inline v1
