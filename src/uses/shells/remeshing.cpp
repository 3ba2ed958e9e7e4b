// SPDX-License-Identifier: Apache-2.0
#include "uses/shells/remeshing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "axis/complex.hpp"
#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "uses/ascent.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kRemeshingStage = "shell mesh";

// Edges between these parts of the size stay: halves of the longest are no shorter than the least (M. Botsch,
// L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004).
constexpr double kLongest = 4.0 / 3.0;
constexpr double kShortest = 4.0 / 5.0;
// Curves that end nearer to each other than this part of the size end in one point.
constexpr double kLeastCurve = 0.25;
constexpr int kRounds = 12;         // after all vertices are in their places; shapes of triangles settle in about eight
constexpr int kMostRounds = 60;     // for sizes far below the thickness of walls
constexpr int kMostDivisions = 12;  // of an edge 4,000 times as long as the size

// An edge at a vertex: its other end, and of a curve the walls and the rim by which one is told from another.
struct Spoke {
    Index end = kNone;
    Index count = 0;
    std::vector<Index> walls;
    Index rim = kNone;

    bool is_curve() const { return count != 2 || walls.front() != walls.back(); }
    bool goes_on_as(const Spoke& other) const { return walls == other.walls && rim == other.rim; }
};

enum class VertexPlace { kInside, kOnCurve, kCorner };

// The walls and rims that a vertex lies on, for `WallShapes::place`.
struct VertexWalls {
    std::vector<Index> walls;
    std::vector<Index> rims;
};

class WallRemesher {
   public:
    WallRemesher(const WallMesh& input, double size, const WallShapes& shapes)
        : size_(size),
          shapes_(shapes),
          vertices_(input.mesh.vertices),
          triangles_(input.mesh.triangles),
          walls_(input.walls),
          normals_(walls_.size()),
          at_(vertices_.size()) {
        for (Index t = 0; t < static_cast<Index>(triangles_.size()); ++t) {
            std::ranges::for_each(triangles_[t], [&](Index v) { at_[v].push_back(t); });
        }
        find_normals();
    }

    // Cuts all triangles at edges that are too long.
    void divide() {
        for (int round = 0; round < kMostDivisions; ++round) {
            bool has_divided = false;
            for (const auto& [length, a, b] : edges()) {
                if (length > kLongest * size_) {
                    cut(a, b);
                    has_divided = true;
                }
            }
            if (!has_divided) {
                return;
            }
        }
    }

    // Contracts edges that are too short, the shortest first.
    void contract() {
        auto all = edges();
        std::ranges::sort(all);
        CancellationPoint stop_if_cancelled_now_and_then;
        for (const auto& [length, a, b] : all) {
            if (length >= kShortest * size_) {
                return;
            }
            stop_if_cancelled_now_and_then();
            if (!at_[a].empty() && !at_[b].empty() && !triangles_at(a, b).empty()) {
                contract(a, b);
            }
        }
    }

    // Flips edges inside walls to the other diagonal where the angles opposite to them are together more than 180
    // degrees, until the triangles of each wall are Delaunay.
    void flip() {
        for (int round = 0; round < kMostDivisions; ++round) {
            bool has_flipped = false;
            for (const auto& [length, a, b] : edges()) {
                has_flipped = flip(a, b) || has_flipped;
            }
            if (!has_flipped) {
                return;
            }
        }
    }

    // Straightens bends and other curves: a triangle between two edges of one curve has no room once this is straight,
    // nor has one between the border and a vertex on it, as the end of a seam.
    void clip_ears() {
        for (Index t = 0; t < static_cast<Index>(triangles_.size()); ++t) {
            for (int k = 0; k < 3 && walls_[t] != kNone; ++k) {
                clip_ear(t, k);
            }
            for (int k = 0; k < 3 && walls_[t] != kNone; ++k) {
                join_curves(t, k);
            }
        }
    }

    // Moves vertices towards the middle of their neighbours and to their places. \returns how far the farthest was
    double relax(bool keeps_sides) {
        std::vector<Point> targets(vertices_);
        std::vector<double> ways(vertices_.size());
        for_each_index(
            vertices_.size(),
            [&](std::size_t i) {
                const auto v = static_cast<Index>(i);
                if (!at_[v].empty()) {
                    const std::vector<Spoke> spokes = spokes_of(v);
                    const VertexWalls on = walls_of(spokes);
                    ways[i] = distance(vertices_[v], shapes_.place(vertices_[v], on.walls, on.rims));
                    targets[i] = shapes_.place(evened(v, spokes), on.walls, on.rims);
                }
            },
            std::size_t{64});
        for (Index v = 0; v < static_cast<Index>(vertices_.size()); ++v) {
            if (!at_[v].empty()) {
                move(v, targets[v], keeps_sides);
            }
        }
        find_normals();
        return *std::ranges::max_element(ways);
    }

    WallMesh result() const {
        WallMesh result;
        std::vector<Index> numbers(vertices_.size(), kNone);
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (walls_[t] == kNone) {
                continue;
            }
            std::array<Index, 3> corners = triangles_[t];
            for (Index& v : corners) {
                if (numbers[v] == kNone) {
                    numbers[v] = static_cast<Index>(result.mesh.vertices.size());
                    result.mesh.vertices.push_back(vertices_[v]);
                }
                v = numbers[v];
            }
            result.mesh.triangles.push_back(corners);
            result.walls.push_back(walls_[t]);
        }
        return result;
    }

   private:
    using Edge = std::tuple<double, Index, Index>;

    std::vector<Edge> edges() const {
        std::vector<std::array<Index, 2>> ends;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            for (int k = 0; k < 3 && walls_[t] != kNone; ++k) {
                const auto [a, b] = std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]);
                ends.push_back({a, b});
            }
        }
        sort_unique(ends);
        std::vector<Edge> result;
        for (const auto& [a, b] : ends) {
            result.emplace_back(distance(vertices_[a], vertices_[b]), a, b);
        }
        return result;
    }

    std::vector<Index> triangles_at(Index a, Index b) const {
        std::vector<Index> result;
        std::ranges::copy_if(at_[a], std::back_inserter(result),
                             [&](Index t) { return std::ranges::find(triangles_[t], b) != triangles_[t].end(); });
        return result;
    }

    // The corner of a triangle besides two.
    Index apex(Index t, Index a, Index b) const {
        return *std::ranges::find_if(triangles_[t], [&](Index v) { return v != a && v != b; });
    }

    std::vector<Spoke> spokes_of(Index v) const {
        std::vector<std::array<Index, 2>> ends;
        for (const Index t : at_[v]) {
            for (const Index end : triangles_[t]) {
                if (end != v) {
                    ends.push_back({end, walls_[t]});
                }
            }
        }
        std::ranges::sort(ends);
        std::vector<Spoke> spokes;
        for (const auto& [end, wall] : ends) {
            if (spokes.empty() || spokes.back().end != end) {
                spokes.push_back({end, 0, {}, kNone});
            }
            ++spokes.back().count;
            spokes.back().walls.push_back(wall);
        }
        for (Spoke& spoke : spokes) {
            if (spoke.count == 1) {
                spoke.rim = shapes_.rim_at(spoke.walls.front(), midpoint(vertices_[v], vertices_[spoke.end]));
            }
        }
        return spokes;
    }

    static std::vector<const Spoke*> curves_of(const std::vector<Spoke>& spokes) {
        std::vector<const Spoke*> curves;
        for (const Spoke& spoke : spokes) {
            if (spoke.is_curve()) {
                curves.push_back(&spoke);
            }
        }
        return curves;
    }

    static VertexPlace place_of(const std::vector<Spoke>& spokes) {
        const std::vector<const Spoke*> curves = curves_of(spokes);
        if (curves.empty()) {
            return VertexPlace::kInside;
        }
        return curves.size() == 2 && curves[0]->goes_on_as(*curves[1]) ? VertexPlace::kOnCurve : VertexPlace::kCorner;
    }

    static VertexWalls walls_of(const std::vector<Spoke>& spokes) {
        VertexWalls result;
        for (const Spoke& spoke : spokes) {
            append(result.walls, spoke.walls);
            if (spoke.rim != kNone) {
                result.rims.push_back(spoke.rim);
            }
        }
        for (std::vector<Index>* list : {&result.walls, &result.rims}) {
            sort_unique(*list);
        }
        return result;
    }

    // Where a vertex divides its curve evenly, or is in the middle of its neighbours; a corner stays.
    Point evened(Index v, const std::vector<Spoke>& spokes) const {
        const Point& p = vertices_[v];
        const VertexPlace place = place_of(spokes);
        if (place == VertexPlace::kCorner) {
            return p;
        }
        if (place == VertexPlace::kOnCurve) {
            // Along the curve: halfway to the chord the rim of a small hole may be nearer on its other side.
            const std::vector<const Spoke*> curves = curves_of(spokes);
            const Point& before = vertices_[curves[0]->end];
            const Point& after = vertices_[curves[1]->end];
            const Point along = unit(after - before);
            return p + 0.5 * dot(midpoint(before, after) - p, along) * along;
        }
        Point sum;
        for (const Spoke& spoke : spokes) {
            sum = sum + vertices_[spoke.end];
        }
        return (1.0 / static_cast<double>(spokes.size())) * sum;
    }

    void find_normals() {
        for_each_index(
            triangles_.size(),
            [&](std::size_t t) {
                if (walls_[t] != kNone) {
                    const auto& [a, b, c] = triangles_[t];
                    normals_[t] = shapes_.normal(walls_[t], (1.0 / 3.0) * (vertices_[a] + vertices_[b] + vertices_[c]));
                }
            },
            std::size_t{256});
    }

    // Cosine of the angle between a triangle and its wall; -1 without area.
    double agreement(const std::array<Point, 3>& corners, const Point& normal) const {
        const Point area = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double twice = norm(area);
        return twice > kFileRounding * size_ * size_ ? dot(area, normal) / twice : -1.0;
    }

    std::array<Point, 3> corners_of(Index t) const {
        return {vertices_[triangles_[t][0]], vertices_[triangles_[t][1]], vertices_[triangles_[t][2]]};
    }

    // May a corner of a triangle be moved, as far as its sides matter?
    bool may_move(Index t, Index v, const Point& to) const {
        std::array<Point, 3> moved = corners_of(t);
        const double before = agreement(moved, normals_[t]);
        moved[static_cast<std::size_t>(std::ranges::find(triangles_[t], v) - triangles_[t].begin())] = to;
        const double after = agreement(moved, normals_[t]);
        return after >= std::min(before, 0.0);
    }

    // Not far in one round, so that the mesh around the vertex can follow.
    void move(Index v, const Point& target, bool keeps_sides) {
        Point step = target - vertices_[v];
        if (const double length = norm(step); length > kNearby * size_) {
            step = (kNearby * size_ / length) * step;
        }
        for (int halving = 0; halving < 4; ++halving, step = 0.5 * step) {
            const Point to = vertices_[v] + step;
            if (!keeps_sides || std::ranges::all_of(at_[v], [&](Index t) { return may_move(t, v, to); })) {
                vertices_[v] = to;
                return;
            }
        }
    }

    Index cut(Index a, Index b) {
        const auto middle = static_cast<Index>(vertices_.size());
        vertices_.push_back(midpoint(vertices_[a], vertices_[b]));
        at_.emplace_back();
        for (const Index t : triangles_at(a, b)) {
            const auto added = static_cast<Index>(triangles_.size());
            triangles_.push_back(triangles_[t]);
            walls_.push_back(walls_[t]);
            normals_.push_back(normals_[t]);
            std::ranges::replace(triangles_[t], b, middle);
            std::ranges::replace(triangles_[added], a, middle);
            std::erase(at_[b], t);
            at_[b].push_back(added);
            at_[apex(t, a, middle)].push_back(added);
            at_[middle].push_back(t);
            at_[middle].push_back(added);
        }
        return middle;
    }

    void clip_ear(Index t, int corner) {
        const Index v = triangles_[t][corner];
        const std::array<Index, 2> others{triangles_[t][(corner + 1) % 3], triangles_[t][(corner + 2) % 3]};
        const std::vector<Spoke> spokes = spokes_of(v);
        const std::array<const Spoke*, 2> sides{&*std::ranges::find(spokes, others[0], &Spoke::end),
                                                &*std::ranges::find(spokes, others[1], &Spoke::end)};
        const Point one = vertices_[others[0]] - vertices_[v];
        const Point two = vertices_[others[1]] - vertices_[v];
        const double cosine = dot(unit(one), unit(two));
        const auto is_border = [&](const Spoke& spoke) { return spoke.count == 1 && spoke.walls[0] == walls_[t]; };
        if (cosine < kNegligible - 1.0 && triangles_at(others[0], others[1]).size() == 1 &&
            std::ranges::none_of(spokes, is_border)) {
            remove(t);
            return;
        }
        if (!sides[0]->is_curve() || !sides[1]->is_curve()) {
            return;
        }
        if (place_of(spokes) == VertexPlace::kOnCurve && sides[0]->count == 2) {
            walls_[t] = sides[0]->walls[sides[0]->walls[0] == walls_[t] ? 1 : 0];
        } else if (place_of(spokes) == VertexPlace::kOnCurve && cosine < -kSameDirection) {
            const int nearer = squared_norm(one) < squared_norm(two) ? 0 : 1;
            contract(v, others[nearer], others[1 - nearer]);
            if (walls_[t] != kNone) {
                contract(v, others[1 - nearer], others[nearer]);
            }
        }
    }

    // A triangle between two curves at one place, as the seams of walls that cross obliquely: one is led through the
    // corner on the other.
    void join_curves(Index t, int corner) {
        const Index v = triangles_[t][corner];
        const Index a = triangles_[t][(corner + 1) % 3];
        const Index b = triangles_[t][(corner + 2) % 3];
        const Point along = vertices_[b] - vertices_[a];
        const Point from = vertices_[v] - vertices_[a];
        const double part = dot(from, along) / squared_norm(along);
        if (!(part > 0.0 && part < 1.0 && norm(from - part * along) < kSmallPart * size_)) {
            return;
        }
        const std::vector<Spoke> spokes = spokes_of(a);
        if (place_of(spokes_of(v)) != VertexPlace::kInside && std::ranges::find(spokes, b, &Spoke::end)->is_curve()) {
            replace(v, cut(a, b), vertices_[v]);
        }
    }

    // \param beyond a vertex towards which curves from both ends may go on as one: between them there is no room
    void contract(Index a, Index b, Index beyond = kNone) {
        std::vector<Spoke> spokes = spokes_of(a);
        VertexPlace place = place_of(spokes);
        VertexPlace other_place = place_of(spokes_of(b));
        if (place > other_place) {  // `a` goes
            std::swap(a, b);
            std::swap(place, other_place);
            spokes = spokes_of(a);
        }
        const Spoke& edge = *std::ranges::find(spokes, b, &Spoke::end);
        const bool is_short = distance(vertices_[a], vertices_[b]) < kLeastCurve * size_;
        // What lies between curves as near to each other, as between the seams of walls that cross, goes with them.
        if (!is_short && place != VertexPlace::kInside && (!edge.is_curve() || place == VertexPlace::kCorner)) {
            return;
        }
        const Point to =
            place == other_place && place != VertexPlace::kCorner ? midpoint(vertices_[a], vertices_[b]) : vertices_[b];
        if (is_short ? keeps_holes(a, b, spokes) : keeps_shape(a, b, spokes, beyond) && may_contract(a, b, to)) {
            replace(a, b, to);
        }
    }

    // Does no hole of three edges close that is wider than a short edge is long?
    bool keeps_holes(Index a, Index b, const std::vector<Spoke>& spokes) const {
        const std::vector<Spoke> others = spokes_of(b);
        return std::ranges::none_of(spokes, [&](const Spoke& spoke) {
            const auto other = std::ranges::find(others, spoke.end, &Spoke::end);
            return other != others.end() && spoke.count == 1 && other->count == 1 &&
                   std::ranges::none_of(triangles_at(a, b), [&](Index t) { return apex(t, a, b) == spoke.end; }) &&
                   distance(vertices_[a], vertices_[spoke.end]) >= kLeastCurve * size_;
        });
    }

    // Does the surface stay what it is, with all its curves, if `a` becomes `b`?
    bool keeps_shape(Index a, Index b, const std::vector<Spoke>& spokes, Index beyond) const {
        const std::vector<Spoke> others = spokes_of(b);
        std::size_t common = 0;
        for (const Spoke& spoke : spokes) {
            const auto other = std::ranges::find(others, spoke.end, &Spoke::end);
            if (other != others.end()) {
                ++common;
                if (spoke.end != beyond && spoke.is_curve() && other->is_curve()) {
                    return false;
                }
            }
        }
        const std::vector<Index> at = triangles_at(a, b);
        auto apexes = each_of<Index>(at, [&](Index t) { return apex(t, a, b); });
        std::ranges::sort(apexes);
        if (std::ranges::adjacent_find(apexes) != apexes.end() || common != apexes.size()) {
            return false;
        }
        // No triangle may become the same as another one, nor may the last ones of a wall go.
        return std::ranges::none_of(at_[a], [&](Index t) {
            return std::ranges::all_of(triangles_[t], [&](Index v) {
                return v == a || (v != beyond && std::ranges::binary_search(apexes, v));
            });
        });
    }

    bool may_contract(Index a, Index b, const Point& to) const {
        const auto allows = [&](Index t, Index moved, Index other) {
            if (std::ranges::find(triangles_[t], other) != triangles_[t].end()) {
                return true;  // it goes
            }
            return may_move(t, moved, to) && std::ranges::all_of(triangles_[t], [&](Index v) {
                       return v == moved || distance(vertices_[v], to) <= kLongest * size_;
                   });
        };
        return std::ranges::all_of(at_[a], [&](Index t) { return allows(t, a, b); }) &&
               std::ranges::all_of(at_[b], [&](Index t) { return allows(t, b, a); });
    }

    void replace(Index a, Index b, const Point& to) {
        vertices_[b] = to;
        for (const Index t : triangles_at(a, b)) {
            remove(t);
        }
        for (const Index t : at_[a]) {
            std::ranges::replace(triangles_[t], a, b);
            at_[b].push_back(t);
        }
        at_[a].clear();
        remove_twins(b);
    }

    // Where a pocket between sheets has closed two triangles are one; where a fold has, none.
    void remove_twins(Index v) {
        const auto corners = [&](Index t) {
            std::array<Index, 3> sorted = triangles_[t];
            std::ranges::sort(sorted);
            return sorted;
        };
        std::vector<Index> at = at_[v];
        std::ranges::sort(at, {}, [&](Index t) { return std::pair(corners(t), t); });
        for (std::size_t i = 1; i < at.size(); ++i) {
            if (corners(at[i - 1]) == corners(at[i])) {
                remove(at[i]);
                if (has_border(at[i - 1])) {
                    remove(at[i - 1]);
                }
            }
        }
    }

    bool has_border(Index t) const {
        const auto& [a, b, c] = triangles_[t];
        return triangles_at(a, b).size() == 1 || triangles_at(b, c).size() == 1 || triangles_at(c, a).size() == 1;
    }

    void remove(Index t) {
        std::ranges::for_each(triangles_[t], [&](Index v) { std::erase(at_[v], t); });
        walls_[t] = kNone;
    }

    bool flip(Index a, Index b) {
        const std::vector<Index> at = triangles_at(a, b);
        if (at.size() != 2 || walls_[at[0]] != walls_[at[1]]) {
            return false;
        }
        const auto passes = [&](Index t, Index from, Index to) {
            const auto k = std::ranges::find(triangles_[t], from) - triangles_[t].begin();
            return triangles_[t][(k + 1) % 3] == to;
        };
        const Index first = passes(at[0], a, b) ? at[0] : at[1];
        const Index second = first == at[0] ? at[1] : at[0];
        if (!passes(first, a, b) || !passes(second, b, a)) {
            return false;
        }
        const Index c = apex(first, a, b);
        const Index d = apex(second, a, b);
        const auto angle_at = [&](Index v) {
            const Point u = vertices_[a] - vertices_[v];
            const Point w = vertices_[b] - vertices_[v];
            return angle_of(u, w);
        };
        // Four points on a circle would be flipped for ever.
        if (c == d || angle_at(c) + angle_at(d) <= std::numbers::pi + kFileRounding || !triangles_at(c, d).empty()) {
            return false;
        }
        const std::array<Index, 3> one{c, a, d};
        const std::array<Index, 3> other{d, b, c};
        const auto agrees = [&](const std::array<Index, 3>& corners) {
            return agreement({vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]]}, normals_[first]);
        };
        const double before =
            std::min(agreement(corners_of(first), normals_[first]), agreement(corners_of(second), normals_[second]));
        if (std::min(agrees(one), agrees(other)) < std::min(before, 0.0)) {
            return false;
        }
        triangles_[first] = one;
        triangles_[second] = other;
        std::erase(at_[b], first);
        std::erase(at_[a], second);
        at_[d].push_back(first);
        at_[c].push_back(second);
        return true;
    }

    double size_;
    const WallShapes& shapes_;
    std::vector<Point> vertices_;
    std::vector<std::array<Index, 3>> triangles_;
    std::vector<Index> walls_;    // #T; kNone: the triangle is gone
    std::vector<Point> normals_;  // #T, of the wall there
    std::vector<std::vector<Index>> at_;
};

}  // namespace

WallMesh remeshed(const WallMesh& input, double size, double farthest, const WallShapes& shapes,
                  const Execution& execution) {
    WallRemesher remesher(input, size, shapes);
    const int rounds = std::min(kMostRounds, kRounds + static_cast<int>(farthest / (kNearby * size)));
    for (int round = 0; round < rounds; ++round) {
        report(execution, kRemeshingStage, static_cast<double>(round) / rounds);
        remesher.divide();
        remesher.contract();
        remesher.clip_ears();
        remesher.flip();
        remesher.relax(round >= rounds - kRounds / 2);
    }
    remesher.flip();
    return remesher.result();
}

}  // namespace scaleaxis::inline v1
