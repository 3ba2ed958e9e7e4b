// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/thickness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "complexes.hpp"
#include "meshes.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"
#include "spatial/slab.hpp"
#include "spatial/slab_tree.hpp"
#include "uses/uphill.hpp"

namespace scaleaxis {
namespace {

using test::box_mesh;
using test::centered_box;
using test::complex_by_hand;
using test::revolved_mesh;
using test::sphere_mesh;
using test::torus_mesh;

MedialComplex axis_of(const TriangleMesh& mesh, double scale = 1.1) {
    const auto solid = mesh_solid(mesh);
    return scale_axis(*solid, {.delta = Length::relative(0.008), .scales = {scale}}).axes[0].complex;
}

// Relative errors over the vertices where the truth is known.
struct Errors {
    double mean = 0.0;
    double most = 0.0;
    int count = 0;
};

Errors errors_of(const TriangleMesh& mesh, const std::vector<PointThickness>& found, double PointThickness::*value,
                 const std::function<std::optional<double>(const Point&)>& truth) {
    Errors errors;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (const auto expected = truth(mesh.vertices[v])) {
            const double error = std::abs(found[v].*value / *expected - 1.0);
            errors.mean += error;
            errors.most = std::max(errors.most, error);
            ++errors.count;
        }
    }
    errors.mean /= std::max(1, errors.count);
    return errors;
}

// A solid with the local thickness of its surface off its edges, and on all of it where that is one number.
struct ClosedForm {
    std::string name;
    TriangleMesh mesh;
    std::function<std::optional<double>(const Point&)> off_edges;
};

double around(const Point& p) { return std::hypot(p.x, p.y); }

// A cone frustum on z = 0, whose flank goes from `bottom` to `top` at height 6.
ClosedForm cone(double bottom, double top) {
    const double flank = std::cos(std::atan((bottom - top) / 6.0));
    return {"cone", revolved_mesh({{0, 0}, {bottom, 0}, {top, 6}, {0, 6}}, 128, 0.15), [=](const Point& p) {
                return p.z > 1.3 * bottom && p.z < 6.0 - 1.6 * top ? std::optional(2.0 * around(p) / flank)
                                                                   : std::nullopt;
            }};
}

std::vector<ClosedForm> closed_forms() {
    const auto where = [](bool is_known, double value) { return is_known ? std::optional(value) : std::nullopt; };
    return {
        {"plate", box_mesh({0, 0, 0}, {10, 8, 1}, 30),
         [=](const Point& p) {
             return where((p.z == 0 || p.z == 1) && std::min({p.x, 10 - p.x, p.y, 8 - p.y}) > 1, 1.0);
         }},
        {"tube", revolved_mesh({{2, -2}, {3, -2}, {3, 2}, {2, 2}}, 128, 0.2),
         [=](const Point& p) { return where(std::abs(p.z) < 1, 1.0); }},
        {"sphere", sphere_mesh({0, 0, 0}, 1, 4), [=](const Point&) { return std::optional(2.0); }},
        {"cylinder", revolved_mesh({{0, -4}, {1, -4}, {1, 4}, {0, 4}}, 128, 0.15),
         [=](const Point& p) { return where(std::abs(p.z) < 3, 2.0); }},
        cone(1.0, 0.5),
        cone(2.0, 0.5),
        {"torus", torus_mesh(3, 1, 160, 80), [=](const Point&) { return std::optional(2.0); }},
        {"stepped shaft", revolved_mesh({{0, -5}, {1, -5}, {1, 0}, {0.5, 0}, {0.5, 5}, {0, 5}}, 128, 0.15),
         [=](const Point& p) {
             return p.z > 0.3 && p.z < 4.4 ? std::optional(1.0) : where(p.z < -1 && p.z > -4 && around(p) > 0.99, 2.0);
         }},
    };
}

void expect_closed_forms(const std::vector<ClosedForm>& forms) {
    double scale = 1.0;
    for (const ClosedForm& form : forms) {
        SCOPED_TRACE(form.name + " at s = " + std::to_string(scale));
        const Thickness thickness(axis_of(form.mesh, scale));
        for (const auto& found : {thickness.at_surface(form.mesh.vertices),
                                  thickness.at_surface(form.mesh.vertices, *mesh_solid(form.mesh))}) {
            for (const auto value : {&PointThickness::thickness, &PointThickness::foot}) {
                const Errors errors = errors_of(form.mesh, found, value, form.off_edges);
                EXPECT_GT(errors.count, 500);
                EXPECT_LT(errors.mean, 0.003);
                EXPECT_LT(errors.most, 0.01);
            }
        }
        scale = scale == 1.0 ? 1.1 : 1.0;
    }
}

// A cube of which only a small disc of the bottom is known, as of a cloud with holes.
class CubeWithHoles : public Solid, public NearestPoints {
   public:
    using Solid::inside;
    Box bounds() const override { return centered_box(1.0, 1.0, 1.0); }
    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override {
        std::ranges::transform(points, sides.begin(), [&](const Point& p) { return bounds().contains(p) ? 1 : 0; });
    }
    void crossings(std::span<const Chord>, std::span<std::optional<Point>>) const override {}
    std::vector<Point> seeds(double, std::uint64_t, const Execution&) const override { return {}; }
    const NearestPoints* nearest_points() const override { return this; }
    void find(std::span<const Point> points, std::span<const double> bounds,
              std::span<std::optional<Point>> nearest) const override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double from_middle = std::hypot(points[i].x, points[i].y);
            const double part = std::min(1.0, kDisc / std::max(kDisc, from_middle));
            const Point p{part * points[i].x, part * points[i].y, -1.0};
            nearest[i] = distance(p, points[i]) < bounds[i] ? std::optional(p) : std::nullopt;
        }
    }

   private:
    static constexpr double kDisc = 0.2;
};

TEST(Uphill, DoesNotLeaveThroughHoles) {
    const CubeWithHoles cube;
    const Ball top = uphill(cube, {{0.0, 0.0, -0.9}, 0.1}, 0.6);
    EXPECT_GT(top.radius, 1.0);
    EXPECT_TRUE(cube.bounds().contains(top.center)) << top.radius;
}

TEST(Thickness, IsThatOfClosedFormsOffEdges) {
    const std::vector<ClosedForm> all = closed_forms();
    expect_closed_forms({all.begin(), all.begin() + 2});
}

TEST(ThicknessSweep, IsThatOfClosedFormsOffEdges) {
    const std::vector<ClosedForm> all = closed_forms();
    ASSERT_GT(all.size(), 2U);
    expect_closed_forms({all.begin() + 2, all.end()});
}

TEST(Thickness, OfSharpEdgesIsThatOfWhatTheyBelongTo) {
    const TriangleMesh cube = box_mesh({0, 0, 0}, {1, 1, 1}, 25);
    const MedialComplex axis = axis_of(cube);
    const auto side = [](const Point&) { return std::optional(1.0); };
    const auto found = Thickness(axis).at_surface(cube.vertices);
    EXPECT_LT(errors_of(cube, found, &PointThickness::thickness, side).most, 0.01);
    EXPECT_GT(errors_of(cube, found, &PointThickness::foot, side).mean, 0.5);
    const auto exact = Thickness(axis, {.angle = 0.0}).at_surface(cube.vertices);
    EXPECT_GT(errors_of(cube, exact, &PointThickness::thickness, side).mean, 0.5);  // that of Hildebrand and Rüegsegger
}

// The solid made of those cells of a grid that are chosen by their centres.
TriangleMesh mesh_of_cells(const std::array<std::vector<double>, 3>& grid,
                           const std::function<bool(const Point&)>& is_chosen) {
    const auto is_full = [&](const std::array<int, 3>& cell) {
        std::array<double, 3> center{};
        for (int axis = 0; axis < 3; ++axis) {
            if (cell[axis] < 0 || cell[axis] + 1 >= static_cast<int>(grid[axis].size())) {
                return false;
            }
            center[axis] = 0.5 * (grid[axis][cell[axis]] + grid[axis][cell[axis] + 1]);
        }
        return is_chosen({center[0], center[1], center[2]});
    };
    TriangleMesh mesh;
    const auto add_side = [&](const std::array<int, 3>& cell, int axis, int side) {
        const Index first = static_cast<Index>(mesh.vertices.size());
        for (const auto& [u, v] : {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}}) {
            std::array<int, 3> corner = cell;
            corner[axis] += side;
            corner[(axis + 1) % 3] += side == 1 ? u : v;
            corner[(axis + 2) % 3] += side == 1 ? v : u;
            mesh.vertices.push_back({grid[0][corner[0]], grid[1][corner[1]], grid[2][corner[2]]});
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    };
    for (int i = 0; i < static_cast<int>(grid[0].size()); ++i) {
        for (int j = 0; j < static_cast<int>(grid[1].size()); ++j) {
            for (int k = 0; k < static_cast<int>(grid[2].size()); ++k) {
                const std::array cell{i, j, k};
                for (int axis = 0; axis < 3 && is_full(cell); ++axis) {
                    for (const int side : {0, 1}) {
                        std::array<int, 3> beside = cell;
                        beside[axis] += 2 * side - 1;
                        if (!is_full(beside)) {
                            add_side(cell, axis, side);
                        }
                    }
                }
            }
        }
    }
    return mesh;
}

struct Part {
    std::string name;
    TriangleMesh mesh;
    double least = 0.0;  // its smallest thickness
};

std::vector<Part> parts() {
    const auto prism = [](std::vector<double> x, std::vector<double> y, double length, const auto& is_chosen) {
        return mesh_of_cells({std::move(x), std::move(y), {0, length}}, is_chosen);
    };
    return {
        {"cube", box_mesh({0, 0, 0}, {1, 1, 1}), 1.0},
        {"plate", box_mesh({0, 0, 0}, {100, 60, 2}), 2.0},
        {"L", prism({0, 1, 5}, {0, 1, 6}, 10, [](const Point& p) { return p.x < 1 || p.y < 1; }), 1.0},
        {"T", prism({0, 2.5, 3.5, 6}, {0, 5, 6}, 8, [](const Point& p) { return p.y > 5 || std::abs(p.x - 3) < 0.5; }),
         1.0},
        {"I",
         prism({0, 2, 3, 5}, {0, 1, 6, 7}, 10,
               [](const Point& p) { return p.y < 1 || p.y > 6 || std::abs(p.x - 2.5) < 0.5; }),
         1.0},
        {"tray",
         mesh_of_cells({std::vector<double>{0, 1, 9, 10}, {0, 1, 6, 7}, {0, 1, 4}},
                       [](const Point& p) { return p.z < 1 || p.x < 1 || p.x > 9 || p.y < 1 || p.y > 6; }),
         1.0},
        {"pipe with a flange", revolved_mesh({{2, 0}, {5, 0}, {5, 1}, {3, 1}, {3, 8}, {2, 8}}, 96, 1.0), 1.0},
        {"thin step beside a block",
         mesh_of_cells({std::vector<double>{0, 4, 8}, {0, 4}, {0, 1, 3}},
                       [](const Point& p) { return p.z < 1 || p.x < 4; }),
         1.0},
        {"thin fin on a block",
         mesh_of_cells({std::vector<double>{0, 2.9, 3.1, 6}, {0, 4}, {0, 2, 4}},
                       [](const Point& p) { return p.z < 2 || std::abs(p.x - 3) < 0.1; }),
         0.2},
    };
}

TEST(Thickness, OfAPartIsNowhereLessThanThatOfItsThinnestWall) {
    for (const Part& part : parts()) {
        SCOPED_TRACE(part.name);
        Box box;
        std::ranges::for_each(part.mesh.vertices, [&](const Point& p) { box.extend(p); });
        const TriangleMesh surface = with_short_edges(part.mesh, 0.03 * box.diagonal());
        const auto solid = mesh_solid(part.mesh);
        const Thickness thickness(scale_axis(*solid, {.scales = {1.1}}).axes[0].complex);
        const auto found = thickness.at_surface(surface.vertices, *solid);
        const auto least = std::ranges::min_element(found, {}, &PointThickness::thickness);
        EXPECT_GT(least->thickness, 0.99 * part.least) << least->ball.center.x << ' ' << least->ball.center.y;
        EXPECT_LT(least->thickness, 1.01 * part.least);
        for (const PointThickness& at : found) {
            EXPECT_LE(at.ball.radius, (1.0 + 1e-9) * distance(at.ball.center, *solid->nearest(at.ball.center)));
        }
    }
}

// Out of a corner of three faces a ball grows by 0.447 of the way if the edge between two of them has 60°, by 0.577 at
// 90°: by more than the 0.438 of contacts 128° apart.
TEST(Thickness, OfAPlateIsThatOfItsFacesAlsoInAcuteCorners) {
    for (const double degrees : {60.0, 65.0, 71.0, 72.0, 75.0, 80.0}) {
        SCOPED_TRACE(degrees);
        const double x = 15.0 * std::cos(degrees * std::numbers::pi / 180.0);
        const double y = 15.0 * std::sin(degrees * std::numbers::pi / 180.0);
        const TriangleMesh plate = test::prism({{0.0, 0.0}, {30.0, 0.0}, {30.0 + x, y}, {x, y}}, 1.5);
        for (unsigned seed = 1; seed <= 2; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            test::Random random(seed);
            const TriangleMesh turned = test::moved(plate, test::random_turn(random));
            const auto solid = mesh_solid(turned);
            const Thickness thickness(scale_axis(*solid, {.scales = {1.1}}).axes[0].complex);
            for (const PointThickness& at : thickness.at_surface(with_short_edges(turned, 0.4).vertices, *solid)) {
                ASSERT_NEAR(at.thickness, 1.5, 0.01);
            }
        }
    }
}

// Balls grow all along the seams that lead out of corners, if these stay where three faces are equally near.
TEST(Thickness, OfACornerIsThatOfItsBoxWhereTheAxisAloneTells) {
    const TriangleMesh box = box_mesh({0, 0, 0}, {2, 3, 4});
    for (unsigned seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Random random(seed);
        const TriangleMesh turned = test::moved(box, test::random_turn(random));
        const auto solid = mesh_solid(turned);
        const Thickness thickness(
            scale_axis(*solid, {.delta = Length::relative(0.05), .scales = {1.0}}).axes[0].complex);
        for (const PointThickness& corner : thickness.at_surface(turned.vertices)) {
            EXPECT_NEAR(corner.thickness, 2.0, 0.02);
        }
    }
}

TEST(Thickness, OfThinPlacesBesideThickOnes) {
    const TriangleMesh part = parts()[7].mesh;  // 1 thick where x > 4, 3 elsewhere
    const TriangleMesh surface = with_short_edges(part, 0.15);
    const auto solid = mesh_solid(part);
    const Thickness thickness(scale_axis(*solid, {.scales = {1.1}}).axes[0].complex);
    const auto truth = [](const Point& p) {
        return p.x > 4.6 ? std::optional(1.0) : p.x < 3.0 ? std::optional(3.0) : std::nullopt;
    };
    for (const auto& found : {thickness.at_surface(surface.vertices, *solid), thickness.at_surface(surface)}) {
        EXPECT_LT(errors_of(surface, found, &PointThickness::thickness, truth).most, 0.01);
    }
}

TEST(Thickness, DoesNotEndInAVoidThatTheAxisHasLost) {
    const TriangleMesh ball = test::ball_mesh(1.0, 30);
    const Thickness thickness(axis_of(ball));
    TriangleMesh void_of_ball = test::ball_mesh(0.05, 30);
    for (Point& p : void_of_ball.vertices) {
        p = p + Point{0.0, 0.0, 0.02};
    }
    const auto solid = mesh_solid(test::together(ball, test::turned_inside_out(void_of_ball)));
    for (const PointThickness& found : thickness.at_surface(ball.vertices, *solid)) {
        EXPECT_GT(found.thickness, 0.9);  // between the void and the surface, 0.93 at least
    }
}

TEST(Thickness, OfAKnifeIsThin) {
    // A prism over an isosceles triangle whose sharp edge, along z, is at the origin.
    const double half = std::tan(15.0 * std::numbers::pi / 180.0);
    TriangleMesh knife;
    knife.vertices = {{0, 0, 0}, {4, -4 * half, 0}, {4, 4 * half, 0}, {0, 0, 5}, {4, -4 * half, 5}, {4, 4 * half, 5}};
    knife.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    knife = with_short_edges(knife, 0.2);
    const Thickness thickness(axis_of(knife));
    for (const auto& found :
         {thickness.at_surface(knife.vertices), thickness.at_surface(knife.vertices, *mesh_solid(knife))}) {
        int asked = 0;
        for (std::size_t v = 0; v < knife.vertices.size(); ++v) {
            const Point& p = knife.vertices[v];
            if (std::abs(p.z - 2.5) > 1.0 || p.x > 2.0) {
                continue;
            }
            // The ball that touches one side at p has its centre on the plane y = 0.
            const double expected = 2.0 * half * std::hypot(p.x, p.y);
            EXPECT_NEAR(found[v].thickness, expected, 0.02 * expected + 0.03);
            ++asked;
        }
        EXPECT_GT(asked, 100);
    }
}

// Balls of radius 0, whose interpolation rounds.
TEST(Thickness, IsNeverNegativeOnASharpEdge) {
    MedialComplex strip;
    strip.vertices = {{0.0, 0.0, 0.0}, {0.7, 0.3, 0.1}, {0.1, 1.3, 0.7}};
    strip.radii = {0.0, 0.0, 0.0};
    strip.vertex_origins.assign(3, {VertexKind::kSharpEdge});
    strip.edges = {{0, 1}, {0, 2}, {1, 2}};
    strip.faces.push_back(std::vector<Index>{0, 1, 2});
    strip.face_edges.push_back(std::vector<Index>{0, 2, 1});
    strip.face_angles = {90.0};
    strip.face_sheets = {0};
    strip.sheets = 1;
    std::vector<Point> points;
    for (int i = 0; i <= 1000; ++i) {
        points.push_back(0.0007 * i * strip.vertices[1] + 0.0003 * i * strip.vertices[2]);
    }
    for (const PointThickness& found : Thickness(strip).at_surface(points)) {
        EXPECT_GE(found.thickness, 0.0);
        EXPECT_GE(found.foot, 0.0);
        EXPECT_GE(found.ball.radius, 0.0);
    }
}

TEST(Thickness, GivesTheBallThatContainsThePoint) {
    const TriangleMesh mesh = torus_mesh(3, 1, 64, 32);
    for (const PointThickness& thickness : Thickness(axis_of(mesh)).at_surface(mesh.vertices)) {
        EXPECT_EQ(thickness.thickness, 2.0 * thickness.ball.radius);
    }
    const auto found = Thickness(axis_of(mesh)).at_surface(mesh.vertices);
    for (std::size_t v = 0; v < found.size(); ++v) {
        EXPECT_NEAR(distance(found[v].ball.center, mesh.vertices[v]), found[v].ball.radius, 0.02);
    }
}

TEST(Thickness, DoesNotDependOnThreadsOrOtherPoints) {
    const TriangleMesh mesh = box_mesh({0, 0, 0}, {3, 2, 1}, 20);
    const Thickness thickness(axis_of(mesh));
    const auto solid = mesh_solid(mesh);
    const auto at = [&](std::span<const Point> points, bool knows_solid, int threads) {
        return knows_solid ? thickness.at_surface(points, *solid, {.threads = threads})
                           : thickness.at_surface(points, {.threads = threads});
    };
    for (const bool knows_solid : {false, true}) {
        const auto one = at(mesh.vertices, knows_solid, 1);
        const auto two = at(mesh.vertices, knows_solid, 2);
        for (std::size_t v = 0; v < one.size(); ++v) {
            const PointThickness alone = at({&mesh.vertices[v], 1}, knows_solid, 0)[0];
            EXPECT_EQ(one[v].thickness, two[v].thickness);
            EXPECT_EQ(one[v].ball, two[v].ball);
            EXPECT_EQ(one[v].thickness, alone.thickness);
            EXPECT_EQ(one[v].foot, alone.foot);
        }
    }
}

TEST(Thickness, RefusesWhatItCannotTake) {
    EXPECT_THROW(Thickness(MedialComplex{}), UnusableInput);
    MedialComplex ball;
    ball.vertices = {{0, 0, 0}};
    ball.radii = {1.0};
    ball.vertex_origins = {{VertexKind::kBall, 0}};
    EXPECT_THROW(Thickness(ball, {.angle = 180.0}), InvalidOption);
    EXPECT_THROW(Thickness(ball, {.angle = std::nan("")}), InvalidOption);
    const Point far{5, 0, 0};
    EXPECT_EQ(Thickness(ball).at_surface({&far, 1})[0].thickness, 2.0);
}

// A rod that becomes thicker: two cones and a lone ball, whose balls are known exactly.
MedialComplex rod() {
    MedialComplex complex;
    complex.vertices = {{0, 0, 0}, {4, 0, 0}, {6, 0, 0}, {9, 5, 1}};
    complex.radii = {0.5, 1.5, 1.0, 1.2};
    complex.vertex_origins.assign(4, {VertexKind::kTouching});
    complex.edges = {{0, 1}, {1, 2}};
    return complex;
}

// The radius of the largest ball of the rod that contains a point, over many of its balls; 0: none does.
double largest_of_rod(const Point& p) {
    const MedialComplex complex = rod();
    double largest = distance(p, complex.vertices[3]) <= complex.radii[3] ? complex.radii[3] : 0.0;
    for (const auto& [a, b] : complex.edges) {
        for (int i = 0; i <= 2000; ++i) {
            const double t = i / 2000.0;
            const Point center = complex.vertices[a] + t * (complex.vertices[b] - complex.vertices[a]);
            const double radius = complex.radii[a] + t * (complex.radii[b] - complex.radii[a]);
            largest = distance(p, center) <= radius ? std::max(largest, radius) : largest;
        }
    }
    return largest;
}

TEST(ThicknessImage, HasTheLargestBallAtEachPoint) {
    Image mask;
    mask.sizes = {61, 43, 33};
    mask.origin = {-1, -2, -1.6};
    mask.steps = {Point{0.2, 0, 0}, Point{0.02, 0.2, 0}, Point{0, 0, 0.11}};  // neither square nor cubic
    mask.values.assign(static_cast<std::size_t>(61) * 43 * 33, 1.0F);
    mask.values[17] = 0.0F;
    const Image one = Thickness(rod(), {.angle = 0.0}).image(mask, {.threads = 1});
    const Image two = Thickness(rod(), {.angle = 0.0}).image(mask, {.threads = 2});
    EXPECT_EQ(one.values, two.values);
    EXPECT_EQ(one.sizes, mask.sizes);
    EXPECT_EQ(one.steps, mask.steps);
    EXPECT_EQ(one.values[17], 0.0F);
    int inside = 0;
    for (std::size_t n = 18; n < one.values.size(); n += 7) {
        const Point p = mask.origin + static_cast<double>(n % 61) * mask.steps[0] +
                        static_cast<double>(n / 61 % 43) * mask.steps[1] +
                        static_cast<double>(n / (61 * 43)) * mask.steps[2];
        const double expected = 2.0 * largest_of_rod(p);
        if (expected > 0.0) {
            ++inside;
            EXPECT_NEAR(one.values[n], expected, 0.005 + 0.02 * 0.11);
        } else {
            EXPECT_GT(one.values[n], 0.0F);  // the ball that reaches it first
        }
    }
    EXPECT_GT(inside, 1000);
}

// A mask that fills the unit cube.
Image filled_cube(Index n) {
    Image mask;
    mask.sizes = {n, n, n};
    mask.origin = {0, 0, 0};
    mask.steps = {Point{1.0 / n, 0, 0}, Point{0, 1.0 / n, 0}, Point{0, 0, 1.0 / n}};
    mask.values.assign(static_cast<std::size_t>(n) * n * n, 1.0F);
    return mask;
}

// Of a value of such an image.
Point place_in_cube(std::size_t k, Index n) {
    const auto i = static_cast<Index>(k);
    return (1.0 / n) *
           Point{static_cast<double>(i % n), static_cast<double>(i / n % n), static_cast<double>(i / (n * n))};
}

TEST(ThicknessImage, OfRandomBallsThatHoldWholeBlocksIsThatOfAllOfThem) {
    // On a grid as fine as this some balls hold blocks in which larger ones contain but a part of the points.
    const Image mask = filled_cube(48);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Random random(seed);
        MedialComplex complex;
        for (int i = 0; i < 20; ++i) {
            complex.vertices.push_back(
                {test::uniform(random, 0, 1), test::uniform(random, 0, 1), test::uniform(random, 0, 1)});
            complex.radii.push_back(test::uniform(random, 0.3, 0.7));
        }
        complex.vertex_origins.assign(20, {VertexKind::kTouching});
        const Image image = Thickness(complex, {.angle = 0.0}).image(mask);
        int wrong = 0;
        for (std::size_t n = 0; n < image.values.size(); ++n) {
            const Point p = place_in_cube(n, 48);
            double largest = 0.0;
            for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
                largest = distance(p, complex.vertices[v]) <= complex.radii[v] ? std::max(largest, complex.radii[v])
                                                                               : largest;
            }
            wrong += largest > 0.0 && std::abs(image.values[n] - 2.0 * largest) > 1e-5 ? 1 : 0;
        }
        EXPECT_EQ(wrong, 0);
    }
}

TEST(ThicknessImage, OfRandomTrianglesIsThatOfTheBallsAllOverThem) {
    constexpr Index kTriangles = 6;
    constexpr int kParts = 16;  // of the sides, between the balls that are tried
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Random random(seed);
        const auto n = static_cast<Index>(11 + 7 * seed);
        std::vector<Point> vertices;
        std::vector<double> radii;
        std::vector<std::vector<Index>> faces;
        for (Index i = 0; i < 3 * kTriangles; ++i) {
            vertices.push_back({test::uniform(random, 0, 1), test::uniform(random, 0, 1), test::uniform(random, 0, 1)});
            radii.push_back(test::uniform(random, 0.05, 0.4));
        }
        std::vector<Ball> balls;
        double spread = 0.0;  // any ball of a triangle lies in one of these that is as much larger
        for (Index a = 0; a < 3 * kTriangles; a += 3) {
            faces.push_back({a, a + 1, a + 2});
            for (int i = 0; i <= kParts; ++i) {
                for (int j = 0; j <= kParts - i; ++j) {
                    const double u = static_cast<double>(i) / kParts;
                    const double v = static_cast<double>(j) / kParts;
                    balls.push_back(
                        {vertices[a] + u * (vertices[a + 1] - vertices[a]) + v * (vertices[a + 2] - vertices[a]),
                         radii[a] + u * (radii[a + 1] - radii[a]) + v * (radii[a + 2] - radii[a])});
                }
            }
            for (const auto& [b, c] : {std::pair(a, a + 1), std::pair(a + 1, a + 2), std::pair(a + 2, a)}) {
                spread =
                    std::max(spread, (distance(vertices[b], vertices[c]) + std::abs(radii[b] - radii[c])) / kParts);
            }
        }
        MedialComplex complex = complex_by_hand(vertices, faces, {});
        complex.radii = radii;
        const Image image = Thickness(complex, {.angle = 0.0}).image(filled_cube(n));
        int inside = 0;
        int wrong = 0;
        for (std::size_t k = 0; k < image.values.size(); ++k) {
            const Point p = place_in_cube(k, n);
            double least = 0.0;
            double most = 0.0;
            for (const Ball& ball : balls) {
                const double out = distance(p, ball.center) - ball.radius;
                least = out <= 0.0 ? std::max(least, ball.radius) : least;
                most = out <= spread ? std::max(most, ball.radius + spread) : most;
            }
            if (least > 0.0) {
                ++inside;
                const double found = 0.5 * image.values[k];
                wrong += found < least - 0.01 / n || found > most ? 1 : 0;
            }
        }
        EXPECT_GT(inside, n * n * n / 4);
        EXPECT_EQ(wrong, 0);
    }
}

TEST(SlabBalls, AreTheBestOfManyAtEachPoint) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    std::uniform_real_distribution<double> radius(0.0, 1.2);
    const auto point = [&] { return Point{coordinate(random), coordinate(random), coordinate(random)}; };
    for (int trial = 0; trial < 300; ++trial) {
        SCOPED_TRACE("trial " + std::to_string(trial) + " of seed 7");
        std::vector<Ball> corners;
        for (int k = 0; k <= trial % 3; ++k) {
            corners.push_back({point(), radius(random)});
        }
        const Slab slab(corners);
        const Point p = 1.5 * point();
        const double factor = trial % 2 == 0 ? 1.0 : 1.2;
        double least = std::numeric_limits<double>::infinity();
        double largest = -1.0;
        constexpr int kSteps = 120;
        for (int i = 0; i <= (slab.size > 1 ? kSteps : 0); ++i) {
            for (int j = 0; i + j <= kSteps && j <= (slab.size > 2 ? kSteps : 0); ++j) {
                const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
                Ball ball = slab.corners[0];
                if (slab.size > 1) {
                    ball.center = ball.center + u * (slab.corners[1].center - slab.corners[0].center);
                    ball.radius += u * (slab.corners[1].radius - slab.corners[0].radius);
                }
                if (slab.size > 2) {
                    ball.center = ball.center + v * (slab.corners[2].center - slab.corners[0].center);
                    ball.radius += v * (slab.corners[2].radius - slab.corners[0].radius);
                }
                const double growth = distance(ball.center, p) / ball.radius;
                least = std::min(least, growth);
                largest = growth <= factor ? std::max(largest, ball.radius) : largest;
            }
        }
        const GrownBall grown = least_grown_ball(slab, p);
        EXPECT_LE(grown.growth, least + 1e-12);
        EXPECT_NEAR(grown.growth, least, 0.03 * least);
        EXPECT_NEAR(distance(grown.ball.center, p), grown.growth * grown.ball.radius, 1e-9);
        const auto found = largest_ball(slab, p, factor);
        if (largest >= 0.0) {
            ASSERT_TRUE(found);
            EXPECT_GE(found->radius, largest - 1e-9);
            EXPECT_LE(found->radius, largest + 0.05);
        }
        if (found) {
            EXPECT_LE(distance(found->center, p), factor * found->radius * (1.0 + 1e-9) + 1e-12);
            EXPECT_LE(least, factor * 1.03);
        }
    }
}

TEST(SlabTreeBalls, AreThoseOfAllSlabs) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    std::uniform_real_distribution<double> radius(0.0, 0.3);
    const auto point = [&] { return Point{coordinate(random), coordinate(random), coordinate(random)}; };
    std::vector<Slab> slabs;
    for (int i = 0; i < 400; ++i) {
        const Point at = point();
        std::vector<Ball> corners;
        for (int k = 0; k <= i % 3; ++k) {
            corners.push_back({at + 0.1 * point(), radius(random)});
        }
        slabs.emplace_back(corners);
    }
    const SlabTree tree = build_slab_tree(slabs);
    for (int trial = 0; trial < 500; ++trial) {
        SCOPED_TRACE("trial " + std::to_string(trial) + " of seed 11");
        const Point p = 1.3 * point();
        double least = std::numeric_limits<double>::infinity();
        double largest = 0.0;
        for (const Slab& slab : slabs) {
            least = std::min(least, least_grown_ball(slab, p).growth);
            const auto ball = largest_ball(slab, p, 1.1);
            largest = ball ? std::max(largest, ball->radius) : largest;
        }
        EXPECT_EQ(least_grown_slab(tree, p).growth, least);
        EXPECT_EQ(least_grown_slab(tree, p, 0.5 * least).growth, 0.5 * least);
        EXPECT_EQ(largest_slab_ball(tree, p, 1.1).value_or(Ball{}).radius, largest);
    }
}

TEST(SurfaceValues, AreThoseOfALinearFunction) {
    const TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1}, 5);
    std::vector<double> heights;
    for (const Point& p : mesh.vertices) {
        heights.push_back(p.z);
    }
    const SurfaceValues values = surface_values(mesh, heights);
    EXPECT_NEAR(values.area, 6.0, 1e-12);
    EXPECT_NEAR(values.mean, 0.5, 1e-12);
    EXPECT_NEAR(values.deviation, std::sqrt((1.0 + 4.0 / 3.0) / 6.0 - 0.25), 1e-12);
    EXPECT_EQ(values.min, 0.0);
    EXPECT_EQ(values.max, 1.0);
    EXPECT_EQ(mesh.vertices[values.min_vertex].z, 0.0);
    EXPECT_EQ(mesh.vertices[values.max_vertex].z, 1.0);
    const AreaHistogram histogram = area_histogram(mesh, heights, 5);
    EXPECT_NEAR(histogram.width, 0.2, 1e-15);
    double sum = 0.0;
    for (const double area : histogram.areas) {
        sum += area;
    }
    EXPECT_NEAR(sum, 6.0, 1e-12);
    EXPECT_GT(histogram.areas.front(), 1.0);
    EXPECT_THROW(surface_values(mesh, std::vector<double>(3)), UnusableInput);
    EXPECT_THROW(area_histogram(mesh, heights, 0), InvalidOption);
}

TEST(ThinRegions, AreConnectedPiecesBelowTheLimit) {
    // The bottom and the top of a box are thin, each down to one corner.
    const TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1}, 10);
    std::vector<double> values;
    for (const Point& p : mesh.vertices) {
        values.push_back(0.4 + 2.0 * std::min(p.z, 1.0 - p.z) + (p == Point{1, 1, 1} ? -0.1 : 0.0));
    }
    const ThinRegions found = thin_regions(mesh, values, 0.5);
    ASSERT_EQ(found.regions.size(), 2U);
    EXPECT_NEAR(found.regions[0].min, 0.3, 1e-12);
    EXPECT_EQ(mesh.vertices[found.regions[0].min_vertex], (Point{1, 1, 1}));
    EXPECT_NEAR(found.regions[1].min, 0.4, 1e-12);
    EXPECT_NEAR(found.regions[1].area, 1.0 + 4.0 * 0.05, 1e-9);  // the limit is at z = 0.05
    EXPECT_EQ(found.regions[1].vertices, 121);
    for (std::size_t v = 0; v < values.size(); ++v) {
        EXPECT_EQ(found.vertex_regions[v] == kNone, !(values[v] < 0.5));
    }
    EXPECT_TRUE(thin_regions(mesh, values, 0.1).regions.empty());
}

TEST(WithShortEdges, DividesTheSameSurface) {
    const TriangleMesh coarse = box_mesh({0, 0, 0}, {3, 1, 0.2}, 1);
    const TriangleMesh fine = with_short_edges(coarse, 0.3);
    for (std::size_t v = 0; v < coarse.vertices.size(); ++v) {
        EXPECT_EQ(fine.vertices[v], coarse.vertices[v]);
    }
    for (const auto& [a, b, c] : fine.triangles) {
        EXPECT_LE(distance(fine.vertices[a], fine.vertices[b]), 0.3);
        EXPECT_LE(distance(fine.vertices[b], fine.vertices[c]), 0.3);
        EXPECT_LE(distance(fine.vertices[c], fine.vertices[a]), 0.3);
    }
    const MeshReport report = repair(fine).report;
    EXPECT_TRUE(report.is_closed() && report.is_manifold());
    EXPECT_NEAR(report.volume, 0.6, 1e-12);
    EXPECT_EQ(report.reversed_triangles, 0);
    EXPECT_THROW(with_short_edges(coarse, 0.0), InvalidOption);
    for (const double length : {1e-4, 1e-9, 1e-300}) {
        EXPECT_THROW(with_short_edges(coarse, length), InvalidOption) << length;
    }
}

TEST(UnresolvedThickness, IsThatOfWallsThinnerThanTwoVoxelsAcross) {
    const TriangleMesh plate = box_mesh({0, 0, 0}, {10, 10, 1});
    const std::vector<double> thickness(plate.vertices.size(), 1.0);
    const auto told = [&](double x, double y, double z) {
        return unresolved_thickness(plate, thickness, {Point{x, 0, 0}, {0, y, 0}, {0, 0, z}});
    };
    ASSERT_TRUE(told(0.2, 0.2, 0.6));
    EXPECT_EQ(told(0.2, 0.2, 0.6)->code, "image.unresolved_thickness");
    EXPECT_NE(told(0.2, 0.2, 0.6)->message.find("at 83 % of its surface"), std::string::npos);
    EXPECT_FALSE(told(0.2, 0.2, 0.4));
    EXPECT_FALSE(told(3.0, 3.0, 0.4));  // thick slices across the plate leave its thickness as it is
    EXPECT_THROW(unresolved_thickness(plate, std::vector{1.0}, {}), UnusableInput);
}

double volume_of(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += dot(mesh.vertices[a], cross(mesh.vertices[b], mesh.vertices[c])) / 6.0;
    }
    return sum;
}

TEST(WithBulgingEdges, HasTheVolumeOfTheSolid) {
    const auto ball_of = [](double radius) { return union_solid({{{0.1, 0.2, 0.3}, radius}}); };
    const auto mesh_of = [](const Solid& solid, double tolerance) {
        return boundary_mesh(sample(solid, {.tolerance = tolerance, .sizing = Sizing::kUniform})).mesh;
    };
    const std::unique_ptr<Solid> ball = ball_of(1.0);
    const double volume = 4.0 / 3.0 * std::numbers::pi;
    const TriangleMesh mesh = mesh_of(*ball, 0.4);
    EXPECT_LT(volume_of(mesh), 0.95 * volume);
    EXPECT_NEAR(volume_of(with_bulging_edges(mesh, *ball)), volume, 0.01 * volume);
    const TriangleMesh fine = mesh_of(*ball, 0.02);
    EXPECT_EQ(with_bulging_edges(fine, *ball).triangles, fine.triangles);

    const std::unique_ptr<Solid> box = mesh_solid(box_mesh({0, 0, 0}, {3, 2, 1}));
    const TriangleMesh flat = mesh_of(*box, 0.3);
    const double bulging = volume_of(with_bulging_edges(flat, *box));  // chamfers at edges stay below these
    EXPECT_GE(bulging, volume_of(flat));
    EXPECT_LT(bulging, 6.0);
}

}  // namespace
}  // namespace scaleaxis
