// SPDX-License-Identifier: Apache-2.0
//
// Incremental insertion (A. Bowyer, D. F. Watson, 1981) in a biased randomized order: the cells whose sphere contains
// the new point are found by a search from the cell that the point lies in, and replaced by the star of the point.
// Mispredicted branches are what costs most; hence the loops that append to a list without asking.
//
// Several workers insert points of different regions at the same time. A worker owns the cells that it changes: those
// in conflict with its point and their neighbors. Where it meets another worker's cell it gives up, and the point
// waits.

#include <algorithm>
#include <atomic>
#include <span>
#include <string>
#include <utility>

#include "base/hash_table.hpp"
#include "base/parallel.hpp"
#include "delaunay/cells.hpp"
#include "delaunay/sphere_batch.hpp"
#include "delaunay/tetrahedron.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/exact/ideal_points.hpp"
#include "spatial/exact/predicates.hpp"
#include "spatial/spatial_order.hpp"

namespace scaleaxis::inline v1 {

namespace {

constexpr Index kMostCells = std::numeric_limits<Index>::max() / 4;

constexpr Index kCellsAtOnce = 1 << 16;  // are copied between two looks at cancellation

constexpr int kApex = 3;  // position of the new vertex in the cells of its star

/// Makes room for more cells: `capacity` in all, or as many as there can be.
void reserve(Cells& c, std::size_t capacity) {
    if (capacity > static_cast<std::size_t>(c.capacity)) {
        const Index size = static_cast<Index>(std::min(capacity, static_cast<std::size_t>(kMostCells)));
        if (size == c.capacity) {
            throw UnusableInput(Diagnostic{
                "size", "the triangulation has more than " + std::to_string(kMostCells) + " cells; use fewer points"});
        }
        auto slots = std::make_unique_for_overwrite<Cell[]>(static_cast<std::size_t>(size));
        for (Index begin = 0; begin < c.used; begin += kCellsAtOnce) {
            stop_if_cancelled();  // to copy some gigabytes takes seconds
            std::copy_n(c.slots.get() + begin, std::min(kCellsAtOnce, c.used - begin), slots.get() + begin);
        }
        c.slots = std::move(slots);
        c.capacity = size;
    }
}

/// The corners of a regular tetrahedron: where the ghosts are, seen from the middle.
constexpr std::array<Point, 4> kGhostDirections{{{1, 1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}}};

ProjectivePoint projective_point(const Cells& c, Index vertex) {
    return vertex < 0 ? ProjectivePoint{kGhostDirections[vertex + kGhosts], 0.0, true}
                      : ProjectivePoint{c.point(vertex), c.is_weighted ? c.weight(vertex) : 0.0, false};
}

/// On which side of the face opposite to position `k` of a cell does `p` lie? +1: where the cell is.
int side(const Cells& c, const std::array<Index, 4>& vertices, int k, const Point& p) {
    const auto& f = kFacetsOfCell[k];
    if (c.has_ideal_ghosts && (vertices[f[0]] | vertices[f[1]] | vertices[f[2]]) < 0) {
        return ideal_orientation({projective_point(c, vertices[f[0]]), projective_point(c, vertices[f[1]]),
                                  projective_point(c, vertices[f[2]])},
                                 p);
    }
    return orientation(c.point(vertices[f[0]]), c.point(vertices[f[1]]), c.point(vertices[f[2]]), p);
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

bool is_exact_conflict(const Cells& c, const Cell& cell, Index vertex) {
    const std::array<Index, 4>& v = cell.vertices;
    if (c.has_ideal_ghosts && (v[0] | v[1] | v[2] | v[3]) < 0) {
        const int sign = ideal_in_power_sphere({projective_point(c, v[0]), projective_point(c, v[1]),
                                                projective_point(c, v[2]), projective_point(c, v[3])},
                                               projective_point(c, vertex));
        return sign != 0 ? sign > 0 : is_perturbed_conflict(c, v, vertex);
    }
    const auto weight = [&](Index i) { return c.is_weighted ? c.weight(i) : 0.0; };
    const int sign_by_center = predicate_details::sign_near_sphere(
        c.point(v[0]), weight(v[0]), c.point(v[1]), weight(v[1]), c.point(v[2]), weight(v[2]), c.point(v[3]),
        weight(v[3]), c.point(vertex), weight(vertex), {cell.center[0], cell.center[1], cell.center[2]});
    if (sign_by_center != 0) {
        return sign_by_center > 0;
    }
    const int sign =
        c.is_weighted
            ? in_power_sphere(c.point(v[0]), c.weight(v[0]), c.point(v[1]), c.weight(v[1]), c.point(v[2]),
                              c.weight(v[2]), c.point(v[3]), c.weight(v[3]), c.point(vertex), c.weight(vertex))
            : in_sphere(c.point(v[0]), c.point(v[1]), c.point(v[2]), c.point(v[3]), c.point(vertex));
    return sign != 0 ? sign > 0 : is_perturbed_conflict(c, v, vertex);
}

bool is_conflict(const Cells& c, const Cell& cell, Index vertex, const Point& point, double weight) {
    using predicate_details::kEpsilon;
    using predicate_details::kUnderflow;
    const Index base = cell.vertices[kApex];
    const Point p = point - c.point(base);
    double lift = squared_norm(p), magnitude = lift;
    if (c.is_weighted) {
        const double w = weight - c.weight(base);
        lift -= w;
        magnitude += std::abs(w);
    }
    const double value = dot(Point{cell.center[0], cell.center[1], cell.center[2]}, p) - lift;
    const double bound =
        cell.error * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z)) + 8 * kEpsilon * magnitude + kUnderflow;
    if (std::abs(value) > bound) [[likely]] {
        return value > 0;
    }
    return is_exact_conflict(c, cell, vertex);
}

/// Which of the new cells meet at an edge of the rim? A hash table that is cleared by changing the epoch.
class EdgeTable {
   public:
    void start(std::size_t edges) {
        if (entries_.size() < 5 * edges) {
            entries_.reset(4 * edges);
            epoch_ = 0;
        }
        ++epoch_;
    }
    /// Notes one of the two faces at an edge. \returns where
    std::size_t add(Index u, Index v, Face face) {
        const std::int64_t difference = static_cast<std::int64_t>(u) - v;
        const std::int64_t excess = difference & (difference >> 63);  // the smaller one is v + excess, without a branch
        const std::uint64_t key = static_cast<std::uint64_t>(v + excess) << 32 | static_cast<std::uint32_t>(u - excess);
        const std::size_t i =
            entries_.find(key, [&](const Entry& e) { return ((e.epoch != epoch_) | (e.key == key)) != 0; });
        Entry& entry = entries_[i];
        entry.faces = (entry.faces & (entry.epoch == epoch_ ? -1 : 0)) ^ face;
        entry.key = key;
        entry.epoch = epoch_;
        return i;
    }
    /// The other face at the edge noted at `i`.
    Face other(std::size_t i, Face face) const { return entries_[i].faces ^ face; }

   private:
    struct Entry {
        std::uint64_t key;
        std::uint32_t epoch;
        Face faces;  // the exclusive or of both
    };
    HashTable<Entry> entries_;
    std::uint32_t epoch_ = 0;
};

/// A list to which a loop appends without asking whether there is room.
template <class T>
class List {
   public:
    void clear() { size_ = 0; }
    std::size_t size() const { return size_; }
    const T& operator[](std::size_t i) const { return items_[i]; }
    std::span<const T> all() const { return {items_.data(), size_}; }

    /// Calls `fill(append_if)`, which calls `append_if(is_wanted, item)` at most `most` times.
    template <class Fill>
    void append(std::size_t most, const Fill& fill) {
        if (items_.size() < size_ + most) {
            items_.resize(2 * (size_ + most));
        }
        T* const items = items_.data();
        std::size_t size = size_;
        fill([items, &size](bool is_wanted, const T& item) {
            items[size] = item;
            size += is_wanted ? 1 : 0;
        });
        size_ = size;
    }

   private:
    std::vector<T> items_;
    std::size_t size_ = 0;
};

enum class Outcome { kDone, kBusy, kNoRoom };

/// Inserts one vertex after the other. If others do so at the same time, `kShared`, what they may read or write is
/// accessed atomically.
template <bool kShared>
class Worker {
   public:
    /// \param known_slots the slots that had been in use before the workers started
    /// \param last a cell, where the first walk begins
    /// \param empty slots to be used
    Worker(Cells& cells, int id, Index known_slots, Index last, std::vector<Index> empty)
        : c_(cells),
          known_slots_(known_slots),
          conflict_(static_cast<Mark>(kFirstWorker + 2 * id)),
          no_conflict_(static_cast<Mark>(conflict_ + 1)),
          last_(last),
          empty_(std::move(empty)) {}

    Outcome insert(Index vertex) {
        const Index start = walk_to(c_.point(vertex));
        if (start == kNone) {
            return Outcome::kBusy;
        }
        if (!is_conflict(c_, c_[start], vertex, c_.point(vertex), c_.is_weighted ? c_.weight(vertex) : 0.0)) {
            set_mark(start, kIdle);
            return Outcome::kDone;  // it is hidden
        }
        if (!find_conflicts(vertex, start)) {
            release();
            return Outcome::kBusy;
        }
        find_rim();
        if (!find_slots(rim_.size())) {
            release();
            return Outcome::kNoRoom;
        }
        make_star(vertex);
        return Outcome::kDone;
    }

    const std::vector<Index>& empty() const { return empty_; }

   private:
    struct RimFace {
        Face inside;   // face of a conflicting cell
        Face outside;  // the same, seen from the other side
    };

    template <class T>
    static T read(const T& value) {
        if constexpr (kShared) {
            return std::atomic_ref<T>(const_cast<T&>(value)).load(std::memory_order_acquire);
        }
        return value;
    }
    template <class T>
    static void write(T& value, T new_value) {
        if constexpr (kShared) {
            std::atomic_ref<T>(value).store(new_value, std::memory_order_release);
        } else {
            value = new_value;
        }
    }
    static std::array<Index, 4> read(const std::array<Index, 4>& a) {
        return {read(a[0]), read(a[1]), read(a[2]), read(a[3])};
    }
    void set_mark(Index cell, Mark mark) { write(c_[cell].mark, mark); }

    bool acquire(Index cell, Mark mark) {
        Mark& current = c_[cell].mark;
        if constexpr (kShared) {
            Mark idle = kIdle;
            return std::atomic_ref<Mark>(current).compare_exchange_strong(idle, mark, std::memory_order_acquire);
        }
        const bool is_idle = current == kIdle;
        current = is_idle ? mark : current;
        return is_idle;
    }

    void release(const List<Index>& cells) {
        for (const Index cell : cells.all()) {
            set_mark(cell, kIdle);
        }
    }
    void release() {
        release(conflicts_);
        release(others_);
    }

    /// Walks to the cell that contains `p`, always through a face that has `p` on its other side, and acquires it.
    /// \returns `kNone` if that is another worker's
    Index walk_to(const Point& p) {
        constexpr int kMostSteps = 100000;  // among cells that others change, a walk may lead nowhere
        Index at = start_of_walk();
        int entry = -1;
        for (int step = 0; !kShared || step < kMostSteps; ++step) {
            const std::array<Index, 4> vertices = read(c_[at].vertices);
            int exit = 0;
            while (exit < 4 && (exit == entry || side(c_, vertices, exit, p) >= 0)) {
                ++exit;
            }
            if (exit < 4) {
                const Face next = read(c_[at].neighbors[exit]);
                at = cell_of(next);
                entry = opposite_of(next);
                continue;
            }
            if (!acquire(at, conflict_)) {
                return kNone;
            }
            last_ = at;
            if (!kShared || (c_[at].vertices == vertices && (entry < 0 || side(c_, vertices, entry, p) >= 0))) {
                return at;
            }
            set_mark(at, kIdle);  // it was another cell when we looked at it
            entry = -1;
        }
        return kNone;
    }

    /// The last cell, if it is still there; else the next one in the known slots.
    Index start_of_walk() const {
        Index start = last_;
        if constexpr (kShared) {
            for (Index i = 0; i < known_slots_ && read(c_[start].mark) == kEmpty; ++i) {
                start = start % (known_slots_ - 1) + 1;
            }
        }
        return start;
    }

    /// Searches the conflicting cells, level by level from the one that contains the vertex and is in conflict with it.
    /// \returns false if it met another worker's cells
    bool find_conflicts(Index vertex, Index start) {
        conflicts_.clear();
        conflicts_.append(1, [&](auto append_if) { append_if(true, start); });
        others_.clear();
        for (std::size_t level = 0; level < conflicts_.size();) {
            candidates_.clear();
            candidates_.append(4 * (conflicts_.size() - level), [&](auto append_if) {
                for (; level < conflicts_.size(); ++level) {
                    for (const Face face : c_[conflicts_[level]].neighbors) {
                        const Index outside = cell_of(face);
                        const bool is_mine = (read(c_[outside].mark) & ~1) == conflict_;
                        append_if(!is_mine & (outside != kBeyond), outside);
                    }
                }
            });
            if (!test_candidates(vertex)) {
                return false;
            }
        }
        return true;
    }

    /// Acquires the candidates, and sorts them into those in conflict with the vertex and others.
    bool test_candidates(Index vertex) {
        const Point point = c_.point(vertex);
        const double weight = c_.is_weighted ? c_.weight(vertex) : 0.0;
        bool is_free = true;
        conflicts_.append(candidates_.size(), [&](auto append_conflict_if) {
            others_.append(candidates_.size(), [&](auto append_other_if) {
                for (const Index cell : candidates_.all()) {
                    if (!acquire(cell, no_conflict_)) {
                        const Mark mark = read(c_[cell].mark);
                        if (mark == conflict_ || mark == no_conflict_) {
                            continue;  // it was a candidate twice
                        }
                        is_free = false;
                        break;
                    }
                    const bool is_in_conflict = is_conflict(c_, c_[cell], vertex, point, weight);
                    set_mark(cell, static_cast<Mark>(no_conflict_ - (is_in_conflict ? 1 : 0)));
                    append_conflict_if(is_in_conflict, cell);
                    append_other_if(!is_in_conflict, cell);
                }
            });
        });
        return is_free;
    }

    void find_rim() {
        rim_.clear();
        rim_.append(4 * conflicts_.size(), [&](auto append_if) {
            for (const Index cell : conflicts_.all()) {
                const std::array<Face, 4>& neighbors = c_[cell].neighbors;
                for (int k = 0; k < 4; ++k) {
                    append_if(read(c_[cell_of(neighbors[k])].mark) != conflict_, {face_of(cell, k), neighbors[k]});
                }
            }
        });
    }

    bool find_slots(std::size_t count) {
        while (empty_.size() < count) {
            const Index wanted = kShared ? 256 : static_cast<Index>(count - empty_.size());
            Index first = read(c_.used);
            if constexpr (kShared) {
                const std::atomic_ref<Index> used(c_.used);
                do {
                    if (first > c_.capacity - wanted) {
                        return false;
                    }
                } while (!used.compare_exchange_weak(first, first + wanted));
            } else {
                if (first > c_.capacity - wanted) {
                    reserve(c_, 2 * static_cast<std::size_t>(first + wanted));
                }
                c_.used = first + wanted;
            }
            for (Index slot = first; slot < first + wanted; ++slot) {
                set_mark(slot, kEmpty);
                empty_.push_back(slot);
            }
        }
        return true;
    }

    /// Joins the vertex with every face of the rim.
    void make_star(Index vertex) {
        const std::size_t count = rim_.size();
        const Index* const slots = empty_.data() + empty_.size() - count;
        const Point p = c_.point(vertex);
        batch_.start(count);
        edges_.start(3 * count / 2);
        edge_entries_.resize(std::max(edge_entries_.size(), count));
        for (std::size_t i = 0; i < count; ++i) {
            const Face inside = rim_[i].inside;
            const std::array<Index, 4>& v = c_[cell_of(inside)].vertices;
            const auto& positions = kFacetsOfCell[opposite_of(inside)];
            const Index a = v[positions[0]], b = v[positions[1]], c = v[positions[2]];
            edge_entries_[i] = {edges_.add(b, c, face_of(slots[i], 0)), edges_.add(c, a, face_of(slots[i], 1)),
                                edges_.add(a, b, face_of(slots[i], 2))};
            batch_.set(i, c_.point(a) - p, c_.point(b) - p, c_.point(c) - p);
            if (c_.is_weighted) {
                const double w = c_.weight(vertex);
                batch_.set_weights(i, c_.weight(a) - w, c_.weight(b) - w, c_.weight(c) - w);
            }
            Cell& cell = c_[slots[i]];
            write(cell.vertices[0], a);
            write(cell.vertices[1], b);
            write(cell.vertices[2], c);
            write(cell.vertices[kApex], vertex);
            cell.batch = c_.batch;
        }
        batch_.make_spheres(count);
        for (std::size_t i = 0; i < count; ++i) {
            Cell& cell = c_[slots[i]];
            for (int k = 0; k < kApex; ++k) {
                write(cell.neighbors[k], edges_.other(edge_entries_[i][k], face_of(slots[i], k)));
            }
            write(cell.neighbors[kApex], rim_[i].outside);
            cell.center = batch_.center(i);
            cell.error = batch_.error(i);
        }
        // Only now do others get to see the new cells.
        for (std::size_t i = 0; i < count; ++i) {
            const Face outside = rim_[i].outside;
            write(c_[cell_of(outside)].neighbors[opposite_of(outside)], face_of(slots[i], kApex));
            set_mark(slots[i], kIdle);
        }
        last_ = slots[0];
        empty_.resize(empty_.size() - count);
        release(others_);
        for (const Index cell : conflicts_.all()) {
            set_mark(cell, kEmpty);
        }
        empty_.insert(empty_.end(), conflicts_.all().begin(), conflicts_.all().end());
    }

    Cells& c_;
    const Index known_slots_;
    const Mark conflict_;
    const Mark no_conflict_;
    Index last_;                // a recent cell
    std::vector<Index> empty_;  // slots to be used

    // State of the current insertion.
    List<Index> conflicts_;
    List<Index> others_;  // cells that were looked at and are not in conflict
    List<Index> candidates_;
    List<RimFace> rim_;
    EdgeTable edges_;
    std::vector<std::array<std::size_t, 3>> edge_entries_;  // of the rim's faces
    SphereBatch batch_;
};

constexpr std::size_t kFewVertices = 200;  // not worth sharing: half a millisecond, in which threads begin
constexpr int kMostWorkers = 100;          // as many as there are marks for

/// Any cell, the next from `slot` on.
Index next_cell(const Cells& c, Index slot) {
    while (c[slot].mark != kIdle) {
        slot = slot % (c.used - 1) + 1;
    }
    return slot;
}

void insert_alone(Cells& c, std::span<const Index> vertices) {
    Worker<false> worker(c, 0, c.used, next_cell(c, c.used - 1), std::move(c.empty));
    CancellationPoint stop;
    for (const Index vertex : vertices) {
        worker.insert(vertex);
        stop();
    }
    c.empty = worker.empty();
}

/// Lets several workers insert the vertices, in pieces of their order far from each other. \returns those that are
/// left: for which there was no room, or others in the way
std::vector<Index> insert_together(Cells& c, std::span<const Index> vertices, int workers) {
    reserve(c, static_cast<std::size_t>(c.used) + 10 * vertices.size());
    const std::size_t regions = static_cast<std::size_t>(workers);
    const std::size_t piece = std::clamp<std::size_t>(vertices.size() / (8 * regions), 64, 512);
    const std::size_t pieces = (vertices.size() + piece - 1) / piece;
    const std::size_t pieces_in_region = (pieces + regions - 1) / regions;
    const Index known_slots = c.used;
    const Index last = next_cell(c, known_slots - 1);
    const std::vector<Index> empty = std::exchange(c.empty, {});

    struct Result {
        std::vector<Index> left;
        std::vector<Index> empty;
    };
    std::vector<Result> results(regions);
    std::atomic<std::size_t> turns = 0;
    tasks::parallel_for(0, workers, [&](int id) {
        Result& result = results[static_cast<std::size_t>(id)];
        const auto share = [&](int i) { return empty.begin() + empty.size() * static_cast<std::size_t>(i) / regions; };
        Worker<true> worker(c, id, known_slots, last, {share(id), share(id + 1)});
        bool has_room = true;
        for (std::size_t turn = turns++; turn < regions * pieces_in_region; turn = turns++) {
            stop_if_cancelled();
            const std::size_t begin = (turn % regions * pieces_in_region + turn / regions) * piece;
            for (std::size_t i = begin; i < std::min(begin + piece, vertices.size()); ++i) {
                const Outcome outcome = has_room ? worker.insert(vertices[i]) : Outcome::kNoRoom;
                has_room = outcome != Outcome::kNoRoom;
                if (outcome != Outcome::kDone) {
                    result.left.push_back(vertices[i]);
                }
            }
        }
        result.empty = worker.empty();
    });
    stop_if_cancelled();
    std::vector<Index> left;
    for (const Result& result : results) {
        left.insert(left.end(), result.left.begin(), result.left.end());
        c.empty.insert(c.empty.end(), result.empty.begin(), result.empty.end());
    }
    return left;
}

Cells cells_of_ghosts(const Point& center, double size, bool is_weighted) {
    Cells c{is_weighted, false, {}, {}, {}, 0, 0, {}, 0};
    for (const Point& direction : kGhostDirections) {
        c.points.push_back(center + size * direction);
    }
    c.weights.assign(is_weighted ? kGhosts : 0, 0.0);
    reserve(c, 64);
    c.used = 2;
    // An infinite error leaves every decision to the exact predicate.
    constexpr float kUnknown = std::numeric_limits<float>::infinity();
    const std::array<Index, 4> ghosts{-4, -3, -2, -1};
    c[kBeyond] = {ghosts, {face_of(1, 0), face_of(1, 1), face_of(1, 2), face_of(1, 3)}, {}, kUnknown, kNotACell, 0};
    c[1] = {ghosts, {face_of(0, 0), face_of(0, 1), face_of(0, 2), face_of(0, 3)}, {}, kUnknown, kIdle, 0};
    return c;
}

}  // namespace

Cells ghost_cells(const Box& box, bool is_weighted) {
    const Point center = box.is_empty() ? Point{} : midpoint(box.min, box.max);
    const double magnitude = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    // The inscribed ball of the ghosts' tetrahedron has a radius of three diagonals. A box of no size gets a
    // tetrahedron that can still be told from a point.
    const double size = std::max(6.0 * box.diagonal(), 0x1p-30 * magnitude);
    return cells_of_ghosts(center, size > 0 ? size : 1.0, is_weighted);
}

Cells ideal_ghost_cells(bool is_weighted) {
    // Without coordinates no filter tells anything, and every decision is left to the exact predicates.
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    Cells cells = cells_of_ghosts({kUnknown, kUnknown, kUnknown}, 1.0, is_weighted);
    cells.has_ideal_ghosts = true;
    return cells;
}

void insert_vertices(Cells& c, Index first) {
    if (++c.batch == 0) {  // the numbers of old batches come again
        for (Index slot = 0; slot < c.used; ++slot) {
            c[slot].batch = 0;
        }
        c.batch = 1;
    }
    const std::span<const Point> points = std::span(c.points).subspan(static_cast<std::size_t>(first + kGhosts));
    const InsertionOrder order = insertion_order(points);
    reserve(c, static_cast<std::size_t>(c.used) + 10 * points.size());

    const int workers = std::min(tasks::this_task_arena::max_concurrency(), kMostWorkers);
    std::size_t begin = 0;
    for (const std::size_t end : order.rounds) {
        std::vector<Index> vertices(order.points.begin() + begin, order.points.begin() + end);
        for (Index& vertex : vertices) {
            vertex += first;
        }
        while (workers > 1 && vertices.size() > kFewVertices) {
            std::vector<Index> left = insert_together(c, vertices, workers);
            const bool is_crowded = left.size() > vertices.size() / 2;
            vertices = std::move(left);
            if (is_crowded) {
                break;
            }
        }
        insert_alone(c, vertices);
        begin = end;
    }
}

}  // namespace scaleaxis::inline v1
