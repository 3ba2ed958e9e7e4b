// SPDX-License-Identifier: Apache-2.0
#include "balls/inward_seeds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "sampling/restricted_facets.hpp"

namespace scaleaxis::inline v1 {
namespace {

// How far inside an way leads, in units of the sampling tolerance: the second distance is for parts thinner than the
// first.
constexpr std::array<double, 2> kDepths{0.05, 0.005};

// Directions to try for the one inwards: about 14 degrees apart.
constexpr std::size_t kDirections = 256;

// How far inside deep seeds are tried, in units of the limit. Along the middle of a right angle the inscribed ball at
// 3.4 limits comes as near to the edge as it may.
constexpr std::array<double, 5> kReaches{8.0, 4.0, 2.0, 1.0, 0.5};

/// Unit vectors, evenly spread: points of a spiral on the sphere, a golden angle apart.
std::vector<Point> directions_around() {
    std::vector<Point> directions(kDirections);
    for (std::size_t i = 0; i < kDirections; ++i) {
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / kDirections;
        const auto [cosine, sine] = on_circle(static_cast<double>(i) / std::numbers::phi);
        const double across = std::sqrt(1.0 - z * z);
        directions[i] = {across * cosine, across * sine, z};
    }
    return directions;
}

}  // namespace

std::vector<Point> points_at_facets(const Samples& samples, const Solid& solid,
                                    const std::function<bool(const Point&)>& is_wanted, std::int64_t& queries) {
    std::vector<Point> centroids;
    for (const RestrictedFacet& facet : restricted_facets(samples)) {
        const auto [a, b, c] = vertices_of(samples, facet);
        const Point centroid = (1.0 / 3.0) * (samples.points[a] + samples.points[b] + samples.points[c]);
        if (is_wanted(centroid)) {
            centroids.push_back(centroid);
        }
    }
    const std::vector<double> bounds(centroids.size(), kInfinity);
    std::vector<Point> points;
    for (const std::optional<Point>& nearest : nearest_of(solid, centroids, bounds)) {
        if (nearest) {
            points.push_back(*nearest);
        }
    }
    queries += std::ssize(centroids);
    return points;
}

std::vector<WayInside> ways_inside(std::vector<Point> points, const Solid& solid, double tolerance) {
    const std::vector<Point> directions = directions_around();
    std::vector<WayInside> ways;
    for (const double part : kDepths) {
        const double depth = part * tolerance;
        std::vector<Point> places;
        for (const Point& point : points) {
            for (const Point& direction : directions) {
                places.push_back(point + depth * direction);
            }
        }
        const std::vector<std::uint8_t> is_inside = sides_of(solid, places);
        std::vector<Point> left;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::span<const std::uint8_t> inside =
                std::span(is_inside).subspan(i * directions.size(), directions.size());
            Point sum;
            for (std::size_t k = 0; k < directions.size(); ++k) {
                sum = sum + (inside[k] != 0 ? 1.0 : 0.0) * directions[k];
            }
            std::size_t middle = 0;
            double most = -kInfinity;
            for (std::size_t k = 0; k < directions.size(); ++k) {
                if (inside[k] != 0 && dot(sum, directions[k]) > most) {
                    middle = k;
                    most = dot(sum, directions[k]);
                }
            }
            if (inside[middle] != 0) {
                ways.push_back({points[i], directions[middle], depth});
            } else {
                left.push_back(points[i]);
            }
        }
        points = std::move(left);
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
        const auto places =
            each_of<Point>(left, [&](std::size_t i) { return ways[i].place + (reach * limit) * ways[i].inwards; });
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
