// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/angles.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/ranges.hpp"
#include "solid/dipole_tree.hpp"
#include "solid/pointwise_solid.hpp"
#include "solid/seeds.hpp"
#include "solid/zero_set/bracketed_root.hpp"
#include "solid/zero_set/farthest_point.hpp"
#include "solid/zero_set/foot_search.hpp"
#include "spatial/point_tree.hpp"
#include "spatial/poisson_disk.hpp"

namespace scaleaxis::inline v1 {
namespace {

// How far the surface may lie outside the hull of the points, in spacings.
constexpr double kCloudMargin = 0.25;

// Candidates for each square of the spacing: enough for a maximal Poisson-disk sample to leave no gaps.
constexpr double kCloudSeedsPerSquare = 9.0;

// The first thinning of seeds, before they are projected, in spacings.
constexpr double kFirstThinning = 1.03;

// Nearer than this part of the kernel's radius to a point, the spheres alone count; farther than the next one, the
// winding number alone. These are 0.75 and 1.5 spacings at the default support. Spheres farther away bulge at edges and
// join the sides of narrow gaps; nearer, the winding number shows single points and takes more of edges off. The
// surface passes by its points no farther away than the second one.
constexpr double kNear = 0.25;
constexpr double kFar = 0.5;

// Points whose winding number is looked at to find that of the surface: the median of so many is known to a percent or
// two of the ranks.
constexpr std::size_t kLevelTrials = 2000;

// Of places farther away than the support, a point that is so much farther than the nearest one serves as well.
constexpr double kHardlyFarther = 1.03;

// Segments are searched for crossings in steps of this part of the kernel's radius.
constexpr double kProjectionStep = 0.25;

// Crossings are exact to this part of the kernel's radius.
constexpr double kPrecision = 1e-5;

/// How much a point counts whose normal is at this cosine to that of the surface: little from 60 degrees on.
double agreement(double cosine) {
    const double half = std::max(0.0, 0.5 + 0.5 * cosine);
    const double power2 = half * half;
    const double power4 = power2 * power2;
    return power4 * power4;
}

/// 1 at a distance of 0, 0 from the radius on.
double nearness(double squared_distance, double squared_radius) {
    return std::max(0.0, 1.0 - squared_distance / squared_radius);
}

/// The axes, and the diagonals of the faces of a cube and of the cube.
std::array<Point, 13> hull_directions() {
    std::array<Point, 13> directions;
    std::size_t count = 0;
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                if (9 * x + 3 * y + z > 0) {
                    const Point d{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
                    directions[count++] = (1.0 / norm(d)) * d;
                }
            }
        }
    }
    return directions;
}

/// The space between parallel planes around points, in 13 directions.
struct Hull {
    std::array<Point, 13> directions = hull_directions();
    std::array<double, 13> min;
    std::array<double, 13> max;
    Box box;

    Hull(const std::vector<Point>& points, double margin) {
        min.fill(std::numeric_limits<double>::infinity());
        max.fill(-std::numeric_limits<double>::infinity());
        for (const Point& p : points) {
            box.extend(p);
            for (std::size_t k = 0; k < directions.size(); ++k) {
                min[k] = std::min(min[k], dot(directions[k], p) - margin);
                max[k] = std::max(max[k], dot(directions[k], p) + margin);
            }
        }
        const Point by{margin, margin, margin};
        box = {box.min - by, box.max + by};
    }

    /// How far outside `p` lies; negative: inside.
    double distance_beyond(const Point& p) const {
        double beyond = -std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const double height = dot(directions[k], p);
            beyond = std::max({beyond, height - max[k], min[k] - height});
        }
        return beyond;
    }
};

/// The implicit function at a point.
struct Value {
    double height = 0.0;  ///< about the signed distance; negative: inside
    double reach = 0.0;   ///< there is no surface nearer than this, as far as the points tell
    double radius = 0.0;  ///< of the kernel here
    Point gradient;       ///< of the height, about
};

class MovingLeastSquares final : public PointwiseSolid {
   public:
    MovingLeastSquares(const PreparedCloud& cloud, double kernel)
        : tree_(build_point_tree(cloud.cloud.points)),
          hull_(cloud.cloud.points, kCloudMargin * cloud.report.spacing),
          normals_(tree_.points.size()),
          spacings_(tree_.points.size()),
          radii_(tree_.points.size()),
          planes_(tree_.points.size()),
          warnings_(cloud.report.warnings()) {
        for (std::size_t i = 0; i < tree_.points.size(); ++i) {
            normals_[i] = cloud.cloud.normals[tree_.order[i]];
            spacings_[i] = cloud.spacings[tree_.order[i]];
            radii_[i] = kernel * spacings_[i];
            largest_radius_ = std::max(largest_radius_, radii_[i]);
        }
        dipoles_ = DipoleTree(tree_, [&](Index i) {
            const double area = spacings_[i] * spacings_[i];
            return SurfacePart{area, area * tree_.points[i], area * normals_[i], {tree_.points[i], tree_.points[i]}};
        });
        level_ = level_of_surface();
        for_each_index(
            planes_.size(), [&](std::size_t i) { planes_[i] = plane_at(i); }, std::size_t{64});
    }

    Box bounds() const override { return hull_.box; }

    std::vector<Diagnostic> warnings() const override { return warnings_; }

    bool is_inside(const Point& p) const override { return value(p).height < 0.0; }

    std::optional<Point> crossing_of(const Point& inside_end, const Point& outside_end,
                                     const Point& reference) const override {
        const double length = distance(inside_end, outside_end);
        if (!(length > 0.0)) {
            return std::nullopt;
        }
        const Point direction = (1.0 / length) * (outside_end - inside_end);
        const auto at = [&](double t) { return t < length ? inside_end + t * direction : outside_end; };
        Value before = value(inside_end);
        const Value last = value(outside_end);
        if (!(before.height < 0.0 && last.height >= 0.0)) {
            return std::nullopt;
        }
        FarthestPoint farthest{reference};
        const double end = length - std::max(0.0, last.reach);  // beyond it there is nothing
        double t = 0.0;
        while (t < end) {
            const double next = std::min(end, t + step_from(before));
            const Value after = next < length ? value(at(next)) : last;
            if ((before.height < 0.0) != (after.height < 0.0)) {
                farthest.add(at(root_between(at, t, before, next, after)));
            }
            t = next;
            before = after;
        }
        // Where the last points tell of none nearby, but one was passed over all the same.
        if (before.height < 0.0) {
            farthest.add(at(root_between(at, t, before, length, last)));
        }
        return farthest.point;
    }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return in_arena(execution, [&] {
            check_number_of_seeds(number_of_seeds(spacing));
            auto candidates =
                collect<std::vector<Point>>(tree_.points.size(), [&](std::size_t i, std::vector<Point>& out) {
                    const double wanted = kCloudSeedsPerSquare * spacings_[i] * spacings_[i] / (spacing * spacing);
                    if (wanted < 1.0 && random_unit(seed, i) >= wanted && i % kLandmarkStep != 0) {
                        return;
                    }
                    out.push_back(tree_.points[i]);
                    for (std::uint64_t k = 1; static_cast<double>(k) < wanted; ++k) {
                        out.push_back(scattered(i, seed, k));
                    }
                });
            for_each_index(candidates.size(), [&](std::size_t i) { candidates[i] = flattened(candidates[i]); });
            append(candidates, hull_candidates(spacing, seed));
            // Most of them would go anyway, and exact projection takes its time. Those kept stay as far apart, or
            // almost.
            candidates = poisson_disk_subset(candidates, kFirstThinning * spacing, seed);
            return collect<std::vector<Point>>(
                candidates.size(),
                [&](std::size_t i, std::vector<Point>& out) {
                    if (const std::optional<Point> p = projected(candidates[i])) {
                        out.push_back(*p);
                    }
                },
                std::size_t{256});
        });
    }

    std::optional<Point> nearest_to(const Point& p, double bound) const override {
        std::optional<Point> nearest;
        double least = bound;
        const auto offer = [&](const Point& q) {
            if (const double there = distance(p, q); there < least) {
                least = there;
                nearest = q;
            }
        };
        const NearPoint near = nearest_point(tree_, p);
        if (std::sqrt(near.squared_distance) - radii_[near.position] < bound) {
            if (const std::optional<Point> foot = foot_near(near.position, p)) {
                offer(*foot);
            }
        }
        // Where the hull closes the surface.
        for (std::size_t k = 0; k < hull_.directions.size(); ++k) {
            const double height = dot(hull_.directions[k], p);
            for (const double side : {hull_.min[k], hull_.max[k]}) {
                const Point q = p + (side - height) * hull_.directions[k];
                if (std::abs(side - height) < least && is_closed_by_hull(q)) {
                    offer(q);
                }
            }
        }
        return nearest;
    }

   private:
    struct Plane {
        Point normal;
        double offset = 0.0;
    };

    /// The signed distance from an algebraic sphere.
    struct Sphere {
        double height = 0.0;
        Point gradient;
    };

    /// Points of the hull's planes where these close the surface. Only large squares with a corner inside are filled.
    std::vector<Point> hull_candidates(double spacing, std::uint64_t seed) const {
        constexpr int kSquares = 48;
        std::vector<Point> result;
        const Point center = midpoint(hull_.box.min, hull_.box.max);
        const double side = hull_.box.diagonal() / kSquares;
        for (std::size_t k = 0; k < hull_.directions.size(); ++k) {
            const std::array<Point, 2> tangents = across(hull_.directions[k]);
            for (const double height : {hull_.min[k], hull_.max[k]}) {
                const Point origin = center + (height - dot(hull_.directions[k], center)) * hull_.directions[k];
                const auto at = [&](double x, double y) {
                    return origin + (x * side) * tangents[0] + (y * side) * tangents[1];
                };
                append(result, collect<std::vector<Point>>(
                                   kSquares * kSquares,
                                   [&](int square, std::vector<Point>& out) {
                                       const double x = square % kSquares - 0.5 * kSquares;
                                       const double y = square / kSquares - 0.5 * kSquares;
                                       const bool is_closing = hull_.distance_beyond(at(x, y)) < 2.0 * side &&
                                                               open_value(at(x, y)).height < side;
                                       if (is_closing) {
                                           fill(at, x, y, side / spacing, random_bits(seed, k, square), out);
                                       }
                                   },
                                   64));
            }
        }
        return result;
    }

    /// Random points of a square where the hull is the surface. \param spacings in the side of the square
    template <class At>
    void fill(const At& at, double x, double y, double spacings, std::uint64_t seed, std::vector<Point>& out) const {
        const auto count = static_cast<std::uint64_t>(std::ceil(kCloudSeedsPerSquare * spacings * spacings));
        for (std::uint64_t i = 0; i < count; ++i) {
            const Point p = at(x + random_unit(seed, i, 0), y + random_unit(seed, i, 1));
            if (is_closed_by_hull(p)) {
                out.push_back(p);
            }
        }
    }

    // Every n-th point is a seed in any case.
    static constexpr std::size_t kLandmarkStep = 1000;

    /// The plane that touches the surface near point `i`.
    Plane plane_at(std::size_t i) const {
        const Point& p = tree_.points[i];
        const Sphere sphere = sphere_at(p, radii_[i]);
        const Point normal = (1.0 / norm(sphere.gradient)) * sphere.gradient;
        return {normal, dot(normal, p) - sphere.height};
    }

    /// Does a point lie on the hull where that is the surface?
    bool is_closed_by_hull(const Point& p) const {
        return std::abs(hull_.distance_beyond(p)) < 1e-9 * hull_.box.diagonal() && open_value(p).height < 0.0;
    }

    Value value(const Point& p) const {
        const double beyond = hull_.distance_beyond(p);
        if (beyond > radii_[0]) {
            return {beyond, beyond, radii_[0], {}};
        }
        Value result = open_value(p);
        result.height = std::max(result.height, beyond);
        return result;
    }

    /// The same without the hull.
    Value open_value(const Point& p) const {
        const NearPoint nearest = near_point(tree_, p, largest_radius_, kHardlyFarther);
        const double nearest_distance = std::sqrt(nearest.squared_distance);
        const double radius = radii_[nearest.position];
        const double at_least = nearest_distance > radius ? nearest_distance / kHardlyFarther : nearest_distance;
        Value result{0.0, at_least - kFar * radius, radius, {}};
        const double share = std::clamp((kFar * radius - nearest_distance) / ((kFar - kNear) * radius), 0.0, 1.0);
        if (share > 0.0) {
            const Sphere sphere = sphere_at(p, radius);
            result.height = share * sphere.height;
            result.gradient = share * sphere.gradient;
        }
        if (share < 1.0) {
            const double side = std::clamp(2.0 * (level_ - winding_number(p)), -1.0, 1.0);
            const Point away = (1.0 / nearest_distance) * (p - tree_.points[nearest.position]);
            result.height += (1.0 - share) * side * nearest_distance;
            result.gradient = result.gradient + ((1.0 - share) * side) * away;
        }
        return result;
    }

    /// That of the squares which the points have for themselves.
    double winding_number(const Point& p) const {
        return dipoles_.winding_number(tree_, p, [&](Index i) {
            const Point d = tree_.points[i] - p;
            return d == Point{} ? 0.0 : spacings_[i] * spacings_[i] * dipole_angle(normals_[i], d);
        });
    }

    /// The winding number on the surface: 0.5 where it is closed, 0 on a plane that ends, whose sides have 0.5 and
    /// -0.5.
    double level_of_surface() const {
        const std::size_t step = tree_.points.size() / kLevelTrials + 1;
        return median(mapped<double>((tree_.points.size() + step - 1) / step,
                                     [&](std::size_t i) { return winding_number(tree_.points[i * step]); }));
    }

    /// That of `p` from the sphere fitted to the points around it.
    Sphere sphere_at(const Point& p, double radius) const {
        struct Neighbor {
            Index position;
            double weight;
        };
        static thread_local std::vector<Neighbor> neighbors;
        neighbors.clear();
        Point mean;
        for_each_point_near(tree_, p, radius, [&](Index k, double squared) {
            const double x = nearness(squared, radius * radius);
            const double w = x * x * x * x;
            neighbors.push_back({k, w});
            mean = mean + w * normals_[k];
        });
        mean = (1.0 / norm(mean)) * mean;
        // The mean of those that agree: near an edge it leans to one of the sides.
        Point side;
        for (const auto& [k, distance_weight] : neighbors) {
            side = side + (distance_weight * agreement(dot(mean, normals_[k]))) * normals_[k];
        }
        side = (1.0 / norm(side)) * side;
        double sum = 0.0;
        Point sum_p;
        Point sum_n;
        double sum_pn = 0.0;
        double sum_pp = 0.0;
        for (const auto& [k, distance_weight] : neighbors) {
            const Point d = tree_.points[k] - p;
            const double w = distance_weight * agreement(dot(side, normals_[k]));
            sum += w;
            sum_p = sum_p + w * d;
            sum_n = sum_n + w * normals_[k];
            sum_pn += w * dot(d, normals_[k]);
            sum_pp += w * squared_norm(d);
        }
        const double spread = sum_pp - squared_norm(sum_p) / sum;
        const double most = 1.0 / radius;
        const double curved = spread > 1e-12 * sum * radius * radius
                                  ? std::clamp(0.5 * (sum_pn - dot(sum_p, sum_n) / sum) / spread, -most, most)
                                  : 0.0;
        const Point linear = (1.0 / sum) * (sum_n - (2.0 * curved) * sum_p);
        const double constant = -(dot(linear, sum_p) + curved * sum_pp) / sum;
        // Taubin's distance, as far as it makes sense.
        const double slope = std::max(0.25, std::sqrt(std::max(0.0, squared_norm(linear) - 4.0 * curved * constant)));
        return {constant / slope, (1.0 / slope) * linear};
    }

    /// How far to go along a segment: the surface is not expected nearer than about this.
    static double step_from(const Value& v) {
        return std::max({v.reach, kProjectionStep * v.radius, 0.8 * std::min(std::abs(v.height), kFar * v.radius)});
    }

    /// Where the sign changes between two places of a segment.
    template <class At>
    double root_between(const At& at, double begin, const Value& at_begin, double end, const Value& at_end) const {
        const double accuracy = kPrecision * at_begin.radius;
        const auto height = [&](double t) {
            const double exact = value(at(t)).height;
            return std::abs(exact) < 0.5 * accuracy ? 0.0 : exact;
        };
        return bracketed_root(height, begin, end, at_begin.height, at_end.height, accuracy);
    }

    /// A random point of the square that point `i` has for itself in the tangent plane, and a little more.
    Point scattered(std::size_t i, std::uint64_t seed, std::uint64_t k) const {
        const auto [u, v] = across(planes_[i].normal);
        const double side = 1.5 * spacings_[i];
        const double x = side * (random_unit(seed, i, 2 * k) - 0.5);
        const double y = side * (random_unit(seed, i, 2 * k + 1) - 0.5);
        return tree_.points[i] + x * u + y * v;
    }

    /// The point below `p` or above it on the plane at the nearest of the given points.
    Point flattened(const Point& p) const {
        const Plane& plane = planes_[nearest_point(tree_, p).position];
        return p - (dot(plane.normal, p) - plane.offset) * plane.normal;
    }

    /// The point of the surface near `p`, if there is one.
    std::optional<Point> projected(const Point& p) const {
        constexpr int kSteps = 5;
        if (is_closed_by_hull(p)) {
            return p;
        }
        Point q = p;
        for (int step = 0; step < kSteps; ++step) {
            const Value here = value(q);
            const double slope = norm(here.gradient);
            q = q - (here.height / (slope * slope)) * here.gradient;
            if (!(slope > 0.0) || !(squared_distance(p, q) < kFar * kFar * here.radius * here.radius)) {
                break;
            }
            // The next step, which has the square of this error, would not matter.
            if (std::abs(here.height) < 1e-3 * here.radius) {
                return q;
            }
        }
        return projected_by_search(p);
    }

    /// The same along the normal at the nearest of the given points.
    std::optional<Point> projected_by_search(const Point& p) const {
        const NearPoint nearest = nearest_point(tree_, p);
        const double radius = radii_[nearest.position];
        const Value start = value(p);
        const double sign = start.height < 0.0 ? 1.0 : -1.0;
        const auto at = [&](double t) { return p + (sign * t) * planes_[nearest.position].normal; };
        double before = 0.0;
        Value value_before = start;
        for (double t = std::max(1.5 * std::abs(start.height), 1e-3 * radius); t < kFar * radius; t *= 2.0) {
            const Value after = value(at(t));
            if ((after.height < 0.0) != (start.height < 0.0)) {
                return at(root_between(at, before, value_before, t, after));
            }
            before = t;
            value_before = after;
        }
        return std::nullopt;
    }

    /// The point of the surface nearest to `p`, as far as a search near point `i` tells.
    std::optional<Point> foot_near(std::size_t i, const Point& p) const {
        // It starts at the nearest point of a disc around the point.
        const Plane& plane = planes_[i];
        const auto to_plane = [&](const Point& q) { return q - (dot(plane.normal, q) - plane.offset) * plane.normal; };
        const Point middle = to_plane(tree_.points[i]);
        const Point way = to_plane(p) - middle;
        const double length = norm(way);
        const Point start = middle + (length > 0.5 * spacings_[i] ? 0.5 * spacings_[i] / length : 1.0) * way;
        FootSearch search(p, start, spacings_[i], kPrecision * radii_[i], true);
        while (!search.is_done()) {
            const Value here = value(search.place());
            const bool is_beyond_hull = hull_.distance_beyond(search.place()) >= here.height;
            search.tell(here.height, is_beyond_hull ? Point{} : here.gradient);
        }
        return search.result() ? search.result() : projected(tree_.points[i]);
    }

    /// How many seeds there will be, about.
    double number_of_seeds(double spacing) const {
        double area = 0.0;
        for (const double s : spacings_) {
            area += s * s;
        }
        return kCloudSeedsPerSquare * area / (spacing * spacing);
    }

    // All by the positions of the tree.
    PointTree tree_;
    Hull hull_;
    std::vector<Point> normals_;
    std::vector<double> spacings_;
    std::vector<double> radii_;  // of the kernels
    double largest_radius_ = 0.0;
    std::vector<Plane> planes_;
    DipoleTree dipoles_;
    double level_ = 0.0;  // the winding number on the surface

    std::vector<Diagnostic> warnings_;
};

}  // namespace

std::unique_ptr<Solid> cloud_solid(const PreparedCloud& cloud, const MlsOptions& options, const Execution& execution) {
    if (!cloud.report.fault.empty()) {
        throw UnusableInput(cloud.report.fault);
    }
    const double kernel = options.kernel.value_or(cloud.report.kernel);
    require(kKernelRange.contains(kernel), "the kernel must lie between 1.5 and 100 spacings of the points");
    return in_arena(execution, [&] {
        report(execution, "search tree", 0.0);
        auto solid = std::make_unique<MovingLeastSquares>(cloud, kernel);
        report(execution, "search tree", 1.0);
        return solid;
    });
}

}  // namespace scaleaxis::inline v1
