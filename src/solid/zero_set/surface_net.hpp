// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles near the zero of a function that is known at the points of a lattice.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "solid/zero_set/lattice.hpp"
#include "solid/zero_set/near_cells.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// How near a net is to the zero where this crosses edges of the lattice, as a part of the step. A curved surface is as
/// far from the triangles between its places if it turns by 5 degrees in a step.
inline constexpr double kNetAccuracy = 0.01;

/// What is known of a zero in a cell with corners on both sides.
struct NetCell {
    Point vertex;  ///< close to the zero
    /// Where it crosses the edges of the cell from corner 0 along each axis, if it does.
    std::array<Point, 3> crossings;
};

/// A face of four corners, the vertices of the cells around it, across each edge of the lattice that the zero crosses
/// (S. Gibson, "Constrained elastic surface nets", 1998), with a vertex at the crossing where that is off the face.
/// Where more than one sheet passes a cell they share its vertex: the triangles tell where to look, not how the surface
/// is connected.
/// \param cells those with corners on both sides, ascending by the last coordinate first; none at a side of the lattice
/// \param points of each of them
TriangleMesh surface_net(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                         const std::vector<NetCell>& points);

/// From the trilinear interpolant. \param values the values at the corners of cell `i`; is asked from several threads
/// at once
std::vector<NetCell> net_of_interpolant(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                                        const std::function<CornerValues(std::size_t)>& values);

/// A place of the zero on an edge of the lattice, and the normal there, 0 where it has none.
struct EdgeCrossing {
    Point place;
    Point normal;
};

/// Vertices where the tangent planes at the crossings of a cell's edges meet, so on the edges of a solid and in its
/// corners (T. Ju, F. Losasso, S. Schaefer, J. Warren, "Dual contouring of Hermite data", 2002).
/// \param crossings of each cell, along the edges from corner 0
std::vector<NetCell> net_of_planes(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                                   const std::vector<std::array<EdgeCrossing, 3>>& crossings);

/// Such a net as the place to start searches from.
struct NetTree {
    Bvh bvh;
    TriangleBounds bounds;
    double margin = 0.0;  ///< the net is nearer than this to the surface: the diagonal of a cell

    /// The point of the net nearest to `p`, if the surface may be closer than `bound`. Hardly anywhere is the net as
    /// far off as it may be: a bound that is wider by a part of that is tried first.
    std::optional<Point> start_of_search(const Point& p, double bound) const {
        for (const double part : {0.1, 1.0}) {
            const NearTriangle nearest = nearest_triangle(bvh, bounds, p, bound + part * margin);
            if (nearest.triangle != kNone) {
                return nearest.point;
            }
        }
        return std::nullopt;
    }
};

/// See `surface_net`.
NetTree net_tree(const Lattice& lattice, const std::vector<SurfaceCell>& cells, const std::vector<NetCell>& points);

}  // namespace scaleaxis::inline v1
