// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "balls/covering_balls.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {
namespace {

// A ball that nothing stops grows by this, one that is to be stopped begins so much larger than it is expected to be.
constexpr double kGrowth = 1.5;
constexpr double kHeadStart = 1.1;

// The slack is not more than this part of the inscribed ball that a fit begins with.
constexpr double kSlackOfRadius = 0.1;

// A solid that searches for its nearest points locally may find a nearer one later: the fit begins again with it,
// unless it is so much nearer that the solid must be wrong.
constexpr double kLeastPartOfFirst = 0.5;

// More questions than a ball ever needs: about five are usual.
constexpr int kMaxQuestions = 64;

// So many balls, and this part of all, may be contradicted by the solid before it is taken to be wrong.
constexpr Index kFewQueries = 16;
constexpr double kMaxInexactPart = 0.1;

// Progress is reported this often.
constexpr std::size_t kBlocksOfProgress = 64;

enum class State : std::uint8_t { kOutside, kSearched, kFitted, kInexact };

// A ball on its way: of radius `radius`, touching `∂S` at `first` from the inside.
struct ContactSearch {
    State state = State::kOutside;
    Point first;
    Point normal;            // from `first` inwards
    double inscribed = 0.0;  // the radius around the given centre
    double least_inscribed = 0.0;
    double slack = 0.0;
    double radius = 0.0;  // that the solid is asked about next
    Point second;         // what stopped larger balls, if anything has
    bool is_stopped = false;
    Ball ball;  // the result, once it is found

    Point center() const { return first + radius * normal; }
};

// The largest number that is surely no more than the distance of two points.
double safe_distance(const Point& a, const Point& b) {
    constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
    const double size = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    const double length = distance(a, b);
    return length - kRounding * (size + length);
}

void give_up(ContactSearch& search, const Point& center) {
    search.state = State::kInexact;
    search.ball = {center, safe_distance(center, search.first)};
    search.second = search.is_stopped ? search.second : search.first;
}

ContactSearch begun_at(const Point& nearest, const Ball& ball, double slack) {
    ContactSearch search;
    search.first = nearest;
    search.inscribed = distance(ball.center, nearest);
    if (!(safe_distance(ball.center, nearest) > 0.0)) {
        return search;
    }
    search.state = State::kSearched;
    search.normal = (1.0 / search.inscribed) * (ball.center - nearest);
    search.slack = std::min(slack, kSlackOfRadius * search.inscribed);
    search.radius = kHeadStart * std::max(ball.radius, search.inscribed);
    search.least_inscribed = kLeastPartOfFirst * search.inscribed;
    return search;
}

ContactSearch begun(const Ball& ball, bool is_inside, const std::optional<Point>& nearest, double slack) {
    return is_inside && nearest ? begun_at(*nearest, ball, slack) : ContactSearch();
}

// The solid has found a point nearer to the given centre than the one it found first.
void begin_again(ContactSearch& search, const Point& nearest, const Ball& given) {
    const double least = search.least_inscribed;
    if (!(distance(nearest, given.center) > least)) {
        give_up(search, given.center);
        return;
    }
    search = begun_at(nearest, given, search.slack);
    search.least_inscribed = least;
}

// Takes the answer to the question for the nearest point of `search.center()`.
void take(ContactSearch& search, const std::optional<Point>& nearest, const Ball& given, const Box& bounds) {
    const Point center = search.center();
    const double reach = nearest ? distance(center, *nearest) : kInfinity;
    if (!(reach < search.radius - search.slack)) {
        if (search.is_stopped && !bounds.contains(center)) {
            give_up(search, given.center);
            return;
        }
        if (search.is_stopped) {
            // Something has stopped all larger balls, and nothing stops this one.
            search.state = State::kFitted;
            search.ball = {center, std::min(safe_distance(center, search.first), safe_distance(center, search.second))};
            if (nearest) {
                search.ball.radius = std::min(search.ball.radius, safe_distance(center, *nearest));
                if (squared_distance(*nearest, search.first) > squared_distance(search.second, search.first)) {
                    search.second = *nearest;
                }
            }
            return;
        }
        search.radius *= kGrowth;
        if (search.radius > bounds.diagonal()) {
            give_up(search, given.center);
        }
        return;
    }
    // The sphere through this point, too. It holds the inscribed ball, if the answers are true.
    const Point chord = *nearest - search.first;
    const double radius = squared_norm(chord) / (2.0 * dot(search.normal, chord));
    if (!(radius >= search.inscribed - search.slack)) {
        begin_again(search, *nearest, given);
        return;
    }
    search.is_stopped = true;
    search.second = *nearest;
    if (!(radius < search.radius)) {
        give_up(search, given.center);
        return;
    }
    search.radius = std::max(radius, search.inscribed);
}

// Of this file, so that `collect_blocks` finds how to join several.
struct Part {
    FittedBalls fitted;
};

Part join(const std::vector<Part>& parts) {
    Part all;
    for (const auto& [fitted] : parts) {
        all.fitted.statistics.outside += fitted.statistics.outside;
        all.fitted.statistics.inexact += fitted.statistics.inexact;
        all.fitted.statistics.queries += fitted.statistics.queries;
        append(all.fitted.balls, fitted.balls);
        append(all.fitted.contacts, fitted.contacts);
        append(all.fitted.given, fitted.given);
    }
    return all;
}

// Asks about all balls of a batch that are still searched, until none is.
void search_all(std::vector<ContactSearch>& searches, std::span<const Ball> balls, const Solid& solid,
                const Box& bounds_of_solid, std::int64_t& queries) {
    std::vector<Index> active;
    std::vector<Point> centers;
    std::vector<double> bounds;
    std::vector<std::optional<Point>> nearest;
    for (int question = 0; question < kMaxQuestions; ++question) {
        active.clear();
        centers.clear();
        bounds.clear();
        for (Index i = 0; i < static_cast<Index>(searches.size()); ++i) {
            if (searches[i].state == State::kSearched) {
                active.push_back(i);
                centers.push_back(searches[i].center());
                // The first contact itself is not of interest.
                bounds.push_back(searches[i].radius * (1.0 - 1e-12));
            }
        }
        if (active.empty()) {
            return;
        }
        stop_if_cancelled();
        nearest.assign(active.size(), std::nullopt);
        solid.nearest(centers, bounds, nearest);
        queries += std::ssize(active);
        for (std::size_t k = 0; k < active.size(); ++k) {
            take(searches[active[k]], nearest[k], balls[active[k]], bounds_of_solid);
        }
    }
    for (std::size_t i = 0; i < searches.size(); ++i) {
        if (searches[i].state == State::kSearched) {
            give_up(searches[i], balls[i].center);
        }
    }
}

// The points of `∂S` nearest to the centres. They are hardly ever farther than the radius: asking so first is cheaper.
std::vector<std::optional<Point>> nearest_of(std::span<const Point> centers, std::span<const Ball> balls,
                                             const Solid& solid, std::int64_t& queries) {
    auto bounds = each_of<double>(balls, [](const Ball& ball) { return 1.001 * ball.radius; });
    std::vector<std::optional<Point>> nearest(balls.size());
    solid.nearest(centers, bounds, nearest);
    queries += std::ssize(balls);
    std::vector<std::size_t> farther;
    std::vector<Point> left;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (!nearest[i]) {
            farther.push_back(i);
            left.push_back(centers[i]);
        }
    }
    bounds.assign(left.size(), kInfinity);
    std::vector<std::optional<Point>> found(left.size());
    solid.nearest(left, bounds, found);
    queries += std::ssize(left);
    for (std::size_t k = 0; k < left.size(); ++k) {
        nearest[farther[k]] = found[k];
    }
    return nearest;
}

void fit_batch(std::span<const Ball> balls, std::size_t first, const Solid& solid, double slack, const Box& bounds,
               FittedBalls& out) {
    auto centers = each_of<Point>(balls, &Ball::center);
    std::vector<std::uint8_t> sides(balls.size());
    solid.inside(centers, sides);
    std::vector<std::optional<Point>> nearest = nearest_of(centers, balls, solid, out.statistics.queries);
    std::vector<ContactSearch> searches(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
        searches[i] = begun(balls[i], sides[i] != 0, nearest[i], slack);
    }
    search_all(searches, balls, solid, bounds, out.statistics.queries);
    // Where the solid knows nearest points only about, as beside an edge of a cloud, a ball may have left it.
    std::ranges::transform(searches, centers.begin(), [](const ContactSearch& search) { return search.ball.center; });
    solid.inside(centers, sides);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const ContactSearch& search = searches[i];
        if (search.state == State::kOutside || !(search.ball.radius > 0.0) || sides[i] == 0) {
            ++out.statistics.outside;
            continue;
        }
        out.statistics.inexact += search.state == State::kInexact ? 1 : 0;
        out.balls.push_back(search.ball);
        out.contacts.push_back({search.first, search.second});
        out.given.push_back(static_cast<Index>(first + i));
    }
}

}  // namespace

void check_knows_nearest(const Solid& solid) {
    if (!solid.knows_nearest()) {
        throw UnusableInput(Diagnostic{"solid.nearest_unknown",
                                       "balls cannot be fitted to this solid, which does not know the nearest points "
                                       "of its boundary: take polar balls"});
    }
}

FittedBalls fit(std::span<const Ball> balls, const Solid& solid, const FitOptions& options,
                const Execution& execution) {
    require(options.slack > 0.0 && std::isfinite(options.slack), "the slack of a fit must be a positive number");
    check_knows_nearest(solid);
    const Box bounds = solid.bounds();
    return in_arena(execution, [&] {
        report(execution, "fit", 0.0);
        solid.prepare_nearest();
        const std::vector<Part> blocks = collect_blocks<Part>(
            solid, balls.size(), kBlocksOfProgress,
            [&](std::size_t begin, std::size_t end, Part& out) {
                fit_batch(balls.subspan(begin, end - begin), begin, solid, options.slack, bounds, out.fitted);
            },
            [&](double part) { report(execution, "fit", part); });
        FittedBalls fitted = join(blocks).fitted;
        if (fitted.statistics.inexact >
            kFewQueries + static_cast<Index>(kMaxInexactPart * static_cast<double>(balls.size()))) {
            throw UnusableInput(Diagnostic{
                "solid.nearest", "the solid contradicts itself about the nearest points of its boundary, for " +
                                     std::to_string(fitted.statistics.inexact) + " of " + std::to_string(balls.size()) +
                                     " balls: balls cannot be fitted to it"});
        }
        const std::vector<Index> kept = distinct_positions(fitted.balls);
        fitted.statistics.repeated = static_cast<Index>(fitted.balls.size() - kept.size());
        fitted = selected(fitted, kept);
        report(execution, "fit", 1.0);
        return fitted;
    });
}

}  // namespace scaleaxis::inline v1
