// SPDX-License-Identifier: Apache-2.0
#include "balls/union/union_interior.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "balls/exposed.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Joins are taken for so much larger, relative to themselves: the distance is continuous, and points on their common
// faces must not be lost to rounding.
constexpr double kOnFace = 1e-9;

bool is_in_simplex(double u, double v, double w) {
    return u >= -kOnFace && v >= -kOnFace && w >= -kOnFace && u + v + w <= 1.0 + kOnFace;
}

// Does `p` lie in the join of a vertex of the boundary with the triangle of its three balls?
bool is_in_join(const UnionComplex& complex, Index vertex, const Point& p) {
    const Point& apex = complex.vertices.points[vertex];
    const auto& [i, j, k] = complex.vertices.balls[vertex];
    const Point a = complex.balls[i].center - apex;
    const Point b = complex.balls[j].center - apex;
    const Point c = complex.balls[k].center - apex;
    const Point x = p - apex;
    const double volume = dot(a, cross(b, c));
    return is_in_simplex(dot(x, cross(b, c)) / volume, dot(a, cross(x, c)) / volume, dot(a, cross(b, x)) / volume);
}

// The point of the arc in whose join with the edge of two balls `p` lies.
std::optional<NearBoundaryPoint> nearest_of_arc(const UnionInterior& interior, Index ball, Index other,
                                                const Point& p) {
    const std::vector<Ball>& balls = interior.complex.balls;
    const Circle circle(balls[ball], balls[other]);
    const Point nearest = circle.toward(p - circle.center);
    const Point a = balls[ball].center - nearest;
    const Point b = balls[other].center - nearest;
    const Point x = p - nearest;
    const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), ax = dot(a, x), bx = dot(b, x);
    const double square = aa * bb - ab * ab;
    if (is_in_simplex((ax * bb - bx * ab) / square, (bx * aa - ax * ab) / square, 0.0) &&
        is_exposed(balls, interior.adjacency.neighbors, ball, other, nearest)) {
        return NearBoundaryPoint{nearest, norm(x)};
    }
    return std::nullopt;
}

std::optional<NearBoundaryPoint> nearest_of_arcs(const UnionInterior& interior, Index ball, const Point& p) {
    for (const Index other : interior.adjacency.neighbors[ball]) {
        if (const auto nearest = nearest_of_arc(interior, ball, other, p)) {
            return nearest;
        }
    }
    return std::nullopt;
}

// Cells are in the order of their smallest vertex, and so is the first with a ball that is near.
bool is_in_dual_complex(const DualComplex& dual, Index ball, const Point& p) {
    const std::vector<Tetrahedron>& cells = dual.triangulation.cells;
    const auto hint = std::partition_point(cells.begin(), cells.end(),
                                           [&](const Tetrahedron& cell) { return cell.vertices[0] < ball; });
    const auto first = static_cast<Index>(std::min(hint, cells.end() - 1) - cells.begin());
    const Index cell = locate(dual.triangulation, p - dual.origin, first);
    return cell != kNone && dual.has_cell[cell] != 0;
}

}  // namespace

UnionInterior union_interior(const UnionComplex& complex, const UnionAdjacency& adjacency) {
    const std::vector<Point>& vertices = complex.vertices.points;
    return {complex, adjacency, build_ball_tree(complex.balls),
            vertices.empty() ? PointTree{} : build_point_tree(vertices)};
}

std::optional<NearBoundaryPoint> nearest_from_inside(const UnionInterior& interior, const Point& p) {
    const UnionComplex& complex = interior.complex;
    if (!interior.vertices.nodes.empty()) {
        const NearPoint nearest = nearest_point(interior.vertices, p);
        const Index vertex = interior.vertices.order[nearest.position];
        const NearBoundaryPoint to_vertex{complex.vertices.points[vertex], std::sqrt(nearest.squared_distance)};
        if (is_in_join(complex, vertex, p)) {
            return to_vertex;
        }
        const std::array<Index, 3>& balls = complex.vertices.balls[vertex];
        for (int k = 0; k < 3; ++k) {
            if (const auto on_arc = nearest_of_arc(interior, balls[k], balls[(k + 1) % 3], p)) {
                return on_arc;
            }
        }
        if (is_in_dual_complex(complex.dual, balls[0], p)) {
            return to_vertex;
        }
        for (const Index ball : balls) {
            if (const auto on_arc = nearest_of_arcs(interior, ball, p)) {
                return on_arc;
            }
        }
    }
    const NearestBall deepest = nearest_ball(interior.balls, p);
    if (deepest.distance > 0.0) {
        return std::nullopt;
    }
    if (const auto on_arc = nearest_of_arcs(interior, deepest.ball, p)) {
        return on_arc;
    }
    const std::vector<Index>& single = complex.dual.singular_vertices;
    const bool has_patch = !interior.adjacency.neighbors[deepest.ball].empty() ||
                           std::binary_search(single.begin(), single.end(), deepest.ball);
    const Ball& ball = complex.balls[deepest.ball];
    const Point outward = p - ball.center;
    const double length = norm(outward);
    const Point nearest = ball.center + ball.radius * (length > 0.0 ? (1.0 / length) * outward : Point{1, 0, 0});
    if (has_patch && is_exposed(complex.balls, interior.adjacency.neighbors, deepest.ball, kNone, nearest)) {
        return NearBoundaryPoint{nearest, -deepest.distance};
    }
    return std::nullopt;
}

}  // namespace scaleaxis::inline v1
