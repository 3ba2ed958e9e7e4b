// SPDX-License-Identifier: GPL-3.0-or-later
#include "kernel/triangulation.hpp"

#include <algorithm>
#include <string>

#include "kernel/cells.hpp"
#include "kernel/parallel.hpp"
#include "kernel/predicates.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::kernel {

namespace {

/// Reordering of a cell's vertices that ascend but for the last two, which keep its orientation.
struct CanonicalOrder {
    std::array<int, 4> from;
};
CanonicalOrder canonical_order(const std::array<Index, 4>& vertices) {
    std::array<int, 4> from{0, 1, 2, 3};
    bool is_odd = false;
    const auto sort = [&](std::size_t i, std::size_t j) {
        if (vertices[from[j]] < vertices[from[i]]) {
            std::swap(from[i], from[j]);
            is_odd = !is_odd;
        }
    };
    sort(0, 1), sort(2, 3), sort(0, 2), sort(1, 3), sort(1, 2);
    if (is_odd) {
        std::swap(from[2], from[3]);
    }
    return {from};
}

}  // namespace

struct TriangulationBuilder::Impl {
    Box box;
    Cells cells;
};

TriangulationBuilder::TriangulationBuilder(const Box& box, bool is_weighted)
    : impl_(std::make_unique<Impl>(Impl{box, ghost_cells(box, is_weighted)})) {}
TriangulationBuilder::~TriangulationBuilder() = default;
TriangulationBuilder::TriangulationBuilder(TriangulationBuilder&&) noexcept = default;
TriangulationBuilder& TriangulationBuilder::operator=(TriangulationBuilder&&) noexcept = default;

void TriangulationBuilder::insert(std::span<const Point> points, std::span<const double> weights) {
    const Box& box = impl_->box;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& p = points[i];
        if (!(box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y && box.min.z <= p.z &&
              p.z <= box.max.z)) {
            throw Error("point " + std::to_string(i) + " lies outside the box of the triangulation");
        }
        if (impl_->cells.is_weighted && !std::isfinite(weights[i])) {
            throw Error("the weight of point " + std::to_string(i) + " is not a finite number");
        }
    }
    Cells& c = impl_->cells;
    const Index first = static_cast<Index>(c.points.size()) - kGhosts;
    c.points.insert(c.points.end(), points.begin(), points.end());
    c.weights.insert(c.weights.end(), weights.begin(), weights.end());
    insert_vertices(c, first);
}

Index TriangulationBuilder::slots() const { return impl_->cells.used; }
bool TriangulationBuilder::is_cell(Index slot) const { return impl_->cells[slot].mark == kIdle; }
bool TriangulationBuilder::is_fresh(Index slot) const { return impl_->cells[slot].is_fresh; }
std::array<Index, 4> TriangulationBuilder::vertices(Index slot) const { return impl_->cells[slot].vertices; }
std::array<Index, 4> TriangulationBuilder::neighbors(Index slot) const {
    std::array<Index, 4> slots;
    for (int k = 0; k < 4; ++k) {
        const Index neighbor = cell_of(impl_->cells[slot].neighbors[k]);
        slots[k] = neighbor == kBeyond ? kNone : neighbor;
    }
    return slots;
}
std::span<const Point> TriangulationBuilder::points() const { return std::span(impl_->cells.points).subspan(kGhosts); }
std::array<Point, 4> TriangulationBuilder::ghosts() const {
    const Cells& c = impl_->cells;
    return {c.point(-1), c.point(-2), c.point(-3), c.point(-4)};
}

Triangulation TriangulationBuilder::finish(std::vector<Index>* slots_of) const {
    struct Key {
        std::array<Index, 3> others;
        Index slot;
        bool operator<(const Key& other) const { return others < other.others; }
    };
    const Cells& cells = impl_->cells;
    const auto sorted = [&](Index slot) {
        std::array<Index, 4> v = cells[slot].vertices;
        std::sort(v.begin(), v.end());
        return v;
    };
    std::vector<std::size_t> starts(impl_->cells.points.size() + 1, 0);
    const auto bucket_of = [&](Index slot) {
        return static_cast<std::size_t>(*std::min_element(cells[slot].vertices.begin(), cells[slot].vertices.end()) +
                                        kGhosts);
    };
    for (Index slot = 0; slot < slots(); ++slot) {
        if (is_cell(slot)) {
            ++starts[bucket_of(slot) + 1];
        }
    }
    for (std::size_t i = 1; i < starts.size(); ++i) {
        starts[i] += starts[i - 1];
    }
    std::vector<Key> keys(starts.back());
    std::vector<std::size_t> ends(starts.begin(), starts.end() - 1);
    for (Index slot = 0; slot < slots(); ++slot) {
        if (is_cell(slot)) {
            const auto v = sorted(slot);
            keys[ends[bucket_of(slot)]++] = {{v[1], v[2], v[3]}, slot};
        }
    }
    for_each_index(ends.size(), [&](std::size_t i) { std::sort(keys.begin() + starts[i], keys.begin() + ends[i]); });

    std::vector<Index> new_ids(static_cast<std::size_t>(slots()), kNone);
    for_each_index(keys.size(), [&](std::size_t i) { new_ids[keys[i].slot] = static_cast<Index>(i); });

    Triangulation result;
    result.vertices.resize(keys.size());
    result.neighbors.resize(keys.size());
    result.points.assign(impl_->cells.points.begin() + kGhosts, impl_->cells.points.end());
    result.ghosts = ghosts();
    for_each_index(keys.size(), [&](std::size_t i) {
        const Cell& cell = cells[keys[i].slot];
        const CanonicalOrder order = canonical_order(cell.vertices);
        for (std::size_t k = 0; k < 4; ++k) {
            result.vertices[i][k] = cell.vertices[order.from[k]];
            result.neighbors[i][k] = new_ids[cell_of(cell.neighbors[order.from[k]])];
        }
    });
    if (slots_of != nullptr) {
        slots_of->resize(keys.size());
        for_each_index(keys.size(), [&](std::size_t i) { (*slots_of)[i] = keys[i].slot; });
    }
    return result;
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
            q[k] = &triangulation.point(triangulation.vertices[cell][k]);
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
        cell = triangulation.neighbors[cell][exit];
        if (cell == kNone) {
            return kNone;
        }
    }
    return kNone;
}

}  // namespace scaleaxis::kernel
