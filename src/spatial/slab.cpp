// SPDX-License-Identifier: Apache-2.0
#include "spatial/slab.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scaleaxis {
namespace {

// Below this squared sine of the angle between its sides a triangle has no plane to speak of: its cones stand for it.
constexpr double kFlat = 1e-20;

// Gradients closer to 1 than this would put contacts anywhere.
constexpr double kSteep = 1.0 - 1e-12;

SlabBall near_ball(const Ball& ball, const Point& p) { return {ball, distance(ball.center, p) - ball.radius}; }

Ball interpolated(const Ball& a, const Ball& b, double t) {
    return {a.center + t * (b.center - a.center), a.radius + t * (b.radius - a.radius)};
}

SlabBall nearest_on_cone(const Ball& a, const Ball& b, const Point& p) {
    const Point direction = b.center - a.center;
    const double squared_length = squared_norm(direction);
    const double growth = b.radius - a.radius;
    const double flank = squared_length - growth * growth;  // of the cone, times the squared length
    if (!(flank > (1.0 - kSteep) * squared_length)) {
        return near_ball(growth > 0.0 ? b : a, p);  // one end holds the other
    }
    const Point q = p - a.center;
    const double along = dot(q, direction) / squared_length;
    const double height = norm(q - along * direction);
    const double t = along + height * growth / std::sqrt(squared_length * flank);
    return near_ball(t <= 0.0 ? a : t >= 1.0 ? b : interpolated(a, b, t), p);
}

}  // namespace

Slab::Slab(std::span<const Ball> balls) : size(static_cast<int>(balls.size())) {
    std::ranges::copy(balls, corners.begin());
}

std::optional<SlabShape> shape_of(const Slab& slab) {
    const auto& [a, b, c] = slab.corners;
    const Point u = b.center - a.center;
    const double du = b.radius - a.radius;
    const double uu = squared_norm(u);
    SlabShape shape;
    if (slab.size == 2) {
        if (!(uu > 0.0)) {
            return std::nullopt;
        }
        shape.gradient = (du / uu) * u;
    } else {
        const Point v = c.center - a.center;
        const double dv = c.radius - a.radius;
        const double vv = squared_norm(v);
        const double uv = dot(u, v);
        const Point normal = cross(u, v);
        const double determinant = squared_norm(normal);
        if (!(determinant > kFlat * uu * vv)) {
            return std::nullopt;
        }
        shape.gradient = ((vv * du - uv * dv) / determinant) * u + ((uu * dv - uv * du) / determinant) * v;
        shape.normal = (1.0 / std::sqrt(determinant)) * normal;
    }
    const double square = squared_norm(shape.gradient);
    if (!(square < kSteep)) {
        return std::nullopt;
    }
    shape.flank = std::sqrt(1.0 - square);
    return shape;
}

SlabBall nearest_ball(const Slab& slab, const Point& p) {
    const auto& [a, b, c] = slab.corners;
    if (slab.size == 1) {
        return near_ball(a, p);
    }
    if (slab.size == 2) {
        return nearest_on_cone(a, b, p);
    }
    // The centre lies up the gradient from the foot of the point. If it is beyond the border, the best ball is on one
    // of the sides that it is beyond.
    std::array<bool, 3> may_be_on{true, true, true};
    if (const auto shape = shape_of(slab)) {
        const double height = dot(p - a.center, shape->normal);
        const Point center = p - height * shape->normal + (std::abs(height) / shape->flank) * shape->gradient;
        for (int k = 0; k < 3; ++k) {
            const Point& from = slab.corners[k].center;
            const Point& to = slab.corners[(k + 1) % 3].center;
            may_be_on[k] = dot(cross(to - from, center - from), shape->normal) < 0.0;
        }
        if (may_be_on == std::array{false, false, false}) {
            return near_ball({center, a.radius + dot(center - a.center, shape->gradient)}, p);
        }
    }
    SlabBall nearest{{}, std::numeric_limits<double>::infinity()};
    for (int k = 0; k < 3; ++k) {
        if (may_be_on[k]) {
            const SlabBall near = nearest_on_cone(slab.corners[k], slab.corners[(k + 1) % 3], p);
            nearest = near.distance < nearest.distance ? near : nearest;
        }
    }
    return nearest;
}

}  // namespace scaleaxis
