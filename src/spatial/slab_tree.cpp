// SPDX-License-Identifier: Apache-2.0
#include "spatial/slab_tree.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace scaleaxis {
namespace {

float upper_end(Float4 values) { return std::max({values[0], values[1], values[2], values[3]}); }

Box box_around_simplex(const Slab& slab) {
    Box box;
    for (int k = 0; k < slab.size; ++k) {
        box.extend(slab.corners[k].center);
    }
    return box;
}

// Lower bounds of |p - centre| - radius in the children of a node, in the frame.
Float4 least_distances(const SlabTree& tree, const BoxTree::Node& node, const FramedPoint& p) {
    const Float4 square = squared_distances(node, p);
    const Float4 distance = {std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]), std::sqrt(square[3])};
    return distance - tree.radii[&node - tree.nodes.data()] - p.slack;
}

// A distance in the frame, larger than it by more than rounding.
float in_frame(const SlabTree& tree, double distance) {
    const double framed = distance * tree.scale;
    return static_cast<float>(framed) + BoxTree::kPadding * static_cast<float>(1.0 + std::abs(framed));
}

}  // namespace

SlabTree build_slab_tree(std::span<const Slab> slabs) {
    std::vector<Box> boxes(slabs.size());
    for_each_index(slabs.size(), [&](std::size_t i) { boxes[i] = box_around_simplex(slabs[i]); });
    SlabTree tree{build_box_tree(boxes), {}, {}};
    tree.slabs.reserve(slabs.size());
    for (const Index i : tree.order) {
        tree.slabs.push_back(slabs[i]);
    }
    tree.radii.resize(tree.nodes.size());
    for (std::size_t n = tree.nodes.size(); n-- > 0;) {  // children before parents
        const BoxTree::Node& node = tree.nodes[n];
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            tree.radii[n][k] = 0.0F;
            if (node.count[k] == 0 && node.first[k] > 0 && node.bounds[0][0][k] <= node.bounds[1][0][k]) {
                tree.radii[n][k] = upper_end(tree.radii[n + static_cast<std::size_t>(node.first[k])]);
            }
            for (Index i = node.first[k]; i < node.first[k] + node.count[k]; ++i) {
                for (int c = 0; c < tree.slabs[i].size; ++c) {
                    tree.radii[n][k] = std::max(tree.radii[n][k], in_frame(tree, tree.slabs[i].corners[c].radius));
                }
            }
        }
    }
    return tree;
}

NearestSlab nearest_slab(const SlabTree& tree, const Point& p, double limit) {
    const FramedPoint framed(tree, p);
    NearestSlab nearest{kNone, {{}, limit}};
    float best = in_frame(tree, limit);
    for_each_better_leaf(
        tree, [&](const BoxTree::Node& node) { return least_distances(tree, node, framed); }, best,
        [&](Index first, Index count) {
            for (Index i = first; i < first + count; ++i) {
                const SlabBall near = nearest_ball(tree.slabs[i], p);
                const bool is_first = nearest.slab != kNone && tree.order[i] < nearest.slab;
                if (near.distance < nearest.near.distance || (near.distance == nearest.near.distance && is_first)) {
                    nearest = {tree.order[i], near};
                }
            }
            best = in_frame(tree, nearest.near.distance);
        });
    return nearest;
}

bool is_near_slab(const SlabTree& tree, const Point& p, double limit, double reach) {
    const FramedPoint framed(tree, p);
    const auto is_any_near = [&](Index first, Index count) {
        return std::any_of(tree.slabs.begin() + first, tree.slabs.begin() + first + count,
                           [&](const Slab& slab) { return nearest_ball(slab, p).distance <= limit; });
    };
    if (reach > 0.0) {
        const float most = in_frame(tree, reach) + framed.slack;
        const auto hit = [&](const BoxTree::Node& node) { return squared_distances(node, framed) <= most * most; };
        if (box_tree_details::any_leaf(tree, hit, is_any_near)) {
            return true;
        }
    }
    const float most = in_frame(tree, limit);
    const auto hit = [&](const BoxTree::Node& node) { return least_distances(tree, node, framed) <= most; };
    return box_tree_details::any_leaf(tree, hit, is_any_near);
}

}  // namespace scaleaxis
