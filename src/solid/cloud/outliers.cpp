// SPDX-License-Identifier: Apache-2.0
#include "solid/cloud/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/parallel.hpp"
#include "solid/cloud/normals.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis {
namespace {

constexpr std::size_t kDensityNeighbors = 8;

// Outliers hide others, from which they are not far.
constexpr int kRounds = 3;

// So much farther than their neighbours have theirs: worth a second look.
constexpr double kThin = 1.5;

// So much farther than half of all points have theirs, ...
constexpr double kThinnest = 3.0;
// ... and neighbours that deviate by this part of their extent from a surface.
constexpr double kThick = 0.1;

// So many standard deviations off the surface of the neighbours.
constexpr double kStrayed = 4.0;

// An outlier is farther from trusted points than so many of their spacings, ...
constexpr double kFar = 5.0;
// ... or off their surface by this part of the spacing and so many of their deviations, more where few of them tell.
constexpr double kHeight = 0.2;
double most_deviations(std::size_t neighbors) {
    return 4.0 + 24.0 / std::max(1.0, static_cast<double>(neighbors) - 6.0);
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The side of the square that a point has for itself. \param near the point itself, and the nearest others
double spacing_of(const std::vector<NearPoint>& near) {
    return std::sqrt(near.back().squared_distance * std::numbers::pi / static_cast<double>(near.size() - 1));
}

/// By positions in the tree.
std::vector<double> spacings_of(const PointTree& tree) {
    std::vector<double> result(tree.points.size());
    for_each_index(
        result.size(),
        [&](std::size_t i) {
            static thread_local std::vector<NearPoint> near;
            nearest_points(tree, tree.points[i], kDensityNeighbors + 1, near);
            result[i] = spacing_of(near);
        },
        std::size_t{256});
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
                                        std::size_t neighbors) {
    const double thinnest = kThinnest * median(spacings);
    std::vector<std::uint8_t> is_suspect(spacings.size());
    for_each_index(
        spacings.size(),
        [&](std::size_t i) {
            static thread_local std::vector<NearPoint> near;
            const LocalFit fit = fit_locally(tree, tree.points[i], neighbors, near);
            const bool is_thin = spacings[i] > kThin * typical_spacing(near, spacings);
            const bool is_thinnest = spacings[i] > thinnest && fit.residual > kThick * fit.radius;
            const bool is_off = fit.height > kHeight * spacings[i] && fit.height > kStrayed * fit.others_residual;
            is_suspect[i] = is_thin || is_thinnest || is_off ? 1 : 0;
        },
        std::size_t{64});
    return is_suspect;
}

/// What the points above suspicion say.
bool is_outlier(const PointTree& trusted, const std::vector<double>& spacings, const Point& p, std::size_t neighbors) {
    static thread_local std::vector<NearPoint> near;
    nearest_points(trusted, p, neighbors, near);
    const LocalFit fit = fit_quadric(trusted, p, near);
    const double spacing = typical_spacing(near, spacings);
    return near.front().squared_distance > (kFar * spacing) * (kFar * spacing) ||
           (fit.height > most_deviations(near.size()) * fit.others_residual && fit.height > kHeight * spacing);
}

/// Those that can be told from the others at first sight.
std::vector<std::uint8_t> find_outliers_once(const std::vector<Point>& points, std::size_t neighbors) {
    const PointTree tree = build_point_tree(points);
    const std::vector<double> spacings = spacings_of(tree);
    const std::vector<std::uint8_t> is_suspect = find_suspects(tree, spacings, neighbors);
    std::vector<Point> trusted_points;
    std::vector<double> spacings_as_given;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (is_suspect[i] == 0) {
            trusted_points.push_back(tree.points[i]);
            spacings_as_given.push_back(spacings[i]);
        }
    }
    std::vector<std::uint8_t> result(points.size());
    if (trusted_points.size() == points.size() || trusted_points.size() < neighbors) {
        return result;
    }
    const PointTree trusted = build_point_tree(trusted_points);
    std::vector<double> trusted_spacings(trusted_points.size());
    for (std::size_t i = 0; i < trusted_spacings.size(); ++i) {
        trusted_spacings[i] = spacings_as_given[trusted.order[i]];
    }
    for_each_index(
        points.size(),
        [&](std::size_t i) {
            if (is_suspect[i] != 0 && is_outlier(trusted, trusted_spacings, tree.points[i], neighbors)) {
                result[tree.order[i]] = 1;
            }
        },
        std::size_t{256});
    return result;
}

}  // namespace

std::vector<std::uint8_t> find_outliers(const std::vector<Point>& points, std::size_t neighbors) {
    std::vector<std::uint8_t> result(points.size());
    std::vector<Point> rest = points;
    std::vector<Index> indices(points.size());
    std::iota(indices.begin(), indices.end(), 0);
    for (int round = 0; round < kRounds && rest.size() > std::max(kDensityNeighbors, neighbors); ++round) {
        const std::vector<std::uint8_t> found = find_outliers_once(rest, neighbors);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < rest.size(); ++i) {
            result[indices[i]] = found[i];
            if (found[i] == 0) {
                rest[kept] = rest[i];
                indices[kept++] = indices[i];
            }
        }
        if (kept == rest.size()) {
            break;
        }
        rest.resize(kept);
        indices.resize(kept);
    }
    return result;
}

}  // namespace scaleaxis
