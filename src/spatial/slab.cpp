// SPDX-License-Identifier: Apache-2.0
#include "spatial/slab.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/numbers.hpp"

namespace scaleaxis::inline v1 {
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

GrownBall grown_ball(const Ball& ball, const Point& p) {
    return {ball, ball.radius > 0.0 ? distance(ball.center, p) / ball.radius : kInfinity};
}

// A simplex as a point sees it: where its foot is, how high it is above it, and what the radius is there, as if the
// simplex went on beyond its border.
struct View {
    double squared_height = 0.0;
    double radius = 0.0;  // at the foot
};

// How far up the gradient from the foot the ball lies that must grow least; nothing if the radius there is not
// positive.
std::optional<double> way_to_least_grown(const View& view, double slope) {
    return view.radius > 0.0 ? std::optional(slope * view.squared_height / view.radius) : std::nullopt;
}

// The balls up the gradient from the foot, at `from` to `to`, that reach the point once they have grown.
struct Reach {
    double from = 0.0;
    double to = 0.0;
    bool is_bounded = true;  // or all reach it, from some place on, if the simplex goes on for ever
};

std::optional<Reach> reach(const View& view, double slope, double growth) {
    const double square = growth * growth;
    const double flank = 1.0 - square * slope * slope;
    if (!(flank > 1.0 - kSteep)) {
        return Reach{.is_bounded = false};
    }
    const double root = square * view.radius * view.radius - flank * view.squared_height;
    if (!(root >= 0.0) || !(view.radius > 0.0)) {
        return std::nullopt;
    }
    const double middle = square * view.radius * slope;
    const double width = growth > 0.0 ? std::sqrt(root) : 0.0;
    return Reach{(middle - width) / flank, (middle + width) / flank};
}

View view_of_cone(const Ball& a, const Ball& b, const Point& p, double length, double& foot) {
    const Point direction = (1.0 / length) * (b.center - a.center);
    foot = dot(p - a.center, direction);
    return {squared_norm(p - a.center - foot * direction), a.radius + foot * (b.radius - a.radius) / length};
}

GrownBall least_grown_on_cone(const Ball& a, const Ball& b, const Point& p) {
    const double length = distance(a.center, b.center);
    if (!(length > 0.0)) {
        return grown_ball(b.radius > a.radius ? b : a, p);
    }
    double foot = 0.0;
    const View view = view_of_cone(a, b, p, length, foot);
    const double slope = (b.radius - a.radius) / length;
    const auto way = way_to_least_grown(view, slope);
    if (!way) {
        return grown_ball(b.radius > a.radius ? b : a, p);
    }
    const double t = (foot + *way) / length;
    return grown_ball(t <= 0.0 ? a : t >= 1.0 ? b : interpolated(a, b, t), p);
}

std::optional<Ball> if_reaching(const Ball& ball, const Point& p, double growth) {
    const bool is_reaching =
        ball.radius >= 0.0 && squared_distance(ball.center, p) <= growth * growth * ball.radius * ball.radius;
    return is_reaching ? std::optional(ball) : std::nullopt;
}

std::optional<Ball> largest_on_cone(const Ball& first, const Ball& second, const Point& p, double growth) {
    const auto& [a, b] = first.radius <= second.radius ? std::tie(first, second) : std::tie(second, first);
    if (const auto largest = if_reaching(b, p, growth)) {
        return largest;
    }
    const double length = distance(a.center, b.center);
    if (!(length > 0.0)) {
        return std::nullopt;
    }
    double foot = 0.0;
    const View view = view_of_cone(a, b, p, length, foot);
    const auto found = reach(view, (b.radius - a.radius) / length, growth);
    if (!found || !found->is_bounded) {
        return std::nullopt;  // where it is not bounded, `b` is the first to reach the point
    }
    const double to = foot + found->to;
    if (to < 0.0 || to > length || foot + found->from > length) {
        return std::nullopt;
    }
    return interpolated(a, b, to / length);
}

// The sides of a triangle that a point of its plane is beyond.
std::array<bool, 3> sides_beyond(const Slab& slab, const Point& normal, const Point& center) {
    std::array<bool, 3> is_beyond{};
    for (int k = 0; k < 3; ++k) {
        const Point& from = slab.corners[k].center;
        const Point& to = slab.corners[(k + 1) % 3].center;
        is_beyond[k] = dot(cross(to - from, center - from), normal) < 0.0;
    }
    return is_beyond;
}

constexpr std::array kNoSide{false, false, false};
constexpr std::array kAnySide{true, true, true};

View view_of_slab(const Slab& slab, const SlabShape& shape, const Point& p, Point& foot) {
    const Point& a = slab.corners[0].center;
    const double height = dot(p - a, shape.normal);
    foot = p - height * shape.normal;
    return {height * height, slab.corners[0].radius + dot(foot - a, shape.gradient)};
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

std::optional<std::array<Point, 2>> contact_directions(const Slab& slab) {
    const std::optional<SlabShape> shape = shape_of(slab);
    if (!shape) {
        return std::nullopt;
    }
    const Point aside = shape->flank * shape->normal;
    return std::array{aside - shape->gradient, -1.0 * aside - shape->gradient};
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
    std::array<bool, 3> may_be_on = kAnySide;
    if (const auto shape = shape_of(slab)) {
        const double height = dot(p - a.center, shape->normal);
        const Point center = p - height * shape->normal + (std::abs(height) / shape->flank) * shape->gradient;
        may_be_on = sides_beyond(slab, shape->normal, center);
        if (may_be_on == kNoSide) {
            return near_ball({center, a.radius + dot(center - a.center, shape->gradient)}, p);
        }
    }
    SlabBall nearest{{}, kInfinity};
    for (int k = 0; k < 3; ++k) {
        if (may_be_on[k]) {
            const SlabBall near = nearest_on_cone(slab.corners[k], slab.corners[(k + 1) % 3], p);
            nearest = near.distance < nearest.distance ? near : nearest;
        }
    }
    return nearest;
}

GrownBall least_grown_ball(const Slab& slab, const Point& p) {
    const auto& [a, b, c] = slab.corners;
    if (slab.size == 1) {
        return grown_ball(a, p);
    }
    if (slab.size == 2) {
        return least_grown_on_cone(a, b, p);
    }
    std::array<bool, 3> may_be_on = kAnySide;
    if (const auto shape = shape_of(slab)) {
        Point foot;
        const View view = view_of_slab(slab, *shape, p, foot);
        if (const auto way = way_to_least_grown(view, 1.0)) {
            const Point center = foot + *way * shape->gradient;
            may_be_on = sides_beyond(slab, shape->normal, center);
            if (may_be_on == kNoSide) {
                return grown_ball({center, a.radius + dot(center - a.center, shape->gradient)}, p);
            }
        }
    }
    GrownBall least{{}, kInfinity};
    for (int k = 0; k < 3; ++k) {
        if (may_be_on[k]) {
            const GrownBall grown = least_grown_on_cone(slab.corners[k], slab.corners[(k + 1) % 3], p);
            least = grown.growth < least.growth ? grown : least;
        }
    }
    return least;
}

double least_distance_bound(const Slab& slab, const Point& p) {
    constexpr std::array kPart{1.0, 1.0, 1.0 / 2.0, 1.0 / 3.0};
    Point sum = slab.corners[0].center;
    for (int k = 1; k < slab.size; ++k) {
        sum = sum + slab.corners[k].center;
    }
    const Point middle = kPart[slab.size] * sum;
    const Point way = middle - p;
    const double far = norm(way);
    const Point direction = (far > 0.0 ? 1.0 / far : 0.0) * way;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < slab.size; ++k) {
        const Ball& corner = slab.corners[k];
        least = std::min(least, dot(direction, corner.center - middle) - corner.radius);
    }
    return far + least;
}

bool is_farther(const Slab& slab, const Point& p, double distance) {
    constexpr double kRounding = 1e-12;
    const double least = least_distance_bound(slab, p);
    return least - distance > kRounding * (std::abs(least) + std::abs(distance) + slab.corners[0].radius);
}

std::optional<Ball> largest_ball(const Slab& slab, const Point& p, double growth) {
    const auto& [a, b, c] = slab.corners;
    if (slab.size == 1) {
        return if_reaching(a, p, growth);
    }
    if (slab.size == 2) {
        return largest_on_cone(a, b, p, growth);
    }
    std::array<bool, 3> may_be_on = kAnySide;
    if (const auto shape = shape_of(slab)) {
        Point foot;
        const View view = view_of_slab(slab, *shape, p, foot);
        const double slope = norm(shape->gradient);
        const auto found = reach(view, slope, growth);
        if (!found) {
            return std::nullopt;
        }
        if (found->is_bounded) {
            const Point center = slope > 0.0 ? foot + (found->to / slope) * shape->gradient : foot;
            may_be_on = sides_beyond(slab, shape->normal, center);
            if (may_be_on == kNoSide) {
                return Ball{center, a.radius + dot(center - a.center, shape->gradient)};
            }
        }
    }
    std::optional<Ball> largest;
    for (int k = 0; k < 3; ++k) {
        if (may_be_on[k]) {
            const auto ball = largest_on_cone(slab.corners[k], slab.corners[(k + 1) % 3], p, growth);
            if (ball && (!largest || ball->radius > largest->radius)) {
                largest = ball;
            }
        }
    }
    return largest;
}

}  // namespace scaleaxis::inline v1
