// SPDX-License-Identifier: Apache-2.0
#include "delaunay/triangulation.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <string>
#include <utility>

#include "base/parallel.hpp"
#include "delaunay/cells.hpp"
#include "delaunay/tetrahedron.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/exact/predicates.hpp"

namespace scaleaxis::inline v1 {

namespace {

/// The position of each vertex of a cell among them in ascending order, and whether that is another orientation.
/// Comparing all pairs costs less than branching.
struct Ranks {
    std::array<int, 4> of;
    bool is_odd;
};
inline Ranks ranks(const std::array<Index, 4>& v) {
    const int c01 = v[1] < v[0], c02 = v[2] < v[0], c03 = v[3] < v[0], c12 = v[2] < v[1], c13 = v[3] < v[1],
              c23 = v[3] < v[2];
    return {{c01 + c02 + c03, 1 - c01 + c12 + c13, 2 - c02 - c12 + c23, 3 - c03 - c13 - c23},
            ((c01 + c02 + c03 + c12 + c13 + c23) & 1) != 0};
}

/// Takes a counter one further. \returns what it was before
Index count_up(Index& counter, bool is_shared) {
    return is_shared ? std::atomic_ref<Index>(counter).fetch_add(1, std::memory_order_relaxed) : counter++;
}

UnusableInput unusable_point(std::string message, std::size_t i) {
    return UnusableInput(Diagnostic{"size", std::move(message), "point", static_cast<std::int64_t>(i)});
}

}  // namespace

TriangulationBuilder TriangulationBuilder::of_hull(bool is_weighted) {
    constexpr double kMost = 1e60;  // products of five coordinates, as predicates have, do not overflow
    return {Box{{-kMost, -kMost, -kMost}, {kMost, kMost, kMost}}, ideal_ghost_cells(is_weighted)};
}

void TriangulationBuilder::insert(std::span<const Point> points, std::span<const double> weights) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& p = points[i];
        if (!(box_.min.x <= p.x && p.x <= box_.max.x && box_.min.y <= p.y && p.y <= box_.max.y && box_.min.z <= p.z &&
              p.z <= box_.max.z)) {
            throw unusable_point("point " + std::to_string(i) + " is not finite, or too far away to compute with", i);
        }
        if (cells_.is_weighted && !std::isfinite(weights[i])) {
            throw unusable_point("the weight of point " + std::to_string(i) + " is not finite", i);
        }
    }
    Cells& c = cells_;
    const Index first = static_cast<Index>(c.points.size()) - kGhosts;
    c.points.insert(c.points.end(), points.begin(), points.end());
    c.weights.insert(c.weights.end(), weights.begin(), weights.end());
    insert_vertices(c, first);
}

template <class IsWanted>
Triangulation TriangulationBuilder::finish_wanted(const IsWanted& is_wanted, std::vector<Index>* slots_of) const {
    // Cells are sorted by counting those of each smallest vertex, and then among these.
    struct Key {
        std::array<Index, 3> others;
        Index slot;
        bool operator<(const Key& other) const {
            return others[0] != other.others[0]   ? others[0] < other.others[0]
                   : others[1] != other.others[1] ? others[1] < other.others[1]
                                                  : others[2] < other.others[2];
        }
    };
    const Cells& cells = cells_;
    const bool is_shared = tasks::this_task_arena::max_concurrency() > 1;
    std::vector<Index> ends(cells.points.size() + 1, 0);
    for_each_index(slots(), [&](Index slot) {
        if (is_wanted(slot)) {
            const std::array<Index, 4>& v = cells[slot].vertices;
            count_up(ends[std::min(std::min(v[0], v[1]), std::min(v[2], v[3])) + kGhosts + 1], is_shared);
        }
    });
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    const auto count = static_cast<std::size_t>(ends.back());
    const auto keys = std::make_unique_for_overwrite<Key[]>(count);
    for_each_index(slots(), [&](Index slot) {
        if (is_wanted(slot)) {
            const std::array<Index, 4>& v = cells[slot].vertices;
            const Ranks rank = ranks(v);
            std::array<Index, 4> sorted;
            for (int k = 0; k < 4; ++k) {
                sorted[rank.of[k]] = v[k];
            }
            keys[count_up(ends[sorted[0] + kGhosts], is_shared)] = {{sorted[1], sorted[2], sorted[3]}, slot};
        }
    });
    // Now each bucket's end is where the next one began.
    const auto new_ids = std::make_unique_for_overwrite<Index[]>(static_cast<std::size_t>(slots()));
    for_each_index(slots(), [&](Index slot) { new_ids[slot] = kNone; });
    for_each_index(cells.points.size(), [&](std::size_t bucket) {
        const Index begin = bucket == 0 ? 0 : ends[bucket - 1];
        std::sort(keys.get() + begin, keys.get() + ends[bucket]);
        for (Index i = begin; i < ends[bucket]; ++i) {
            new_ids[keys[i].slot] = i;
        }
    });

    Triangulation result;
    result.cells.resize(count);
    result.points.assign(cells.points.begin() + kGhosts, cells.points.end());
    result.ghosts = {cells.point(-1), cells.point(-2), cells.point(-3), cells.point(-4)};
    for_each_index(slots(), [&](Index slot) {
        if (is_wanted(slot)) {
            const Cell& cell = cells[slot];
            const Ranks rank = ranks(cell.vertices);
            auto& [vertices, neighbors] = result.cells[new_ids[slot]];
            for (int k = 0; k < 4; ++k) {
                const int to = rank.of[k] ^ (rank.is_odd & (rank.of[k] >> 1));  // changes the last two places
                vertices[to] = cell.vertices[k];
                neighbors[to] = new_ids[cell_of(cell.neighbors[k])];
            }
        }
    });
    if (slots_of != nullptr) {
        slots_of->resize(count);
        for_each_index(count, [&](std::size_t i) { (*slots_of)[i] = keys[i].slot; });
    }
    return result;
}

Triangulation TriangulationBuilder::finish(std::vector<Index>* slots_of) const {
    return finish_wanted([&](Index slot) { return is_cell(slot); }, slots_of);
}

std::vector<std::uint8_t> TriangulationBuilder::near_fresh() const {
    std::vector<std::uint8_t> is_near(static_cast<std::size_t>(slots()));
    bool are_all_fresh = true;
    for (Index slot = 0; slot < slots() && are_all_fresh; ++slot) {
        is_near[slot] = is_cell(slot) ? 1 : 0;
        are_all_fresh = !is_cell(slot) || is_fresh(slot);
    }
    if (are_all_fresh) {
        return is_near;
    }
    std::ranges::fill(is_near, 0);
    // Around an edge of a fresh cell, from the facet where the fresh cells end to the next one of them.
    const auto walk = [&](Index slot, int entry, int exit) {
        while (slot != kNone && !is_fresh(slot)) {
            std::atomic_ref(is_near[slot]).store(1, std::memory_order_relaxed);
            const Index left_behind = vertices(slot)[entry];
            entry = mirror(slot, exit);
            slot = neighbor(slot, exit);
            exit = slot == kNone ? 0 : position_of(vertices(slot), left_behind);
        }
    };
    for_each_index(slots(), [&](Index slot) {
        if (!is_cell(slot) || !is_fresh(slot)) {
            return;
        }
        std::atomic_ref(is_near[slot]).store(1, std::memory_order_relaxed);
        for (int k = 0; k < 4; ++k) {
            const Index beside = neighbor(slot, k);
            for (int exit = 0; beside != kNone && !is_fresh(beside) && exit < 4; ++exit) {
                if (exit != mirror(slot, k)) {
                    walk(beside, mirror(slot, k), exit);
                }
            }
        }
    });
    return is_near;
}

Triangulation TriangulationBuilder::finish_fresh(std::vector<std::uint8_t>& is_fresh_cell) const {
    const std::vector<std::uint8_t> is_near = near_fresh();
    std::vector<Index> slots_of;
    Triangulation part = finish_wanted([&](Index slot) { return is_near[slot] != 0; }, &slots_of);
    is_fresh_cell = mapped<std::uint8_t>(slots_of.size(), [&](std::size_t i) { return is_fresh(slots_of[i]) ? 1 : 0; });
    return part;
}

Triangulation triangulate(std::span<const Point> points, std::span<const double> weights) {
    Box box;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double radius = weights.empty() ? 0.0 : std::sqrt(std::max(weights[i], 0.0));
        box.extend(points[i] - Point{radius, radius, radius});
        box.extend(points[i] + Point{radius, radius, radius});
    }
    TriangulationBuilder builder(box, !weights.empty());
    builder.insert(points, weights);
    return builder.finish();
}

Index locate(const Triangulation& triangulation, const Point& p, Index hint) {
    if (!is_finite(p)) {
        return kNone;
    }
    Index cell = hint;
    for (std::size_t steps = 0; steps <= 4 * triangulation.size(); ++steps) {
        std::array<const Point*, 4> q;
        for (int k = 0; k < 4; ++k) {
            q[k] = &triangulation.point(triangulation.cells[cell].vertices[k]);
        }
        int exit = 0;
        for (; exit < 4; ++exit) {
            const Point* const vertex = std::exchange(q[exit], &p);
            if (orientation(*q[0], *q[1], *q[2], *q[3]) < 0) {
                break;
            }
            q[exit] = vertex;
        }
        if (exit == 4) {
            return cell;
        }
        cell = triangulation.cells[cell].neighbors[exit];
        if (cell == kNone) {
            return kNone;
        }
    }
    return kNone;
}

}  // namespace scaleaxis::inline v1
