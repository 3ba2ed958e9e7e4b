// SPDX-License-Identifier: GPL-3.0-or-later
#include "medial_axis/union_interior.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "medial_axis/dual_complex.hpp"
#include "medial_axis/exposed.hpp"

namespace scaleaxis {
namespace {

// Joins are taken for so much larger, relative to themselves: the distance is continuous, and points on their common
// faces must not be lost to rounding.
constexpr double kOnFace = 1e-9;

bool is_in_simplex(double u, double v, double w) {
    return u >= -kOnFace && v >= -kOnFace && w >= -kOnFace && u + v + w <= 1.0 + kOnFace;
}

// Does `p` lie in the join of a vertex of the boundary with the triangle of its three balls?
bool is_in_join(const MedialAxis& axis, Index vertex, const Point& p) {
    const Point& apex = axis.complex.boundary_vertices[vertex];
    const auto& [i, j, k] = axis.complex.boundary_vertex_balls[vertex];
    const Point a = axis.balls[i].center - apex;
    const Point b = axis.balls[j].center - apex;
    const Point c = axis.balls[k].center - apex;
    const Point x = p - apex;
    const double volume = dot(a, cross(b, c));
    return is_in_simplex(dot(x, cross(b, c)) / volume, dot(a, cross(x, c)) / volume, dot(a, cross(b, x)) / volume);
}

// The distance from `p` to the arc in whose join with the edge of two balls it lies.
std::optional<double> distance_to_arc(const UnionInterior& interior, Index ball, Index other, const Point& p) {
    const std::vector<Ball>& balls = interior.axis.balls;
    const Circle circle(balls[ball], balls[other]);
    const Point nearest = circle.toward(p - circle.center);
    const Point a = balls[ball].center - nearest;
    const Point b = balls[other].center - nearest;
    const Point x = p - nearest;
    const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), ax = dot(a, x), bx = dot(b, x);
    const double square = aa * bb - ab * ab;
    if (is_in_simplex((ax * bb - bx * ab) / square, (bx * aa - ax * ab) / square, 0.0) &&
        is_exposed(balls, interior.neighbors, ball, other, nearest)) {
        return norm(x);
    }
    return std::nullopt;
}

std::optional<double> distance_to_arcs(const UnionInterior& interior, Index ball, const Point& p) {
    for (const Index other : interior.neighbors[ball]) {
        if (const std::optional<double> distance = distance_to_arc(interior, ball, other, p)) {
            return distance;
        }
    }
    return std::nullopt;
}

// Cells are in the order of their smallest vertex, and so is the first with a ball that is near.
bool is_in_dual_complex(const DualComplex& dual, Index ball, const Point& p) {
    const std::vector<kernel::Tetrahedron>& cells = dual.triangulation.cells;
    const auto hint = std::partition_point(cells.begin(), cells.end(),
                                           [&](const kernel::Tetrahedron& cell) { return cell.vertices[0] < ball; });
    const auto first = static_cast<Index>(std::min(hint, cells.end() - 1) - cells.begin());
    const Index cell = kernel::locate(dual.triangulation, p - dual.origin, first);
    return cell != kNone && dual.has_cell[cell] != 0;
}

}  // namespace

UnionInterior union_interior(const MedialAxis& axis) {
    const std::vector<Point>& vertices = axis.complex.boundary_vertices;
    return {axis, neighbors_of_balls(*axis.dual, axis.balls.size()), axis.dual->singular_vertices,
            kernel::build_ball_tree(axis.balls),
            vertices.empty() ? kernel::PointTree{} : kernel::build_point_tree(vertices)};
}

std::optional<double> distance_to_boundary(const UnionInterior& interior, const Point& p) {
    const MedialAxis& axis = interior.axis;
    if (!interior.vertices.nodes.empty()) {
        const kernel::NearPoint nearest = kernel::nearest_point(interior.vertices, p);
        const Index vertex = interior.vertices.order[nearest.position];
        const double to_vertex = std::sqrt(nearest.squared_distance);
        if (is_in_join(axis, vertex, p)) {
            return to_vertex;
        }
        const std::array<Index, 3>& balls = axis.complex.boundary_vertex_balls[vertex];
        for (int k = 0; k < 3; ++k) {
            if (const auto distance = distance_to_arc(interior, balls[k], balls[(k + 1) % 3], p)) {
                return distance;
            }
        }
        if (is_in_dual_complex(*axis.dual, balls[0], p)) {
            return to_vertex;
        }
        for (const Index ball : balls) {
            if (const auto distance = distance_to_arcs(interior, ball, p)) {
                return distance;
            }
        }
    }
    const NearestBall deepest = kernel::nearest_ball(interior.balls, p);
    if (deepest.distance > 0.0) {
        return std::nullopt;
    }
    if (const auto distance = distance_to_arcs(interior, deepest.ball, p)) {
        return distance;
    }
    const bool has_patch = !interior.neighbors[deepest.ball].empty() ||
                           std::binary_search(interior.single.begin(), interior.single.end(), deepest.ball);
    const Ball& ball = axis.balls[deepest.ball];
    const Point outward = p - ball.center;
    const double length = norm(outward);
    const Point nearest = ball.center + ball.radius * (length > 0.0 ? (1.0 / length) * outward : Point{1, 0, 0});
    if (has_patch && is_exposed(axis.balls, interior.neighbors, deepest.ball, kNone, nearest)) {
        return -deepest.distance;
    }
    return std::nullopt;
}

}  // namespace scaleaxis
