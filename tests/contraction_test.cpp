// SPDX-License-Identifier: Apache-2.0
// Edits that keep the homotopy type, against brute force: contraction of edges, elementary collapses.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "axis/edit/remainder.hpp"
#include "axis/edit/slivers.hpp"
#include "complexes.hpp"
#include "homology.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

/// Each face has its own angle and contacts, each vertex its own radius, not the mean of two others,
/// so that what comes out can be told apart.
MedialComplex with_marks(MedialComplex complex) {
    const auto faces = static_cast<Index>(complex.faces.size());
    complex.boundary_vertices.resize(faces + 1);
    complex.boundary_vertex_balls.resize(faces + 1);
    for (Index f = 0; f < faces; ++f) {
        complex.face_angles[f] = 1.0 + 80.0 * f / faces;
        complex.face_contacts[f] = {f, f + 1};
    }
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        complex.radii[v] = 10.0 + std::sin(static_cast<double>(v));
    }
    return complex;
}

/// Random triangles and edges between a few vertices.
MedialComplex random_simplices(Random& random) {
    constexpr Index kVertices = 9;
    std::vector<Point> vertices;
    for (Index v = 0; v < kVertices; ++v) {
        vertices.push_back(random_point(random, 1.0));
    }
    const double part = uniform(random, 0.05, 0.5);
    std::vector<std::vector<Index>> triangles;
    std::vector<std::array<Index, 2>> edges;
    for (Index a = 0; a < kVertices; ++a) {
        for (Index b = a + 1; b < kVertices; ++b) {
            if (uniform(random, 0.0, 1.0) < 0.1) {
                edges.push_back({a, b});
            }
            for (Index c = b + 1; c < kVertices; ++c) {
                if (uniform(random, 0.0, 1.0) < part) {
                    triangles.push_back({a, b, c});
                }
            }
        }
    }
    return with_marks(complex_by_hand(vertices, triangles, {}, edges));
}

/// Random squares of a grid of cubes, with sides of 1 or, in thin layers, of 0.01.
MedialComplex random_squares(Random& random) {
    constexpr Index kSide = 4;  // vertices
    std::array<std::array<double, kSide>, 3> at{};
    for (auto& coordinates : at) {
        for (Index k = 1; k < kSide; ++k) {
            coordinates[k] = coordinates[k - 1] + (uniform(random, 0.0, 1.0) < 0.3 ? 0.01 : 1.0);
        }
    }
    constexpr std::array<Index, 3> kStride{kSide * kSide, kSide, 1};
    std::vector<Point> vertices;
    std::vector<std::vector<Index>> faces;
    std::vector<std::array<Index, 2>> edges;
    const double part = uniform(random, 0.2, 0.9);
    for (Index v = 0; v < kSide * kStride[0]; ++v) {
        const std::array<Index, 3> place{v / kStride[0], v / kSide % kSide, v % kSide};
        vertices.push_back({at[0][place[0]], at[1][place[1]], at[2][place[2]]});
        for (int axis = 0; axis < 3; ++axis) {
            const int next = (axis + 1) % 3;
            if (place[axis] + 1 == kSide) {
                continue;
            }
            if (uniform(random, 0.0, 1.0) < 0.1) {
                edges.push_back({v, v + kStride[axis]});
            }
            if (place[next] + 1 < kSide && uniform(random, 0.0, 1.0) < part) {
                faces.push_back({v, v + kStride[axis], v + kStride[axis] + kStride[next], v + kStride[next]});
            }
        }
    }
    return with_marks(complex_by_hand(vertices, faces, {}, edges));
}

using Simplices = std::set<std::vector<Index>>;

/// The edges and faces of a complex of triangles with `q` in the place of `p`, where they still have 2 and 3 vertices.
std::pair<Simplices, Simplices> contracted(const MedialComplex& complex, Index p, Index q) {
    const auto after = [&](auto simplices, std::size_t size) {
        Simplices result;
        for (std::size_t i = 0; i < simplices.size(); ++i) {
            std::set<Index> vertices(simplices[i].begin(), simplices[i].end());
            if (vertices.erase(p) != 0) {
                vertices.insert(q);
            }
            if (vertices.size() == size) {
                result.emplace(vertices.begin(), vertices.end());
            }
        }
        return result;
    };
    return {after(complex.edges, 2), after(complex.faces, 3)};
}

std::size_t edges_without_face(const Simplices& edges, const Simplices& faces) {
    return static_cast<std::size_t>(std::ranges::count_if(edges, [&](const std::vector<Index>& edge) {
        return std::ranges::none_of(faces,
                                    [&](const std::vector<Index>& face) { return std::ranges::includes(face, edge); });
    }));
}

/// Does nothing become one with something else when an edge is contracted, but for the sides of its triangles?
bool may_be_contracted(const MedialComplex& complex, Index e) {
    const auto [p, q] = complex.edges[e];
    const auto triangles = static_cast<std::size_t>(std::ranges::count(complex.face_edges.items, e));
    const auto [edges, faces] = contracted(complex, p, q);
    return triangles > 0 && faces.size() + triangles == complex.faces.size() &&
           edges.size() + triangles + 1 == complex.edges.size() &&
           edges_without_face(edges, faces) == curve_edges(complex).size();
}

/// Faces are in their order, each with what it had; vertices away from slivers are where they were, in their order.
void expect_attributes_and_order_kept(const MedialComplex& before, const MedialComplex& after, double tolerance) {
    Index face = 0;
    for (std::size_t f = 0; f < after.faces.size(); ++f) {
        ASSERT_GE(after.face_contacts[f][0], face);
        face = after.face_contacts[f][0];
        ASSERT_EQ(after.face_contacts[f][1], face + 1);
        ASSERT_EQ(after.face_angles[f], before.face_angles[face]);
    }
    std::vector<double> areas(before.sheets);
    std::vector<std::uint8_t> may_move(before.vertices.size());
    for (Index f = 0; f < static_cast<Index>(before.faces.size()); ++f) {
        areas[before.face_sheets[f]] += face_area(before, f);
    }
    for (Index f = 0; f < static_cast<Index>(before.faces.size()); ++f) {
        // A sheet with a whole square is no sliver.
        if (areas[before.face_sheets[f]] < 1.0 || tolerance > 1.0) {
            std::ranges::for_each(before.faces[f], [&](Index v) { may_move[v] = 1; });
        }
    }
    // What is as short beside slivers may stand in their way.
    const std::vector<std::uint8_t> is_at_sliver = may_move;
    for (Index f = 0; f < static_cast<Index>(before.faces.size()); ++f) {
        if (std::ranges::any_of(before.faces[f], [&](Index v) { return is_at_sliver[v] != 0; })) {
            std::ranges::for_each(before.faces[f], [&](Index v) { may_move[v] = 1; });
        }
    }
    std::size_t next = 0;
    for (std::size_t v = 0; v < before.vertices.size(); ++v) {
        if (may_move[v] == 0) {
            while (next < after.vertices.size() && after.radii[next] != before.radii[v]) {
                ++next;
            }
            ASSERT_LT(next, after.vertices.size()) << "vertex " << v << " is gone, or out of order";
            ASSERT_EQ(after.vertices[next], before.vertices[v]);
        }
    }
}

TEST(Contraction, KeepsTheHomotopyTypeAttributesAndOrder) {
    std::size_t gone = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const MedialComplex complex = random_squares(random);
        constexpr double kTolerance = 0.1;  // between the sides of thin layers and the others
        const MedialComplex result = without_slivers(complex, kTolerance);
        ASSERT_NO_FATAL_FAILURE(expect_well_formed(result));
        ASSERT_EQ(homology(result), homology(complex));
        ASSERT_NO_FATAL_FAILURE(expect_attributes_and_order_kept(complex, result, kTolerance));
        gone += complex.vertices.size() - result.vertices.size();
        ASSERT_TRUE(same_bytes(without_slivers(complex, 1e-3), complex)) << "nothing is as narrow";
    }
    EXPECT_GT(gone, 0);
}

TEST(Contraction, GoesOnUntilNoEdgeIsLeftThatMayBeContracted) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const MedialComplex complex = random_simplices(random);
        constexpr double kTolerance = 10.0;  // wider than all
        MedialComplex result = without_slivers(complex, kTolerance);
        ASSERT_EQ(homology(result), homology(complex));
        ASSERT_NO_FATAL_FAILURE(expect_well_formed(result));
        ASSERT_NO_FATAL_FAILURE(expect_attributes_and_order_kept(complex, result, kTolerance));
        // Contractions of one sheet may allow others.
        for (std::size_t vertices = 0; vertices != result.vertices.size();) {
            vertices = result.vertices.size();
            result = without_slivers(result, kTolerance);
        }
        ASSERT_EQ(homology(result), homology(complex));
        for (Index e = 0; e < static_cast<Index>(result.edges.size()); ++e) {
            ASSERT_FALSE(may_be_contracted(result, e)) << "edge " << e;
        }
    }
}

TEST(Contraction, DrawsANarrowSheetBetweenTwoSeamsTogether) {
    // H: the bar in the middle is narrow.
    std::vector<Point> vertices;
    for (const double y : {0.0, 1.0, 2.0}) {
        vertices.insert(
            vertices.end(),
            {{0.0, y, -1.0}, {0.0, y, 0.0}, {0.0, y, 1.0}, {0.01, y, -1.0}, {0.01, y, 0.0}, {0.01, y, 1.0}});
    }
    std::vector<std::vector<Index>> faces;
    for (const Index row : {0, 6}) {
        for (const auto& [p, q] :
             {std::pair(0, 1), std::pair(1, 2), std::pair(3, 4), std::pair(4, 5), std::pair(1, 4)}) {
            faces.push_back({row + p, row + q, row + q + 6, row + p + 6});
        }
    }
    const MedialComplex complex = complex_by_hand(vertices, faces);
    ASSERT_EQ(complex.sheets, 5);
    const MedialComplex result = without_slivers(complex, 0.1);
    EXPECT_EQ(result.sheets, 4);
    EXPECT_EQ(result.vertices.size(), 15);
    for (const Point& p : result.vertices) {
        EXPECT_EQ(p.x, p.z != 0.0 ? std::round(100.0 * p.x) / 100.0 : 0.0) << "in the first of both seams";
    }
}

TEST(Contraction, CutsAFlatTriangleBetweenThreeSeamsWhoseSidesAreTooLong) {
    // Two more triangles at each of its sides, of sheets of their own.
    std::vector<Point> vertices{{0, 0, 0}, {3, 0, 0}, {1.4, 1e-4, 0}};
    std::vector<std::vector<Index>> faces{{0, 1, 2}};
    for (const auto& [p, q] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0)}) {
        for (const double z : {-1.0, 1.0}) {
            vertices.push_back(midpoint(vertices[p], vertices[q]) + Point{0, p == 0 ? -1.0 : 1.0, z});
            faces.push_back({p, q, static_cast<Index>(vertices.size()) - 1});
        }
    }
    const MedialComplex complex = with_marks(complex_by_hand(vertices, faces));
    ASSERT_EQ(complex.sheets, 7);
    const MedialComplex result = without_slivers(complex, 0.1);
    ASSERT_NO_FATAL_FAILURE(expect_well_formed(result));
    EXPECT_EQ(homology(result), homology(complex));
    EXPECT_EQ(result.sheets, 6);
    EXPECT_EQ(result.vertices.size(), vertices.size());
}

TEST(Contraction, CutsAFlatTriangleWhoseSidesHaveANeighborInCommon) {
    // Faces at the long side and at one of the others meet in a vertex beside the triangle.
    const MedialComplex complex = with_marks(complex_by_hand(
        {{0, 0, 0}, {3, 0, 0}, {1.4, 1e-4, 0}, {1, 0, 1}, {1.5, -1, -1}, {2, 1, 1}, {2, 1, -1}, {0.7, 1, -1}},
        {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {0, 1, 4}, {1, 2, 5}, {1, 2, 6}, {0, 2, 7}}));
    ASSERT_EQ(complex.sheets, 6);
    const MedialComplex result = without_slivers(complex, 0.1);
    ASSERT_NO_FATAL_FAILURE(expect_well_formed(result));
    EXPECT_EQ(homology(result), homology(complex));
    EXPECT_EQ(result.sheets, 5);
}

TEST(Contraction, DrawsCrumbsTogetherHoweverSmallTheirBalls) {
    // As wide as half a tolerance, between three seams, each with two more sheets.
    std::vector<Point> vertices{{0, 0, 0}, {0.05, 0, 0}, {0.02, 0.05, 0}};
    std::vector<std::vector<Index>> faces{{0, 1, 2}};
    for (const auto& [p, q] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0)}) {
        for (const double z : {-1.0, 1.0}) {
            const auto next = static_cast<Index>(vertices.size());
            const Point side = 20.0 * (vertices[q] - vertices[p]);
            const Point middle = midpoint(vertices[p], vertices[q]);
            const Point out = middle + 40.0 * (middle - Point{0.023, 0.017, 0.0}) + Point{0, 0, z};
            vertices.insert(vertices.end(), {out + side, out - side});
            faces.push_back({p, q, next, next + 1});
        }
    }
    MedialComplex complex = complex_by_hand(vertices, faces);
    ASSERT_EQ(complex.sheets, 7);
    for (const double radius : {1.0, 0.05, 0.0}) {
        SCOPED_TRACE(radius);
        std::ranges::fill(complex.radii, radius);
        const MedialComplex result = without_slivers(complex, 0.1);
        ASSERT_NO_FATAL_FAILURE(expect_well_formed(result));
        EXPECT_EQ(homology(result), homology(complex));
        EXPECT_EQ(result.sheets, 6);
    }
}

TEST(Contraction, DrawsACrumbTogetherAllOfWhoseSidesHaveANeighborInCommon) {
    // Each of the sheets goes from one side of the crumb around a corner to the next, and on to a wide part.
    const MedialComplex complex = with_marks(complex_by_hand({{0, 0, 0},
                                                              {0.05, 0, 0},
                                                              {0.02, 0.04, 0},
                                                              {-1, -1, 1},
                                                              {1, 1, 1},
                                                              {1, -1, -1},
                                                              {-1, 2, 1},
                                                              {-1, 3, 1},
                                                              {3, 0, -1}},
                                                             {{0, 1, 2},
                                                              {0, 1, 3},
                                                              {0, 2, 3},
                                                              {0, 2, 4},
                                                              {1, 2, 4},
                                                              {0, 1, 5},
                                                              {1, 2, 5},
                                                              {2, 3, 6},
                                                              {0, 4, 7},
                                                              {2, 5, 8}}));
    ASSERT_EQ(complex.sheets, 4);
    const MedialComplex result = without_slivers(complex, 0.1);
    ASSERT_NO_FATAL_FAILURE(expect_well_formed(result));
    EXPECT_EQ(homology(result), homology(complex));
    EXPECT_EQ(result.sheets, 3);
}

TEST(Contraction, BringsSeamsToTheBorderOfASheetThatIsFoldedAlongThem) {
    // A seam of three sheets, two of which go on around its end up to a vertex of the border.
    const auto star = [](double gap, double fold) {
        const double x = std::cos(fold);
        const double y = std::sin(fold);
        return complex_by_hand({{0, 0, 0}, {0, 0, 1}, {-1, 0, 1}, {x, y, 1}, {x, -y, 1}, {0, 0, 1 + gap}},
                               {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {1, 3, 5}, {1, 4, 5}});
    };
    const MedialComplex complex = star(0.05, 1.05);  // 60 degrees on both sides
    ASSERT_EQ(complex.sheets, 2);
    const MedialComplex result = with_seams_to_borders(complex, 0.1);
    ASSERT_NO_FATAL_FAILURE(expect_well_formed(result));
    EXPECT_EQ(homology(result), homology(complex));
    EXPECT_EQ(result.sheets, 3);
    EXPECT_EQ(with_seams_to_borders(star(0.2, 1.05), 0.1).sheets, 2) << "too far";
    EXPECT_EQ(with_seams_to_borders(star(0.05, 1.4), 0.1).sheets, 2) << "smooth";
    const std::vector<double> reaches(complex.vertices.size(), 0.1);
    EXPECT_EQ(with_seams_to_borders(star(0.05, 1.4), reaches, false).sheets, 2);
    EXPECT_EQ(with_seams_to_borders(star(0.05, 1.4), reaches, true).sheets, 3) << "may be flat";
}

TEST(Contraction, LeavesSeamsWhereTheyAreWhenItDrawsAFlapIn) {
    for (const bool has_flap_first : {false, true}) {
        SCOPED_TRACE(has_flap_first);
        // Rows of four vertices: the end of the flap, the seam, and a sheet on both sides of it.
        const Index end = has_flap_first ? 0 : 3;
        const Index seam = has_flap_first ? 1 : 0;
        std::vector<Point> vertices;
        std::vector<std::vector<Index>> faces;
        for (Index row = 0; row < 3; ++row) {
            std::array<Point, 4> places;
            places[end] = {0.01, 1.0 * row, 0.0};
            places[seam] = {0.0, 1.0 * row, 0.0};
            places[seam + 1] = {0.0, 1.0 * row, 1.0};
            places[seam + 2] = {0.0, 1.0 * row, -1.0};
            vertices.insert(vertices.end(), places.begin(), places.end());
            for (const Index side : {end, seam + 1, seam + 2}) {
                if (row < 2) {
                    faces.push_back({4 * row + seam, 4 * row + side, 4 * row + side + 4, 4 * row + seam + 4});
                }
            }
        }
        const MedialComplex complex = with_marks(complex_by_hand(vertices, faces));
        ASSERT_EQ(complex.sheets, 3);
        const MedialComplex result = without_slivers(complex, 0.1);
        EXPECT_EQ(result.sheets, 1);
        ASSERT_EQ(result.vertices.size(), 9);
        for (std::size_t v = 0; v < 9; ++v) {
            const std::size_t before = v / 3 * 4 + v % 3 + (has_flap_first ? 1 : 0);
            EXPECT_EQ(result.vertices[v], complex.vertices[before]);
            EXPECT_EQ(result.radii[v], complex.radii[before]);
        }
    }
}

TEST(Contraction, OfShortEdgesAtSeamsKeepsTheHomotopyTypeAttributesAndOrder) {
    std::size_t gone = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const MedialComplex complex = seed % 2 == 0 ? random_squares(random) : random_simplices(random);
        constexpr double kPart =
            0.05;  // of radii of about 10: longer than thin layers are wide, shorter than other edges
        const MedialComplex result = without_short_edges_at_seams(complex, kPart);
        ASSERT_NO_FATAL_FAILURE(expect_well_formed(result));
        ASSERT_EQ(homology(result), homology(complex));
        ASSERT_NO_FATAL_FAILURE(expect_attributes_and_order_kept(complex, result, 10.0));
        gone += complex.vertices.size() - result.vertices.size();
    }
    EXPECT_GT(gone, 0);
}

/// All collapses that are possible.
std::set<ElementaryCollapse> possible_collapses(const MedialComplex& complex, const Remainder& remainder) {
    std::set<ElementaryCollapse> result;
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        if (remainder.has_edge[e] == 0) {
            continue;
        }
        std::vector<Index> faces;
        for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
            if (remainder.has_face[f] != 0 && std::ranges::count(complex.face_edges[f], e) != 0) {
                faces.push_back(f);
            }
        }
        if (faces.size() == 1) {
            result.insert({true, faces[0], e});
        }
        for (const Index v : complex.edges[e]) {
            std::size_t edges = 0;
            for (std::size_t other = 0; other < complex.edges.size(); ++other) {
                edges += remainder.has_edge[other] != 0 && std::ranges::count(complex.edges[other], v) != 0 ? 1 : 0;
            }
            if (faces.empty() && edges == 1) {
                result.insert({false, e, v});
            }
        }
    }
    return result;
}

TEST(ElementaryCollapses, GoOnInTheOrderOfKeysUntilNoneIsPossible) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const MedialComplex complex = seed % 2 == 0 ? random_squares(random) : random_simplices(random);
        Remainder remainder(complex);
        // Few keys, so that there are ties; and some that are not to go.
        const auto key_of = [](const ElementaryCollapse& collapse) -> std::optional<int> {
            const int key = (7 * collapse.element + 3 * collapse.free) % 11;
            return key < 10 ? std::optional(key / 2) : std::nullopt;
        };
        const auto first_of = [&](const std::set<ElementaryCollapse>& collapses) {
            std::optional<std::pair<int, ElementaryCollapse>> first;
            for (const ElementaryCollapse& collapse : collapses) {
                if (const std::optional<int> key = key_of(collapse);
                    key && (!first || std::pair(*key, collapse) < *first)) {
                    first = {*key, collapse};
                }
            }
            return first;
        };
        auto expected = first_of(possible_collapses(complex, remainder));
        std::vector<ElementaryCollapse> taken;
        Collapses collapses(complex, remainder, key_of,
                            [&](const ElementaryCollapse& collapse, const std::optional<int>& key) {
                                ASSERT_TRUE(expected);
                                EXPECT_EQ(*expected, std::pair(*key, collapse));
                                expected = first_of(possible_collapses(complex, remainder));
                                taken.push_back(collapse);
                            });
        collapses.add_all();
        collapses.run();
        EXPECT_FALSE(expected) << "one is left";
        const MedialComplex rest = complex_of(remainder, complex);
        expect_consistent(rest);
        EXPECT_EQ(homology(rest), homology(complex));
        for (auto collapse = taken.rbegin(); collapse != taken.rend(); ++collapse) {
            undo(*collapse, complex, remainder);
        }
        EXPECT_TRUE(same_bytes(complex_of(remainder, complex), complex));
        const Remainder whole(complex);
        const auto are_equal = [](const Cofaces& p, const Cofaces& q) {
            return p.count == q.count && p.combined == q.combined;
        };
        EXPECT_TRUE(std::ranges::equal(remainder.faces_at_edge, whole.faces_at_edge, are_equal));
        EXPECT_TRUE(std::ranges::equal(remainder.edges_at_vertex, whole.edges_at_vertex, are_equal));
        ASSERT_FALSE(HasFailure());
    }
}

TEST(ElementaryCollapses, InAnyOrderLeaveNothingThatIsFree) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const MedialComplex complex = seed % 2 == 0 ? random_squares(random) : random_simplices(random);
        Remainder remainder(complex);
        Collapses collapses(
            complex, remainder, [](const ElementaryCollapse&) { return true; }, [](const ElementaryCollapse&, bool) {});
        collapses.add_all();
        collapses.run();
        EXPECT_TRUE(possible_collapses(complex, remainder).empty());
        ASSERT_EQ(homology(complex_of(remainder, complex)), homology(complex));
    }
}

}  // namespace
}  // namespace scaleaxis
