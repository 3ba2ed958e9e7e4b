// SPDX-License-Identifier: Apache-2.0
// Solids of triangles that bound none.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "solid/mesh/fast_winding.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis {
namespace {

using test::sphere_mesh;
using test::together;
using Random = std::mt19937_64;

Point random_point(Random& random, double most) {
    std::uniform_real_distribution<double> coordinate(-most, most);
    const double x = coordinate(random), y = coordinate(random);
    return {x, y, coordinate(random)};
}

/// A wavy sheet of 2 n² triangles over [-1, 1]².
TriangleMesh sheet(int n, double height) {
    TriangleMesh mesh;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            const double x = 2.0 * i / n - 1.0, y = 2.0 * j / n - 1.0;
            mesh.vertices.push_back({x, y, height * std::sin(3.0 * x) * std::cos(2.0 * y)});
        }
    }
    for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) {
            const Index a = i * (n + 1) + j, b = a + n + 1;
            mesh.triangles.push_back({a, b, b + 1});
            mesh.triangles.push_back({a, b + 1, a + 1});
        }
    }
    return mesh;
}

/// The faces of [0, 1]³, each a grid of another size, a little smaller than it should be; one the other side up.
TriangleMesh loose_faces(double gap) {
    TriangleMesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int n = 3 + face, axis = face / 2, side = face % 2;
        const auto first = static_cast<Index>(mesh.vertices.size());
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; j <= n; ++j) {
                std::array<double, 3> p{};
                p[axis] = side;
                p[(axis + 1) % 3] = gap + (1.0 - 2.0 * gap) * i / n;
                p[(axis + 2) % 3] = gap + (1.0 - 2.0 * gap) * j / n;
                mesh.vertices.push_back({p[0], p[1], p[2]});
            }
        }
        const bool is_outward = (side == 1) != (face == 3);
        for (Index i = 0; i < n; ++i) {
            for (Index j = 0; j < n; ++j) {
                const Index a = first + i * (n + 1) + j, b = a + n + 1;
                for (std::array<Index, 3> t : {std::array{a, b, b + 1}, std::array{a, b + 1, a + 1}}) {
                    if (!is_outward) {
                        std::swap(t[1], t[2]);
                    }
                    mesh.triangles.push_back(t);
                }
            }
        }
    }
    return mesh;
}

double distance_to(const TriangleMesh& mesh, const Point& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [u, v, w] : mesh.triangles) {
        least = std::min(least, distance(p, nearest_point(mesh.vertices[u], mesh.vertices[v], mesh.vertices[w], p)));
    }
    return least;
}

TEST(FastWinding, IsNearTheSumOfSolidAngles) {
    constexpr std::uint64_t kSeed = 3;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Random random(kSeed);
    TriangleMesh open = sphere_mesh({0, 0, 0}, 1.0, 4);
    std::erase_if(open.triangles, [&](const auto&) { return random() % 4 == 0; });
    for (const TriangleMesh& mesh : {sphere_mesh({0, 0, 0}, 1.0, 4), open, sheet(40, 0.3)}) {
        const Bvh bvh = build_bvh(mesh);
        const FastWinding winding(bvh);
        double sum = 0.0;
        for (int i = 0; i < 500; ++i) {
            const Point p = random_point(random, 1.5);
            double angle = 0.0;
            for (const auto& [u, v, w] : mesh.triangles) {
                const Point a = mesh.vertices[u] - p, b = mesh.vertices[v] - p, c = mesh.vertices[w] - p;
                const double la = norm(a), lb = norm(b), lc = norm(c);
                angle += 2.0 * std::atan2(dot(a, cross(b, c)),
                                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
            }
            const double error = std::abs(winding(p) - angle / (4.0 * std::acos(-1.0)));
            EXPECT_LT(error, 0.02);
            sum += error;
        }
        EXPECT_LT(sum / 500, 0.003);
    }
}

TEST(SolidOfTriangles, ThickenedSheetsAreAllPointsNearby) {
    constexpr std::uint64_t kSeed = 4;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Random random(kSeed);
    const TriangleMesh mesh = sheet(12, 0.3);
    EXPECT_EQ(repair(mesh).report.fault.code, "mesh.sheet");
    const SolidOfTriangles made = solid_of_triangles(mesh, {.kind = SolidKind::kThicken, .thickness = 0.2}, {});
    ASSERT_TRUE(made.solid);
    EXPECT_EQ(made.report.kind, SolidKind::kThicken);
    EXPECT_NE(made.report.reason.find("within 0.1"), std::string::npos);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
        const Point p = random_point(random, 1.3);
        const double distance = distance_to(mesh, p);
        if (std::abs(distance - 0.1) > 1e-9) {
            EXPECT_EQ(made.solid->inside(p), distance < 0.1);
            inside += distance < 0.1 ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 50);
    for (int i = 0; i < 100; ++i) {
        const std::optional<Point> nearest = made.solid->nearest(random_point(random, 1.3));
        ASSERT_TRUE(nearest);
        EXPECT_NEAR(distance_to(mesh, *nearest), 0.1, 1e-6);
    }
}

TEST(SolidOfTriangles, WrapsADoubleWallWithPinHoles) {
    constexpr std::uint64_t kSeed = 5;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Random random(kSeed);
    TriangleMesh inner = sphere_mesh({0, 0, 0}, 0.99, 4);
    for (auto& triangle : inner.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    TriangleMesh mesh = together({sphere_mesh({0, 0, 0}, 1.0, 4), inner});
    std::erase_if(mesh.triangles, [&](const auto&) { return random() % 50 == 0; });
    const auto is_called_a_wall = [](const TriangleMesh& surface) {
        const std::vector<Diagnostic> warnings = repair(surface).report.warnings();
        return std::ranges::any_of(warnings, [](const Diagnostic& w) { return w.code == "mesh.shell"; });
    };
    EXPECT_TRUE(is_called_a_wall(mesh));
    TriangleMesh filled = sphere_mesh({0, 0, 0}, 1.0, 4);
    filled.triangles.pop_back();
    EXPECT_FALSE(is_called_a_wall(filled));
    // Pin holes through the wall leave the surface closed.
    TriangleMesh pierced = together({sphere_mesh({0, 0, 0}, 1.0, 4), inner});
    EXPECT_FALSE(is_called_a_wall(pierced)) << "a cavity is no wall with holes";
    const auto half = std::ssize(pierced.triangles) / 2;
    const auto inner_vertex = static_cast<Index>(std::ssize(pierced.vertices) / 2);
    for (const std::ptrdiff_t hole : {half / 5, half / 2}) {
        const auto [a, b, c] = pierced.triangles[hole];
        pierced.triangles[hole] = {a, b, b + inner_vertex};
        pierced.triangles[half + hole] = {a, b + inner_vertex, a + inner_vertex};
        for (const auto& [p, q] : {std::array{b, c}, std::array{c, a}}) {
            pierced.triangles.push_back({p, q, q + inner_vertex});
            pierced.triangles.push_back({p, q + inner_vertex, p + inner_vertex});
        }
    }
    const MeshReport report = repair(pierced).report;
    EXPECT_TRUE(report.is_closed());
    EXPECT_EQ(report.genus, 1);
    EXPECT_TRUE(is_called_a_wall(pierced));
    EXPECT_NE(report.reason.find("a wall, 0.0"), std::string::npos) << report.reason;
    constexpr double kOpening = 0.3;
    const SolidOfTriangles made = solid_of_triangles(mesh, {.kind = SolidKind::kWrap, .opening = kOpening}, {});
    ASSERT_TRUE(made.solid);
    EXPECT_EQ(made.report.kind, SolidKind::kWrap);
    EXPECT_TRUE(made.solid->inside({0, 0, 0}));
    for (int i = 0; i < 300; ++i) {
        const Point p = random_point(random, 1.2);
        if (std::abs(norm(p) - 0.98) > 0.05) {
            EXPECT_EQ(made.solid->inside(p), norm(p) < 0.98) << norm(p);
        }
        EXPECT_NEAR(norm(*made.solid->nearest(p)), 1.0, 0.1 * kOpening);
    }
}

TEST(SolidOfTriangles, WrapFillsWhatAnotherPartLiesAround) {
    TriangleMesh inner = sphere_mesh({0.1, 0, 0}, 0.5, 3);
    for (const bool is_cavity : {false, true}) {
        const TriangleMesh mesh = together({sphere_mesh({0, 0, 0}, 1.0, 3), inner, sphere_mesh({3, 0, 0}, 0.4, 3)});
        const SolidOfTriangles made = solid_of_triangles(mesh, {.kind = SolidKind::kWrap, .opening = 0.2}, {});
        ASSERT_TRUE(made.solid) << is_cavity;
        for (const Point& p :
             {Point{0.1, 0, 0}, Point{0.1, 0.49, 0}, Point{0.1, 0, 0.51}, Point{-0.9, 0, 0}, Point{3, 0, 0}}) {
            EXPECT_TRUE(made.solid->inside(p)) << is_cavity << ", " << p.x << ' ' << p.y << ' ' << p.z;
        }
        EXPECT_FALSE(made.solid->inside({1.8, 0, 0})) << is_cavity;
        for (auto& triangle : inner.triangles) {
            std::swap(triangle[1], triangle[2]);
        }
    }
}

TEST(SolidOfTriangles, WrapRefusesABallThatGetsInsideThroughAHole) {
    TriangleMesh mesh = test::box_mesh({0, 0, 0}, {2, 2, 2}, 4);  // squares of side 1/2
    std::erase_if(mesh.triangles, [&](const std::array<Index, 3>& triangle) {
        return std::ranges::all_of(triangle, [&](Index v) {
            const Point& p = mesh.vertices[v];
            return p.z == 2.0 && p.x >= 0.5 && p.x <= 1.5 && p.y >= 0.5 && p.y <= 1.5;
        });
    });
    const SolidOfTriangles open = solid_of_triangles(mesh, {.kind = SolidKind::kWrap, .opening = 0.3}, {});
    EXPECT_EQ(open.solid, nullptr) << "what is left are slivers in its edges";
    EXPECT_EQ(open.report.fault.code, "mesh.wrap_reached");
    EXPECT_EQ(open.report.fault.place->z, 2.0);
    ASSERT_EQ(open.report.fault.hints.size(), 1U);
    EXPECT_EQ(open.report.fault.hints[0].option, "opening");
    const double opening = std::stod(open.report.fault.hints[0].value);
    EXPECT_NEAR(opening, std::sqrt(2.0), 1e-2);
    const SolidOfTriangles closed = solid_of_triangles(mesh, {.kind = SolidKind::kWrap, .opening = opening}, {});
    ASSERT_NE(closed.solid, nullptr) << closed.report.fault.message;
    EXPECT_TRUE(closed.solid->inside({1.0, 1.0, 1.0}));
    EXPECT_EQ(closed.left_out.triangles.size(), mesh.triangles.size()) << "any may be off its boundary";
}

TEST(SolidOfTriangles, WrapLeavesNothingOfASheet) {
    const SolidOfTriangles made = solid_of_triangles(sheet(12, 0.1), {.kind = SolidKind::kWrap, .opening = 0.3}, {});
    EXPECT_FALSE(made.solid);
    EXPECT_EQ(made.report.fault.code, "mesh.no_volume");
    EXPECT_NE(made.report.fault.message.find("opening"), std::string::npos);
}

TEST(SolidOfTriangles, PiecesThatDoNotMeetAreTakenTogether) {
    constexpr std::uint64_t kSeed = 6;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Random random(kSeed);
    const SolidOfTriangles made = solid_of_triangles(loose_faces(0.004), {}, {});
    ASSERT_TRUE(made.solid) << made.report.fault.message;
    EXPECT_EQ(made.report.kind, SolidKind::kWinding);
    EXPECT_TRUE(made.mesh.triangles.empty());
    for (int i = 0; i < 2000; ++i) {
        const Point p = Point{0.5, 0.5, 0.5} + random_point(random, 0.7);
        const Point d{std::abs(p.x - 0.5) - 0.5, std::abs(p.y - 0.5) - 0.5, std::abs(p.z - 0.5) - 0.5};
        const double beyond = std::max({d.x, d.y, d.z});
        if (std::abs(beyond) > 0.01) {
            EXPECT_EQ(made.solid->inside(p), beyond < 0.0) << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
}

TEST(SolidOfTriangles, SheetsWindAroundNothing) {
    for (const double height : {0.0, 0.1, 0.3}) {
        const SolidOfTriangles made = solid_of_triangles(sheet(20, height), {}, {});
        EXPECT_FALSE(made.solid);
        EXPECT_EQ(made.report.fault.code, "mesh.sheet");
    }
}

/// A sheet over [0, 1]², bent; where `is_band` its ends are joined, turned over once.
TriangleMesh bent_sheet(int m, int n, const std::function<Point(double, double)>& place, bool is_band = false) {
    TriangleMesh mesh;
    for (int i = 0; i <= m - (is_band ? 1 : 0); ++i) {
        for (int j = 0; j <= n; ++j) {
            mesh.vertices.push_back(place(static_cast<double>(i) / m, static_cast<double>(j) / n));
        }
    }
    const auto vertex = [&](Index i, Index j) { return is_band && i == m ? n - j : i * (n + 1) + j; };
    for (Index i = 0; i < m; ++i) {
        for (Index j = 0; j < n; ++j) {
            const Index a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    }
    return mesh;
}

// One line names an option and a number for it, which makes a solid that the default sampling shows.
TEST(SolidOfTriangles, SurfacesWithoutInsideAreToldAThickness) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const auto band = [](double u, double v) {
        const double t = kTurn * u, r = 1.0 + 0.6 * (v - 0.5) * std::cos(0.5 * t);
        return Point{r * std::cos(t), r * std::sin(t), 0.6 * (v - 0.5) * std::sin(0.5 * t)};
    };
    struct Case {
        std::string name;
        TriangleMesh mesh;
        std::string code;
        std::int64_t tunnels;
    };
    const std::vector<Case> cases{
        {"plane",
         bent_sheet(10, 10,
                    [](double u, double v) {
                        return Point{u, v, 0.0};
                    }),
         "mesh.sheet", 0},
        {"half cylinder",
         bent_sheet(40, 20,
                    [](double u, double v) {
                        return Point{std::cos(0.5 * kTurn * u), std::sin(0.5 * kTurn * u), 2.0 * v};
                    }),
         "mesh.sheet", 0},
        {"terrain",
         bent_sheet(60, 60,
                    [](double u, double v) {
                        return Point{10.0 * u, 10.0 * v,
                                     0.5 * std::sin(6.0 * u) * std::cos(7.0 * v) + 0.3 * std::sin(9.0 * u)};
                    }),
         "mesh.sheet", 0},
        {"one-sided band", bent_sheet(60, 10, band, true), "mesh.one_sided", 1}};
    for (const auto& [name, mesh, code, tunnels] : cases) {
        SCOPED_TRACE(name);
        const SolidOfTriangles none = solid_of_triangles(mesh, {}, {});
        EXPECT_EQ(none.solid, nullptr);
        const std::string& message = none.report.fault.message;
        EXPECT_EQ(none.report.fault.code, code) << message;
        ASSERT_EQ(none.report.fault.hints.size(), 2U) << message;
        EXPECT_EQ(none.report.fault.hints[0].value, "thicken");
        const double thickness = std::stod(none.report.fault.hints[1].value);
        const SolidOfTriangles thick = solid_of_triangles(mesh, {SolidKind::kThicken, 0.0, thickness}, {});
        ASSERT_NE(thick.solid, nullptr);
        const double delta = kDefaultDelta.of(thick.solid->bounds().diagonal());
        EXPECT_GT(thickness, 2.0 * delta) << "the default tolerance shows it";
        const std::optional<Topology> topology = sampled_union(*thick.solid, {.tolerance = delta}).topology;
        ASSERT_TRUE(topology);
        EXPECT_EQ(*topology, (Topology{1, 1 - tunnels, tunnels, 0}));
    }
}

TEST(SolidOfTriangles, RefusesLengthsThatAreMissingOrHaveNoEffect) {
    const TriangleMesh mesh = sphere_mesh({0, 0, 0}, 1.0, 1);
    const auto make = [&](const SolidOptions& options) { return solid_of_triangles(mesh, options, {}); };
    EXPECT_THROW(make({.kind = SolidKind::kWrap}), InvalidOption);
    EXPECT_THROW(make({.kind = SolidKind::kThicken}), InvalidOption);
    EXPECT_THROW(make({.kind = SolidKind::kWrap, .opening = -1.0}), InvalidOption);
    EXPECT_THROW(make({.kind = SolidKind::kWrap, .opening = 0.1, .thickness = 0.1}), InvalidOption);
    EXPECT_THROW(make({.opening = 0.1}), InvalidOption);
    EXPECT_THROW(make({.kind = SolidKind::kThicken, .thickness = 1e-6}), InvalidOption);
    EXPECT_FALSE(solid_of_triangles(TriangleMesh{}, {.kind = SolidKind::kThicken, .thickness = 1.0}, {}).solid);
    EXPECT_TRUE(make({.kind = SolidKind::kWinding}).solid);
}

/// The opening that the refusal of another one names; 0 if it is not refused.
double opening_instead(const TriangleMesh& mesh, double opening) {
    // What is not refused is cancelled as the work begins.
    const Execution execution{0, [](std::string_view stage, double) { return stage != "sampling"; }};
    try {
        solid_of_triangles(mesh, {.kind = SolidKind::kWrap, .opening = opening}, execution);
    } catch (const Cancelled&) {
        return 0.0;
    } catch (const InvalidOption& refusal) {
        const std::string text = refusal.what();
        const std::string before = "choose an opening of at least ";
        EXPECT_NE(text.find("million samples"), std::string::npos) << text;
        EXPECT_NE(text.find(before), std::string::npos) << text;
        return std::stod(text.substr(text.find(before) + before.size()));
    }
    ADD_FAILURE() << "the work was done";
    return 0.0;
}

TEST(SolidOfTriangles, RefusesOpeningsThatWouldTakeTooLong) {
    // More than a 128th of the diagonal, and too fine because of the area.
    std::vector<TriangleMesh> shells;
    for (const double radius : {1.0, 0.95, 0.9, 0.85, 0.8, 0.75}) {
        shells.push_back(sphere_mesh({0, 0, 0}, radius, 3));
    }
    const TriangleMesh mesh = together(shells);
    const double least = opening_instead(mesh, 0.03);
    EXPECT_GT(least, 0.03);
    EXPECT_EQ(opening_instead(mesh, least), 0.0);
    for (const double opening : {0.008, 1e-300}) {
        EXPECT_NEAR(opening_instead(mesh, opening), least, 0.2 * least) << opening;
    }
}

}  // namespace
}  // namespace scaleaxis
