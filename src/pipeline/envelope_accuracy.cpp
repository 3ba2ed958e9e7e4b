// SPDX-License-Identifier: Apache-2.0
#include "pipeline/envelope_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "surface/envelope_boundary.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr double kSharpAngle = 40.0;  // degrees: flatter edges stick out of the samples around them by little
constexpr double kSeedSpacing = 3.0;  // there are ten seeds for each square of their spacing

/// Edges of parts that overlap are no boundary, and left out.
std::vector<Point> points_on_sharp_edges(const Solid& solid, double spacing) {
    std::vector<Point> points;
    const auto edges = solid.sharp_edges(kSharpAngle);
    const double rounding = kRelativeRounding * solid.bounds().diagonal();
    for (std::size_t i = 0; edges && i < edges->size(); ++i) {
        const auto& [a, b] = (*edges)[i].ends;
        const double parts = std::ceil(distance(a, b) / spacing);
        for (double k = 0.0; k <= parts; k += 1.0) {
            const Point p = a + k / std::max(parts, 1.0) * (b - a);
            if (solid.nearest(p, rounding)) {
                points.push_back(p);
            }
        }
    }
    return points;
}

}  // namespace

EnvelopeAccuracy accuracy_of(const Envelope& envelope, std::span<const Point> samples, const Solid* solid,
                             double spacing) {
    const EnvelopeBoundary boundary(envelope, spacing);
    EnvelopeAccuracy accuracy;
    auto distances = mapped<double>(
        samples.size(), [&](std::size_t i) { return boundary.distance(samples[i]); }, std::size_t{256});
    for (const double distance : distances) {
        accuracy.solid_to_envelope = std::max(accuracy.solid_to_envelope, distance);
        accuracy.mean_solid_to_envelope += distance / static_cast<double>(samples.size());
    }
    if (solid == nullptr) {
        return accuracy;
    }
    const std::vector<SurfacePoint>& points = boundary.points();
    distances.assign(points.size(), 0.0);
    const std::size_t batch = solid->batch_size();
    for_each_index((points.size() + batch - 1) / batch,
                   [&](std::size_t b) {
                       std::vector<Point> places;
                       for (std::size_t i = b * batch; i < std::min(points.size(), (b + 1) * batch); ++i) {
                           places.push_back(points[i].point);
                       }
                       const std::vector<double> bounds(places.size(), std::numeric_limits<double>::infinity());
                       std::vector<std::optional<Point>> nearest(places.size());
                       solid->nearest(places, bounds, nearest);
                       for (std::size_t i = 0; i < places.size(); ++i) {
                           distances[b * batch + i] = nearest[i] ? distance(places[i], *nearest[i]) : 0.0;
                       }
                   },
                   std::size_t{1});
    double area = 0.0;
    double sum = 0.0;
    double most = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        most = std::max(most, distances[i]);
        sum += points[i].area * distances[i];
        area += points[i].area;
    }
    accuracy.envelope_to_solid = most;
    accuracy.mean_envelope_to_solid = area > 0.0 ? sum / area : most;
    return accuracy;
}

double largest_distance_from(const Solid& solid, const Envelope& envelope, double spacing, const Execution& execution) {
    std::vector<Point> points = solid.seeds(kSeedSpacing * spacing, 0, execution);
    append(points, points_on_sharp_edges(solid, spacing));
    if (points.empty()) {
        return 0.0;
    }
    const EnvelopeBoundary boundary(envelope, spacing);
    const auto distances = mapped<double>(
        points.size(), [&](std::size_t i) { return boundary.distance(points[i]); }, std::size_t{256});
    return std::ranges::max(distances);
}

}  // namespace scaleaxis::inline v1
