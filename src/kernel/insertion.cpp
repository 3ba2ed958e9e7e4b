// SPDX-License-Identifier: GPL-3.0-or-later
//
// Incremental insertion (A. Bowyer, D. F. Watson, 1981) in a biased randomized order: the cells whose sphere contains
// the new point are found by a search from the cell that the point lies in, and replaced by the star of the point.
//
// Several workers insert points of different regions at the same time. A worker owns the cells that it changes: those
// in conflict with its point and their neighbors. Where it meets another worker's cell it gives up, and the point
// waits.
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <span>
#include <string>

#include "kernel/cells.hpp"
#include "kernel/predicates.hpp"
#include "kernel/spatial_order.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::kernel {

namespace {

constexpr Index kMostCells = std::numeric_limits<Index>::max() / 4;

/// Positions of the vertices of the face opposite to position `k`: with the replaced vertex last, the cell keeps its
/// orientation. And the inverse.
constexpr std::array<std::array<int, 3>, 4> kFacePositions{{{1, 3, 2}, {3, 0, 2}, {1, 0, 3}, {0, 1, 2}}};
constexpr std::array<std::array<int, 4>, 4> kPositionsInFace{{{3, 0, 2, 1}, {1, 3, 2, 0}, {1, 0, 3, 2}, {0, 1, 2, 3}}};
constexpr int kApex = 3;  // the position of the new vertex in the cells of its star

void grow(Cells& c, std::size_t capacity) {
    if (capacity <= static_cast<std::size_t>(c.capacity)) {
        return;
    }
    const std::size_t size = std::min(capacity, static_cast<std::size_t>(kMostCells));
    const auto move_to_larger = [&](auto& array) {
        using Element = std::remove_reference_t<decltype(array[0])>;
        auto larger = std::make_unique_for_overwrite<Element[]>(size);
        std::copy_n(array.get(), c.used, larger.get());
        array = std::move(larger);
    };
    move_to_larger(c.cells);
    move_to_larger(c.marks);
    move_to_larger(c.is_fresh);
    c.capacity = static_cast<Index>(size);
}

/// Fills in the sphere of a cell.
void make_sphere(const Cells& c, Cell& cell) {
    using predicate_details::kEpsilon;
    const Point& base = c.point(cell.vertices[kApex]);
    std::array<Point, 3> p;
    std::array<double, 3> lift;
    double reach = 0, largest_lift = 0;
    for (int i = 0; i < 3; ++i) {
        p[i] = c.point(cell.vertices[i]) - base;
        lift[i] = squared_norm(p[i]);
        reach = std::max({reach, std::abs(p[i].x), std::abs(p[i].y), std::abs(p[i].z)});
        double magnitude = lift[i];
        if (c.is_weighted) {
            const double w = c.weight(cell.vertices[i]) - c.weight(cell.vertices[kApex]);
            lift[i] -= w;
            magnitude += std::abs(w);
        }
        largest_lift = std::max(largest_lift, magnitude);
    }
    const Point n0 = cross(p[1], p[2]), n1 = cross(p[2], p[0]), n2 = cross(p[0], p[1]);
    const double volume = dot(p[0], n0);
    const double size = std::abs(volume);
    cell.center = (1 / volume) * (lift[0] * n0 + lift[1] * n1 + lift[2] * n2);
    const double farthest = std::max({std::abs(cell.center.x), std::abs(cell.center.y), std::abs(cell.center.z)});
    const double square = reach * reach;
    cell.error =
        size > 100 * kEpsilon * square * reach + 1e-150
            ? kEpsilon * ((160 * square * largest_lift + 110 * square * reach * farthest) / size + 10 * farthest)
            : std::numeric_limits<double>::infinity();
}

/// Does the vertex of the cell at position `k`, replaced by `p`, lie on the same side of the opposite face?
int side(const Cells& c, const std::array<Index, 4>& vertices, int k, const Point& p) {
    std::array<const Point*, 4> q;
    for (int i = 0; i < 4; ++i) {
        q[i] = &c.point(vertices[i]);
    }
    q[k] = &p;
    return orientation(*q[0], *q[1], *q[2], *q[3]);
}

/// The perturbation raises the lifted points by infinitesimals, each much larger than those of all smaller ids: the
/// first point, from the largest id down, whose raise matters decides (O. Devillers, M. Teillaud, "Perturbations for
/// Delaunay and weighted Delaunay 3D triangulations", 2011).
bool is_perturbed_conflict(const Cells& c, const std::array<Index, 4>& vertices, Index vertex) {
    std::array<int, 4> order{0, 1, 2, 3};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return vertices[i] > vertices[j]; });
    for (const int k : order) {
        if (vertices[k] < vertex) {
            return false;
        }
        const int sign = side(c, vertices, k, c.point(vertex));
        if (sign != 0) {
            return sign > 0;
        }
    }
    return false;
}

bool is_exact_conflict(const Cells& c, const std::array<Index, 4>& v, Index vertex) {
    const int sign =
        c.is_weighted
            ? in_power_sphere(c.point(v[0]), c.weight(v[0]), c.point(v[1]), c.weight(v[1]), c.point(v[2]),
                              c.weight(v[2]), c.point(v[3]), c.weight(v[3]), c.point(vertex), c.weight(vertex))
            : in_sphere(c.point(v[0]), c.point(v[1]), c.point(v[2]), c.point(v[3]), c.point(vertex));
    return sign != 0 ? sign > 0 : is_perturbed_conflict(c, v, vertex);
}

bool is_conflict(const Cells& c, const Cell& cell, Index vertex) {
    using predicate_details::kEpsilon;
    using predicate_details::kUnderflow;
    const Index base = cell.vertices[kApex];
    const Point p = c.point(vertex) - c.point(base);
    double lift = squared_norm(p), magnitude = lift;
    if (c.is_weighted) {
        const double w = c.weight(vertex) - c.weight(base);
        lift -= w;
        magnitude += std::abs(w);
    }
    const double value = dot(cell.center, p) - lift;
    const double bound =
        cell.error * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z)) + 8 * kEpsilon * magnitude + kUnderflow;
    return value > bound || (!(value < -bound) && is_exact_conflict(c, cell.vertices, vertex));
}

/// Inserts one vertex after the other.
struct Worker {
    Cells& c;
    Mark conflict_mark = kFirstWorker;
    Mark no_conflict_mark = kFirstWorker + 1;
    Index last = 1;            // a recent cell
    std::vector<Index> empty{};  // slots to be used

    // Of the current insertion.
    struct RimFace {
        Face inside;   // face of a conflicting cell
        Face outside;  // the same, seen from the other side
        Index star;    // the new cell there
    };
    std::vector<Index> conflicts{};
    std::vector<RimFace> rim{};

    /// Walks to the cell that contains `p`: always through a face that has `p` on its other side.
    Index walk_to(const Point& p) const {
        Index at = last;
        int entry = -1;
        for (;;) {
            const Cell& cell = c.cells[at];
            int exit = 0;
            while (exit < 4 && (exit == entry || side(c, cell.vertices, exit, p) >= 0)) {
                ++exit;
            }
            if (exit == 4) {
                return at;
            }
            const Face next = cell.neighbors[exit];
            at = cell_of(next);
            entry = opposite_of(next);
        }
    }

    void insert(Index vertex) {
        const Index start = walk_to(c.point(vertex));
        if (!is_conflict(c, c.cells[start], vertex)) {
            return;
        }
        find_conflicts(vertex, start);
        make_star(vertex);
        join_star();
        for (const Index cell : conflicts) {
            c.marks[cell] = kEmpty;
        }
        empty.insert(empty.end(), conflicts.begin(), conflicts.end());
        for (const RimFace& face : rim) {
            if (cell_of(face.outside) != kBeyond) {
                c.marks[cell_of(face.outside)] = kIdle;
            }
            c.marks[face.star] = kIdle;
            c.is_fresh[face.star] = 1;
        }
    }

    void find_conflicts(Index vertex, Index start) {
        rim.clear();
        conflicts.assign(1, start);
        c.marks[start] = conflict_mark;
        for (std::size_t i = 0; i < conflicts.size(); ++i) {
            const Index inside = conflicts[i];
            for (int k = 0; k < 4; ++k) {
                const Face face = c.cells[inside].neighbors[k];
                const Index outside = cell_of(face);
                const Mark mark = c.marks[outside];
                if (mark == conflict_mark) {
                    continue;
                }
                if (mark == kIdle) {
                    if (is_conflict(c, c.cells[outside], vertex)) {
                        c.marks[outside] = conflict_mark;
                        conflicts.push_back(outside);
                        continue;
                    }
                    c.marks[outside] = no_conflict_mark;
                }
                rim.push_back({face_of(inside, k), face, kNone});
            }
        }
    }

    Index new_slot() {
        if (!empty.empty()) {
            const Index slot = empty.back();
            empty.pop_back();
            return slot;
        }
        if (c.used == c.capacity) {
            if (c.used == kMostCells) {
                throw Error("the triangulation has more than " + std::to_string(kMostCells) +
                            " cells; use fewer points");
            }
            grow(c, 2 * static_cast<std::size_t>(c.capacity));
        }
        return c.used++;
    }

    /// Joins `vertex` with every face of the rim.
    void make_star(Index vertex) {
        for (RimFace& face : rim) {
            face.star = new_slot();
            const Cell& old = c.cells[cell_of(face.inside)];
            const auto& positions = kFacePositions[opposite_of(face.inside)];
            Cell& cell = c.cells[face.star];
            cell.vertices = {old.vertices[positions[0]], old.vertices[positions[1]], old.vertices[positions[2]],
                             vertex};
            cell.neighbors = {kBeyond, kBeyond, kBeyond, face.outside};
            c.cells[cell_of(face.outside)].neighbors[opposite_of(face.outside)] = face_of(face.star, kApex);
            make_sphere(c, cell);
        }
        last = rim.back().star;
    }

    void join_star() {
        for (const RimFace& face : rim) {
            Cell& cell = c.cells[face.star];
            for (int k = 0; k < kApex; ++k) {
                if (cell.neighbors[k] == kBeyond) {
                    const Face twin = turn(face.inside, kFacePositions[opposite_of(face.inside)][k]);
                    cell.neighbors[k] = twin;
                    c.cells[cell_of(twin)].neighbors[opposite_of(twin)] = face_of(face.star, k);
                }
            }
        }
    }

    /// The new cell on `face` of the rim shares its face opposite to position `exit` with another new cell. Finds it by
    /// turning, through the conflicting cells, around the edge that `face` has in common with the rim there.
    Face turn(Face face, int exit) const {
        Index inside = cell_of(face);
        int entry = opposite_of(face);
        for (;;) {
            const Cell& cell = c.cells[inside];
            const Face next = cell.neighbors[exit];
            if (c.marks[cell_of(next)] != conflict_mark) {
                // The cell beyond the rim knows the new cell already.
                const Face twin = c.cells[cell_of(next)].neighbors[opposite_of(next)];
                return face_of(cell_of(twin), kPositionsInFace[exit][entry]);
            }
            const Index pivot = cell.vertices[entry];
            inside = cell_of(next);
            entry = opposite_of(next);
            const auto& v = c.cells[inside].vertices;
            exit = (v[1] == pivot ? 1 : 0) + (v[2] == pivot ? 2 : 0) + (v[3] == pivot ? 3 : 0);
        }
    }
};

}  // namespace

Cells ghost_cells(const Box& box, bool is_weighted) {
    const Point center = box.is_empty() ? Point{} : midpoint(box.min, box.max);
    const double magnitude = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    // The inscribed ball of the ghosts' tetrahedron has a radius of three diagonals. A box of no size gets a
    // tetrahedron that can still be told from a point.
    const double size = std::max(6.0 * box.diagonal(), 0x1p-30 * magnitude);
    const double h = size > 0 ? size : 1.0;

    Cells c{is_weighted, {}, {}};
    c.points = {center + Point{h, h, h}, center + Point{h, -h, -h}, center + Point{-h, -h, h},
                center + Point{-h, h, -h}};
    c.weights.assign(is_weighted ? kGhosts : 0, 0.0);
    grow(c, 64);
    c.used = 2;
    c.cells[kBeyond] = {{-4, -3, -2, -1}, {face_of(1, 0), face_of(1, 1), face_of(1, 2), face_of(1, 3)}, {}, 0};
    c.cells[1] = {{-4, -3, -2, -1}, {face_of(0, 0), face_of(0, 1), face_of(0, 2), face_of(0, 3)}, {}, 0};
    make_sphere(c, c.cells[1]);
    c.marks[kBeyond] = kNotACell;
    c.marks[1] = kIdle;
    c.is_fresh[kBeyond] = 0;
    c.is_fresh[1] = 1;
    return c;
}

void insert_vertices(Cells& c, Index first) {
    std::fill_n(c.is_fresh.get(), c.used, std::uint8_t{0});
    const std::span<const Point> points = std::span(c.points).subspan(static_cast<std::size_t>(first + kGhosts));
    const InsertionOrder order = insertion_order(points);
    grow(c, static_cast<std::size_t>(c.used) + 8 * points.size());
    Worker worker{c};
    worker.empty = std::move(c.empty);
    while (c.marks[worker.last] != kIdle) {
        ++worker.last;
    }
    for (const Index i : order.points) {
        worker.insert(first + i);
    }
    c.empty = std::move(worker.empty);
}

}  // namespace scaleaxis::kernel
