// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "axis/stages/crests.hpp"
#include "complexes.hpp"
#include "homology.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/shrinking.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using namespace test;

// Complexes by hand. Angles below 30 degrees mark what may go.

constexpr double kSmall = 10.0;
constexpr double kLarge = 60.0;

TEST(Filter, RemovesAFinAndJoinsWhatItDivided) {
    const MedialComplex fin =
        complex_by_hand({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {0, 0, 1}, {0, 1, 1}},
                        {{0, 2, 3, 1}, {0, 1, 5, 4}, {0, 1, 7, 6}}, {kLarge, kLarge, kSmall});
    ASSERT_EQ(fin.sheets, 3);
    const FilteredComplex filtered = filter(fin);
    expect_well_formed(filtered.complex);
    EXPECT_EQ(filtered.complex.vertices.size(), 6U);
    EXPECT_EQ(filtered.complex.edges.size(), 7U);
    EXPECT_EQ(filtered.complex.faces.size(), 2U);
    EXPECT_EQ(filtered.complex.face_angles, (std::vector<double>{kLarge, kLarge}));
    EXPECT_EQ(filtered.statistics.sheets_before, 3);
    EXPECT_EQ(filtered.statistics.sheets_after, 1);
    EXPECT_EQ(filtered.statistics.faces_removed, 1);
    EXPECT_EQ(filtered.statistics.topology, known_topology(1, 0, 0));
    EXPECT_EQ(filter(fin, {.angle = kSmall}).complex.faces.size(), 3U) << "only what is below the threshold goes";
}

TEST(Filter, KeepsASheetWithOneLargeAngle) {
    const MedialComplex square =
        complex_by_hand({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {kSmall, kLarge});
    EXPECT_EQ(filter(square).complex.faces.size(), 2U);
}

TEST(Filter, ByAreaAsksWholeSheets) {
    const auto row = [](const std::vector<double>& angles) {  // of squares
        std::vector<Point> vertices{{0, 0, 0}, {0, 1, 0}};
        std::vector<std::vector<Index>> faces;
        for (Index i = 1; i <= std::ssize(angles); ++i) {
            vertices.push_back({static_cast<double>(i), 0, 0});
            vertices.push_back({static_cast<double>(i), 1, 0});
            faces.push_back({2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 1});
        }
        return complex_by_hand(vertices, faces, angles);
    };
    const FilterOptions by_area{.measure = SheetAngle::kByArea};
    const MedialComplex narrow = row({22, 22, 80, 22, 22, 22});
    EXPECT_EQ(filter(narrow).complex.faces.size(), 6U) << "one face is wide";
    EXPECT_EQ(filter(narrow, by_area).complex.faces.size(), 0U);
    EXPECT_EQ(filter(narrow, {.angle = 0.0, .measure = SheetAngle::kByArea}).complex.faces.size(), 6U);
    EXPECT_EQ(filter(row({22, 80, 80, 22, 22, 22}), by_area).complex.faces.size(), 6U) << "a third is wide";
    EXPECT_EQ(filter(row({30.3, 30.3, 30.3}), by_area).complex.faces.size(), 0U) << "the angle, but for rounding";
    EXPECT_EQ(filter(row({30.7, 30.7, 30.7}), by_area).complex.faces.size(), 3U);
    const MedialComplex curve = complex_by_hand({{0, 0, 0}, {0.9, 0, 0}}, {}, {}, {{0, 1}});
    EXPECT_EQ(filter(curve, {.angle = 90.0, .measure = SheetAngle::kByArea}).complex.edges.size(), 1U) << "curves stay";
    EXPECT_THROW(filter(row({0, 30}), by_area), UnusableInput) << "unknown angles";
}

TEST(Filter, ByAreaAsksWhatCreasesDivide) {
    // Three wide sheets that meet on the z axis up to 1. Beyond, a narrow triangle is left that makes one of two of
    // them.
    const auto seam = [](double size, bool is_turned) {
        const std::vector<Index> triangle = is_turned ? std::vector<Index>{1, 5, 3} : std::vector<Index>{1, 3, 5};
        return complex_by_hand({{0, 0, 0},
                                {0, 0, 1},
                                {1, 0, 0},
                                {size, 0, 1 + size},
                                {0, 1, 0},
                                {0, size, 1 + size},
                                {-1, -1, 0},
                                {-1, -1, 1}},
                               {{0, 2, 3, 1}, {0, 6, 7, 1}, triangle, {0, 4, 5, 1}}, {kLarge, kLarge, 27.0, kLarge});
    };
    const FilterOptions by_area{.measure = SheetAngle::kByArea};
    for (const bool is_turned : {false, true}) {
        const MedialComplex whole = seam(1.0, is_turned);
        EXPECT_EQ(whole.sheets, 2);
        EXPECT_EQ(filter(whole, by_area).complex.faces.size(), 3U);
        EXPECT_EQ(filter(whole, by_area).complex.sheets, 3);
        EXPECT_EQ(filter(seam(0.01, is_turned), by_area).complex.faces.size(), 4U) << "narrower than δ";
    }
}

// A square fin of a narrow sheet on two squares of a wide one, with the radius 1 where it hangs.
MedialComplex fin_of_radius(double radius) {
    MedialComplex fin =
        complex_by_hand({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {0, 0, 1}, {0, 1, 1}},
                        {{0, 2, 3, 1}, {0, 1, 5, 4}, {0, 1, 7, 6}}, {kLarge, kLarge, kSmall});
    fin.radii[6] = fin.radii[7] = radius;
    return fin;
}

TEST(Filter, ByAreaLeavesCurvesToBallsThatNothingCovers) {
    const FilterOptions by_area{.measure = SheetAngle::kByArea};
    const MedialComplex covered = filter(fin_of_radius(0.1), by_area).complex;
    EXPECT_EQ(covered.faces.size(), 2U);
    EXPECT_EQ(covered.vertices.size(), 6U);
    const MedialComplex larger = filter(fin_of_radius(1.2), by_area).complex;
    expect_well_formed(larger);
    EXPECT_EQ(larger.faces.size(), 2U);
    EXPECT_EQ(larger.vertices.size(), 8U) << "both of the larger balls";
    EXPECT_EQ(larger.edges.size(), 7U + 2U);
}

// As in a bar with so many sides: sheets around the z axis, from 0 to 4, whose radii fall from 1 on it.
MedialComplex star(int sheets, double angle) {
    constexpr Index kSteps = 16;
    std::vector<Point> vertices;
    std::vector<std::vector<Index>> faces;
    const double width = 0.9 / std::cos(angle * std::numbers::pi / 180.0);
    for (Index k = 0; k <= sheets; ++k) {
        const double turn = 2.0 * std::numbers::pi * k / sheets;
        for (Index i = 0; i <= kSteps; ++i) {
            const double z = 4.0 * i / kSteps;
            vertices.push_back(k == 0 ? Point{0, 0, z} : Point{width * std::cos(turn), width * std::sin(turn), z});
            if (k > 0 && i > 0) {
                const Index outer = k * (kSteps + 1) + i;
                faces.push_back({i - 1, outer - 1, outer, i});
            }
        }
    }
    MedialComplex result = complex_by_hand(vertices, faces, std::vector<double>(faces.size(), angle));
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        result.radii[v] = 1.0 - 0.9 * std::hypot(vertices[v].x, vertices[v].y) / width;
    }
    return result;
}

TEST(Filter, ByAreaLeavesTheCurveInWhichNarrowSheetsMeet) {
    for (const int sheets : {2, 3, 6, 7}) {
        for (const double angle : {12.0, 22.5, 30.0}) {
            SCOPED_TRACE(std::to_string(sheets) + " sheets of " + std::to_string(angle));
            const FilteredComplex filtered = filter(star(sheets, angle), {.measure = SheetAngle::kByArea});
            expect_well_formed(filtered.complex);
            EXPECT_EQ(filtered.complex.faces.size(), 0U);
            EXPECT_EQ(filtered.complex.edges.size(), 16U);
            for (const Point& p : filtered.complex.vertices) {
                EXPECT_EQ(std::hypot(p.x, p.y), 0.0);
            }
            EXPECT_EQ(filtered.statistics.topology, known_topology(1, 0, 0));
        }
    }
    EXPECT_EQ(filter(star(6, 31.0), {.measure = SheetAngle::kByArea}).complex.faces.size(), 6U * 16U);
}

// A curve of unit balls, two long, with a way of two edges to a ball that hangs on its middle.
TEST(Crests, LoseHairsThatTheirCurveCovers) {
    const auto left = [](const Point& end, double radius, bool is_narrow, Index steps) {
        std::vector<Point> vertices;
        for (Index i = 0; i <= steps; ++i) {
            vertices.push_back({2.0 * i / steps, 0, 0});
        }
        std::vector<std::array<Index, 2>> edges = chain_edges(steps + 1);
        vertices.push_back(0.5 * (vertices[steps / 2] + end));
        vertices.push_back(end);
        edges.push_back({steps / 2, steps + 1});
        edges.push_back({steps + 1, steps + 2});
        MedialComplex complex = complex_by_hand(vertices, {}, {}, edges);
        complex.radii[steps + 1] = 0.5 * (1.0 + radius);
        complex.radii[steps + 2] = radius;
        Remainder remainder(complex);
        remove_hairs(complex, std::vector<std::uint8_t>(vertices.size(), is_narrow ? 1 : 0), 1.0 / 1.16, remainder);
        const MedialComplex rest = complex_of(remainder, complex);
        expect_well_formed(rest);
        EXPECT_EQ(topology(rest), known_topology(1, 0, 0));
        return rest.vertices.size();
    };
    EXPECT_EQ(left({1, 0.5, 0}, 0.6, true, 20), 21U);
    EXPECT_EQ(left({1.5, 0.5, 0}, 0.6, true, 20), 21U) << "covered by a ball beside that on which it hangs";
    EXPECT_EQ(left({1.5, 0.5, 0}, 0.6, true, 2), 3U) << "covered by a ball between vertices";
    EXPECT_EQ(left({1, 0.5, 0}, 0.6, false, 20), 23U) << "hangs on what was no narrow sheet";
    EXPECT_EQ(left({1, 0.5, 0}, 0.7, true, 20), 23U) << "sticks out";
    EXPECT_EQ(left({1, 3, 0}, 1.0, true, 20), 23U);
}

TEST(Filter, ByAreaTakesSheetsWithoutWidthForCurves) {
    // Between two curves one face that is wide by its angle, and no ball's thousandth across.
    const MedialComplex crumb = complex_by_hand({{0, 0, 0}, {1, 0, 0}, {1.5, 1e-4, 0}, {2, 0, 0}, {3, 0, 0}},
                                                {{1, 2, 3}}, {kLarge}, {{0, 1}, {3, 4}});
    const MedialComplex filtered = filter(crumb, {.measure = SheetAngle::kByArea}).complex;
    EXPECT_EQ(filtered.faces.size(), 0U);
    EXPECT_EQ(topology(filtered), known_topology(1, 0, 0));
    EXPECT_EQ(filtered.vertices.front(), (Point{0, 0, 0}));
    EXPECT_EQ(filtered.vertices.back(), (Point{3, 0, 0}));
}

// A roof whose radius falls from 1 at the ridge to 0.5 at the eaves, one away: the cosine of the angle is 1/2.
MedialComplex roof(const std::vector<double>& angles) {
    MedialComplex result = complex_by_hand({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.2, 1, 0}, {0, 0.5, 0}, {1, -1, 0}},
                                           {{0, 1, 2, 3, 4}, {0, 1, 5}}, angles, {});
    result.radii = {1.0, 1.0, 0.5, 0.5, 0.75, 0.5};
    return with_linear_radii(std::move(result));
}

TEST(ObjectAngles, AreTheSlopesOfTheRadii) {
    const MedialComplex found = with_object_angles(roof({0.0, 0.0}));
    EXPECT_NEAR(found.face_angles[0], 60.0, 1e-9);
    EXPECT_NEAR(found.face_angles[1], 60.0, 1e-9);
    EXPECT_NEAR(with_object_angles(with_scale(roof({0.0, 0.0}), 1.5)).face_angles[0],
                std::acos(0.75) * 180.0 / std::numbers::pi, 1e-9);
    EXPECT_EQ(with_object_angles(with_scale(roof({0.0, 0.0}), 3.0)).face_angles, (std::vector<double>{1e-3, 1e-3}));
    EXPECT_EQ(with_object_angles(roof({kSmall, 0.0})).face_angles[0], kSmall) << "known angles stay";
    MedialComplex flat = roof({0.0, 0.0});
    flat.vertices[5] = {3, 0, 0};
    EXPECT_EQ(with_object_angles(flat).face_angles[1], 1e-3) << "no area";
    EXPECT_THROW(with_object_angles(with_scale(flat, 0.5)), UnusableInput);
    EXPECT_THROW(filter(roof({0.0, 0.0})), UnusableInput);
    EXPECT_EQ(filter(found, {.angle = 59.0}).complex.faces.size(), 2U);
    EXPECT_EQ(filter(found, {.angle = 61.0}).complex.faces.size(), 0U);
}

TEST(ObjectAngles, OfAnAxisAreThoseOfItsContacts) {
    const ImplicitSolid solid = box_solid({1.0, 0.6, 0.4});
    const std::vector<Ball> balls = inner_balls(sample(solid, {.tolerance = 0.03, .sizing = Sizing::kUniform}));
    const MedialComplex exact = filter(medial_axis(balls).complex).complex;
    for (const double scale : {1.0, 1.2}) {
        MedialComplex complex = exact;
        std::ranges::fill(complex.face_angles, 0.0);
        complex = with_object_angles(shrink(complex, scale));
        std::vector<double> differences;
        for (std::size_t f = 0; f < exact.faces.size(); ++f) {
            differences.push_back(std::abs(complex.face_angles[f] - exact.face_angles[f]));
        }
        std::ranges::sort(differences);
        EXPECT_LT(differences[differences.size() * 99 / 100], 0.01) << "degrees";
        complex.face_angles.assign(exact.faces.size(), 0.0);
        complex = with_object_angles(with_linear_radii(std::move(complex)));
        std::size_t near = 0;
        for (std::size_t f = 0; f < exact.faces.size(); ++f) {
            near += std::abs(complex.face_angles[f] - exact.face_angles[f]) < 15.0 ? 1 : 0;
        }
        EXPECT_GT(near, exact.faces.size() * 4 / 5) << "slabs: one slope a face";
    }
}

TEST(Filter, TakesCurvesAsSeenFromTheGrownBalls) {
    MedialComplex bar = complex_by_hand({{0, 0, 0}, {0.9, 0, 0}}, {}, {}, {{0, 1}});
    bar.radii = {1.0, 0.2};  // 65 degrees; 28 before the division by 1.1
    const double angle = 45.0;
    EXPECT_EQ(filter(bar, {.angle = angle}).complex.edges.size(), 1U);
    EXPECT_EQ(filter(with_scale(bar, 1.1), {.angle = angle}).complex.edges.size(), 0U);
}

TEST(Filter, TakesEdgesOfOtherProgramsForCones) {
    MedialComplex bar = complex_by_hand({{0, 0, 0}, {4, 0, 0}}, {}, {}, {{0, 1}});
    bar.radii = {1.0, 0.5};
    const MedialComplex cone = with_linear_radii(bar);  // 83 degrees
    EXPECT_EQ(filter(bar, {.angle = 80.0}).complex.edges.size(), 0U) << "balls of a union, with a neck between them";
    EXPECT_EQ(filter(cone, {.angle = 80.0}).complex.edges.size(), 1U);
    EXPECT_EQ(filter(cone, {.angle = 85.0}).complex.edges.size(), 0U);
    EXPECT_EQ(filter(with_scale(cone, 1.5), {.angle = 80.0}).complex.edges.size(), 0U);
}

TEST(Thresholded, KeepsFacesBySizeWhateverBecomesOfTheTopology) {
    // Two squares at an edge, with a curve at a far corner of the second one, and an isolated ball.
    MedialComplex complex =
        complex_by_hand({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {2, 2, 0}, {9, 9, 9}},
                        {{0, 2, 3, 1}, {0, 1, 5, 4}}, {kSmall, kLarge}, {{3, 6}});
    complex.boundary_vertices = {{0, 0, 1}, {0, 0, -1}, {0, 0, 3}, {0, 0, -3}};
    complex.boundary_vertex_balls.resize(4);
    complex.face_contacts = {{0, 1}, {2, 3}};
    const auto kept = [&](LocalMeasure measure, double threshold) {
        const FilteredComplex result = thresholded(complex, measure, threshold);
        expect_well_formed(result.complex);
        EXPECT_EQ(result.statistics.topology, topology(result.complex));
        EXPECT_EQ(result.statistics.faces_removed + result.complex.faces.size(), 2U);
        return std::array{result.complex.vertices.size(), result.complex.edges.size(), result.complex.faces.size()};
    };
    EXPECT_EQ(kept(LocalMeasure::kObjectAngle, 0.0), (std::array<std::size_t, 3>{8, 8, 2}));
    // Equal radii at the ends of the curve: it is seen at a right angle in its middle, from a circle of this radius.
    const double circle = std::sqrt(1.0 - 0.5);
    EXPECT_EQ(kept(LocalMeasure::kObjectAngle, 30.0), (std::array<std::size_t, 3>{7, 5, 1}))
        << "one square, the curve apart from it, the ball";
    EXPECT_EQ(kept(LocalMeasure::kCircumradius, circle - 1e-9), (std::array<std::size_t, 3>{8, 8, 2}));
    EXPECT_EQ(kept(LocalMeasure::kCircumradius, circle + 1e-9), (std::array<std::size_t, 3>{7, 7, 2}));
    EXPECT_EQ(kept(LocalMeasure::kCircumradius, 1.0), (std::array<std::size_t, 3>{7, 7, 2}));
    EXPECT_EQ(kept(LocalMeasure::kCircumradius, 1.1), (std::array<std::size_t, 3>{4, 4, 1}));
    EXPECT_EQ(kept(LocalMeasure::kCircumradius, 3.1), (std::array<std::size_t, 3>{0, 0, 0}));
    EXPECT_THROW(thresholded(complex, LocalMeasure::kObjectAngle, -1.0), InvalidOption);
    EXPECT_THROW(thresholded(complex, LocalMeasure::kObjectAngle, std::nan("")), InvalidOption);
}

TEST(Filter, KeepsVoids) {
    const std::vector<Point> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const MedialComplex sphere =
        complex_by_hand(corners, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}, std::vector<double>(4, kSmall));
    EXPECT_TRUE(same_bytes(filter(sphere).complex, sphere));

    // A partition between two voids has no free edge either.
    const std::vector<Point> five{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
    const MedialComplex chambers =
        complex_by_hand(five, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}, {0, 1, 4}, {1, 2, 4}, {2, 0, 4}},
                        {kSmall, kLarge, kLarge, kLarge, kLarge, kLarge, kLarge});
    EXPECT_TRUE(same_bytes(filter(chambers).complex, chambers));
}

TEST(Filter, KeepsWhatClosesATunnel) {
    // A strip between two seams of a tube: without it the tube would have another hole. Removing it from the other
    // one, which ends in the open, changes nothing.
    std::vector<Point> points;
    std::vector<std::vector<Index>> faces;
    std::vector<double> angles;
    constexpr Index kSides = 8;
    for (Index ring = 0; ring < 2; ++ring) {
        for (Index k = 0; k < kSides; ++k) {
            const double angle = 0.25 * std::numbers::pi * k;
            points.push_back({std::cos(angle), std::sin(angle), 1.0 * ring});
        }
    }
    for (Index k = 0; k < kSides; ++k) {
        const Index next = (k + 1) % kSides;
        faces.push_back({k, next, next + kSides, k + kSides});
        angles.push_back(kLarge);
    }
    const auto with = [&](const std::vector<Point>& more_points, const std::vector<Index>& face) {
        std::vector<Point> p = points;
        p.insert(p.end(), more_points.begin(), more_points.end());
        std::vector<std::vector<Index>> f = faces;
        f.push_back(face);
        std::vector<double> a = angles;
        a.push_back(kSmall);
        return complex_by_hand(p, f, a);
    };
    const MedialComplex divided = with({}, {0, 4, 4 + kSides, kSides});
    EXPECT_EQ(topology(divided), known_topology(1, 2, 0));
    EXPECT_TRUE(same_bytes(filter(divided).complex, divided));
    const MedialComplex winged = with({{2, 0, 0}, {2, 0, 1}}, {0, 16, 17, kSides});
    EXPECT_EQ(filter(winged).complex.faces.size(), 8U);
    EXPECT_EQ(filter(winged).complex.vertices.size(), 16U);
}

TEST(Filter, SeesSheetsThatTouchInASingleVertex) {
    // A triangle that holds at one vertex may go, one that connects two squares must not.
    const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {3, 0, 0},
                                    {4, 0, 0}, {4, 1, 0}, {3, 1, 0}, {2, 1, 1}, {2, 0, 1}};
    const std::vector<std::vector<Index>> squares{{0, 1, 2, 3}, {4, 5, 6, 7}};
    std::vector<std::vector<Index>> faces = squares;
    faces.push_back({1, 9, 8});
    const FilteredComplex loose = filter(complex_by_hand(points, faces, {kLarge, kLarge, kSmall}));
    EXPECT_EQ(loose.complex.faces.size(), 2U);
    EXPECT_EQ(loose.complex.vertices.size(), 8U);
    faces.back() = {1, 4, 8};
    const MedialComplex held =
        complex_by_hand(std::vector<Point>(points.begin(), points.end() - 1), faces, {kLarge, kLarge, kSmall});
    EXPECT_TRUE(same_bytes(filter(held).complex, held));
}

TEST(Filter, KeepsCurvesAndWhatHoldsThem) {
    const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 0}, {-1, -1, 0}};
    // A curve goes on behind the sheet on two sides, or hangs on it alone.
    const MedialComplex between = complex_by_hand(points, {{0, 1, 2, 3}}, {kSmall}, {{2, 4}, {0, 5}});
    EXPECT_TRUE(same_bytes(filter(between).complex, between));
    const FilteredComplex alone =
        filter(complex_by_hand({points.begin(), points.end() - 1}, {{0, 1, 2, 3}}, {kSmall}, {{2, 4}}));
    EXPECT_EQ(alone.complex.faces.size(), 0U);
    EXPECT_EQ(alone.complex.edges.size(), 1U);
    EXPECT_EQ(alone.statistics.topology, known_topology(1, 0, 0));
}

TEST(Filter, LeavesAPointOfEveryComponent) {
    const MedialComplex two = complex_by_hand({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}, {4, 0, 0}, {3, 1, 0}},
                                              {{0, 1, 2}, {3, 4, 5}}, {kSmall, kSmall});
    const FilteredComplex filtered = filter(two);
    EXPECT_TRUE(filtered.complex.faces.empty());
    EXPECT_TRUE(filtered.complex.edges.empty());
    EXPECT_EQ(filtered.complex.vertices.size(), 2U);
    EXPECT_EQ(filtered.statistics.topology, known_topology(2, 0, 0));
}

TEST(Filter, ComesBackToASheetWhenWhatItHeldHasGone) {
    // The fin on the square bears two more at its far edge. It is the least important, but can only go last.
    const MedialComplex tower = complex_by_hand(
        {{0, 0, 0},
         {0, 1, 0},
         {1, 0, 0},
         {1, 1, 0},
         {-1, 0, 0},
         {-1, 1, 0},
         {0, 0, 1},
         {0, 1, 1},
         {1, 0, 2},
         {1, 1, 2},
         {-1, 0, 2},
         {-1, 1, 2}},
        {{0, 2, 3, 1}, {0, 1, 5, 4}, {0, 1, 7, 6}, {6, 7, 9, 8}, {6, 7, 11, 10}}, {kLarge, kLarge, 5.0, 10.0, 20.0});
    EXPECT_EQ(filter(tower).complex.faces.size(), 2U);
    EXPECT_EQ(filter(tower, {.angle = 15.0}).complex.faces.size(), 4U) << "the last wing holds the fin";
}

// The axes of solids.

struct Named {
    std::string name;
    MedialComplex complex;
};

MedialComplex axis_of(const Solid& solid, double tolerance, double scale) {
    const Samples samples = sample(solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
    return medial_axis(scaled(inner_balls(samples), scale)).complex;
}

std::vector<Named> axes() {
    std::vector<Named> result;
    for (const double scale : {1.0, 1.1, 1.4}) {
        const std::string at = " at s = " + std::to_string(scale);
        result.push_back({"box" + at, axis_of(box_solid({1.0, 0.7, 0.4}), 0.1, scale)});
        result.push_back({"torus" + at, axis_of(torus_solid(1.0, 0.35), 0.12, scale)});
        result.push_back({"shell" + at, axis_of(shell_solid(1.0, 0.6), 0.15, scale)});
        result.push_back({"ellipsoid" + at, axis_of(ellipsoid_solid(1.0, 0.6, 0.35), 0.08, scale)});
        result.push_back({"dumbbell" + at, axis_of(dumbbell_solid(0.5, 1.0, 0.2), 0.1, scale)});
    }
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        const std::string with = " balls with seed " + std::to_string(seed);
        result.push_back({"scattered" + with, medial_axis(scattered_balls(random, 100, 1.5, 0.2, 0.5)).complex});
        result.push_back({"through" + with, medial_axis(balls_through_points(random, 200, 40)).complex});
        result.push_back({"hollow" + with, medial_axis(balls_around_a_void(random, 80, 0.5)).complex});
    }
    return result;
}

// A face by its contacts, of which no other has the same.
std::set<std::array<Index, 2>> face_names(const MedialComplex& complex) {
    return {complex.face_contacts.begin(), complex.face_contacts.end()};
}

TEST(Filter, KeepsTheHomotopyTypeAndIsNested) {
    for (const auto& [name, complex] : axes()) {
        SCOPED_TRACE(name);
        const Topology truth = homology(complex);
        std::set<std::array<Index, 2>> before = face_names(complex);
        ASSERT_EQ(before.size(), complex.faces.size());
        std::vector<double> importance(complex.sheets);
        for (std::size_t f = 0; f < complex.faces.size(); ++f) {
            importance[complex.face_sheets[f]] = std::max(importance[complex.face_sheets[f]], complex.face_angles[f]);
        }
        for (const double angle : {0.0, 5.0, 15.0, 30.0, 45.0, 60.0, 90.0}) {
            const FilteredComplex filtered = filter(complex, {.angle = angle});
            expect_well_formed(filtered.complex);
            if (HasFatalFailure()) {
                return;
            }
            EXPECT_EQ(homology(filtered.complex), truth) << angle;
            EXPECT_EQ(filtered.statistics.topology, truth) << angle;
            EXPECT_EQ(filtered.statistics.sheets_before, complex.sheets);
            EXPECT_EQ(filtered.statistics.sheets_after, filtered.complex.sheets);
            EXPECT_EQ(filtered.statistics.faces_removed,
                      static_cast<Index>(complex.faces.size() - filtered.complex.faces.size()));

            const std::set<std::array<Index, 2>> now = face_names(filtered.complex);
            EXPECT_TRUE(std::includes(before.begin(), before.end(), now.begin(), now.end())) << angle;
            before = now;

            // Sheets go as a whole, and only unimportant ones.
            std::vector<Index> kept(complex.sheets);
            std::vector<Index> all(complex.sheets);
            for (std::size_t f = 0; f < complex.faces.size(); ++f) {
                ++all[complex.face_sheets[f]];
                kept[complex.face_sheets[f]] += now.contains(complex.face_contacts[f]) ? 1 : 0;
            }
            for (Index sheet = 0; sheet < complex.sheets; ++sheet) {
                EXPECT_TRUE(kept[sheet] == all[sheet] || (kept[sheet] == 0 && importance[sheet] < angle))
                    << "sheet " << sheet << " at " << angle;
            }
        }
        EXPECT_TRUE(same_bytes(filter(complex, {.angle = 0.0}).complex, complex));
    }
}

TEST(Filter, KeepsBallsThatAreLargerThanAllAround) {
    std::vector<Named> complexes = axes();
    // A ball at the end of a rod, twice but for noise: from the rod a sliver leads to it.
    const std::vector<Ball> rod{{{0, 0, 0}, 0.33},    {{0.0021, 0.00187, 0.00109}, 0.32882},
                                {{0.30, 0, 0}, 0.12}, {{0.36, 0, 0}, 0.12},
                                {{0.42, 0, 0}, 0.12}, {{0.48, 0, 0}, 0.12}};
    complexes.push_back({"rod", medial_axis(rod).complex});
    for (const auto& [name, complex] : complexes) {
        SCOPED_TRACE(name);
        std::vector<bool> is_largest(complex.vertices.size(), true);
        for (const auto& [p, q] : complex.edges) {
            is_largest[p] = is_largest[p] && complex.radii[p] > complex.radii[q];
            is_largest[q] = is_largest[q] && complex.radii[q] > complex.radii[p];
        }
        const MedialComplex filtered = filter(complex).complex;
        for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
            EXPECT_TRUE(!is_largest[v] ||
                        std::ranges::find(filtered.vertices, complex.vertices[v]) != filtered.vertices.end())
                << complex.radii[v];
        }
    }
}

TEST(Filter, HasNothingToDoASecondTime) {
    for (const auto& [name, complex] : axes()) {
        const MedialComplex filtered = filter(complex).complex;
        ASSERT_LT(filtered.faces.size(), complex.faces.size()) << name;
        EXPECT_EQ(filter(filtered).statistics.faces_removed, 0) << name;
    }
}

TEST(Filter, DoesNotDependOnThreads) {
    const MedialComplex complex = axis_of(ellipsoid_solid(1.0, 0.6, 0.35), 0.05, 1.1);
    const MedialComplex filtered = filter(complex, {}, {.threads = 1}).complex;
    for (const int threads : {1, 2, 4}) {
        EXPECT_TRUE(same_bytes(filter(complex, {}, {.threads = threads}).complex, filtered)) << threads;
    }
}

TEST(Filter, RejectsAnglesOutOfRange) {
    const MedialComplex complex = complex_by_hand({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    for (const double angle : {-1.0, 90.1, std::nan("")}) {
        EXPECT_THROW(filter(complex, {.angle = angle}), InvalidOption) << angle;
    }
    EXPECT_THROW(filter(complex, {}, {.progress = [](std::string_view, double) { return false; }}), Cancelled);
}

TEST(Filter, TakesAnEmptyComplex) {
    const FilteredComplex filtered = filter({});
    EXPECT_TRUE(filtered.complex.vertices.empty());
    EXPECT_EQ(filtered.statistics.topology.components, 0);
}

}  // namespace
}  // namespace scaleaxis
