// SPDX-License-Identifier: Apache-2.0
//
// Point clouds: points taken from solids whose shape and topology are known.
#include "scaleaxis/cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "base/random.hpp"
#include "executions.hpp"
#include "meshes.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/crust.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solid/cloud/normals.hpp"
#include "solid/cloud/outliers.hpp"
#include "solids.hpp"
#include "spatial/point_tree.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

/// Three tunnels: a slab with holes, rounded.
ImplicitSolid genus3_solid() {
    const Point half{1.7, 0.6, 0.25};
    return {centered_box(half.x, half.y, half.z),
            [=](const Point& p) {
                const Point q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
                double value = std::max({q.x, q.y, q.z});
                for (const double x : {-1.0, 0.0, 1.0}) {
                    value = std::max(value, 0.3 - std::hypot(p.x - x, p.y));
                }
                return value;
            },
            known_topology(1, 3, 0)};
}

Point gradient(const ImplicitSolid& solid, const Point& p) {
    const double h = 1e-6;
    const auto along = [&](const Point& d) { return (solid.value(p + d) - solid.value(p - d)) / (2.0 * h); };
    const Point g{along({h, 0, 0}), along({0, h, 0}), along({0, 0, h})};
    return (1.0 / norm(g)) * g;
}

/// Points of the boundary about `spacing` apart, with their normals; moved along these by random lengths.
PointCloud cloud_of(const ImplicitSolid& solid, double spacing, double noise = 0.0) {
    PointCloud cloud{sample(solid, {.tolerance = spacing, .sizing = Sizing::kUniform}).points, {}};
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        Point& p = cloud.points[i];
        cloud.normals.push_back(gradient(solid, p));
        p = p + noise * (2.0 * random_unit(7, i) - 1.0) * cloud.normals.back();
    }
    return cloud;
}

PointCloud without_normals(PointCloud cloud) {
    cloud.normals.clear();
    return cloud;
}

/// The largest difference between the radius of a ball and the depth of its centre.
double worst_radius(const std::vector<Ball>& balls, const ImplicitSolid& solid) {
    double worst = 0.0;
    for (const auto& [center, radius] : balls) {
        worst = std::max(worst, std::abs(solid.value(center) + radius));
    }
    return worst;
}

ScaleAxisOptions with_tolerance(double tolerance, double scale = 1.0) {
    ScaleAxisOptions options;
    options.delta = Length::absolute(tolerance);
    options.scales = {scale};
    return options;
}

void expect_topology(const ScaleAxis& axis, const Topology& expected) {
    const AxisAtScale& result = axis.axes.front();
    EXPECT_TRUE(agree(result.medial_statistics.dual_complex, expected))
        << testing::PrintToString(expected) << " expected, "
        << testing::PrintToString(result.medial_statistics.dual_complex);
    EXPECT_TRUE(agree(topology(result.complex), expected)) << testing::PrintToString(topology(result.complex));
}

struct Case {
    std::string name;
    std::shared_ptr<ImplicitSolid> solid;
    double spacing;
};

std::vector<Case> cases() {
    const auto shared = [](ImplicitSolid* solid) { return std::shared_ptr<ImplicitSolid>(solid); };
    return {{"ball", shared(new ImplicitSolid(ball_solid(1.0))), 0.1},
            {"torus", shared(new ImplicitSolid(torus_solid(1.0, 0.4))), 0.08},
            {"box", shared(new ImplicitSolid(box_solid({1.0, 0.7, 0.4}))), 0.05},
            {"shell", shared(new ImplicitSolid(shell_solid(1.0, 0.5))), 0.08},
            {"genus 3", shared(new ImplicitSolid(genus3_solid())), 0.05}};
}

TEST(MovingLeastSquares, GivesTheSolidThatThePointsAreFrom) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const PointCloud given = cloud_of(*c.solid, c.spacing);
        for (const PointCloud& cloud : {given, without_normals(given)}) {
            SCOPED_TRACE(cloud.normals.empty() ? "without normals" : "with normals");
            const auto solid = cloud_solid(prepare(cloud));
            const ScaleAxis axis = scale_axis(*solid, with_tolerance(c.spacing, 1.05));
            expect_topology(axis, *c.solid->topology());
            EXPECT_LT(worst_radius(axis.balls, *c.solid), 2.0 * c.spacing);
        }
    }
}

TEST(MovingLeastSquares, IsFinerThanThePointsAreApart) {
    const ImplicitSolid ball = ball_solid(1.0);
    const auto solid = cloud_solid(prepare(cloud_of(ball, 0.2)));
    const Samples samples = sample(*solid, {.tolerance = 0.05, .sizing = Sizing::kUniform});
    EXPECT_GT(samples.points.size(), 3000U);
    for (const Point& p : samples.points) {
        EXPECT_NEAR(norm(p), 1.0, 0.01) << "spheres fit a sphere";
    }
}

TEST(MovingLeastSquares, KeepsEdges) {
    const ImplicitSolid box = box_solid({1.0, 0.7, 0.4});
    const double spacing = 0.05;
    const auto solid = cloud_solid(prepare(cloud_of(box, spacing)));
    for (const Point& p : sample(*solid, {.tolerance = spacing, .sizing = Sizing::kUniform}).points) {
        EXPECT_LT(std::abs(box.value(p)), 0.5 * spacing);
    }
}

TEST(MovingLeastSquares, SmoothsNoise) {
    const double spacing = 0.04;
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    for (const double noise : {0.3, 1.0}) {
        SCOPED_TRACE(noise);
        const PointCloud cloud = cloud_of(torus, spacing, noise * spacing);
        const PreparedCloud prepared = prepare(without_normals(cloud));
        EXPECT_GT(prepared.report.noise, 0.1 * noise);
        const auto solid = cloud_solid(prepared);
        const ScaleAxis axis = scale_axis(*solid, with_tolerance(2.0 * spacing, 1.05));
        expect_topology(axis, *torus.topology());
        for (const Point& p : sample(*solid, {.tolerance = spacing, .sizing = Sizing::kUniform}).points) {
            EXPECT_LT(std::abs(torus.value(p)), (0.5 + 0.7 * noise) * spacing);
        }
    }
    EXPECT_GT(prepare(cloud_of(torus, spacing, spacing)).report.kernel,
              prepare(cloud_of(torus, spacing)).report.kernel);
}

TEST(MovingLeastSquares, TakesFewPoints) {
    for (const ImplicitSolid& solid : {ball_solid(1.0), torus_solid(1.0, 0.4)}) {
        const double spacing = 0.35;
        const PointCloud cloud = cloud_of(solid, spacing);
        EXPECT_LT(cloud.points.size(), 300U);
        const auto fitted = cloud_solid(prepare(cloud));
        const ScaleAxis axis = scale_axis(*fitted, with_tolerance(0.1));
        expect_topology(axis, *solid.topology());
        EXPECT_LT(worst_radius(axis.balls, solid), 0.1 + 0.3 * spacing);
    }
}

TEST(MovingLeastSquares, TakesUnevenPoints) {
    const ImplicitSolid ball = ball_solid(1.0);
    PointCloud cloud = cloud_of(ball, 0.03);
    PointCloud uneven;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const double share = cloud.points[i].z > 0.0 ? 1.0 : 0.06;
        if (random_unit(3, i) < share) {
            uneven.points.push_back(cloud.points[i]);
        }
    }
    const PreparedCloud prepared = prepare(uneven);
    const auto [finest, coarsest] = std::ranges::minmax_element(prepared.spacings);
    EXPECT_GT(*coarsest, 3.0 * *finest);
    const auto solid = cloud_solid(prepared);
    const ScaleAxis axis = scale_axis(*solid, with_tolerance(0.06));
    expect_topology(axis, *ball.topology());
    EXPECT_LT(worst_radius(axis.balls, ball), 0.06);
}

TEST(MovingLeastSquares, IsDefinedFarFromThePoints) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const auto solid = cloud_solid(prepare(cloud_of(torus, 0.1)));
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const auto coordinate = [&](std::uint64_t k) { return 4.0 * random_unit(5, i, k) - 2.0; };
        const Point p = (i % 10 == 0 ? 1000.0 : 1.0) * Point{coordinate(0), coordinate(1), coordinate(2)};
        if (std::abs(torus.value(p)) > 0.02) {
            ASSERT_EQ(solid->inside(p), torus.value(p) < 0.0) << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
}

TEST(MovingLeastSquares, FindsCrossings) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const auto solid = cloud_solid(prepare(cloud_of(torus, 0.05)));
    int crossed = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const auto coordinate = [&](std::uint64_t k) { return 3.0 * random_unit(9, i, k) - 1.5; };
        const Point a{coordinate(0), coordinate(1), 0.3 * coordinate(2)};
        const Point b{coordinate(3), coordinate(4), coordinate(5)};
        if (!solid->inside(a) || solid->inside(b)) {
            EXPECT_FALSE(solid->crossing(a, b, a)) << "an even number of crossings, or the wrong way round";
            continue;
        }
        const auto crossing = solid->crossing(a, b, a);
        ASSERT_TRUE(crossing);
        ++crossed;
        const Point step = 1e-5 / distance(a, b) * (b - a);
        EXPECT_TRUE(solid->inside(*crossing - step));
        EXPECT_FALSE(solid->inside(*crossing + step));
        // The last place where a dense row of points changes sides is the farthest one.
        constexpr int kSteps = 2000;
        double last = 0.0;
        for (int k = 1; k <= kSteps; ++k) {
            const Point p = a + static_cast<double>(k) / kSteps * (b - a);
            last = solid->inside(p) ? static_cast<double>(k) / kSteps : last;
        }
        EXPECT_NEAR(distance(*crossing, a), last * distance(a, b), 1.1 / kSteps * distance(a, b));
    }
    EXPECT_GT(crossed, 200);
}

TEST(MovingLeastSquares, ClosesAnOpenSurfaceAtItsHull) {
    const ImplicitSolid ball = ball_solid(1.0);
    PointCloud cloud = cloud_of(ball, 0.08);
    PointCloud half;
    for (const Point& p : cloud.points) {
        if (p.z > 0.0) {
            half.points.push_back(p);
        }
    }
    const PreparedCloud prepared = prepare(half);
    EXPECT_GT(prepared.report.border_points, 20);
    EXPECT_NE(prepared.report.warnings().at(0).message.find("border"), std::string::npos);
    const auto solid = cloud_solid(prepared);
    const ScaleAxis axis = scale_axis(*solid, with_tolerance(0.08));
    expect_topology(axis, known_topology(1, 0, 0));
    EXPECT_TRUE(solid->inside({0.0, 0.0, 0.1}));
    EXPECT_FALSE(solid->inside({0.0, 0.0, -0.1}));
}

TEST(MovingLeastSquares, DoesNotDependOnThreads) {
    const PointCloud cloud = without_normals(cloud_of(torus_solid(1.0, 0.4), 0.06, 0.02));
    const auto balls = [&](int threads) {
        const Execution execution{threads};
        const auto solid = cloud_solid(prepare(cloud, {}, execution), {}, execution);
        return scale_axis(*solid, with_tolerance(0.06), execution).balls;
    };
    EXPECT_EQ(balls(1), balls(4));
}

TEST(MovingLeastSquares, RefusesKernelsOutOfRange) {
    const PreparedCloud cloud = prepare(cloud_of(ball_solid(1.0), 0.2));
    EXPECT_THROW(cloud_solid(cloud, {.kernel = 1.0}), InvalidOption);
    EXPECT_THROW(cloud_solid(cloud, {.kernel = 1000.0}), InvalidOption);
    EXPECT_THROW(cloud_solid(cloud, {.kernel = std::nan("")}), InvalidOption);
}

TEST(Crust, GivesTheSolidThatThePointsAreFrom) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const PointCloud cloud = without_normals(cloud_of(*c.solid, c.spacing));
        const ScaleAxis axis = scale_axis(crust(prepare(cloud)), {.scales = {1.05}});
        EXPECT_EQ(axis.samples, static_cast<Index>(cloud.points.size()));
        expect_topology(axis, *c.solid->topology());
        EXPECT_LT(worst_radius(axis.balls, *c.solid), 2.0 * c.spacing);
        EXPECT_LT(axis.tolerance, c.spacing);
        EXPECT_GT(axis.tolerance, 0.2 * c.spacing);
    }
}

TEST(Crust, AgreesWithThePipelineFromTheMesh) {
    const TriangleMesh mesh = dumbbell_mesh(0.5, 1.0, 0.2, 60);
    const auto solid = mesh_solid(mesh);
    const double tolerance = 0.05;
    const Samples samples = sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
    const Samples from_points = crust(prepare(PointCloud{samples.points, {}}));
    const SurfaceDistance distance = surface_distance(
        BallUnion(inner_balls(samples)), BallUnion(inner_balls(from_points)), {.spacing = 0.5 * tolerance});
    EXPECT_LT(distance.max(), 0.5 * tolerance);
}

TEST(Crust, DoesNotDependOnThreads) {
    const PreparedCloud cloud = prepare(without_normals(cloud_of(torus_solid(1.0, 0.4), 0.05)));
    EXPECT_EQ(inner_balls(crust(cloud, {1})), inner_balls(crust(cloud, {4})));
}

TEST(Points, OfEitherWayAgree) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const double spacing = 0.06;
    const PreparedCloud cloud = prepare(without_normals(cloud_of(torus, spacing)));
    const auto mls = cloud_solid(cloud);
    const double tolerance = 0.05;
    const SurfaceDistance distance =
        surface_distance(BallUnion(inner_balls(sample(*mls, {.tolerance = tolerance, .sizing = Sizing::kUniform}))),
                         BallUnion(inner_balls(crust(cloud))), {.spacing = tolerance});
    EXPECT_LT(distance.max(), tolerance + spacing);
}

TEST(Points, OrientsNormalsOutward) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const PointCloud given = cloud_of(*c.solid, c.spacing);
        const PreparedCloud prepared = prepare(without_normals(given));
        EXPECT_FALSE(prepared.report.has_normals);
        EXPECT_EQ(prepared.report.parts, c.name == "shell" ? 2 : 1);
        for (std::size_t i = 0; i < given.points.size(); ++i) {
            EXPECT_GT(dot(prepared.cloud.normals[i], given.normals[i]), 0.0);
        }
        PointCloud inward = given;
        for (Point& normal : inward.normals) {
            normal = -3.0 * normal;
        }
        const PreparedCloud flipped = prepare(inward);
        EXPECT_EQ(flipped.report.flipped_normals, flipped.report.kept());
        EXPECT_EQ(flipped.report.parts, 0);
        EXPECT_EQ(flipped.report.warnings().size(), 1U);
        for (std::size_t i = 0; i < given.points.size(); ++i) {
            EXPECT_LT(distance(flipped.cloud.normals[i], given.normals[i]), 1e-12);
        }
    }
}

// Two balls, one of which faces inward; and one in the other, which is a void, whatever its normals say.
TEST(Points, TurnsClosedPartsThatFaceTheWrongWay) {
    const PointCloud ball = cloud_of(ball_solid(1.0), 0.1);
    for (const auto& [place, sign] : {std::pair(3.0, -1.0), std::pair(0.0, 1.0)}) {
        PointCloud both = ball;
        for (std::size_t i = 0; i < ball.points.size(); ++i) {
            both.points.push_back(0.5 * ball.points[i] + Point{place, 0.0, 0.0});
            both.normals.push_back(sign * ball.normals[i]);
        }
        const PreparedCloud prepared = prepare(both);
        EXPECT_EQ(prepared.report.flipped_normals, std::ssize(ball.points));
        EXPECT_EQ(prepared.report.warnings().size(), 1U);
        ASSERT_EQ(prepared.cloud.points, both.points);
        for (std::size_t i = 0; i < both.points.size(); ++i) {
            const double turn = i < ball.points.size() ? 1.0 : -1.0;
            EXPECT_LT(distance(prepared.cloud.normals[i], turn * both.normals[i]), 1e-12);
        }
    }
}

TEST(Points, TurnsNormalsThatContradictEachOther) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const PointCloud given = cloud_of(torus, 0.08);
    PointCloud mixed = given;
    for (std::size_t i = 0; i < mixed.normals.size(); ++i) {
        if (random_unit(2, i) < 0.3) {
            mixed.normals[i] = -1.0 * mixed.normals[i];
        }
    }
    EXPECT_FALSE(prepare(given).report.are_normals_inconsistent());
    const PreparedCloud prepared = prepare(mixed);
    EXPECT_TRUE(prepared.report.are_normals_inconsistent());
    EXPECT_NE(prepared.report.warnings().at(0).message.find("against"), std::string::npos);
    for (std::size_t i = 0; i < given.points.size(); ++i) {
        EXPECT_LT(distance(prepared.cloud.normals[i], given.normals[i]), 1e-12);
    }
}

TEST(Points, EstimatesNormalsToSecondOrder) {
    const double spacing = 0.1;
    const ImplicitSolid ball = ball_solid(1.0);
    const PointCloud given = cloud_of(ball, spacing);
    const PreparedCloud prepared = prepare(without_normals(given));
    for (std::size_t i = 0; i < given.points.size(); ++i) {
        EXPECT_LT(distance(prepared.cloud.normals[i], given.normals[i]), 0.03);
    }
    EXPECT_LT(prepared.report.noise, 0.05);
    EXPECT_EQ(prepared.report.border_points, 0);
    EXPECT_GT(prepared.report.spacing, 0.8 * spacing);
    EXPECT_LT(prepared.report.spacing, 1.6 * spacing);
}

TEST(Points, HolesAreReported) {
    const ImplicitSolid ball = ball_solid(1.0);
    PointCloud cloud;
    for (const Point& p : cloud_of(ball, 0.05).points) {
        if (p.z < 0.9 && p.x > -0.96) {
            cloud.points.push_back(p);
        }
    }
    const CloudReport report = prepare(cloud).report;
    ASSERT_EQ(report.holes.size(), 2U);
    // The box around a circle of radius r has the diagonal 2 √2 r.
    EXPECT_NEAR(report.holes[0].width, 2.0 * std::sqrt(2.0 * (1.0 - 0.9 * 0.9)), 0.15);
    EXPECT_NEAR(report.holes[0].place.z, 0.9, 0.06);
    EXPECT_NEAR(report.holes[1].width, 2.0 * std::sqrt(2.0 * (1.0 - 0.96 * 0.96)), 0.15);
    EXPECT_NEAR(report.holes[1].place.x, -0.96, 0.04);
    ASSERT_FALSE(report.warnings().empty());
    EXPECT_NE(report.warnings().front().message.find("at 2 places"), std::string::npos);
}

TEST(Points, ChoosesTheMethodThatSuitsThem) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const PointCloud clean = cloud_of(torus, 0.06);
    const CloudChoice with_normals = choose_method(prepare(clean));
    EXPECT_EQ(with_normals.method, CloudMethod::kMovingLeastSquares);
    EXPECT_NE(with_normals.reason.find("normals"), std::string::npos);
    EXPECT_EQ(choose_method(prepare(without_normals(clean))).method, CloudMethod::kCrust);
    const CloudChoice noisy = choose_method(prepare(without_normals(cloud_of(torus, 0.06, 0.04))));
    EXPECT_EQ(noisy.method, CloudMethod::kMovingLeastSquares);
    EXPECT_NE(noisy.reason.find("noise"), std::string::npos) << noisy.reason;
}

TEST(Points, MergesDuplicates) {
    PointCloud cloud = cloud_of(ball_solid(1.0), 0.2);
    const std::size_t distinct = cloud.points.size();
    cloud.points.insert(cloud.points.end(), cloud.points.begin(), cloud.points.begin() + 10);
    cloud.normals.insert(cloud.normals.end(), 10, Point{0.0, 0.0, 1.0});
    const PreparedCloud prepared = prepare(cloud);
    EXPECT_EQ(prepared.report.duplicates, 10);
    EXPECT_EQ(prepared.cloud.points.size(), distinct);
    EXPECT_EQ(prepared.report.warnings().at(0).message,
              "10 of " + std::to_string(distinct + 10) + " points lie where others do: merged");
    for (std::size_t i = 0; i < distinct; ++i) {
        EXPECT_LT(distance(prepared.cloud.normals[i], cloud.normals[i]), 1e-12) << "that of the first point";
    }
}

TEST(Points, LeavesOutliersOut) {
    PointCloud cloud = without_normals(cloud_of(ball_solid(1.0), 0.1));
    cloud.points.insert(cloud.points.begin() + 5, {3.0, 0.0, 0.0});
    cloud.points.push_back({0.0, 0.0, 0.0});
    const PreparedCloud prepared = prepare(cloud);
    EXPECT_EQ(prepared.report.outliers, 2);
    EXPECT_EQ(prepared.cloud.points.size(), cloud.points.size() - 2);
    for (const Point& p : prepared.cloud.points) {
        EXPECT_NEAR(norm(p), 1.0, 1e-6);
    }
    EXPECT_NE(prepared.report.warnings().at(0).message.find("2 of "), std::string::npos);
}

/// Random points of the boundary of a shape, which has a density that differs between places.
struct Scatter {
    std::string name;
    std::function<Point(std::uint64_t)> point;
    std::function<double(const Point&)> density;  ///< [0, 1]
};

std::vector<Scatter> scatters() {
    const auto on_torus = [](std::uint64_t i) {
        // More of the outer side than of the inner one.
        for (std::uint64_t k = 0;; k += 3) {
            const double u = 2.0 * std::numbers::pi * random_unit(21, i, k);
            const double v = 2.0 * std::numbers::pi * random_unit(21, i, k + 1);
            const double r = 1.0 + 0.4 * std::cos(v);
            if (1.4 * random_unit(21, i, k + 2) < r) {
                return Point{r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)};
            }
        }
    };
    const auto on_box = [](std::uint64_t i) {
        const Point half{1.0, 0.7, 0.4};
        const double yz = half.y * half.z, xz = half.x * half.z, xy = half.x * half.y;
        const double face = random_unit(22, i, 0) * (yz + xz + xy);
        Point p{2.0 * random_unit(22, i, 1) - 1.0, 2.0 * random_unit(22, i, 2) - 1.0,
                2.0 * random_unit(22, i, 3) - 1.0};
        double& across = face < yz ? p.x : face < yz + xz ? p.y : p.z;
        across = across < 0.0 ? -1.0 : 1.0;
        return Point{half.x * p.x, half.y * p.y, half.z * p.z};
    };
    const auto even = [](const Point&) { return 1.0; };
    const auto stepped = [](const Point& p) { return p.x > 0.0 ? 1.0 : 0.1; };
    const auto graded = [](const Point& p) { return std::pow(0.1, std::clamp(0.5 * (p.x + 1.0), 0.0, 1.0)); };
    return {{"torus", on_torus, even},
            {"box", on_box, even},
            {"stepped torus", on_torus, stepped},
            {"graded box", on_box, graded}};
}

TEST(MovingLeastSquares, ErodesEdgesLittle) {
    const Point half{1.0, 0.7, 0.4};
    PointCloud cloud;
    for (std::uint64_t i = 0; i < 8000; ++i) {
        const Point p = scatters()[1].point(i);
        const auto along = [](double x, double most) { return std::abs(x) == most ? x / most : 0.0; };
        cloud.points.push_back(p);
        cloud.normals.push_back({along(p.x, half.x), along(p.y, half.y), along(p.z, half.z)});
    }
    const PreparedCloud prepared = prepare(cloud);
    const auto solid = cloud_solid(prepared);
    const Point out = (1.0 / std::sqrt(2.0)) * Point{0, 1, 1};
    double sum = 0.0;
    constexpr int kPlaces = 100;
    for (int i = 0; i < kPlaces; ++i) {
        const Point edge{1.6 * i / kPlaces - 0.8, half.y, half.z};
        const std::optional<Point> p = solid->crossing(edge - 0.2 * out, edge + 0.2 * out, edge);
        ASSERT_TRUE(p);
        sum += dot(edge - *p, out);
    }
    EXPECT_LT(sum / kPlaces, 0.1 * prepared.report.spacing);
}

// Points scattered at random over two arms of a square, with the normals of the faces: beside an edge some of one face
// may be missing, and those of the other one are the nearest to places far away, which their planes have behind them.
TEST(MovingLeastSquares, HasNothingInsideFarBeyondAnEdge) {
    const auto to_box = [](const Point& p, const Point& high) {
        const Point q{std::abs(p.x - 0.5 * high.x) - 0.5 * high.x, std::abs(p.y - 0.5 * high.y) - 0.5 * high.y,
                      std::abs(p.z - 0.5 * high.z) - 0.5 * high.z};
        return norm(Point{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)}) +
               std::min(0.0, std::max({q.x, q.y, q.z}));
    };
    const ImplicitSolid angle({{-0.1, -0.1, -0.1}, {4.1, 1.1, 4.1}}, [&](const Point& p) {
        return std::min(to_box(p, {4, 1, 1}), to_box(p, {1, 1, 4}));
    });
    const TriangleMesh faces = prism({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}, 1.0);  // in x and z, along y
    for (const std::uint64_t seed : {3U, 5U, 6U, 8U}) {  // of ten, those that have such a place
        SCOPED_TRACE("seed " + std::to_string(seed));
        PointCloud cloud;
        for (const auto& [a, b, c] : faces.triangles) {
            const auto at = [&](Index v) {
                return Point{faces.vertices[v].x, faces.vertices[v].z, faces.vertices[v].y};
            };
            const Point normal = cross(at(c) - at(a), at(b) - at(a));
            for (int i = 0; i < 120.0 * norm(normal); ++i) {
                const double u = std::sqrt(random_unit(seed, cloud.points.size(), 0));
                const double v = random_unit(seed, cloud.points.size(), 1);
                cloud.points.push_back(at(a) + u * (at(b) - at(a)) + u * v * (at(c) - at(b)));
                cloud.normals.push_back((1.0 / norm(normal)) * normal);
            }
        }
        const PreparedCloud prepared = prepare(cloud);
        const auto solid = cloud_solid(prepared);
        for (std::uint64_t i = 0; i < 20000; ++i) {
            const Point p{4.0 * random_unit(seed, i, 2), random_unit(seed, i, 3), 4.0 * random_unit(seed, i, 4)};
            if (angle.value(p) > 4.0 * prepared.report.spacing) {
                ASSERT_FALSE(solid->inside(p)) << p.x << ' ' << p.y << ' ' << p.z;
            }
        }
        const SampledUnion made = sampled_union(*solid, {.tolerance = 0.01 * solid->bounds().diagonal()});
        for (const Ball& ball : made.balls.balls) {
            ASSERT_LT(ball.radius + angle.value(ball.center), 4.0 * prepared.report.spacing);
        }
    }
}

// Towards the edge of a wedge its sides are nearer to each other than their points are: spheres fitted to points of
// both tell nothing there, and neither does the plane of the nearest point.
TEST(MovingLeastSquares, StaysNearItsPointsWhereSidesAreCloserThanThese) {
    const double slope = std::tan(10.0 / 180.0 * std::numbers::pi);
    const Point up = (1.0 / std::hypot(slope, 1.0)) * Point{-slope, 0, 1};
    const Point down{up.x, 0, -up.z};
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        PointCloud cloud;
        for (std::uint64_t i = 0; i < 2000; ++i) {
            const double u = random_unit(seed, i, 0), v = random_unit(seed, i, 1),
                         w = 2.0 * random_unit(seed, i, 2) - 1.0;
            // Of the two sides, the back and the two ends, by their areas.
            const double part = random_unit(seed, i, 3) * (4.0 / up.z + 12.0 * slope);
            const bool is_side = part < 4.0 / up.z;
            const bool is_back = !is_side && part < 4.0 / up.z + 4.0 * slope;
            const double x = is_side ? 2.0 * u : is_back ? 2.0 : 2.0 * std::sqrt(u);
            const double end = w < 0.0 ? 0.0 : 1.0;
            const double across = is_side ? (w < 0.0 ? -1.0 : 1.0) : is_back ? w : 2.0 * v - 1.0;
            cloud.points.push_back({x, is_side || is_back ? v : end, across * slope * x});
            cloud.normals.push_back(is_side   ? (w < 0.0 ? down : up)
                                    : is_back ? Point{1, 0, 0}
                                              : Point{0, 2.0 * end - 1.0, 0});
        }
        const PreparedCloud prepared = prepare(cloud);
        const auto solid = cloud_solid(prepared);
        const SampledUnion made = sampled_union(*solid, {.tolerance = 0.005 * solid->bounds().diagonal()});
        for (const Ball& ball : made.balls.balls) {
            const Point& c = ball.center;
            const double beyond = std::max({dot(up, c), dot(down, c), c.x - 2.0, -c.x, -c.y, c.y - 1.0});
            ASSERT_LT(beyond + ball.radius, 2.5 * prepared.report.spacing) << c.x << ' ' << c.y << ' ' << c.z;
        }
    }
}

TEST(Points, AreThinnedWhereTheyAreDense) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    PointCloud cloud;
    for (std::uint64_t i = 0; i < 40'000; ++i) {
        cloud.points.push_back(scatters()[0].point(i));
        cloud.normals.push_back(gradient(torus, cloud.points.back()));
    }
    const double least = 0.06;
    const PreparedCloud thinned = prepare(cloud, {.thinning = least});
    const std::vector<Point>& kept = thinned.cloud.points;
    EXPECT_EQ(thinned.report.kept(), static_cast<Index>(kept.size()));
    EXPECT_EQ(thinned.report.thinned, static_cast<Index>(cloud.points.size() - kept.size()));
    EXPECT_LT(kept.size(), 5000U);
    const PointTree tree = build_point_tree(kept);
    std::vector<NearPoint> near;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        nearest_points(tree, kept[i], 2, near);
        EXPECT_GE(near[1].squared_distance, least * least);
        EXPECT_GT(dot(thinned.cloud.normals[i], gradient(torus, kept[i])), 0.999) << "the normal of another point";
    }
    for (const Point& p : cloud.points) {
        EXPECT_LE(nearest_point(tree, p).squared_distance, least * least);
    }
    const ScaleAxis axis = scale_axis(*cloud_solid(thinned), with_tolerance(4.0 * least, 1.05));
    expect_topology(axis, *torus.topology());
    EXPECT_EQ(choose_method(prepare(without_normals(cloud), {.thinning = least})).method,
              CloudMethod::kMovingLeastSquares)
        << "the crust would take them all as samples";
    const PreparedCloud all = prepare(cloud, {.thinning = 0.5 * prepare(cloud).report.spacing});
    EXPECT_EQ(all.report.thinned, 0) << "half of them would stay";
    EXPECT_EQ(all.cloud.points, prepare(cloud).cloud.points);
    EXPECT_EQ(prepare(cloud, {.thinning = least}, {1}).cloud.points,
              prepare(cloud, {.thinning = least}, {4}).cloud.points);
    for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(prepare(cloud, {.thinning = bad}), InvalidOption);
    }
}

TEST(Points, AreThinnedToAPartOfTheTolerance) {
    const std::vector<Point> points{{0, 0, 0}, {3, 4, 0}, {std::nan(""), 100, 100}};
    EXPECT_EQ(prepare_options(points, std::nullopt).thinning, 0.0);
    EXPECT_DOUBLE_EQ(prepare_options(points, Length::relative(0.01)).thinning, 0.25 * 0.05);
    EXPECT_DOUBLE_EQ(prepare_options(points, Length::absolute(0.1)).thinning, 0.25 * 0.1);
    EXPECT_EQ(prepare_options({}, Length::relative(0.01)).thinning, 0.0);
    EXPECT_EQ(finest_delta({}), kDefaultDelta);
    EXPECT_EQ(finest_delta({.delta = Length::absolute(0.4)}), Length::absolute(0.4));
    EXPECT_EQ(finest_delta({.delta_range = DeltaRange{Length::relative(0.02), Length::relative(0.005)}}),
              Length::relative(0.005));
}

// Outliers within a fraction of the spacing of the points cannot be told from noise, and do as little harm.
void expect_outliers_found(const std::vector<Scatter>& among) {
    constexpr std::size_t kPoints = 50'000;
    constexpr std::size_t kOutliers = 1500;
    for (const Scatter& scatter : among) {
        SCOPED_TRACE(scatter.name);
        PointCloud cloud;
        Box box;
        for (std::uint64_t i = 0; cloud.points.size() < kPoints; ++i) {
            const Point p = scatter.point(i);
            if (random_unit(23, i) < scatter.density(p)) {
                cloud.points.push_back(p);
                box.extend(p);
            }
        }
        const PreparedCloud clean = prepare(cloud);
        EXPECT_LE(clean.report.outliers, static_cast<Index>(kPoints / 1000));
        const Point size = box.max - box.min;
        const PointTree surface = build_point_tree(clean.cloud.points);
        std::vector<Point> far;
        for (std::uint64_t i = 0; i < kOutliers; ++i) {
            const Point p = box.min + Point{size.x * random_unit(24, i, 0), size.y * random_unit(24, i, 1),
                                            size.z * random_unit(24, i, 2)};
            const NearPoint near = nearest_point(surface, p);
            if (std::sqrt(near.squared_distance) > 2.0 * clean.spacings[surface.order[near.position]]) {
                far.push_back(p);
            }
            cloud.points.push_back(p);
        }
        ASSERT_GT(far.size(), kOutliers / 2);
        const PreparedCloud prepared = prepare(cloud);
        std::vector<Point> kept = prepared.cloud.points;
        const auto before = [](const Point& a, const Point& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        };
        std::ranges::sort(kept, before);
        const auto count_kept = [&](const auto& points) {
            return std::ranges::count_if(points,
                                         [&](const Point& p) { return std::ranges::binary_search(kept, p, before); });
        };
        EXPECT_LT(count_kept(far), static_cast<std::ptrdiff_t>(far.size() / 100));
        EXPECT_GT(count_kept(std::span(cloud.points).first(kPoints)),
                  static_cast<std::ptrdiff_t>(kPoints - kPoints / 1000));
    }
}

TEST(Points, FindsOutliersByDensity) { expect_outliers_found({scatters().front()}); }

TEST(PointsSweep, FindsOutliersByDensity) {
    const std::vector<Scatter> all = scatters();
    ASSERT_GT(all.size(), 1U);
    expect_outliers_found({all.begin() + 1, all.end()});
}

TEST(Points, EstimatesAllNormalsWhereSomeAreUnknown) {
    PointCloud cloud = cloud_of(ball_solid(1.0), 0.1);
    cloud.normals[3] = {};
    cloud.normals[4] = {std::nan(""), 0.0, 0.0};
    const PreparedCloud prepared = prepare(cloud);
    EXPECT_EQ(prepared.report.unknown_normals, 2);
    EXPECT_EQ(prepared.report.parts, 1);
    EXPECT_NE(prepared.report.warnings().at(0).message.find("2 normals"), std::string::npos);
    EXPECT_GT(dot(prepared.cloud.normals[3], prepared.cloud.points[3]), 0.9);
}

TEST(Points, RefusesWhatBoundsNoSolid) {
    const auto fault_of = [](const PointCloud& cloud) {
        const PreparedCloud prepared = prepare(cloud);
        EXPECT_THROW(cloud_solid(prepared), UnusableInput);
        EXPECT_THROW(crust(prepared), UnusableInput);
        return prepared.report.fault.message;
    };
    EXPECT_NE(fault_of({}).find("there are 0 different points"), std::string::npos);
    EXPECT_NE(fault_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}}).find("3 different points"), std::string::npos);
    EXPECT_NE(fault_of({std::vector<Point>(100, {1, 2, 3}), {}}).find("1 different points"), std::string::npos);
    PointCloud plane;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const double x = random_unit(1, i, 0);
        const double y = random_unit(1, i, 1);
        plane.points.push_back({100.0 + x, y, 0.3 * x - 0.7 * y});
    }
    EXPECT_NE(fault_of(plane).find("plane"), std::string::npos);
    PointCloud line;
    for (int i = 0; i < 10; ++i) {
        line.points.push_back({1.0 * i, 2.0 * i, 3.0 * i});
    }
    EXPECT_NE(fault_of(line).find("plane"), std::string::npos);
}

TEST(Points, LeavesOutThoseThatAreNotFinite) {
    const PointCloud sound = cloud_of(ball_solid(1.0), 0.2);
    const PreparedCloud expected = prepare(sound);
    PointCloud damaged = sound;
    const auto add = [&](std::size_t at, double bad) {
        Point p = damaged.points[at];
        (at % 2 == 0 ? p.x : p.z) = bad;
        damaged.points.insert(damaged.points.begin() + static_cast<std::ptrdiff_t>(at), p);
        damaged.normals.insert(damaged.normals.begin() + static_cast<std::ptrdiff_t>(at), {std::nan(""), 0.0, 0.0});
    };
    add(0, std::nan(""));
    add(5, std::numeric_limits<double>::infinity());
    add(8, -std::numeric_limits<double>::infinity());
    const PreparedCloud prepared = prepare(damaged);
    EXPECT_EQ(prepared.report.points, expected.report.points + 3);
    EXPECT_EQ(prepared.report.not_finite, 3);
    EXPECT_EQ(prepared.report.duplicates, 0);
    EXPECT_EQ(prepared.report.unknown_normals, 0) << "the normals of such points do not matter";
    EXPECT_EQ(prepared.cloud.points, expected.cloud.points);
    EXPECT_EQ(prepared.cloud.normals, expected.cloud.normals);
    ASSERT_EQ(prepared.report.warnings().size(), 1U);
    EXPECT_EQ(prepared.report.warnings()[0].code, "points.not_finite");
    const PointCloud nothing{std::vector<Point>(10, Point{std::nan(""), 0.0, 0.0}), {}};
    EXPECT_EQ(prepare(nothing).report.fault.code, "points.few");
}

TEST(Points, RefusesWhatIsNoCloud) {
    const PointCloud sound = cloud_of(ball_solid(1.0), 0.3);
    const auto fault_of = [&](const std::function<void(PointCloud&)>& damage) {
        PointCloud cloud = sound;
        damage(cloud);
        const PreparedCloud prepared = prepare(cloud);
        EXPECT_THROW(cloud_solid(prepared), UnusableInput);
        return prepared.report.fault;
    };
    const std::size_t count = sound.points.size();
    for (const std::size_t normals : {count + 1, count + 1000, count - 1}) {
        const Diagnostic fault = fault_of([&](PointCloud& cloud) { cloud.normals.resize(normals); });
        EXPECT_EQ(fault.code, "points.normals");
        EXPECT_NE(fault.message.find(std::to_string(normals) + " normals for " + std::to_string(count) + " points"),
                  std::string::npos);
    }
    const auto moved_by = [](double by, double scale) {
        return [=](PointCloud& cloud) {
            for (Point& p : cloud.points) {
                p = scale * p + Point{0, by, 0};
            }
        };
    };
    EXPECT_EQ(fault_of(moved_by(1e11, 1.0)).code, "size.too_far");
    EXPECT_EQ(fault_of(moved_by(0.0, 4e17)).code, "size.too_large");
    EXPECT_EQ(fault_of(moved_by(0.0, 1e100)).code, "points.few");
    EXPECT_EQ(fault_of(moved_by(0.0, 1e-100)).code, "size.too_small");
    EXPECT_NE(fault_of(moved_by(1e11, 1.0)).message.find("coordinates of its points"), std::string::npos);
}

TEST(Points, LeavesOutMarksOfAbsentDataAndPointsFarFromAllOthers) {
    const PointCloud cloud = cloud_of(torus_solid(1.0, 0.4), 0.1);
    const PreparedCloud expected = prepare(cloud);
    for (const double mark : {1e4, 1e7, 1e10, 1e15, 1e20, 1e30, double{std::numeric_limits<float>::max()}}) {
        SCOPED_TRACE(mark);
        PointCloud marked = cloud;
        marked.points.push_back({0.0, mark, 0.0});
        marked.points.push_back({0.1, 0.2, -mark});
        marked.normals.resize(marked.normals.empty() ? 0 : marked.points.size(), {0.0, 0.0, 1.0});
        EXPECT_EQ(std::ranges::count(find_far_points(marked.points), 1), mark < 1e5 ? 0 : 2);
        const PreparedCloud prepared = prepare(marked, prepare_options(marked.points, Length::relative(0.01)));
        EXPECT_TRUE(prepared.report.fault.empty()) << prepared.report.fault.message;
        EXPECT_EQ(prepared.cloud.points, expected.cloud.points);
        EXPECT_EQ(mark > 1e18 ? prepared.report.not_finite : prepared.report.outliers, 2);
    }
}

TEST(Points, TakesNormalsOfAnyLength) {
    const PointCloud cloud = cloud_of(torus_solid(1.0, 0.4), 0.1);
    const PreparedCloud expected = prepare(cloud);
    for (const int exponent : {-1000, -520, 520, 1000}) {
        PointCloud scaled = cloud;
        for (Point& normal : scaled.normals) {
            normal = {std::ldexp(normal.x, exponent), std::ldexp(normal.y, exponent), std::ldexp(normal.z, exponent)};
        }
        const PreparedCloud prepared = prepare(scaled);
        EXPECT_EQ(prepared.report.unknown_normals, 0) << exponent;
        ASSERT_EQ(prepared.cloud.normals.size(), expected.cloud.normals.size());
        for (std::size_t i = 0; i < prepared.cloud.normals.size(); ++i) {
            ASSERT_LT(distance(prepared.cloud.normals[i], expected.cloud.normals[i]), 1e-14) << exponent;
        }
    }
}

TEST(Points, HandOverWhatWasDoneToThem) {
    PointCloud cloud = cloud_of(ball_solid(1.0), 0.2);
    EXPECT_TRUE(cloud_solid(prepare(cloud))->warnings().empty());
    cloud.points.push_back(cloud.points.front());
    cloud.normals.push_back(cloud.normals.front());
    const std::vector<Diagnostic> warnings = cloud_solid(prepare(cloud))->warnings();
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].code, "points.duplicates");
}

TEST(Points, TakesArraysOfTheCallers) {
    const PointCloud cloud = cloud_of(ball_solid(1.0), 0.2);
    EXPECT_EQ(prepare(CloudView{cloud.points, cloud.normals}).cloud.normals, prepare(cloud).cloud.normals);
    EXPECT_EQ(prepare(CloudView{cloud.points, {}}).report.has_normals, false);
}

TEST(Points, ReportProgressAndStop) {
    const PointCloud cloud = cloud_of(torus_solid(1.0, 0.4), 0.05);
    expect_progress_and_cancellation([&](const Execution& execution) { prepare(cloud, {}, execution); });
    expect_progress_and_cancellation(
        [&](const Execution& execution) { prepare(without_normals(cloud), {}, execution); });
    const PreparedCloud prepared = prepare(cloud);
    expect_progress_and_cancellation([&](const Execution& execution) { cloud_solid(prepared, {}, execution); });
}

TEST(Points, FewButEnough) {
    const PointCloud tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
    const PreparedCloud prepared = prepare(tetrahedron);
    EXPECT_EQ(prepared.report.fault.message, "");
    for (const bool is_crust : {false, true}) {
        try {
            const ScaleAxis axis = is_crust ? scale_axis(crust(prepared), {.scales = {1.0}})
                                            : scale_axis(*cloud_solid(prepared), with_tolerance(0.1));
            EXPECT_FALSE(axis.balls.empty());
        } catch (const UnusableInput&) {  // the right answer, too
        }
    }
}

// The tree.

TEST(PointTree, FindsWhatTryingAllPointsFinds) {
    for (const std::size_t count : {1U, 7U, 8U, 9U, 1000U}) {
        std::vector<Point> points(count);
        const auto random_point = [](std::uint64_t seed, std::uint64_t i) {
            // Many equal coordinates, far from the origin.
            const auto coordinate = [&](std::uint64_t k) { return std::floor(20.0 * random_unit(seed, i, k)); };
            return Point{1e6 + coordinate(0), coordinate(1), coordinate(2)};
        };
        for (std::size_t i = 0; i < count; ++i) {
            points[i] = random_point(1, i);
        }
        const PointTree tree = build_point_tree(points);
        std::vector<NearPoint> near;
        for (std::uint64_t q = 0; q < 200; ++q) {
            const Point p = random_point(2, q) + Point{q % 3 == 0 ? 0.3 : 0.0, 0.0, q % 5 == 0 ? 100.0 : 0.0};
            std::vector<std::pair<double, Index>> expected;
            for (std::size_t i = 0; i < count; ++i) {
                expected.emplace_back(squared_distance(points[i], p), static_cast<Index>(i));
            }
            std::ranges::sort(expected);
            EXPECT_EQ(tree.order[nearest_point(tree, p).position], expected[0].second);
            nearest_points(tree, p, 20, near);
            ASSERT_EQ(near.size(), std::min<std::size_t>(20, count));
            for (std::size_t k = 0; k < near.size(); ++k) {
                EXPECT_EQ(tree.order[near[k].position], expected[k].second);
            }
            std::vector<Index> within;
            for_each_point_near(tree, p, 5.0, [&](Index i, double) { within.push_back(tree.order[i]); });
            std::vector<Index> expected_within;
            for (const auto& [squared, i] : expected) {
                if (squared <= 25.0) {
                    expected_within.push_back(i);
                }
            }
            std::ranges::sort(within);
            std::ranges::sort(expected_within);
            EXPECT_EQ(within, expected_within);
        }
    }
}

// The squares of their lengths are beyond the range of a double.
TEST(MovingLeastSquares, TakesLongNormals) {
    PointCloud cloud = cloud_of(ball_solid(1.0), 0.1);
    for (Point& normal : cloud.normals) {
        normal = 1e160 * normal;
    }
    const PreparedCloud prepared = prepare(cloud);
    EXPECT_EQ(prepared.report.fault.message, "");
    EXPECT_EQ(prepared.report.unknown_normals, 0);
    expect_topology(scale_axis(*cloud_solid(prepared), {.delta = Length::relative(0.05)}), known_topology(1, 0, 0));
}

}  // namespace
}  // namespace scaleaxis
