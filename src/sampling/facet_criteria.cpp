// SPDX-License-Identifier: Apache-2.0
#include "sampling/facet_criteria.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "sampling/questions.hpp"
#include "spatial/poisson_disk.hpp"

namespace scaleaxis {
namespace {

// Where the samples are sparser than labels rely on, labels are in doubt whose circumspheres are smaller than this, in
// tolerances: the group of a larger one has been asked for at one that is deeper still.
constexpr double kDoubtfulRadius = 3.0;

// Points of one batch keep this distance, in tolerances: closer ones would be of no use for each other.
constexpr double kBatchSpacing = 0.7;

// Facets with surface Delaunay balls smaller than this, in tolerances, are not refined to make the surface a manifold.
constexpr double kManifoldFloor = 1.0 / 32.0;

// The same where facets are refined for the features of the solid or for its balls.
constexpr double kFeatureFloor = 1.0 / 8.0;

// The union of the balls may be so far from the surface, in tolerances. Much less takes samples without end.
constexpr double kDeviation = 0.25;

// A facet is flat if its crossing is closer to its plane than this part of the radius of its surface Delaunay ball.
constexpr double kFlat = 0.01;

// How often points are looked for around samples without facets.
constexpr Index kMaxStrayRounds = 6;

/// What became of facets that were asked for.
struct FacetCheck {
    std::vector<CrossedFacet> bad;
    std::vector<RestrictedFacet> uncrossed;  ///< their dual edges do not cross the surface: a label is wrong
};

FacetCheck join(std::vector<FacetCheck>& parts) {
    return {joined(parts, &FacetCheck::bad), joined(parts, &FacetCheck::uncrossed)};
}

/// Asks for the crossings of all facets, and tells which are bad.
template <class IsBad>
FacetCheck check_facets(const LabelledTriangulation& triangulation, std::span<const RestrictedFacet> facets,
                        SamplingStatistics& statistics, const IsBad& is_bad) {
    statistics.crossing_queries += static_cast<std::int64_t>(facets.size());
    return collect_crossings<FacetCheck>(
        triangulation.solid(), facets.size(), [&](std::size_t f) { return triangulation.dual_edge(facets[f]); },
        [&](std::size_t f, const Chord& chord, const std::optional<Point>& crossing, FacetCheck& out) {
            if (!crossing) {
                out.uncrossed.push_back(facets[f]);
                return;
            }
            const CrossedFacet facet{triangulation.vertices(facets[f]), *crossing,
                                     distance(*crossing, chord.reference)};
            if (is_bad(facet)) {
                out.bad.push_back(facet);
            }
        });
}

/// The facets of which `is_wanted` says so for the vertices.
template <class IsWanted>
std::vector<RestrictedFacet> facets_where(const LabelledTriangulation& triangulation,
                                          const std::vector<RestrictedFacet>& facets, const IsWanted& is_wanted) {
    return collect<std::vector<RestrictedFacet>>(facets.size(), [&](std::size_t f, std::vector<RestrictedFacet>& out) {
        if (is_wanted(triangulation.vertices(facets[f]))) {
            out.push_back(facets[f]);
        }
    });
}

/// In the canonical order.
std::vector<CrossedFacet> sorted(std::vector<CrossedFacet> facets) {
    std::ranges::sort(facets, {}, &CrossedFacet::vertices);
    return facets;
}

/// The crossings of those facets whose surface Delaunay balls are larger than `floor`, none much closer to another than
/// its ball is large.
std::vector<Point> thinned(const std::vector<CrossedFacet>& facets, double tolerance, double floor,
                           std::uint64_t seed) {
    std::vector<Point> points;
    for (double radius = tolerance; radius > floor; radius *= 0.5) {
        std::vector<Point> batch;
        for (const CrossedFacet& facet : facets) {
            if (facet.radius <= radius && facet.radius > std::max(0.5 * radius, floor)) {
                batch.push_back(facet.crossing);
            }
        }
        append(points, poisson_disk_subset(batch, 0.5 * kBatchSpacing * radius, seed));
    }
    return points;
}

/// The cells on both sides of facets, in pairs.
std::vector<Index> cells_beside(const LabelledTriangulation& triangulation, std::span<const RestrictedFacet> facets) {
    std::vector<Index> cells;
    for (const RestrictedFacet& facet : facets) {
        const Index neighbor = triangulation.neighbor(facet);
        append(cells, {facet.cell, neighbor != kNone ? neighbor : facet.cell});
    }
    return cells;
}

/// Facets that no label explains: their dual edges cross the surface nowhere, although one end was said to be inside
/// and the other one outside. Their circumcentres lie on the surface to within rounding, and bisection finds it.
std::vector<CrossedFacet> bisected(const LabelledTriangulation& triangulation,
                                   std::span<const RestrictedFacet> facets) {
    constexpr int kSteps = 60;
    std::vector<Point> inside(facets.size());
    std::vector<Point> outside(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const Chord chord = triangulation.dual_edge(facets[f]);
        inside[f] = chord.inside_end;
        outside[f] = chord.outside_end;
    }
    std::vector<Point> middles(facets.size());
    for (int step = 0; step < kSteps && !facets.empty(); ++step) {
        std::ranges::transform(inside, outside, middles.begin(), midpoint);
        const std::vector<std::uint8_t> sides = sides_of(triangulation.solid(), middles);
        for (std::size_t f = 0; f < facets.size(); ++f) {
            (sides[f] != 0 ? inside : outside)[f] = middles[f];
        }
    }
    std::vector<CrossedFacet> result;
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const Facet vertices = triangulation.vertices(facets[f]);
        result.push_back({vertices, inside[f], distance(inside[f], triangulation.point(vertices[0]))});
    }
    return result;
}

/// A random direction.
Point direction(std::uint64_t seed, std::uint64_t i, std::uint64_t k) {
    const auto coordinate = [&](std::uint64_t axis) { return random_unit(seed, i, 3 * k + axis) - 0.5; };
    return unit({coordinate(0), coordinate(1), coordinate(2)});
}

/// Crossings around samples, at about `length` from each, on segments from random points inside near it.
/// \param seeds of each sample
std::vector<std::vector<Point>> crossings_around(const Solid& solid, std::span<const Point> samples,
                                                 std::span<const std::uint64_t> seeds, double length, double floor) {
    constexpr std::uint64_t kTries = 8;
    std::vector<Point> starts;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        for (std::uint64_t i = 0; i < kTries; ++i) {
            starts.push_back(samples[s] + length * direction(seeds[s], i, 0));
        }
    }
    const std::vector<std::uint8_t> is_inside = sides_of(solid, starts);
    std::vector<Chord> chords;
    std::vector<std::size_t> sample_of_chord;
    for (std::size_t start = 0; start < starts.size(); ++start) {
        const std::size_t s = start / kTries;
        for (std::uint64_t k = 1; is_inside[start] != 0 && k <= kTries; ++k) {
            const Point end = starts[start] + 4.0 * length * direction(seeds[s], start % kTries, k);
            chords.push_back({starts[start], end, samples[s]});
            sample_of_chord.push_back(s);
        }
    }
    const std::vector<std::optional<Point>> crossings = crossings_of(solid, chords);
    std::vector<std::vector<Point>> result(samples.size());
    for (std::size_t c = 0; c < chords.size(); ++c) {
        const std::size_t s = sample_of_chord[c];
        if (crossings[c] && distance(*crossings[c], samples[s]) > floor) {
            result[s].push_back(*crossings[c]);
        }
    }
    for (std::size_t s = 0; s < samples.size(); ++s) {
        result[s] = poisson_disk_subset(result[s], 0.25 * length, seeds[s]);
    }
    return result;
}

/// A part of the boundary so small that it has one sample only is found from points inside near the sample, if there
/// are any: at half the distance where there are none.
std::vector<Point> points_around(const LabelledTriangulation& triangulation, const std::vector<Index>& strays,
                                 double tolerance, Index attempt, std::uint64_t seed) {
    std::vector<std::vector<Point>> found(strays.size());
    const double floor = kManifoldFloor * tolerance;
    for (double length = std::ldexp(tolerance, -attempt); length > floor; length *= 0.5) {
        std::vector<std::size_t> pending;
        std::vector<Point> samples;
        std::vector<std::uint64_t> seeds;
        for (std::size_t s = 0; s < strays.size(); ++s) {
            if (found[s].empty()) {
                pending.push_back(s);
                samples.push_back(triangulation.point(strays[s]));
                seeds.push_back(random_bits(seed, strays[s], attempt + 1));
            }
        }
        std::vector<std::vector<Point>> crossings =
            crossings_around(triangulation.solid(), samples, seeds, length, floor);
        for (std::size_t i = 0; i < pending.size(); ++i) {
            found[pending[i]] = std::move(crossings[i]);
        }
    }
    return join(found);
}

/// Of samples without facets those that have no cell inside: all that there is of a part of the solid. (One without a
/// cell outside lies in a crevice that the cells bridge. More samples there would tear holes into the bridge.)
std::vector<Index> strays(const LabelledTriangulation& triangulation, const std::vector<Index>& irregular,
                          const std::vector<double>& facet_radii) {
    const std::vector<std::uint8_t> has_inside = triangulation.vertices_of_inside_cells();
    std::vector<Index> result;
    std::ranges::copy_if(irregular, std::back_inserter(result),
                         [&](Index v) { return facet_radii[v] == 0.0 && has_inside[v] == 0; });
    return result;
}

}  // namespace

bool is_too_large(const CrossedFacet& facet, double tolerance) { return facet.radius > tolerance; }

bool is_too_large_for_features(const CrossedFacet& facet, const std::vector<double>& pole_distances) {
    const auto& [a, b, c] = facet.vertices;
    return facet.radius > std::min({pole_distances[a], pole_distances[b], pole_distances[c]});
}

bool is_far_from_plane(const CrossedFacet& facet, const LabelledTriangulation& triangulation, double distance) {
    const Point a = triangulation.point(facet.vertices[0]);
    const Point normal = cross(triangulation.point(facet.vertices[1]) - a, triangulation.point(facet.vertices[2]) - a);
    return std::abs(dot(normal, facet.crossing - a)) / norm(normal) > distance;
}

bool is_far_from_balls(const CrossedFacet& facet, const BallTree& balls, double distance) {
    return std::abs(nearest_ball(balls, facet.crossing).distance) > distance;
}

// If the solid corrects a label beside an uncrossed facet, the samples are sparser than labels rely on, and it is asked
// for every fresh cell near the surface; if that was not enough, for all of them.
std::vector<Point> size_samples(LabelledTriangulation& triangulation, double tolerance, std::uint64_t seed,
                                SamplingStatistics& statistics) {
    const auto check = [&] {
        return check_facets(triangulation, triangulation.fresh_restricted_facets(), statistics,
                            [&](const CrossedFacet& facet) { return is_too_large(facet, tolerance); });
    };
    const auto relabel = [&](std::span<const Index> cells) {
        const Index corrected = triangulation.relabel(cells);
        statistics.relabelled += corrected;
        return corrected > 0;
    };
    FacetCheck facets = check();
    statistics.conflicts += static_cast<Index>(facets.uncrossed.size());
    if (relabel(cells_beside(triangulation, facets.uncrossed))) {
        std::vector<Index> doubtful;
        std::ranges::copy_if(triangulation.fresh_cells(), std::back_inserter(doubtful),
                             [&](Index cell) { return triangulation.radius(cell) <= kDoubtfulRadius * tolerance; });
        relabel(doubtful);
        facets = check();
        if (relabel(cells_beside(triangulation, facets.uncrossed))) {
            relabel(triangulation.fresh_cells());
            facets = check();
        }
    }
    for (const CrossedFacet& facet : bisected(triangulation, facets.uncrossed)) {
        if (is_too_large(facet, tolerance)) {
            facets.bad.push_back(facet);
        }
    }
    std::vector<Point> points;
    for (const CrossedFacet& facet : sorted(std::move(facets.bad))) {
        points.push_back(facet.crossing);
    }
    return poisson_disk_subset(points, kBatchSpacing * tolerance, seed);
}

std::vector<Point> feature_samples(const LabelledTriangulation& triangulation, double tolerance, std::uint64_t seed,
                                   SamplingStatistics& statistics) {
    const double floor = kFeatureFloor * tolerance;
    const std::vector<double> sizes = triangulation.pole_distances();
    // Surface Delaunay balls are not larger than the tolerance, which spares most questions.
    const std::vector<RestrictedFacet> facets =
        facets_where(triangulation, triangulation.restricted_facets(), [&](const Facet& v) {
            return std::min({sizes[v[0]], sizes[v[1]], sizes[v[2]]}) < tolerance;
        });
    FacetCheck check = check_facets(triangulation, facets, statistics, [&](const CrossedFacet& facet) {
        return facet.radius > floor && is_too_large_for_features(facet, sizes);
    });
    return thinned(sorted(std::move(check.bad)), tolerance, floor, seed);
}

std::vector<Point> deviation_samples(const LabelledTriangulation& triangulation, const SamplingOptions& options,
                                     Index since, SamplingStatistics& statistics) {
    const double tolerance = options.tolerance;
    const double floor = kFeatureFloor * tolerance;
    std::optional<BallTree> balls;
    if (options.limits_deviation) {
        if (const std::vector<Ball> inner = triangulation.inner_balls(); !inner.empty()) {
            balls = build_ball_tree(inner);
        }
    }
    const std::vector<std::uint8_t> is_changed = triangulation.vertices_changed_since(since);
    const std::vector<RestrictedFacet> facets =
        facets_where(triangulation, triangulation.restricted_facets(), [&](const Facet& vertices) {
            return std::ranges::any_of(vertices, [&](Index v) { return is_changed[v] != 0; });
        });
    FacetCheck check = check_facets(triangulation, facets, statistics, [&](const CrossedFacet& facet) {
        return facet.radius > floor && (is_far_from_plane(facet, triangulation, options.facet_distance) ||
                                        (balls && is_far_from_balls(facet, *balls, kDeviation * tolerance)));
    });
    return thinned(sorted(std::move(check.bad)), tolerance, floor, options.seed);
}

std::vector<Point> crease_samples(const LabelledTriangulation& triangulation, const Creases& creases, double tolerance,
                                  std::uint64_t seed, SamplingStatistics& statistics) {
    // Pieces, and vertices on creases, by their positions among the samples of the creases.
    std::vector<Index> position(triangulation.points());
    for_each_index(position.size(), [&](std::size_t v) {
        position[v] = creases.position_of(triangulation.point(static_cast<Index>(v)));
    });
    const std::vector<RestrictedFacet> all = triangulation.restricted_facets();
    using Ends = std::pair<Index, Index>;
    auto edges = collect<std::vector<Ends>>(all.size(), [&](std::size_t f, std::vector<Ends>& out) {
        const Facet vertices = triangulation.vertices(all[f]);
        for (int k = 0; k < 3; ++k) {
            const Ends ends = std::minmax(position[vertices[k]], position[vertices[(k + 1) % 3]]);
            if (ends.first != kNone && ends.second != kNone) {
                out.push_back(ends);
            }
        }
    });
    std::ranges::sort(edges);
    std::vector<Ends> missing;
    std::vector<char> is_end(creases.samples().size(), 0);
    for (const auto& [a, b] : creases.pieces()) {
        const Ends ends = std::minmax(creases.position_of(a), creases.position_of(b));
        if (!std::ranges::binary_search(edges, ends)) {
            missing.push_back(ends);
            is_end[ends.first] = is_end[ends.second] = 1;
        }
    }
    if (missing.empty()) {
        return {};
    }
    const auto is_at_end = [&](Index v) { return position[v] != kNone && is_end[position[v]] != 0; };
    const std::vector<RestrictedFacet> facets =
        facets_where(triangulation, all, [&](const Facet& facet) { return std::ranges::any_of(facet, is_at_end); });
    const double floor = kFeatureFloor * tolerance;
    const FacetCheck check = check_facets(triangulation, facets, statistics, [&](const CrossedFacet& facet) {
        return facet.radius > floor && is_far_from_plane(facet, triangulation, kFlat * facet.radius);
    });
    for (const CrossedFacet& facet : check.bad) {
        for (const Index v : facet.vertices) {
            if (position[v] != kNone) {
                is_end[position[v]] = 0;
            }
        }
    }
    std::vector<Point> points = thinned(sorted(check.bad), tolerance, floor, seed);
    for (const auto& [a, b] : missing) {
        if (is_end[a] != 0 && is_end[b] != 0) {
            points.push_back(midpoint(creases.samples()[a], creases.samples()[b]));
        }
    }
    return points;
}

std::vector<Point> manifold_samples(const LabelledTriangulation& triangulation, double tolerance, Index attempt,
                                    std::uint64_t seed, SamplingStatistics& statistics) {
    const std::vector<RestrictedFacet> facets = triangulation.restricted_facets();
    std::vector<Facet> vertices(facets.size());
    for_each_index(facets.size(), [&](std::size_t f) { vertices[f] = triangulation.vertices(facets[f]); });
    const std::vector<Index> irregular = irregular_vertices(vertices, triangulation.points());
    std::vector<CrossedFacet> widest(triangulation.points());  // of each irregular sample
    std::vector<double> radii(triangulation.points(), -1.0);
    for (const Index v : irregular) {
        radii[v] = 0.0;
    }
    const auto is_irregular = [&](Index v) { return radii[v] >= 0.0; };
    const FacetCheck around =
        check_facets(triangulation,
                     facets_where(triangulation, facets,
                                  [&](const Facet& facet) { return std::ranges::any_of(facet, is_irregular); }),
                     statistics, [](const CrossedFacet&) { return true; });
    for (const CrossedFacet& facet : around.bad) {
        for (const Index v : facet.vertices) {
            const bool is_wider =
                facet.radius > radii[v] || (facet.radius == radii[v] && facet.vertices < widest[v].vertices);
            if (is_irregular(v) && is_wider) {
                radii[v] = facet.radius;
                widest[v] = facet;
            }
        }
    }
    std::vector<CrossedFacet> of_irregular;
    for (const Index v : irregular) {
        of_irregular.push_back(widest[v]);
    }
    std::vector<Point> points = thinned(of_irregular, tolerance, kManifoldFloor * tolerance, seed);
    if (attempt < kMaxStrayRounds) {
        append(points, points_around(triangulation, strays(triangulation, irregular, radii), tolerance, attempt, seed));
    }
    return points;
}

}  // namespace scaleaxis
