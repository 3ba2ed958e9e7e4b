// SPDX-License-Identifier: Apache-2.0
#include "balls/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "balls/critical_points.hpp"
#include "balls/dual_complex.hpp"
#include "balls/inward_seeds.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/powers.hpp"
#include "base/progress.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/balls.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// A new ball is left out if a larger new one reaches this part of its squared radius beyond its centre.
constexpr double kGapCoveredDepth = 0.5;

// Beside a critical point outside there may be a part of the solid without a ball if the solid is closer than this part
// of the distance to the union, or if the cosine of the angle between the directions to its nearest point and to every
// ball of the simplex is below this.
constexpr double kNearPart = 0.5;
constexpr double kSidewaysCosine = 0.7;

// How far samples may be from the union, in units of the sampling tolerance, where the topology of the solid is not
// known. Other points are not looked at then, so that parts that hang on nothing, as where a surface intersects itself,
// do not multiply.
constexpr double kFarSample = 1.0;

// Points of the boundary that are nearer to the union than this at first, in units of the sampling tolerance, need not
// be looked at again.
constexpr double kNearPoint = 0.25;

// The largest distance is looked for among points farther than this, in units of the sampling tolerance, and among all
// only if there are none. Sizes that follow the solid bring some points nearly as far as promised, of hundreds of
// thousands.
constexpr double kAlmostFar = 0.9 * kPromise;

// Distances allowed one after the other, in units of the sampling tolerance, while the topology is wrong.
constexpr std::array<std::pair<double, const char*>, 2> kCompletions{{{0.5, "complete 0.5"}, {0.25, "complete 0.25"}}};

// Distance between the points of the boundary that are looked at besides, in units of the sampling tolerance: about
// three for each sample of uniform ones.
constexpr double kPointSpacing = 2.0;

// Points this close to an island are beside it, in units of the sampling tolerance. All of the boundary is within half
// a tolerance of the union, so the rest of it is near these.
constexpr double kBesideIsland = 2.0;

// Points beside islands that are to be joined to the rest may be this far from the union, in units of the sampling
// tolerance: the least distance asked for above.
constexpr double kJoined = kCompletions.back().first;

constexpr Index kFewPoints = 1000;

// An island whose points are no farther than this from the rest, in units of the sampling tolerance, may go for the
// right topology. Twice what is promised, and points farther than that are told; limbs that samples can show stay.
constexpr double kIslandReach = 1.0;

// Where the topology of the solid is not known, balls at critical points have at least this radius, in units of the
// sampling tolerance: a surface that intersects itself may leave the solid no thickness at all, and gaps between ever
// smaller balls would not end. So it is along an edge where parts of the solid touch. Where the topology is known, some
// solids need smaller balls, so this is tried second.
constexpr double kLeastRadius = 0.01;

// Gaps that take a larger one to be closed are not noted: hardly anybody grows balls that much.
constexpr double kLargestScaleOfGaps = 2.0;

using Simplex = std::array<Index, 4>;

/// Of new balls those that no larger new one covers deeply: their positions, ascending.
std::vector<Index> not_covered_deeply(std::span<const Ball> balls) {
    if (balls.empty()) {
        return {};
    }
    const PointTree tree = build_point_tree(each_of<Point>(balls, &Ball::center));
    std::vector<std::uint8_t> is_done(balls.size());
    std::vector<Index> kept;
    CancellationPoint cancellation_point(64);
    for (const Index i : sorted_indices(
             balls.size(), [&](Index k) { return balls[k].radius; }, std::greater<>())) {
        cancellation_point();
        if (is_done[i] != 0) {
            continue;
        }
        kept.push_back(i);
        const double square = balls[i].radius * balls[i].radius;
        for_each_point_near(tree, balls[i].center, balls[i].radius, [&](Index position, double squared_distance) {
            const Index other = tree.order[position];
            if (square - squared_distance >= kGapCoveredDepth * balls[other].radius * balls[other].radius) {
                is_done[other] = 1;
            }
        });
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

/// Of the samples on the sphere of each polar ball the two that are farthest apart.
std::vector<Contacts> touched_samples(const Samples& samples, std::span<const Ball> balls) {
    constexpr double kRounding = 1e-6;
    const PointTree tree = build_point_tree(samples.points);
    std::vector<Contacts> contacts;
    for (const Ball& ball : balls) {
        std::vector<Point> touched;
        for_each_point_near(tree, ball.center, (1.0 + kRounding) * ball.radius,
                            [&](Index i, double) { touched.push_back(tree.points[i]); });
        Contacts farthest{ball.center, ball.center};
        for (const Point& a : touched) {
            for (const Point& b : touched) {
                if (squared_distance(a, b) >= squared_distance(farthest[0], farthest[1])) {
                    farthest = {a, b};
                }
            }
        }
        contacts.push_back(farthest);
    }
    return contacts;
}

/// Around all balls that there are, or will be.
Box box_of(const FittedBalls& fitted, const Solid& solid) {
    Box box = solid.bounds();
    box.extend(bounds(fitted.balls));
    const double margin = 0.01 * box.diagonal();
    box.extend(box.min - Point{margin, margin, margin});
    box.extend(box.max + Point{margin, margin, margin});
    return box;
}

class Repair {
   public:
    /// \param least_radius of balls at critical points, in units of the sampling tolerance
    Repair(const FittedBalls& fitted, const Samples& samples, const Solid& solid, const RepairOptions& options,
           double least_radius, const Execution& execution)
        : least_radius_(least_radius * samples.tolerance),
          samples_(samples),
          solid_(solid),
          options_(options),
          execution_(execution),
          box_(box_of(fitted, solid)),
          builder_(box_, true) {
        result_.balls = fitted.balls;
        result_.contacts = fitted.contacts;
        limit_ = static_cast<std::size_t>((1.0 + options.growth_limit) * static_cast<double>(fitted.balls.size())) +
                 kFewPoints;
    }

    void complete_samples() {
        points_ = boundary_points([&](std::span<const Point> points) {
            result_.report.points += static_cast<Index>(points.size());
            return far_from(points, result_.balls, kNearPoint * samples_.tolerance);
        });
        complete({.name = "samples"}, points_, options_.topology ? kPromise : kFarSample);
    }

    // Takes islands away that may go. Where that is not enough those that points of the boundary need are joined to the
    // rest, and gaps of the rest get balls of any size: in folds that leave with an island these would be many, in
    // vain.
    void join_islands() {
        const std::optional<std::vector<Ball>> needed = remove_islands({kPromise, kIslandReach}, true);
        if (!is_wrong()) {
            return;
        }
        RepairStep step{.name = "small balls"};
        least_radius_ = 0.0;
        closes_gaps_alone_ = true;
        if (needed) {
            builder_ = TriangulationBuilder(box_, true);
            moved_.clear();
            critical_.clear();
            settled_.clear();
            if (!needed->empty()) {
                add_balls_at(points_beside(*needed), kJoined * samples_.tolerance, step);
            }
            triangulate();
        }
        mend_critical_points(step);
        find_topology();
        step.topology = topology_;
        finish(step);
        remove_islands({kPromise, kIslandReach});
    }

    void complete_boundary() {
        remove_islands({kPromise});
        for (const auto& [distance, name] : kCompletions) {
            if (!is_wrong()) {
                return;
            }
            const std::vector<Ball> around = has_only_islands() ? islands(lands()) : std::vector<Ball>();
            if (complete({.name = name}, points_beside(around), distance)) {
                remove_islands({kPromise});
            }
        }
        remove_islands({kIslandReach});
    }

    RepairedBalls result() {
        result_.report.topology = topology_;
        measure();
        std::ranges::stable_sort(result_.report.gaps, {}, &Gap::scale);
        return std::move(result_);
    }

    RepairedBalls run() {
        complete_samples();
        complete_boundary();
        remove_islands({kPromise}, true);
        if (is_wrong()) {
            add_polar_balls();
        }
        return result();
    }

    bool is_wrong() const { return options_.topology && !agree(*options_.topology, topology_); }
    /// Were balls added that a least radius would leave out?
    bool has_tiny_balls() const { return has_tiny_balls_; }

   private:
    // Inserts the balls that are new, and adds the critical points of what they have changed to those to be asked
    // about.
    void triangulate() {
        stop_if_cancelled();
        const auto first = std::ssize(moved_);
        moved_ = perturbed(result_.balls, options_.perturbation, options_.seed);
        const std::span<const Ball> added = std::span(moved_).subspan(first);
        std::vector<Point> centers(added.size());
        std::vector<double> weights(added.size());
        std::ranges::transform(added, centers.begin(), &Ball::center);
        std::ranges::transform(added, weights.begin(), [](const Ball& ball) { return ball.radius * ball.radius; });
        builder_.insert(centers, weights);
        std::vector<std::uint8_t> is_fresh;
        Triangulation changed = builder_.finish_fresh(is_fresh);

        std::erase_if(critical_, [&](const CriticalPoint& point) {
            return std::ranges::any_of(added, [&](const Ball& ball) {
                return squared_distance(ball.center, point.place) - ball.radius * ball.radius < point.power;
            });
        });
        append(critical_, critical_points_of_cells(changed, moved_, CriticalPoints::kUncovered, is_fresh));
        std::ranges::stable_sort(critical_, {}, &CriticalPoint::balls);
        const auto repeated = std::unique(critical_.begin(), critical_.end(),
                                          [](const auto& a, const auto& b) { return a.balls == b.balls; });
        critical_.erase(repeated, critical_.end());
        triangulation_ = first == 0 ? std::move(changed) : Triangulation();
    }

    void find_topology() {
        const bool is_whole = triangulation_.size() > 0;
        DualComplex complex = dual_complex(is_whole ? std::move(triangulation_) : builder_.finish(), moved_);
        triangulation_ = {};
        edges_ = std::move(complex.edges);
        topology_ = complex.topology;
    }

    // Is the topology right but for components too many?
    bool has_only_islands() const {
        if (!is_wrong() || topology_.components <= options_.topology->components) {
            return false;
        }
        Topology joined = topology_;
        joined.euler -= joined.components - options_.topology->components;
        joined.components = options_.topology->components;
        return agree(joined, *options_.topology);
    }

    // The samples, and the points of the boundary at the centres of their facets, that some balls contain; all of them
    // if there are no balls.
    std::vector<Point> points_beside(const std::vector<Ball>& around) {
        const auto is_beside = [&, tree = around.empty() ? BallTree() : build_ball_tree(around)](const Point& point) {
            return around.empty() || covering_ball(tree, point) != kNone;
        };
        std::vector<Point> points = points_at_facets(samples_, solid_, is_beside, result_.report.queries);
        std::ranges::copy_if(samples_.points, std::back_inserter(points), is_beside);
        return points;
    }

    // What `choose(points)` takes of the points of the boundary that are looked at: seeds are too many to be kept.
    template <class Choose>
    std::vector<Point> boundary_points(const Choose& choose) const {
        std::vector<Point> points = choose(samples_.points);
        if (options_.topology) {
            append(points, choose(solid_.seeds(kPointSpacing * samples_.tolerance, options_.seed, quiet_)));
        }
        return points;
    }

    static std::vector<Point> far_from(std::span<const Point> points, std::span<const Ball> balls, double distance) {
        return far_from_balls(points, balls, distance, [](const Point& point) { return point; });
    }

    // How far the points that have been looked at are from the union. Mostly some are nearly as far as they may be:
    // then the others need not be measured.
    void measure() {
        std::vector<Point> points = far_from(points_, result_.balls, kAlmostFar * samples_.tolerance);
        if (points.empty()) {
            points = std::move(points_);
        }
        const std::vector<NearestBall> nearest = nearest_balls(points);
        RepairReport& report = result_.report;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (nearest[i].distance > report.largest_distance) {
                report.largest_distance = nearest[i].distance;
                report.farthest_point = points[i];
            }
            report.far_points += nearest[i].distance > kPromise * samples_.tolerance ? 1 : 0;
        }
    }

    std::vector<NearestBall> nearest_balls(const std::vector<Point>& points) const {
        const BallTree tree = build_ball_tree(result_.balls);
        return mapped<NearestBall>(points.size(), [&](std::size_t i) { return nearest_ball(tree, points[i]); });
    }

    // No point may be farther from the union than this, in units of the sampling tolerance; then no critical point may
    // be left to mend. Were balls added?
    bool complete(RepairStep step, std::span<const Point> points, double distance) {
        add_balls_at(points, distance * samples_.tolerance, step);
        if (moved_.size() < result_.balls.size()) {
            triangulate();
            mend_critical_points(step);
            find_topology();
        }
        step.topology = topology_;
        const bool has_added = step.added > 0;
        finish(step);
        return has_added;
    }

    // The components of the union. The largest ones, as many as the solid has, are mainlands, the others islands, as
    // are hidden balls: the boundary is complete beside few of these.
    struct Lands {
        std::vector<Index> of;                  // of each ball the one that stands for its component
        std::vector<std::uint8_t> is_mainland;  // of balls that stand for components
    };

    // A part of the solid that hangs on a neck too thin for any ball leaves an island. One may go if all points of the
    // boundary stay this near to the union, in tolerances; it does if the topology is right then. Reaches are tried in
    // their order; at the last one islands go whatever the topology if \p wants_fewer.
    /// \return the balls of those needed at the last reach that was tried, see `islands`; nothing if none was
    std::optional<std::vector<Ball>> remove_islands(std::initializer_list<double> reaches, bool wants_fewer = false) {
        if (!is_wrong() || topology_.components <= options_.topology->components) {
            return std::nullopt;
        }
        const Lands all = lands();
        const BallTree shore = build_ball_tree(islands(all));
        const auto is_beside = [&](const Point& point) { return covering_ball(shore, point) != kNone; };
        const std::vector<Point> points = boundary_points([&](std::span<const Point> some) {
            return collect<std::vector<Point>>(some.size(), [&](std::size_t i, std::vector<Point>& out) {
                if (is_beside(some[i])) {
                    out.push_back(some[i]);
                }
            });
        });
        std::vector<Ball> needed;
        for (const double& reach : reaches) {
            const std::vector<std::uint8_t> is_needed = needed_lands(all, points, reach * samples_.tolerance);
            const bool in_any_case = wants_fewer && &reach == reaches.end() - 1;
            needed = islands(all, is_needed);
            if ((in_any_case || std::ranges::count(is_needed, 1) == options_.topology->components) &&
                keep_lands(all, is_needed, in_any_case)) {
                std::erase_if(points_, is_beside);
                append(points_, far_from(points, result_.balls, kNearPoint * samples_.tolerance));
                break;
            }
        }
        return needed;
    }

    // Takes all other balls away, where that is of use. Is it?
    bool keep_lands(const Lands& lands, std::span<const std::uint8_t> is_needed, bool in_any_case) {
        std::vector<Ball> balls;
        std::vector<Contacts> contacts;
        for (std::size_t i = 0; i < lands.of.size(); ++i) {
            if (is_needed[lands.of[i]] != 0) {
                balls.push_back(result_.balls[i]);
                contacts.push_back(result_.contacts[i]);
            }
        }
        const auto removed = static_cast<Index>(result_.balls.size() - balls.size());
        if (removed == 0) {
            return false;
        }
        const Topology topology = dual_complex(perturbed(balls, options_.perturbation, options_.seed)).topology;
        if (!in_any_case && !agree(*options_.topology, topology)) {
            return false;
        }
        topology_ = topology;
        result_.balls = std::move(balls);
        result_.contacts = std::move(contacts);
        RepairStep step{.name = "islands", .rounds = 1, .added = -removed, .topology = topology};
        finish(step);
        return true;
    }

    Lands lands() const {
        DisjointSets sets(result_.balls.size());
        for (const auto& [a, b] : edges_) {
            sets.join(a, b);
        }
        Lands lands{sets.all(), std::vector<std::uint8_t>(result_.balls.size())};
        std::vector<double> volumes(lands.of.size());
        std::vector<Index> first;
        for (Index i = 0; i < std::ssize(lands.of); ++i) {
            volumes[lands.of[i]] += power(result_.balls[i].radius, 3);
            if (lands.of[i] == i) {
                first.push_back(i);
            }
        }
        std::ranges::stable_sort(first, std::greater<>(), [&](Index i) { return volumes[i]; });
        first.resize(std::min(first.size(), static_cast<std::size_t>(options_.topology->components)));
        for (const Index i : first) {
            lands.is_mainland[i] = 1;
        }
        return lands;
    }

    // The balls of islands, larger by what is beside these.
    /// \param is_wanted 1 for the balls that stand for the islands; empty: all are wanted
    std::vector<Ball> islands(const Lands& lands, std::span<const std::uint8_t> is_wanted = {}) const {
        std::vector<Ball> around;
        for (std::size_t i = 0; i < lands.of.size(); ++i) {
            const Index land = lands.of[i];
            if (lands.is_mainland[land] == 0 && (is_wanted.empty() || is_wanted[land] != 0)) {
                const Ball& ball = result_.balls[i];
                around.push_back({ball.center, ball.radius + kBesideIsland * samples_.tolerance});
            }
        }
        return around;
    }

    // Mainlands, and those islands that some of the points are far without: 1 for the balls that stand for them.
    std::vector<std::uint8_t> needed_lands(const Lands& lands, std::span<const Point> points, double reach) const {
        std::vector<std::uint8_t> is_needed = lands.is_mainland;
        std::vector<Ball> mainland;
        for (std::size_t i = 0; i < lands.of.size(); ++i) {
            if (is_needed[lands.of[i]] != 0) {
                mainland.push_back(result_.balls[i]);
            }
        }
        for (const NearestBall& nearest : nearest_balls(far_from(points, mainland, reach))) {
            is_needed[lands.of[nearest.ball]] = 1;
        }
        return is_needed;
    }

    // Polar balls stick out of the solid, so they cover crevices much narrower than the samples are apart, along which
    // inscribed balls may leave a tunnel. They stay only if the topology is right with them.
    void add_polar_balls() {
        RepairStep step{.name = "polar"};
        std::vector<Ball> balls = result_.balls;
        append(balls, polar_balls_at_gaps());
        const Topology topology = dual_complex(perturbed(balls, options_.perturbation, options_.seed)).topology;
        ++step.rounds;
        if (agree(*options_.topology, topology)) {
            topology_ = topology;
            step.added = static_cast<Index>(balls.size() - result_.balls.size());
            const std::span<const Ball> polar = std::span(balls).subspan(result_.balls.size());
            append(result_.contacts, touched_samples(samples_, polar));
            result_.report.largest_protrusion = largest_protrusion(polar);
            result_.balls = std::move(balls);
        }
        step.topology = topology_;
        finish(step);
    }

    // Those that cover a critical point outside the solid.
    std::vector<Ball> polar_balls_at_gaps() const {
        const auto places = each_of<Point>(result_.report.gaps, &Gap::place);
        const PointTree tree = build_point_tree(places);
        std::vector<Ball> polar = inner_balls(samples_);
        std::erase_if(polar, [&](const Ball& ball) {
            bool is_at_gap = false;
            for_each_point_near(tree, ball.center, ball.radius, [&](Index, double) { is_at_gap = true; });
            return !is_at_gap;
        });
        return polar;
    }

    // How far balls stick out of the solid.
    double largest_protrusion(std::span<const Ball> balls) {
        const auto centers = each_of<Point>(balls, &Ball::center);
        const std::vector<double> bounds(balls.size(), kInfinity);
        const std::vector<std::optional<Point>> nearest = nearest_of(solid_, centers, bounds);
        result_.report.queries += std::ssize(centers);
        double largest = 0.0;
        for (std::size_t i = 0; i < balls.size(); ++i) {
            largest = std::max(largest, balls[i].radius - (nearest[i] ? distance(centers[i], *nearest[i]) : 0.0));
        }
        return largest;
    }

    // How many rounds there will be is not known.
    void tell() {
        progress_ += 0.2 * (1.0 - progress_);
        report(execution_, "union repair", progress_);
    }

    struct FarPoint {
        Point place;
        Index tries = 0;
        NearestBall nearest{kNone, kInfinity};
    };

    // Of points that know the nearest of the first balls, the nearest of all.
    void find_nearest(std::vector<FarPoint>& points, std::size_t known) const {
        const BallTree tree = build_ball_tree(std::span(result_.balls).subspan(known));
        for_each_index(points.size(), [&](std::size_t i) {
            NearestBall& nearest = points[i].nearest;
            const auto [ball, distance] = nearest_ball(tree, points[i].place, nearest.distance);
            if (ball != kNone && distance < nearest.distance) {
                nearest = {static_cast<Index>(known) + ball, distance};
            }
        });
    }

    // Grows balls inwards from points of `∂S` that are farther than this from the union. Points with the same ball
    // nearest are mostly parts of one dip, so only the farthest of them gets a ball, and the others are looked at
    // again.
    void add_balls_at(std::span<const Point> points, double limit, RepairStep& step) {
        std::vector<FarPoint> far(points.size());
        std::ranges::transform(points, far.begin(), [](const Point& p) { return FarPoint{p}; });
        std::size_t known = 0;  // balls that the points are far from
        for (; step.rounds < options_.max_rounds; ++step.rounds) {
            far = far_from_balls<FarPoint>(far, std::span(result_.balls).subspan(known), limit,
                                           [](const FarPoint& point) { return point.place; });
            step.far_samples += step.rounds == 0 ? static_cast<Index>(far.size()) : 0;
            if (far.empty()) {
                return;
            }
            if (known < result_.balls.size()) {
                find_nearest(far, known);
            }
            known = result_.balls.size();
            const bool has_untried = std::ranges::any_of(far, [](const FarPoint& point) { return point.tries == 0; });
            if (!add(fitted(seeds_at_farthest(far, limit)), step) && !has_untried) {
                return;
            }
        }
    }

    // Deep balls are larger and meet others. Points that these leave far get balls that touch the boundary there, those
    // tried least first: larger new balls may take the place of these.
    std::vector<Ball> seeds_at_farthest(std::vector<FarPoint>& points, double limit) {
        const auto rank = [&](std::size_t i) { return std::pair(points[i].tries, -points[i].nearest.distance); };
        std::vector<std::size_t> farthest(result_.balls.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            std::size_t& best = farthest[points[i].nearest.ball];
            if (best == points.size() || rank(i) < rank(best)) {
                best = i;
            }
        }
        std::vector<Point> deep;
        std::vector<Point> shallow;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (farthest[points[i].nearest.ball] == i) {
                (points[i].tries++ == 0 ? deep : shallow).push_back(points[i].place);
            }
        }
        const double tolerance = samples_.tolerance;
        std::vector<Ball> seeds = deep_seeds(ways_inside(std::move(deep), solid_, tolerance), solid_, tolerance, limit,
                                             result_.report.queries);
        append(seeds, shallow_seeds(ways_inside(std::move(shallow), solid_, tolerance), tolerance));
        return seeds;
    }

    void finish(RepairStep& step) {
        result_.report.added += step.added;
        result_.report.steps.push_back(std::move(step));
    }

    void mend_critical_points(RepairStep& step) {
        for (Index round = 0; round < options_.max_rounds; ++round) {
            tell();
            if (!add(fitted(seeds_of_critical_points(step)), step, least_radius_)) {
                return;
            }
            triangulate();
            ++step.rounds;
        }
    }

    FittedBalls fitted(const std::vector<Ball>& seeds) {
        FittedBalls fitted = fit(seeds, solid_, {options_.slack}, quiet_);
        result_.report.queries += fitted.statistics.queries;
        return fitted;
    }

    // Were there any of at least this radius?
    bool add(const FittedBalls& fitted, RepairStep& step, double least_radius = 0.0) {
        const std::size_t before = result_.balls.size();
        for (const Index i : not_covered_deeply(fitted.balls)) {
            if (fitted.balls[i].radius < least_radius) {
                continue;
            }
            has_tiny_balls_ |= fitted.balls[i].radius < kLeastRadius * samples_.tolerance;
            if (result_.balls.size() >= limit_) {
                result_.report.is_growth_limited = true;
                break;
            }
            result_.balls.push_back(fitted.balls[i]);
            result_.contacts.push_back(fitted.contacts[i]);
        }
        step.added += static_cast<Index>(result_.balls.size() - before);
        return result_.balls.size() > before;
    }

    double largest_radius(const CriticalPoint& point) const {
        double radius = 0.0;
        for (const Index ball : point.simplex()) {
            radius = std::max(radius, result_.balls[ball].radius);
        }
        return radius;
    }

    // Balls around those critical points that are in the solid, to be fitted; and the others.
    struct Gaps {
        std::vector<Ball> seeds;
        std::vector<CriticalPoint> inside;
        std::vector<CriticalPoint> outside;
    };

    Gaps seeds_at_gaps(std::span<const CriticalPoint> critical, RepairStep& step) const {
        auto places = each_of<Point>(critical, &CriticalPoint::place);
        const std::vector<std::uint8_t> is_inside = sides_of(solid_, places);
        Gaps gaps;
        for (std::size_t i = 0; i < critical.size(); ++i) {
            if (is_inside[i] != 0) {
                gaps.seeds.push_back({places[i], largest_radius(critical[i])});
            }
            (is_inside[i] != 0 ? gaps.inside : gaps.outside).push_back(critical[i]);
        }
        step.gaps += static_cast<Index>(gaps.seeds.size());
        return gaps;
    }

    // Balls in the solid, to be fitted: at gaps, and where the solid is beside the union.
    std::vector<Ball> seeds_of_critical_points(RepairStep& step) {
        std::erase_if(critical_, [&](const CriticalPoint& point) {
            return std::binary_search(settled_.begin(), settled_.end(), point.balls);
        });
        Gaps gaps = seeds_at_gaps(critical_, step);
        critical_ = std::move(gaps.inside);  // until balls cover them
        if (closes_gaps_alone_) {
            return std::move(gaps.seeds);
        }
        std::vector<Point> missed = missed_parts(gaps.outside);
        step.missed += static_cast<Index>(missed.size());
        append(gaps.seeds,
               shallow_seeds(ways_inside(std::move(missed), solid_, samples_.tolerance), samples_.tolerance));
        return std::move(gaps.seeds);
    }

    // The points of `∂S` nearest to critical points outside, where they belong to a part of the solid that has no ball.
    // Their simplices are settled: they need not be asked about again.
    std::vector<Point> missed_parts(std::span<const CriticalPoint> outside) {
        std::vector<Point> places(outside.size());
        std::vector<double> bounds(outside.size());
        for (std::size_t i = 0; i < outside.size(); ++i) {
            // How far the union is: of balls of equal power the largest is the nearest.
            const double radius = largest_radius(outside[i]);
            places[i] = outside[i].place;
            bounds[i] = std::sqrt(std::max(0.0, outside[i].power) + radius * radius) - radius + samples_.tolerance;
        }
        const std::vector<std::optional<Point>> nearest = nearest_of(solid_, places, bounds);
        result_.report.queries += std::ssize(places);
        std::vector<Point> missed;
        for (std::size_t i = 0; i < outside.size(); ++i) {
            if (nearest[i] && is_missed(outside[i], *nearest[i], bounds[i] - samples_.tolerance)) {
                missed.push_back(*nearest[i]);
            }
            settled_.push_back(outside[i].balls);
            note_gap(outside[i]);
        }
        std::sort(settled_.begin(), settled_.end());
        return missed;
    }

    // Since balls lie in the solid, none will cover the point but by growing.
    void note_gap(const CriticalPoint& point) {
        double nearest = kInfinity;
        double farthest = 0.0;
        Gap gap{point.place, 0.0, kInfinity};
        for (const Index b : point.simplex()) {
            const Ball& ball = result_.balls[b];
            const double from_center = distance(point.place, ball.center);
            nearest = std::min(nearest, from_center - ball.radius);
            farthest = std::max(farthest, from_center - ball.radius);
            gap.scale = std::min(gap.scale, from_center / ball.radius);
        }
        gap.width = nearest + farthest;
        if (gap.scale <= kLargestScaleOfGaps) {
            result_.report.gaps.push_back(gap);
        }
    }

    bool is_missed(const CriticalPoint& point, const Point& nearest, double distance_to_union) const {
        if (distance(point.place, nearest) < kNearPart * distance_to_union) {
            return true;
        }
        const Point direction = unit(nearest - point.place);
        const std::span<const Index> simplex = point.simplex();
        return std::ranges::all_of(simplex, [&](Index ball) {
            return dot(direction, unit(result_.balls[ball].center - point.place)) < kSidewaysCosine;
        });
    }

    double least_radius_;
    const Samples& samples_;
    const Solid& solid_;
    const RepairOptions& options_;
    const Execution& execution_;
    const Execution quiet_{execution_.threads, {}, execution_.cancel};  // of what does not report progress
    RepairedBalls result_;
    bool has_tiny_balls_ = false;
    std::size_t limit_ = 0;
    double progress_ = 0.0;
    bool closes_gaps_alone_ = false;  // and looks for no missed parts
    const Box box_;                   // around all balls
    TriangulationBuilder builder_;
    // Of the union as it was triangulated last:
    std::vector<Ball> moved_;                  // its balls in general position
    Triangulation triangulation_;              // of all of them, or empty after more were added
    std::vector<std::array<Index, 2>> edges_;  // of its dual complex, as its topology
    Topology topology_;
    std::vector<CriticalPoint> critical_;  // to be asked about, ascending
    std::vector<Simplex> settled_;         // simplices with a critical point outside, ascending
    std::vector<Point> points_;            // that are not near to the balls given
};

void validate(const RepairOptions& options) {
    require(options.max_rounds >= 0 && options.max_rounds <= 100,
            "the number of rounds of a repair must lie between 0 and 100");
    require(options.growth_limit >= 0.0 && std::isfinite(options.growth_limit),
            "the growth limit of a repair must be a number of at least 0");
}

double least_radius_of(const RepairOptions& options) { return options.topology ? 0.0 : kLeastRadius; }

}  // namespace

std::optional<RepairedBalls> repair_at_samples(const FittedBalls& fitted, const Samples& samples, const Solid& solid,
                                               const RepairOptions& options, const Execution& execution) {
    validate(options);
    return in_arena(execution, [&]() -> std::optional<RepairedBalls> {
        report(execution, "union repair", 0.0);
        Repair repair(fitted, samples, solid, options, kLeastRadius, execution);
        repair.complete_samples();
        repair.join_islands();
        report(execution, "union repair", 1.0);
        return repair.is_wrong() ? std::nullopt : std::optional(repair.result());
    });
}

RepairedBalls repair(const FittedBalls& fitted, const Samples& samples, const Solid& solid,
                     const RepairOptions& options, const Execution& execution) {
    validate(options);
    return in_arena(execution, [&] {
        report(execution, "union repair", 0.0);
        RepairedBalls repaired;
        if (!fitted.balls.empty()) {
            Repair first(fitted, samples, solid, options, least_radius_of(options), execution);
            repaired = first.run();
            if (first.is_wrong() && first.has_tiny_balls()) {
                const Execution quiet{execution.threads, {}, execution.cancel};
                Repair second(fitted, samples, solid, options, kLeastRadius, quiet);
                if (RepairedBalls other = second.run(); !second.is_wrong()) {
                    repaired = std::move(other);
                }
            }
        }
        report(execution, "union repair", 1.0);
        return repaired;
    });
}

}  // namespace scaleaxis::inline v1
