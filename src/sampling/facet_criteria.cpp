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
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "sampling/size_field.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/point_tree.hpp"
#include "spatial/poisson_disk.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Points of one batch keep this distance, in tolerances: closer ones would be of no use for each other.
constexpr double kBatchSpacing = 0.7;

// Facets with surface Delaunay balls smaller than this, in tolerances, are not refined to follow the surface.
constexpr double kDeviationFloor = 1.0 / 8.0;

// Points whose sizes the solid tells keep this part of the larger one's distance: one sample halves a facet, and more
// than that would be of no use.
constexpr double kPartOfSize = 0.5;

// A facet is flat if its crossing is closer to its plane than this part of the radius of its surface Delaunay ball.
constexpr double kFlat = 0.01;

// How often points are looked for around samples without facets.
constexpr Index kMaxStrayRounds = 6;

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

struct SizedPoint {
    Point place;
    double size = 0.0;
};

/// In classes by powers of two of their sizes, from the largest on, points that are not closer than `apart` times the
/// largest size of their class. \param first the class to begin with, where no size is larger \param floor smaller ones
/// are left out
std::vector<Point> thinned(std::span<const SizedPoint> points, double first, double floor, double apart,
                           std::uint64_t seed) {
    double largest = first;
    for (const SizedPoint& point : points) {
        largest = std::max(largest, point.size);
    }
    std::vector<Point> result;
    for (double size = largest; size > floor; size *= 0.5) {
        std::vector<Point> batch;
        for (const SizedPoint& point : points) {
            if (point.size <= size && point.size > std::max(0.5 * size, floor)) {
                batch.push_back(point.place);
            }
        }
        append(result, poisson_disk_subset(batch, apart * size, seed));
    }
    return result;
}

/// The crossings of those facets whose surface Delaunay balls are larger than `floor`, none much closer to another than
/// its ball is large.
std::vector<Point> thinned(const std::vector<CrossedFacet>& facets, double tolerance, double floor,
                           std::uint64_t seed) {
    std::vector<SizedPoint> points(facets.size());
    std::ranges::transform(facets, points.begin(), [](const CrossedFacet& facet) {
        return SizedPoint{facet.crossing, facet.radius};
    });
    return thinned(points, tolerance, floor, 0.5 * kBatchSpacing, seed);
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
                                 double tolerance, double floor, Index attempt, std::uint64_t seed) {
    std::vector<std::vector<Point>> found(strays.size());
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

bool is_far_from_plane(const CrossedFacet& facet, const LabelledTriangulation& triangulation, double distance) {
    const Point a = triangulation.point(facet.vertices[0]);
    const Point normal = cross(triangulation.point(facet.vertices[1]) - a, triangulation.point(facet.vertices[2]) - a);
    return std::abs(dot(normal, facet.crossing - a)) / norm(normal) > distance;
}

std::vector<Point> uniform_samples(LabelledTriangulation& triangulation, double tolerance, std::uint64_t seed,
                                   SamplingStatistics& statistics) {
    std::vector<CrossedFacet> facets = ask_fresh_facets(triangulation, tolerance, statistics);
    std::erase_if(facets, [&](const CrossedFacet& facet) { return !is_too_large(facet, tolerance); });
    const auto points = each_of<Point>(sorted(std::move(facets)), &CrossedFacet::crossing);
    return poisson_disk_subset(points, kBatchSpacing * tolerance, seed);
}

std::vector<Point> adaptive_samples(LabelledTriangulation& triangulation, std::vector<CrossedFacet>& facets,
                                    double tolerance, double largest, const ThinSizes& thin, std::uint64_t seed,
                                    SamplingStatistics& statistics) {
    ask_again(facets, triangulation, largest, statistics);
    const std::vector<FacetSize> sizes = size_field(triangulation, facets, tolerance, largest, thin);
    std::vector<std::pair<Facet, SizedPoint>> bad;
    for (const CrossedFacet& facet : facets) {
        const auto& [a, b, c] = facet.vertices;
        const FacetSize allowed = std::min({sizes[a], sizes[b], sizes[c]});
        if (is_too_large(facet, allowed.length)) {
            ++(allowed.bound == SizeBound::kThickness ? statistics.thickness_facets
               : allowed.bound == SizeBound::kGap     ? statistics.gap_facets
                                                      : statistics.dip_facets);
        } else if (is_too_large(facet, kLeastSize * tolerance) &&
                   is_far_from_plane(facet, triangulation, kSamplingError * tolerance)) {
            ++statistics.bent_facets;
        } else {
            continue;
        }
        bad.push_back({facet.vertices, {facet.crossing, std::max(0.5 * facet.radius, allowed.length)}});
    }
    std::ranges::sort(bad, {}, &std::pair<Facet, SizedPoint>::first);
    const auto points = each_of<SizedPoint>(bad, &std::pair<Facet, SizedPoint>::second);
    return thinned(points, 0.0, 0.5 * std::min(kLeastSize * tolerance, thin.least()), kPartOfSize, seed);
}

std::vector<Point> thin_part_samples(std::span<const Point> points, const ThinSizes& thin, std::uint64_t seed) {
    std::vector<SizedPoint> sized;
    for (const Point& point : points) {
        if (const std::optional<double> size = thin.at(point)) {
            sized.push_back({point, *size});
        }
    }
    return thinned(sized, 0.0, 0.0, kBatchSpacing, seed);
}

std::vector<Point> far_samples(const LabelledTriangulation& triangulation, std::vector<Point>& points, double tolerance,
                               std::uint64_t seed) {
    points = far_from_balls(std::span<const Point>(points), triangulation.inner_balls(), kSamplingError * tolerance,
                            [](const Point& p) { return p; });
    if (points.empty()) {
        return {};
    }
    const auto samples = mapped<Point>(triangulation.points(),
                                       [&](std::size_t v) { return triangulation.point(static_cast<Index>(v)); });
    const PointTree tree = build_point_tree(samples);
    // Parts without balls are found at once, and then sampled more and more densely.
    const auto sized = mapped<SizedPoint>(points.size(), [&](std::size_t i) {
        return SizedPoint{points[i], std::sqrt(nearest_point(tree, points[i]).squared_distance)};
    });
    return thinned(sized, 0.0, 0.5 * kLeastSize * tolerance, kPartOfSize, seed);
}

std::vector<Point> deviation_samples(const LabelledTriangulation& triangulation, const SamplingOptions& options,
                                     Index since, SamplingStatistics& statistics) {
    const double floor = kDeviationFloor * options.tolerance;
    const std::vector<std::uint8_t> is_changed = triangulation.vertices_changed_since(since);
    const std::vector<RestrictedFacet> facets =
        facets_where(triangulation, triangulation.restricted_facets(), [&](const Facet& vertices) {
            return std::ranges::any_of(vertices, [&](Index v) { return is_changed[v] != 0; });
        });
    AskedFacets asked = ask_facets(triangulation, facets, statistics, [&](const CrossedFacet& facet) {
        return facet.radius > floor && is_far_from_plane(facet, triangulation, options.facet_distance);
    });
    return thinned(sorted(std::move(asked.crossed)), options.tolerance, floor, options.seed);
}

std::vector<Point> crease_samples(const LabelledTriangulation& triangulation, const Creases& creases, double tolerance,
                                  std::uint64_t seed, SamplingStatistics& statistics) {
    // Pieces, and vertices on creases, by their positions among the samples of the creases.
    const auto position = mapped<Index>(triangulation.points(), [&](std::size_t v) {
        return creases.position_of(triangulation.point(static_cast<Index>(v)));
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
    const double floor = kDeviationFloor * tolerance;
    const AskedFacets asked = ask_facets(triangulation, facets, statistics, [&](const CrossedFacet& facet) {
        return facet.radius > floor && is_far_from_plane(facet, triangulation, kFlat * facet.radius);
    });
    for (const CrossedFacet& facet : asked.crossed) {
        for (const Index v : facet.vertices) {
            if (position[v] != kNone) {
                is_end[position[v]] = 0;
            }
        }
    }
    std::vector<Point> points = thinned(sorted(asked.crossed), tolerance, floor, seed);
    for (const auto& [a, b] : missing) {
        if (is_end[a] != 0 && is_end[b] != 0) {
            points.push_back(midpoint(creases.samples()[a], creases.samples()[b]));
        }
    }
    return points;
}

std::vector<Point> manifold_samples(const LabelledTriangulation& triangulation, double tolerance, double floor,
                                    Index attempt, std::uint64_t seed, SamplingStatistics& statistics) {
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
    const AskedFacets around =
        ask_facets(triangulation,
                   facets_where(triangulation, facets,
                                [&](const Facet& facet) { return std::ranges::any_of(facet, is_irregular); }),
                   statistics, [](const CrossedFacet&) { return true; });
    for (const CrossedFacet& facet : around.crossed) {
        for (const Index v : facet.vertices) {
            const bool is_wider =
                facet.radius > radii[v] || (facet.radius == radii[v] && facet.vertices < widest[v].vertices);
            if (is_irregular(v) && is_wider) {
                radii[v] = facet.radius;
                widest[v] = facet;
            }
        }
    }
    const auto of_irregular = each_of<CrossedFacet>(irregular, [&](Index v) { return widest[v]; });
    std::vector<Point> points = thinned(of_irregular, tolerance, floor * tolerance, seed);
    if (attempt < kMaxStrayRounds) {
        append(points, points_around(triangulation, strays(triangulation, irregular, radii), tolerance,
                                     floor * tolerance, attempt, seed));
    }
    return points;
}

}  // namespace scaleaxis::inline v1
