// SPDX-License-Identifier: Apache-2.0
#include "sampling/thin_sizes.hpp"

#include <algorithm>
#include <vector>

#include "base/numbers.hpp"
#include "base/vectors.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Surface Delaunay balls may have this part of half the thickness. With 0.8, as where the solid is thicker than δ, a
// plate takes 1.6 times as many samples, and the repair has nothing left to do; with 1.25 it comes out with holes.
constexpr double kOfThinPart = 1.0;

}  // namespace

ThinSizes::ThinSizes(std::span<const Ball> balls, double reach) : reach_(reach), least_(kInfinity) {
    if (balls.empty()) {
        return;
    }
    const auto centers = each_of<Point>(balls, &Ball::center);
    tree_ = build_point_tree(centers);
    for (const Index i : tree_.order) {
        sizes_.push_back(kOfThinPart * balls[i].radius);
        least_ = std::min(least_, sizes_.back());
    }
}

std::optional<double> ThinSizes::at(const Point& place) const {
    if (empty()) {
        return std::nullopt;
    }
    const NearPoint nearest = nearest_point(tree_, place);
    if (nearest.squared_distance > reach_ * reach_) {
        return std::nullopt;
    }
    return sizes_[nearest.position];
}

}  // namespace scaleaxis::inline v1
