// SPDX-License-Identifier: Apache-2.0
/// \file
/// What tells a sheet between two sides of a solid from one that runs into an edge.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "base/grouped.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

/// Where the radius grows from a vertex on as fast as in an edge. Angles of single simplices are noisy where these are
/// small; so the way over the largest neighbours is followed for about a radius, and what is beside it is looked at.
class Ascent {
   public:
    Ascent(const MedialComplex& complex, std::span<const std::array<Index, 2>> edges)
        : complex_(complex), neighbors_(grouped_both_ways(complex.vertices.size(), edges)) {}

    /// \param simplex a face or an edge \param slope growth of the radius along the way, at least
    bool is_steep(std::span<const Index> simplex, double slope) const {
        const auto& radii = complex_.radii;
        const Index start = *std::ranges::max_element(simplex, {}, [&](Index v) { return radii[v]; });
        const auto way_to = [&](Index v) { return distance(complex_.vertices[v], complex_.vertices[start]); };
        for (Index at = start; way_to(at) < kAscent * radii[start];) {
            Index next = at;
            for (const Index v : neighbors_[at]) {
                const double way = way_to(v);
                if (way > kLeastAscent * radii[start] && radii[v] - radii[start] > slope * way) {
                    return true;
                }
                next = radii[v] > radii[next] ? v : next;
            }
            if (next == at) {
                return false;
            }
            at = next;
        }
        return false;
    }

   private:
    static constexpr double kAscent = 0.75;      // of the radius
    static constexpr double kLeastAscent = 0.1;  // nearer ones say nothing

    const MedialComplex& complex_;
    IndexLists neighbors_;
};

}  // namespace scaleaxis
