// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/triangle_edges.hpp"

#include <algorithm>
#include <span>

#include "base/grouped.hpp"

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {

IndexLists sides_of_edges(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
    struct Side {
        Index far_end;
        Index id;
        auto operator<=>(const Side&) const = default;
    };
    // By the smaller end, and by the larger one among these few.
    const auto side_count = static_cast<Index>(3 * triangles.size());
    Lists<Side> sides = lists_of<Side>(vertex_count, [&](const auto& add) {
        for (Index s = 0; s < side_count; ++s) {
            const auto [low, high] = std::minmax({start_of(triangles, s), end_of(triangles, s)});
            add(low, Side{high, s});
        }
    });
    IndexLists edges;
    edges.offsets.reserve(sides.items.size() / 2 + 1);
    edges.items.resize(sides.items.size());
    CancellationPoint cancellation;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        cancellation();
        const std::span<Side> at_vertex = sides[v];
        std::ranges::sort(at_vertex);
        for (std::size_t i = 0; i < at_vertex.size(); ++i) {
            const Index next = sides.offsets[v] + static_cast<Index>(i) + 1;
            edges.items[next - 1] = at_vertex[i].id;
            if (i + 1 == at_vertex.size() || at_vertex[i].far_end != at_vertex[i + 1].far_end) {
                edges.offsets.push_back(next);
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

}  // namespace scaleaxis::inline v1
