// SPDX-License-Identifier: Apache-2.0
#include "balls/critical_points.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/parallel.hpp"
#include "delaunay/edges.hpp"
#include "delaunay/tetrahedron.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis::inline v1 {
namespace {

using Balls = std::span<const Ball>;
using Critical = std::vector<CriticalPoint>;

// Bit `k` of a cell: its ball at `k` is in conflict with the smallest sphere orthogonal to the three others. So the
// facet opposite is not Gabriel, and the cell does not contain its own point of equal power.
// Of the wanted cells and those beside them; the others have none.
std::vector<std::uint8_t> conflicts_of_cells(const Triangulation& t, Balls balls,
                                             std::span<const std::uint8_t> is_wanted) {
    std::vector<std::uint8_t> bits(t.size());
    for_each_index(t.size(), [&](std::size_t cell) {
        const auto& [v, neighbors] = t.cells[cell];
        const bool is_beside = std::any_of(neighbors.begin(), neighbors.end(), [&](Index neighbor) {
            return neighbor != kNone && is_wanted[neighbor] != 0;
        });
        if ((is_wanted[cell] == 0 && !is_beside) || std::any_of(v.begin(), v.end(), is_ghost)) {
            return;  // a ghost is far away from everything, and facets with one are nobody's
        }
        bits[cell] =
            static_cast<std::uint8_t>(conflicts_of_corners(balls[v[0]], balls[v[1]], balls[v[2]], balls[v[3]]));
    });
    return bits;
}

template <class... Ids>
void add(Critical& out, CriticalPoints wanted, Balls balls, Ids... ids) {
    const bool is_covered = meet(balls[ids]...);
    if (is_covered && wanted == CriticalPoints::kUncovered) {
        return;
    }
    const OrthogonalSphere sphere = orthogonal_sphere(balls[ids]...);
    CriticalPoint point{{kNone, kNone, kNone, kNone}, sphere.center, sphere.power, is_covered};
    std::copy_n(std::array{ids...}.begin(), sizeof...(ids), point.balls.begin());
    std::sort(point.balls.begin(), point.balls.end());
    out.push_back(point);
}

// Does the triangle contain its point of equal power? Its edges and the balls opposite decide.
bool is_centered(const Ball& a, const Ball& b, const Ball& c) {
    return !conflicts(a, b, c) && !conflicts(b, c, a) && !conflicts(c, a, b);
}

}  // namespace

std::vector<CriticalPoint> critical_points(const Triangulation& t, std::span<const Ball> balls, CriticalPoints wanted) {
    return critical_points_of_cells(t, balls, wanted, std::vector<std::uint8_t>(t.size(), 1));
}

std::vector<CriticalPoint> critical_points_of_cells(const Triangulation& t, std::span<const Ball> balls,
                                                    CriticalPoints wanted, std::span<const std::uint8_t> is_wanted) {
    const std::vector<std::uint8_t> bits = conflicts_of_cells(t, balls, is_wanted);
    const auto is_real = [&](Index cell) {
        const std::array<Index, 4>& v = t.cells[cell].vertices;
        return std::none_of(v.begin(), v.end(), is_ghost);
    };
    Critical points = collect<Critical>(static_cast<Index>(t.size()), [&](Index cell, Critical& out) {
        if (is_wanted[cell] == 0) {
            return;
        }
        const std::array<Index, 4>& v = t.cells[cell].vertices;
        if (is_real(cell) && bits[cell] == 0) {
            add(out, wanted, balls, v[0], v[1], v[2], v[3]);
        }
        for (int k = 0; k < 4; ++k) {
            const Index neighbor = t.cells[cell].neighbors[k];
            const bool is_theirs = neighbor < cell && (neighbor == kNone || is_wanted[neighbor] != 0);
            if (is_theirs || (bits[cell] >> k & 1) != 0) {
                continue;  // each triangle once; beyond the ghosts there is nothing
            }
            const auto [p, q, r] = facet_of_cell(v, k);
            if (is_ghost(p) || is_ghost(q) || is_ghost(r)) {
                continue;
            }
            const int mirror = position_of(t.cells[neighbor].neighbors, cell);
            if ((bits[neighbor] >> mirror & 1) == 0 && is_centered(balls[p], balls[q], balls[r])) {
                add(out, wanted, balls, p, q, r);
            }
        }
    });
    const auto is_wanted_cell = [&](Index cell) { return is_wanted[cell] != 0; };
    append(points, collect_edges<Critical>(t, is_wanted_cell, [&](const auto& around, Critical& out) {
               const auto [p, q] = ends_of_edge(t, around.front());
               if (is_ghost(p) || is_ghost(q) || conflicts(balls[p], balls[q]) || conflicts(balls[q], balls[p])) {
                   return;
               }
               const bool is_gabriel =
                   std::none_of(around.begin(), around.end(), [&, p = p, q = q](const AroundEdge& at) {
                       const Index other = t.cells[at.cell].vertices[at.apex];
                       return !is_ghost(other) && conflicts(balls[p], balls[q], balls[other]);
                   });
               if (is_gabriel) {
                   add(out, wanted, balls, p, q);
               }
           }));
    return points;
}

}  // namespace scaleaxis::inline v1
