// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/fit.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// For each point a distance to the union that is not too small: that to the balls that touch the boundary nearby.
std::vector<double> distances_by_contacts(std::span<const Point> points, std::span<const Ball> balls,
                                          std::span<const Contacts> contacts) {
    constexpr std::size_t kContacts = 6;
    std::vector<Point> places;
    places.reserve(2 * contacts.size());
    for (const auto& [first, second] : contacts) {
        places.push_back(first);
        places.push_back(second);
    }
    const PointTree tree = build_point_tree(places);
    return mapped<double>(points.size(), [&](std::size_t i) {
        thread_local std::vector<NearPoint> near;
        nearest_points(tree, points[i], kContacts, near);
        double least = std::numeric_limits<double>::infinity();
        for (const NearPoint& contact : near) {
            const Ball& ball = balls[tree.order[contact.position] / 2];
            least = std::min(least, distance(points[i], ball.center) - ball.radius);
        }
        return std::max(0.0, least);
    });
}

}  // namespace

UnionAccuracy union_accuracy(std::span<const Ball> balls, std::span<const Contacts> contacts, const Samples& samples,
                             const Execution& execution) {
    return in_arena(execution, [&] {
        report(execution, "accuracy", 0.0);
        UnionAccuracy accuracy;
        const std::vector<double> distances = distances_by_contacts(samples.points, balls, contacts);
        for (const double each : distances) {
            accuracy.mean_distance += each / static_cast<double>(distances.size());
        }
        // To be exact it is enough to look at the farthest ones.
        const BallTree tree = build_ball_tree(balls);
        const auto order = sorted_indices(
            distances.size(), [&](Index i) { return distances[i]; }, std::greater<>());
        for (const Index i : order) {
            stop_if_cancelled();
            if (distances[i] <= accuracy.largest_distance) {
                break;
            }
            const double exact = nearest_ball(tree, samples.points[i]).distance;
            if (exact > accuracy.largest_distance) {
                accuracy.largest_distance = exact;
                accuracy.farthest_sample = samples.points[i];
            }
        }
        const auto [thinnest, thickest] = std::ranges::minmax_element(balls, {}, &Ball::radius);
        accuracy.thinnest = *thinnest;
        accuracy.thickest = *thickest;
        report(execution, "accuracy", 1.0);
        return accuracy;
    });
}

}  // namespace scaleaxis::inline v1
