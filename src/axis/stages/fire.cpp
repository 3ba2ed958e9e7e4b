// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/fire.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <utility>

#include "axis/complex.hpp"
#include "axis/edit/remainder.hpp"
#include "base/disjoint_sets.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/cleaning.hpp"

namespace scaleaxis::inline v1 {
namespace {

Front front_between(const Point& a, const Point& b, double time_a, double time_b) {
    Front front{a, {}, distance(a, b), time_a};
    if (front.length > 0.0) {
        front.direction = (1.0 / front.length) * (b - a);
        front.slope = (time_b - time_a) / front.length;
        const double square = 1.0 - front.slope * front.slope;
        // Where the time grows as fast as the fire burns all comes from the earlier end.
        front.lead = square > 0.0 ? front.slope / std::sqrt(square) : std::copysign(kInfinity, front.slope);
    }
    return front;
}

// The first arrival at `x`, on a straight way: what comes from the border first has not met the border in between, so
// that in a plane sheet no way is shorter. A way along the edges of faces would zigzag.
Arrival arrival(const Front& front, const Point& x) {
    const Point from_start = x - front.start;
    const double foot = dot(from_start, front.direction);
    const double height = norm(from_start - foot * front.direction);
    const double lead = height > 0.0 ? front.lead * height : 0.0;
    const double position = std::clamp(foot - lead, 0.0, front.length);
    const double along = foot - position;
    const double path = std::sqrt(along * along + height * height);
    return {front.time + position * front.slope + path, path};
}

// Burns a complex by collapses, in order of time: a face from an edge that is left with this one face, an edge without
// faces from a vertex that is left with this one edge. The rule for seams comes out of that by itself.
class Burning {
   public:
    Burning(const MedialComplex& complex, const std::vector<double>& radii, const Sides& sides, const Sectors& sectors,
            double tolerance)
        : complex_(complex),
          radii_(radii),
          tolerance_(tolerance),
          sides_(sides),
          sectors_(sectors),
          sectors_at_(grouped(complex.vertices.size(),
                              [&](const auto& add) {
                                  for (Index s = 0; s < static_cast<Index>(sectors.vertices.size()); ++s) {
                                      add(sectors.vertices[s], s);
                                  }
                              })),
          remainder_(complex),
          fronts_at_(complex.vertices.size()),
          front_of_edge_(complex.edges.size(), kNone),
          states_(sectors.vertices.size()),
          curve_front_(complex.vertices.size(), kNone),
          curve_times_(complex.vertices.size(), -kInfinity) {}

    Fire run() {
        for (Index e = 0; e < static_cast<Index>(complex_.edges.size()); ++e) {
            if (remainder_.only_face(e) != kNone) {
                ignite_face(e);
            }
        }
        for (Index v = 0; v < static_cast<Index>(complex_.vertices.size()); ++v) {
            burn_on_from(v);
        }
        CancellationPoint stop_if_cancelled_now_and_then;
        while (!events_.empty()) {
            stop_if_cancelled_now_and_then();
            const auto [time, edge] = events_.top();
            events_.pop();
            if (const Index face = remainder_.only_face(edge); face != kNone) {
                burn_face(time, edge, face);
            } else if (remainder_.has_edge[edge] != 0 && sides_.of_edge[edge].empty()) {
                burn_curve_edge(edge);
            }
        }
        return result();
    }

   private:
    // An arrival that comes first of those from a front and from the fronts beside it.
    struct KnownArrival {
        Arrival arrival;
        Index front = kNone;
        Index fronts_beside = 0;
    };

    // What there is to know of a sector, side by side: the fire burns here and there in turn, and what it asks for is
    // seldom in the cache.
    struct SectorState {
        Arrival arrival;
        Index front = kNone;  // from which it came
        KnownArrival known;
    };

    using Event = std::pair<double, Index>;  // when, and from which edge a face burns, or which edge

    // The time at which all that reaches a vertex on sheets and curves has come.
    double latest_at(Index vertex) const {
        double latest = curve_times_[vertex];
        for (const Index s : sectors_at_[vertex]) {
            if (states_[s].arrival.time < kInfinity) {
                latest = std::max(latest, states_[s].arrival.time);
            }
        }
        return std::max(latest, radii_[vertex]);
    }

    // The latest time at which the faces that have burnt at an edge have burnt at its ends.
    std::array<double, 2> latest_across_seam(Index edge, Index last_face) const {
        const auto& [p, q] = complex_.edges[edge];
        std::array<double, 2> latest{radii_[p], radii_[q]};
        for (const Index side : sides_.of_edge[edge]) {
            if (sides_.face_of[side] != last_face) {
                const std::array<Index, 2> corners = corners_at_ends(complex_, sides_, side);
                for (int end : {0, 1}) {
                    latest[end] = std::max(latest[end], states_[sectors_.of_corner[corners[end]]].arrival.time);
                }
            }
        }
        return latest;
    }

    // The face at an edge starts to burn from it.
    void ignite_face(Index edge) {
        const Index face = remainder_.only_face(edge);
        const auto& [p, q] = complex_.edges[edge];
        if (sides_.is_regular(edge)) {
            const auto corners = corners_at_ends(complex_, sides_, sides_.of_edge[edge][0]);
            const Index at_p = states_[sectors_.of_corner[corners[0]]].front;
            const Index at_q = states_[sectors_.of_corner[corners[1]]].front;
            front_of_edge_[edge] =
                at_p == at_q ? at_p : first_at(midpoint(complex_.vertices[p], complex_.vertices[q]), at_p, at_q);
        } else {
            const bool is_border = sides_.of_edge[edge].size() == 1;
            const auto times = is_border ? std::array{radii_[p], radii_[q]} : latest_across_seam(edge, face);
            front_of_edge_[edge] = static_cast<Index>(fronts_.size());
            add_fronts({complex_.vertices[p], times[0]}, {complex_.vertices[q], times[1]}, {p, q},
                       complex_.face_sheets[face], is_border && !is_linear(complex_, {p, q}));
            near_fronts_.assign(1, front_of_edge_[edge]);
            for (const Index side : sides_.of_edge[edge]) {
                if (sides_.face_of[side] == face) {
                    for (const Index corner : corners_at_ends(complex_, sides_, side)) {
                        Index front = kNone;
                        const Arrival found = first_arrival(corner, front);
                        set(corner, found, front);
                    }
                }
            }
        }
        events_.emplace(burnt_through(edge, face), edge);
    }

    // From one ball to another, on an edge with these ends: as many fronts as it takes for radii of a union to be
    // nearly linear on each.
    void add_fronts(const Ball& from, const Ball& to, const std::array<Index, 2>& ends, Index sheet, bool may_dip) {
        const double square = squared_distance(from.center, to.center);
        const auto at = may_dip ? deepest_dip(from.radius, to.radius, square) : std::nullopt;
        const Ball between{from.center + at.value_or(0.0) * (to.center - from.center),
                           radius_between(from.radius, to.radius, square, at.value_or(0.0))};
        const double dip = std::lerp(from.radius, to.radius, at.value_or(0.0)) - between.radius;
        if (at && dip > std::max(tolerance_, kNegligible * std::max(from.radius, to.radius))) {
            add_fronts(from, between, ends, sheet, true);
            add_fronts(between, to, ends, sheet, true);
            return;
        }
        Front front = front_between(from.center, to.center, from.radius, to.radius);
        front.ends = ends;
        front.sheet = sheet;
        for (const Index v : ends) {
            fronts_at_[v].push_back(static_cast<Index>(fronts_.size()));
        }
        fronts_.push_back(front);
    }

    // Which of two fronts, or `kNone`, comes first.
    Index first_at(const Point& x, Index a, Index b) const {
        const auto time_of = [&](Index front) { return front == kNone ? kInfinity : arrival(fronts_[front], x).time; };
        return time_of(b) < time_of(a) ? b : a;
    }

    // The first arrival from one of the near fronts, or from one beside it in the same sheet. \param front which one
    //
    // A sector is asked about a dozen times, from each of its faces, and the answer is mostly the same: so the last one
    // is kept, and the fronts beside it need not be looked at again unless there are new ones.
    Arrival first_arrival(Index corner, Index& front) {
        const Point& x = complex_.vertices[complex_.faces.items[corner]];
        KnownArrival& known = states_[sectors_.of_corner[corner]].known;
        Arrival first;
        const auto try_front = [&](Index other) {
            const Arrival found = other == known.front ? known.arrival : arrival(fronts_[other], x);
            if (found.time < first.time) {
                first = found;
                front = other;
                return true;
            }
            return false;
        };
        for (const Index near : near_fronts_) {
            try_front(near);
        }
        const auto fronts_beside = [&] {
            const auto& [p, q] = fronts_[front].ends;
            return static_cast<Index>(fronts_at_[p].size() + fronts_at_[q].size());
        };
        for (bool has_changed = front != kNone; has_changed;) {
            if (front == known.front && fronts_beside() == known.fronts_beside) {
                return first;
            }
            has_changed = false;
            const Front& at = fronts_[front];
            for (const Index end : at.ends) {
                for (const Index other : fronts_at_[end]) {
                    has_changed =
                        (fronts_[other].sheet == at.sheet && other != front && try_front(other)) || has_changed;
                }
            }
        }
        if (front != kNone) {
            known = {first, front, fronts_beside()};
        }
        return first;
    }

    void set(Index corner, const Arrival& found, Index front) {
        SectorState& state = states_[sectors_.of_corner[corner]];
        if (found.time < state.arrival.time) {
            state.arrival = found;
            state.front = front;
        }
    }

    // The fronts that may burn through a face from an edge.
    void find_fronts(Index edge, Index face) {
        near_fronts_.assign(1, front_of_edge_[edge]);
        for (Index c = complex_.faces.offsets[face]; c < complex_.faces.offsets[face + 1]; ++c) {
            const Index front = states_[sectors_.of_corner[c]].front;
            if (front != kNone && std::ranges::find(near_fronts_, front) == near_fronts_.end()) {
                near_fronts_.push_back(front);
            }
        }
    }

    double burnt_through(Index edge, Index face) {
        find_fronts(edge, face);
        arrivals_.clear();
        double last = 0.0;
        for (Index c = complex_.faces.offsets[face]; c < complex_.faces.offsets[face + 1]; ++c) {
            Index front = kNone;
            const Arrival found = first_arrival(c, front);
            arrivals_.emplace_back(found, front);
            last = std::max(last, std::min(states_[sectors_.of_corner[c]].arrival.time, found.time));
        }
        return last;
    }

    void burn_face(double time, Index edge, Index face) {
        if (const double later = burnt_through(edge, face); later > time) {
            events_.emplace(later, edge);  // corners have been reached from a front that is not the edge's
            return;
        }
        for (Index c = complex_.faces.offsets[face]; c < complex_.faces.offsets[face + 1]; ++c) {
            const auto& [found, front] = arrivals_[c - complex_.faces.offsets[face]];
            set(c, found, front);
        }
        remainder_.remove_face(complex_, face);
        for (const Index e : complex_.face_edges[face]) {
            if (e != edge && remainder_.faces_at_edge[e].count == 1) {
                ignite_face(e);
            }
        }
        remainder_.remove_edge(complex_, edge);
        for (const Index v : complex_.faces[face]) {
            burn_on_from(v);
        }
    }

    // If a vertex is left with one edge, without faces: an edge that faces have left behind the front burns at once,
    // one of a curve in its time.
    void burn_on_from(Index vertex) {
        for (Index edge = remainder_.only_bare_edge(vertex); edge != kNone; edge = remainder_.only_bare_edge(vertex)) {
            const Index next = other_end(complex_.edges[edge], vertex);
            if (sides_.of_edge[edge].empty()) {
                if (curve_front_[vertex] == kNone || !is_inside_curve(vertex)) {
                    curve_front_[vertex] = static_cast<Index>(fronts_.size());
                    const Point& at = complex_.vertices[vertex];
                    fronts_.push_back(front_between(at, at, latest_at(vertex), latest_at(vertex)));
                }
                events_.emplace(arrival(fronts_[curve_front_[vertex]], complex_.vertices[next]).time, edge);
                return;
            }
            remainder_.remove_edge(complex_, edge);
            vertex = next;
        }
    }

    bool is_inside_curve(Index vertex) const { return sectors_at_[vertex].empty() && degrees_[vertex] == 2; }

    void burn_curve_edge(Index edge) {
        auto [from, to] = complex_.edges[edge];
        const auto is_free = [&](Index v) {
            return remainder_.edges_at_vertex[v].count == 1 && curve_front_[v] != kNone;
        };
        if (!is_free(from) || (is_free(to) && latest_at(to) < latest_at(from))) {
            std::swap(from, to);
        }
        const Index front = curve_front_[from];
        const double time = std::max(arrival(fronts_[front], complex_.vertices[to]).time, latest_at(from));
        // Where the fire burns from both ends, it has passed both of them, and meets within the edge.
        if (!is_free(to) && time > curve_times_[to]) {
            curve_times_[to] = time;
            curve_front_[to] = front;
        }
        remainder_.remove_edge(complex_, edge);
        burn_on_from(to);
    }

    Fire result() {
        Fire fire;
        for (const SectorState& state : states_) {
            fire.sector_fronts.push_back(state.front);
            fire.sector_times.push_back(state.arrival.time);
            fire.sector_paths.push_back(state.arrival.path);
        }
        fire.vertex_times.resize(complex_.vertices.size());
        for (Index v = 0; v < static_cast<Index>(complex_.vertices.size()); ++v) {
            double time = std::max(radii_[v], curve_times_[v]);
            for (const Index s : sectors_at_[v]) {
                time = std::max(time, fire.sector_times[s]);
            }
            const bool is_in_loop = sectors_at_[v].empty() && remainder_.edges_at_vertex[v].count > 1;
            fire.vertex_times[v] = is_in_loop ? kInfinity : time;
        }
        fire.fronts = std::move(fronts_);
        fire.fronts_at = std::move(fronts_at_);
        return fire;
    }

    const MedialComplex& complex_;
    const std::vector<double>& radii_;
    double tolerance_;
    const Sides& sides_;
    const Sectors& sectors_;
    IndexLists sectors_at_;  // of each vertex
    Remainder remainder_;
    std::vector<Index> degrees_ = degrees();
    std::vector<Front> fronts_;
    std::vector<std::vector<Index>> fronts_at_;  // of each vertex, those of edges
    std::vector<Index> front_of_edge_;           // of edges that are left with one face
    std::vector<SectorState> states_;
    std::vector<Index> curve_front_;  // of vertices on curves: where the fire that came last started
    std::vector<double> curve_times_;
    std::vector<Index> near_fronts_;
    std::vector<std::pair<Arrival, Index>> arrivals_;  // at the corners of a face, and from which front
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;

    std::vector<Index> degrees() const {
        std::vector<Index> result(complex_.vertices.size());
        for (std::size_t v = 0; v < result.size(); ++v) {
            result[v] = remainder_.edges_at_vertex[v].count;
        }
        return result;
    }
};

}  // namespace

Sides sides_of(const MedialComplex& complex) {
    Sides result;
    result.face_of.resize(complex.faces.items.size());
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        std::fill(result.face_of.begin() + complex.faces.offsets[f],
                  result.face_of.begin() + complex.faces.offsets[f + 1], f);
    }
    result.of_edge = grouped(complex.edges.size(), [&](const auto& add) {
        for (Index c = 0; c < static_cast<Index>(complex.face_edges.items.size()); ++c) {
            add(complex.face_edges.items[c], c);
        }
    });
    return result;
}

std::array<Index, 2> corners_at_ends(const MedialComplex& complex, const Sides& sides, Index side) {
    const Index face = sides.face_of[side];
    const Index next = side + 1 < complex.faces.offsets[face + 1] ? side + 1 : complex.faces.offsets[face];
    const bool is_forward = complex.edges[complex.face_edges.items[side]][0] == complex.faces.items[side];
    return is_forward ? std::array{side, next} : std::array{next, side};
}

Sectors sectors_of(const MedialComplex& complex, const Sides& sides) {
    DisjointSets joined(complex.faces.items.size());
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        if (sides.is_regular(e)) {
            const auto first = corners_at_ends(complex, sides, sides.of_edge[e][0]);
            const auto second = corners_at_ends(complex, sides, sides.of_edge[e][1]);
            joined.join(first[0], second[0]);
            joined.join(first[1], second[1]);
        }
    }
    Sectors result;
    result.of_corner.resize(complex.faces.items.size());
    for (Index c = 0; c < static_cast<Index>(result.of_corner.size()); ++c) {
        const Index first = joined.find(c);
        if (first == c) {
            result.of_corner[c] = static_cast<Index>(result.vertices.size());
            result.vertices.push_back(complex.faces.items[c]);
        } else {
            result.of_corner[c] = result.of_corner[first];
        }
    }
    return result;
}

Fire burn(const MedialComplex& complex, const std::vector<double>& radii, const Sides& sides, const Sectors& sectors,
          double tolerance) {
    return Burning(complex, radii, sides, sectors, tolerance).run();
}

std::pair<Arrival, Index> arrival_beside(const Fire& fire, Index sector, const Point& x) {
    Index front = fire.sector_fronts[sector];
    Arrival first = arrival(fire.fronts[front], x);
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        const Front& at = fire.fronts[front];
        for (const Index end : at.ends) {
            for (const Index other : fire.fronts_at[end]) {
                if (const Front& beside = fire.fronts[other]; beside.sheet == at.sheet) {
                    if (const Arrival sooner = arrival(beside, x); sooner.time < first.time) {
                        first = sooner;
                        front = other;
                        has_changed = true;
                    }
                }
            }
        }
    }
    return {first, front};
}

ErosionThickness erosion_thickness(const MedialComplex& complex, const Execution& execution) {
    return in_arena(execution, [&] {
        check(complex);
        report(execution, "erosion thickness", 0.0);
        const Sides sides = sides_of(complex);
        const Sectors sectors = sectors_of(complex, sides);
        Fire fire = burn(complex, complex.radii, sides, sectors);
        ErosionThickness result;
        result.corner_burn_times = each_of<double>(sectors.of_corner, [&](Index s) { return fire.sector_times[s]; });
        for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
            result.thickness.push_back(fire.vertex_times[v] - complex.radii[v]);
        }
        result.burn_times = std::move(fire.vertex_times);
        report(execution, "erosion thickness", 1.0);
        return result;
    });
}

}  // namespace scaleaxis::inline v1
