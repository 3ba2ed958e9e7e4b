// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sampling.hpp"

#include <CGAL/Cartesian_converter.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>

#include "complexes.hpp"
#include "meshes.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/field.hpp"
#include "scaleaxis/mesh.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

// An independent Delaunay triangulation, and the Voronoi edges of its facets.

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Delaunay = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>>>;

Delaunay delaunay(const std::vector<Point>& points) {
    std::vector<std::pair<Kernel::Point_3, Index>> named;
    for (std::size_t i = 0; i < points.size(); ++i) {
        named.emplace_back(Kernel::Point_3(points[i].x, points[i].y, points[i].z), static_cast<Index>(i));
    }
    return Delaunay(named.begin(), named.end());
}

Point to_point(const Exact::Point_3& p) {
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}
Point to_point(const Delaunay::Vertex_handle& v) { return {v->point().x(), v->point().y(), v->point().z()}; }
Exact::Point_3 exact(const Delaunay::Vertex_handle& v) {
    return CGAL::Cartesian_converter<Kernel, Exact>()(v->point());
}

// The largest surface Delaunay ball of all restricted facets: of every dual Voronoi edge whose ends lie on different
// sides, the crossing that is farthest from the facet's corners, found by walking along the edge in small steps.
double largest_surface_ball(const Solid& solid, const std::vector<Point>& points, double step) {
    const Delaunay triangulation = delaunay(points);
    const double far = 2.0 * solid.bounds().diagonal();
    std::map<Delaunay::Cell_handle, Point> centers;
    for (auto cell = triangulation.finite_cells_begin(); cell != triangulation.finite_cells_end(); ++cell) {
        centers[cell] = to_point(CGAL::circumcenter(exact(cell->vertex(0)), exact(cell->vertex(1)),
                                                    exact(cell->vertex(2)), exact(cell->vertex(3))));
    }
    const auto is_inside = [&](const Delaunay::Cell_handle& cell) {
        return !triangulation.is_infinite(cell) && solid.inside(centers.at(cell));
    };
    double largest = 0.0;
    for (auto facet = triangulation.finite_facets_begin(); facet != triangulation.finite_facets_end(); ++facet) {
        const auto& [cell, k] = *facet;
        const Delaunay::Cell_handle other = cell->neighbor(k);
        if (is_inside(cell) == is_inside(other)) {
            continue;
        }
        // The edge lies on the line through the facet's circumcentre that is normal to it. No part that is farther away
        // than `far` can meet the solid.
        const std::array<Delaunay::Vertex_handle, 3> corners{cell->vertex((k + 1) & 3), cell->vertex((k + 2) & 3),
                                                             cell->vertex((k + 3) & 3)};
        const Point corner = to_point(corners[0]);
        const Point foot = to_point(CGAL::circumcenter(exact(corners[0]), exact(corners[1]), exact(corners[2])));
        const Point normal = cross(to_point(corners[1]) - corner, to_point(corners[2]) - corner);
        const Point unit = (1.0 / norm(normal)) * normal;
        const auto end_at = [&](const Delaunay::Cell_handle& c, const Delaunay::Cell_handle& opposite) {
            if (!triangulation.is_infinite(c)) {
                return std::clamp(dot(centers.at(c) - foot, unit), -far, far);
            }
            return dot(to_point(opposite->vertex(opposite->index(c))) - corner, unit) > 0.0 ? -far : far;
        };
        const auto [begin, end] = std::minmax({end_at(cell, other), end_at(other, cell)});
        const auto at = [&](double t) { return foot + t * unit; };
        bool was_inside = solid.inside(at(begin));
        double last = begin;
        while (last < end) {
            const double next = std::min(end, last + step);
            const bool is_next_inside = solid.inside(at(next));
            if (is_next_inside != was_inside) {
                double low = last;
                double high = next;
                for (int i = 0; i < 40; ++i) {
                    const double t = 0.5 * (low + high);
                    (solid.inside(at(t)) == was_inside ? low : high) = t;
                }
                largest = std::max(largest, distance(at(low), corner));
            }
            was_inside = is_next_inside;
            last = next;
        }
    }
    return largest;
}

struct Named {
    std::string name;
    std::unique_ptr<Solid> solid;
    double tolerance;
    double area;
};

// Solids that give no seeds, and solids that do.
std::vector<Named> solids() {
    constexpr double kPi = std::numbers::pi;
    std::vector<Named> result;
    const auto add = [&](const std::string& name, ImplicitSolid* oracle, double tolerance, double area) {
        result.push_back({name, std::unique_ptr<Solid>(oracle), tolerance, area});
    };
    add("ball", new ImplicitSolid(ball_solid(1.0)), 0.15, 4.0 * kPi);
    add("torus", new ImplicitSolid(torus_solid(1.0, 0.4)), 0.12, 4.0 * kPi * kPi * 0.4);
    add("ellipsoid", new ImplicitSolid(ellipsoid_solid(1.0, 0.7, 0.4)), 0.1, 6.0);
    add("shell", new ImplicitSolid(shell_solid(1.0, 0.5)), 0.2, 4.0 * kPi * 1.25);
    add("lens", new ImplicitSolid(lens_solid(1.0, 0.5)), 0.1, 2.0 * kPi);
    add("box", new ImplicitSolid(box_solid({1.0, 0.7, 0.4})), 0.15, 8.0 * (0.7 + 0.4 + 0.28));
    add("cylinder", new ImplicitSolid(cylinder_solid(0.5, 1.0)), 0.12, 2.0 * kPi + 0.5 * kPi);
    add("dumbbell", new ImplicitSolid(dumbbell_solid(0.5, 1.0, 0.2)), 0.1, 2.0 * kPi + 0.4 * kPi);
    const auto add_union = [&](const std::string& name, const Balls& balls, double tolerance, double area) {
        result.push_back({name, union_solid(balls), tolerance, area});
    };
    add_union("one ball", chain_of_balls(1, 0.0, 1.0), 0.15, 4.0 * kPi);
    add_union("chain of balls", chain_of_balls(4, 1.0, 0.7), 0.12, 4.0 * kPi * 0.7 * 0.7 + 3.0 * 2.0 * kPi * 0.7);
    const auto add_mesh = [&](const std::string& name, const TriangleMesh& mesh, double tolerance) {
        RepairedMesh repaired = repair(mesh);
        result.push_back({name + " mesh", mesh_solid(repaired.mesh), tolerance, repaired.report.area});
    };
    add_mesh("ball", ball_mesh(1.0, 40), 0.1);
    add_mesh("torus", torus_mesh(1.0, 0.4, 24), 0.1);
    add_mesh("box", box_mesh({-1.0, -0.7, -0.4}, {1.0, 0.7, 0.4}, 3), 0.1);
    add_mesh("cylinder", cylinder_mesh(0.5, 1.0, 30), 0.1);
    add_mesh("dumbbell", dumbbell_mesh(0.5, 1.0, 0.2, 30), 0.08);
    add_mesh("shell", together(ball_mesh(1.0, 30), turned_inside_out(ball_mesh(0.5, 24))), 0.15);
    return result;
}

TEST(Sampling, BoundsEverySurfaceDelaunayBall) {
    for (const auto& [name, solid, tolerance, area] : solids()) {
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
            const Samples samples = sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform, .seed = seed});
            EXPECT_EQ(samples.tolerance, tolerance);
            const double largest = largest_surface_ball(*solid, samples.points, 0.1 * tolerance);
            EXPECT_LE(largest, tolerance * (1.0 + 1e-9)) << name << ", seed " << seed;
            EXPECT_GE(largest, 0.8 * tolerance) << name << " is sampled more densely than it needs";
        }
    }
}

TEST(Sampling, LabelsEveryTetrahedronByItsCircumcentre) {
    for (const auto& [name, solid, tolerance, area] : solids()) {
        const Samples s = sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
        const Box box = solid->bounds();
        for (std::size_t t = 0; t < s.tetrahedra.size(); ++t) {
            if (!std::isfinite(s.radii[t])) {
                EXPECT_EQ(s.inside[t], 0) << name;
                continue;
            }
            for (const Index v : s.tetrahedra[t]) {
                ASSERT_NEAR(distance(s.centers[t], s.points[v]), s.radii[t], 1e-6 * (1.0 + s.radii[t])) << name;
            }
            // Centres on the surface may go either way.
            const double slack = 1e-6 * box.diagonal();
            const bool is_inside = solid->inside(s.centers[t]);
            const bool is_clear = solid->inside(s.centers[t] + Point{slack, 0, 0}) == is_inside &&
                                  solid->inside(s.centers[t] - Point{slack, 0, 0}) == is_inside &&
                                  solid->inside(s.centers[t] + Point{0, slack, 0}) == is_inside &&
                                  solid->inside(s.centers[t] - Point{0, slack, 0}) == is_inside &&
                                  solid->inside(s.centers[t] + Point{0, 0, slack}) == is_inside &&
                                  solid->inside(s.centers[t] - Point{0, 0, slack}) == is_inside;
            EXPECT_TRUE(!is_clear || is_inside == (s.inside[t] == 1)) << name << ", tetrahedron " << t;
        }
    }
}

TEST(Sampling, GivesTheDelaunayTriangulation) {
    for (const auto& [name, solid, tolerance, area] : solids()) {
        const Samples s = sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
        ASSERT_EQ(s.neighbors.size(), s.tetrahedra.size());
        ASSERT_EQ(s.centers.size(), s.tetrahedra.size());
        ASSERT_EQ(s.radii.size(), s.tetrahedra.size());
        ASSERT_EQ(s.inside.size(), s.tetrahedra.size());
        for (std::size_t t = 0; t < s.tetrahedra.size(); ++t) {
            const auto& [a, b, c, d] = s.tetrahedra[t];
            const Point& p = s.points[a];
            EXPECT_GE(dot(cross(s.points[b] - p, s.points[c] - p), s.points[d] - p), -1e-12);
            for (std::size_t k = 0; k < 4; ++k) {
                const Index neighbor = s.neighbors[t][k];
                if (neighbor == kNone) {
                    continue;
                }
                const auto& back = s.neighbors[neighbor];
                EXPECT_EQ(std::count(back.begin(), back.end(), static_cast<Index>(t)), 1) << name;
                const auto& others = s.tetrahedra[neighbor];
                for (std::size_t j = 0; j < 4; ++j) {
                    const bool is_shared = std::count(others.begin(), others.end(), s.tetrahedra[t][j]) == 1;
                    EXPECT_EQ(is_shared, j != k) << name;
                }
            }
        }
        // Inside there is nothing ambiguous, as long as no five samples are cospherical.
        std::set<std::array<Index, 4>> inside;
        for (std::size_t t = 0; t < s.tetrahedra.size(); ++t) {
            std::array<Index, 4> sorted = s.tetrahedra[t];
            std::sort(sorted.begin(), sorted.end());
            if (s.inside[t] != 0) {
                inside.insert(sorted);
            }
        }
        std::size_t found = 0;
        const Delaunay truth = delaunay(s.points);
        for (auto cell = truth.finite_cells_begin(); cell != truth.finite_cells_end(); ++cell) {
            std::array<Index, 4> sorted{cell->vertex(0)->info(), cell->vertex(1)->info(), cell->vertex(2)->info(),
                                        cell->vertex(3)->info()};
            std::sort(sorted.begin(), sorted.end());
            found += inside.contains(sorted) ? 1 : 0;
        }
        EXPECT_EQ(found, inside.size()) << name;
    }
}

// The restricted facets form a surface of the right topology, all samples lie on it, and they cover it evenly.
TEST(Sampling, MakesAManifoldOfTheRightTopology) {
    for (const auto& [name, solid, tolerance, area] : solids()) {
        const Samples s = sample(*solid, {.tolerance = tolerance, .sizing = Sizing::kUniform});
        std::set<std::array<Index, 2>> edges;
        std::set<Index> vertices;
        Index facets = 0;
        for (std::size_t t = 0; t < s.tetrahedra.size(); ++t) {
            for (std::size_t k = 0; s.inside[t] != 0 && k < 4; ++k) {
                const Index neighbor = s.neighbors[t][k];
                if (neighbor != kNone && s.inside[neighbor] != 0) {
                    continue;
                }
                ++facets;
                for (std::size_t i = 0; i < 4; ++i) {
                    for (std::size_t j = 0; j < 4; ++j) {
                        if (i != k && j != k && s.tetrahedra[t][i] < s.tetrahedra[t][j]) {
                            edges.insert({s.tetrahedra[t][i], s.tetrahedra[t][j]});
                        }
                    }
                    if (i != k) {
                        vertices.insert(s.tetrahedra[t][i]);
                    }
                }
            }
        }
        const Topology truth = solid->topology().value();
        const auto euler =
            static_cast<std::int64_t>(vertices.size()) - static_cast<std::int64_t>(edges.size()) + facets;
        EXPECT_EQ(euler, 2 * truth.euler) << name;
        EXPECT_EQ(vertices.size(), s.points.size()) << name << ": a sample without a facet";
        EXPECT_EQ(s.statistics.restricted_facets, facets) << name;
        EXPECT_EQ(s.statistics.irregular_samples, 0) << name;
        EXPECT_EQ(s.statistics.conflicts, 0) << name;
        EXPECT_EQ(topology(s), truth) << name;

        for (const Point& p : s.points) {
            int inside = 0;
            int outside = 0;
            for (int direction = 0; direction < 27; ++direction) {
                const Point to{direction % 3 - 1.0, direction / 3 % 3 - 1.0, direction / 9 - 1.0};
                ++(solid->inside(p + 1e-9 * to) ? inside : outside);
            }
            EXPECT_TRUE(inside > 0 && outside > 0) << name << ": a sample is not on the boundary";
        }

        // Every point of the boundary is near to a sample. A loose sample of a smooth surface allows hardly more than
        // the tolerance, at edges it may be more.
        Random random(1);
        const Box box = solid->bounds();
        double covering = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const Point p = midpoint(box.min, box.max) + random_point(random, 0.5 * box.diagonal());
            if (!solid->inside(p)) {
                continue;
            }
            const Point end = p + 2.0 * box.diagonal() * random_direction(random);
            if (const auto crossing = solid->crossing(p, end, p)) {
                double nearest = std::numeric_limits<double>::infinity();
                for (const Point& q : s.points) {
                    nearest = std::min(nearest, distance(*crossing, q));
                }
                covering = std::max(covering, nearest);
            }
        }
        const double density = static_cast<double>(s.points.size()) * tolerance * tolerance / area;
        std::cout << name << ": " << s.points.size() << " samples, covering " << covering / tolerance << " tolerances, "
                  << density << " samples for each tolerance squared\n";
        EXPECT_LT(covering, 1.2 * tolerance) << name;
        EXPECT_LT(density, 0.9) << name;
    }
}

// Seeds that break their promise to be dense: all labels are derived from it, and the solid must be asked.
class SparselySeeded : public Solid {
   public:
    SparselySeeded(const Solid& solid, std::size_t seeds) : solid_(solid), seeds_(seeds) {}
    Box bounds() const override { return solid_.bounds(); }
    using Solid::inside;
    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override {
        solid_.inside(points, sides);
    }
    void crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const override {
        solid_.crossings(chords, points);
    }
    std::vector<Point> seeds(double, std::uint64_t seed, const Execution&) const override {
        Random random(seed);
        std::vector<Point> result;
        while (result.size() < seeds_) {
            const Point p = random_point(random, 0.5 * bounds().diagonal());
            if (solid_.inside(p)) {
                const Point end = p + 2.0 * bounds().diagonal() * random_direction(random);
                result.push_back(solid_.crossing(p, end, end).value());
            }
        }
        return result;
    }

   private:
    const Solid& solid_;
    std::size_t seeds_;
};

TEST(Sampling, KnowsTheTopologyOfAManifoldOnly) {
    Samples s = sample(*mesh_solid(together(torus_mesh(1.0, 0.4, 24), ball_mesh(0.4, 20))),
                       {.tolerance = 0.1, .sizing = Sizing::kUniform});
    EXPECT_EQ(topology(s), known_topology(2, 1, 0));
    // A part more that touches the others in vertices only.
    const auto is_inside = [&](Index t) { return t != kNone && s.inside[t] != 0; };
    const auto far = std::ranges::find_if(s.neighbors, [&](const std::array<Index, 4>& neighbors) {
        const auto t = static_cast<Index>(&neighbors - s.neighbors.data());
        return !is_inside(t) && std::ranges::none_of(neighbors, is_inside);
    });
    ASSERT_NE(far, s.neighbors.end());
    s.inside[far - s.neighbors.begin()] = 1;
    EXPECT_EQ(topology(s), std::nullopt);
    std::ranges::fill(s.inside, std::uint8_t{0});
    EXPECT_EQ(topology(s), std::nullopt);
}

TEST(Sampling, NoticesThatSeedsAreSparse) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const double tolerance = 0.12;
    Index conflicts = 0;
    for (const std::size_t seeds : {40U, 80U, 160U, 320U}) {
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            const Samples s = sample(SparselySeeded(torus, seeds),
                                     {.tolerance = tolerance, .sizing = Sizing::kUniform, .seed = seed});
            if (std::count(s.inside.begin(), s.inside.end(), 1) == 0) {
                EXPECT_LT(seeds, 160U) << "all of the solid was taken for the outside";
                continue;  // no ball can come of it, which the pipeline tells
            }
            conflicts += s.statistics.conflicts;
            EXPECT_LE(largest_surface_ball(torus, s.points, 0.1 * tolerance), tolerance * (1.0 + 1e-9))
                << seeds << " seeds, seed " << seed;
            Index wrong = 0;
            for (std::size_t t = 0; t < s.tetrahedra.size(); ++t) {
                const bool is_clear = std::abs(torus.value(s.centers[t])) > 1e-6;
                wrong += std::isfinite(s.radii[t]) && is_clear && torus.inside(s.centers[t]) != (s.inside[t] == 1);
            }
            EXPECT_EQ(wrong, 0) << seeds << " seeds, seed " << seed;
        }
    }
    EXPECT_GT(conflicts, 0);
}

// Invariance.

bool same(const Samples& a, const Samples& b) {
    return same_bytes(a.points, b.points) && same_bytes(a.tetrahedra, b.tetrahedra) &&
           same_bytes(a.neighbors, b.neighbors) && same_bytes(a.radii, b.radii) && same_bytes(a.inside, b.inside) &&
           a.statistics.rounds == b.statistics.rounds && a.statistics.crossing_queries == b.statistics.crossing_queries;
}

TEST(Sampling, IsTheSameForAnyNumberOfThreads) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const std::unique_ptr<Solid> mesh = mesh_solid(torus_mesh(1.0, 0.4, 30));
    for (const Solid* solid : {static_cast<const Solid*>(&torus), static_cast<const Solid*>(mesh.get())}) {
        const Samples first = sample(*solid, {.tolerance = 0.04, .sizing = Sizing::kUniform}, {.threads = 1});
        ASSERT_GT(first.points.size(), 3000U) << "too few to be shared among threads";
        for (const int threads : {1, 2, 4, 0}) {
            EXPECT_TRUE(
                same(sample(*solid, {.tolerance = 0.04, .sizing = Sizing::kUniform}, {.threads = threads}), first))
                << threads;
        }
        EXPECT_FALSE(same(sample(*solid, {.tolerance = 0.04, .sizing = Sizing::kUniform, .seed = 2}), first));
    }
}

TEST(Sampling, ScalesExactlyWithPowersOfTwo) {
    for (const double scale : {0x1p-30, 0x1p30}) {
        const Samples a = sample(torus_solid(1.0, 0.4), {.tolerance = 0.1, .sizing = Sizing::kUniform});
        Samples b = sample(moved(torus_solid(1.0, 0.4), enlargement(scale)),
                           {.tolerance = 0.1 * scale, .sizing = Sizing::kUniform});
        const auto a_mesh =
            sample(*mesh_solid(torus_mesh(1.0, 0.4, 20)), {.tolerance = 0.1, .sizing = Sizing::kUniform});
        auto b_mesh = sample(*mesh_solid(moved(torus_mesh(1.0, 0.4, 20), enlargement(scale))),
                             {.tolerance = 0.1 * scale, .sizing = Sizing::kUniform});
        for (Samples* samples : {&b, &b_mesh}) {
            for (Point& p : samples->points) {
                p = (1.0 / scale) * p;
            }
            for (double& radius : samples->radii) {
                radius /= scale;
            }
        }
        EXPECT_TRUE(same(a, b)) << scale;
        EXPECT_TRUE(same(a_mesh, b_mesh)) << scale;
    }
}

// What a solid is asked.

/// Another solid, asked in batches of some size.
class Batched : public Solid {
   public:
    Batched(const Solid& solid, std::size_t batch) : solid_(solid), batch_(batch) {}
    using Solid::inside;
    Box bounds() const override { return solid_.bounds(); }
    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override {
        count(points.size(), sides.size());
        solid_.inside(points, sides);
    }
    void crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const override {
        count(chords.size(), points.size());
        solid_.crossings(chords, points);
    }
    std::size_t batch_size() const override { return batch_; }
    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return solid_.seeds(spacing, seed, execution);
    }

    mutable std::atomic<std::int64_t> calls = 0;
    mutable std::atomic<std::int64_t> questions = 0;

   private:
    void count(std::size_t asked, std::size_t answers) const {
        ++calls;
        questions += static_cast<std::int64_t>(asked);
        EXPECT_LE(asked, batch_);
        EXPECT_EQ(asked, answers);
    }

    const Solid& solid_;
    std::size_t batch_;
};

TEST(Sampling, AsksInBatches) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    const std::unique_ptr<Solid> mesh = mesh_solid(box_mesh({-1.0, -0.7, -0.1}, {1.0, 0.7, 0.1}, 3));
    for (const Solid* solid : {static_cast<const Solid*>(&torus), static_cast<const Solid*>(mesh.get())}) {
        const SamplingOptions options{.tolerance = 0.1, .sizing = Sizing::kUniform, .needs_manifold = true};
        const Samples expected = sample(*solid, options);
        for (const std::size_t batch : {1, 7, 1000, 1 << 20}) {
            for (const int threads : {1, 4}) {
                const Batched batched(*solid, batch);
                EXPECT_TRUE(same(sample(batched, options, {.threads = threads}), expected)) << batch;
                // Every round asks for sides once, and for crossings once for each criterion.
                const std::int64_t groups = 6 * (expected.statistics.rounds + 2);
                EXPECT_LE(batched.calls, batched.questions / static_cast<std::int64_t>(batch) + groups) << batch;
                EXPECT_GT(batched.questions, expected.statistics.crossing_queries);
            }
        }
    }
}

// Solids whose answers contradict each other. Sampling ends, with whatever result, or an error that says what is wrong.

/// A ball with some answers replaced.
class LyingBall : public Solid {
   public:
    using Inside = std::function<bool(const Point&)>;
    using Crossing = std::function<std::optional<Point>(const Chord&)>;

    LyingBall(Inside inside, Crossing crossing) : inside_(std::move(inside)), crossing_(std::move(crossing)) {}
    using Solid::inside;
    Box bounds() const override { return centered_box(1.0, 1.0, 1.0); }
    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override {
        std::ranges::transform(points, sides.begin(), [&](const Point& p) { return inside_(p) ? 1 : 0; });
    }
    void crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const override {
        std::ranges::transform(chords, points.begin(), crossing_);
    }
    std::vector<Point> seeds(double, std::uint64_t, const Execution&) const override { return {}; }

   private:
    Inside inside_;
    Crossing crossing_;
};

/// How sampling it ends, with all criteria: an error's code, or nothing.
std::string end_of_sampling(const Solid& solid, double tolerance) {
    try {
        sample(solid, {.tolerance = tolerance,
                       .sizing = Sizing::kUniform,
                       .needs_manifold = true,
                       .facet_distance = 0.1 * tolerance,
                       .max_samples = 20000});
    } catch (const UnusableInput& error) {
        EXPECT_FALSE(error.diagnostic().message.empty());
        return error.diagnostic().code;
    }
    return "";
}

TEST(Sampling, EndsWhateverTheSolidAnswers) {
    const ImplicitSolid ball = ball_solid(1.0);
    const auto truth = [&](const Point& p) { return ball.inside(p); };
    const auto true_crossing = [&](const Chord& c) { return ball.crossing(c.inside_end, c.outside_end, c.reference); };
    std::atomic<std::uint64_t> calls = 0;
    const auto random = [&](std::uint64_t k) {
        return static_cast<double>((++calls * 2654435761 + k) % 1000) / 1000.0;
    };
    const auto random_place = [&](double reach) {
        return reach * Point{2.0 * random(1) - 1.0, 2.0 * random(2) - 1.0, 2.0 * random(3) - 1.0};
    };
    const auto on_chord = [&](const Chord& c, double t) { return c.inside_end + t * (c.outside_end - c.inside_end); };
    const auto always = [](const Point&) { return true; };
    const auto at_random = [&](const Point&) { return random(0) < 0.5; };
    struct Case {
        std::string name;
        LyingBall::Inside inside;
        LyingBall::Crossing crossing;
        bool must_fail;
    };
    const std::vector<Case> cases{
        {"random sides", at_random, true_crossing, false},
        {"random crossings on the chord", truth, [&](const Chord& c) { return on_chord(c, random(4)); }, false},
        {"random crossings in the box", truth, [&](const Chord&) { return random_place(1.0); }, true},
        {"random answers", at_random, [&](const Chord& c) { return on_chord(c, random(5)); }, false},
        {"now and then no crossing", truth,
         [&](const Chord& c) { return random(6) < 0.5 ? std::nullopt : true_crossing(c); }, false},
        {"everything inside", always, true_crossing, false},
        {"no crossing anywhere, and everything inside", always, [](const Chord&) { return std::nullopt; }, true},
        {"crossings far off", truth,
         [](const Chord&) {
             return Point{50.0, 0.0, 0.0};
         },
         true},
        {"crossings that are no numbers", truth,
         [](const Chord&) {
             return Point{std::nan(""), 0.0, 0.0};
         },
         true},
        {"crossings that move", truth,
         [&](const Chord&) {
             return Point{2e-5 * static_cast<double>(++calls % 10000), 0.0, 0.0};
         },
         false},
    };
    for (const auto& [name, inside, crossing, must_fail] : cases) {
        calls = 0;
        const std::string end = end_of_sampling(LyingBall(inside, crossing), 0.2);
        std::cout << name << ": " << (end.empty() ? "a result" : end) << '\n';
        EXPECT_TRUE(!must_fail || !end.empty()) << name;
    }
}

TEST(Sampling, RefinesInABoundedNumberOfRounds) {
    // Sides of a fine checkerboard, and crossings anywhere: some of the new facets are always large. Few of the
    // crossings are as far apart as those of a batch must be, so that the number of samples grows slowly.
    const ImplicitSolid ball = ball_solid(1.0);
    Random random(9);
    const auto checkers = [](const Point& p) {
        return static_cast<int>(std::floor(50.0 * p.x) + std::floor(50.0 * p.y) + std::floor(50.0 * p.z)) % 2 == 0;
    };
    const LyingBall endless(checkers, [&](const Chord& c) -> std::optional<Point> {
        if (c.reference == c.outside_end) {  // a seed
            return ball.crossing(c.inside_end, c.outside_end, c.reference);
        }
        return random_point(random, 0.9);
    });
    try {
        sample(endless, {.tolerance = 0.9, .sizing = Sizing::kUniform}, {.threads = 1});
        FAIL() << "no error";
    } catch (const UnusableInput& error) {
        EXPECT_EQ(error.diagnostic().code, "sampling.rounds");
        EXPECT_NE(error.diagnostic().message.find("1000 rounds"), std::string::npos) << error.what();
    }
}

TEST(Sampling, TakesAtMostSoManySamples) {
    const ImplicitSolid ball = ball_solid(1.0);
    const Samples samples = sample(ball, {.tolerance = 0.1, .sizing = Sizing::kUniform});
    const auto count = static_cast<Index>(samples.points.size());
    EXPECT_TRUE(same(sample(ball, {.tolerance = 0.1, .sizing = Sizing::kUniform, .max_samples = count}), samples));
    try {
        sample(ball, {.tolerance = 0.1, .sizing = Sizing::kUniform, .max_samples = count - 1});
        FAIL() << "no error";
    } catch (const UnusableInput& error) {
        EXPECT_EQ(error.diagnostic().code, "sampling.samples");
        EXPECT_NE(error.diagnostic().message.find(std::to_string(count - 1)), std::string::npos) << error.what();
    }
    EXPECT_THROW(sample(ball, {.tolerance = 0.1, .sizing = Sizing::kUniform, .max_samples = 0}), InvalidOption);
}

TEST(Sampling, RejectsBoundariesOutsideOfTheBounds) {
    const ImplicitSolid ball = ball_solid(1.0);
    const ImplicitSolid larger(centered_box(0.5, 0.5, 0.5), [](const Point& p) { return norm(p) - 1.0; });
    try {
        sample(larger, {.tolerance = 0.1, .sizing = Sizing::kUniform});
        FAIL() << "no error";
    } catch (const UnusableInput& error) {
        EXPECT_EQ(error.diagnostic().code, "solid.contradiction");
        EXPECT_TRUE(error.diagnostic().place);
    }
}

// Options and callbacks.

TEST(Sampling, RejectsWhatItCannotSample) {
    const ImplicitSolid ball = ball_solid(1.0);
    for (const double tolerance : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_THROW(sample(ball, {.tolerance = tolerance, .sizing = Sizing::kUniform}), InvalidOption) << tolerance;
    }
    const ImplicitSolid nothing(centered_box(1.0, 1.0, 1.0), [](const Point&) { return 1.0; });
    EXPECT_THROW(sample(nothing, {.tolerance = 0.1, .sizing = Sizing::kUniform}), UnusableInput);
    EXPECT_THROW(sample(ImplicitSolid({}, [](const Point&) { return 1.0; }), {.tolerance = 0.1}), UnusableInput);
}

TEST(Sampling, ReportsProgressAndStops) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    std::vector<double> fractions;
    sample(torus, {.tolerance = 0.1, .sizing = Sizing::kUniform}, {.progress = [&](std::string_view, double fraction) {
               fractions.push_back(fraction);
               return true;
           }});
    EXPECT_GE(fractions.size(), 4U);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end())) << testing::PrintToString(fractions);
    EXPECT_EQ(fractions.front(), 0.0);
    EXPECT_EQ(fractions.back(), 1.0);
    for (std::size_t calls = 0; calls < fractions.size(); ++calls) {
        std::size_t left = calls;
        EXPECT_THROW(sample(torus, {.tolerance = 0.1, .sizing = Sizing::kUniform},
                            {.progress = [&](std::string_view, double) { return left-- > 0; }}),
                     Cancelled);
    }
}

TEST(Sampling, IsCancelledFromWithinTheSolid) {
    const ImplicitSolid torus = torus_solid(1.0, 0.4);
    std::stop_source stop;
    std::atomic<int> questions = 0;
    const ImplicitSolid stopping(torus.bounds(), [&](const Point& p) {
        if (++questions == 20000) {
            stop.request_stop();
        }
        return torus.value(p);
    });
    EXPECT_THROW(
        sample(stopping, {.tolerance = 0.02, .sizing = Sizing::kUniform}, {.threads = 1, .cancel = stop.get_token()}),
        Cancelled);
    EXPECT_LT(questions, 400000) << "it went on for more than a batch";
    questions = 0;
    sample(stopping, {.tolerance = 0.02, .sizing = Sizing::kUniform});
    EXPECT_GT(questions, 1000000) << "there was nothing to cancel";
}

TEST(Sampling, FacetsFollowEdges) {
    const TriangleMesh box = box_mesh({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.6}, 1);
    const double tolerance = 0.1;
    const auto distance = [&](double facet_distance) {
        const Samples samples = sample(*mesh_solid(box), {.tolerance = tolerance,
                                                          .sizing = Sizing::kUniform,
                                                          .needs_manifold = true,
                                                          .facet_distance = facet_distance * tolerance,
                                                          .growth_limit = 10.0});
        return surface_distance(box, boundary_mesh(samples).mesh, {.spacing = 0.1 * tolerance}).max() / tolerance;
    };
    EXPECT_GT(distance(100.0), 0.5);
    EXPECT_LT(distance(0.125), 0.4);
    EXPECT_THROW(sample(*mesh_solid(box), {.tolerance = 0.1, .sizing = Sizing::kUniform, .facet_distance = 0.0}),
                 InvalidOption);
}

}  // namespace
}  // namespace scaleaxis
