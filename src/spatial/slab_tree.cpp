// SPDX-License-Identifier: Apache-2.0
#include "spatial/slab_tree.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/parallel.hpp"
#include "base/vectors.hpp"

namespace scaleaxis::inline v1 {
namespace {

Box box_around_simplex(const Slab& slab) {
    Box box;
    for (int k = 0; k < slab.size; ++k) {
        box.extend(slab.corners[k].center);
    }
    return box;
}

// Distances of a point from the boxes of the children, or a little less, in the frame.
Float4 least_distances_from_boxes(const BoxTree::Node& node, const FramedPoint& p) {
    const Float4 square = squared_distances(node, p);
    return Float4{std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]), std::sqrt(square[3])} - p.slack;
}

void put(SlabBlock& block, int lane, const SlabTree& tree, const Slab& slab) {
    Point sum;
    for (int k = 0; k < slab.size; ++k) {
        sum = sum + tree.in_frame(slab.corners[k].center);
    }
    const Point middle = (1.0 / slab.size) * sum;
    set_lane(block.middles, lane, middle);
    for (int k = 0; k < 3; ++k) {
        const Ball& corner = slab.corners[k < slab.size ? k : 0];
        set_lane(block.corners[k], lane, tree.in_frame(corner.center) - middle);
        block.radii[k][lane] = slab_tree_details::in_frame(tree, corner.radius);
    }
}

/// Calls `visit(i)` for the slabs of a leaf that may have a ball with |p - centre| - radius ≤ `most()`, until it
/// returns true. \param most in the frame, asked for each block
template <class Most, class Visit>
bool any_near_in_leaf(const SlabTree& tree, Index first, Index count, const FramedPoint& p, const Most& most,
                      const Visit& visit) {
    const Index end = first + count;
    for (Index block = first / SlabBlock::kSize; block * SlabBlock::kSize < end; ++block) {
        const Float4 least = tree.blocks[block].least_distances(p.at) - p.slack;
        for (int k = 0; k < SlabBlock::kSize; ++k) {
            const Index i = block * SlabBlock::kSize + k;
            if (i >= first && i < end && least[k] <= most() && visit(i)) {
                return true;
            }
        }
    }
    return false;
}

// An order of points, so that of equal balls always the same one is found.
bool comes_before(const Point& a, const Point& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

// A factor, larger than it by more than rounding.
float rounded_up(double factor) { return static_cast<float>(factor) * (1.0F + BoxTree::kPadding); }

}  // namespace

namespace slab_tree_details {

Float4 least_distances(const SlabTree& tree, const BoxTree::Node& node, const FramedPoint& p) {
    return least_distances_from_boxes(node, p) - tree.radii[&node - tree.nodes.data()];
}

float in_frame(const SlabTree& tree, double distance) {
    const double framed = distance * tree.scale;
    return static_cast<float>(framed) + BoxTree::kPadding * static_cast<float>(1.0 + std::abs(framed));
}

}  // namespace slab_tree_details

using slab_tree_details::in_frame;
using slab_tree_details::least_distances;

SlabTree build_slab_tree(std::span<const Slab> slabs) {
    const auto boxes = mapped<Box>(slabs.size(), [&](std::size_t i) { return box_around_simplex(slabs[i]); });
    SlabTree tree{build_box_tree(boxes), {}, {}, {}};
    tree.slabs = each_of<Slab>(tree.order, [&](Index i) { return slabs[i]; });
    tree.blocks.resize((slabs.size() + SlabBlock::kSize - 1) / SlabBlock::kSize);
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        put(tree.blocks[i / SlabBlock::kSize], static_cast<int>(i % SlabBlock::kSize), tree, tree.slabs[i]);
    }
    tree.radii.resize(tree.nodes.size());
    for (std::size_t n = tree.nodes.size(); n-- > 0;) {  // children before parents
        const BoxTree::Node& node = tree.nodes[n];
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            tree.radii[n][k] = 0.0F;
            if (node.count[k] == 0 && node.first[k] > 0 && node.bounds[0][0][k] <= node.bounds[1][0][k]) {
                tree.radii[n][k] = largest_of(tree.radii[n + static_cast<std::size_t>(node.first[k])]);
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
            any_near_in_leaf(
                tree, first, count, framed, [&] { return best; },
                [&](Index i) {
                    const SlabBall near = nearest_ball(tree.slabs[i], p);
                    const bool is_first = nearest.slab != kNone && tree.order[i] < nearest.slab;
                    if (near.distance < nearest.near.distance || (near.distance == nearest.near.distance && is_first)) {
                        nearest = {tree.order[i], near};
                        best = in_frame(tree, near.distance);
                    }
                    return false;
                });
        });
    return nearest;
}

const Slab* slab_within(const SlabTree& tree, const Point& p, double limit, double reach) {
    const FramedPoint framed(tree, p);
    const float most = in_frame(tree, limit);
    const Slab* found = nullptr;
    const auto is_any_near = [&](Index first, Index count) {
        return any_near_in_leaf(
            tree, first, count, framed, [&] { return most; },
            [&](Index i) {
                found = nearest_ball(tree.slabs[i], p).distance <= limit ? &tree.slabs[i] : nullptr;
                return found != nullptr;
            });
    };
    if (reach > 0.0) {
        const float far = in_frame(tree, reach) + framed.slack;
        const auto hit = [&](const BoxTree::Node& node) { return squared_distances(node, framed) <= far * far; };
        if (box_tree_details::any_leaf(tree, hit, is_any_near)) {
            return found;
        }
    }
    const auto hit = [&](const BoxTree::Node& node) { return least_distances(tree, node, framed) <= most; };
    box_tree_details::any_leaf(tree, hit, is_any_near);
    return found;
}

GrownBall least_grown_slab(const SlabTree& tree, const Point& p, double limit) {
    const FramedPoint framed(tree, p);
    GrownBall least{{}, limit};
    Index first_slab = kNone;
    float best = rounded_up(limit);
    const auto least_growth = [&](const BoxTree::Node& node) {
        const Float4& radii = tree.radii[&node - tree.nodes.data()];
        Float4 bound = greater(least_distances_from_boxes(node, framed), Float4{});
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            bound[k] /= radii[k];
        }
        return bound;
    };
    for_each_better_leaf(tree, least_growth, best, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            const GrownBall grown = least_grown_ball(tree.slabs[i], p);
            const bool is_first = first_slab != kNone && tree.order[i] < first_slab;
            if (grown.growth < least.growth || (grown.growth == least.growth && is_first)) {
                least = grown;
                first_slab = tree.order[i];
            }
        }
        best = rounded_up(least.growth);
    });
    return least;
}

std::optional<Ball> largest_slab_ball(const SlabTree& tree, const Point& p, double growth) {
    const FramedPoint framed(tree, p);
    const float factor = rounded_up(growth);
    std::optional<Ball> largest;
    float best = 0.0F;  // the negative of a radius, so that larger balls are better
    const auto negative_radius = [&](const BoxTree::Node& node) {
        const Float4& radii = tree.radii[&node - tree.nodes.data()];
        const Float4 distances = least_distances_from_boxes(node, framed);
        Float4 bound;
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            bound[k] = distances[k] <= factor * radii[k] ? -radii[k] : std::numeric_limits<float>::infinity();
        }
        return bound;
    };
    for_each_better_leaf(tree, negative_radius, best, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            const auto ball = largest_ball(tree.slabs[i], p, growth);
            if (ball && (!largest || ball->radius > largest->radius ||
                         (ball->radius == largest->radius && comes_before(ball->center, largest->center)))) {
                largest = ball;
            }
        }
        best = largest ? -static_cast<float>(largest->radius * tree.scale) * (1.0F - BoxTree::kPadding) : best;
    });
    return largest;
}

}  // namespace scaleaxis::inline v1
