// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/slab_quadric.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/numbers.hpp"
#include "spatial/mesh_parts.hpp"

namespace scaleaxis::inline v1 {

void SlabQuadric::add_plane(const Point& normal, const Ball& ball, double plane_weight) {
    const Eigen::Vector4d n(normal.x, normal.y, normal.z, 1.0);
    const double offset = dot(normal, ball.center) + ball.radius;
    a += plane_weight * n * n.transpose();
    b -= plane_weight * offset * n;
    c += plane_weight * offset * offset;
    weight += plane_weight;
}

SlabQuadric& SlabQuadric::operator+=(const SlabQuadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
    weight += other.weight;
    return *this;
}

double SlabQuadric::operator()(const Ball& ball) const {
    const Eigen::Vector4d x(ball.center.x, ball.center.y, ball.center.z, ball.radius);
    return std::max(0.0, x.dot(a * x + 2.0 * b) + c);
}

Ball SlabQuadric::least(const Ball& guess) const {
    if (!(weight > 0.0)) {
        return guess;
    }
    const Eigen::Vector4d x(guess.center.x, guess.center.y, guess.center.z, guess.radius);
    // A unit of distance from the guess hardly counts beside a plane of all the weight.
    const Eigen::Matrix4d pulled = a + kNegligible * weight * Eigen::Matrix4d::Identity();
    const Eigen::Vector4d step = pulled.ldlt().solve(-(a * x + b));
    const Eigen::Vector4d best = x + step;
    return {{best[0], best[1], best[2]}, std::max(0.0, best[3])};
}

SlabQuadric quadric_of(const Slab& slab) {
    SlabQuadric quadric;
    const auto shape = shape_of(slab);
    if (!shape || shape->flank < kLeastSine) {
        return quadric;
    }
    const auto& [a, b, c] = slab.corners;
    if (slab.size == 3) {
        const double area = triangle_area(a.center, b.center, c.center);
        for (const double side : {-1.0, 1.0}) {
            quadric.add_plane(side * shape->flank * shape->normal - shape->gradient, a, area);
        }
    } else {
        const Point direction = b.center - a.center;
        const Point other = std::abs(direction.x) < 0.6 * norm(direction) ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0};
        const Point first = unit(cross(direction, other));
        const Point second = unit(cross(direction, first));
        const double area = 0.5 * squared_norm(direction);
        for (const Point& side : {first, second, -1.0 * first, -1.0 * second}) {
            quadric.add_plane(shape->flank * side - shape->gradient, a, area);
        }
    }
    return quadric;
}

SlabQuadric border_quadric(const Slab& slab) {
    SlabQuadric quadric;
    const auto& [a, b, c] = slab.corners;
    const auto cone = shape_of(Slab(std::array{a, b}));
    const auto shape = shape_of(slab);
    if (!cone || !shape || cone->flank < kLeastSine) {
        return quadric;
    }
    const Point direction = b.center - a.center;
    Point outwards = unit(cross(shape->normal, direction));
    if (dot(outwards, c.center - a.center) > 0.0) {
        outwards = -1.0 * outwards;
    }
    quadric.add_plane(cone->flank * outwards - cone->gradient, a, 0.5 * squared_norm(direction));
    return quadric;
}

}  // namespace scaleaxis::inline v1
