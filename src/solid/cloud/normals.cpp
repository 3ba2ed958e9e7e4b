// SPDX-License-Identifier: Apache-2.0
#include "solid/cloud/normals.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <tuple>
#include <vector>

#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"

namespace scaleaxis::inline v1 {
namespace {

Eigen::Vector3d to_eigen(const Point& p) { return {p.x, p.y, p.z}; }

/// Directions of the least, middle and largest variance of points around their mean.
std::array<Point, 3> principal_axes(std::span<const Point> points) {
    const double weight = 1.0 / static_cast<double>(points.size());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Point& p : points) {
        mean += weight * to_eigen(p);
    }
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Point& p : points) {
        const Eigen::Vector3d d = to_eigen(p) - mean;
        covariance += weight * d * d.transpose();
    }
    const Eigen::Matrix3d vectors = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
    std::array<Point, 3> axes;
    for (int k = 0; k < 3; ++k) {
        axes[k] = {vectors(0, k), vectors(1, k), vectors(2, k)};
    }
    return axes;
}

// In standard deviations: points that lie off the surface by less may lie there by noise.
constexpr double kNoise = 3.0;

/// Coefficients of a quadric over a plane: of 1, u, v, u², uv, v².
constexpr int kTerms = 6;
using Terms = Eigen::Vector<double, kTerms>;

}  // namespace

LocalFit fit_locally(const PointTree& tree, const Point& p, std::size_t neighbors, std::vector<NearPoint>& memory) {
    nearest_points(tree, p, neighbors + 1, memory);
    return fit_quadric(tree, p, memory);
}

LocalFit fit_quadric(const PointTree& tree, const Point& p, std::span<const NearPoint> neighbors) {
    LocalFit fit;
    fit.radius = std::sqrt(neighbors.back().squared_distance);
    static thread_local std::vector<Point> local;  // in units of the radius, relative to `p`
    local.clear();
    for (const NearPoint& near : neighbors) {
        local.push_back((1.0 / fit.radius) * (tree.points[near.position] - p));
    }
    const std::array<Point, 3> axes = principal_axes(local);
    const Point& normal = axes[0];
    const Point& second = axes[1];
    const Point& first = axes[2];
    const auto terms_of = [&](const Point& q) -> Terms {
        const double u = dot(first, q);
        const double v = dot(second, q);
        return {1.0, u, v, u * u, u * v, v * v};
    };
    // Least squares by the normal equations. The small diagonal is for fewer than six points, or for points on a conic.
    Eigen::Matrix<double, kTerms, kTerms> matrix = 1e-6 * Eigen::Matrix<double, kTerms, kTerms>::Identity();
    Terms right = Terms::Zero();
    for (const Point& q : local) {
        const Terms terms = terms_of(q);
        matrix += terms * terms.transpose();
        right += dot(normal, q) * terms;
    }
    const auto factors = matrix.llt();
    const Terms quadric = factors.solve(right);
    double squares = 0.0;
    for (const Point& q : local) {
        const double height = dot(normal, q) - quadric.dot(terms_of(q));
        squares += height * height;
    }
    const double freedom = std::max(1.0, static_cast<double>(local.size()) - static_cast<double>(kTerms));
    fit.residual = fit.radius * std::sqrt(squares / freedom);
    if (neighbors.front().squared_distance == 0.0) {
        // Without `p`, whose terms are 1, 0, 0, ...: what leaving out one row changes in least squares.
        const double others = std::max(1e-6, 1.0 - factors.solve(Terms::Unit(0))[0]);
        const double without = std::max(0.0, squares - quadric[0] * quadric[0] / others);
        fit.height = fit.radius * std::abs(quadric[0]) / others;
        fit.others_residual = fit.radius * std::sqrt(without / std::max(1.0, freedom - 1.0));
    } else {
        fit.height = fit.radius * std::abs(quadric[0]);
        fit.others_residual = fit.residual;
    }
    const Point gradient = normal - quadric[1] * first - quadric[2] * second;
    fit.normal = (1.0 / norm(gradient)) * gradient;
    return fit;
}

double largest_gap(const PointTree& tree, const Point& p, const Point& normal, std::size_t neighbors,
                   std::vector<NearPoint>& memory) {
    nearest_points(tree, p, neighbors + 1, memory);
    const Point u = cross(normal, std::abs(normal.x) < 0.6 ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0});
    const Point v = cross(normal, u);
    std::vector<double> angles;
    for (const NearPoint& near : memory) {
        if (const Point d = tree.points[near.position] - p; d != Point{}) {
            angles.push_back(signed_angle_of(dot(u, d), dot(v, d)));
        }
    }
    std::ranges::sort(angles);
    double gap = angles.front() + 2.0 * std::numbers::pi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) {
        gap = std::max(gap, angles[i] - angles[i - 1]);
    }
    return gap;
}

IndexLists connected_parts(const PointTree& tree, std::span<const Point> points, std::size_t neighbors) {
    DisjointSets sets(static_cast<Index>(points.size()));
    std::vector<NearPoint> near;
    CancellationPoint stop;
    for (std::size_t i = 0; i < points.size(); ++i, stop()) {
        nearest_points(tree, points[i], neighbors + 1, near);
        for (const NearPoint& other : near) {
            sets.join(static_cast<Index>(i), tree.order[other.position]);
        }
    }
    const std::pair<std::vector<Index>, Index> part_of = sets.numbered();
    return grouped(static_cast<std::size_t>(part_of.second), [&](const auto& add) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            add(part_of.first[i], static_cast<Index>(i));
        }
    });
}

void orient_consistently(std::span<const Point> points, std::span<const Index> part, std::span<const double> noise,
                         std::size_t neighbors, std::vector<Point>& normals) {
    const auto size = static_cast<Index>(part.size());
    const auto places = each_of<Point>(part, [&](Index i) { return points[i]; });
    const PointTree tree = build_point_tree(places);
    std::vector<std::array<Index, 2>> edges;
    std::vector<NearPoint> near;
    CancellationPoint stop;
    for (Index i = 0; i < size; ++i, stop()) {
        nearest_points(tree, places[i], neighbors + 1, near);
        for (const NearPoint& other : near) {
            if (const Index j = tree.order[other.position]; j != i) {
                edges.push_back({i, j});
            }
        }
    }
    const IndexLists graph = grouped_both_ways(part.size(), edges);

    // R. C. Prim's algorithm from the highest point, whose normal is to point upwards. The shortest edges are those at
    // which the normal is most nearly what the one before leads to.
    const auto normal = [&](Index i) -> Point& { return normals[part[i]]; };
    // That of a circle through both points: from one side of a thin part to the other it turns around. What is noise
    // leads nowhere.
    const auto led_to = [&](Index from, Index to) {
        const Point step = places[to] - places[from];
        const double most = kNoise * noise[part[from]];
        const Point way = step - std::clamp(dot(normal(from), step), -most, most) * normal(from);
        const double square = squared_norm(way);
        return square > 0.0 ? normal(from) - (2.0 * dot(normal(from), way) / square) * way : normal(from);
    };
    using Edge = std::tuple<double, Index, Index>;  // length, from, to
    std::priority_queue<Edge, std::vector<Edge>, std::greater<>> queue;
    const Index top = static_cast<Index>(std::ranges::max_element(places, {}, &Point::z) - places.begin());
    std::vector<bool> is_oriented(part.size(), false);
    const auto add = [&](Index i, bool is_flipped) {
        is_oriented[i] = true;
        if (is_flipped) {
            normal(i) = -1.0 * normal(i);
        }
        for (const Index j : graph[i]) {
            if (!is_oriented[j]) {
                queue.emplace(1.0 - std::abs(dot(led_to(i, j), normal(j))), i, j);
            }
        }
    };
    add(top, normal(top).z < 0.0);
    for (; !queue.empty(); stop()) {
        const auto [length, from, to] = queue.top();
        queue.pop();
        if (!is_oriented[to]) {
            add(to, dot(led_to(from, to), normal(to)) < 0.0);
        }
    }
}

bool are_coplanar(std::span<const Point> points) {
    const auto farthest = [&](const auto& height) { return *std::ranges::max_element(points, {}, height); };
    const Point a = points.front();
    const Point b = farthest([&](const Point& p) { return squared_distance(a, p); });
    const Point along = (1.0 / std::max(distance(a, b), std::numeric_limits<double>::min())) * (b - a);
    const Point c = farthest([&](const Point& p) { return squared_norm(cross(along, p - a)); });
    const Point normal = cross(along, c - a);
    const double extent = distance(a, b);
    const double length = norm(normal);
    return length <= kRelativeRounding * extent || std::ranges::all_of(points, [&](const Point& p) {
               return std::abs(dot(normal, p - a)) <= kRelativeRounding * extent * length;
           });
}

}  // namespace scaleaxis::inline v1
