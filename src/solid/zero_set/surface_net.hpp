// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles near the zero of a function that is known at the points of a lattice.
#pragma once

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

/// A vertex in each cell, close to the zero of its interpolant, and a face of four corners across each edge of the
/// lattice that the zero crosses (S. Gibson, "Constrained elastic surface nets", 1998), with a vertex at the crossing
/// where that is off the face. Where more than one sheet passes a cell they
/// share its vertex: the triangles tell where to look, not how the surface is connected.
/// \param cells those with corners on both sides, ascending by the last coordinate first; none at a side of the lattice
/// \param values the values at the corners of cell `i`; is asked from several threads at once
TriangleMesh surface_net(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                         const std::function<CornerValues(std::size_t)>& values);

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
NetTree net_tree(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                 const std::function<CornerValues(std::size_t)>& values);

}  // namespace scaleaxis::inline v1
