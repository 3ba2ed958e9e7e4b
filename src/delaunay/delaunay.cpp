// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/delaunay.hpp"

#include <algorithm>
#include <string>

#include "base/parallel.hpp"
#include "delaunay/triangulation.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {

Delaunay delaunay(std::span<const Point> points, std::span<const double> weights, const Execution& execution) {
    if (!weights.empty() && weights.size() != points.size()) {
        throw UnusableInput("there are " + std::to_string(weights.size()) + " weights for " +
                            std::to_string(points.size()) + " points; each point needs one");
    }
    return in_arena(execution, [&] {
        TriangulationBuilder builder = TriangulationBuilder::of_hull(!weights.empty());
        builder.insert(points, weights);
        const std::vector<Tetrahedron> cells = builder.finish().cells;
        // In their order those with ghosts come first.
        const auto first =
            std::ranges::partition_point(cells, [](const Tetrahedron& cell) { return is_ghost(cell.vertices[0]); }) -
            cells.begin();
        Delaunay result;
        result.tetrahedra.resize(cells.size() - first);
        result.neighbors.resize(cells.size() - first);
        for_each_index(result.tetrahedra.size(), [&](std::size_t i) {
            const Tetrahedron& cell = cells[first + i];
            result.tetrahedra[i] = cell.vertices;
            std::ranges::transform(cell.neighbors, result.neighbors[i].begin(), [&](Index neighbor) {
                return neighbor < first ? kNone : static_cast<Index>(neighbor - first);
            });
        });
        return result;
    });
}

}  // namespace scaleaxis::inline v1
