// SPDX-License-Identifier: Apache-2.0
/// \file
/// Unions of balls: families of them, and by brute force what is true of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::test {

using Balls = std::vector<Ball>;
using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(random);
}

inline Point random_direction(Random& random) {
    const double z = uniform(random, -1.0, 1.0);
    const double angle = uniform(random, 0.0, 2.0 * std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

inline Point random_point(Random& random, double half_extent) {
    return {uniform(random, -half_extent, half_extent), uniform(random, -half_extent, half_extent),
            uniform(random, -half_extent, half_extent)};
}

// Families of unions.

inline Balls chain_of_balls(int count, double spacing, double radius) {
    Balls balls;
    for (int i = 0; i < count; ++i) {
        balls.push_back({{i * spacing, 0.0, 0.0}, radius});
    }
    return balls;
}

/// Equal balls on the points of a cubic grid of spacing 1.
inline Balls grid_of_balls(int nx, int ny, int nz, double radius) {
    Balls balls;
    for (int x = 0; x < nx; ++x) {
        for (int y = 0; y < ny; ++y) {
            for (int z = 0; z < nz; ++z) {
                balls.push_back({{1.0 * x, 1.0 * y, 1.0 * z}, radius});
            }
        }
    }
    return balls;
}

inline Balls ring_of_balls(int count, double ring_radius, double radius) {
    Balls balls;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        balls.push_back({{ring_radius * std::cos(angle), ring_radius * std::sin(angle), 0.0}, radius});
    }
    return balls;
}

inline Balls scattered_balls(Random& random, int count, double extent, double smallest, double largest) {
    Balls balls;
    for (int i = 0; i < count; ++i) {
        balls.push_back({random_point(random, extent), uniform(random, smallest, largest)});
    }
    return balls;
}

/// Radii over three orders of magnitude: most balls hide, or lie apart.
inline Balls balls_of_all_sizes(Random& random, int count) {
    Balls balls;
    for (int i = 0; i < count; ++i) {
        balls.push_back({random_point(random, 1.0), std::pow(10.0, uniform(random, -3.0, 0.0))});
    }
    return balls;
}

/// Centres on a sphere: a void where they are dense.
inline Balls balls_around_a_void(Random& random, int count, double radius) {
    Balls balls;
    for (int i = 0; i < count; ++i) {
        balls.push_back({random_direction(random), radius * uniform(random, 0.9, 1.1)});
    }
    return balls;
}

/// Like polar balls at s = 1: many spheres pass through the same few points.
inline Balls balls_through_points(Random& random, int count, int points) {
    std::vector<Point> through;
    for (int i = 0; i < points; ++i) {
        through.push_back(random_direction(random));
    }
    Balls balls;
    for (int i = 0; i < count; ++i) {
        const Point center = random_point(random, 0.7);
        double radius = std::numeric_limits<double>::infinity();
        for (const Point& p : through) {
            radius = std::min(radius, distance(p, center));
        }
        balls.push_back({center, radius});
    }
    return balls;
}

inline Balls flat_balls(Random& random, int count) {
    Balls balls = scattered_balls(random, count, 1.0, 0.1, 0.5);
    for (Ball& ball : balls) {
        ball.center.z = 0.0;
    }
    return balls;
}

inline Balls aligned_balls(Random& random, int count) {
    Balls balls = scattered_balls(random, count, 1.0, 0.05, 0.3);
    for (Ball& ball : balls) {
        ball.center.y = ball.center.z = 0.0;
    }
    return balls;
}

// Truth.

/// The two points where three spheres meet, if they do.
inline std::optional<std::array<Point, 2>> meeting_points(const Ball& a, const Ball& b, const Ball& c) {
    const Point to_b = b.center - a.center;
    const double d = norm(to_b);
    const Point ex = (1.0 / d) * to_b;
    const Point to_c = c.center - a.center;
    const double i = dot(ex, to_c);
    const Point across = to_c - i * ex;
    const double j = norm(across);
    if (!(d > 0.0) || !(j > 0.0)) {
        return std::nullopt;
    }
    const Point ey = (1.0 / j) * across;
    const double x = (a.radius * a.radius - b.radius * b.radius + d * d) / (2.0 * d);
    const double y = (a.radius * a.radius - c.radius * c.radius + i * i + j * j - 2.0 * i * x) / (2.0 * j);
    const double square = a.radius * a.radius - x * x - y * y;
    if (!(square > 0.0)) {
        return std::nullopt;
    }
    const Point foot = a.center + x * ex + y * ey;
    const Point up = std::sqrt(square) * cross(ex, ey);
    return std::array{foot + up, foot - up};
}

/// A union of balls with its boundary as patches of spheres, arcs of circles, and vertices, found by trying all pairs
/// and triples.
class UnionOfBalls {
   public:
    struct Vertex {
        Point point;
        std::array<Index, 3> balls;  // ascending
    };

    explicit UnionOfBalls(Balls balls) : balls_(std::move(balls)) {
        const auto count = static_cast<Index>(balls_.size());
        for (Index i = 0; i < count; ++i) {
            for (Index j = i + 1; j < count; ++j) {
                const bool do_meet = add_circle(i, j);
                for (Index k = j + 1; k < count && do_meet; ++k) {
                    if (const auto points = meeting_points(balls_[i], balls_[j], balls_[k])) {
                        for (const Point& p : *points) {
                            if (!is_covered(p, {i, j, k})) {
                                vertices_.push_back({p, {i, j, k}});
                            }
                        }
                    }
                }
            }
        }
    }

    const std::vector<Vertex>& vertices() const { return vertices_; }

    bool contains(const Point& p) const {
        return std::any_of(balls_.begin(), balls_.end(), [&](const Ball& ball) {
            return squared_distance(ball.center, p) <= ball.radius * ball.radius;
        });
    }

    /// Distance of a point of the union to its boundary, and the nearest point. A nearest point of a patch, an arc is
    /// the nearest one of the whole sphere, circle, or at its border.
    std::pair<double, Point> boundary_near(const Point& x) const {
        double best = std::numeric_limits<double>::infinity();
        Point nearest;
        const auto offer = [&](const Point& p, const std::array<Index, 3>& on) {
            const double square = squared_distance(x, p);
            if (square < best && !is_covered(p, on)) {
                best = square;
                nearest = p;
            }
        };
        for (Index i = 0; i < static_cast<Index>(balls_.size()); ++i) {
            const Point direction = x - balls_[i].center;
            const double length = norm(direction);
            const Point unit = length > 0.0 ? (1.0 / length) * direction : Point{1.0, 0.0, 0.0};
            offer(balls_[i].center + balls_[i].radius * unit, {i, i, i});
        }
        for (const Circle& circle : circles_) {
            const Point radial = across(across(x - circle.center, circle.normal), circle.normal);
            const bool is_on_axis = norm(radial) < 1e-12 * circle.radius;
            const Point direction = is_on_axis ? any_normal_to(circle.normal) : radial;
            offer(circle.center + (circle.radius / norm(direction)) * direction,
                  {circle.balls[0], circle.balls[1], circle.balls[1]});
        }
        for (const Vertex& vertex : vertices_) {
            offer(vertex.point, vertex.balls);
        }
        return {std::sqrt(best), nearest};
    }

    double depth(const Point& x) const { return contains(x) ? boundary_near(x).first : 0.0; }

   private:
    struct Circle {
        Point center;
        Point normal;
        double radius;
        std::array<Index, 2> balls;
    };

    // Without its part along `unit`.
    static Point across(const Point& v, const Point& unit) { return v - dot(v, unit) * unit; }

    static Point any_normal_to(const Point& v) {
        return cross(v, std::abs(v.x) < std::abs(v.y) ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0});
    }

    // Returns false if the spheres do not meet.
    bool add_circle(Index i, Index j) {
        const Ball& a = balls_[i];
        const Ball& b = balls_[j];
        const Point to_b = b.center - a.center;
        const double d = norm(to_b);
        const double x = (a.radius * a.radius - b.radius * b.radius + d * d) / (2.0 * d);
        const double square = a.radius * a.radius - x * x;
        if (!(d > 0.0 && square > 0.0)) {
            return false;
        }
        circles_.push_back({a.center + (x / d) * to_b, (1.0 / d) * to_b, std::sqrt(square), {i, j}});
        return true;
    }

    bool is_covered(const Point& p, const std::array<Index, 3>& except) const {
        for (Index k = 0; k < static_cast<Index>(balls_.size()); ++k) {
            const double square = balls_[k].radius * balls_[k].radius;
            if (k != except[0] && k != except[1] && k != except[2] &&
                squared_distance(balls_[k].center, p) < square * (1.0 - 1e-12)) {
                return true;
            }
        }
        return false;
    }

    Balls balls_;
    std::vector<Circle> circles_;
    std::vector<Vertex> vertices_;
};

/// Points of a union, some on each ball.
inline std::vector<Point> points_of(const std::vector<Ball>& balls) {
    constexpr int kOnEach = 6;
    Random random(11);
    std::vector<Point> points;
    for (const auto& [center, radius] : balls) {
        for (int i = 0; i < kOnEach; ++i) {
            points.push_back(center + radius * random_direction(random));
        }
    }
    return points;
}

/// How far the farthest of the points is from the union.
inline double farthest(const std::vector<Point>& points, const std::vector<Ball>& balls) {
    double most = 0.0;
    for (const NearestBall& nearest : BallUnion(balls).nearest_balls(points)) {
        most = std::max(most, nearest.distance);
    }
    return most;
}

}  // namespace scaleaxis::test
