// SPDX-License-Identifier: GPL-3.0-or-later
//
// Incremental insertion (A. Bowyer, D. F. Watson, 1981) in a biased randomized order: the cells whose sphere contains
// the new point are found by a search from the cell that the point lies in, and replaced by the star of the point.
#include "kernel/triangulation.hpp"

#include <algorithm>
#include <string>

#include "kernel/parallel.hpp"
#include "kernel/predicates.hpp"
#include "kernel/spatial_order.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::kernel {

namespace {

/// A face of a cell: 4 · cell + the position of the opposite vertex in the cell.
using Face = Index;
constexpr Face face_of(Index cell, int opposite) { return 4 * cell + opposite; }
constexpr Index cell_of(Face face) { return face >> 2; }
constexpr int opposite_of(Face face) { return face & 3; }
constexpr Index kMostCells = std::numeric_limits<Index>::max() / 4;

struct Cell {
    std::array<Index, 4> vertices;
    std::array<Face, 4> neighbors;  ///< the same faces, seen from the other side
};

/// Slot 0 is no cell: it stands for all that is beyond the ghosts, so that every face has another side.
constexpr Index kBeyond = 0;

/// What a slot is in. During an insertion the cells that were looked at bear a mark of their own.
enum class Mark : std::uint8_t { kIdle, kConflict, kNoConflict, kNotACell, kEmpty };

constexpr std::size_t kGhosts = 4;

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
    bool is_weighted;
    std::vector<Point> points;    // the ghosts come first
    std::vector<double> weights;  // empty if not weighted
    std::vector<Cell> cells;
    std::vector<Mark> marks;
    std::vector<std::uint8_t> fresh;
    std::vector<Index> empty;  // slots to be used again

    // Of the current insertion.
    std::vector<Index> conflicts;
    std::vector<Face> rim;  // faces of `conflicts` with no conflict beyond
    Index last = 1;         // a recent cell

    Impl(const Box& box_, bool is_weighted_) : box(box_), is_weighted(is_weighted_) {
        const Point center = box.is_empty() ? Point{} : midpoint(box.min, box.max);
        const double magnitude = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
        // The inscribed ball of the ghosts' tetrahedron has a radius of three diagonals. A box of no size gets a
        // tetrahedron that can still be told from a point.
        const double size = std::max(6.0 * box.diagonal(), 0x1p-30 * magnitude);
        const double h = size > 0 ? size : 1.0;
        points = {center + Point{h, h, h}, center + Point{h, -h, -h}, center + Point{-h, -h, h},
                  center + Point{-h, h, -h}};
        weights.assign(is_weighted ? kGhosts : 0, 0.0);
        // Ghost `-1 - k` is the point `3 - k`: ids ascend with the positions.
        cells = {{{-4, -3, -2, -1}, {face_of(1, 0), face_of(1, 1), face_of(1, 2), face_of(1, 3)}},
                 {{-4, -3, -2, -1}, {face_of(0, 0), face_of(0, 1), face_of(0, 2), face_of(0, 3)}}};
        marks = {Mark::kNotACell, Mark::kIdle};
        fresh = {0, 1};
    }

    const Point& point(Index vertex) const { return points.data()[vertex + static_cast<Index>(kGhosts)]; }
    double weight(Index vertex) const { return weights.data()[vertex + static_cast<Index>(kGhosts)]; }

    /// Does the vertex of the cell at position `k`, replaced by `p`, lie on the same side of the opposite face?
    int side(const Cell& cell, int k, const Point& p) const {
        std::array<const Point*, 4> q;
        for (int i = 0; i < 4; ++i) {
            q[i] = &point(cell.vertices[i]);
        }
        q[k] = &p;
        return orientation(*q[0], *q[1], *q[2], *q[3]);
    }

    /// The perturbation raises the lifted points by infinitesimals, each much larger than those of all smaller ids: the
    /// first point, from the largest id down, whose raise matters decides (O. Devillers, M. Teillaud, "Perturbations
    /// for Delaunay and weighted Delaunay 3D triangulations", 2011).
    bool is_perturbed_conflict(const Cell& cell, Index vertex) const {
        std::array<int, 4> order{0, 1, 2, 3};
        std::sort(order.begin(), order.end(), [&](int i, int j) { return cell.vertices[i] > cell.vertices[j]; });
        for (const int k : order) {
            if (cell.vertices[k] < vertex) {
                return false;
            }
            const int sign = side(cell, k, point(vertex));
            if (sign != 0) {
                return sign > 0;
            }
        }
        return false;
    }

    bool is_conflict(const Cell& cell, Index vertex) const {
        const auto [a, b, c, d] = cell.vertices;
        const int sign = is_weighted ? in_power_sphere(point(a), weight(a), point(b), weight(b), point(c), weight(c),
                                                       point(d), weight(d), point(vertex), weight(vertex))
                                     : in_sphere(point(a), point(b), point(c), point(d), point(vertex));
        return sign != 0 ? sign > 0 : is_perturbed_conflict(cell, vertex);
    }

    /// Walks to the cell that contains `p`: always through a face that has `p` on its other side.
    Index walk_to(const Point& p, Index start) const {
        Face entry = face_of(start, 0);
        bool is_start = true;
        for (;;) {
            const Cell& cell = cells[cell_of(entry)];
            int exit = 0;
            while (exit < 4 && ((exit == opposite_of(entry) && !is_start) || side(cell, exit, p) >= 0)) {
                ++exit;
            }
            if (exit == 4) {
                return cell_of(entry);
            }
            entry = cell.neighbors[exit];
            is_start = false;
        }
    }

    void insert_point(Index vertex) {
        const Index start = walk_to(point(vertex), last);
        if (!is_conflict(cells[start], vertex)) {
            return;
        }
        find_conflicts(vertex, start);
        last = make_star(vertex);
        for (const Face face : rim) {
            const Index outside = cell_of(cells[cell_of(face)].neighbors[opposite_of(face)]);
            if (outside != kBeyond) {
                marks[outside] = Mark::kIdle;
            }
        }
        for (const Index cell : conflicts) {
            marks[cell] = Mark::kEmpty;
        }
        empty.insert(empty.end(), conflicts.begin(), conflicts.end());
    }

    void find_conflicts(Index vertex, Index start) {
        rim.clear();
        conflicts.assign(1, start);
        marks[start] = Mark::kConflict;
        for (std::size_t i = 0; i < conflicts.size(); ++i) {
            const Index inside = conflicts[i];
            for (int k = 0; k < 4; ++k) {
                const Index outside = cell_of(cells[inside].neighbors[k]);
                Mark& mark = marks[outside];
                if (mark == Mark::kIdle) {
                    mark = Mark::kNoConflict;
                    if (is_conflict(cells[outside], vertex)) {
                        mark = Mark::kConflict;
                        conflicts.push_back(outside);
                    }
                }
                if (mark != Mark::kConflict) {
                    rim.push_back(face_of(inside, k));
                }
            }
        }
    }

    Index new_slot() {
        if (!empty.empty()) {
            const Index slot = empty.back();
            empty.pop_back();
            return slot;
        }
        if (cells.size() >= static_cast<std::size_t>(kMostCells)) {
            throw Error("the triangulation has more than " + std::to_string(kMostCells) + " cells; use fewer points");
        }
        cells.emplace_back();
        marks.emplace_back();
        fresh.emplace_back();
        return static_cast<Index>(cells.size() - 1);
    }

    /// Joins `vertex` with every face of the rim. \returns one of the new cells
    Index make_star(Index vertex) {
        Index slot = kNone;
        for (const Face face : rim) {
            slot = new_slot();
            const Cell& old = cells[cell_of(face)];
            const int k = opposite_of(face);
            Cell& cell = cells[slot];
            cell.vertices = old.vertices;
            cell.vertices[k] = vertex;
            cell.neighbors = {kNone, kNone, kNone, kNone};
            cell.neighbors[k] = old.neighbors[k];
            cells[cell_of(old.neighbors[k])].neighbors[opposite_of(old.neighbors[k])] = face_of(slot, k);
            marks[slot] = Mark::kIdle;
            fresh[slot] = 1;
        }
        for (const Face face : rim) {
            const Index cell = across(face);
            for (int k = 0; k < 4; ++k) {
                if (cells[cell].neighbors[k] == kNone) {
                    const Face twin = turn(face, k);
                    cells[cell].neighbors[k] = twin;
                    cells[cell_of(twin)].neighbors[opposite_of(twin)] = face_of(cell, k);
                }
            }
        }
        return slot;
    }

    /// The new cell on a face of the rim: the cell beyond the face knows it already.
    Index across(Face face) const {
        const Face outside = cells[cell_of(face)].neighbors[opposite_of(face)];
        return cell_of(cells[cell_of(outside)].neighbors[opposite_of(outside)]);
    }

    /// The new cell on `face` of the rim shares its face opposite to position `exit` with another new cell. Finds it by
    /// turning, through the conflicting cells, around the edge that `face` has in common with the rim there.
    Face turn(Face face, int exit) const {
        Index inside = cell_of(face);
        int entry = opposite_of(face);
        for (;;) {
            const Face next = cells[inside].neighbors[exit];
            if (marks[cell_of(next)] != Mark::kConflict) {
                return face_of(across(face_of(inside, exit)), entry);
            }
            const Index pivot = cells[inside].vertices[entry];
            inside = cell_of(next);
            entry = opposite_of(next);
            const auto& vertices = cells[inside].vertices;
            exit = static_cast<int>(std::find(vertices.begin(), vertices.end(), pivot) - vertices.begin());
        }
    }
};

TriangulationBuilder::TriangulationBuilder(const Box& box, bool is_weighted)
    : impl_(std::make_unique<Impl>(box, is_weighted)) {}
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
        if (impl_->is_weighted && !std::isfinite(weights[i])) {
            throw Error("the weight of point " + std::to_string(i) + " is not a finite number");
        }
    }
    const Index first = static_cast<Index>(impl_->points.size() - kGhosts);
    impl_->points.insert(impl_->points.end(), points.begin(), points.end());
    impl_->weights.insert(impl_->weights.end(), weights.begin(), weights.end());
    std::fill(impl_->fresh.begin(), impl_->fresh.end(), std::uint8_t{0});
    for (const Index i : insertion_order(points).points) {
        impl_->insert_point(first + i);
    }
}

Index TriangulationBuilder::slots() const { return static_cast<Index>(impl_->cells.size()); }
bool TriangulationBuilder::is_cell(Index slot) const { return impl_->marks[slot] == Mark::kIdle; }
bool TriangulationBuilder::is_fresh(Index slot) const { return impl_->fresh[slot] != 0; }
std::array<Index, 4> TriangulationBuilder::vertices(Index slot) const { return impl_->cells[slot].vertices; }
std::array<Index, 4> TriangulationBuilder::neighbors(Index slot) const {
    std::array<Index, 4> slots;
    for (int k = 0; k < 4; ++k) {
        const Index neighbor = cell_of(impl_->cells[slot].neighbors[k]);
        slots[k] = neighbor == kBeyond ? kNone : neighbor;
    }
    return slots;
}
std::span<const Point> TriangulationBuilder::points() const { return std::span(impl_->points).subspan(kGhosts); }
std::array<Point, 4> TriangulationBuilder::ghosts() const {
    return {impl_->points[3], impl_->points[2], impl_->points[1], impl_->points[0]};
}

Triangulation TriangulationBuilder::finish(std::vector<Index>* slots_of) const {
    struct Key {
        std::array<Index, 3> others;
        Index slot;
        bool operator<(const Key& other) const { return others < other.others; }
    };
    const std::vector<Cell>& cells = impl_->cells;
    const auto sorted = [&](Index slot) {
        std::array<Index, 4> v = cells[slot].vertices;
        std::sort(v.begin(), v.end());
        return v;
    };
    std::vector<std::size_t> starts(impl_->points.size() + 1, 0);
    const auto bucket_of = [&](Index slot) {
        return static_cast<std::size_t>(*std::min_element(cells[slot].vertices.begin(), cells[slot].vertices.end()) +
                                        static_cast<Index>(kGhosts));
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

    std::vector<Index> new_ids(cells.size(), kNone);
    for_each_index(keys.size(), [&](std::size_t i) { new_ids[keys[i].slot] = static_cast<Index>(i); });

    Triangulation result;
    result.vertices.resize(keys.size());
    result.neighbors.resize(keys.size());
    result.points.assign(impl_->points.begin() + kGhosts, impl_->points.end());
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
