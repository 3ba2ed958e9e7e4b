// SPDX-License-Identifier: Apache-2.0
/// \file
/// The combinatorial structure of a union of balls: its dual complex and the vertices of its boundary.
#pragma once

#include <span>
#include <vector>

#include "balls/dual_complex.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The dual complex and the boundary vertices of balls in general position. Their balls are numbered as in `balls`.
struct UnionComplex {
    std::vector<Ball> balls;   ///< distinct, in general position
    std::vector<Index> given;  ///< the position of each among the balls given; empty if none of these was left out
    DualComplex dual;
    BoundaryVertices vertices;

    Index given_ball(Index ball) const { return given.empty() || ball == kNone ? ball : given[ball]; }
};

/// What lies beside what.
struct UnionAdjacency {
    IndexLists neighbors;        ///< of each ball: in the dual complex. They cover all that any other ball covers of it
    IndexLists vertices;         ///< of each ball: the boundary vertices on its sphere
    std::vector<Index> visible;  ///< the balls of the dual complex. No others have a part of the union's boundary
};

/// How far the centre of a ball in general position is from that of the ball given, at most; relative to its radius.
inline constexpr double kGeneralPosition = 1e-9;

/// The balls grown by 2e-9 of their radii and moved by at most 1e-9 of them: less than a file in single precision can
/// tell, but enough for predicates to be decided without exact arithmetic. Balls that touch still do.
std::vector<Ball> in_general_position(std::span<const Ball> balls);

/// Can they be computed with?
/// \throws UnusableInput if there are no balls, or as `check_balls`, or if the union is too far from the origin for its
///     size, or too small or too large for the range of numbers (see `extent_fault`)
void check_union(std::span<const Ball> balls);

/// \param balls any
UnionComplex union_complex(std::span<const Ball> balls);

BoundaryVertices boundary_vertices(const DualComplex& complex, std::span<const Ball> balls);

UnionAdjacency union_adjacency(const UnionComplex& complex);

}  // namespace scaleaxis::inline v1
