// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the neighbours of points tell about the surface that they were taken from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {

/// A quadric fitted to the nearest points of a point.
struct LocalFit {
    Point normal;                  ///< at the point; of length 1, of either direction
    double residual = 0.0;         ///< standard deviation of the neighbours from the quadric
    double radius = 0.0;           ///< distance of the farthest neighbour
    double height = 0.0;           ///< of the point above or below the quadric through the others alone
    double others_residual = 0.0;  ///< the residual of this quadric
};

/// \param neighbors nearest points of `p`, by distance; the first one is `p` itself if it is a point of the tree
LocalFit fit_quadric(const PointTree& tree, const Point& p, std::span<const NearPoint> neighbors);

/// The quadric at a point of the tree.
/// \param neighbors how many nearest points to take, without the point itself; ≥ 3
LocalFit fit_locally(const PointTree& tree, const Point& p, std::size_t neighbors, std::vector<NearPoint>& memory);

/// The largest angle, as seen from `p` in the plane with this normal, between nearest points next to each other;
/// radians.
double largest_gap(const PointTree& tree, const Point& p, const Point& normal, std::size_t neighbors,
                   std::vector<NearPoint>& memory);

/// The points in parts: those connected by steps from a point to one of its nearest neighbours, or back.
IndexLists connected_parts(const PointTree& tree, std::span<const Point> points, std::size_t neighbors);

/// Flips normals of a connected part so that those of neighbours point to the same side: they are followed along a
/// minimum spanning tree of the graph of nearest neighbours (H. Hoppe and others, "Surface reconstruction from
/// unorganized points", 1992), in which neighbours are near to each other if their normals are those of a circle.
/// \param noise how far points around each one lie off their surface: a standard deviation
void orient_consistently(std::span<const Point> points, std::span<const Index> part, std::span<const double> noise,
                         std::size_t neighbors, std::vector<Point>& normals);

/// Do all points lie in a plane, to within rounding?
bool are_coplanar(std::span<const Point> points);

}  // namespace scaleaxis::inline v1
