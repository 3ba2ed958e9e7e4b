// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which of the Delaunay tetrahedra inside a solid give the balls of its union: the poles of the samples, and those
/// that close the holes between poles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/parallel.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

// An inner Voronoi ball that is no polar ball is kept if no polar ball of its samples reaches this part of its squared
// radius beyond its centre: then the poles leave a hole there.
inline constexpr double kCoveredDepth = 0.5;

// It must not be much smaller than the polar balls of its samples: such balls only make bumps.
inline constexpr double kSmallestRadius = 0.7;

/// Inside cell of the largest radius at each sample, the sample's inner pole; `kNone` where no cell is inside.
/// \param cells has `size()` of them, of which some may be no cells; for each inside cell its `vertices`, all samples,
/// and `ball`; and an order of these by radius that is the same for the same set of cells, `is_larger`
template <class Cells>
std::vector<Index> inner_poles(const Cells& cells, std::size_t samples) {
    std::vector<Index> poles(samples, kNone);
    CancellationPoint cancellation_point;
    for (Index cell = 0; cell < cells.size(); ++cell) {
        cancellation_point();
        if (cells.is_inside(cell)) {
            for (const Index v : cells.vertices(cell)) {
                if (poles[v] == kNone || cells.is_larger(cell, poles[v])) {
                    poles[v] = cell;
                }
            }
        }
    }
    return poles;
}

/// Does the ball of an inside cell close a hole that the polar balls of its samples leave?
template <class Cells>
bool closes_hole(const Cells& cells, const std::vector<Index>& poles, Index cell) {
    const Ball ball = cells.ball(cell);
    double smallest_pole = std::numeric_limits<double>::infinity();
    for (const Index v : cells.vertices(cell)) {
        const Ball pole = cells.ball(poles[v]);
        const double depth = pole.radius * pole.radius - squared_distance(pole.center, ball.center);
        if (depth >= kCoveredDepth * ball.radius * ball.radius) {
            return false;
        }
        smallest_pole = std::min(smallest_pole, pole.radius);
    }
    return ball.radius > kSmallestRadius * smallest_pole;
}

/// The balls of the union, in the order of their cells.
template <class Cells>
std::vector<Ball> balls_of_cells(const Cells& cells, std::size_t samples) {
    const std::vector<Index> poles = inner_poles(cells, samples);
    std::vector<std::uint8_t> is_pole(cells.size());
    for (const Index pole : poles) {
        if (pole != kNone) {
            is_pole[pole] = 1;
        }
    }
    return collect<std::vector<Ball>>(cells.size(), [&](Index cell, std::vector<Ball>& out) {
        if (cells.is_inside(cell) && (is_pole[cell] != 0 || closes_hole(cells, poles, cell))) {
            out.push_back(cells.ball(cell));
        }
    });
}

}  // namespace scaleaxis::inline v1
