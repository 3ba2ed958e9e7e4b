// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points of the boundary of a solid, and balls to begin with that are to be grown inwards from them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// A point of `∂S` and the direction inwards there.
struct BoundaryPoint {
    Point place;
    Point inwards;  ///< need not be of unit length; 0 if nothing tells
};

/// The samples with the sum of the normals of their facets.
std::vector<BoundaryPoint> samples_with_normals(const Samples& samples);

/// These, and the points of `∂S` nearest to the centroids of their facets. \param queries counts them
std::vector<BoundaryPoint> samples_and_facets(const Samples& samples, const Solid& solid, std::int64_t& queries);

/// A point of `∂S`, a unit direction that leads inside there, and how far from it there is surely inside.
struct WayInside {
    Point place;
    Point inwards;
    double depth = 0.0;
};

/// How to go inside: along the normal, or where that does not lead inside along the middle one of the directions that
/// do. Beside crumpled and very thin parts the normals of facets mean little. Points where none leads inside, down to a
/// small part of the tolerance, have no way.
std::vector<WayInside> ways_inside(std::span<const BoundaryPoint> points, const Solid& solid, double tolerance);

/// A small ball inside beside each point.
std::vector<Ball> shallow_seeds(std::span<const WayInside> ways, double tolerance);

/// A ball for each point, as far inside as the largest one around its centre still comes within `limit` of the point.
/// Beside edges such a ball is far larger than one that touches the boundary there, and meets its neighbours.
/// \param queries counts the nearest points
std::vector<Ball> deep_seeds(std::span<const WayInside> ways, const Solid& solid, double tolerance, double limit,
                             std::int64_t& queries);

}  // namespace scaleaxis::inline v1
