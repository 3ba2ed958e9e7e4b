// SPDX-License-Identifier: Apache-2.0
/// \file
/// A bounding-volume hierarchy over slabs.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "spatial/box_tree.hpp"
#include "spatial/slab.hpp"

namespace scaleaxis {

/// The boxes of the tree are around the simplices alone; no ball reaches farther beyond them than the radius given.
struct SlabTree : BoxTree {
    std::vector<Float4> radii;  ///< largest radius in each child of each node, in the frame
    std::vector<Slab> slabs;    ///< in the order of the leaves
};

/// \param slabs at least one; finite
SlabTree build_slab_tree(std::span<const Slab> slabs);

/// The ball, of those of all slabs, for which |p - centre| - radius is least, if that is less than `limit`; else one
/// whose distance is `limit`. Of several it is that of the slab given first.
struct NearestSlab {
    Index slab = kNone;  ///< as numbered when the tree was built
    SlabBall near;
};
NearestSlab nearest_slab(const SlabTree& tree, const Point& p, double limit = std::numeric_limits<double>::infinity());

/// Is there a ball with |p - centre| - radius ≤ `limit`? Quick if there is one with its centre within `reach` of `p`:
/// these are looked at first.
bool is_near_slab(const SlabTree& tree, const Point& p, double limit, double reach = 0.0);

}  // namespace scaleaxis
