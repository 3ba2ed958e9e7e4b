// SPDX-License-Identifier: Apache-2.0
#include "balls/inward_seeds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/numbers.hpp"
#include "sampling/questions.hpp"
#include "sampling/restricted_facets.hpp"

namespace scaleaxis::inline v1 {
namespace {

// How far inside an way leads, in units of the sampling tolerance: the second distance is for parts thinner than the
// first.
constexpr std::array<double, 2> kDepths{0.05, 0.005};

// Directions to try where nothing tells the one inwards: about 14 degrees apart.
constexpr std::size_t kDirections = 256;

// How far inside deep seeds are tried, in units of the limit. Along the middle of a right angle the inscribed ball at
// 3.4 limits comes as near to the edge as it may.
constexpr std::array<double, 5> kReaches{8.0, 4.0, 2.0, 1.0, 0.5};

/// The normal of a restricted facet, inwards; as long as twice its area.
Point normal_of(const Samples& samples, const RestrictedFacet& facet) {
    const std::array<Index, 3> v = vertices_of(samples, facet);
    const Point& a = samples.points[v[0]];
    const Point& apex = samples.points[samples.tetrahedra[facet.cell][facet.opposite]];
    const Point normal = cross(samples.points[v[1]] - a, samples.points[v[2]] - a);
    return dot(normal, apex - a) < 0.0 ? -1.0 * normal : normal;
}

std::vector<BoundaryPoint> with_normals(const Samples& samples, std::span<const RestrictedFacet> facets) {
    std::vector<BoundaryPoint> points(samples.points.size());
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

/// Adds ways along the middle one of the directions that lead inside, and returns the points that have none.
/// `directions_at` gives equally many for each.
std::vector<BoundaryPoint> add_ways(std::span<const BoundaryPoint> points, const Solid& solid, double depth,
                                    const auto& directions_at, std::vector<WayInside>& ways) {
    std::vector<Point> places;
    for (const BoundaryPoint& point : points) {
        for (const Point& direction : directions_at(point)) {
            places.push_back(point.place + depth * direction);
        }
    }
    const std::vector<std::uint8_t> is_inside = sides_of(solid, places);
    std::vector<BoundaryPoint> left;
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
        ways.push_back({points[i].place, middle, depth});
    }
    return left;
}

}  // namespace

std::vector<BoundaryPoint> samples_with_normals(const Samples& samples) {
    return with_normals(samples, restricted_facets(samples));
}

std::vector<BoundaryPoint> samples_and_facets(const Samples& samples, const Solid& solid, std::int64_t& queries) {
    const std::vector<RestrictedFacet> facets = restricted_facets(samples);
    std::vector<BoundaryPoint> points = with_normals(samples, facets);
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

std::vector<WayInside> ways_inside(std::span<const BoundaryPoint> points, const Solid& solid, double tolerance) {
    std::vector<WayInside> ways;
    std::vector<BoundaryPoint> left(points.begin(), points.end());
    const auto normal_at = [](const BoundaryPoint& point) { return std::array{unit(point.inwards)}; };
    for (const double depth : kDepths) {
        left = add_ways(left, solid, depth * tolerance, normal_at, ways);
    }
    const std::vector<Point> all_around = directions_around();
    const auto around = [&](const BoundaryPoint&) { return std::span(all_around); };
    for (const double depth : kDepths) {
        left = add_ways(left, solid, depth * tolerance, around, ways);
    }
    return ways;
}

std::vector<Ball> shallow_seeds(std::span<const WayInside> ways, double tolerance) {
    std::vector<Ball> seeds(ways.size());
    std::ranges::transform(ways, seeds.begin(), [&](const WayInside& way) {
        return Ball{way.place + way.depth * way.inwards, tolerance};
    });
    return seeds;
}

std::vector<Ball> deep_seeds(std::span<const WayInside> ways, const Solid& solid, double tolerance, double limit,
                             std::int64_t& queries) {
    std::vector<Ball> seeds = shallow_seeds(ways, tolerance);
    std::vector<std::size_t> left(ways.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    for (const double reach : kReaches) {
        std::vector<Point> places(left.size());
        std::ranges::transform(left, places.begin(),
                               [&](std::size_t i) { return ways[i].place + (reach * limit) * ways[i].inwards; });
        const std::vector<std::uint8_t> is_inside = sides_of(solid, places);
        // Where nothing is closer than the bound the ball reaches the point but for the limit.
        const std::vector<double> bounds(places.size(), std::max(0.0, reach - 1.0) * limit);
        const std::vector<std::optional<Point>> nearest = nearest_of(solid, places, bounds);
        queries += std::ssize(places);
        std::vector<std::size_t> farther;
        for (std::size_t k = 0; k < left.size(); ++k) {
            if (is_inside[k] != 0 && !nearest[k]) {
                seeds[left[k]].center = places[k];
            } else {
                farther.push_back(left[k]);
            }
        }
        left = std::move(farther);
    }
    return seeds;
}

}  // namespace scaleaxis::inline v1
