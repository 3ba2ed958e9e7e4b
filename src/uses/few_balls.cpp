// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/few_balls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/fit.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/point_tree.hpp"
#include "spatial/poisson_disk.hpp"
#include "uses/clipped_solid.hpp"
#include "uses/placement.hpp"
#include "uses/set_cover.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Of the spacing at which points are looked at while the balls are placed: that of those that they cover in the end.
constexpr double kCheckedPart = 0.6;

// More balls than this are not searched for as thoroughly.
constexpr std::size_t kFewSearched = 100;

// So often are balls changed in the end to keep to an error, and then so many are added.
constexpr int kMostChanged = 6;
constexpr int kMostAdded = 60;

void check(std::span<const Ball> candidates, std::span<const Point> points, const Solid& solid,
           const FewBallsOptions& options) {
    require(options.count || options.error, "the number of balls or the error is needed");
    require(!options.count || !options.error || options.kind != FewBallsKind::kInside,
            "balls inside stick out nowhere: their number or the error is needed, and not both");
    require(!options.count || *options.count >= 1, "the number of balls must be at least 1");
    require(!options.error || (*options.error > 0.0 && std::isfinite(*options.error)),
            "the error must be a positive number");
    require(options.search_size >= 100, "the search needs at least 100 points");
    require(options.effort > 0.0 && options.effort <= 1e6, "the effort must be positive, and at most 1e6");
    for (const auto& [normal, offset] : options.clip) {
        require(norm(normal) > 0.0 && std::isfinite(norm(normal)) && std::isfinite(offset),
                "a plane that balls must not reach through needs a normal other than 0, and an offset");
    }
    check_balls(candidates);
    if (candidates.empty() || points.empty()) {
        throw UnusableInput("there are no candidates, or no points of the surface, to choose balls by");
    }
    check_knows_nearest(solid);
}

// So many of the points, about, at most, that are as far from each other as such a number allows.
std::vector<Point> thinned(const std::vector<Point>& points, Index most, double diagonal) {
    std::vector<Point> fewer = points;
    double spacing = diagonal / std::sqrt(static_cast<double>(most)) / 4.0;
    while (static_cast<Index>(fewer.size()) > most) {
        fewer = poisson_disk_subset(points, spacing, 1);
        spacing *= std::clamp(std::sqrt(static_cast<double>(fewer.size()) / most), 1.03, 2.0);
    }
    return fewer;
}

// Candidates, the largest first, without those whose centres are close to that of a larger one.
std::vector<Ball> thinned(std::span<const Ball> candidates, Index most, double diagonal) {
    std::vector<Ball> order(candidates.begin(), candidates.end());
    std::ranges::stable_sort(order, std::greater<>(), &Ball::radius);
    if (static_cast<Index>(order.size()) <= most) {
        return order;
    }
    const auto centers = each_of<Point>(order, &Ball::center);
    const PointTree tree = build_point_tree(centers);
    std::vector<Ball> fewer;
    double spacing = diagonal / std::sqrt(static_cast<double>(most)) / 8.0;
    do {
        stop_if_cancelled();
        fewer.clear();
        std::vector<char> is_close(order.size(), 0);
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (is_close[i] == 0) {
                fewer.push_back(order[i]);
                for_each_point_near(tree, centers[i], spacing,
                                    [&](Index position, double) { is_close[tree.order[position]] = 1; });
            }
        }
        spacing *= std::clamp(std::sqrt(static_cast<double>(fewer.size()) / most), 1.05, 2.0);
    } while (static_cast<Index>(fewer.size()) > most);
    return fewer;
}

// The points that the search looks at, and those that are no farther from each candidate than its radius and an error.
struct SubsetSearch {
    std::vector<Ball> candidates;
    std::vector<Ball> moved;  // candidates too: the balls that were settled last, off the axis mostly
    std::vector<Point> points;
    PointTree tree;
    double effort = 1.0;
};

SetSystem covered(const SubsetSearch& search, double error) {
    std::vector<std::vector<Index>> lists(search.candidates.size());
    for_each_index(
        lists.size(),
        [&](std::size_t k) {
            const auto& [center, radius] = search.candidates[k];
            for_each_point_near(search.tree, center, radius + error,
                                [&](Index position, double) { lists[k].push_back(position); });
        },
        std::size_t{32});
    SetSystem system;
    system.elements = static_cast<Index>(search.points.size());
    for (const std::vector<Index>& list : lists) {
        system.sets.push_back(list);
    }
    return system;
}

struct Greedy {
    std::vector<Ball> balls;
    double error = 0.0;
};

std::vector<Ball> chosen(const SubsetSearch& search, const std::vector<Index>& cover) {
    return each_of<Ball>(cover, [&](Index k) { return search.candidates[k]; });
}

// The least error for which greedy set cover takes no more than so many balls.
Greedy greedy_by_count(const SubsetSearch& search, Index count, double diagonal) {
    constexpr double kPrecision = 0.01;
    double low = 0.0;
    double high = 0.002 * diagonal;
    std::optional<std::vector<Index>> best;
    while (!(best = greedy_cover(covered(search, high), count))) {
        low = std::exchange(high, 1.5 * high);
    }
    while (high - low > kPrecision * high && high > kRelativeRounding * diagonal) {
        const double middle = 0.5 * (low + high);
        if (auto cover = greedy_cover(covered(search, middle), count)) {
            best = std::move(cover);
            high = middle;
        } else {
            low = middle;
        }
    }
    std::vector<Ball> balls = chosen(search, *best);
    const double error = std::max(0.0, placed(balls, search.points).error);
    return {std::move(balls), error};
}

// As many candidates as it takes.
Greedy greedy_by_error(const SubsetSearch& search, double error, double diagonal) {
    const auto all = static_cast<Index>(search.candidates.size());
    const double least = std::max(0.0, placed(search.candidates, search.points).error);
    if (error < least + kRelativeRounding * diagonal) {
        throw InvalidOption("the error of " + to_text(error) + " is too small: all " + std::to_string(all) +
                            " balls that the search looks at leave " + to_text(least) +
                            "; take a larger error, or all balls of the solid, of which there are more the smaller "
                            "delta is");
    }
    return {chosen(search, greedy_cover(covered(search, error), all).value()), error};
}

// As many balls as there are, within a smaller error of the points of the search if that is found: candidates and the
// balls as they are, chosen by local search, then settled.
std::optional<Placement> within(const Placement& placement, SubsetSearch& search, const Solid& solid, double error) {
    constexpr double kWork = 3e7;  // less than a tenth of a second
    SubsetSearch wider = search;
    append(wider.candidates, search.moved);
    append(wider.candidates, placement.balls);
    std::vector<Index> start(placement.balls.size());
    std::iota(start.begin(), start.end(), static_cast<Index>(wider.candidates.size() - placement.balls.size()));
    const auto cover = cover_of_size(covered(wider, error), start, static_cast<std::int64_t>(kWork * search.effort));
    if (!cover) {
        return std::nullopt;
    }
    const std::vector<char> everywhere(cover->size(), 1);
    Placement next = settled(placed(chosen(wider, *cover), search.points), search.points, solid, everywhere,
                             cover->size() <= kFewSearched ? 30 : 12);
    append(search.moved, next.balls);
    if (search.moved.size() > search.candidates.size()) {
        search.moved.erase(search.moved.begin(),
                           search.moved.begin() + static_cast<std::ptrdiff_t>(search.moved.size() / 2));
    }
    return next;
}

// How often the balls are all placed anew, at most: where there are many, each time takes long and gains little.
int most_trials(std::size_t balls) { return static_cast<int>(std::clamp<std::size_t>(1500 / balls, 3, 60)); }

// The error becomes smaller as long as that is found, and it is larger than the goal.
Placement with_least_error(Placement placement, SubsetSearch& search, const Solid& solid, double goal) {
    int trials = most_trials(placement.balls.size());
    for (const double part : {0.95, 0.98, 0.99}) {
        while (placement.error > goal && trials-- > 0) {
            std::optional<Placement> next = within(placement, search, solid, std::max(goal, part * placement.error));
            if (!next) {
                break;
            }
            placement = std::move(*next);
        }
    }
    return improved(std::move(placement), search.points, search.candidates, solid, goal);
}

// So many balls fewer within the error, if that is found. \param skipped of those that are missed least, these stay
std::optional<Placement> with_fewer(const Placement& placement, SubsetSearch& search, const Solid& solid, double error,
                                    std::size_t fewer, std::size_t skipped) {
    const std::vector<Index> order = by_need(placement);
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(skipped);
    std::vector<Index> gone(first, first + static_cast<std::ptrdiff_t>(fewer));
    std::ranges::sort(gone, std::greater<>());
    std::vector<Ball> balls = placement.balls;
    std::ranges::for_each(gone, [&](Index k) { balls.erase(balls.begin() + k); });
    Placement next = placed(std::move(balls), search.points);
    if (std::optional<Placement> better = within(next, search, solid, error)) {
        return better;
    }
    if (fewer == 1) {
        next = with_least_error(std::move(next), search, solid, error);
    }
    return next.error <= error ? std::optional(std::move(next)) : std::nullopt;
}

// Balls go as long as the error can be kept without them, several at once where there are many, and not too often.
Placement with_fewest(Placement placement, SubsetSearch& search, const Solid& solid, double error) {
    const auto tries = static_cast<std::size_t>(std::clamp(2.0 * search.effort, 1.0, 6.0));
    std::size_t skipped = 0;
    int trials =
        placement.balls.size() > kFewSearched ? most_trials(placement.balls.size()) : std::numeric_limits<int>::max();
    for (std::size_t fewer = 1 + placement.balls.size() / kFewSearched * 4;
         trials-- > 0 && fewer > 0 && placement.balls.size() > fewer + skipped;) {
        if (std::optional<Placement> next = with_fewer(placement, search, solid, error, fewer, skipped)) {
            placement = std::move(*next);
            skipped = 0;
        } else if (fewer > 1) {
            fewer /= 2;
        } else if (++skipped == tries || placement.balls.size() > kFewSearched) {
            break;
        }
    }
    return placement;
}

// Adds points that are farther from the balls than the search knows, the farthest ones first, none close to another.
// Returns whether there are any.
bool extend(SubsetSearch& search, const Placement& placement, std::span<const Point> all, double known,
            double spacing) {
    const Placement there = placed(placement.balls, all);
    auto missed = indices_where(all.size(), [&](Index i) { return there.distances[i] > known; });
    std::ranges::stable_sort(missed, std::greater<>(), [&](Index i) { return there.distances[i]; });
    const std::size_t before = search.points.size();
    for (const Index i : missed) {
        stop_if_cancelled();
        if (std::none_of(search.points.begin() + static_cast<std::ptrdiff_t>(before), search.points.end(),
                         [&](const Point& p) { return squared_distance(p, all[i]) < spacing * spacing; })) {
            search.points.push_back(all[i]);
        }
    }
    search.tree = build_point_tree(search.points);
    return !missed.empty();
}

Placement settled_everywhere(Placement placement, const SubsetSearch& search, const Solid& solid) {
    constexpr int kRounds = 10;
    const std::vector<char> everywhere(placement.balls.size(), 1);
    return settled(std::move(placement), search.points, solid, everywhere, kRounds);
}

// Balls change, or are added if that does not help, until the points of the search are within the error.
Placement completed(Placement placement, SubsetSearch& search, const Solid& solid, double error) {
    while (placement.error > error && placement.balls.size() < search.candidates.size()) {
        // Some less leaves room for points that the search does not see.
        for (const double part : {0.98, 0.99, 1.0}) {
            if (std::optional<Placement> better = within(placement, search, solid, part * error)) {
                return std::move(*better);
            }
        }
        // One at a time, or several where there are many.
        for (std::size_t more = 1 + placement.balls.size() / kFewSearched; more > 0 && placement.error > error;
             --more) {
            placement = placed(with_one_more(placement, search.points, search.candidates), search.points);
        }
        placement = settled_everywhere(std::move(placement), search, solid);
    }
    return placement;
}

// The smallest ball around two.
Ball around(const Ball& a, const Ball& b) {
    const double apart = distance(a.center, b.center);
    if (apart + b.radius <= a.radius) {
        return a;
    }
    if (apart + a.radius <= b.radius) {
        return b;
    }
    const double radius = 0.5 * (apart + a.radius + b.radius);
    return {a.center + (radius - a.radius) / apart * (b.center - a.center), radius};
}

double reach(const Point& from, const Ball& ball) { return distance(from, ball.center) + ball.radius; }

const Ball& farthest(std::span<const Ball> balls, const Point& from) {
    return *std::ranges::max_element(balls, {}, [&](const Ball& ball) { return reach(from, ball); });
}

// The centre moves towards the ball that it reaches last, by less and less (M. Bădoiu, K. Clarkson, "Smaller core-sets
// for balls", 2003): after so many steps the radius is too large by less than a few of their inverses.
Ball around_few(std::span<const Ball> balls, int steps) {
    Ball best{balls.front().center, kInfinity};
    Point center = best.center;
    for (int i = 1; i <= steps; ++i) {
        const Ball& far = farthest(balls, center);
        const double radius = reach(center, far);
        if (radius < best.radius) {
            best = {center, radius};
        }
        const double apart = distance(center, far.center);
        if (apart == 0.0) {
            break;
        }
        // Towards the farthest point of that ball.
        center = center + (apart + far.radius) / (apart * (i + 1)) * (far.center - center);
    }
    return best;
}

// The ball around a few holds nearly all: the one that sticks out of it most joins these, until it does so by no more
// than the steps miss.
Ball around(std::span<const Ball> balls, int steps) {
    std::vector<Ball> few{balls.front()};
    while (true) {
        Ball result = around_few(few, steps);
        const Ball& far = farthest(balls, result.center);
        if (reach(result.center, far) <= (1.0 + 1.0 / steps) * result.radius ||
            std::ranges::find(few, far) != few.end()) {
            result.radius = reach(result.center, far);
            return result;
        }
        few.push_back(far);
    }
}

// What covering balls must not exceed.
struct Limits {
    std::span<const HalfSpace> clip;
    double error = kInfinity;
    std::span<const Point> beside = {};  // the planes: covered as far as that costs nothing

    bool are_any() const { return !clip.empty() || error < kInfinity; }
    double radius(const Ball& inscribed) const {
        return std::min(inscribed.radius + error, clearance(clip, inscribed.center));
    }
};

// The ball that reaches a point within its limit and sticks out least for it; none: `kNone`.
Index reaching(const Placement& placement, const Limits& limits, const Point& p) {
    Index best = kNone;
    double least = kInfinity;
    for (std::size_t k = 0; k < placement.balls.size(); ++k) {
        const double away = distance(p, placement.balls[k].center);
        if (away <= limits.radius(placement.balls[k]) && away - placement.balls[k].radius < least) {
            least = away - placement.balls[k].radius;
            best = static_cast<Index>(k);
        }
    }
    return best;
}

// Smallest radii around the centres that cover the points within reach: first by nearest centre; then, worst protrusion
// first, only for points that no other ball covers.
std::vector<Ball> covering(const Placement& placement, std::span<const Point> points, const Limits& limits,
                           double rounding) {
    std::vector<double> radii(placement.balls.size(), 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Index k = limits.are_any() ? reaching(placement, limits, points[i]) : placement.nearest[i];
        if (k != kNone) {
            radii[k] = std::max(radii[k], distance(points[i], placement.balls[k].center) + rounding);
        }
    }
    std::vector<Index> times(points.size(), 0);
    std::vector<std::vector<Index>> inside(radii.size());
    for_each_index(
        radii.size(),
        [&](std::size_t k) {
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (squared_distance(points[i], placement.balls[k].center) <= radii[k] * radii[k]) {
                    inside[k].push_back(static_cast<Index>(i));
                }
            }
        },
        std::size_t{1});
    for (const auto& list : inside) {
        std::ranges::for_each(list, [&](Index i) { ++times[i]; });
    }
    const auto order = sorted_indices(
        radii.size(), [&](Index k) { return radii[k] - placement.balls[k].radius; }, std::greater<>());
    for (const Index k : order) {
        double needed = 0.0;
        for (const Index i : inside[k]) {
            if (times[i] == 1) {
                needed = std::max(needed, distance(points[i], placement.balls[k].center) + rounding);
            }
        }
        // The inscribed ball sticks out nowhere.
        radii[k] = std::min(radii[k], std::max(needed, placement.balls[k].radius));
        for (const Index i : inside[k]) {
            times[i] -= squared_distance(points[i], placement.balls[k].center) > radii[k] * radii[k] ? 1 : 0;
        }
    }
    std::vector<Ball> balls;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        balls.push_back({placement.balls[k].center, std::max(radii[k], placement.balls[k].radius)});
    }
    return balls;
}

// Covering balls around the smallest balls of the points that no other covers, one after the other, the one that sticks
// out most first: they become smaller, and stick out no farther than `error`. \param placement gets their inscribed
// balls
std::vector<Ball> tightened(std::vector<Ball> balls, Placement& placement, std::span<const Point> points,
                            const Solid& solid, const Limits& limits, double rounding, double error) {
    constexpr int kRounds = 3;    // a fourth gains less than a thousandth
    constexpr int kSteps = 1000;  // the ball is off by a thousandth, and is taken if it is smaller than the last one
    const PointTree tree = build_point_tree(points);
    std::vector<Index> times(points.size(), 0);  // in the order of the tree
    const auto count = [&](const Ball& ball, Index sign) {
        for_each_point_near(tree, ball.center, ball.radius, [&](Index i, double) { times[i] += sign; });
    };
    std::ranges::for_each(balls, [&](const Ball& ball) { count(ball, 1); });
    std::vector<Index> order(balls.size());
    std::iota(order.begin(), order.end(), 0);
    for (int round = 0; round < kRounds; ++round) {
        std::ranges::stable_sort(order, std::greater<>(),
                                 [&](Index k) { return balls[k].radius - placement.balls[k].radius; });
        for (const Index k : order) {
            stop_if_cancelled();
            std::vector<Ball> needed;
            for_each_point_near(tree, balls[k].center, balls[k].radius, [&](Index i, double) {
                if (times[i] == 1) {
                    needed.push_back({tree.points[i], 0.0});
                }
            });
            if (needed.empty()) {
                continue;
            }
            Ball smaller = around(needed, kSteps);
            smaller.radius += rounding;
            const Ball inscribed = inscribed_ball(solid, smaller.center);
            if (smaller.radius >= balls[k].radius || smaller.radius - inscribed.radius > error ||
                smaller.radius > limits.radius(inscribed) || !solid.inside(smaller.center)) {
                continue;
            }
            count(smaller, 1);
            count(balls[k], -1);
            balls[k] = smaller;
            placement.balls[k] = inscribed;
        }
    }
    return balls;
}

// From a point outside the union of balls uphill, away from the ball that is nearest, to about where it is farthest
// from all of them in the solid.
Point farther_off(Point p, const BallTree& tree, const std::vector<Ball>& balls, const Solid& solid) {
    constexpr int kSteps = 60;
    double step = 0.1 * balls[nearest_ball(tree, p).ball].radius;
    for (int i = 0; i < kSteps; ++i) {
        const NearestBall nearest = nearest_ball(tree, p);
        const Point next = p + step * unit(p - balls[nearest.ball].center);
        if (nearest_ball(tree, next).distance > nearest.distance && solid.inside(next)) {
            p = next;
        } else {
            step *= 0.7;
        }
    }
    return p;
}

// A part of the solid inside that the balls do not cover, though they cover the surface, is one of a cavity of their
// union. That ends at vertices of its boundary.
std::vector<Point> uncovered_points(const std::vector<Ball>& balls, const Solid& solid, double rounding) {
    const std::vector<Point> vertices = BallUnion(balls).boundary_vertices().points;
    std::vector<std::uint8_t> sides(vertices.size());
    solid.inside(vertices, sides);
    const BallTree tree = build_ball_tree(balls);
    std::vector<Point> uncovered;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (sides[i] != 0 && !solid.nearest(vertices[i], 100.0 * rounding)) {
            const Point middle = farther_off(vertices[i], tree, balls, solid);
            if (nearest_ball(tree, middle).distance > 100.0 * rounding) {
                uncovered.insert(uncovered.end(), {vertices[i], midpoint(vertices[i], middle), middle});
            }
        }
    }
    return uncovered;
}

// Covering balls around the centres; adds the points inside the solid that they were made to cover to those given.
FewBalls covering_solid(const Placement& placement, std::vector<Point>& points, const Solid& solid, Limits limits,
                        double rounding) {
    if (!limits.clip.empty()) {
        limits.error = std::min(limits.error, placed(placement.balls, points).error + rounding);
        points.insert(points.end(), limits.beside.begin(), limits.beside.end());
    }
    constexpr int kSmallest = 2;
    constexpr int kMaxRounds = 7;
    FewBalls result;
    std::vector<Point> missed;
    for (int round = 0; round < kMaxRounds; ++round) {
        if (round < kSmallest) {
            result.balls = covering(placed(placement.balls, points), points, limits, rounding);
        } else {
            // Where balls that are as small as they can be leave cavities again and again, they are as large as the
            // others.
            const double error = placed(placement.balls, points).error + rounding;
            for (const Index k : placed(placement.balls, missed).nearest) {
                result.balls[k].radius = std::max(result.balls[k].radius, placement.balls[k].radius + error);
            }
        }
        missed = uncovered_points(result.balls, solid, rounding);
        if (limits.are_any()) {
            std::erase_if(missed, [&](const Point& p) { return reaching(placement, limits, p) == kNone; });
        }
        if (missed.empty()) {
            break;
        }
        append(points, missed);
    }
    if (!missed.empty()) {
        // What is left is small, and gone when all balls grow by as much as it is deep.
        const double gap = std::max(0.0, placed(result.balls, missed).error) + rounding;
        std::ranges::for_each(result.balls, [&](Ball& ball) { ball.radius += gap; });
    }
    const auto error_of = [&](const std::vector<Ball>& balls, const std::vector<Ball>& inscribed) {
        double error = 0.0;
        for (std::size_t k = 0; k < balls.size(); ++k) {
            error = std::max(error, balls[k].radius - inscribed[k].radius);
        }
        return error;
    };
    for (std::size_t k = 0; k < result.balls.size(); ++k) {
        result.balls[k].radius = std::min(result.balls[k].radius, limits.radius(placement.balls[k]));
    }
    result.statistics.error = error_of(result.balls, placement.balls);
    if (missed.empty()) {
        Placement moved = placement;
        std::vector<Ball> smaller =
            tightened(result.balls, moved, points, solid, limits, rounding, result.statistics.error);
        missed = uncovered_points(smaller, solid, rounding);
        std::erase_if(missed, [&](const Point& p) { return reaching(moved, limits, p) == kNone; });
        if (missed.empty()) {
            result.balls = std::move(smaller);
            result.statistics.error = error_of(result.balls, moved.balls);
        }
    }
    return result;
}

// The balls around the centres. \param points that they are for; those inside that covering balls are enlarged for are
// added
FewBalls finished(const Placement& placement, std::vector<Point>& points, const Solid& solid, FewBallsKind kind,
                  const Limits& limits, double rounding) {
    if (kind == FewBallsKind::kCover) {
        return covering_solid(placement, points, solid, limits, rounding);
    }
    FewBalls result{placement.balls, {}};
    result.statistics.error = std::max(0.0, placed(placement.balls, points).error);
    return result;
}

FewBalls greedy_only(const Greedy& greedy, const SubsetSearch& search, FewBallsKind kind) {
    FewBalls result{greedy.balls, {}};
    if (kind == FewBallsKind::kCover) {
        std::ranges::for_each(result.balls, [&](Ball& ball) { ball.radius += greedy.error; });
    }
    result.statistics.error = result.statistics.greedy_error = greedy.error;
    result.statistics.greedy_count = static_cast<Index>(greedy.balls.size());
    result.statistics.candidates = static_cast<Index>(search.candidates.size());
    result.statistics.search_points = result.statistics.checked_points = static_cast<Index>(search.points.size());
    return result;
}

// The search sees few of all points: it is done again with those that turned out to be farther off than it knew, in the
// end only settled. \param error that is not to be exceeded; unset: as small as possible
Placement found(const std::vector<Ball>& start, SubsetSearch& search, std::span<const Point> all, const Solid& solid,
                std::optional<double> error, double spacing, const Execution& execution) {
    const int searches = start.size() > kFewSearched ? 2 : error ? 4 : 8;
    const int rounds = start.size() <= kFewSearched ? 20 : 8;
    const double rounding = kRelativeRounding * solid.bounds().diagonal();
    Placement placement = placed(start, search.points);
    for (int round = 0; round < rounds; ++round) {
        report(execution, "few balls", 0.1 + 0.7 * std::min(1.0, static_cast<double>(round) / searches));
        if (round >= searches) {
            placement = settled_everywhere(std::move(placement), search, solid);
        } else if (!error) {
            placement = with_least_error(std::move(placement), search, solid, rounding);
        }
        if (error) {
            placement = completed(std::move(placement), search, solid, *error);
            if (round < searches) {
                placement = with_fewest(std::move(placement), search, solid, *error);
            }
        }
        if (!extend(search, placement, all, error.value_or(placement.error) + rounding, spacing)) {
            break;
        }
        placement = placed(std::move(placement.balls), search.points);
    }
    return placement;
}

FewBalls search_and_finish(std::span<const Ball> candidates, std::span<const Point> points, const Solid& solid,
                           const FewBallsOptions& options, std::span<const Point> beside, const Execution& execution) {
    const double diagonal = solid.bounds().diagonal();
    const double rounding = kRelativeRounding * diagonal;
    report(execution, "few balls", 0.0);
    SubsetSearch search;
    search.candidates = thinned(candidates, options.search_size, diagonal);
    search.points = thinned({points.begin(), points.end()}, options.search_size, diagonal);
    search.tree = build_point_tree(search.points);
    search.effort = options.effort;
    const SubsetSearch first = search;
    const Greedy greedy = options.count ? greedy_by_count(search, *options.count, diagonal)
                                        : greedy_by_error(search, *options.error, diagonal);
    if (!options.improves) {
        return greedy_only(greedy, search, options.kind);
    }

    // What the balls are for in the end: centres too, so that the inside is not forgotten.
    const double spacing = 0.25 * diagonal / std::sqrt(static_cast<double>(search.points.size()));
    const auto all_points = [&](double apart) {
        if (!options.checks_all) {
            return first.points;
        }
        std::vector<Point> all = solid.seeds(apart, 1, {});
        all.insert(all.end(), points.begin(), points.end());
        std::ranges::transform(candidates, std::back_inserter(all), &Ball::center);
        return all;
    };
    std::vector<Ball> start = greedy.balls;
    while (options.count && static_cast<Index>(start.size()) < *options.count) {
        start = with_one_more(placed(start, search.points), search.points, search.candidates);
    }
    const std::optional<double> error = options.count ? std::nullopt : std::optional(greedy.error);
    const Limits limits{options.clip, options.count ? options.error.value_or(kInfinity) : kInfinity, beside};
    Placement placement = found(start, search, all_points(spacing), solid, error, spacing, execution);
    report(execution, "few balls", 0.8);

    std::vector<Point> all = all_points(kCheckedPart * spacing);
    FewBalls result = finished(placement, all, solid, options.kind, limits, rounding);
    // A cavity inside may ask for more than the points of the surface do, and these more than the search has seen.
    for (int more = 0; error && result.statistics.error > *error + 2.0 * rounding && more < kMostChanged + kMostAdded;
         ++more) {
        int changes = 0;
        while (changes < kMostChanged && extend(search, placement, all, *error + rounding, spacing)) {
            placement = completed(placed(std::move(placement.balls), search.points), search, solid, *error);
            ++changes;
        }
        if (changes == 0 || more >= kMostChanged) {
            placement = placed(with_one_more(placed(placement.balls, all), all, search.candidates), search.points);
            placement = settled_everywhere(std::move(placement), search, solid);
        }
        result = finished(placement, all, solid, options.kind, limits, rounding);
    }
    FewBallsStatistics& statistics = result.statistics;
    statistics.greedy_error = greedy.error;
    statistics.greedy_count = static_cast<Index>(greedy.balls.size());
    statistics.candidates = static_cast<Index>(search.candidates.size());
    statistics.search_points = static_cast<Index>(search.points.size());
    statistics.checked_points = static_cast<Index>(all.size());
    statistics.count_bound = cover_bound(covered(first, std::max(statistics.error, error.value_or(0.0))),
                                         static_cast<Index>(result.balls.size()));
    report(execution, "few balls", 1.0);
    return result;
}

/// What of a solid and its samples lies in half-spaces.
struct Part {
    std::vector<Ball> candidates;
    std::vector<Point> points;
    std::vector<Point> beside;  // points that the half-spaces without their margin have too
};

Part part_in(std::span<const Ball> candidates, std::span<const Point> points, std::vector<HalfSpace> spaces,
             double margin) {
    Part part;
    for (const Point& p : points) {
        const double height = clearance(spaces, p);
        if (height >= 0.0) {
            (height >= margin ? part.points : part.beside).push_back(p);
        }
    }
    std::ranges::for_each(spaces, [&](HalfSpace& space) { space.offset += margin; });
    for (const Ball& ball : candidates) {
        const double height = clearance(spaces, ball.center);
        if (height > 0.0) {
            part.candidates.push_back({ball.center, std::min(ball.radius, height)});
        } else if (ball.radius + height > 0.0) {
            // What is cut off below its middle has the largest ball of the rest, so that low parts have one.
            const auto lowest = std::ranges::min_element(
                spaces, {}, [&](const HalfSpace& space) { return dot(space.normal, ball.center) - space.offset; });
            const Point center = ball.center + 0.5 * (ball.radius - height) * lowest->normal;
            const double radius = std::min(0.5 * (ball.radius + height), clearance(spaces, center));
            if (radius > 0.0) {
                part.candidates.push_back({center, radius});
            }
        }
        // Of a cut the surface has no points: middles of the sections of balls stand for it.
        for (const auto& [normal, offset] : spaces) {
            const double away = dot(normal, ball.center) - offset;
            const Point middle = ball.center - away * normal;
            if (std::abs(away) < ball.radius && clearance(spaces, middle) > -kRelativeRounding * ball.radius) {
                part.points.push_back(middle);
            }
        }
    }
    return part;
}

// The search in the part of the solid that is not clipped away, and less: balls that touched a plane could not grow,
// not even on their other side. As they grow by the error in the end, the planes are that far away in the search.
FewBalls search_in_part(std::span<const Ball> candidates, std::span<const Point> points, const Solid& solid,
                        FewBallsOptions options, const Execution& execution) {
    if (options.clip.empty()) {
        return search_and_finish(candidates, points, solid, options, {}, execution);
    }
    for (HalfSpace& space : options.clip) {
        space.normal = unit(space.normal);
    }
    const Part whole = part_in(candidates, points, options.clip, 0.0);
    if (whole.candidates.empty() || whole.points.empty()) {
        throw UnusableInput("nothing of the solid lies on the side of the planes where balls may be");
    }
    double margin = options.kind == FewBallsKind::kInside ? 0.0 : options.error.value_or(kInfinity);
    if (options.count && margin > 0.0) {
        FewBallsOptions greedy = options;
        greedy.error = {};
        greedy.improves = false;
        const ClippedSolid part(solid, options.clip);
        margin = std::min(
            margin, search_and_finish(whole.candidates, whole.points, part, greedy, {}, execution).statistics.error);
    }
    const double least_margin = kFileRounding * solid.bounds().diagonal();
    for (;; margin = margin > least_margin ? 0.5 * margin : 0.0) {
        const Part part = margin > 0.0 ? part_in(candidates, points, options.clip, margin) : whole;
        if (part.candidates.empty() || part.points.empty()) {
            continue;
        }
        std::vector<HalfSpace> nearer = options.clip;
        std::ranges::for_each(nearer, [&](HalfSpace& space) { space.offset += margin; });
        FewBalls result = search_and_finish(part.candidates, part.points, ClippedSolid(solid, nearer), options,
                                            part.beside, execution);
        // The balls may have grown by less than the margin, and have left out what is farther from the planes.
        const BallTree tree = build_ball_tree(result.balls);
        const bool has_missed = std::ranges::any_of(part.beside, [&](const Point& p) {
            return clearance(options.clip, p) > result.statistics.error &&
                   nearest_ball(tree, p).distance > least_margin;
        });
        if (!has_missed) {
            return result;
        }
    }
}

double greedy_error(const Sharer& sharer, Index count, FewBallsOptions options, const Execution& execution) {
    options.count = count;
    options.clip = sharer.clip;
    options.improves = false;
    return search_in_part(sharer.candidates, sharer.points, *sharer.solid, options, execution).statistics.error;
}

}  // namespace

FewBalls few_balls(std::span<const Ball> candidates, std::span<const Point> points, const Solid& solid,
                   const FewBallsOptions& options, const Execution& execution) {
    check(candidates, points, solid, options);
    return in_arena(execution, [&] { return search_in_part(candidates, points, solid, options, execution); });
}

std::vector<FewBalls> shared_balls(std::span<const Sharer> solids, Index total, const FewBallsOptions& options,
                                   const Execution& execution) {
    // More exchanges than this hardly ever help, and each is two searches.
    constexpr int kExchanges = 4;
    const auto size = static_cast<Index>(solids.size());
    require(total >= size,
            "the " + counted(size, "solid") + " need a ball each, and " + std::to_string(total) + " are too few");
    FewBallsOptions own = options;
    own.error = {};
    const auto options_of = [&](const Sharer& sharer, Index count) {
        own.count = count;
        own.clip = sharer.clip;
        return own;
    };
    for (const Sharer& sharer : solids) {
        check(sharer.candidates, sharer.points, *sharer.solid, options_of(sharer, 1));
    }
    return in_arena(execution, [&] {
        std::vector<Index> counts(solids.size(), 1);
        // By number of balls, from one on.
        std::vector<std::vector<double>> errors(solids.size());
        for (std::size_t k = 0; k < solids.size(); ++k) {
            errors[k].push_back(greedy_error(solids[k], 1, own, {}));
        }
        const auto can_grow = [&](std::size_t k) {
            return static_cast<std::size_t>(counts[k]) < solids[k].candidates.size();
        };
        for (Index given = size; given < total; ++given) {
            report(execution, "sharing", 0.3 * given / total);
            std::size_t worst = solids.size();
            for (std::size_t k = 0; k < solids.size(); ++k) {
                if (can_grow(k) && (worst == solids.size() || errors[k].back() > errors[worst].back())) {
                    worst = k;
                }
            }
            if (worst == solids.size()) {
                break;
            }
            const double next = greedy_error(solids[worst], ++counts[worst], own, {});
            errors[worst].push_back(std::min(errors[worst].back(), next));
        }
        const auto found = [&](std::size_t k, Index count) {
            return search_in_part(solids[k].candidates, solids[k].points, *solids[k].solid,
                                  options_of(solids[k], count), {});
        };
        std::vector<FewBalls> result;
        for (std::size_t k = 0; k < solids.size(); ++k) {
            report(execution, "sharing", 0.3 + 0.5 * static_cast<double>(k) / static_cast<double>(size));
            result.push_back(found(k, counts[k]));
        }
        for (int exchange = 0; exchange < kExchanges; ++exchange) {
            report(execution, "sharing", 0.8 + 0.2 * exchange / kExchanges);
            const auto error = [&](std::size_t k) { return result[k].statistics.error; };
            std::size_t worst = 0, giver = solids.size();
            double least = kInfinity;
            for (std::size_t k = 0; k < solids.size(); ++k) {
                worst = error(k) > error(worst) ? k : worst;
                const auto count = static_cast<std::size_t>(counts[k]);
                // What the error would be with one ball less, as greedy set cover has it.
                if (count > 1 && errors[k][count - 1] > 0.0) {
                    const double without = error(k) * errors[k][count - 2] / errors[k][count - 1];
                    if (without < least) {
                        least = without;
                        giver = k;
                    }
                }
            }
            if (giver == solids.size() || giver == worst || !can_grow(worst) || least >= error(worst)) {
                break;
            }
            FewBalls more = found(worst, counts[worst] + 1);
            FewBalls fewer = found(giver, counts[giver] - 1);
            if (std::max(more.statistics.error, fewer.statistics.error) >= error(worst)) {
                break;
            }
            errors[worst].push_back(errors[worst].back());
            ++counts[worst];
            --counts[giver];
            result[worst] = std::move(more);
            result[giver] = std::move(fewer);
        }
        report(execution, "sharing", 1.0);
        return result;
    });
}

std::vector<Ball> enclosing_balls(std::span<const Ball> balls, Index count) {
    check_balls(balls);
    require(!balls.empty() && count >= 1,
            "large balls are put around one ball at least, and one of them is needed at least");
    struct Group {
        Ball around;
        std::vector<Ball> balls;
    };
    auto groups = each_of<Group>(balls, [&](const Ball& ball) { return Group{ball, {ball}}; });
    while (static_cast<Index>(groups.size()) > count) {
        std::size_t first = 0, second = 1;
        double least = kInfinity;
        for (std::size_t a = 0; a < groups.size(); ++a) {
            for (std::size_t b = a + 1; b < groups.size(); ++b) {
                if (const double radius = around(groups[a].around, groups[b].around).radius; radius < least) {
                    least = radius;
                    first = a;
                    second = b;
                }
            }
        }
        append(groups[first].balls, groups[second].balls);
        groups[first].around = around(groups[first].balls, 4000);
        groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(second));
    }
    std::vector<Ball> large;
    for (const Group& group : groups) {
        // So that rounding leaves none outside.
        large.push_back({group.around.center, (1.0 + kRelativeRounding) * group.around.radius});
    }
    return large;
}

}  // namespace scaleaxis::inline v1
