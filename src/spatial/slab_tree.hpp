// SPDX-License-Identifier: Apache-2.0
/// \file
/// A bounding-volume hierarchy over slabs.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "spatial/box_tree.hpp"
#include "spatial/slab.hpp"

namespace scaleaxis::inline v1 {

/// Four slabs of a tree, in its frame and in single precision: how far a point is from them at least is cheap to say.
struct alignas(64) SlabBlock {
    static constexpr int kSize = BoxTree::kWidth;

    std::array<Float4, 3> middles;                 ///< means of the corners, coordinate by coordinate
    std::array<std::array<Float4, 3>, 3> corners;  ///< from there; of a slab with fewer of them one is repeated
    std::array<Float4, 3> radii;                   ///< rounded up

    /// At most |p - centre| - radius of every ball, up to rounding of `p`. As a function on the simplex that is convex,
    /// and its tangent at the mean lies below it: close where the simplex is small beside the distance.
    Float4 least_distances(const std::array<float, 3>& p) const {
        constexpr float kTiny = 1e-30F;  // of a point in the middle the way is 0, whatever it is divided by
        const Float4 x = middles[0] - p[0], y = middles[1] - p[1], z = middles[2] - p[2];
        const Float4 square = x * x + y * y + z * z;
        const Float4 far{std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]), std::sqrt(square[3])};
        const Float4 inverse{1.0F / (far[0] + kTiny), 1.0F / (far[1] + kTiny), 1.0F / (far[2] + kTiny),
                             1.0F / (far[3] + kTiny)};
        const auto from_middle = [&](int k) {
            return (x * corners[k][0] + y * corners[k][1] + z * corners[k][2]) * inverse - radii[k];
        };
        return far + lesser(from_middle(0), lesser(from_middle(1), from_middle(2)));
    }
};

/// The boxes of the tree are around the simplices alone; no ball reaches farther beyond them than the radius given.
struct SlabTree : BoxTree {
    std::vector<Float4> radii;      ///< largest radius in each child of each node, in the frame
    std::vector<Slab> slabs;        ///< in the order of the leaves
    std::vector<SlabBlock> blocks;  ///< slab `i` is in block `i / 4`
};

namespace slab_tree_details {

/// Lower bounds of |p - centre| - radius in the children of a node, in the frame.
Float4 least_distances(const SlabTree& tree, const BoxTree::Node& node, const FramedPoint& p);

/// A distance in the frame, larger than it by more than rounding.
float in_frame(const SlabTree& tree, double distance);

}  // namespace slab_tree_details

/// \param slabs at least one; finite
SlabTree build_slab_tree(std::span<const Slab> slabs);

/// The ball, of those of all slabs, for which |p - centre| - radius is least, if that is less than `limit`; else one
/// whose distance is `limit`. Of several it is that of the slab given first.
struct NearestSlab {
    Index slab = kNone;  ///< as numbered when the tree was built
    SlabBall near;
};
NearestSlab nearest_slab(const SlabTree& tree, const Point& p, double limit = std::numeric_limits<double>::infinity());

/// A slab of which a ball has |p - centre| - radius ≤ `limit`, or null. Quick if there is one with its centre within
/// `reach` of `p`: these are looked at first.
const Slab* slab_within(const SlabTree& tree, const Point& p, double limit, double reach = 0.0);

/// The ball that must grow by the least factor to reach `p`, if that is less than `limit`; else one without a radius
/// whose growth is `limit`. Of several it is that of the slab given first.
GrownBall least_grown_slab(const SlabTree& tree, const Point& p,
                           double limit = std::numeric_limits<double>::infinity());

/// The largest ball with |p - centre| ≤ `growth` times its radius; nothing if there is none.
std::optional<Ball> largest_slab_ball(const SlabTree& tree, const Point& p, double growth);

/// Calls `visit(i)` for all slabs, as `tree.slabs` has them, that may have a ball with |p - centre| - radius ≤ `limit`.
template <class Visit>
void for_each_near_slab(const SlabTree& tree, const Point& p, double limit, const Visit& visit) {
    const FramedPoint framed(tree, p);
    const float most = slab_tree_details::in_frame(tree, limit);
    const auto hit = [&](const BoxTree::Node& node) {
        return slab_tree_details::least_distances(tree, node, framed) <= most;
    };
    box_tree_details::for_each_leaf(tree, hit, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            visit(i);
        }
    });
}

}  // namespace scaleaxis::inline v1
