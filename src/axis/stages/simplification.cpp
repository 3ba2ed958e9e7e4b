// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/simplification.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "axis/complex.hpp"
#include "axis/edit/triangulated.hpp"
#include "axis/envelope_data.hpp"
#include "axis/stages/slab_quadric.hpp"
#include "axis/stages/stages.hpp"
#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kSimplificationStage = "simplification";

// The error grows to that asked for in these steps, so that collapses which cost little come first everywhere.
constexpr std::array kErrorSteps{0.25, 0.5, 1.0, 1.0};

// Where a number of vertices is asked for: how the error grows, from a small one on.
constexpr double kErrorGrowth = 1.4;

// From this error on, as a part of the diagonal, seams, borders and sheets are no longer kept: that would cost more
// shape than their own loss.
constexpr double kClassError = 0.005;

// The least cosine of the angle by which a collapse may turn a triangle.
constexpr double kLeastTurn = 0.3;

// The cost of a unit of length of an edge beside a unit of error: where sheets are flat short edges go first, and no
// needles come to be.
constexpr double kPositionPull = 1e-5;

// Triangles are looked at in points that are an error apart, but no more than this part of the mean edge given: the
// envelope given changes no faster. At 0.4 balls between these points stick out by 7 % more than the error on some
// axes.
constexpr double kLeastStep = 0.25;

// What may become of a vertex.
enum class Rank : std::uint8_t {
    kInner,   // of a sheet
    kAlong,   // inside a seam, a border or a curve
    kCorner,  // where these end or meet; anchors
};

// A triangle, an edge without faces (`size` 2), or a vertex without edges.
struct Simplex {
    std::array<Index, 3> corners{kNone, kNone, kNone};
    int size = 0;
    Index sheet = kNone;
    std::vector<Index> witnesses;  // the given balls that it stands for

    bool has(Index v) const { return corners[0] == v || corners[1] == v || (size == 3 && corners[2] == v); }
};

struct Candidate {
    double cost;
    Index u, v;
    std::array<Index, 2> versions;  // of both when the cost was computed

    // The least cost is the greatest priority.
    bool operator<(const Candidate& other) const {
        return std::pair(std::pair(-cost, u), v) < std::pair(std::pair(-other.cost, other.u), other.v);
    }
};

// What a collapse makes of the simplices around an edge.
struct Change {
    Index kept = kNone;
    Index removed = kNone;
    Ball ball;
    std::vector<Index> gone;     // simplices that have both ends
    std::vector<Index> changed;  // those that have one
    std::vector<Slab> slabs;     // what these become
};

double longest_side(const Slab& slab) {
    const auto& [a, b, c] = slab.corners;
    const double side = distance(a.center, b.center);
    return slab.size < 3 ? side : std::max({side, distance(b.center, c.center), distance(c.center, a.center)});
}

Ball between(const Ball& a, const Ball& b, double t) {
    return {a.center + t * (b.center - a.center), a.radius + t * (b.radius - a.radius)};
}

// Is something true of all balls between two, looked at in steps of this length?
template <class Test>
bool all_balls(const Ball& a, const Ball& b, double step, const Test& test) {
    const int n = std::max(1, static_cast<int>(std::ceil(distance(a.center, b.center) / step)));
    for (int i = 0; i < n; ++i) {
        if (!test(between(a, b, (i + 0.5) / n))) {
            return false;
        }
    }
    return true;
}

// The same for all balls of a slab. Triangles are looked at in rows along their longest side: of needles there are few.
template <class Test>
bool all_balls(const Slab& slab, double step, const Test& test) {
    auto [a, b, c] = slab.corners;
    if (slab.size < 3) {
        return all_balls(a, b, step, test);
    }
    const double longest = longest_side(slab);
    while (distance(a.center, b.center) < longest) {
        std::tie(a, b, c) = std::tuple(b, c, a);
    }
    const double height = longest > 0.0 ? norm(cross(b.center - a.center, c.center - a.center)) / longest : 0.0;
    const int rows = std::max(1, static_cast<int>(std::ceil(height / step)));
    for (int row = 0; row < rows; ++row) {
        const double t = (row + 0.5) / rows;
        if (!all_balls(between(a, c, t), between(b, c, t), step, test)) {
            return false;
        }
    }
    return true;
}

// The same for those of its sides, too.
template <class Test>
bool all_balls_with_sides(const Slab& slab, double step, const Test& test) {
    const auto& [a, b, c] = slab.corners;
    return all_balls(slab, step, test) &&
           (slab.size < 3 ||
            (all_balls(a, b, step, test) && all_balls(b, c, step, test) && all_balls(c, a, step, test)));
}

class Collapser {
   public:
    Collapser(const MedialComplex& complex, const SimplifyOptions& options)
        : given_(slabs_of(complex)), tree_(build_slab_tree(given_)) {
        for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
            given_balls_.push_back({complex.vertices[v], complex.radii[v]});
            box_.extend(complex.vertices[v]);
        }
        for (const auto& [a, b] : complex.edges) {
            least_step_ += kLeastStep * distance(complex.vertices[a], complex.vertices[b]) /
                           static_cast<double>(complex.edges.size());
        }
        // Quadrics square offsets of planes: far from the origin nothing would be left of them.
        origin_ = midpoint(box_.min, box_.max);
        balls_ = given_balls_;
        stars_.resize(balls_.size());
        sheet_sizes_.resize(complex.sheets);
        for (const FaceTriangle& triangle : face_triangles(complex)) {
            add({triangle.corners, 3, complex.face_sheets[triangle.face], {}});
        }
        for (const auto& [a, b] : curve_edges(complex)) {
            add({{a, b, kNone}, 2, kNone, {}});
        }
        for (const Index v : isolated_vertices(complex)) {
            add({{v, kNone, kNone}, 1, kNone, {}});
        }
        count_ = static_cast<Index>(balls_.size());
        versions_.resize(balls_.size());
        for (std::size_t v = 0; v < balls_.size(); ++v) {
            simplices_[stars_[v].front()].witnesses.push_back(static_cast<Index>(v));
        }
        add_balls_between(step(options.error.value_or(0.0)));
        ranks_ = mapped<Rank>(static_cast<Index>(balls_.size()), [&](Index v) { return rank_of(v); });
        for (const Index v : options.anchors) {
            ranks_[v] = Rank::kCorner;
        }
        add_quadrics();
    }

    // From now on seams, borders and sheets may vanish where the error allows it; `anchors` stay.
    void release_classes(std::span<const Index> anchors) {
        keeps_classes_ = false;
        std::ranges::fill(ranks_, Rank::kInner);
        for (const Index v : anchors) {
            ranks_[v] = Rank::kCorner;
        }
    }

    Index count() const { return count_; }
    double diagonal() const { return box_.diagonal(); }

    // Collapses what keeps to an error, until there are only so many vertices. Returns how many collapses there were.
    Index collapse(double error, Index least_count) {
        std::priority_queue<Candidate> candidates;
        for (Index v = 0; v < static_cast<Index>(balls_.size()); ++v) {
            for (const Index w : neighbors(v)) {
                if (v < w) {
                    push(v, w, candidates);
                }
            }
        }
        CancellationPoint cancellation_point(16);
        const Index before = count_;
        while (!candidates.empty() && count_ > least_count) {
            cancellation_point();
            const Candidate next = candidates.top();
            candidates.pop();
            if (std::array{versions_[next.u], versions_[next.v]} != next.versions) {
                continue;
            }
            auto change = change_of(next.u, next.v);
            if (change && can_become(error, *change)) {
                apply(*change);
                for (const Index w : neighbors(change->kept)) {
                    push(change->kept, w, candidates);
                }
            }
        }
        return before - count_;
    }

    MedialComplex result() const {
        MedialComplex complex;
        std::vector<Index> numbers(balls_.size(), kNone);
        for (std::size_t v = 0; v < balls_.size(); ++v) {
            if (!stars_[v].empty()) {
                numbers[v] = add_vertex(complex, balls_[v], linear_vertex(balls_[v].radius));
            }
        }
        std::vector<std::array<Index, 2>> curves;
        for (const Simplex& simplex : simplices_) {
            std::array<Index, 3> corners{};
            for (int k = 0; k < simplex.size; ++k) {
                corners[k] = numbers[simplex.corners[k]];
            }
            if (simplex.size == 3) {
                complex.faces.push_back(corners);
                const auto shape = shape_of(slab_of(simplex));
                complex.face_angles.push_back(
                    shape ? angle_of_cosine(norm(shape->gradient)) * (180.0 / std::numbers::pi) : 0.0);
            } else if (simplex.size == 2) {
                curves.push_back({std::min(corners[0], corners[1]), std::max(corners[0], corners[1])});
            }
        }
        build_edges(complex, curves);
        label_sheets(complex);
        return complex;
    }

    // How far apart points are looked at.
    double step(double most) const { return std::max(most, least_step_); }

    const SlabTree& tree() const { return tree_; }
    const std::vector<Ball>& given_balls() const { return given_balls_; }

   private:
    // Balls inside simplices that are long beside what is looked at later: vertices alone would say too little of them.
    void add_balls_between(double spacing) {
        for (Simplex& simplex : simplices_) {
            const Slab slab = slab_of(simplex);
            if (simplex.size > 1 && longest_side(slab) > 2.0 * spacing) {
                all_balls(slab, spacing, [&](const Ball& ball) {
                    simplex.witnesses.push_back(static_cast<Index>(given_balls_.size()));
                    given_balls_.push_back(ball);
                    return true;
                });
            }
        }
    }

    void add(Simplex simplex) {
        for (int k = 0; k < simplex.size; ++k) {
            stars_[simplex.corners[k]].push_back(static_cast<Index>(simplices_.size()));
        }
        if (simplex.sheet != kNone) {
            ++sheet_sizes_[simplex.sheet];
        }
        simplices_.push_back(std::move(simplex));
    }

    Slab slab_of(const Simplex& simplex) const {
        std::array<Ball, 3> balls;
        for (int k = 0; k < simplex.size; ++k) {
            balls[k] = balls_[simplex.corners[k]];
        }
        return Slab(std::span(balls).first(simplex.size));
    }

    std::vector<Index> neighbors(Index v) const {
        std::vector<Index> result;
        for (const Index s : stars_[v]) {
            for (int k = 0; k < simplices_[s].size; ++k) {
                if (simplices_[s].corners[k] != v) {
                    result.push_back(simplices_[s].corners[k]);
                }
            }
        }
        sort_unique(result);
        return result;
    }

    // How many triangles there are at an edge; 0: it is one of a curve.
    Index triangles_at(Index u, Index v) const {
        return static_cast<Index>(
            std::ranges::count_if(stars_[u], [&](Index s) { return simplices_[s].size == 3 && simplices_[s].has(v); }));
    }

    Rank rank_of(Index v) const {
        Index features = 0;
        Index kind = kNone;  // of them: the number of their triangles
        bool is_same_kind = true;
        for (const Index w : neighbors(v)) {
            const Index triangles = triangles_at(v, w);
            if (triangles != 2) {
                ++features;
                is_same_kind = is_same_kind && (kind == kNone || kind == triangles);
                kind = triangles;
            }
        }
        if (!(features == 0 || (features == 2 && is_same_kind)) || stars_[v].empty()) {
            return Rank::kCorner;
        }
        const bool is_on_curve = kind == 0;
        if (is_on_curve) {
            return stars_[v].size() == 2 ? Rank::kAlong : Rank::kCorner;
        }
        // Sheets that touch only here?
        const std::vector<Index>& star = stars_[v];
        DisjointSets fans(static_cast<Index>(star.size()));
        Index count = static_cast<Index>(star.size());
        for (std::size_t i = 0; i < star.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                const Simplex& other = simplices_[star[k]];
                const bool is_adjacent = std::ranges::any_of(
                    simplices_[star[i]].corners, [&](Index corner) { return corner != v && other.has(corner); });
                if (is_adjacent && fans.find(static_cast<Index>(i)) != fans.find(static_cast<Index>(k))) {
                    fans.join(static_cast<Index>(i), static_cast<Index>(k));
                    --count;
                }
            }
        }
        return count > 1 ? Rank::kCorner : features == 0 ? Rank::kInner : Rank::kAlong;
    }

    Ball from_origin(const Ball& ball) const { return {ball.center - origin_, ball.radius}; }

    void add_quadrics() {
        quadrics_.resize(balls_.size());
        for (const Simplex& simplex : simplices_) {
            Slab slab = slab_of(simplex);
            for (Ball& ball : slab.corners) {
                ball = from_origin(ball);
            }
            if (simplex.size < 2) {
                continue;
            }
            const SlabQuadric quadric = quadric_of(slab);
            for (int k = 0; k < simplex.size; ++k) {
                quadrics_[simplex.corners[k]] += quadric;
            }
            for (int k = 0; simplex.size == 3 && k < 3; ++k) {
                const Index a = simplex.corners[k];
                const Index b = simplex.corners[(k + 1) % 3];
                if (triangles_at(a, b) == 1) {
                    const SlabQuadric border = border_quadric(slab);
                    quadrics_[a] += border;
                    quadrics_[b] += border;
                }
                std::rotate(slab.corners.begin(), slab.corners.begin() + 1, slab.corners.end());
            }
        }
    }

    // May these two become one, by what they are?
    bool may_collapse(Index u, Index v) const {
        const Rank lower = std::min(ranks_[u], ranks_[v]);
        return lower == Rank::kInner || (lower == Rank::kAlong && triangles_at(u, v) != 2);
    }

    // The ball that takes the place of two.
    Ball merged(Index u, Index v) const {
        if (ranks_[u] != ranks_[v]) {
            return balls_[ranks_[u] > ranks_[v] ? u : v];
        }
        const Ball& a = balls_[u];
        const Ball& b = balls_[v];
        for (const Ball& ball : {a, b}) {
            if (linear_vertex(ball.radius).kind == VertexKind::kSharpEdge) {
                return ball;  // exact
            }
        }
        SlabQuadric quadric = quadrics_[u];
        quadric += quadrics_[v];
        const Ball guess = from_origin({midpoint(a.center, b.center), 0.5 * (a.radius + b.radius)});
        const Ball best = quadric.least(guess);
        return {best.center + origin_, best.radius};
    }

    void push(Index u, Index v, std::priority_queue<Candidate>& candidates) const {
        if (may_collapse(u, v)) {
            SlabQuadric quadric = quadrics_[u];
            quadric += quadrics_[v];
            const double cost = quadric(from_origin(merged(u, v))) +
                                kPositionPull * quadric.weight * squared_distance(balls_[u].center, balls_[v].center);
            candidates.push(
                {cost, std::min(u, v), std::max(u, v), {versions_[std::min(u, v)], versions_[std::max(u, v)]}});
        }
    }

    // The link condition: what both links share is the link of the edge (T. Dey et al., "Topology preserving edge
    // contraction", 1999). Nothing if it fails, or if an edge would be left without its
    // faces, or a sheet vanish.
    std::optional<Change> change_of(Index u, Index v) const {
        Change change;
        std::tie(change.kept, change.removed) = ranks_[v] > ranks_[u] ? std::pair(v, u) : std::pair(u, v);
        std::vector<Index> between;  // the link of the edge
        for (const Index s : stars_[change.kept]) {
            (simplices_[s].has(change.removed) ? change.gone : change.changed).push_back(s);
        }
        for (const Index s : stars_[change.removed]) {
            if (!simplices_[s].has(change.kept)) {
                change.changed.push_back(s);
            }
        }
        for (const Index s : change.gone) {
            for (int k = 0; k < simplices_[s].size; ++k) {
                if (simplices_[s].corners[k] != u && simplices_[s].corners[k] != v) {
                    between.push_back(simplices_[s].corners[k]);
                }
            }
        }
        std::ranges::sort(between);
        std::vector<Index> shared;
        std::ranges::set_intersection(neighbors(u), neighbors(v), std::back_inserter(shared));
        if (shared != between) {
            return std::nullopt;
        }
        for (const Index x : between) {
            const bool is_left = std::ranges::any_of(change.changed, [&](Index s) { return simplices_[s].has(x); });
            if (!is_left) {
                return std::nullopt;
            }
        }
        for (const Index s : change.gone) {
            const auto is_of_same_sheet = [&](Index other) { return simplices_[other].sheet == simplices_[s].sheet; };
            if (keeps_classes_ && simplices_[s].sheet != kNone &&
                std::ranges::count_if(change.gone, is_of_same_sheet) == sheet_sizes_[simplices_[s].sheet]) {
                return std::nullopt;
            }
        }
        // An edge in both links, which that of the edge does not have.
        std::vector<std::array<Index, 2>> opposite;
        for (const Index s : change.changed) {
            if (simplices_[s].size == 3) {
                opposite.push_back(opposite_edge(simplices_[s], simplices_[s].has(u) ? u : v));
            }
        }
        std::ranges::sort(opposite);
        if (std::ranges::adjacent_find(opposite) != opposite.end()) {
            return std::nullopt;
        }
        return change;
    }

    // Can the two become one ball? That of least cost, or where it does not do one of both.
    bool can_become(double error, Change& change) {
        const Index u = std::min(change.kept, change.removed);
        const Index v = std::max(change.kept, change.removed);
        const auto keeps_to_with = [&](const Ball& ball) {
            put(ball, change);
            return keeps_to(error, change);
        };
        return keeps_to_with(merged(u, v)) ||
               (ranks_[u] == ranks_[v] && (keeps_to_with(balls_[u]) || keeps_to_with(balls_[v])));
    }

    void put(const Ball& ball, Change& change) const {
        change.ball = ball;
        change.slabs.clear();
        for (const Index s : change.changed) {
            change.slabs.push_back(slab_of(simplices_[s]));
            for (int k = 0; k < simplices_[s].size; ++k) {
                if (simplices_[s].corners[k] == change.kept || simplices_[s].corners[k] == change.removed) {
                    change.slabs.back().corners[k] = ball;
                }
            }
        }
    }

    static std::array<Index, 2> opposite_edge(const Simplex& triangle, Index v) {
        const auto& [a, b, c] = triangle.corners;
        const auto [x, y] = a == v ? std::pair(b, c) : b == v ? std::pair(a, c) : std::pair(a, b);
        return {std::min(x, y), std::max(x, y)};
    }

    bool keeps_to(double error, const Change& change) {
        return !folds(change) && covers_given(error, change) && is_within_given(error, change);
    }

    // Does a triangle turn over, or become a needle?
    bool folds(const Change& change) const {
        for (std::size_t i = 0; i < change.changed.size(); ++i) {
            if (change.slabs[i].size < 3) {
                continue;
            }
            const Slab before = slab_of(simplices_[change.changed[i]]);
            const auto area_and_longest = [](const Slab& slab) {
                const auto& [a, b, c] = slab.corners;
                return std::pair(cross(b.center - a.center, c.center - a.center),
                                 std::max({squared_distance(a.center, b.center), squared_distance(b.center, c.center),
                                           squared_distance(c.center, a.center)}));
            };
            const auto [old_normal, old_square] = area_and_longest(before);
            const auto [new_normal, new_square] = area_and_longest(change.slabs[i]);
            const double old_area = norm(old_normal);
            const double new_area = norm(new_normal);
            const bool was_thin = old_area < kLeastSine * old_square;
            if (!was_thin && (new_area < kLeastSine * new_square ||
                              dot(old_normal, new_normal) < kLeastTurn * old_area * new_area)) {
                return true;
            }
            if (was_thin && new_area * old_square < 0.5 * old_area * new_square) {
                return true;
            }
        }
        return false;
    }

    // Does every given ball that the simplices stand for stay within the error of what they become? Remembers of which:
    // its own if that does, or else the nearest.
    bool covers_given(double error, const Change& change) {
        assigned_.clear();
        const auto assign = [&](Index given, std::size_t own) {
            const Ball& ball = given_balls_[given];
            double least = nearest_ball(change.slabs[own], ball.center).distance;
            std::size_t best = own;
            for (std::size_t i = 0; i < change.slabs.size() && least + ball.radius > error; ++i) {
                if (is_farther(change.slabs[i], ball.center, least)) {
                    continue;
                }
                const double beyond = nearest_ball(change.slabs[i], ball.center).distance;
                if (beyond < least) {
                    least = beyond;
                    best = i;
                }
            }
            assigned_.push_back({given, change.changed[best]});
            return least + ball.radius <= error;
        };
        const auto assign_all = [&](Index simplex, std::size_t own) {
            return std::ranges::all_of(simplices_[simplex].witnesses, [&](Index given) { return assign(given, own); });
        };
        bool are_covered = !change.slabs.empty();
        for (std::size_t i = 0; i < change.changed.size() && are_covered; ++i) {
            are_covered = assign_all(change.changed[i], i);
        }
        return are_covered && std::ranges::all_of(change.gone, [&](Index simplex) { return assign_all(simplex, 0); });
    }

    // Do the new balls stay within the error of the given envelope?
    bool is_within_given(double error, const Change& change) const {
        const auto is_within = [&](const Ball& ball) {
            return slab_within(tree_, ball.center, error - ball.radius, 0.5 * error) != nullptr;
        };
        const auto are_within = [&](const Slab& slab) { return all_balls(slab, step(error), is_within); };
        const auto is_spoke_within = [&](Index v) { return all_balls(change.ball, balls_[v], step(error), is_within); };
        return is_within(change.ball) && std::ranges::all_of(change.slabs, are_within) &&
               std::ranges::all_of(ends_of_spokes(change), is_spoke_within);
    }

    // The vertices that a change leaves sides of triangles to.
    std::vector<Index> ends_of_spokes(const Change& change) const {
        std::vector<Index> ends;
        for (const Index s : change.changed) {
            for (int k = 0; simplices_[s].size == 3 && k < 3; ++k) {
                const Index v = simplices_[s].corners[k];
                if (v != change.kept && v != change.removed) {
                    ends.push_back(v);
                }
            }
        }
        sort_unique(ends);
        return ends;
    }

    void apply(const Change& change) {
        const auto& [kept, removed, ball, gone, changed, slabs] = change;
        for (const Index s : gone) {
            if (simplices_[s].sheet != kNone) {
                --sheet_sizes_[simplices_[s].sheet];
            }
            for (int k = 0; k < simplices_[s].size; ++k) {
                std::erase(stars_[simplices_[s].corners[k]], s);
            }
            simplices_[s] = {};
        }
        for (const Index s : changed) {
            simplices_[s].witnesses.clear();
            std::ranges::replace(simplices_[s].corners, removed, kept);
        }
        for (const auto& [given, simplex] : assigned_) {
            simplices_[simplex].witnesses.push_back(given);
        }
        append(stars_[kept], stars_[removed]);
        stars_[removed].clear();
        balls_[kept] = ball;
        quadrics_[kept] += quadrics_[removed];
        ++versions_[kept];
        ++versions_[removed];
        --count_;
    }

    std::vector<Slab> given_;
    SlabTree tree_;
    std::vector<Ball> given_balls_;
    Box box_;
    Point origin_;
    std::vector<Ball> balls_;
    std::vector<SlabQuadric> quadrics_;
    std::vector<Rank> ranks_;
    std::vector<Index> versions_;
    std::vector<Simplex> simplices_;
    std::vector<std::vector<Index>> stars_;  // the simplices at each vertex
    std::vector<Index> sheet_sizes_;
    std::vector<std::array<Index, 2>> assigned_;  // given balls and simplices, by the last change looked at
    Index count_ = 0;
    double least_step_ = 0.0;
    bool keeps_classes_ = true;
};

void validate(const MedialComplex& complex, const SimplifyOptions& options) {
    require(options.error || options.vertices, "simplification needs an error, or a number of vertices");
    require(!options.error || (*options.error > 0.0 && std::isfinite(*options.error)),
            "the error of simplification must be a positive length");
    require(!options.error || complex.vertices.empty() || *options.error <= box_of_balls(complex).diagonal(),
            "the error of simplification must be at most the diagonal of the box around the balls");
    require(!options.vertices || *options.vertices >= 1, "the number of vertices must be at least 1");
    for (const Index v : options.anchors) {
        if (v < 0 || static_cast<std::size_t>(v) >= complex.vertices.size()) {
            throw InvalidOption("anchor " + std::to_string(v) + " is no vertex: there are " +
                                std::to_string(complex.vertices.size()));
        }
    }
}

MedialComplex linear_complex(const MedialComplex& complex, const SimplifyOptions& options) {
    const Box box = box_around(complex.vertices);
    const double error = options.error.value_or(kSmallLength * box.diagonal());
    return linearized(complex, std::max(kLeastDip * error, std::numeric_limits<double>::min()));
}

double collapse(Collapser& collapser, const SimplifyOptions& options, const Execution& execution) {
    const Index least_count = options.vertices.value_or(0);
    const double diagonal = collapser.diagonal();
    if (options.error) {
        for (const double part : kErrorSteps) {
            collapser.collapse(part * *options.error, least_count);
            report(execution, kSimplificationStage, 0.1 + 0.8 * part);
        }
        return *options.error;
    }
    double error = kSmallLength * diagonal;
    for (; collapser.count() > least_count && error < diagonal; error *= kErrorGrowth) {
        if (error > kClassError * diagonal) {
            collapser.release_classes(options.anchors);
        }
        collapser.collapse(error, least_count);
    }
    return error;
}

// The largest of `value(i)` for `0 ≤ i < count`, in parallel.
template <class Value>
double largest(std::size_t count, const Value& value) {
    const auto values = mapped<double>(
        count, [&](std::size_t i) { return value(i); }, std::size_t{16});
    return values.empty() ? 0.0 : std::max(0.0, *std::ranges::max_element(values));
}

SimplifyStatistics compared(const Collapser& collapser, const MedialComplex& complex, const MedialComplex& result,
                            double error) {
    SimplifyStatistics statistics;
    statistics.error = error;
    statistics.vertices_before = static_cast<Index>(complex.vertices.size());
    statistics.vertices_after = static_cast<Index>(result.vertices.size());
    statistics.triangles = static_cast<Index>(result.faces.size());
    statistics.curve_edges = static_cast<Index>(curve_edges(result).size());
    const std::vector<Slab> slabs = slabs_of(result);
    const SlabTree tree = build_slab_tree(slabs);
    statistics.largest_gap = largest(collapser.given_balls().size(), [&](std::size_t v) {
        const Ball& ball = collapser.given_balls()[v];
        return nearest_slab(tree, ball.center).near.distance + ball.radius;
    });
    statistics.largest_protrusion = largest(slabs.size(), [&](std::size_t i) {
        double most = 0.0;
        all_balls_with_sides(slabs[i], collapser.step(error), [&](const Ball& ball) {
            most = std::max(most, nearest_slab(collapser.tree(), ball.center).near.distance + ball.radius);
            return true;
        });
        return most;
    });
    statistics.topology = topology_of(result);
    return statistics;
}

}  // namespace

SimplifyStatistics compared(const MedialComplex& complex, const MedialComplex& simplified,
                            const SimplifyOptions& options, const Execution& execution) {
    return in_arena(execution, [&] {
        const Collapser collapser(linear_complex(complex, options), options);
        return compared(collapser, complex, simplified, *options.error);
    });
}

SimplifiedComplex simplify(const MedialComplex& complex, const SimplifyOptions& options, const Execution& execution) {
    return in_arena(execution, [&] {
        check(complex);
        validate(complex, options);
        if (complex.vertices.empty()) {
            throw UnusableInput(Diagnostic{"complex.empty", "the axis has no vertices: there is nothing to simplify"});
        }
        report(execution, kSimplificationStage, 0.0);
        Collapser collapser(linear_complex(complex, options), options);
        report(execution, kSimplificationStage, 0.1);
        SimplifiedComplex simplified;
        SimplifyStatistics& statistics = simplified.statistics;
        statistics.error = collapse(collapser, options, execution);
        simplified.complex = collapser.result();
        simplified.complex.scale = complex.scale;
        report(execution, kSimplificationStage, 0.9);

        statistics = compared(collapser, complex, simplified.complex, statistics.error);
        report(execution, kSimplificationStage, 1.0);
        return simplified;
    });
}

}  // namespace scaleaxis::inline v1
