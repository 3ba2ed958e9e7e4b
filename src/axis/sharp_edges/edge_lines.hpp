// SPDX-License-Identifier: Apache-2.0
/// \file
/// The sharp edges of a solid as lines, each from where edges meet, or end, to the next such point.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Degrees: edges of the solid are sharp from this angle between their normals on, and bends of a line corners.
inline constexpr double kLeastAngle = 40.0;

/// Tolerances: how far lines and corners may be from the edges that they stand for.
inline constexpr double kEdgeAccuracy = 0.01;

/// A line of several parts, with the normals on both sides of each.
struct EdgeLine {
    std::vector<Point> points;  // of a closed line the last one is the first
    std::vector<std::array<Point, 2>> normals;
    std::vector<double> positions;            // of the points along the line, from 0 on
    std::array<Index, 2> ends{kNone, kNone};  // lines that end in the same point have the same number; closed ones none

    bool is_closed() const { return ends[0] == kNone; }
    double length() const { return positions.back(); }

    /// The number of the part at a position; where two meet that of the second.
    std::size_t part_at(double position) const {
        const auto next = std::upper_bound(positions.begin() + 1, positions.end() - 1, position);
        return static_cast<std::size_t>(next - positions.begin()) - 1;
    }
};

/// Lines of equal edges come in the same order.
std::vector<EdgeLine> edge_lines(std::span<const SharpEdge> edges);

/// The nearest point on a line, and how far along it that is.
std::pair<Point, double> nearest_on(const EdgeLine& line, const Point& p);

/// The part of a line between two positions, in pieces no longer than `step`. Points of the line from which its pieces
/// stay within `sag` are left out.
EdgeLine section_of(const EdgeLine& line, double from, double to, double step, double sag);

}  // namespace scaleaxis::inline v1
