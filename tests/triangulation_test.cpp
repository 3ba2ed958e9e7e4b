// SPDX-License-Identifier: Apache-2.0
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "delaunay/tetrahedron.hpp"
#include "delaunay/triangulation.hpp"
#include "point_sets.hpp"
#include "scaleaxis/delaunay.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/exact/predicates.hpp"
#include "spatial/spatial_order.hpp"

namespace scaleaxis {
namespace {

using Weights = std::vector<double>;
using Ids = std::array<Index, 4>;

/// A name, points and weights (none: Delaunay).
struct Case {
    std::string name;
    Points points;
    Weights weights;
};

Weights random_weights(std::size_t count, double largest, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(0, largest);
    Weights weights(count);
    for (double& w : weights) {
        w = uniform(random);
    }
    return weights;
}

/// Small sets, most of them degenerate.
std::vector<Case> small_cases() {
    std::mt19937_64 random = seeded(7);
    std::vector<Case> cases;
    const auto add = [&](const std::string& name, const Points& points) {
        cases.push_back({name, points, {}});
        cases.push_back({name + ", weighted", points, random_weights(points.size(), 0.5, random)});
        Weights equal(points.size(), 0.25);
        cases.push_back({name + ", equal weights", points, equal});
        Weights few(points.size());
        for (double& w : few) {
            w = static_cast<double>(random() % 3);
        }
        cases.push_back({name + ", integer weights", points, few});
    };
    const Points cube = in_cube(200, random);
    add("nothing", {});
    for (std::size_t n = 1; n <= 5; ++n) {
        add(std::to_string(n) + " points", Points(cube.begin(), cube.begin() + n));
    }
    add("five equal points", Points(5, {1, 2, 3}));
    add("a point twice", {cube[0], cube[0]});
    add("cube", cube);
    add("grid with duplicates", on_grid(150, 4, random));
    add("full grid", on_grid(200, 6, random));
    add("integer sphere", on_integer_sphere());
    add("rounded sphere", on_unit_sphere(120, random));
    Points collinear, coplanar, cocircular, lifted_plane;
    for (int i = 0; i < 40; ++i) {
        collinear.push_back(static_cast<double>((i * 17) % 40) * Point{1, 2, -1});
        const Point p = cube[static_cast<std::size_t>(i)];
        coplanar.push_back({p.x, p.y, 0});
        lifted_plane.push_back({std::round(8 * p.x), std::round(8 * p.y), std::round(8 * p.x) + std::round(8 * p.y)});
        cocircular.push_back({std::cos(0.1 * i), std::sin(0.1 * i), 0.5});
    }
    add("collinear", collinear);
    add("coplanar", coplanar);
    add("coplanar grid", lifted_plane);
    add("cocircular", cocircular);
    Points twice = cube;
    twice.insert(twice.end(), cube.begin(), cube.begin() + 100);
    add("duplicates", twice);
    add("tiny", transformed(on_grid(100, 5, random), 1e-9, {}));
    add("huge", transformed(on_grid(100, 5, random), 1e9, {}));
    add("tiny and random", transformed(cube, 1e-9, {}));
    add("huge and random", transformed(cube, 1e9, {}));
    add("far away", transformed(cube, 1, {1e6, -1e6, 1e6}));
    add("tiny and far away", transformed(cube, 1e-6, {1e6, 1e6, 1e6}));
    add("one point far away", {{1e9, 1e9, 1e9}});
    return cases;
}

// Sets of cells.

Ids sorted(Ids ids) {
    std::sort(ids.begin(), ids.end());
    return ids;
}

std::set<Ids> cell_set(const Triangulation& t) {
    std::set<Ids> cells;
    for (const auto& [ids, neighbors] : t.cells) {
        cells.insert(sorted(ids));
    }
    return cells;
}

bool operator==(const Triangulation& a, const Triangulation& b) {
    return a.cells == b.cells && a.points == b.points && a.ghosts == b.ghosts;
}

double weight_of(const Weights& weights, Index id) { return id < 0 ? 0.0 : weights[static_cast<std::size_t>(id)]; }

int conflict_sign(const Triangulation& t, const Weights& weights, const Ids& v, Index e) {
    const auto point = [&](Index id) { return t.point(id); };
    if (weights.empty()) {
        return in_sphere(point(v[0]), point(v[1]), point(v[2]), point(v[3]), point(e));
    }
    return in_power_sphere(point(v[0]), weight_of(weights, v[0]), point(v[1]), weight_of(weights, v[1]), point(v[2]),
                           weight_of(weights, v[2]), point(v[3]), weight_of(weights, v[3]), point(e),
                           weight_of(weights, e));
}

/// Positive orientation, symmetric adjacency, order of cells: everything that the arrays promise.
void expect_well_formed(const Triangulation& t) {
    std::size_t hull_faces = 0;
    Ids last{-5, -5, -5, -5};
    for (std::size_t c = 0; c < t.size(); ++c) {
        const Ids& v = t.cells[c].vertices;
        ASSERT_EQ(orientation(t.point(v[0]), t.point(v[1]), t.point(v[2]), t.point(v[3])), 1) << "cell " << c;
        ASSERT_TRUE(v[0] < v[1] && v[1] < v[2] && v[1] < v[3]) << "cell " << c;
        ASSERT_LT(last, sorted(v)) << "cell " << c;
        last = sorted(v);
        for (std::size_t k = 0; k < 4; ++k) {
            const Index n = t.cells[c].neighbors[k];
            if (n == kNone) {
                ++hull_faces;
                continue;
            }
            const Ids& back = t.cells[n].neighbors;
            const auto twin = std::find(back.begin(), back.end(), static_cast<Index>(c)) - back.begin();
            ASSERT_LT(twin, 4) << "cell " << c << " neighbor " << n;
            std::set<Index> face(v.begin(), v.end());
            face.erase(v[k]);
            std::set<Index> twin_face(t.cells[n].vertices.begin(), t.cells[n].vertices.end());
            twin_face.erase(t.cells[n].vertices[twin]);
            ASSERT_EQ(face, twin_face) << "cell " << c << " neighbor " << n;
        }
    }
    EXPECT_EQ(hull_faces, 4U);
}

/// No point within the sphere of any cell, by brute force. The cells fill the tetrahedron of the ghosts if the arrays
/// are well formed, so this makes them a Delaunay (regular) triangulation.
void expect_empty_spheres(const Triangulation& t, const Weights& weights) {
    for (const auto& [v, neighbors] : t.cells) {
        for (Index e = -4; e < static_cast<Index>(t.points.size()); ++e) {
            if (std::find(v.begin(), v.end(), e) == v.end()) {
                ASSERT_LE(conflict_sign(t, weights, v, e), 0) << "point " << e;
            }
        }
    }
}

Box box_of(const Points& points, const Weights& weights = {}) {
    Box box;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double r = weights.empty() ? 0 : std::sqrt(weights[i]);
        box.extend(points[i] - Point{r, r, r});
        box.extend(points[i] + Point{r, r, r});
    }
    return box;
}

// Order of insertion.

TEST(SpatialOrder, HoldsEveryPointOnceInGrowingRounds) {
    std::mt19937_64 random = seeded(3);
    for (const std::size_t count : {0, 1, 499, 5000, 100000}) {
        const InsertionOrder order = insertion_order(in_cube(count, random));
        std::vector<Index> ids = order.points;
        std::sort(ids.begin(), ids.end());
        std::vector<Index> all(count);
        std::iota(all.begin(), all.end(), 0);
        EXPECT_EQ(ids, all);
        ASSERT_EQ(order.rounds.back(), count);
        for (std::size_t r = 1; r < order.rounds.size(); ++r) {
            EXPECT_GT(order.rounds[r], 4 * order.rounds[r - 1]);
        }
    }
}

TEST(SpatialOrder, ConsecutivePointsOfACompleteGridAreNeighbors) {
    Points grid;
    for (int i = 0; i < 16 * 16 * 16; ++i) {
        grid.push_back({1.0 * (i % 16), 1.0 * (i / 16 % 16), 1.0 * (i / 256)});
    }
    const std::vector<Index> order = hilbert_order(grid);
    for (std::size_t i = 1; i < order.size(); ++i) {
        EXPECT_EQ(distance(grid[order[i - 1]], grid[order[i]]), 1.0);
    }
}

// Triangulations.

TEST(Triangulation, OfNothingIsTheGhosts) {
    const Triangulation t = triangulate({});
    ASSERT_EQ(t.size(), 1U);
    EXPECT_EQ(sorted(t.cells[0].vertices), (Ids{-4, -3, -2, -1}));
    EXPECT_EQ(t.cells[0].neighbors, (Ids{kNone, kNone, kNone, kNone}));
}

TEST(Triangulation, GhostsKeepTheirDistance) {
    const Points points{{1, 2, 3}, {3, 5, 9}};
    const Triangulation t = triangulate(points);
    const Point center = midpoint(points[0], points[1]);
    const double diagonal = distance(points[0], points[1]);
    for (const Ids& v : {Ids{-1, -2, -3, -4}, Ids{-1, -2, -4, -3}, Ids{-1, -3, -4, -2}, Ids{-2, -3, -4, -1}}) {
        const Point normal = cross(t.point(v[1]) - t.point(v[0]), t.point(v[2]) - t.point(v[0]));
        EXPECT_GT(std::abs(dot(normal, center - t.point(v[0]))) / norm(normal), 3 * diagonal);
    }
}

TEST(Triangulation, SmallCasesAreRegularWellFormedAndIndependentOfBatches) {
    for (const Case& c : small_cases()) {
        SCOPED_TRACE(c.name);
        const Triangulation t = triangulate(c.points, c.weights);
        expect_well_formed(t);
        expect_empty_spheres(t, c.weights);

        // One by one, and in batches.
        for (const std::size_t batch : {1U, 7U, 60U}) {
            TriangulationBuilder builder(box_of(c.points, c.weights), !c.weights.empty());
            for (std::size_t i = 0; i < c.points.size(); i += batch) {
                const std::size_t n = std::min(batch, c.points.size() - i);
                builder.insert(std::span(c.points).subspan(i, n),
                               c.weights.empty() ? std::span<const double>() : std::span(c.weights).subspan(i, n));
            }
            EXPECT_TRUE(builder.finish() == t) << "batches of " << batch;
        }
    }
}

TEST(Triangulation, OfPointsAtOnePlaceKeepsTheHeaviestThenTheFirst) {
    const Points points{{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}};
    const auto vertices_of = [](const Triangulation& t) {
        std::set<Index> vertices;
        for (const auto& [v, neighbors] : t.cells) {
            vertices.insert(v.begin(), v.end());
        }
        return vertices;
    };
    EXPECT_EQ(vertices_of(triangulate(points)), (std::set<Index>{-4, -3, -2, -1, 0, 1}));
    EXPECT_EQ(vertices_of(triangulate(points, Weights{1, 1, 3, 2, 3})), (std::set<Index>{-4, -3, -2, -1, 2, 3}));
}

TEST(Triangulation, HidesBallsThatOthersMakeRedundant) {
    // The small ball at the origin lies within the power cell of nobody once the two large ones are there.
    const Points points{{0, 0, 0}, {0.1, 0, 0}, {-0.1, 0, 0}, {5, 5, 5}};
    const Weights weights{0.01, 1, 1, 0.1};
    const Triangulation t = triangulate(points, weights);
    std::set<Index> vertices;
    for (const auto& [v, neighbors] : t.cells) {
        vertices.insert(v.begin(), v.end());
    }
    EXPECT_EQ(vertices, (std::set<Index>{-4, -3, -2, -1, 1, 2, 3}));
}

// Against CGAL: the cells of the one that have no ghost, and of the other that are finite, whose circumcenter lies in
// the box of the points.

template <class Cgal>
std::set<Ids> finite_cells(const Cgal& t) {
    std::set<Ids> cells;
    for (const auto& cell : t.finite_cell_handles()) {
        Ids ids;
        for (int k = 0; k < 4; ++k) {
            ids[k] = cell->vertex(k)->info();
        }
        cells.insert(sorted(ids));
    }
    return cells;
}

using Inexact = CGAL::Exact_predicates_inexact_constructions_kernel;

Inexact::Weighted_point_3 weighted(const Points& points, const Weights& weights, Index id) {
    const Point& p = points[static_cast<std::size_t>(id)];
    return {{p.x, p.y, p.z}, weights.empty() ? 0.0 : weight_of(weights, id)};
}

std::set<Ids> cgal_cells(const Points& points, const Weights& weights) {
    if (weights.empty()) {
        using Vertex = CGAL::Triangulation_vertex_base_with_info_3<Index, Inexact>;
        using Structure =
            CGAL::Triangulation_data_structure_3<Vertex, CGAL::Delaunay_triangulation_cell_base_3<Inexact>>;
        std::vector<std::pair<Inexact::Point_3, Index>> input;
        for (const Point& p : points) {
            input.emplace_back(Inexact::Point_3(p.x, p.y, p.z), static_cast<Index>(input.size()));
        }
        return finite_cells(CGAL::Delaunay_triangulation_3<Inexact, Structure>(input.begin(), input.end()));
    }
    using Vertex =
        CGAL::Triangulation_vertex_base_with_info_3<Index, Inexact, CGAL::Regular_triangulation_vertex_base_3<Inexact>>;
    using Structure = CGAL::Triangulation_data_structure_3<Vertex, CGAL::Regular_triangulation_cell_base_3<Inexact>>;
    std::vector<std::pair<Inexact::Weighted_point_3, Index>> input;
    for (Index i = 0; i < static_cast<Index>(points.size()); ++i) {
        input.emplace_back(weighted(points, weights, i), i);
    }
    return finite_cells(CGAL::Regular_triangulation_3<Inexact, Structure>(input.begin(), input.end()));
}

std::set<Ids> centered_in_box(const std::set<Ids>& cells, const Points& points, const Weights& weights) {
    const Box box = box_of(points);
    std::set<Ids> result;
    for (const Ids& v : cells) {
        if (v[0] < 0) {
            continue;
        }
        const auto center = Inexact().construct_weighted_circumcenter_3_object()(
            weighted(points, weights, v[0]), weighted(points, weights, v[1]), weighted(points, weights, v[2]),
            weighted(points, weights, v[3]));
        if (box.min.x < center.x() && center.x() < box.max.x && box.min.y < center.y() && center.y() < box.max.y &&
            box.min.z < center.z() && center.z() < box.max.z) {
            result.insert(v);
        }
    }
    return result;
}

TEST(Triangulation, AgreesWithCgal) {
    std::mt19937_64 random = seeded(13);
    const std::vector<Case> cases{
        {"cube", in_cube(5000, random), {}},
        {"surface", on_bumpy_surface(5000, random), {}},
        {"cube, light", in_cube(3000, random), random_weights(3000, 0.001, random)},
        {"cube, heavy", in_cube(3000, random), random_weights(3000, 0.1, random)},
        {"surface, weighted", on_bumpy_surface(3000, random), random_weights(3000, 0.01, random)},
        {"tiny", transformed(in_cube(500, random), 1e-9, {}), {}},
        {"huge", transformed(in_cube(500, random), 1e9, {}), {}},
        {"far", transformed(in_cube(500, random), 1e-3, {1e6, 1e6, 1e6}), {}},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const Triangulation t = triangulate(c.points, c.weights);
        const std::set<Ids> ours = centered_in_box(cell_set(t), c.points, c.weights);
        EXPECT_GT(ours.size(), c.weights.empty() ? c.points.size() : 100U);
        EXPECT_EQ(ours, centered_in_box(cgal_cells(c.points, c.weights), c.points, c.weights));
    }
}

// The public function: ghosts that lie infinitely far.

/// Empty spheres, positive orientation, symmetric adjacency, and no point beyond a facet of the hull: by brute force.
void expect_fills_the_hull(const Delaunay& d, const Points& points, const Weights& weights) {
    const auto at = [&](Index id) { return points[static_cast<std::size_t>(id)]; };
    const auto weight = [&](Index id) { return weights.empty() ? 0.0 : weight_of(weights, id); };
    for (std::size_t t = 0; t < d.tetrahedra.size(); ++t) {
        const Ids& v = d.tetrahedra[t];
        ASSERT_EQ(orientation(at(v[0]), at(v[1]), at(v[2]), at(v[3])), 1);
        for (int k = 0; k < 4; ++k) {
            const std::array<Index, 3> facet = facet_of_cell(v, k);
            if (const Index n = d.neighbors[t][k]; n != kNone) {
                const int back = position_of(d.neighbors[n], static_cast<Index>(t));
                ASSERT_EQ(d.neighbors[n][back], static_cast<Index>(t));
                std::array<Index, 3> other = facet_of_cell(d.tetrahedra[n], back);
                std::swap(other[1], other[2]);
                ASSERT_EQ(other, facet);
            }
            for (Index e = 0; e < static_cast<Index>(points.size()); ++e) {
                if (d.neighbors[t][k] == kNone) {
                    ASSERT_GE(orientation(at(facet[0]), at(facet[1]), at(facet[2]), at(e)), 0) << "point " << e;
                }
                ASSERT_LE(in_power_sphere(at(v[0]), weight(v[0]), at(v[1]), weight(v[1]), at(v[2]), weight(v[2]),
                                          at(v[3]), weight(v[3]), at(e), weight(e)),
                          0)
                    << "point " << e;
            }
        }
    }
}

/// Are there four points that are not coplanar?
bool is_spatial(const Points& points) {
    for (const Point& p : points) {
        for (const Point& q : points) {
            if (squared_norm(cross(p - points[0], q - points[0])) > 0) {
                return std::ranges::any_of(points,
                                           [&](const Point& r) { return orientation(points[0], p, q, r) != 0; });
            }
        }
    }
    return false;
}

TEST(Delaunay, FillsTheHullOfSmallCases) {
    for (const Case& c : small_cases()) {
        SCOPED_TRACE(c.name);
        const Delaunay d = delaunay(c.points, c.weights);
        EXPECT_EQ(!d.tetrahedra.empty(), is_spatial(c.points));
        expect_fills_the_hull(d, c.points, c.weights);
        const Delaunay alone = delaunay(c.points, c.weights, {.threads = 1});
        EXPECT_EQ(d.tetrahedra, alone.tetrahedra);
        EXPECT_EQ(d.neighbors, alone.neighbors);
    }
}

TEST(Delaunay, AgreesWithCgalUpToTheHull) {
    std::mt19937_64 random = seeded(14);
    Points tilted;  // the sides of a cube, coplanar to rounding: thousands of slivers below each of them
    for (Point p : in_cube(3000, random)) {
        (tilted.size() % 3 == 0 ? p.x : tilted.size() % 3 == 1 ? p.y : p.z) = tilted.size() % 2 == 0 ? 1 : -1;
        tilted.push_back(
            {0.6 * p.x - 0.8 * p.y, 0.48 * p.x + 0.36 * p.y - 0.8 * p.z, 0.64 * p.x + 0.48 * p.y + 0.6 * p.z});
    }
    const std::vector<Case> cases{
        {"cube", in_cube(5000, random), {}},
        {"surface", on_bumpy_surface(5000, random), {}},
        {"sphere", on_unit_sphere(3000, random), {}},
        {"tilted cube", tilted, {}},
        {"tilted cube, weighted", tilted, random_weights(tilted.size(), 0.001, random)},
        {"cube, heavy", in_cube(3000, random), random_weights(3000, 0.1, random)},
        {"tiny", transformed(in_cube(500, random), 1e-40, {}), {}},
        {"huge", transformed(in_cube(500, random), 1e40, {}), {}},
        {"far", transformed(in_cube(500, random), 1e-3, {1e6, 1e6, 1e6}), {}},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const Delaunay d = delaunay(c.points, c.weights);
        std::set<Ids> ours;
        for (const Ids& v : d.tetrahedra) {
            ours.insert(sorted(v));
        }
        EXPECT_TRUE(ours == cgal_cells(c.points, c.weights));
    }
}

TEST(Delaunay, RefusesWhatIsNotFiniteAndWeightsOfAnotherNumber) {
    const Points points{{0, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}};
    EXPECT_THROW(delaunay(points), UnusableInput);
    EXPECT_THROW(delaunay(Points{{1e61, 0, 0}}), UnusableInput);
    EXPECT_THROW(delaunay(Points(2), Weights{1, std::numeric_limits<double>::infinity()}), UnusableInput);
    EXPECT_THROW(delaunay(Points(2), Weights(3)), UnusableInput);
}

// Batches and threads.

TEST(TriangulationBuilder, FreshCellsAreTheNewOnes) {
    std::mt19937_64 random = seeded(17);
    const Points points = in_cube(3000, random);
    const Weights weights = random_weights(points.size(), 0.01, random);
    TriangulationBuilder builder(box_of(points, weights), true);
    std::set<Ids> before;
    for (std::size_t i = 0; i < points.size(); i += 1000) {
        builder.insert(std::span(points).subspan(i, 1000), std::span(weights).subspan(i, 1000));
        std::set<Ids> now, fresh;
        for (Index slot = 0; slot < builder.slots(); ++slot) {
            if (builder.is_cell(slot)) {
                now.insert(sorted(builder.vertices(slot)));
                if (builder.is_fresh(slot)) {
                    fresh.insert(sorted(builder.vertices(slot)));
                }
            }
        }
        std::set<Ids> expected;
        std::set_difference(now.begin(), now.end(), before.begin(), before.end(),
                            std::inserter(expected, expected.end()));
        EXPECT_EQ(fresh, expected);
        EXPECT_LT(fresh.size(), i == 0 ? now.size() + 1 : now.size());
        before = now;
    }
}

TEST(TriangulationBuilder, SlotsMatchTheFinishedCells) {
    std::mt19937_64 random = seeded(19);
    const Points points = on_grid(400, 5, random);
    TriangulationBuilder builder(box_of(points), false);
    builder.insert(points);
    std::vector<Index> slots;
    const Triangulation t = builder.finish(&slots);
    ASSERT_EQ(slots.size(), t.size());
    for (Index ghost = -4; ghost < 0; ++ghost) {
        EXPECT_EQ(t.point(ghost), builder.point(ghost));
    }
    for (std::size_t c = 0; c < t.size(); ++c) {
        ASSERT_TRUE(builder.is_cell(slots[c]));
        EXPECT_EQ(sorted(builder.vertices(slots[c])), sorted(t.cells[c].vertices));
        for (std::size_t k = 0; k < 4; ++k) {
            const Ids v = builder.vertices(slots[c]);
            const auto at = std::find(v.begin(), v.end(), t.cells[c].vertices[k]) - v.begin();
            const Index neighbor = builder.neighbor(slots[c], static_cast<int>(at));
            EXPECT_EQ(neighbor, t.cells[c].neighbors[k] == kNone ? kNone : slots[t.cells[c].neighbors[k]]);
        }
    }
}

TEST(TriangulationBuilder, FreshPartIsThatOfTheWholeAroundTheNewCells) {
    std::mt19937_64 random = seeded(41);
    const Points points = in_cube(1200, random);
    const Weights weights = random_weights(points.size(), 0.01, random);
    TriangulationBuilder builder(box_of(points, weights), true);
    std::size_t begin = 0;
    for (const std::size_t end : {1000U, 1001U, 1001U, 1200U}) {
        builder.insert(std::span(points).subspan(begin, end - begin), std::span(weights).subspan(begin, end - begin));
        begin = end;
        std::vector<std::uint8_t> is_fresh;
        const Triangulation part = builder.finish_fresh(is_fresh);
        std::vector<Index> slots;
        const Triangulation whole = builder.finish(&slots);
        const auto edges_of = [&](std::size_t c) {
            std::set<std::pair<Index, Index>> edges;
            for (const auto& at : kEdgesOfCell) {
                edges.insert(std::minmax(whole.cells[c].vertices[at[0]], whole.cells[c].vertices[at[1]]));
            }
            return edges;
        };
        std::set<std::pair<Index, Index>> fresh_edges;
        for (std::size_t c = 0; c < whole.size(); ++c) {
            if (builder.is_fresh(slots[c])) {
                fresh_edges.merge(edges_of(c));
            }
        }
        std::vector<Index> chosen;
        std::vector<Index> number(whole.size(), kNone);
        for (std::size_t c = 0; c < whole.size(); ++c) {
            if (std::ranges::any_of(edges_of(c), [&](const auto& edge) { return fresh_edges.contains(edge); })) {
                number[c] = static_cast<Index>(chosen.size());
                chosen.push_back(static_cast<Index>(c));
            }
        }
        ASSERT_EQ(part.size(), chosen.size());
        ASSERT_EQ(is_fresh.size(), chosen.size());
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const Tetrahedron& cell = whole.cells[chosen[i]];
            EXPECT_EQ(part.cells[i].vertices, cell.vertices);
            EXPECT_EQ(is_fresh[i] != 0, builder.is_fresh(slots[chosen[i]]));
            for (std::size_t k = 0; k < 4; ++k) {
                EXPECT_EQ(part.cells[i].neighbors[k], cell.neighbors[k] == kNone ? kNone : number[cell.neighbors[k]]);
            }
        }
    }
}

TEST(TriangulationBuilder, ResultDoesNotDependOnThreads) {
    std::mt19937_64 random = seeded(23);
    Points spheres;
    for (const Point& center : on_bumpy_surface(1500, random)) {
        for (const Point& p : on_unit_sphere(8, random)) {
            spheres.push_back(center + 0.1 * p);
        }
    }
    Points sphere_with_center = on_unit_sphere(5000, random);
    sphere_with_center.push_back({0, 0, 0});
    // Every point of the one line makes a cell with every edge of the other: far more cells than there is room for.
    Points skew_lines;
    for (int i = 0; i < 1100; ++i) {
        skew_lines.push_back({0.001 * i, 0, 0});
        skew_lines.push_back({0, 0.001 * i, 1});
    }
    const std::vector<Case> cases{
        {"surface", on_bumpy_surface(15000, random), {}},
        {"cospherical", spheres, {}},
        {"grid", on_grid(10000, 25, random), {}},
        {"sphere with center", sphere_with_center, {}},
        {"skew lines", skew_lines, {}},
        {"weighted", in_cube(15000, random), random_weights(15000, 0.002, random)},
    };
    // As many threads as asked for, even where there are fewer processors.
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 4);
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const auto with_threads = [&](int threads) {
            tbb::task_arena arena(threads);
            return arena.execute([&] { return triangulate(c.points, c.weights); });
        };
        const Triangulation one = with_threads(1);
        if (one.size() < 300000) {
            expect_well_formed(one);
        }
        for (const int threads : {2, 4, 4}) {
            EXPECT_TRUE(with_threads(threads) == one) << threads << " threads";
        }
    }
}

TEST(TriangulationBuilder, RefusesPointsOutsideItsBox) {
    TriangulationBuilder builder({{0, 0, 0}, {1, 1, 1}}, true);
    const Points outside{{0.5, 0.5, 1.5}}, not_a_number{{0.5, NAN, 0.5}}, inside{{0.5, 0.5, 0.5}};
    const Weights one{1.0}, infinite{INFINITY};
    EXPECT_THROW(builder.insert(outside, one), Error);
    EXPECT_THROW(builder.insert(not_a_number, one), Error);
    EXPECT_THROW(builder.insert(inside, infinite), Error);
    builder.insert(inside, one);
    EXPECT_EQ(builder.finish().size(), 4U);
}

// Location.

TEST(Locate, FindsTheCellFromAnywhere) {
    std::mt19937_64 random = seeded(29);
    for (const Points& points : {in_cube(300, random), on_grid(200, 5, random)}) {
        const Weights weights = random_weights(points.size(), 0.05, random);
        for (const Triangulation& t : {triangulate(points), triangulate(points, weights)}) {
            Points queries = in_cube(100, random);
            queries.insert(queries.end(), points.begin(), points.begin() + 50);
            queries.push_back(t.ghosts[2]);
            for (const Point& q : queries) {
                const Index hint = static_cast<Index>(random() % t.size());
                const Index cell = locate(t, q, hint);
                ASSERT_NE(cell, kNone);
                for (std::size_t k = 0; k < 4; ++k) {
                    std::array<Point, 4> corners;
                    for (std::size_t i = 0; i < 4; ++i) {
                        corners[i] = i == k ? q : t.point(t.cells[cell].vertices[i]);
                    }
                    ASSERT_GE(orientation(corners[0], corners[1], corners[2], corners[3]), 0);
                }
                EXPECT_EQ(locate(t, q, hint), cell);
            }
            EXPECT_EQ(locate(t, 3 * t.ghosts[0], 0), kNone);
            EXPECT_EQ(locate(t, {NAN, 0, 0}, 0), kNone);
            EXPECT_EQ(locate(t, {INFINITY, 0, 0}, 0), kNone);
        }
    }
}

}  // namespace
}  // namespace scaleaxis
