// SPDX-License-Identifier: Apache-2.0
/// \file
/// What several stages need of a union of balls. Everything is built when it is first asked for.
#pragma once

#include <vector>

#include "balls/dual_complex.hpp"
#include "balls/union/union_boundary.hpp"
#include "balls/union/union_complex.hpp"
#include "balls/union/union_interior.hpp"
#include "base/built_once.hpp"
#include "scaleaxis/geometry.hpp"
#include "spatial/ball_tree.hpp"

namespace scaleaxis::inline v1 {

/// The members run in the caller's arena.
class UnionData {
   public:
    /// \throws UnusableInput as `check_union`
    explicit UnionData(std::vector<Ball> balls);

    /// A union whose complex is known. \param complex of these balls as they are, without repetitions
    UnionData(std::vector<Ball> balls, UnionComplex complex);

    UnionData(const UnionData&) = delete;
    UnionData& operator=(const UnionData&) = delete;

    /// The balls as given.
    const std::vector<Ball>& balls() const { return balls_; }
    /// A tree of the balls as given.
    const BallTree& tree() const;

    // Of the balls in general position, numbered as in the complex:
    const UnionComplex& complex() const;
    const UnionAdjacency& adjacency() const;
    const UnionBoundary& boundary() const;
    const UnionInterior& interior() const;

   private:
    std::vector<Ball> balls_;
    BuiltOnce<BallTree> tree_;
    BuiltOnce<UnionComplex> complex_;
    BuiltOnce<UnionAdjacency> adjacency_;
    BuiltOnce<UnionBoundary> boundary_;
    BuiltOnce<UnionInterior> interior_;
};

}  // namespace scaleaxis::inline v1
