// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// The spheres of a union of balls, and what is known of the parts of them that no other ball covers.
struct VisibleSpheres {
    std::vector<Ball> balls;      ///< only those of `visible` have such parts
    std::vector<Index> visible;   ///< the balls of the dual complex
    IndexLists neighbors;         ///< of each ball: in the dual complex. They cover all that any other ball covers
    std::vector<Point> vertices;  ///< where three spheres meet that no ball covers
    std::vector<std::array<Index, 3>> vertex_balls;  ///< of each vertex
    IndexLists ball_vertices;                        ///< of each ball
};

/// The area of the parts of the spheres that no other ball covers, about: from a few random points on each.
double visible_area(const VisibleSpheres& spheres, std::uint64_t seed);

/// Random points on the parts of the spheres that no other ball covers: about one for each `area`, evenly spread,
/// and some on every ball that lies alone, however small. Parts smaller than `area` may get none.
std::vector<Point> visible_points(const VisibleSpheres& spheres, double area, std::uint64_t seed);

}  // namespace scaleaxis
