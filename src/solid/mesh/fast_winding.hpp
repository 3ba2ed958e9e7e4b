// SPDX-License-Identifier: Apache-2.0
/// \file
/// Generalized winding numbers of any triangles.
#pragma once

#include "scaleaxis/geometry.hpp"
#include "solid/dipole_tree.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {

/// Winding numbers as a `DipoleTree` has them, of triangles.
class FastWinding {
   public:
    /// \param bvh has to outlive this object
    explicit FastWinding(const Bvh& bvh);

    double operator()(const Point& p) const;

   private:
    const Bvh& bvh_;
    DipoleTree dipoles_;
};

}  // namespace scaleaxis::inline v1
