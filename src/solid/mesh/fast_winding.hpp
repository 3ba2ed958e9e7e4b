// SPDX-License-Identifier: Apache-2.0
/// \file
/// Generalized winding numbers of any triangles.
#pragma once

#include <array>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// The part of the full sphere that triangles hide, seen from a point: 1 inside and 0 outside a closed surface, in
/// between around an open one (A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust inside-outside segmentation using
/// generalized winding numbers", 2013). Triangles far away count together, as one dipole (G. Barill, N. Dickson,
/// R. Schmidt, D. Levin, A. Jacobson, "Fast winding numbers for soups and clouds", 2018).
class FastWinding {
   public:
    /// \param bvh has to outlive this object
    explicit FastWinding(const Bvh& bvh);

    double operator()(const Point& p) const;

   private:
    struct Dipole {
        Point center;         ///< mean of the triangles, by area
        Point area;           ///< sum of their normals, as long as they are large
        double reach = -1.0;  ///< squared distance from the center from which on they count together; < 0: no child
    };

    double below(Index node, const Point& p) const;

    const Bvh& bvh_;
    std::vector<std::array<Dipole, Bvh::kWidth>> dipoles_;  ///< of the children of each node
};

}  // namespace scaleaxis::inline v1
