// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "balls/critical_points.hpp"
#include "balls/dual_complex.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "sampling/questions.hpp"
#include "sampling/restricted_facets.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/fit.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A new ball is left out if a larger new one reaches this part of its squared radius beyond its centre.
constexpr double kCoveredDepth = 0.5;

// Beside a critical point outside there may be a part of the solid without a ball if the solid is closer than this part
// of the distance to the union, or if the cosine of the angle between the directions to its nearest point and to every
// ball of the simplex is below this.
constexpr double kNearPart = 0.5;
constexpr double kSidewaysCosine = 0.7;

// How far inside points are taken from which balls are grown inwards, in units of the sampling tolerance: the second
// distance is for parts thinner than the first.
constexpr std::array<double, 2> kDepths{0.05, 0.005};

// Directions to try where nothing tells the one inwards: about 14 degrees apart.
constexpr std::size_t kDirections = 256;

// Distances from the union in units of the sampling tolerance, one for each step of completion.
constexpr std::array<std::pair<double, const char*>, 3> kCompletions{
    {{1.0, "complete 1"}, {0.5, "complete 0.5"}, {0.25, "complete 0.25"}}};

constexpr Index kFew = 1000;

// Where the topology of the solid is not known, balls at critical points have at least this radius, in units of the
// sampling tolerance: a surface that intersects itself may leave the solid no thickness at all, and gaps between ever
// smaller balls would not end.
constexpr double kLeastRadius = 0.01;

// Gaps that take a larger one to be closed are not noted: hardly anybody grows balls that much.
constexpr double kLargestScaleOfGaps = 2.0;

using Simplex = std::array<Index, 4>;

/// A point of `∂S` and the direction inwards there.
struct SurfacePoint {
    Point place;
    Point inwards;  // need not be of unit length; 0 if nothing tells
};

/// The normal of a restricted facet, inwards; as long as twice its area.
Point normal_of(const Samples& samples, const RestrictedFacet& facet) {
    const std::array<Index, 3> v = vertices_of(samples, facet);
    const Point& a = samples.points[v[0]];
    const Point& apex = samples.points[samples.tetrahedra[facet.cell][facet.opposite]];
    const Point normal = cross(samples.points[v[1]] - a, samples.points[v[2]] - a);
    return dot(normal, apex - a) < 0.0 ? -1.0 * normal : normal;
}

/// The samples with the sum of the normals of their facets.
std::vector<SurfacePoint> samples_with_normals(const Samples& samples, std::span<const RestrictedFacet> facets) {
    std::vector<SurfacePoint> points(samples.points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].place = samples.points[i];
    }
    for (const RestrictedFacet& facet : facets) {
        const Point normal = normal_of(samples, facet);
        for (const Index k : vertices_of(samples, facet)) {
            points[k].inwards = points[k].inwards + normal;
        }
    }
    return points;
}

/// These, and the points of `∂S` nearest to the facets' centroids.
std::vector<SurfacePoint> surface_points(const Samples& samples, const Solid& solid, std::int64_t& queries) {
    const std::vector<RestrictedFacet> facets = restricted_facets(samples);
    std::vector<SurfacePoint> points = samples_with_normals(samples, facets);
    std::vector<Point> centroids(facets.size());
    std::ranges::transform(facets, centroids.begin(), [&](const RestrictedFacet& facet) {
        const auto [a, b, c] = vertices_of(samples, facet);
        return (1.0 / 3.0) * (samples.points[a] + samples.points[b] + samples.points[c]);
    });
    const std::vector<double> bounds(centroids.size(), kInfinity);
    const std::vector<std::optional<Point>> nearest = nearest_of(solid, centroids, bounds);
    queries += std::ssize(centroids);
    for (std::size_t i = 0; i < facets.size(); ++i) {
        if (nearest[i]) {
            points.push_back({*nearest[i], normal_of(samples, facets[i])});
        }
    }
    return points;
}

/// Of new balls those that no larger new one covers deeply: their positions, ascending.
std::vector<Index> not_covered_deeply(std::span<const Ball> balls) {
    if (balls.empty()) {
        return {};
    }
    std::vector<Index> by_size(balls.size());
    std::vector<Point> centers(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
        by_size[i] = static_cast<Index>(i);
        centers[i] = balls[i].center;
    }
    std::stable_sort(by_size.begin(), by_size.end(),
                     [&](Index i, Index j) { return balls[i].radius > balls[j].radius; });
    const PointTree tree = build_point_tree(centers);
    std::vector<std::uint8_t> is_done(balls.size());
    std::vector<Index> kept;
    CancellationPoint cancellation_point(64);
    for (const Index i : by_size) {
        cancellation_point();
        if (is_done[i] != 0) {
            continue;
        }
        kept.push_back(i);
        const double square = balls[i].radius * balls[i].radius;
        for_each_point_near(tree, balls[i].center, balls[i].radius, [&](Index position, double squared_distance) {
            const Index other = tree.order[position];
            if (square - squared_distance >= kCoveredDepth * balls[other].radius * balls[other].radius) {
                is_done[other] = 1;
            }
        });
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

/// Unit vectors, evenly spread: points of a spiral on the sphere, a golden angle apart.
std::vector<Point> directions_around() {
    std::vector<Point> directions(kDirections);
    for (std::size_t i = 0; i < kDirections; ++i) {
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / kDirections;
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / std::numbers::phi;
        const double across = std::sqrt(1.0 - z * z);
        directions[i] = {across * std::cos(angle), across * std::sin(angle), z};
    }
    return directions;
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
    const Box balls = bounds(fitted.balls);
    box.extend(balls.min);
    box.extend(balls.max);
    const double margin = 0.01 * box.diagonal();
    box.extend(box.min - Point{margin, margin, margin});
    box.extend(box.max + Point{margin, margin, margin});
    return box;
}

class Repair {
   public:
    Repair(const FittedBalls& fitted, const Samples& samples, const Solid& solid, const RepairOptions& options,
           const Execution& execution)
        : samples_(samples),
          solid_(solid),
          options_(options),
          execution_(execution),
          builder_(box_of(fitted, solid), true) {
        result_.balls = fitted.balls;
        result_.contacts = fitted.contacts;
        limit_ =
            static_cast<std::size_t>((1.0 + options.growth_limit) * static_cast<double>(fitted.balls.size())) + kFew;
    }

    RepairedBalls run() {
        triangulate();
        sample_step();
        critical_step();
        for (const auto& [distance, name] : kCompletions) {
            if (options_.topology && !is_right()) {
                completion_step(distance, name);
            }
        }
        if (options_.topology && !is_right()) {
            polar_step();
        }
        result_.report.topology = topology_;
        std::ranges::stable_sort(result_.report.gaps, {}, &Gap::scale);
        return std::move(result_);
    }

   private:
    bool is_right() const { return options_.topology && agree(*options_.topology, topology_); }

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
        std::vector<Index> slots;
        triangulation_ = builder_.finish(&slots);
        std::vector<std::uint8_t> is_fresh(slots.size());
        for_each_index(slots.size(), [&](std::size_t i) { is_fresh[i] = builder_.is_fresh(slots[i]) ? 1 : 0; });

        std::erase_if(critical_, [&](const CriticalPoint& point) {
            return std::ranges::any_of(added, [&](const Ball& ball) {
                return squared_distance(ball.center, point.place) - ball.radius * ball.radius < point.power;
            });
        });
        append(critical_, critical_points_of_cells(triangulation_, moved_, CriticalPoints::kUncovered, is_fresh));
        std::ranges::sort(critical_, {}, &CriticalPoint::balls);
        const auto repeated = std::unique(critical_.begin(), critical_.end(),
                                          [](const auto& a, const auto& b) { return a.balls == b.balls; });
        critical_.erase(repeated, critical_.end());
    }

    void find_topology() {
        DualComplex complex = dual_complex(std::move(triangulation_), moved_);
        topology_ = complex.topology;
        triangulation_ = std::move(complex.triangulation);
    }

    // No sample may be very far from the union.
    void sample_step() {
        RepairStep step{.name = "samples"};
        const std::vector<SurfacePoint> samples = samples_with_normals(samples_, restricted_facets(samples_));
        if (complete(samples, kCompletions[0].first, step)) {
            find_topology();
            finish(step);
        }
    }

    void critical_step() {
        RepairStep step{.name = "critical"};
        mend_critical_points(step);
        find_topology();
        finish(step);
    }

    void completion_step(double distance, const char* name) {
        RepairStep step{.name = name};
        if (surface_points_.empty()) {
            surface_points_ = surface_points(samples_, solid_, result_.report.queries);
        }
        if (complete(surface_points_, distance, step)) {
            mend_critical_points(step);
            find_topology();
        }
        finish(step);
    }

    // Polar balls stick out of the solid, so they cover crevices much narrower than the samples are apart, along which
    // inscribed balls may leave a tunnel. They stay only if the topology is right with them.
    void polar_step() {
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
        finish(step);
    }

    // Those that cover a critical point outside the solid.
    std::vector<Ball> polar_balls_at_gaps() const {
        std::vector<Point> places(result_.report.gaps.size());
        std::ranges::transform(result_.report.gaps, places.begin(), &Gap::place);
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
        std::vector<Point> centers(balls.size());
        std::ranges::transform(balls, centers.begin(), &Ball::center);
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

    // Grows balls inwards from points of `∂S` until none of them is farther from the union, in units of the sampling
    // tolerance. Were there any?
    bool complete(std::span<const SurfacePoint> points, double distance, RepairStep& step) {
        std::vector<SurfacePoint> far(points.begin(), points.end());
        for (Index round = 0; round < options_.max_rounds; ++round) {
            far = far_points(far, distance * samples_.tolerance);
            step.far_samples += round == 0 ? static_cast<Index>(far.size()) : 0;
            if (!add(fitted(seeds_of(far)), step)) {
                break;
            }
            ++step.rounds;
        }
        if (step.rounds > 0) {
            triangulate();
        }
        return step.rounds > 0;
    }

    void finish(RepairStep& step) {
        step.topology = topology_;
        result_.report.added += step.added;
        result_.report.steps.push_back(std::move(step));
    }

    void mend_critical_points(RepairStep& step) {
        for (Index round = 0; round < options_.max_rounds; ++round) {
            tell();
            const double least_radius = options_.topology ? 0.0 : kLeastRadius * samples_.tolerance;
            if (!add(fitted(seeds_of_critical_points(step)), step, least_radius)) {
                return;
            }
            triangulate();
            ++step.rounds;
        }
    }

    FittedBalls fitted(const std::vector<Ball>& seeds) {
        FittedBalls fitted = fit(seeds, solid_, {options_.slack}, Execution{execution_.threads, {}, execution_.cancel});
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
        std::vector<Point> places(critical.size());
        std::ranges::transform(critical, places.begin(), &CriticalPoint::place);
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
        const std::vector<SurfacePoint> missed = missed_parts(gaps.outside);
        step.missed += static_cast<Index>(missed.size());
        append(gaps.seeds, seeds_of(missed));
        return std::move(gaps.seeds);
    }

    // The points of `∂S` nearest to critical points outside, where they belong to a part of the solid that has no ball.
    // Their simplices are settled: they need not be asked about again.
    std::vector<SurfacePoint> missed_parts(std::span<const CriticalPoint> outside) {
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
        std::vector<SurfacePoint> missed;
        for (std::size_t i = 0; i < outside.size(); ++i) {
            if (nearest[i] && is_missed(outside[i], *nearest[i], bounds[i] - samples_.tolerance)) {
                missed.push_back({*nearest[i], *nearest[i] - places[i]});
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

    // A small ball inside beside each point of `∂S`: along the normal, or where that does not lead inside along the
    // middle one of the directions that do. Beside crumpled and very thin parts the normals of facets mean little.
    std::vector<Ball> seeds_of(std::span<const SurfacePoint> points) const {
        std::vector<Ball> seeds;
        std::vector<SurfacePoint> left(points.begin(), points.end());
        const auto normal_of = [](const SurfacePoint& point) { return std::array{unit(point.inwards)}; };
        for (const double depth : kDepths) {
            left = seed(left, depth, normal_of, seeds);
        }
        const std::vector<Point> all_around = directions_around();
        for (const double depth : kDepths) {
            left = seed(
                left, depth, [&](const SurfacePoint&) { return std::span(all_around); }, seeds);
        }
        return seeds;
    }

    // Returns the points without a seed. `directions_at` gives equally many for each.
    std::vector<SurfacePoint> seed(std::span<const SurfacePoint> points, double depth, const auto& directions_at,
                                   std::vector<Ball>& seeds) const {
        std::vector<Point> places;
        for (const SurfacePoint& point : points) {
            for (const Point& direction : directions_at(point)) {
                places.push_back(point.place + (depth * samples_.tolerance) * direction);
            }
        }
        const std::vector<std::uint8_t> is_inside = sides_of(solid_, places);
        std::vector<SurfacePoint> left;
        for (std::size_t i = 0, k = 0; i < points.size(); ++i) {
            std::vector<Point> inwards;
            for (const Point& direction : directions_at(points[i])) {
                if (is_inside[k++] != 0 && squared_norm(direction) > 0.0) {
                    inwards.push_back(direction);
                }
            }
            if (inwards.empty()) {
                left.push_back(points[i]);
                continue;
            }
            const Point sum = std::accumulate(inwards.begin(), inwards.end(), Point{});
            const Point& middle =
                *std::ranges::max_element(inwards, {}, [&](const Point& direction) { return dot(sum, direction); });
            seeds.push_back({points[i].place + (depth * samples_.tolerance) * middle, samples_.tolerance});
        }
        return left;
    }

    // The points of `∂S` that are farther from the union.
    std::vector<SurfacePoint> far_points(std::span<const SurfacePoint> points, double limit) const {
        std::vector<Ball> inflated = result_.balls;
        for (Ball& ball : inflated) {
            ball.radius += limit;
        }
        const BallTree tree = build_ball_tree(inflated);
        return collect<std::vector<SurfacePoint>>(points.size(), [&](std::size_t i, std::vector<SurfacePoint>& out) {
            if (covering_ball(tree, points[i].place) == kNone) {
                out.push_back(points[i]);
            }
        });
    }

    const Samples& samples_;
    const Solid& solid_;
    const RepairOptions& options_;
    const Execution& execution_;
    RepairedBalls result_;
    std::size_t limit_ = 0;
    double progress_ = 0.0;
    TriangulationBuilder builder_;
    // Of the union as it was triangulated last:
    std::vector<Ball> moved_;  // its balls in general position
    Triangulation triangulation_;
    Topology topology_;
    std::vector<CriticalPoint> critical_;  // to be asked about, ascending
    std::vector<Simplex> settled_;         // simplices with a critical point outside, ascending
    std::vector<SurfacePoint> surface_points_;
};

}  // namespace

RepairedBalls repair(const FittedBalls& fitted, const Samples& samples, const Solid& solid,
                     const RepairOptions& options, const Execution& execution) {
    if (!(options.max_rounds >= 0 && options.max_rounds <= 100)) {
        throw InvalidOption("the number of rounds of a repair must lie between 0 and 100");
    }
    if (!(options.growth_limit >= 0.0) || !std::isfinite(options.growth_limit)) {
        throw InvalidOption("the growth limit of a repair must be a number of at least 0");
    }
    return in_arena(execution, [&] {
        report(execution, "union repair", 0.0);
        RepairedBalls repaired;
        if (!fitted.balls.empty()) {
            repaired = Repair(fitted, samples, solid, options, execution).run();
        }
        report(execution, "union repair", 1.0);
        return repaired;
    });
}

}  // namespace scaleaxis
