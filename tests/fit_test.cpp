// SPDX-License-Identifier: Apache-2.0
// Fitted balls and repaired unions: closed forms, brute force, solids that lie.
#include "scaleaxis/fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "balls/covering_balls.hpp"
#include "balls/critical_points.hpp"
#include "balls/dual_complex.hpp"
#include "base/random.hpp"
#include "executions.hpp"
#include "meshes.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"
#include "spatial/nearest_triangle.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A solid that knows nearest points, by a function.
class KnownSolid : public ImplicitSolid, public NearestPoints {
   public:
    using Nearest = std::function<std::optional<Point>(const Point&)>;

    KnownSolid(Box box, Function function, Nearest nearest, std::size_t batch = 64)
        : ImplicitSolid(box, std::move(function)), nearest_(std::move(nearest)), batch_(batch) {}

    const NearestPoints* nearest_points() const override { return this; }
    void prepare() const override { is_prepared_ = true; }
    bool is_prepared() const { return is_prepared_; }
    void find(std::span<const Point> points, std::span<const double> bounds,
              std::span<std::optional<Point>> found) const override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::optional<Point> p = nearest_(points[i]);
            found[i] = p && (lies_ || distance(*p, points[i]) < bounds[i]) ? p : std::nullopt;
        }
    }
    std::size_t batch_size() const override { return batch_; }
    void lie() { lies_ = true; }

   private:
    Nearest nearest_;
    std::size_t batch_;
    mutable bool is_prepared_ = false;
    bool lies_ = false;
};

// Nearest points of solids around the origin.

Point nearest_of_box(const Point& half, const Point& p) {
    const std::array<double, 3> gaps{half.x - std::abs(p.x), half.y - std::abs(p.y), half.z - std::abs(p.z)};
    const double gap = std::ranges::min(gaps);
    Point q = p;
    if (gap < 0.0) {
        return {std::clamp(p.x, -half.x, half.x), std::clamp(p.y, -half.y, half.y), std::clamp(p.z, -half.z, half.z)};
    }
    if (gap == gaps[0]) {
        q.x = std::copysign(half.x, p.x);
    } else if (gap == gaps[1]) {
        q.y = std::copysign(half.y, p.y);
    } else {
        q.z = std::copysign(half.z, p.z);
    }
    return q;
}

// On the ray from `from` to `p`.
Point at_distance(const Point& from, const Point& p, double radius) {
    const double length = distance(from, p);
    return length > 0.0 ? from + (radius / length) * (p - from) : from + Point{radius, 0, 0};
}

Point nearest_of_cylinder(double radius, double half_height, const Point& p) {
    if (std::abs(p.z) > half_height) {
        const Point q = std::hypot(p.x, p.y) > radius ? at_distance({0, 0, p.z}, p, radius) : p;
        return {q.x, q.y, std::copysign(half_height, p.z)};
    }
    const double along = half_height - std::abs(p.z);
    const double across = radius - std::hypot(p.x, p.y);
    return along < across ? Point{p.x, p.y, std::copysign(half_height, p.z)} : at_distance({0, 0, p.z}, p, radius);
}

Point nearest_of_torus(double ring_radius, double radius, const Point& p) {
    return at_distance(at_distance({}, {p.x, p.y, 0.0}, ring_radius), p, radius);
}

Point nearest_of_capsule(double radius, double half_length, const Point& p) {
    return at_distance({0, 0, std::clamp(p.z, -half_length, half_length)}, p, radius);
}

// The ellipsoid with a > b > c: for its nearest point q, p - q is parallel to the gradient there (D. Eberly, "Distance
// from a point to an ellipse, an ellipsoid, or a hyperellipsoid", 2013).
Point nearest_of_ellipsoid(double a, double b, double c, const Point& p) {
    // Its multiple, less that at which the gradient's z component vanishes.
    const auto at = [&](double u) {
        return Point{a * a * p.x / (u + a * a - c * c), b * b * p.y / (u + b * b - c * c), c * c * p.z / u};
    };
    const auto value = [&](double u) {
        const Point q = at(u);
        return squared_norm({q.x / a, q.y / b, q.z / c}) - 1.0;
    };
    double low = 1e-300, high = c * c + a * norm(p);
    if (p.z == 0.0 || value(low) < 0.0) {
        const Point q = at(low);
        return {q.x, q.y, std::copysign(c * std::sqrt(1.0 - q.x * q.x / (a * a) - q.y * q.y / (b * b)), p.z)};
    }
    for (int i = 0; i < 2000 && low < high * (1.0 - 1e-15); ++i) {
        const double middle = i % 2 == 0 ? std::sqrt(low * high) : 0.5 * (low + high);
        (value(middle) > 0.0 ? low : high) = middle;
    }
    return at(high);
}

KnownSolid known_box(const Point& half) {
    return {centered_box(half.x, half.y, half.z), box_solid(half).function(),
            [=](const Point& p) { return nearest_of_box(half, p); }};
}
KnownSolid known_ellipsoid(double a, double b, double c) {
    return {centered_box(a, b, c), ellipsoid_solid(a, b, c).function(),
            [=](const Point& p) { return nearest_of_ellipsoid(a, b, c, p); }};
}

std::vector<Ball> random_balls_inside(const Solid& solid, int count, std::uint64_t seed) {
    std::cout << "seed " << seed << '\n';
    const Box box = solid.bounds();
    std::vector<Ball> balls;
    for (std::uint64_t i = 0; std::ssize(balls) < count; ++i) {
        const auto along = [&](double min, double max, std::uint64_t k) {
            return min + (max - min) * random_unit(seed, i, k);
        };
        const Point p{along(box.min.x, box.max.x, 0), along(box.min.y, box.max.y, 1), along(box.min.z, box.max.z, 2)};
        if (solid.inside(p)) {
            balls.push_back({p, 0.3 * random_unit(seed, i, 3)});
        }
    }
    return balls;
}

constexpr double kSlack = 1e-6;

FittedBalls fitted_at_random(const Solid& solid, std::uint64_t seed) {
    FittedBalls fitted = fit(random_balls_inside(solid, 500, seed), solid, {kSlack});
    EXPECT_EQ(fitted.statistics.outside, 0);
    EXPECT_EQ(fitted.statistics.inexact, 0);
    EXPECT_EQ(fitted.balls.size() + fitted.statistics.repeated, 500U);
    return fitted;
}

TEST(Fit, BallsOfABoxAreOnItsMedialAxis) {
    const Point half{1.0, 0.7, 0.4};
    for (const auto& [center, radius] : fitted_at_random(known_box(half), 1).balls) {
        std::array<double, 3> gaps{half.x - std::abs(center.x), half.y - std::abs(center.y),
                                   half.z - std::abs(center.z)};
        std::ranges::sort(gaps);
        // In the middle sheet the opposite walls are the two nearest; elsewhere two that share an edge.
        const bool is_in_middle = std::abs(center.z) <= kSlack;
        EXPECT_TRUE(is_in_middle || gaps[1] - gaps[0] <= kSlack) << center.x << ' ' << center.y << ' ' << center.z;
        EXPECT_LE(radius, gaps[0]);
        EXPECT_GE(radius, gaps[0] - 1e-14);
    }
}

TEST(Fit, BallsOfACylinderAreOnItsMedialAxis) {
    const double r = 0.5, h = 1.0;
    const KnownSolid solid(centered_box(r, r, h), cylinder_solid(r, h).function(),
                           [=](const Point& p) { return nearest_of_cylinder(r, h, p); });
    for (const auto& [center, radius] : fitted_at_random(solid, 2).balls) {
        const double off_axis = std::hypot(center.x, center.y);
        const double across = r - off_axis, along = h - std::abs(center.z);
        EXPECT_TRUE(off_axis <= kSlack || std::abs(across - along) <= kSlack) << across << ' ' << along;
        EXPECT_NEAR(radius, std::min(across, along), 1e-14);
    }
}

TEST(Fit, BallsOfATorusAreOnItsRing) {
    const double ring = 1.0, r = 0.4;
    const KnownSolid solid(centered_box(ring + r, ring + r, r), torus_solid(ring, r).function(),
                           [=](const Point& p) { return nearest_of_torus(ring, r, p); });
    for (const auto& [center, radius] : fitted_at_random(solid, 3).balls) {
        EXPECT_LE(std::hypot(std::hypot(center.x, center.y) - ring, center.z), kSlack);
        EXPECT_NEAR(radius, r, kSlack);
        EXPECT_LE(radius, r);
    }
}

TEST(Fit, BallsOfACapsuleAreOnItsSegment) {
    const double r = 0.3, h = 0.8;
    const KnownSolid solid(centered_box(r, r, h + r), capsule_solid(r, h).function(),
                           [=](const Point& p) { return nearest_of_capsule(r, h, p); });
    for (const auto& [center, radius] : fitted_at_random(solid, 4).balls) {
        EXPECT_LE(norm({center.x, center.y, std::max(0.0, std::abs(center.z) - h)}), kSlack);
        EXPECT_NEAR(radius, r, kSlack);
        EXPECT_LE(radius, r);
    }
}

TEST(Fit, BallsOfAnEllipsoidAreOnItsMedialDisc) {
    const double a = 1.0, b = 0.7, c = 0.4;
    for (const auto& [center, radius] : fitted_at_random(known_ellipsoid(a, b, c), 5).balls) {
        const double x = center.x * center.x / (a * a - c * c), y = center.y * center.y / (b * b - c * c);
        // The rim of the disc, where the two contacts become one, is hard to tell from what is around it.
        EXPECT_LE(x / (1.0 - c * c / (a * a)) + y / (1.0 - c * c / (b * b)), 1.0 + 1e-2);
        EXPECT_LE(std::abs(center.z), 5e-3);
        EXPECT_NEAR(radius, c * std::sqrt(std::max(0.0, 1.0 - x - y)), 2e-3);
    }
}

TEST(Fit, CentersOutsideAreDropped) {
    const KnownSolid solid = known_box({1.0, 1.0, 1.0});
    const std::vector<Ball> balls{{{3, 0, 0}, 1.0}, {{0.5, 0.2, 0.1}, 0.1}, {{1, 0, 0}, 1.0}};
    const FittedBalls fitted = fit(balls, solid, {1e-6});
    EXPECT_EQ(fitted.given, std::vector<Index>{1});
    EXPECT_EQ(fitted.statistics.outside, 2);
    EXPECT_TRUE(fit({}, solid, {1e-6}).balls.empty());
}

TEST(Fit, EqualResultsAreOne) {
    const KnownSolid solid = known_box({1.0, 1.0, 0.25});
    const std::vector<Ball> balls{{{0.5, 0.25, 0.125}, 0.1}, {{0.5, 0.25, 0.0625}, 0.1}, {{0.5, 0.25, 0.125}, 0.1}};
    EXPECT_FALSE(solid.is_prepared());
    const FittedBalls fitted = fit(balls, solid, {1e-9});
    EXPECT_TRUE(solid.is_prepared());  // with all threads, before any of them asks
    EXPECT_EQ(fitted.given, std::vector<Index>{0});
    EXPECT_EQ(fitted.statistics.repeated, 2);
}

// Meshes, by brute force.

struct Model {
    std::string name;
    TriangleMesh mesh;
    double tolerance;
};

std::vector<Model> models() {
    return {{"box", box_mesh({-1.0, -0.7, -0.4}, {1.0, 0.7, 0.4}, 3), 0.1},
            {"cylinder", cylinder_mesh(0.5, 1.0, 24), 0.1},
            {"torus", torus_mesh(1.0, 0.4, 24), 0.1},
            {"ball", ball_mesh(1.0, 16), 0.2},
            {"dumbbell", dumbbell_mesh(0.5, 1.0, 0.2, 16), 0.1}};
}

double distance_to_mesh(const TriangleMesh& mesh, const Point& p) {
    double least = kInfinity;
    for (const auto& [a, b, c] : mesh.triangles) {
        least = std::min(least, distance(p, nearest_point(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], p)));
    }
    return least;
}

Samples sampled(const Solid& solid, double tolerance) {
    return sample(solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
}

TEST(Fit, BallsOfMeshesAreInscribedAndTouchTwice) {
    for (const Model& model : models()) {
        const auto solid = mesh_solid(model.mesh);
        const double slack = 0.01 * model.tolerance;
        const FittedBalls fitted = fit(inner_balls(sampled(*solid, model.tolerance)), *solid, {slack});
        EXPECT_EQ(fitted.statistics.inexact, 0) << model.name;
        ASSERT_EQ(fitted.contacts.size(), fitted.balls.size());
        ASSERT_GT(fitted.balls.size(), 20U) << model.name;
        for (std::size_t i = 0; i < fitted.balls.size(); ++i) {
            const auto& [center, radius] = fitted.balls[i];
            const auto& [first, second] = fitted.contacts[i];
            const double true_distance = distance_to_mesh(model.mesh, center);
            EXPECT_LE(radius, true_distance) << model.name << ", ball " << i;
            EXPECT_GE(radius, true_distance - 1e-12) << model.name << ", ball " << i;
            EXPECT_LE(std::max(distance(center, first), distance(center, second)), radius + slack);
            EXPECT_LE(std::max(distance_to_mesh(model.mesh, first), distance_to_mesh(model.mesh, second)), 1e-12);
            EXPECT_GT(distance(first, second), 0.0);
        }
    }
}

TEST(Fit, BallsOfAMeshedBoxAreThoseOfTheBox) {
    const Point half{1.0, 0.7, 0.4};
    const auto solid = mesh_solid(box_mesh(-1.0 * half, half, 4));
    const FittedBalls by_mesh = fitted_at_random(*solid, 6);
    const FittedBalls by_form = fitted_at_random(known_box(half), 6);
    ASSERT_EQ(by_mesh.balls.size(), by_form.balls.size());
    for (std::size_t i = 0; i < by_mesh.balls.size(); ++i) {
        EXPECT_LE(distance(by_mesh.balls[i].center, by_form.balls[i].center), 2.0 * kSlack);
        EXPECT_NEAR(by_mesh.balls[i].radius, by_form.balls[i].radius, 2.0 * kSlack);
    }
}

TEST(Fit, MovesWithTheSolid) {
    const TriangleMesh mesh = box_mesh({-1.0, -0.7, -0.4}, {1.0, 0.7, 0.4}, 2);
    const auto solid = mesh_solid(mesh);
    const std::vector<Ball> balls = random_balls_inside(*solid, 200, 7);
    const FittedBalls fitted = fit(balls, *solid, {kSlack});
    for (const Similarity& similarity : {turn(0.7), enlargement(1000.0), shift({5.0, -3.0, 2.0})}) {
        std::vector<Ball> moved_balls = balls;
        for (Ball& ball : moved_balls) {
            ball = {similarity(ball.center), similarity.scale * ball.radius};
        }
        const auto moved_solid = mesh_solid(moved(mesh, similarity));
        const FittedBalls again = fit(moved_balls, *moved_solid, {similarity.scale * kSlack});
        ASSERT_EQ(again.given, fitted.given);
        for (std::size_t i = 0; i < again.balls.size(); ++i) {
            const double slack = 2.0 * similarity.scale * kSlack;
            EXPECT_LE(distance(again.balls[i].center, similarity(fitted.balls[i].center)), slack);
            EXPECT_NEAR(again.balls[i].radius, similarity.scale * fitted.balls[i].radius, slack);
        }
    }
}

// Solids that lie.

TEST(Fit, EndsWithAnErrorIfTheSolidIsWrong) {
    const Box box = centered_box(1, 1, 1);
    const auto is_inside = [](const Point& p) { return norm(p) - 0.9; };
    const std::vector<Ball> balls = random_balls_inside(ball_solid(0.9), 2000, 8);
    const auto random_answer = [](const Point& p) -> std::optional<Point> {
        const auto bits =
            static_cast<std::uint64_t>(std::abs(p.x) * 1e15) ^ static_cast<std::uint64_t>(std::abs(p.y) * 1e15);
        const auto along = [&](std::uint64_t k) { return 2.0 * random_unit(9, bits, k) - 1.0; };
        return Point{along(0), along(1), along(2)};
    };
    KnownSolid lying(box, is_inside, random_answer);
    EXPECT_THROW(fit(balls, lying, {1e-3}), UnusableInput);
    lying.lie();
    EXPECT_THROW(fit(balls, lying, {1e-3}), UnusableInput);
    // Everything is free, and nothing ever stops a ball.
    const Point pole{0, 0, 0.9};
    EXPECT_THROW(fit(balls, KnownSolid(box, is_inside, [&](const Point&) { return pole; }), {1e-3}), UnusableInput);
    KnownSolid not_a_number(box, is_inside, [](const Point& p) { return Point{p.x, std::nan(""), p.z}; });
    not_a_number.lie();
    EXPECT_TRUE(fit(balls, not_a_number, {1e-3}).balls.empty());
    EXPECT_TRUE(
        fit(balls, KnownSolid(box, is_inside, [](const Point&) { return std::nullopt; }), {1e-3}).balls.empty());
    EXPECT_THROW(fit(balls, ball_solid(0.9), {1e-3}), UnusableInput) << "does not know nearest points";
    EXPECT_THROW(fit(balls, known_box({1, 1, 1}), {0.0}), InvalidOption);
    EXPECT_THROW(fit(balls, known_box({1, 1, 1}), {std::nan("")}), InvalidOption);
}

// Critical points by trying all simplices.

/// The point of equal power in the affine hull of the balls, as barycentric coordinates: solves the linear system by
/// Cramer's rule of the Gram matrix.
std::optional<std::vector<double>> barycentric_center(const std::vector<Ball>& simplex) {
    const std::size_t n = simplex.size() - 1;
    std::vector<std::vector<double>> m(n, std::vector<double>(n + 1));
    for (std::size_t i = 0; i < n; ++i) {
        const Point e = simplex[i + 1].center - simplex[0].center;
        for (std::size_t j = 0; j < n; ++j) {
            m[i][j] = dot(e, simplex[j + 1].center - simplex[0].center);
        }
        m[i][n] = 0.5 * (squared_norm(e) + simplex[0].radius * simplex[0].radius -
                         simplex[i + 1].radius * simplex[i + 1].radius);
    }
    for (std::size_t k = 0; k < n; ++k) {  // the matrix is positive definite: no pivots
        for (std::size_t i = 0; i < n; ++i) {
            if (i != k) {
                const double factor = m[i][k] / m[k][k];
                for (std::size_t j = k; j <= n; ++j) {
                    m[i][j] -= factor * m[k][j];
                }
            }
        }
    }
    std::vector<double> weights{1.0};
    for (std::size_t i = 0; i < n; ++i) {
        weights.push_back(m[i][n] / m[i][i]);
        weights[0] -= weights.back();
    }
    if (std::ranges::any_of(weights, [](double w) { return !(w > 0.0); })) {
        return std::nullopt;
    }
    return weights;
}

double power(const Ball& ball, const Point& p) { return squared_distance(ball.center, p) - ball.radius * ball.radius; }

struct Found {
    Point place;
    double power;
};

std::vector<std::pair<std::array<Index, 4>, Found>> critical_by_brute_force(const std::vector<Ball>& balls) {
    std::vector<std::pair<std::array<Index, 4>, Found>> result;
    const auto count = static_cast<Index>(balls.size());
    const auto try_simplex = [&](const std::array<Index, 4>& ids) {
        std::vector<Ball> simplex;
        for (const Index id : ids) {
            if (id != kNone) {
                simplex.push_back(balls[id]);
            }
        }
        const auto weights = barycentric_center(simplex);
        if (!weights) {
            return;
        }
        Point x;
        for (std::size_t i = 0; i < simplex.size(); ++i) {
            x = x + (*weights)[i] * simplex[i].center;
        }
        const double least = power(simplex[0], x);
        for (Index other = 0; other < count; ++other) {
            if (std::ranges::find(ids, other) == ids.end() && power(balls[other], x) < least) {
                return;
            }
        }
        result.push_back({ids, {x, least}});
    };
    for (Index a = 0; a < count; ++a) {
        for (Index b = a + 1; b < count; ++b) {
            try_simplex({kNone, kNone, a, b});
            for (Index c = b + 1; c < count; ++c) {
                try_simplex({kNone, a, b, c});
                for (Index d = c + 1; d < count; ++d) {
                    try_simplex({a, b, c, d});
                }
            }
        }
    }
    std::ranges::sort(result, {}, [](const auto& entry) { return entry.first; });
    return result;
}

TEST(CriticalPoints, AreThoseOfAllSimplices) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::vector<Ball> balls;
        for (std::uint64_t i = 0; i < 4 + seed % 9; ++i) {
            balls.push_back({{random_unit(seed, i, 0), random_unit(seed, i, 1), random_unit(seed, i, 2)},
                             0.05 + 0.4 * random_unit(seed, i, 3) * random_unit(seed, i, 4)});
        }
        const auto expected = critical_by_brute_force(balls);
        const Triangulation triangulation = dual_complex(balls).triangulation;
        std::vector<CriticalPoint> found = critical_points(triangulation, balls);
        std::ranges::sort(found, {}, &CriticalPoint::balls);
        ASSERT_EQ(found.size(), expected.size());
        std::size_t uncovered = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].balls, expected[i].first);
            EXPECT_LE(distance(found[i].place, expected[i].second.place), 1e-9);
            EXPECT_NEAR(found[i].power, expected[i].second.power, 1e-9);
            EXPECT_EQ(found[i].is_covered, expected[i].second.power <= 0.0);
            uncovered += found[i].is_covered ? 0 : 1;
        }
        EXPECT_EQ(critical_points(triangulation, balls, CriticalPoints::kUncovered).size(), uncovered);
    }
}

// The Euler characteristic of the union is the sum over balls and critical points that are covered (Morse theory);
// every ball here has its own centre as a minimum.
TEST(CriticalPoints, CountTheEulerCharacteristic) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::vector<Ball> balls;
        for (std::uint64_t i = 0; i < 200; ++i) {
            balls.push_back({{random_unit(seed, i, 0), random_unit(seed, i, 1), random_unit(seed, i, 2)}, 0.09});
        }
        const DualComplex complex = dual_complex(balls);
        std::int64_t euler = std::ssize(balls);
        for (const CriticalPoint& point : critical_points(complex.triangulation, balls)) {
            euler += !point.is_covered ? 0 : point.simplex().size() % 2 == 0 ? -1 : 1;
        }
        EXPECT_EQ(euler, complex.topology.euler);
    }
}

// Repair.

/// A ring of rectangular section: a tube with a thin wall.
TriangleMesh thin_tube(double inner, double outer, double half_height) {
    std::vector<std::array<double, 2>> curve;
    const int steps = 8;
    for (int i = 0; i < steps; ++i) {
        curve.push_back({outer, half_height * (2.0 * i / steps - 1.0)});
    }
    for (int i = 0; i < steps; ++i) {
        curve.push_back({inner, half_height * (1.0 - 2.0 * i / steps)});
    }
    return revolved(curve, 96);
}

struct Case {
    std::unique_ptr<Solid> solid;
    Samples samples;
    FittedBalls fitted;
    RepairOptions options;
};

Case case_of(const TriangleMesh& mesh, double tolerance) {
    Case c;
    c.solid = mesh_solid(mesh);
    c.samples = sampled(*c.solid, tolerance);
    c.fitted = fit(inner_balls(c.samples), *c.solid, {kDefaultSlack * tolerance});
    c.options.topology = c.solid->topology();
    c.options.slack = kDefaultSlack * tolerance;
    return c;
}

RepairedBalls repaired(const Case& c, const Execution& execution = {}) {
    return repair(c.fitted, c.samples, *c.solid, c.options, execution);
}

/// The balls with centres at smaller x.
FittedBalls part_below(const FittedBalls& fitted, double x) {
    FittedBalls part;
    for (std::size_t i = 0; i < fitted.balls.size(); ++i) {
        if (fitted.balls[i].center.x < x) {
            part.balls.push_back(fitted.balls[i]);
            part.contacts.push_back(fitted.contacts[i]);
        }
    }
    return part;
}

/// As the medial axis sees it.
Topology topology_of(const std::vector<Ball>& balls) { return BallUnion(perturbed(balls, 1e-4, 1)).topology(); }

TEST(Repair, ClosesTheGapsOfAThinTube) {
    const TriangleMesh mesh = thin_tube(2.0, 2.1, 1.0);
    const Case c = case_of(mesh, 0.12);
    const RepairedBalls result = repaired(c);
    EXPECT_GT(*topology_of(c.fitted.balls).tunnels, 1) << "the case is too easy";
    EXPECT_EQ(result.report.topology, known_topology(1, 1, 0));
    ASSERT_FALSE(result.report.steps.empty());
    EXPECT_EQ(result.report.steps.back().name, "samples") << "no ladder";
    EXPECT_GT(result.report.steps.back().gaps, 0);
    EXPECT_EQ(result.balls.size(), c.fitted.balls.size() + result.report.added);
    ASSERT_EQ(result.contacts.size(), result.balls.size());
    for (std::size_t i = 0; i < c.fitted.balls.size(); ++i) {
        EXPECT_EQ(result.balls[i], c.fitted.balls[i]);
    }
    for (const auto& [center, radius] : result.balls) {
        EXPECT_LE(radius, distance_to_mesh(mesh, center));
    }
    EXPECT_EQ(topology_of(result.balls), known_topology(1, 1, 0));
}

TEST(Repair, KeepsTunnelsAndCavities) {
    const TriangleMesh torus = torus_mesh(1.0, 0.3, 32);
    EXPECT_EQ(repaired(case_of(torus, 0.1)).report.topology, known_topology(1, 1, 0));
    const TriangleMesh shell = together(ball_mesh(1.0, 32), turned_inside_out(ball_mesh(0.8, 32)));
    EXPECT_EQ(repaired(case_of(shell, 0.25)).report.topology, known_topology(1, 0, 1));
    const TriangleMesh two = together(box_mesh({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, 2),
                                      moved(box_mesh({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, 2), shift({0.65, 0, 0})));
    EXPECT_EQ(repaired(case_of(two, 0.15)).report.topology, known_topology(2, 0, 0))
        << "the gap is no gap in the union";
}

TEST(Repair, TakesPolarBallsWhereInscribedOnesFail) {
    // Two boxes with a gap of 0.001 that are to be one: inscribed balls never meet.
    const TriangleMesh mesh = together(box_mesh({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, 2),
                                       moved(box_mesh({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, 2), shift({0.601, 0, 0})));
    Case c = case_of(mesh, 0.15);
    const RepairedBalls apart = repaired(c);
    EXPECT_EQ(apart.report.topology, known_topology(2, 0, 0));
    EXPECT_EQ(apart.report.largest_protrusion, 0.0);
    c.options.topology = known_topology(1, 0, 0);
    const RepairedBalls joined = repaired(c);
    EXPECT_EQ(joined.report.topology, known_topology(1, 0, 0));
    EXPECT_EQ(topology_of(joined.balls), joined.report.topology);
    const RepairStep& last = joined.report.steps.back();
    EXPECT_EQ(last.name, "polar");
    EXPECT_GT(last.added, 0);
    EXPECT_GT(joined.report.largest_protrusion, 0.0);
    ASSERT_EQ(joined.contacts.size(), joined.balls.size());
    double largest = 0.0;
    for (std::size_t i = joined.balls.size() - last.added; i < joined.balls.size(); ++i) {
        const auto& [center, radius] = joined.balls[i];
        largest = std::max(largest, radius - distance_to_mesh(mesh, center));
        for (const Point& contact : joined.contacts[i]) {
            EXPECT_NEAR(distance(contact, center), radius, 1e-6 * radius);
        }
    }
    EXPECT_NEAR(joined.report.largest_protrusion, largest, 1e-12);
    c.options.topology = known_topology(3, 7, 2);
    const RepairedBalls hopeless = repaired(c);
    EXPECT_EQ(hopeless.report.steps.back().added, 0) << "they do not help";
    EXPECT_EQ(hopeless.report.largest_protrusion, 0.0);
}

TEST(Repair, FindsPartsWithoutBalls) {
    Case c = case_of(torus_mesh(1.0, 0.3, 32), 0.1);
    const FittedBalls part = c.fitted = part_below(c.fitted, 0.3);
    const RepairedBalls result = repaired(c);
    EXPECT_EQ(topology_of(part.balls), known_topology(1, 0, 0));
    EXPECT_EQ(result.report.topology, known_topology(1, 1, 0));
    EXPECT_EQ(result.report.steps[0].name, "samples");
    EXPECT_GT(result.report.steps[0].far_samples, 0);
    const UnionAccuracy before = union_accuracy(part.balls, part.contacts, c.samples);
    const UnionAccuracy after = union_accuracy(result.balls, result.contacts, c.samples);
    EXPECT_GT(before.largest_distance, 0.3);
    EXPECT_LE(after.largest_distance, 0.1);
}

TEST(Repair, ComesNearToEdgesAndCorners) {
    const TriangleMesh mesh = box_mesh({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}, 6);
    const double tolerance = 0.15;
    const Case c = case_of(mesh, tolerance);
    const auto farthest = [&](const std::vector<Ball>& balls) {
        double result = 0.0;
        for (const Point& vertex : mesh.vertices) {
            double nearest = 1.0;
            for (const auto& [center, radius] : balls) {
                nearest = std::min(nearest, distance(vertex, center) - radius);
            }
            result = std::max(result, nearest);
        }
        return result;
    };
    const RepairedBalls result = repaired(c);
    EXPECT_GT(farthest(c.fitted.balls), 0.6 * tolerance) << "the case is too easy";
    EXPECT_LE(farthest(result.balls), 0.5 * tolerance * (1.0 + 1e-9));
    EXPECT_EQ(result.report.topology, known_topology(1, 0, 0));
    EXPECT_LT(result.report.added, 0.6 * static_cast<double>(c.fitted.balls.size()))
        << "balls that touch the edges are tiny";
    EXPECT_LT(result.report.added, result.report.steps[0].far_samples) << "one ball a dip, not one a point";
}

// A small box beside a large one, and a solid that is said to be in one piece.
TEST(Repair, TakesAwayIslandsThatNoPointNeeds) {
    const TriangleMesh mesh =
        together(box_mesh({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, 2),
                 moved(box_mesh({-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, 2), shift({0.32, 0, 0})));
    Case c = case_of(mesh, 0.1);
    c.fitted.balls.push_back({{0.32, 0.0, 0.0}, 0.01});  // too small for its samples to find
    c.fitted.contacts.push_back({Point{0.31, 0.0, 0.0}, Point{0.33, 0.0, 0.0}});
    const auto is_beyond = [](const Ball& ball) { return ball.center.x > 0.305; };
    const RepairedBalls both = repaired(c);
    EXPECT_EQ(both.report.topology, known_topology(2, 0, 0));
    ASSERT_TRUE(std::ranges::any_of(both.balls, is_beyond));
    c.options.topology = known_topology(1, 0, 0);
    const RepairedBalls one = repaired(c);
    EXPECT_EQ(one.report.topology, known_topology(1, 0, 0));
    EXPECT_EQ(topology_of(one.balls), one.report.topology);
    EXPECT_TRUE(std::ranges::none_of(one.balls, is_beyond));
    EXPECT_EQ(one.report.steps.back().name, "islands");
    EXPECT_GT(one.report.largest_distance, 0.02) << "points beside the island count";
    EXPECT_LT(one.report.steps.back().added, 0);
    EXPECT_EQ(one.balls.size(), c.fitted.balls.size() + one.report.added);
    EXPECT_EQ(one.contacts.size(), one.balls.size());
}

TEST(Repair, KeepsIslandsThatPointsNeed) {
    // The second box has balls only because its samples are far from the union.
    const TriangleMesh mesh = together(box_mesh({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, 2),
                                       moved(box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, 2), shift({0.6, 0, 0})));
    Case c = case_of(mesh, 0.1);
    c.fitted = part_below(c.fitted, 0.4);
    c.options.topology = known_topology(1, 0, 0);
    const RepairedBalls result = repaired(c);
    EXPECT_EQ(result.report.topology, known_topology(2, 0, 0));
    EXPECT_TRUE(std::ranges::any_of(result.balls, [](const Ball& ball) { return ball.center.x > 0.4; }));
    EXPECT_EQ(result.report.far_points, 0);
}

TEST(Repair, LeavesNoSampleFarFromTheUnion) {
    // Slim spikes in all directions on a box: few restricted facets, and their normals do not lead inside.
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        TriangleMesh mesh = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 6);
        for (std::uint64_t i = 0; i < 12; ++i) {
            const auto v = static_cast<std::size_t>(random_unit(seed, i) * static_cast<double>(mesh.vertices.size()));
            mesh.vertices[v] = (1.5 + random_unit(seed, i, 1)) * mesh.vertices[v];
        }
        const Case c = case_of(mesh, 0.2);
        const RepairedBalls result = repaired(c);
        EXPECT_LE(union_accuracy(result.balls, result.contacts, c.samples).largest_distance, 0.2 * (1.0 + 1e-9))
            << "seed " << seed;
    }
}

TEST(Repair, EndsWhereTheTopologyIsUnknownOrOutOfReach) {
    Case c = case_of(thin_tube(2.0, 2.1, 1.0), 0.12);
    const RepairedBalls right = repaired(c);
    c.options.topology.reset();
    const RepairedBalls result = repaired(c);
    EXPECT_EQ(result.report.steps.back().name, "samples") << "nothing to compare with: no ladder";
    EXPECT_EQ(result.report.topology, known_topology(1, 1, 0));
    c.options.topology = known_topology(3, 7, 2);
    c.options.growth_limit = 0.1;
    const RepairedBalls wrong = repaired(c);
    EXPECT_EQ(wrong.report.steps.back().name, "polar");
    EXPECT_EQ(wrong.report.steps.back().added, 0);
    EXPECT_LE(wrong.balls.size(), c.fitted.balls.size() * 11 / 10 + 1000);
    c.options.max_rounds = 0;
    EXPECT_NO_THROW(repaired(c));
    c.options.max_rounds = -1;
    EXPECT_THROW(repaired(c), InvalidOption);
    EXPECT_GE(right.balls.size(), c.fitted.balls.size());
}

TEST(Repair, CompletesBesideIslandsOnlyWhereTheseAreAllThatIsWrong) {
    const Box small{{6, 0, 0}, {7, 1, 1}};
    Case c = case_of(together(box_mesh({0, 0, 0}, {4, 4, 4}), box_mesh(small.min, small.max)), 0.25);
    c.options.topology = known_topology(1, 0, 0);
    const RepairedBalls result = repaired(c);
    ASSERT_EQ(result.report.steps.at(2).name, "complete 0.25");
    EXPECT_GT(result.report.steps[2].added, 0);
    for (std::size_t i = c.fitted.balls.size() + result.report.steps[0].added; i < result.balls.size(); ++i) {
        EXPECT_TRUE(small.contains(result.balls[i].center));
    }
}

TEST(Repair, EndsWhereASolidHasNoThickness) {
    // A prism between a square and a smaller mirrored one: it is turned inside out on the way. Two wedges meet in a
    // line.
    const TriangleMesh mesh{{{-1, -1, -1},
                             {1, -1, -1},
                             {1, 1, -1},
                             {-1, 1, -1},
                             {0.7, -0.7, 0.7},
                             {-0.7, -0.7, 0.7},
                             {-0.7, 0.7, 0.7},
                             {0.7, 0.7, 0.7}},
                            {{0, 2, 1},
                             {0, 3, 2},
                             {4, 5, 6},
                             {4, 6, 7},
                             {0, 1, 5},
                             {0, 5, 4},
                             {1, 2, 6},
                             {1, 6, 5},
                             {2, 3, 7},
                             {2, 7, 6},
                             {3, 0, 4},
                             {3, 4, 7}}};
    const Case c = case_of(mesh, 0.1);
    const RepairedBalls result = repaired(c);
    EXPECT_EQ(result.report.topology, known_topology(2, 0, 0));
    EXPECT_FALSE(result.report.is_growth_limited);
    EXPECT_LT(result.balls.size(), 3 * c.fitted.balls.size()) << "ten times as many without a least radius";
}

TEST(Repair, EndsWherePartsTouchAlongAnEdge) {
    // Two boxes welded along an edge of both, as of four triangles.
    const TriangleMesh a = box_mesh({0, 0, 0}, {1, 2, 3});
    TriangleMesh mesh = together(a, moved(a, shift({1, 2, 0})));
    const auto welded = [&](Index v) {
        return std::ranges::find(mesh.vertices, mesh.vertices[v]) - mesh.vertices.begin();
    };
    for (std::array<Index, 3>& triangle : mesh.triangles) {
        for (Index& v : triangle) {
            v = static_cast<Index>(welded(v));
        }
    }
    const std::unique_ptr<Solid> solid = mesh_solid(repair(mesh));
    ASSERT_EQ(solid->topology(), known_topology(2, 0, 0)) << "with a least radius only where this is unknown";
    for (const double tolerance : {0.25, 0.1}) {
        const SampledUnion made = sampled_union(*solid, {.tolerance = tolerance});
        EXPECT_EQ(made.balls.fit->repair.topology, known_topology(2, 0, 0));
        EXPECT_LT(made.balls.balls.size(), 5 * made.samples.points.size()) << "tolerance " << tolerance;
    }
}

TEST(Repair, EndsIfTheSolidIsWrong) {
    const Case c = case_of(thin_tube(2.0, 2.1, 1.0), 0.12);
    const auto bits = [](const Point& p) { return static_cast<std::uint64_t>(std::abs(p.x * p.y * 1e15)); };
    KnownSolid lying(
        c.solid->bounds(), [&](const Point& p) { return random_unit(1, bits(p)) - 0.5; },
        [&](const Point& p) -> std::optional<Point> {
            const auto along = [&](std::uint64_t k) { return 4.0 * random_unit(2, bits(p), k) - 2.0; };
            return Point{along(0), along(1), along(2)};
        });
    lying.lie();
    EXPECT_THROW(repair(c.fitted, c.samples, lying, c.options), UnusableInput);
}

TEST(CoveringBalls, AreThoseThatPointsAreFarWithout) {
    constexpr std::uint64_t kSeed = 11;
    std::vector<Ball> balls(200);
    std::vector<Point> points(500);
    const auto random_point = [](std::uint64_t kind, std::uint64_t i) {
        return Point{random_unit(kSeed, kind, 3 * i), random_unit(kSeed, kind, 3 * i + 1),
                     random_unit(kSeed, kind, 3 * i + 2)};
    };
    for (std::size_t i = 0; i < balls.size(); ++i) {
        balls[i] = {random_point(0, i), 0.02 + 0.2 * random_unit(kSeed, 1, i)};
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = random_point(2, i);
    }
    balls[7].radius = balls[3].radius;  // of equal ones the first comes first
    for (const double reach : {0.0, 0.05, 0.2}) {
        const auto is_near = [&](const Ball& ball, const Point& p) {
            return distance(ball.center, p) <= ball.radius + reach;
        };
        std::vector<Index> order(balls.size());
        std::iota(order.begin(), order.end(), Index{0});
        std::ranges::stable_sort(order, [&](Index i, Index j) { return balls[i].radius > balls[j].radius; });
        std::vector<Index> expected;
        std::vector<Point> left = points;
        for (const Index i : order) {
            if (std::erase_if(left, [&](const Point& p) { return is_near(balls[i], p); }) > 0) {
                expected.push_back(i);
            }
        }
        std::ranges::sort(expected);
        EXPECT_EQ(covering_balls(balls, points, reach), expected) << "reach " << reach << ", seed " << kSeed;
        EXPECT_LT(expected.size(), balls.size());
    }
}

TEST(CoveringBalls, MakeAUnionAsNearWithFewerBalls) {
    const std::unique_ptr<Solid> solid =
        mesh_solid(revolved_mesh({{0.0, -2.0}, {0.5, -2.0}, {0.5, 2.0}, {0.0, 2.0}}, 48, 0.2));
    const double tolerance = 0.1;
    const SampledUnion needed = sampled_union(*solid, {.tolerance = tolerance});
    const SampledUnion all = sampled_union(*solid, {.tolerance = tolerance}, {.keeps_all = true});
    EXPECT_LT(3 * needed.balls.balls.size(), 2 * all.balls.balls.size());
    EXPECT_GT(needed.balls.fit->not_needed, 0);
    EXPECT_EQ(all.balls.fit->not_needed, 0);
    for (const SampledUnion* made : {&needed, &all}) {
        EXPECT_EQ(made->balls.fit->repair.topology, known_topology(1, 0, 0));
        EXPECT_LE(made->balls.fit->accuracy.largest_distance, kPromise * tolerance);
    }
    const SamplingOptions uniform{.tolerance = tolerance, .sizing = Sizing::kUniform};
    EXPECT_EQ(sampled_union(*solid, uniform).balls.balls,
              sampled_union(*solid, uniform, {.keeps_all = true}).balls.balls);
}

TEST(FitAndRepair, GiveTheSameBytesForAnyNumberOfThreads) {
    const TriangleMesh mesh = thin_tube(2.0, 2.1, 1.0);
    const auto solid = mesh_solid(mesh);
    const Samples samples = sampled(*solid, 0.08);
    const std::vector<Ball> balls = inner_balls(samples);
    std::vector<std::vector<Ball>> results;
    std::vector<std::vector<Contacts>> contacts;
    for (const int threads : {1, 2, 3}) {
        const Execution execution{.threads = threads};
        const FittedBalls fitted = fit(balls, *solid, {1e-3}, execution);
        const RepairedBalls result =
            repair(fitted, samples, *solid, {.topology = solid->topology(), .slack = 1e-3}, execution);
        EXPECT_GT(result.report.added, 0);
        results.push_back(result.balls);
        contacts.push_back(result.contacts);
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
    EXPECT_EQ(contacts[0], contacts[1]);
    EXPECT_EQ(contacts[0], contacts[2]);
}

TEST(FitAndRepair, ReportProgressAndCanBeCancelled) {
    const Case c = case_of(thin_tube(2.0, 2.1, 1.0), 0.12);
    const std::vector<Ball> balls = inner_balls(c.samples);
    expect_progress_and_cancellation([&](const Execution& execution) { fit(balls, *c.solid, {1e-3}, execution); });
    expect_progress_and_cancellation([&](const Execution& execution) { repaired(c, execution); });
}

TEST(FittedUnion, IsAnOptionOfThePipeline) {
    const auto solid = mesh_solid(thin_tube(2.0, 2.1, 1.0));
    ScaleAxisOptions options;
    options.delta = Length::absolute(0.12);
    options.scales = {1.0};
    options.union_kind = UnionKind::kFitted;
    const ScaleAxis fitted = scale_axis(*solid, options);
    ASSERT_TRUE(fitted.fit.has_value());
    EXPECT_EQ(fitted.contacts.size(), fitted.balls.size());
    EXPECT_EQ(fitted.axes[0].medial_statistics.dual_complex, known_topology(1, 1, 0));
    ASSERT_EQ(fitted.warnings.size(), 1U);
    EXPECT_EQ(fitted.warnings[0].code, "axis.thin_part");
    EXPECT_NEAR(2.0 * fitted.fit->accuracy.thickest.radius, 0.1, 0.002);
    options.union_kind = UnionKind::kPolar;
    const ScaleAxis polar = scale_axis(*solid, options);
    EXPECT_FALSE(polar.fit.has_value());
    EXPECT_TRUE(polar.contacts.empty());
    EXPECT_GT(polar.axes[0].complex.sheets, 5 * fitted.axes[0].complex.sheets);

    options.union_kind = UnionKind::kFitted;
    const ImplicitSolid unknowing = torus_solid(1.0, 0.4);
    EXPECT_THROW(scale_axis(unknowing, options), UnusableInput);
    options.delta.reset();
    EXPECT_THROW(scale_axis(sampled(*solid, 0.12), options), InvalidOption);
}

TEST(FittedUnion, IsTheDefaultWhereTheSolidAllows) {
    const ScaleAxisOptions options{.delta = Length::relative(0.05), .scales = {1.0}};
    EXPECT_TRUE(scale_axis(*mesh_solid(ball_mesh(1.0, 20)), options).fit.has_value());
    EXPECT_FALSE(scale_axis(torus_solid(1.0, 0.4), options).fit.has_value());

    const ImplicitSolid box = box_solid({1.0, 0.7, 0.4});
    const KnownSolid wrong(box.bounds(), box.function(), [](const Point&) { return Point{0, 0, 0.4}; });
    const ScaleAxis axis = scale_axis(wrong, options);
    EXPECT_FALSE(axis.fit.has_value());
    ASSERT_EQ(axis.warnings.size(), 1U);
    EXPECT_EQ(axis.warnings[0].code, "balls.polar");
    EXPECT_EQ(axis.balls.size(), inner_balls(sample(wrong, {.tolerance = axis.tolerance})).size());
    EXPECT_THROW(
        scale_axis(wrong, {.delta = Length::relative(0.05), .union_kind = UnionKind::kFitted, .scales = {1.0}}),
        UnusableInput);
}

/// A unit cube with a flap along one side, which hangs on a neck; both are this thick.
TriangleMesh cube_with_flap(double gap, double thickness) {
    const double a = 1.0 + gap, b = a + thickness, top = 0.5 + thickness;
    const std::vector<std::array<double, 2>> profile{{0, 0},   {1, 0},   {1, 0.5}, {a, 0.5}, {a, 0.3},
                                                     {b, 0.3}, {b, top}, {1, top}, {1, 1},   {0, 1}};
    const auto n = static_cast<Index>(profile.size());
    TriangleMesh mesh;
    for (const double z : {0.0, 1.0}) {
        for (const auto& [x, y] : profile) {
            mesh.vertices.push_back({x, y, z});
        }
    }
    const std::vector<std::array<Index, 3>> caps{{0, 1, 2}, {0, 2, 7}, {0, 7, 8}, {0, 8, 9},
                                                 {2, 3, 6}, {2, 6, 7}, {3, 4, 5}, {3, 5, 6}};
    for (const auto& [u, v, w] : caps) {
        mesh.triangles.push_back({u, w, v});
        mesh.triangles.push_back({u + n, v + n, w + n});
    }
    for (Index i = 0; i < n; ++i) {
        const Index next = (i + 1) % n;
        mesh.triangles.push_back({i, next, next + n});
        mesh.triangles.push_back({i, next + n, i + n});
    }
    return mesh;
}

TEST(FittedUnion, DoesNotFillFoldsThatNoPointNeeds) {
    const double delta = 0.05;
    const auto solid = mesh_solid(cube_with_flap(0.2 * delta, 0.002 * delta));
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::absolute(delta), .scales = {1.0}});
    const RepairReport& repair = axis.fit->repair;
    EXPECT_EQ(repair.topology, known_topology(1, 0, 0));
    EXPECT_EQ(repair.far_points, 0);
    EXPECT_EQ(repair.steps.back().name, "islands");
    EXPECT_LT(repair.steps.front().added, 300) << "2,900 balls would fill the flap";
    EXPECT_GT(axis.fit->not_needed, 0);
}

TEST(FittedUnion, TakesSmallBallsWherePartsHangOnThem) {
    const double delta = 0.2;
    const auto solid = mesh_solid(dumbbell_mesh(1.0, 1.05, 0.004 * delta, 8));
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::absolute(delta), .scales = {1.0}});
    const RepairReport& repair = axis.fit->repair;
    EXPECT_EQ(repair.topology, known_topology(1, 0, 0));
    EXPECT_EQ(repair.far_points, 0);
    EXPECT_EQ(repair.steps.back().name, "small balls");
    EXPECT_GT(axis.fit->not_needed, 0);
}

TEST(FittedUnion, GapsThatGrowingClosesAreNamed) {
    constexpr double kGap = 0.05;
    const TriangleMesh cube = box_mesh({0, 0, 0}, {1, 1, 1});
    const auto solid = mesh_solid(together(cube, box_mesh({1.0 + kGap, 0, 0}, {2.0 + kGap, 1, 1})));
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.03), .scales = {1.0, 1.02, 1.15}});
    EXPECT_EQ(axis.solid_topology, known_topology(2, 0, 0));
    for (int i : {0, 1}) {
        EXPECT_EQ(axis.axes[i].medial_statistics.dual_complex, known_topology(2, 0, 0));
        EXPECT_TRUE(axis.axes[i].closed_gaps.empty());
    }
    EXPECT_EQ(axis.axes[2].medial_statistics.dual_complex.components, 1);
    ASSERT_EQ(axis.warnings.size(), 1U);
    EXPECT_EQ(axis.warnings[0].code, "axis.growth_topology");
    ASSERT_FALSE(axis.axes[2].closed_gaps.empty());
    double last = 1.0;
    for (const Gap& gap : axis.axes[2].closed_gaps) {
        EXPECT_NEAR(gap.place.x, 1.0 + 0.5 * kGap, 0.3 * kGap);
        EXPECT_GE(gap.width, kGap - 1e-9);
        EXPECT_LT(gap.width, 3.0 * kGap);
        EXPECT_GE(gap.scale, last);
        last = gap.scale;
    }
    EXPECT_LE(last, 1.15);
}

}  // namespace
}  // namespace scaleaxis
