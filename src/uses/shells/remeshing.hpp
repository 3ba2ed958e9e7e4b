// SPDX-License-Identifier: Apache-2.0
/// \file
/// Surfaces whose sheets meet in seams, with triangles of a wanted size.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "base/angles.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The angle between two vectors, in radians.
inline double angle_of(const Point& u, const Point& v) { return angle_of(dot(u, v), norm(cross(u, v))); }

/// Triangles with the walls that they belong to. Where other than two triangles of one wall meet at an edge it is part
/// of a *curve*: a seam, a border, or a bend between two walls.
struct WallMesh {
    TriangleMesh mesh;
    std::vector<Index> walls;  ///< #T
};

/// What a mesh is fitted to. The functions are called from several threads.
struct WallShapes {
    /// The side of the solid at which the wall ends near the middle of a border edge; `kNone` if it is not known.
    std::function<Index(Index wall, const Point& middle)> rim_at;
    /// The place of a vertex on all these walls and rims.
    std::function<Point(const Point& p, std::span<const Index> walls, std::span<const Index> rims)> place;
    std::function<Point(Index wall, const Point& p)> normal;
};

/// The same surface with edges about `size` long. Curves are divided at that length, and stay curves; so do the points
/// where they meet or change walls or rims. \param farthest how far vertices may be from their places at first
WallMesh remeshed(const WallMesh& input, double size, double farthest, const WallShapes& shapes,
                  const Execution& execution);

}  // namespace scaleaxis::inline v1
