// SPDX-License-Identifier: Apache-2.0
#include "solid/cloud/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "solid/cloud/normals.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::size_t kDensityNeighbors = 8;

// A point is far if it is farther from the middle of the cloud than half of all points, by this factor: a tenth of
// 2^20, the resolution of a tree's boxes.
constexpr double kFarthest = 1e5;

// Outliers hide others, from which they are not far.
constexpr int kRounds = 3;

// Points with spacings larger than those of their neighbours by this factor are worth a second look.
constexpr double kThin = 1.5;

// So are those with spacings larger than the median by this factor, ...
constexpr double kThinnest = 3.0;
// ... and neighbours that deviate by this part of their extent from a surface.
constexpr double kThick = 0.1;

// ... and those this many standard deviations off the surface of the neighbours.
constexpr double kStrayed = 4.0;

// An outlier is farther from trusted points than this multiple of their spacing, ...
constexpr double kFarSpacings = 5.0;
// ... or off their surface by this part of the spacing and by `most_deviations`, more where few neighbours tell.
constexpr double kHeight = 0.2;
double most_deviations(std::size_t neighbors) {
    return 4.0 + 24.0 / std::max(1.0, static_cast<double>(neighbors) - 6.0);
}

/// The side of the square that a point has for itself. \param near the point itself, and the nearest others
double spacing_of(const std::vector<NearPoint>& near) {
    return std::sqrt(near.back().squared_distance * std::numbers::pi / static_cast<double>(near.size() - 1));
}

/// The spacing of the tree's points at other points, each of which is one of them.
std::vector<double> spacings_at(const std::vector<Point>& points, const PointTree& tree) {
    return mapped<double>(
        points.size(),
        [&](std::size_t i) {
            static thread_local std::vector<NearPoint> near;
            nearest_points(tree, points[i], kDensityNeighbors + 1, near);
            return spacing_of(near);
        },
        std::size_t{256});
}

/// Values by position in the tree. \param values as the points were given
std::vector<double> in_order_of(const PointTree& tree, const std::vector<double>& values) {
    std::vector<double> result(values.size());
    std::ranges::transform(tree.order, result.begin(), [&](Index i) { return values[i]; });
    return result;
}

double typical_spacing(const std::vector<NearPoint>& near, const std::vector<double>& spacings) {
    std::vector<double> around;
    for (std::size_t k = 0; k <= std::min(kDensityNeighbors, near.size() - 1); ++k) {
        around.push_back(spacings[near[k].position]);
    }
    return median(std::move(around));
}

/// By positions in the tree.
std::vector<std::uint8_t> find_suspects(const PointTree& tree, const std::vector<double>& spacings,
                                        const std::vector<double>& given_spacings, std::size_t neighbors) {
    const double thinnest = kThinnest * median(given_spacings);
    return mapped<std::uint8_t>(
        spacings.size(),
        [&](std::size_t i) {
            static thread_local std::vector<NearPoint> near;
            const LocalFit fit = fit_locally(tree, tree.points[i], neighbors, near);
            const bool is_thin = given_spacings[i] > kThin * typical_spacing(near, given_spacings);
            const bool is_thinnest = given_spacings[i] > thinnest && fit.residual > kThick * fit.radius;
            const bool is_off = fit.height > kHeight * spacings[i] && fit.height > kStrayed * fit.others_residual;
            return is_thin || is_thinnest || is_off ? 1 : 0;
        },
        std::size_t{64});
}

/// What the points above suspicion say.
bool is_outlier(const PointTree& trusted, const std::vector<double>& spacings, const Point& p, std::size_t neighbors) {
    static thread_local std::vector<NearPoint> near;
    nearest_points(trusted, p, neighbors, near);
    const LocalFit fit = fit_quadric(trusted, p, near);
    const double spacing = typical_spacing(near, spacings);
    return near.front().squared_distance > (kFarSpacings * spacing) * (kFarSpacings * spacing) ||
           (fit.height > most_deviations(near.size()) * fit.others_residual && fit.height > kHeight * spacing);
}

/// Those that can be told from the others at first sight.
/// \param given_spacings those of all points around each, also of points that were thinned out
std::vector<std::uint8_t> find_outliers_once(const PointTree& tree, const std::vector<double>& spacings,
                                             const std::vector<double>& given_spacings, std::size_t neighbors) {
    const std::vector<Point>& points = tree.points;
    const std::vector<std::uint8_t> is_suspect = find_suspects(tree, spacings, given_spacings, neighbors);
    std::vector<Point> trusted_points;
    std::vector<double> spacings_of_trusted;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (is_suspect[i] == 0) {
            trusted_points.push_back(points[i]);
            spacings_of_trusted.push_back(spacings[i]);
        }
    }
    std::vector<std::uint8_t> result(points.size());
    if (trusted_points.size() == points.size() || trusted_points.size() < neighbors) {
        return result;
    }
    const PointTree trusted = build_point_tree(trusted_points);
    const std::vector<double> trusted_spacings = in_order_of(trusted, spacings_of_trusted);
    for_each_index(
        points.size(),
        [&](std::size_t i) {
            if (is_suspect[i] != 0 && is_outlier(trusted, trusted_spacings, points[i], neighbors)) {
                result[tree.order[i]] = 1;
            }
        },
        std::size_t{256});
    return result;
}

}  // namespace

std::vector<std::uint8_t> find_far_points(std::span<const Point> points) {
    std::vector<std::uint8_t> result(points.size());
    if (points.size() <= kDensityNeighbors) {
        return result;
    }
    const auto typical = [&](const auto& value) { return median(each_of<double>(points, value)); };
    const Point center{typical(&Point::x), typical(&Point::y), typical(&Point::z)};
    const auto from_center = [&](const Point& p) { return distance(p, center); };
    const double far = kFarthest * typical(from_center);
    std::ranges::transform(points, result.begin(), [&](const Point& p) { return from_center(p) > far ? 1 : 0; });
    return result;
}

std::vector<std::uint8_t> find_outliers(const std::vector<Point>& points, const std::vector<Point>& given,
                                        std::size_t neighbors) {
    std::vector<std::uint8_t> result(points.size());
    const bool is_thinned = points.size() < given.size();
    std::vector<double> given_spacings;
    if (is_thinned) {
        given_spacings = spacings_at(points, build_point_tree(given));
    }
    std::vector<Point> rest = points;
    std::vector<Index> indices(points.size());
    std::iota(indices.begin(), indices.end(), 0);
    for (int round = 0; round < kRounds && rest.size() > std::max(kDensityNeighbors, neighbors); ++round) {
        const PointTree tree = build_point_tree(rest);
        const std::vector<double> spacings = spacings_at(tree.points, tree);
        const std::vector<std::uint8_t> found =
            find_outliers_once(tree, spacings, is_thinned ? in_order_of(tree, given_spacings) : spacings, neighbors);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < rest.size(); ++i) {
            result[indices[i]] = found[i];
            if (found[i] == 0) {
                rest[kept] = rest[i];
                indices[kept] = indices[i];
                if (is_thinned) {
                    given_spacings[kept] = given_spacings[i];
                }
                ++kept;
            }
        }
        if (kept == rest.size()) {
            break;
        }
        rest.resize(kept);
        indices.resize(kept);
        given_spacings.resize(is_thinned ? kept : 0);
    }
    return result;
}

}  // namespace scaleaxis::inline v1
