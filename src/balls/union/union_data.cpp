// SPDX-License-Identifier: Apache-2.0
#include "balls/union/union_data.hpp"

#include <utility>

namespace scaleaxis::inline v1 {

UnionData::UnionData(std::vector<Ball> balls) : balls_(std::move(balls)) { check_union(balls_); }

UnionData::UnionData(std::vector<Ball> balls, UnionComplex complex)
    : balls_(std::move(balls)), complex_(std::move(complex)) {}

const BallTree& UnionData::tree() const {
    return tree_.get([&] { return build_ball_tree(balls_); });
}

const UnionComplex& UnionData::complex() const {
    return complex_.get([&] { return union_complex(balls_); });
}

const UnionAdjacency& UnionData::adjacency() const {
    return adjacency_.get([&] { return union_adjacency(complex()); });
}

const UnionBoundary& UnionData::boundary() const {
    return boundary_.get([&] { return union_boundary(complex(), adjacency()); });
}

const UnionInterior& UnionData::interior() const {
    return interior_.get([&] { return union_interior(complex(), adjacency()); });
}

}  // namespace scaleaxis::inline v1
