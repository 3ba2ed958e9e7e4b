// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/triangle_edges.hpp"

#include <algorithm>
#include <numeric>

namespace scaleaxis {

IndexLists sides_of_edges(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
    struct Side {
        Index far_end;
        Index id;
        auto operator<=>(const Side&) const = default;
    };
    // Sorted by the smaller end by counting, and by the larger one among these few.
    const auto side_count = static_cast<Index>(3 * triangles.size());
    std::vector<Index> first(vertex_count + 1, 0);
    for (Index s = 0; s < side_count; ++s) {
        ++first[std::min(start_of(triangles, s), end_of(triangles, s)) + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> end(first.begin(), first.end() - 1);
    std::vector<Side> sides(side_count);
    for (Index s = 0; s < side_count; ++s) {
        const auto [low, high] = std::minmax({start_of(triangles, s), end_of(triangles, s)});
        sides[end[low]++] = {high, s};
    }
    IndexLists edges;
    edges.offsets.reserve(sides.size() / 2 + 1);
    edges.items.resize(sides.size());
    for (std::size_t v = 0; v < vertex_count; ++v) {
        const auto begin = sides.begin() + first[v];
        std::sort(begin, sides.begin() + first[v + 1]);
        for (Index i = first[v]; i < first[v + 1]; ++i) {
            edges.items[i] = sides[i].id;
            if (i + 1 == first[v + 1] || sides[i].far_end != sides[i + 1].far_end) {
                edges.offsets.push_back(i + 1);
            }
        }
    }
    return edges;
}

std::vector<Index> opposite_sides(const IndexLists& edges) {
    std::vector<Index> opposite(edges.items.size(), kNone);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (const auto sides = edges[e]; sides.size() == 2) {
            opposite[sides[0]] = sides[1];
            opposite[sides[1]] = sides[0];
        }
    }
    return opposite;
}

}  // namespace scaleaxis
