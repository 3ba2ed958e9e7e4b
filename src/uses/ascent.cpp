// SPDX-License-Identifier: Apache-2.0
#include "uses/ascent.hpp"

#include <algorithm>
#include <cstddef>

#include "axis/complex.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::size_t kMostFaceVertices = 100;

}  // namespace

std::vector<std::uint8_t> steep_vertices(const MedialComplex& complex, std::span<const std::array<Index, 2>> edges,
                                         double slope) {
    const IndexLists neighbors = grouped_both_ways(complex.vertices.size(), edges);
    return collect<std::vector<std::uint8_t>>(
        complex.vertices.size(),
        [&](std::size_t start, std::vector<std::uint8_t>& out) {
            const Ball ball{complex.vertices[start], complex.radii[start]};
            std::vector<Index> seen{static_cast<Index>(start)};
            bool is_steep = false;
            for (std::size_t i = 0; i < seen.size() && !is_steep; ++i) {
                for (const Index v : neighbors[seen[i]]) {
                    const double way = distance(complex.vertices[v], ball.center);
                    const bool is_near = i == 0 || way <= kNearby * ball.radius;
                    if (is_near && seen.size() < kMostFaceVertices && std::ranges::find(seen, v) == seen.end()) {
                        seen.push_back(v);
                        is_steep =
                            is_steep || complex.radii[v] - ball.radius > slope * way + kRelativeRounding * ball.radius;
                    }
                }
            }
            out.push_back(is_steep ? 1 : 0);
        },
        std::size_t{64});
}

}  // namespace scaleaxis::inline v1
