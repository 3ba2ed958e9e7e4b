// SPDX-License-Identifier: Apache-2.0
/// \file
/// Gaps between rows of places on one sharp edge of the solid, where the border of the axis is not along the edge.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Where a row of places on a sharp edge ends.
struct RowEnd {
    Index vertex = kNone;  // of the complex
    Index target = kNone;  // to which it goes: rows that end in the same corner have the same
    Point place;           // of the target
    bool is_corner = false;
    Point direction;  // along the edge: on from the end, but from a corner back along the row
};

/// Vertices of the rows that end at a target.
struct RowsOfTarget {
    std::vector<Index> feet;    // those that go to the target
    std::vector<Index> others;  // those that go elsewhere, below which there is to be no bridge to the target
};

/// A way through the complex from one end to another, below a part of the edge.
struct Bridge {
    Index from = kNone;  // among the ends
    Index to = kNone;
    std::vector<Index> way;         // vertices of the complex, both ends included
    std::vector<Point> places;      // the nearest on the edge to each
    std::vector<double> positions;  // of these along the edge
};

/// Bridges from ends of rows to those that the edge leads to next, and between corners on a short edge without a row,
/// if the edge is sharp all the way, and if the complex has a way that is hardly longer. \param same_place closer
/// places are one
std::vector<Bridge> bridges_between(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                                    double same_place, std::span<const RowEnd> ends,
                                    std::unordered_map<Index, RowsOfTarget> rows);

}  // namespace scaleaxis::inline v1
