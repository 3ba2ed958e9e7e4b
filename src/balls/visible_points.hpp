// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of the spheres of a union of balls that no other ball covers.
#pragma once

#include <cstdint>
#include <vector>

#include "balls/union/union_complex.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Estimated area of the parts of the spheres that no other ball covers, from a few random points on each.
double visible_area(const UnionComplex& complex, const UnionAdjacency& adjacency, std::uint64_t seed);

/// Random points on the parts of the spheres that no other ball covers: about one for each `area`, evenly spread,
/// and some on every ball that lies alone, however small. Parts smaller than `area` may get none.
std::vector<Point> visible_points(const UnionComplex& complex, const UnionAdjacency& adjacency, double area,
                                  std::uint64_t seed);

}  // namespace scaleaxis::inline v1
