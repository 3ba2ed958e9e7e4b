// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/cleaning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/halving.hpp"
#include "axis/stages/resolved_fire.hpp"
#include "complexes.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/shrinking.hpp"
#include "scaleaxis/simplification.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The border edges of a complex.
std::vector<std::array<Index, 2>> border_of(const MedialComplex& complex) {
    std::vector<int> faces(complex.edges.size());
    for (const Index e : complex.face_edges.items) {
        ++faces[e];
    }
    std::vector<std::array<Index, 2>> result;
    for (std::size_t e = 0; e < faces.size(); ++e) {
        if (faces[e] == 1) {
            result.push_back(complex.edges[e]);
        }
    }
    return result;
}

TEST(ErosionThickness, OfASingleEdgeIsThatOfItsTips) {
    MedialComplex edge = complex_by_hand({{0, 0, 0}, {5, 0, 0}}, {}, {}, {{0, 1}});
    EXPECT_EQ(erosion_thickness(edge).thickness, (std::vector<double>{0.0, 0.0}));
    // The fire that comes first to the vertex between two edges goes on to meet the other one.
    MedialComplex path = complex_by_hand({{0, 0, 0}, {2, 0, 0}, {5, 0, 0}}, {}, {}, {{0, 1}, {1, 2}});
    EXPECT_EQ(erosion_thickness(path).thickness, (std::vector<double>{0.0, 2.0, 0.0}));
}

TEST(ErosionThickness, OfABoxIsThatOfItsFaces) {
    // The slanted sheets burn from the edges of the box, and what comes last ignites the sheet in the middle.
    constexpr Point kSize{6, 4, 2};
    const auto radius = [&](const Point& p) {
        return std::min({p.x, p.y, p.z, kSize.x - p.x, kSize.y - p.y, kSize.z - p.z});
    };
    MedialComplex complex = axis_of_box(kSize, radius);
    for (int level = 0; level < 4; ++level) {
        SCOPED_TRACE("level " + std::to_string(level));
        const ErosionThickness fire = erosion_thickness(complex);
        ASSERT_EQ(fire.corner_burn_times.size(), complex.faces.items.size());
        for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
            const Point& p = complex.vertices[v];
            const bool is_in_middle = p.z == 1.0 && radius(p) == 1.0;
            const double in_middle = std::min({p.x - 1.0, p.y - 1.0, 5.0 - p.x, 3.0 - p.y});
            const double expected =
                std::numbers::sqrt2 * (is_in_middle ? 1.0 : radius(p)) + (is_in_middle ? in_middle : 0.0);
            EXPECT_NEAR(fire.burn_times[v], expected, 1e-9) << p.x << ' ' << p.y << ' ' << p.z;
            EXPECT_NEAR(fire.thickness[v], expected - radius(p), 1e-9);
        }
        complex = refined(complex, radius);
    }
}

TEST(ErosionThickness, OfAPlaneSheetIsTheDistanceFromItsBorder) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        std::array<std::array<bool, 6>, 6> is_in{};
        for (auto& row : is_in) {
            for (bool& cell : row) {
                cell = random() % 3 != 0;
            }
        }
        // Radii that grow more slowly than ways: fire from places that burn late may come first all the same.
        const double slope = seed % 2 == 0 ? 0.0 : 0.6;
        const auto radius = [&](const Point& p) { return 1.0 + slope * p.x; };
        const MedialComplex complex = squares(
            1.0, 6, 6, 3, [&](int i, int j) { return is_in[i][j]; }, radius);
        const ErosionThickness fire = erosion_thickness(complex);
        const std::vector<std::array<Index, 2>> border = border_of(complex);
        for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
            double expected = kInfinity;
            for (const auto& [a, b] : border) {
                for (int k = 0; k <= 200; ++k) {
                    const Point p = complex.vertices[a] + (k / 200.0) * (complex.vertices[b] - complex.vertices[a]);
                    expected = std::min(expected, radius(p) + distance(p, complex.vertices[v]));
                }
            }
            EXPECT_LE(fire.burn_times[v], expected + 1e-9) << complex.vertices[v].x << ' ' << complex.vertices[v].y;
            EXPECT_GE(fire.burn_times[v], expected - 1e-4);
        }
    }
}

/// When the fire comes by in a plane sheet, from a border on which radii are those of a union.
double first_arrival(const MedialComplex& sheet, const Point& x) {
    double first = kInfinity;
    for (const auto& [a, b] : border_of(sheet)) {
        const double square = squared_distance(sheet.vertices[a], sheet.vertices[b]);
        for (int k = 0; k <= 500; ++k) {
            const double t = k / 500.0;
            const Point p = sheet.vertices[a] + t * (sheet.vertices[b] - sheet.vertices[a]);
            first = std::min(first, radius_between(sheet.radii[a], sheet.radii[b], square, t) + distance(p, x));
        }
    }
    return first;
}

TEST(BurntComplex, StartsAtDipsOfTheUnionAndBurnsAsBeforeWhereEdgesAreCut) {
    constexpr double kTolerance = 0.01;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        const MedialComplex sheet = squares(
            1.0, 4, 3, 1, [](int, int) { return true; }, [&](const Point&) { return 0.8 + 0.2 * unit(random); });
        BurntComplex burnt = burnt_complex(sheet, kTolerance);
        for (int round = 0; round < 3; ++round) {
            for (std::size_t s = 0; s < burnt.sectors.vertices.size(); ++s) {
                const Index v = burnt.sectors.vertices[s];
                const double expected = first_arrival(sheet, burnt.complex.vertices[v]);
                EXPECT_LE(burnt.fire.sector_times[s], expected + kTolerance) << v;
                EXPECT_GE(burnt.fire.sector_times[s], expected - 1e-3) << v;  // half a step of the border
                EXPECT_EQ(burnt.fire.vertex_times[v], std::max(burnt.radii[v], burnt.fire.sector_times[s]));
            }
            const std::size_t edges = burnt.complex.edges.size();
            Halving cuts{std::vector<std::uint8_t>(edges), std::vector<double>(edges), std::vector<double>(edges)};
            for (Index e = 0; e < static_cast<Index>(edges); ++e) {
                if (random() % 3 == 0) {
                    note_cut(burnt, e, 0.2 + 0.6 * unit(random), cuts);
                }
            }
            ASSERT_TRUE(cut(burnt, cuts));
        }
    }
}

TEST(ErosionThickness, OfACylinderGoesOnAlongItsCurve) {
    // Radius 1, length 6: a cone at each end, between their tips a curve.
    constexpr Index kSides = 48;
    std::vector<Point> vertices{{0, 0, 1}, {0, 0, 5}};
    std::vector<std::vector<Index>> faces;
    for (const Index end : {0, 1}) {
        for (Index k = 0; k < kSides; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / kSides;
            vertices.push_back({std::cos(angle), std::sin(angle), 6.0 * end});
            faces.push_back({end, 2 + end * kSides + k, 2 + end * kSides + (k + 1) % kSides});
        }
    }
    std::vector<std::array<Index, 2>> curve;
    Index previous = 0;
    for (int k = 1; k < 8; ++k) {
        vertices.push_back({0, 0, 1.0 + 0.5 * k});
        curve.push_back({previous, static_cast<Index>(std::ssize(vertices)) - 1});
        previous = curve.back()[1];
    }
    curve.push_back({1, previous});
    const auto radius = [](const Point& p) { return std::min(1.0 - std::hypot(p.x, p.y), std::min(p.z, 6.0 - p.z)); };
    const MedialComplex complex = with_radii(complex_by_hand(vertices, faces, {}, curve), [&](const Point& p) {
        return p.x == 0.0 && p.y == 0.0 ? 1.0 : std::max(0.0, radius(p));
    });
    const ErosionThickness fire = erosion_thickness(complex);
    // The rim is a polygon, whose sides are nearer to the tip.
    const double tip = std::hypot(std::cos(std::numbers::pi / kSides), 1.0);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (vertices[v].x == 0.0 && vertices[v].y == 0.0) {
            EXPECT_NEAR(fire.burn_times[v], tip + std::min(vertices[v].z - 1.0, 5.0 - vertices[v].z), 1e-9);
        } else {
            EXPECT_NEAR(fire.burn_times[v], 0.0, 1e-9);
        }
    }
}

TEST(ErosionThickness, IsInfiniteWhereNoFireComes) {
    // A tetrahedron's surface, which is around a void, with a fin; and a loop with a twig.
    const MedialComplex complex = complex_by_hand(
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, -1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {4, 0, 0}},
        {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 4}}, {}, {{5, 6}, {6, 7}, {5, 7}, {5, 8}});
    const ErosionThickness fire = erosion_thickness(complex);
    for (const Index v : {0, 1, 2, 3, 5, 6, 7}) {
        EXPECT_EQ(fire.burn_times[v], kInfinity) << v;
    }
    EXPECT_EQ(fire.burn_times[4], 1.0);
    EXPECT_EQ(fire.burn_times[8], 1.0);
    for (const std::size_t corner : {12, 13, 14}) {
        EXPECT_TRUE(std::isfinite(fire.corner_burn_times[corner])) << "of the fin";
    }
}

TEST(Clean, TakesNothingWithoutAThickness) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const MedialComplex complex = medial_axis(balls_through_points(random, 40, 12)).complex;
        const CleanedComplex cleaned = clean(complex, {.thickness = 0.0});
        EXPECT_EQ(cleaned.complex.vertices.size(), complex.vertices.size());
        EXPECT_EQ(cleaned.complex.faces.items, complex.faces.items);
        EXPECT_EQ(cleaned.complex.edges, complex.edges);
        EXPECT_EQ(cleaned.statistics.vertices_removed, 0);
        EXPECT_EQ(cleaned.statistics.area_removed, 0.0);
    }
    // A short twig, whose ball lies within the one that it sits on.
    MedialComplex twig = complex_by_hand({{0, 0, 0}, {3, 0, 0}, {0, 0.5, 0}}, {}, {}, {{0, 1}, {0, 2}});
    twig.radii = {2.0, 2.0, 1.0};
    EXPECT_EQ(clean(twig, {.thickness = 0.0}).complex.edges, twig.edges);
    EXPECT_EQ(clean(twig, {.thickness = 0.1}).complex.edges.size(), 1U);
}

TEST(Clean, CountsCurvesAndLoops) {
    const MedialComplex complex = complex_by_hand({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {-9, 0, 0}, {-18, 0, 0}}, {}, {},
                                                  {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {3, 4}});
    const CleanedComplex cleaned = clean(complex, {.thickness = 1.0});
    EXPECT_EQ(cleaned.complex.edges, complex.edges);
    EXPECT_EQ(cleaned.statistics.curves, 2) << "a loop, and a curve of two edges";
    const MedialComplex ring = complex_by_hand({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {}, {}, {{0, 1}, {1, 2}, {0, 2}});
    EXPECT_EQ(clean(ring, {.thickness = 1.0}).statistics.curves, 1);
}

TEST(Clean, TakesTeethAndLeavesTheSheet) {
    // A plate of 12 × 8 with a tooth of 0.25 × 1.
    const auto is_in = [](int i, int j) { return j < 32 || (j < 36 && i == 20); };
    const MedialComplex plate = squares(0.25, 48, 36, 2, is_in, [](const Point&) { return 2.0; });
    const CleanedComplex cleaned = clean(plate, {.thickness = 0.5});
    expect_well_formed(cleaned.complex);
    EXPECT_EQ(cleaned.complex.sheets, 1);
    EXPECT_EQ(cleaned.statistics.curves, 0);
    EXPECT_EQ(cleaned.statistics.topology, known_topology(1, 0, 0));
    double highest = 0.0;
    for (const Point& p : cleaned.complex.vertices) {
        highest = std::max(highest, p.y);
    }
    EXPECT_NEAR(highest, 8.0, 0.1) << "the border beside the tooth stays where it was";
    // The tooth, and the corners, as far as a disc of radius 0.5 does not reach into them.
    EXPECT_NEAR(cleaned.statistics.area_removed, 0.25 + (4.0 - std::numbers::pi) * 0.25, 0.15);
    EXPECT_NEAR(cleaned.statistics.largest_loss, 1.0, 0.15);
    EXPECT_EQ(clean(plate, {.thickness = 0.05}).complex.sheets, 1);
    EXPECT_LT(clean(plate, {.thickness = 0.05}).statistics.area_removed, 0.06) << "the tooth is wider than that";
}

TEST(Clean, MakesCurvesOfNarrowSheets) {
    // A limb of 20 × 0.5 at a plate of 8 × 8.
    const auto is_in = [](int i, int j) { return (i < 16 && j < 16) || (j == 8 && i < 56); };
    const MedialComplex complex = squares(0.5, 56, 16, 2, is_in, [](const Point&) { return 2.0; });
    const CleanedComplex cleaned = clean(complex, {.thickness = 0.5});
    expect_well_formed(cleaned.complex);
    EXPECT_EQ(cleaned.complex.sheets, 1);
    EXPECT_EQ(cleaned.statistics.curves, 1);
    EXPECT_EQ(cleaned.statistics.topology, known_topology(1, 0, 0));
    double length = 0.0, farthest = 0.0;
    for (const auto& [p, q] : curve_edges(cleaned.complex)) {
        length += distance(cleaned.complex.vertices[p], cleaned.complex.vertices[q]);
        farthest = std::max({farthest, cleaned.complex.vertices[p].x, cleaned.complex.vertices[q].x});
    }
    EXPECT_GT(farthest, 27.5) << "the curve reaches the tip";
    EXPECT_NEAR(length, 20.0, 1.0);
    // Alone it is a curve and nothing else; short, a ball.
    const auto strip = [](double long_side) {
        return squares(
            0.5, static_cast<int>(2 * long_side), 1, 2, [](int, int) { return true; },
            [](const Point&) { return 2.0; });
    };
    const CleanedComplex curve = clean(strip(6.0), {.thickness = 0.5});
    EXPECT_TRUE(curve.complex.faces.empty());
    EXPECT_EQ(curve.statistics.curves, 1);
    EXPECT_EQ(curve.complex.edges.size() + 1, curve.complex.vertices.size());
    const CleanedComplex ball = clean(strip(0.5), {.thickness = 0.5});
    EXPECT_EQ(ball.complex.vertices.size(), 1U);
    EXPECT_TRUE(ball.complex.edges.empty());
}

/// A parallelogram of `nu` × `nv` faces with the sides `u` and `v`.
struct Grid {
    Point origin;
    Point u, v;
    int nu, nv;
};

MedialComplex grids(std::span<const Grid> all, double radius) {
    std::vector<Point> vertices;
    std::vector<std::vector<Index>> faces;
    for (const auto& [origin, u, v, nu, nv] : all) {
        std::map<std::array<int, 2>, Index> grid;
        for (int i = 0; i <= nu; ++i) {
            for (int j = 0; j <= nv; ++j) {
                const Point p = origin + static_cast<double>(i) * u + static_cast<double>(j) * v;
                const auto known =
                    std::ranges::find_if(vertices, [&](const Point& q) { return distance(p, q) < 1e-9; });
                grid[{i, j}] = static_cast<Index>(known - vertices.begin());
                if (known == vertices.end()) {
                    vertices.push_back(p);
                }
            }
        }
        for (int i = 0; i < nu; ++i) {
            for (int j = 0; j < nv; ++j) {
                faces.push_back({grid[{i, j}], grid[{i + 1, j}], grid[{i + 1, j + 1}], grid[{i, j + 1}]});
            }
        }
    }
    return with_radii(complex_by_hand(vertices, faces), [&](const Point&) { return radius; });
}

/// A plate of 12 × 6, and across it sheets of heights 0.5, at x = 3, and 2, at x = 8.
MedialComplex plate_with_fins(double radius, std::span<const Grid> others = {}) {
    std::vector<Grid> all{Grid{{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, 0}, 48, 24},
                          Grid{{3, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}, 24, 2},
                          Grid{{8, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}, 24, 8}};
    all.insert(all.end(), others.begin(), others.end());
    return grids(all, radius);
}

TEST(Clean, TakesFinsThatAreLowAndKeepsOthers) {
    const MedialComplex complex = plate_with_fins(3.0);
    ASSERT_EQ(complex.sheets, 5);
    const CleanedComplex cleaned = clean(complex, {.thickness = 0.75});
    expect_well_formed(cleaned.complex);
    EXPECT_EQ(cleaned.statistics.sheets_before, 5);
    EXPECT_EQ(cleaned.statistics.sheets_after, 3);
    EXPECT_EQ(cleaned.statistics.topology, known_topology(1, 0, 0));
    double highest = 0.0;
    for (const Point& p : cleaned.complex.vertices) {
        highest = std::max(highest, p.z);
        EXPECT_FALSE(std::abs(p.x - 3.0) < 1e-9 && p.z > 0.0);
    }
    EXPECT_NEAR(highest, 2.0, 0.1);
    // Discs do not reach into the corners of fins, which stay all the same, or the sheets across would hang together.
    const MedialComplex less = clean(complex, {.thickness = 0.3}).complex;
    EXPECT_EQ(less.sheets, 5);
    EXPECT_TRUE(std::ranges::any_of(less.vertices, [](const Point& p) { return p.x == 3.0 && p.z > 0.4; }));
}

TEST(Clean, KeepsAFinAlongAllOfItsSeam) {
    // From y = 3 on it becomes low. Crumbs that go do not divide the seam.
    const Grid crumb{{8, 2.5, 0}, {0, 0.25, 0}, {0, 0, -0.25}, 3, 1};
    for (const MedialComplex& plate : {plate_with_fins(3.0), plate_with_fins(3.0, std::span(&crumb, 1))}) {
        MedialComplex complex = plate;
        for (Point& p : complex.vertices) {
            p.z *= p.x == 8.0 && p.z > 0.0 ? std::clamp(4.0 - p.y, 0.1, 1.0) : 1.0;
        }
        const CleanedComplex cleaned = clean(complex, {.thickness = 0.75});
        expect_well_formed(cleaned.complex);
        EXPECT_EQ(cleaned.statistics.sheets_after, 3) << "else the plate is one sheet around the end of the fin";
        const auto has = [&](const auto& is_asked) { return std::ranges::any_of(cleaned.complex.vertices, is_asked); };
        EXPECT_FALSE(has([](const Point& p) { return p.x == 3.0 && p.z > 0.0; }));
        EXPECT_FALSE(has([](const Point& p) { return p.z < 0.0; }));
        EXPECT_TRUE(has([](const Point& p) { return p.y > 5.9 && p.z > 0.0; }));
    }
}

TEST(Clean, LeadsSeamsThatEndTooEarlyToTheBorder) {
    // Two sheets at a right angle, and a third one, which ends 0.25 before they do: they are one sheet around its end.
    const MedialComplex complex = grids(std::array{Grid{{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, 0}, 16, 16},
                                                   Grid{{0, 0, 0}, {0.25, 0, 0}, {0, 0, 0.25}, 16, 16},
                                                   Grid{{0, 0, 0}, {0.25, 0, 0}, {0, -0.2, -0.2}, 15, 16}},
                                        3.0);
    ASSERT_EQ(complex.sheets, 2);
    const MedialComplex cleaned = clean(complex, {.thickness = 0.2}).complex;
    expect_well_formed(cleaned);
    EXPECT_EQ(cleaned.sheets, 3);
    EXPECT_EQ(topology(cleaned), known_topology(1, 0, 0));
    EXPECT_EQ(clean(complex, {.thickness = 0.1}).complex.sheets, 2) << "too far";
    EXPECT_EQ(clean(complex, {.thickness = 0.2, .finds_ridges = false}).complex.sheets, 2);
}

TEST(Clean, TakesCrumbsWithSmallBallsUnlessTheyStandAlone) {
    // Balls of 0.8 protect what is half as thick, but not a crumb on a larger sheet.
    const CleanedComplex cleaned = clean(plate_with_fins(0.8), {.thickness = 0.75});
    EXPECT_EQ(cleaned.statistics.sheets_after, 3);
    EXPECT_LE(cleaned.statistics.largest_loss, 0.75);
    const MedialComplex alone = squares(
        0.25, 4, 4, 2, [](int, int) { return true; }, [](const Point&) { return 0.8; });
    EXPECT_EQ(clean(alone, {.thickness = 0.75}).statistics.sheets_after, 1);
}

TEST(ContractSlivers, DrawsSheetsTogetherThatAreButASeam) {
    // Twice as long as high, and hardly wider than high: the sheet in the middle is a strip between two seams.
    constexpr double kWidth = 0.02;
    constexpr Point kSize{4, 2 + kWidth, 2};
    const auto radius = [&](const Point& p) {
        return std::max(0.0, std::min({p.x, p.y, p.z, kSize.x - p.x, kSize.y - p.y, kSize.z - p.z}));
    };
    const MedialComplex complex = refined(refined(refined(axis_of_box(kSize, radius), radius), radius), radius);
    ASSERT_EQ(complex.sheets, 13);
    EXPECT_EQ(contract_slivers(complex, kWidth).sheets, 13);
    const MedialComplex contracted = contract_slivers(complex, 3.0 * kWidth);
    expect_consistent(contracted);
    EXPECT_EQ(contracted.sheets, 12);
    EXPECT_EQ(topology(contracted), topology(complex));
    // Cut into triangles it is the same.
    EXPECT_EQ(simplify(contracted, {.error = 1e-3}).statistics.topology, topology(complex));
    EXPECT_THROW(contract_slivers(complex, 0.0), InvalidOption);
    for (std::size_t v = 0; v < contracted.vertices.size(); ++v) {
        const Point& p = contracted.vertices[v];
        EXPECT_NEAR(contracted.radii[v], radius(p), 1e-12) << "no ball is new";
        if (v % 20 == 0) {  // asks all faces
            EXPECT_LE(distance_to(complex, p), kWidth);
        }
    }
}

TEST(Clean, KeepsTheHomotopyTypeOfRandomUnions) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const std::vector<Ball> balls = seed % 3 == 0   ? ring_of_balls(10 + static_cast<int>(seed), 2.0, 0.7)
                                        : seed % 3 == 1 ? balls_around_a_void(random, 40, 0.6)
                                                        : scattered_balls(random, 40, 1.0, 0.2, 0.7);
        const MedialComplex complex = filter(medial_axis(balls).complex).complex;
        const Topology before = topology(complex);
        for (const double thickness : {0.001, 0.01, 0.1, 1.0}) {
            SCOPED_TRACE(thickness);
            const CleanedComplex cleaned = clean(complex, {.thickness = thickness});
            expect_well_formed(cleaned.complex);
            EXPECT_EQ(cleaned.statistics.topology, before);
            EXPECT_EQ(topology(cleaned.complex), before);
            // What goes lies within about the thickness of the balls that stay.
            EXPECT_LE(cleaned.statistics.largest_loss, 2.0 * thickness + 1e-9);
            EXPECT_LE(cleaned.statistics.mean_loss, cleaned.statistics.largest_loss);
        }
    }
}

TEST(Clean, DoesNotDependOnSizeAndPlace) {
    Random random(5);
    const std::vector<Ball> balls = scattered_balls(random, 40, 1.0, 0.2, 0.7);
    const MedialComplex complex = filter(medial_axis(balls).complex).complex;
    const CleanedComplex cleaned = clean(complex, {.thickness = 0.05});
    EXPECT_GT(cleaned.statistics.area_removed, 0.0);
    MedialComplex moved = complex;
    for (std::size_t v = 0; v < moved.vertices.size(); ++v) {
        const Point p = moved.vertices[v];
        moved.vertices[v] = Point{8.0 * p.y, -8.0 * p.x, 8.0 * p.z};  // exact: a power of two, and a turn
        moved.radii[v] *= 8.0 / 2.0;
    }
    const CleanedComplex again = clean(with_scale(moved, 2.0), {.thickness = 0.4});
    EXPECT_EQ(again.complex.edges, cleaned.complex.edges);
    EXPECT_EQ(again.complex.faces.items, cleaned.complex.faces.items);
    EXPECT_NEAR(again.statistics.area_removed, 64.0 * cleaned.statistics.area_removed, 1e-9);
}

TEST(Clean, GivesTheSameBytesForAnyThreads) {
    Random random(6);
    const MedialComplex complex = medial_axis(scattered_balls(random, 200, 1.5, 0.2, 0.5)).complex;
    const CleanedComplex one = clean(complex, {.thickness = 0.02}, {.threads = 1});
    const CleanedComplex four = clean(complex, {.thickness = 0.02}, {.threads = 4});
    EXPECT_TRUE(one.complex.vertices == four.complex.vertices);
    EXPECT_EQ(one.complex.radii, four.complex.radii);
    EXPECT_EQ(one.complex.faces.items, four.complex.faces.items);
    EXPECT_EQ(one.statistics.mean_loss, four.statistics.mean_loss);
}

TEST(Clean, RefusesWhatIsNoThickness) {
    const MedialComplex complex = complex_by_hand({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    for (const double wrong : {-1.0, std::nan(""), kInfinity}) {
        EXPECT_THROW(clean(complex, {.thickness = wrong}), InvalidOption);
    }
    MedialComplex broken = complex;
    broken.radii.pop_back();
    EXPECT_THROW(clean(broken, {.thickness = 1.0}), UnusableInput);
    EXPECT_THROW(erosion_thickness(broken), UnusableInput);
    EXPECT_TRUE(clean({}, {.thickness = 1.0}).complex.vertices.empty());
    EXPECT_TRUE(erosion_thickness({}).burn_times.empty());
}

// The corners of a plate are cut. Where radii are linear, as in the medial meshes of other programs, they are so on
// cuts.
TEST(Clean, CutsSlabsWhereRadiiAreLinear) {
    constexpr Index kCount = 13;
    std::vector<Point> points;
    std::vector<std::vector<Index>> squares;
    for (Index i = 0; i < kCount; ++i) {
        for (Index j = 0; j < kCount; ++j) {
            points.push_back({0.5 * i, 0.5 * j, 0.0});
            if (i > 0 && j > 0) {
                const Index v = kCount * i + j;
                squares.push_back({v - kCount - 1, v - 1, v, v - kCount});
            }
        }
    }
    MedialComplex plate = complex_by_hand(points, squares, {}, {});
    const auto radius = [](const Point& p) { return 2.0 + 0.1 * p.x; };
    std::ranges::transform(points, plate.radii.begin(), radius);
    const MedialComplex cut = clean(with_linear_radii(plate), {.thickness = 1.0}).complex;
    std::size_t added = 0;
    for (std::size_t v = 0; v < cut.vertices.size(); ++v) {
        EXPECT_NEAR(cut.radii[v], radius(cut.vertices[v]), 1e-12);
        EXPECT_TRUE(is_linear(cut.vertex_origins[v]));
        added += std::ranges::find(points, cut.vertices[v]) == points.end() ? 1 : 0;
    }
    EXPECT_GT(added, 3U);
}

}  // namespace
}  // namespace scaleaxis
