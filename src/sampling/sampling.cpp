// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/sampling.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "kernel/ball_tree.hpp"
#include "kernel/disjoint_sets.hpp"
#include "kernel/parallel.hpp"
#include "kernel/random.hpp"
#include "kernel/spheres.hpp"
#include "kernel/triangulation.hpp"
#include "sampling/inner_cells.hpp"
#include "sampling/poisson_disk.hpp"
#include "sampling/umbrellas.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

// Distance of the first samples, in tolerances. A larger one needs fewer samples, but from 1.2 on the first
// triangulation is too coarse for labels to spread from tetrahedron to tetrahedron.
constexpr double kSeedSpacing = 1.0;

// No point of the surface is taken to be farther than this from the first samples, in tolerances: labels rely on it.
// Conflicts show where it does not hold.
constexpr double kSeedCovering = 1.5;

// Where it does not hold, labels are in doubt whose circumspheres are smaller than this, in tolerances: the group of a
// larger one has been asked for at one that is deeper still.
constexpr double kDoubtfulRadius = 3.0;

// Points of one batch keep this distance, in tolerances: closer ones would be of no use for each other.
constexpr double kBatchSpacing = 0.7;

// Facets with surface Delaunay balls smaller than this, in tolerances, are not refined to make the surface a manifold.
constexpr double kManifoldFloor = 1.0 / 32.0;

// The same where the facets are made to suit the features of the shape or its balls.
constexpr double kFeatureFloor = 1.0 / 8.0;

// The union of the balls may be so far from the surface, in tolerances. Much less takes samples without end.
constexpr double kDeviation = 0.25;

// How often points are looked for around samples without facets.
constexpr Index kMaxStrayRounds = 6;

// Circumcentres farther away than this many diagonals are only known by their direction.
constexpr double kFarAway = 1e4;

// Where a shape gives no seeds: how many random points are tried to find some that are inside.
constexpr std::uint64_t kBlindTries = 1 << 20;
constexpr std::size_t kBlindSeeds = 64;

enum class Side : std::uint8_t { kUnknown, kOutside, kInside };

struct CrossedFacet {
    std::array<Index, 3> vertices{};  // ascending: the key of the canonical order
    Point crossing;
    double radius = 0.0;  // of the surface Delaunay ball
};

struct FacetList {
    std::vector<std::array<Index, 3>> vertices;  // ascending
    std::vector<std::pair<Index, int>> faces;  // the cell inside, and the position of its vertex opposite to the facet
};

FacetList join(std::vector<FacetList>& parts) {
    return {kernel::joined(parts, &FacetList::vertices), kernel::joined(parts, &FacetList::faces)};
}

struct FacetCheck {
    std::vector<CrossedFacet> bad;
    std::vector<Index> conflicts;  // pairs of cells whose facet's dual edge does not cross the surface
};

FacetCheck join(std::vector<FacetCheck>& parts) {
    return {kernel::joined(parts, &FacetCheck::bad), kernel::joined(parts, &FacetCheck::conflicts)};
}

// Crossings may lie outside the shape's box by a rounding error.
Box widened(Box box, double margin) {
    const Point by{margin, margin, margin};
    return {box.min - by, box.max + by};
}

// A Delaunay triangulation of samples in refinement, with the side of every circumcentre. Whatever it decides depends
// on the set of cells alone, not on the slots that they happen to live in.
class Refinement {
   public:
    Refinement(const Shape& shape, double tolerance)
        : shape_(shape), box_(shape.bounds()), tolerance_(tolerance), builder_(widened(box_, tolerance), false) {}

    void insert(const std::vector<Point>& points) {
        builder_.insert(points);
        points_ += points.size();
        const Index slots = builder_.slots();
        spheres_.resize(slots);
        sides_.resize(slots, Side::kOutside);
        fresh_ = kernel::collect<std::vector<Index>>(slots, [&](Index cell, std::vector<Index>& fresh) {
            if (!builder_.is_cell(cell)) {
                sides_[cell] = Side::kOutside;
            } else if (builder_.is_fresh(cell)) {
                spheres_[cell] = circumsphere(cell);
                sides_[cell] = may_be_inside(cell) ? Side::kUnknown : Side::kOutside;
                fresh.push_back(cell);
            }
        });
        if (is_fresh_vertex_.empty()) {
            return;
        }
        is_fresh_vertex_.resize(points_);
        for (const Index cell : fresh_) {
            for (const Index v : builder_.vertices(cell)) {
                if (!kernel::is_ghost(v)) {
                    is_fresh_vertex_[v] = 1;
                }
            }
        }
    }

    // Labels all cells that have no label yet. No point of the surface is farther than `covering` from a sample, so a
    // circumball of radius R holds a ball of radius R - covering that the surface does not meet, and where two of these
    // overlap, both centres lie on the same side: one question for each connected group is enough.
    void label(double covering) {
        DisjointSets groups(builder_.slots());
        std::vector<Side> known(sides_.size(), Side::kUnknown);  // the side of a group, where a neighbor tells
        for (const Index cell : fresh_) {
            if (sides_[cell] != Side::kUnknown || spheres_[cell].radius <= covering) {
                continue;
            }
            for (int k = 0; k < 4; ++k) {
                const Index neighbor = builder_.neighbor(cell, k);
                if (neighbor == kNone) {
                    continue;
                }
                const bool is_known = sides_[neighbor] != Side::kUnknown;
                if ((is_known || neighbor < cell) && are_on_one_side(cell, neighbor, covering)) {
                    if (is_known) {
                        known[cell] = std::max(known[cell], sides_[neighbor]);
                    } else {
                        groups.join(cell, neighbor);
                    }
                }
            }
        }

        std::vector<Index> deepest(sides_.size(), kNone);  // of a group
        std::vector<Index> asked;
        for (const Index cell : fresh_) {
            if (sides_[cell] == Side::kUnknown) {
                const Index group = groups.find(cell);
                if (deepest[group] == kNone) {
                    asked.push_back(group);
                }
                if (deepest[group] == kNone || is_deeper(cell, deepest[group])) {
                    deepest[group] = cell;
                }
                known[group] = std::max(known[group], known[cell]);
            }
        }
        kernel::for_each_index(
            asked.size(),
            [&](std::size_t i) {
                const Index group = asked[i];
                known[group] = known[group] != Side::kUnknown ? known[group] : ask(deepest[group]);
            },
            std::size_t{64});
        for (const Index cell : fresh_) {
            if (sides_[cell] == Side::kUnknown) {
                sides_[cell] = known[groups.find(cell)];
            }
        }
    }

    // Crossings of the restricted facets beside a fresh cell whose surface Delaunay balls are too large, thinned: no
    // other facet can have become so. Where labels contradict the shape, the shape is asked for the two cells; if it
    // corrects one of them, the sampling was coarser than `label` was told, and it is asked for every fresh cell near
    // the surface; if that was not enough, for all of them.
    std::vector<Point> bad_points(std::uint64_t seed) {
        FacetCheck check = check_facets();
        statistics_.conflicts += static_cast<Index>(check.conflicts.size() / 2);
        if (relabel(check.conflicts) > 0) {
            std::vector<Index> near;
            std::ranges::copy_if(fresh_, std::back_inserter(near),
                                 [&](Index cell) { return spheres_[cell].radius <= kDoubtfulRadius * tolerance_; });
            relabel(near);
            check = check_facets();
            if (relabel(check.conflicts) > 0) {
                relabel(fresh_);
                check = check_facets();
            }
        }
        std::ranges::sort(check.bad, {}, &CrossedFacet::vertices);
        std::vector<Point> points(check.bad.size());
        std::ranges::transform(check.bad, points.begin(), &CrossedFacet::crossing);
        return poisson_disk_subset(points, kBatchSpacing * tolerance_, seed);
    }

    // Points that make the restricted facets more of a manifold: for every sample around which they form no disk the
    // crossing of its facet with the largest surface Delaunay ball, and points around a sample that has no facet.
    std::vector<Point> manifold_points(std::uint64_t seed) {
        const FacetList facets = restricted_facets();
        const std::vector<Index> irregular = irregular_vertices(facets.vertices, points_);
        std::vector<CrossedFacet> widest(points_);  // of each irregular sample
        std::vector<double> radii(points_, -1.0);
        for (const Index v : irregular) {
            radii[v] = 0.0;
        }
        for (std::size_t f = 0; f < facets.vertices.size(); ++f) {
            const std::array<Index, 3>& vertices = facets.vertices[f];
            if (std::none_of(vertices.begin(), vertices.end(), [&](Index v) { return radii[v] >= 0.0; })) {
                continue;
            }
            const auto& [cell, k] = facets.faces[f];
            const Point crossing = crossing_of(cell, k).value_or(point(vertices[0]));
            const double radius = distance(crossing, point(vertices[0]));
            for (const Index v : vertices) {
                const bool is_wider = radius > radii[v] || (radius == radii[v] && vertices < widest[v].vertices);
                if (radii[v] >= 0.0 && is_wider) {
                    radii[v] = radius;
                    widest[v] = {vertices, crossing, radius};
                }
            }
        }
        std::vector<CrossedFacet> facets_of_irregular;
        for (const Index v : irregular) {
            facets_of_irregular.push_back(widest[v]);
        }
        std::vector<Point> points = thinned(facets_of_irregular, kManifoldFloor * tolerance_, seed);
        if (++stray_rounds_ <= kMaxStrayRounds) {
            for (const Index v : strays(irregular, radii)) {
                kernel::append(points, points_around(point(v), kernel::random_bits(seed, v, stray_rounds_)));
            }
        }
        return points;
    }

    // Crossings of the facets that are too large for the features of the shape around them: a surface Delaunay ball
    // must not be larger than the distance of a corner to its nearer pole.
    std::vector<Point> feature_points(std::uint64_t seed) {
        const std::vector<double> sizes = feature_sizes();
        return crossings_where(
            [&](const std::array<Index, 3>& facet) {
                return std::min({sizes[facet[0]], sizes[facet[1]], sizes[facet[2]]}) < tolerance_;
            },
            [&](const CrossedFacet& facet) {
                const auto& [a, b, c] = facet.vertices;
                return facet.radius > std::min({sizes[a], sizes[b], sizes[c]});
            },
            seed);
    }

    // Crossings of facets that are too far from the plane of the facet, or (`suits_balls`) from the boundary of the
    // union of the balls, inside it or outside. Only facets with a sample at a cell that is new since the last time are
    // looked at.
    std::vector<Point> deviation_points(double facet_distance, bool suits_balls, std::uint64_t seed) {
        std::optional<kernel::BallTree> tree;
        if (suits_balls) {
            if (const std::vector<Ball> balls = balls_of_cells(Cells{*this}, points_); !balls.empty()) {
                tree = kernel::build_ball_tree(balls);
            }
        }
        std::vector<Point> points = crossings_where(
            [&](const std::array<Index, 3>& facet) {
                return is_fresh_vertex_.empty() ||
                       std::ranges::any_of(facet, [&](Index v) { return is_fresh_vertex_[v] != 0; });
            },
            [&](const CrossedFacet& facet) {
                return height_above(facet) > facet_distance ||
                       (tree &&
                        std::abs(kernel::nearest_ball(*tree, facet.crossing).distance) > kDeviation * tolerance_);
            },
            seed);
        is_fresh_vertex_.assign(points_, 0);
        return points;
    }

    std::size_t points() const { return points_; }

    Samples finish() && {
        Samples samples;
        std::vector<Index> slots;
        kernel::Triangulation triangulation = builder_.finish(&slots);
        // Cells with a ghost come first in the canonical order.
        const auto ghosts =
            static_cast<Index>(std::find_if(triangulation.cells.begin(), triangulation.cells.end(),
                                            [](const auto& cell) { return !kernel::is_ghost(cell.vertices[0]); }) -
                               triangulation.cells.begin());
        const Index count = static_cast<Index>(triangulation.size()) - ghosts;
        samples.tetrahedra.resize(count);
        samples.neighbors.resize(count);
        samples.centers.resize(count);
        samples.radii.resize(count);
        samples.inside.resize(count);
        kernel::for_each_index(count, [&](Index t) {
            const Index slot = slots[ghosts + t];
            samples.tetrahedra[t] = triangulation.cells[ghosts + t].vertices;
            for (int k = 0; k < 4; ++k) {
                const Index neighbor = triangulation.cells[ghosts + t].neighbors[k];
                samples.neighbors[t][k] = neighbor < ghosts ? kNone : neighbor - ghosts;
            }
            samples.centers[t] = spheres_[slot].center;
            samples.radii[t] = spheres_[slot].radius;
            samples.inside[t] = sides_[slot] == Side::kInside ? 1 : 0;
        });
        samples.points = std::move(triangulation.points);
        samples.tolerance = tolerance_;
        statistics_.inside_queries = inside_queries_;
        statistics_.crossing_queries = crossing_queries_;
        samples.statistics = statistics_;
        return samples;
    }

    SamplingStatistics& statistics() { return statistics_; }

   private:
    // As `balls_of_cells` wants them.
    struct Cells {
        const Refinement& refinement;

        Index size() const { return refinement.builder_.slots(); }
        bool is_inside(Index cell) const { return refinement.sides_[cell] == Side::kInside; }
        const std::array<Index, 4>& vertices(Index cell) const { return refinement.builder_.vertices(cell); }
        Ball ball(Index cell) const {
            const auto& [center, radius] = refinement.spheres_[cell];
            return {center, radius};
        }
        bool is_larger(Index cell, Index other) const { return refinement.is_deeper(cell, other); }
    };

    bool has_ghost(Index cell) const {
        const std::array<Index, 4>& v = builder_.vertices(cell);
        return std::any_of(v.begin(), v.end(), kernel::is_ghost);
    }

    const Point& point(Index vertex) const { return builder_.point(vertex); }

    // Rounding depends on the order of the vertices, so there is one order.
    kernel::Circumsphere circumsphere(Index cell) const {
        std::array<Index, 4> v = builder_.vertices(cell);
        std::sort(v.begin(), v.end());
        return kernel::circumsphere(point(v[0]), point(v[1]), point(v[2]), point(v[3]), kFarAway * box_.diagonal());
    }

    bool is_deeper(Index cell, Index other) const {
        const double a = spheres_[cell].radius;
        const double b = spheres_[other].radius;
        if (a != b) {
            return a > b;
        }
        std::array<Index, 4> v = builder_.vertices(cell);
        std::array<Index, 4> w = builder_.vertices(other);
        std::sort(v.begin(), v.end());
        std::sort(w.begin(), w.end());
        return v < w;
    }

    bool are_on_one_side(Index cell, Index neighbor, double covering) const {
        const kernel::Circumsphere& a = spheres_[cell];
        const kernel::Circumsphere& b = spheres_[neighbor];
        const double overlap = a.radius + b.radius - 2.0 * covering;
        return b.radius > covering && std::isfinite(b.radius) &&
               squared_distance(a.center, b.center) < overlap * overlap;
    }

    Side ask(Index cell) {
        inside_queries_.fetch_add(1, std::memory_order_relaxed);
        return shape_.inside(spheres_[cell].center) ? Side::kInside : Side::kOutside;
    }

    // Can the centre of the cell lie inside? One inside is at most half a diagonal from the surface, and so hardly
    // farther from a sample.
    bool may_be_inside(Index cell) const {
        return !has_ghost(cell) && spheres_[cell].radius <= 0.5 * box_.diagonal() + tolerance_ &&
               box_.contains(spheres_[cell].center);
    }

    // Asks the shape for the side of each of the cells and returns how many labels were wrong.
    Index relabel(const std::vector<Index>& cells) {
        std::atomic<Index> corrected = 0;
        kernel::for_each_index(
            cells.size(),
            [&](std::size_t i) {
                const Index cell = cells[i];
                if (may_be_inside(cell)) {
                    const Side asked = ask(cell);
                    // A cell may be named twice, but the answer is the same.
                    corrected += std::atomic_ref(sides_[cell]).exchange(asked) != asked ? 1 : 0;
                }
            },
            std::size_t{64});
        statistics_.relabelled += corrected;
        return corrected;
    }

    // The end of the dual Voronoi edge of facet `k` of an inside cell, cut off where nothing of the shape can be.
    Point outer_end(Index cell, int k) const {
        const Point& center = spheres_[cell].center;
        const double enough = 3.0 * box_.diagonal();
        const Index neighbor = builder_.neighbor(cell, k);
        Point direction;
        if (neighbor != kNone && std::isfinite(spheres_[neighbor].radius)) {
            direction = spheres_[neighbor].center - center;
        } else {
            const std::array<Index, 4>& v = builder_.vertices(cell);
            const Point a = point(v[(k + 1) & 3]);
            const Point normal = cross(point(v[(k + 2) & 3]) - a, point(v[(k + 3) & 3]) - a);
            const Point outward = dot(normal, point(v[k]) - a) > 0.0 ? -1.0 * normal : normal;
            direction = (2.0 * enough / norm(outward)) * outward;
        }
        const double length = norm(direction);
        return length <= enough ? center + direction : center + (enough / length) * direction;
    }

    std::array<Index, 3> facet_vertices(Index cell, int k) const {
        const std::array<Index, 4> v = builder_.vertices(cell);
        std::array<Index, 3> facet{v[(k + 1) & 3], v[(k + 2) & 3], v[(k + 3) & 3]};
        std::sort(facet.begin(), facet.end());
        return facet;
    }

    std::optional<Point> crossing_of(Index cell, int k) {
        crossing_queries_.fetch_add(1, std::memory_order_relaxed);
        return shape_.crossing(spheres_[cell].center, outer_end(cell, k), point(facet_vertices(cell, k)[0]));
    }

    FacetList restricted_facets() const {
        return kernel::collect<FacetList>(builder_.slots(), [&](Index cell, FacetList& out) {
            for (int k = 0; sides_[cell] == Side::kInside && k < 4; ++k) {
                const Index neighbor = builder_.neighbor(cell, k);
                if (neighbor == kNone || sides_[neighbor] != Side::kInside) {
                    out.vertices.push_back(facet_vertices(cell, k));
                    out.faces.emplace_back(cell, k);
                }
            }
        });
    }

    // Distance of each sample to the nearer of its two poles, which are the farthest centres of its cells inside and
    // outside; infinite where there are none.
    std::vector<double> feature_sizes() const {
        std::array<std::vector<double>, 2> poles{std::vector<double>(points_), std::vector<double>(points_)};
        for (Index cell = 0; cell < builder_.slots(); ++cell) {
            for (int k = 0; builder_.is_cell(cell) && k < 4; ++k) {
                if (const Index v = builder_.vertices(cell)[k]; !kernel::is_ghost(v)) {
                    double& pole = poles[sides_[cell] == Side::kInside ? 0 : 1][v];
                    pole = std::max(pole, spheres_[cell].radius);
                }
            }
        }
        std::vector<double> sizes(points_, std::numeric_limits<double>::infinity());
        for (std::size_t v = 0; v < points_; ++v) {
            for (const std::vector<double>& pole : poles) {
                sizes[v] = pole[v] > 0.0 ? std::min(sizes[v], pole[v]) : sizes[v];
            }
        }
        return sizes;
    }

    // The distance of the crossing from the plane of the facet.
    double height_above(const CrossedFacet& facet) const {
        const Point a = point(facet.vertices[0]);
        const Point normal = cross(point(facet.vertices[1]) - a, point(facet.vertices[2]) - a);
        return std::abs(dot(normal, facet.crossing - a)) / norm(normal);
    }

    // Crossings of the restricted facets that are bad, thinned. `may_be_bad` spares the crossing.
    template <class MayBeBad, class IsBad>
    std::vector<Point> crossings_where(const MayBeBad& may_be_bad, const IsBad& is_bad, std::uint64_t seed) {
        const double floor = kFeatureFloor * tolerance_;
        const FacetList facets = restricted_facets();
        auto found = kernel::collect<std::vector<CrossedFacet>>(
            facets.vertices.size(),
            [&](std::size_t f, std::vector<CrossedFacet>& out) {
                const std::array<Index, 3>& vertices = facets.vertices[f];
                if (may_be_bad(vertices)) {
                    const auto& [cell, k] = facets.faces[f];
                    const Point crossing = crossing_of(cell, k).value_or(point(vertices[0]));
                    const CrossedFacet facet{vertices, crossing, distance(crossing, point(vertices[0]))};
                    if (facet.radius > floor && is_bad(facet)) {
                        out.push_back(facet);
                    }
                }
            },
            std::size_t{256});
        std::ranges::sort(found, {}, &CrossedFacet::vertices);
        return thinned(found, floor, seed);
    }

    // The crossings of those facets whose surface Delaunay balls are larger than `floor`, none much closer to another
    // than its ball is large.
    std::vector<Point> thinned(const std::vector<CrossedFacet>& facets, double floor, std::uint64_t seed) const {
        std::vector<Point> points;
        for (double radius = tolerance_; radius > floor; radius *= 0.5) {
            std::vector<Point> batch;
            for (const CrossedFacet& facet : facets) {
                if (facet.radius <= radius && facet.radius > std::max(0.5 * radius, floor)) {
                    batch.push_back(facet.crossing);
                }
            }
            kernel::append(points, poisson_disk_subset(batch, 0.5 * kBatchSpacing * radius, seed));
        }
        return points;
    }

    // Samples with no cell inside around them: all that there is of a part of the shape. (One with no cell outside lies
    // in a crevice that the cells bridge. More samples there would tear holes into the bridge.)
    std::vector<Index> strays(const std::vector<Index>& irregular, const std::vector<double>& radii) const {
        std::vector<std::uint8_t> has_inside(points_);
        for (Index cell = 0; cell < builder_.slots(); ++cell) {
            for (int k = 0; sides_[cell] == Side::kInside && k < 4; ++k) {
                has_inside[builder_.vertices(cell)[k]] = 1;
            }
        }
        std::vector<Index> result;
        std::copy_if(irregular.begin(), irregular.end(), std::back_inserter(result),
                     [&](Index v) { return radii[v] == 0.0 && has_inside[v] == 0; });
        return result;
    }

    // A part of the boundary so small that it has this sample only is found from points inside nearby, if there are
    // any.
    std::vector<Point> points_around(const Point& p, std::uint64_t seed) const {
        constexpr std::uint64_t kTries = 8;
        const auto direction = [&](std::uint64_t i, std::uint64_t k) {
            const auto coordinate = [&](std::uint64_t axis) {
                return kernel::random_unit(seed, i, 3 * k + axis) - 0.5;
            };
            const Point d{coordinate(0), coordinate(1), coordinate(2)};
            return (1.0 / norm(d)) * d;
        };
        std::vector<Point> points;
        for (double length = std::ldexp(tolerance_, 1 - stray_rounds_);
             points.empty() && length > kManifoldFloor * tolerance_; length *= 0.5) {
            for (std::uint64_t i = 0; i < kTries; ++i) {
                const Point inner = p + length * direction(i, 0);
                for (std::uint64_t k = 1; k <= kTries && shape_.inside(inner); ++k) {
                    const std::optional<Point> crossing =
                        shape_.crossing(inner, inner + 4.0 * length * direction(i, k), p);
                    if (crossing && distance(*crossing, p) > kManifoldFloor * tolerance_) {
                        points.push_back(*crossing);
                    }
                }
            }
            points = poisson_disk_subset(points, 0.25 * length, seed);
        }
        return points;
    }

    // Labels and shape can disagree about a centre that lies on the surface to within rounding: then the surface is
    // found by bisection.
    Point bisected(Point inside, Point outside) {
        for (int step = 0; step < 60; ++step) {
            const Point middle = midpoint(inside, outside);
            (shape_.inside(middle) ? inside : outside) = middle;
        }
        return inside;
    }

    // Each facet once, even if both cells are fresh.
    FacetCheck check_facets() {
        return kernel::collect<FacetCheck>(fresh_.size(), [&](std::size_t i, FacetCheck& out) {
            const Index cell = fresh_[i];
            for (int k = 0; k < 4; ++k) {
                const Index neighbor = builder_.neighbor(cell, k);
                const Side beyond = neighbor != kNone ? sides_[neighbor] : Side::kOutside;
                if (sides_[cell] == beyond) {
                    continue;
                }
                if (sides_[cell] == Side::kInside) {
                    check_facet(cell, k, out);
                } else if (!builder_.is_fresh(neighbor)) {
                    check_facet(neighbor, builder_.mirror(cell, k), out);
                }
            }
        });
    }

    // Facet `k` of an inside cell, with an outside cell or nothing behind it.
    void check_facet(Index cell, int k, FacetCheck& out) {
        const std::array<Index, 3> vertices = facet_vertices(cell, k);
        std::optional<Point> crossing = crossing_of(cell, k);
        if (!crossing) {
            const Index neighbor = builder_.neighbor(cell, k);
            kernel::append(out.conflicts, {cell, neighbor != kNone ? neighbor : cell});
            crossing = bisected(spheres_[cell].center, outer_end(cell, k));
        }
        const double radius = distance(*crossing, point(vertices[0]));
        if (radius > tolerance_) {
            out.bad.push_back({vertices, *crossing, radius});
        }
    }

    const Shape& shape_;
    Box box_;
    double tolerance_;
    kernel::TriangulationBuilder builder_;
    std::size_t points_ = 0;
    std::vector<kernel::Circumsphere> spheres_;  // by slot
    std::vector<Side> sides_;                    // by slot
    std::vector<Index> fresh_;                   // the cells made by the last `insert`
    std::vector<std::uint8_t>
        is_fresh_vertex_;  // of a cell made since the last `deviation_points`; empty before the first
    Index stray_rounds_ = 0;
    SamplingStatistics statistics_;
    std::atomic<std::int64_t> inside_queries_ = 0;
    std::atomic<std::int64_t> crossing_queries_ = 0;
};

// Points of the boundary on random rays from random inside points.
std::vector<Point> blind_seeds(const Shape& shape, std::uint64_t seed) {
    const Box box = shape.bounds();
    const Point extent = box.max - box.min;
    std::vector<Point> seeds;
    for (std::uint64_t i = 0; i < kBlindTries && seeds.size() < kBlindSeeds; ++i) {
        const auto coordinate = [&](std::uint64_t k) { return kernel::random_unit(seed, i, k); };
        const Point p = box.min + Point{extent.x * coordinate(0), extent.y * coordinate(1), extent.z * coordinate(2)};
        if (shape.inside(p)) {
            const Point direction{coordinate(3) - 0.5, coordinate(4) - 0.5, coordinate(5) - 0.5};
            const Point end = p + (2.0 * box.diagonal() / norm(direction)) * direction;
            if (const std::optional<Point> crossing = shape.crossing(p, end, end)) {
                seeds.push_back(*crossing);
            }
        }
    }
    return seeds;
}

void validate(const Shape& shape, const SamplingOptions& options) {
    const double diagonal = shape.bounds().diagonal();
    if (!(diagonal > 0.0) || !std::isfinite(diagonal)) {
        throw UnusableShape("the shape is empty or not bounded: its bounding box has no finite diagonal");
    }
    if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance)) {
        throw InvalidOption("the sampling tolerance must be a positive length");
    }
    if (!(options.facet_distance > 0.0)) {
        throw InvalidOption("the distance of the surface from its facets must be a positive length");
    }
    if (!(options.growth_limit >= 1.0)) {
        throw InvalidOption("the growth of the number of samples must be limited to a factor of 1 at least");
    }
}

}  // namespace

Samples sample(const Shape& shape, const SamplingOptions& options, const Execution& execution) {
    validate(shape, options);
    return kernel::in_arena(execution, [&] {
        constexpr std::string_view kStage = "sampling";
        const double tolerance = options.tolerance;
        kernel::report(execution, kStage, 0.0);

        std::vector<Point> seeds = shape.seeds(kSeedSpacing * tolerance, options.seed, execution);
        const bool are_seeds_dense = !seeds.empty();
        if (!are_seeds_dense) {
            seeds = blind_seeds(shape, options.seed);
        }
        seeds = poisson_disk_subset(seeds, kSeedSpacing * tolerance, options.seed);
        if (seeds.empty()) {
            throw UnusableShape("no point of the shape's boundary was found: it has no volume to speak of");
        }
        kernel::report(execution, kStage, 0.2);

        Refinement refinement(shape, tolerance);
        refinement.statistics().seeds = static_cast<Index>(seeds.size());
        refinement.insert(seeds);
        double progress = 0.6;
        double most = 0.0;  // samples; set when the size of all facets is right for the first time
        while (true) {
            kernel::report(execution, kStage, progress);
            refinement.label(are_seeds_dense ? kSeedCovering * tolerance : std::numeric_limits<double>::infinity());
            std::vector<Point> batch = refinement.bad_points(options.seed);
            if (batch.empty()) {
                most = most > 0.0 ? most : options.growth_limit * static_cast<double>(refinement.points());
                const auto limit = [&](std::vector<Point> points, Index& count) {
                    if (static_cast<double>(refinement.points() + points.size()) > most) {
                        refinement.statistics().is_growth_limited |= !points.empty();
                        points.clear();
                    }
                    count += static_cast<Index>(points.size());
                    return points;
                };
                if (options.suits_features) {
                    batch = limit(refinement.feature_points(options.seed), refinement.statistics().feature_samples);
                }
                if (batch.empty() && (options.limits_deviation || std::isfinite(options.facet_distance))) {
                    batch = limit(
                        refinement.deviation_points(options.facet_distance, options.limits_deviation, options.seed),
                        refinement.statistics().deviation_samples);
                }
            }
            if (batch.empty() && options.needs_manifold) {
                batch = refinement.manifold_points(options.seed);
                refinement.statistics().manifold_samples += static_cast<Index>(batch.size());
            }
            if (batch.empty()) {
                break;
            }
            refinement.insert(batch);
            ++refinement.statistics().rounds;
            progress += 0.5 * (1.0 - progress);
        }
        Samples samples = std::move(refinement).finish();
        count_umbrellas(samples);
        kernel::report(execution, kStage, 1.0);
        return samples;
    });
}

}  // namespace scaleaxis
