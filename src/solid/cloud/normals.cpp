// SPDX-License-Identifier: GPL-3.0-or-later
#include "points/normals.hpp"

#include <CGAL/Default_diagonalize_traits.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "kernel/disjoint_sets.hpp"

namespace scaleaxis {
namespace {

// Coordinates are rounded to about this part of the extent of the points.
constexpr double kRounding = 1e-9;

/// Directions of the least, middle and largest extent of points, and their variances along these.
struct PrincipalAxes {
    Point mean;
    std::array<Point, 3> axes;
    std::array<double, 3> variances{};
};

template <class Points>
PrincipalAxes principal_axes(const Points& points) {
    PrincipalAxes result;
    const double weight = 1.0 / static_cast<double>(std::size(points));
    for (const Point& p : points) {
        result.mean = result.mean + weight * p;
    }
    std::array<double, 6> covariance{};
    for (const Point& p : points) {
        const Point d = p - result.mean;
        const std::array<double, 6> products{d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
        for (int k = 0; k < 6; ++k) {
            covariance[k] += weight * products[k];
        }
    }
    std::array<double, 9> vectors{};
    CGAL::Default_diagonalize_traits<double, 3>::diagonalize_selfadjoint_covariance_matrix(covariance, result.variances,
                                                                                           vectors);
    for (int k = 0; k < 3; ++k) {
        result.axes[k] = {vectors[3 * k], vectors[3 * k + 1], vectors[3 * k + 2]};
    }
    return result;
}

constexpr std::size_t kTerms = 6;
using Terms = std::array<double, kTerms>;

/// Solves the normal equations by Cholesky's decomposition.
Terms solved(std::array<Terms, kTerms> a, Terms b) {
    for (std::size_t i = 0; i < kTerms; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = a[i][j];
            for (std::size_t k = 0; k < j; ++k) {
                sum -= a[i][k] * a[j][k];
            }
            a[i][j] = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / a[j][j];
        }
    }
    for (std::size_t i = 0; i < kTerms; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            b[i] -= a[i][k] * b[k];
        }
        b[i] /= a[i][i];
    }
    for (std::size_t i = kTerms; i-- > 0;) {
        for (std::size_t k = i + 1; k < kTerms; ++k) {
            b[i] -= a[k][i] * b[k];
        }
        b[i] /= a[i][i];
    }
    return b;
}

}  // namespace

LocalFit fit_locally(const kernel::PointTree& tree, const Point& p, std::size_t neighbors,
                     std::vector<kernel::NearPoint>& memory) {
    kernel::nearest_points(tree, p, neighbors + 1, memory);
    LocalFit fit;
    fit.radius = std::sqrt(memory.back().squared_distance);
    std::vector<Point> local;  // in units of the radius, relative to `p`
    for (const kernel::NearPoint& near : memory) {
        local.push_back((1.0 / fit.radius) * (tree.points[near.position] - p));
    }
    const auto [normal, second, first] = principal_axes(local).axes;
    const auto terms_of = [&](const Point& q) -> Terms {
        const double u = dot(first, q);
        const double v = dot(second, q);
        return {1.0, u, v, u * u, u * v, v * v};
    };
    std::array<Terms, kTerms> matrix{};
    Terms right{};
    for (std::size_t i = 0; i < kTerms; ++i) {
        matrix[i][i] = 1e-6;  // fewer than six points, or on a conic
    }
    for (const Point& q : local) {
        const Terms terms = terms_of(q);
        for (std::size_t i = 0; i < kTerms; ++i) {
            for (std::size_t j = 0; j < kTerms; ++j) {
                matrix[i][j] += terms[i] * terms[j];
            }
            right[i] += terms[i] * dot(normal, q);
        }
    }
    const Terms quadric = solved(matrix, right);
    double squares = 0.0;
    for (const Point& q : local) {
        const Terms terms = terms_of(q);
        double height = dot(normal, q);
        for (std::size_t i = 0; i < kTerms; ++i) {
            height -= quadric[i] * terms[i];
        }
        squares += height * height;
    }
    const double freedom = std::max(1.0, static_cast<double>(local.size()) - static_cast<double>(kTerms));
    fit.residual = fit.radius * std::sqrt(squares / freedom);
    const Point gradient = normal - quadric[1] * first - quadric[2] * second;
    fit.normal = (1.0 / norm(gradient)) * gradient;
    return fit;
}

double largest_gap(const kernel::PointTree& tree, const Point& p, const Point& normal, std::size_t neighbors,
                   std::vector<kernel::NearPoint>& memory) {
    kernel::nearest_points(tree, p, neighbors + 1, memory);
    const Point u = cross(normal, std::abs(normal.x) < 0.6 ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0});
    const Point v = cross(normal, u);
    std::vector<double> angles;
    for (const kernel::NearPoint& near : memory) {
        if (const Point d = tree.points[near.position] - p; d != Point{}) {
            angles.push_back(std::atan2(dot(v, d), dot(u, d)));
        }
    }
    std::ranges::sort(angles);
    double gap = angles.front() + 2.0 * std::numbers::pi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) {
        gap = std::max(gap, angles[i] - angles[i - 1]);
    }
    return gap;
}

IndexLists connected_parts(const kernel::PointTree& tree, std::span<const Point> points, std::size_t neighbors) {
    DisjointSets sets(static_cast<Index>(points.size()));
    std::vector<kernel::NearPoint> near;
    for (std::size_t i = 0; i < points.size(); ++i) {
        kernel::nearest_points(tree, points[i], neighbors + 1, near);
        for (const kernel::NearPoint& other : near) {
            sets.join(static_cast<Index>(i), tree.order[other.position]);
        }
    }
    std::vector<Index> part_of_set(points.size(), kNone);
    std::vector<std::vector<Index>> parts;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Index& part = part_of_set[sets.find(static_cast<Index>(i))];
        if (part == kNone) {
            part = static_cast<Index>(parts.size());
            parts.emplace_back();
        }
        parts[part].push_back(static_cast<Index>(i));
    }
    IndexLists result;
    for (const std::vector<Index>& part : parts) {
        result.push_back(part);
    }
    return result;
}

void orient_consistently(std::span<const Point> points, std::span<const Index> part, std::size_t neighbors,
                         std::vector<Point>& normals) {
    using Geometry = CGAL::Simple_cartesian<double>;
    using Item = std::tuple<Geometry::Point_3, Geometry::Vector_3, Index>;
    std::vector<Item> items;
    for (const Index i : part) {
        const auto& [x, y, z] = points[i];
        const auto& [a, b, c] = normals[i];
        items.emplace_back(Geometry::Point_3(x, y, z), Geometry::Vector_3(a, b, c), i);
    }
    CGAL::mst_orient_normals(items, static_cast<unsigned>(std::min(neighbors, items.size() - 1)),
                             CGAL::parameters::point_map(CGAL::Nth_of_tuple_property_map<0, Item>())
                                 .normal_map(CGAL::Nth_of_tuple_property_map<1, Item>()));
    for (const auto& [point, normal, i] : items) {
        normals[i] = {normal.x(), normal.y(), normal.z()};
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
    return length <= kRounding * extent || std::ranges::all_of(points, [&](const Point& p) {
               return std::abs(dot(normal, p - a)) <= kRounding * extent * length;
           });
}

}  // namespace scaleaxis
