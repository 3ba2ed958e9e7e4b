// SPDX-License-Identifier: Apache-2.0
/// \file
/// The border of an axis in parts, each along one sharp edge of the solid, from corner to corner.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "axis/sharp_edges/border.hpp"
#include "base/disjoint_sets.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// Vertices that go to the same corner: trees of edges of the complex, so that cones on them change nothing about the
/// homotopy type.
struct CornerTrees {
    DisjointSets sets;          // of vertices of the complex
    std::vector<Index> of_set;  // at its representative, a vertex of the border in it that knows the corner
    std::vector<std::array<Index, 2>> tree_edges;  // of vertices of the complex
};

/// Joins vertices of the border with the same corner: those beside each other, and then others along the shortest way
/// across the complex, which takes the place of a seam where the filter, or the gaps between balls, have made two
/// sheets of three. Vertices of the border on that way know the corner from then on.
CornerTrees corners_of(const MedialComplex& complex, Border& border, double same_place);

/// A part of the border along one sharp edge: vertices of the border one after the other, and where each is on the
/// edge.
struct Chain {
    std::vector<Index> at;
    std::vector<double> positions;  // along the edge, ascending
    bool is_closed = false;
};

/// \param same_place closer places are one
std::vector<Chain> chains_of(const MedialComplex& complex, const Border& border, CornerTrees& corners, double tolerance,
                             double same_place);

/// Which vertices of a row arrive at the same place, so that none goes back where the row does: the blocks of an
/// isotonic regression of the positions, by pooling of adjacent violators. First and last of each, ascending.
std::vector<std::array<std::size_t, 2>> blocks_of(const std::vector<double>& positions, double same_place);

}  // namespace scaleaxis::inline v1
