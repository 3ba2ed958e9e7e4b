// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sampling.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "sampling/creases.hpp"
#include "sampling/facet_criteria.hpp"
#include "sampling/labelled_triangulation.hpp"
#include "sampling/questions.hpp"
#include "sampling/size_field.hpp"
#include "sampling/thin_sizes.hpp"
#include "sampling/umbrellas.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/poisson_disk.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Distance of the first samples, in tolerances. With `kUniform` a larger one needs fewer samples, but from 1.2 on the
// first triangulation is too coarse for labels to spread from tetrahedron to tetrahedron.
constexpr double kUniformSpacing = 1.0;

// With `kAdaptive` it is that of a solid with radii of a thirteenth of the diagonal (`size_field`), so that few samples
// are more than are needed, but not less than this: parts would be lost that are then to be found again.
constexpr double kLeastSpacing = 4.0;
constexpr double kSpacingOfDiagonal = 1.0 / 16.0;

// Spacing of the seeds, of which the first samples are chosen, and at which parts are found that these miss: about 0.6
// seeds for each square of the tolerance.
constexpr double kSeedSpacing = 4.0;

// Of both where a solid gives hardly more seeds than such a sample has: so few do not tell what is lost.
constexpr double kSparseSpacing = 2.0;

// No point of the surface is taken to be farther than this from the first samples, in their spacings: labels rely on
// it. Conflicts show where it does not hold.
constexpr double kSeedCovering = 1.5;

// Facets with surface Delaunay balls smaller than this, in tolerances, are not refined to make the surface a manifold.
constexpr double kManifoldFloor = 1.0 / 32.0;

// How far from the centre of a ball in a thin part samples follow it, in tolerances: no point of the boundary is
// farther than half a tolerance from the union, and the rest is for what is thick.
constexpr double kReachOfThin = 1.0;

// An estimate above this many times the samples allowed saves making them: vertices of fine meshes are seeds, too.
constexpr double kClearlyTooMany = 2.0;

// Seeds of all of a solid, of which those in thin parts are samples: they take 240 MB.
constexpr double kMostThinSeeds = 1e7;

// Where a solid gives no seeds: how many random points are tried to find some that are inside.
constexpr std::uint64_t kBlindTries = 1 << 20;
constexpr std::size_t kBlindSeeds = 64;

// Refinement takes a few rounds, up to a hundred with all criteria. It takes more only where answers of the solid
// contradict each other.
constexpr Index kMaxRounds = 1000;

/// A reason for more samples.
struct Criterion {
    /// The samples that it asks for now; none where it holds.
    std::function<std::vector<Point>(LabelledTriangulation&)> missing_samples;
    Index* count = nullptr;     ///< of samples inserted for it
    bool is_desirable = false;  ///< it is dropped where the samples would grow too many, the others must hold
};

/// What refinement may take.
struct Budget {
    double growth = 2.0;  ///< samples, times those at the time when all criteria that must hold first do
    Index samples = 0;    ///< in all
    Index rounds = 0;
};

/// How refinement ended.
struct Refined {
    Index rounds = 0;
    bool is_growth_limited = false;  ///< a desirable criterion was dropped
};

void check_budget(const Budget& budget, std::size_t samples, Index rounds) {
    if (samples > static_cast<std::size_t>(budget.samples)) {
        throw UnusableInput(Diagnostic{
            "sampling.samples", "the boundary of the solid takes more than " + std::to_string(budget.samples) +
                                    " samples (" + std::to_string(samples) + " after " + std::to_string(rounds) +
                                    " rounds): choose a larger tolerance; if the solid is not as large as that, its "
                                    "answers contradict each other"});
    }
    if (rounds >= budget.rounds) {
        throw UnusableInput(Diagnostic{"sampling.rounds", "the sampling has not come to an end after " +
                                                              std::to_string(rounds) + " rounds of refinement, with " +
                                                              std::to_string(samples) +
                                                              " samples: the solid's answers contradict each other"});
    }
}

/// Inserts samples until all criteria hold, of several the first one first.
Refined refine(LabelledTriangulation& triangulation, std::span<const Criterion> criteria, Creases& creases,
               const Budget& budget, const Execution& execution) {
    Refined result;
    double most = 0.0;  // samples; set when a desirable criterion is asked for the first time
    const auto next_samples = [&]() -> std::vector<Point> {
        for (const Criterion& criterion : criteria) {
            if (criterion.is_desirable && most == 0.0) {
                most = budget.growth * static_cast<double>(triangulation.points());
            }
            const std::vector<Point> missing = criterion.missing_samples(triangulation);
            const bool is_too_many =
                criterion.is_desirable && static_cast<double>(triangulation.points() + missing.size()) > most;
            if (is_too_many) {
                result.is_growth_limited |= !missing.empty();
            } else if (std::vector<Point> samples = creases.making_way(missing); !samples.empty()) {
                if (criterion.count != nullptr) {
                    *criterion.count += static_cast<Index>(samples.size());
                }
                return samples;
            }
        }
        return {};
    };
    double progress = 0.6;
    report(execution, "sampling", progress);
    for (std::vector<Point> samples = next_samples(); !samples.empty(); samples = next_samples()) {
        check_budget(budget, triangulation.points() + samples.size(), result.rounds);
        triangulation.insert(samples);
        ++result.rounds;
        progress += 0.5 * (1.0 - progress);
        report(execution, "sampling", progress);
    }
    return result;
}

// Points of the boundary on random rays from random inside points.
std::vector<Point> blind_seeds(const Solid& solid, std::uint64_t seed) {
    constexpr std::uint64_t kBatch = 256;
    const Box box = solid.bounds();
    const Point extent = box.max - box.min;
    std::vector<Point> seeds;
    for (std::uint64_t first = 0; first < kBlindTries && seeds.size() < kBlindSeeds; first += kBatch) {
        stop_if_cancelled();
        std::vector<Point> places;
        for (std::uint64_t i = first; i < first + kBatch; ++i) {
            const auto coordinate = [&](std::uint64_t k) { return random_unit(seed, i, k); };
            places.push_back(box.min +
                             Point{extent.x * coordinate(0), extent.y * coordinate(1), extent.z * coordinate(2)});
        }
        const std::vector<std::uint8_t> sides = sides_of(solid, places);
        std::vector<Chord> chords;
        for (std::uint64_t k = 0; k < kBatch; ++k) {
            if (sides[k] != 0) {
                const auto coordinate = [&](std::uint64_t axis) { return random_unit(seed, first + k, axis) - 0.5; };
                const Point direction{coordinate(3), coordinate(4), coordinate(5)};
                const Point end = places[k] + (2.0 * box.diagonal() / norm(direction)) * direction;
                chords.push_back({places[k], end, end});
            }
        }
        for (const std::optional<Point>& crossing : crossings_of(solid, chords)) {
            if (crossing && seeds.size() < kBlindSeeds) {
                seeds.push_back(*crossing);
            }
        }
    }
    return seeds;
}

void validate(const Solid& solid, const SamplingOptions& options) {
    const double diagonal = solid.bounds().diagonal();
    if (!(diagonal > 0.0) || !std::isfinite(diagonal)) {
        throw UnusableInput("the solid is empty or not bounded: its bounding box has no finite diagonal");
    }
    require(options.tolerance > 0.0 && std::isfinite(options.tolerance),
            "the sampling tolerance must be a positive length");
    require(options.facet_distance > 0.0, "the distance of the surface from its facets must be a positive length");
    require(options.growth_limit >= 1.0,
            "the growth of the number of samples must be limited to a factor of 1 at least");
    for (const auto& [a, b] : options.creases) {
        require(is_finite(a) && is_finite(b), "the creases must have finite coordinates");
    }
    require(options.max_samples >= 1, "the largest number of samples must be at least 1");
}

/// Known points of the boundary, and those of them that the triangulation begins with.
struct FirstSamples {
    std::vector<Point> seeds;
    std::vector<Point> samples;
    double spacing = 0.0;   ///< of the samples
    bool are_dense = true;  ///< no point of the boundary is much farther from a sample than the spacing
};

// In thin parts first samples are as close together as facets may be large there: coarser ones show nothing inside.
void sample_densely(FirstSamples& first, const Solid& solid, const ThinSizes& thin, const SamplingOptions& options,
                    const Execution& execution) {
    // There will be about as many samples there as seeds.
    const double times = (options.tolerance / thin.least()) * (options.tolerance / thin.least());
    const auto near = std::ranges::count_if(first.seeds, [&](const Point& p) { return thin.at(p).has_value(); });
    if (static_cast<double>(near) * times > kClearlyTooMany * options.max_samples ||
        static_cast<double>(first.seeds.size()) * times > kMostThinSeeds) {
        throw UnusableInput(Diagnostic{"sampling.samples", "thin parts of the solid take too many samples"});
    }
    std::erase_if(first.samples, [&](const Point& p) { return thin.at(p).has_value(); });
    append(first.samples,
           thin_part_samples(solid.seeds(kSeedSpacing * thin.least(), options.seed, execution), thin, options.seed));
}

FirstSamples first_samples(const Solid& solid, const SamplingOptions& options, const Creases& creases,
                           const Execution& execution) {
    const double tolerance = options.tolerance;
    FirstSamples first;
    const auto choose = [&](double seed_spacing, double spacing) {
        first.spacing = spacing * tolerance;
        first.seeds = solid.seeds(seed_spacing * tolerance, options.seed, execution);
        if (first.seeds.empty()) {
            first.are_dense = false;
            first.spacing = kUniformSpacing * tolerance;  // nothing would show what is lost
            first.seeds = blind_seeds(solid, options.seed);
        }
        first.samples = poisson_disk_subset(creases.apart(first.seeds), first.spacing, options.seed);
    };
    if (options.sizing == Sizing::kUniform) {
        choose(kUniformSpacing, kUniformSpacing);
        return first;
    }
    const double diagonal = solid.bounds().diagonal() / tolerance;
    choose(kSeedSpacing, std::max(kLeastSpacing, std::sqrt(kSpacingOfDiagonal * diagonal)));
    if (first.are_dense && 2 * first.samples.size() > first.seeds.size()) {
        choose(kSparseSpacing, kSparseSpacing);
    }
    return first;
}

/// The criteria that the options ask for, in the order in which they are to hold.
std::vector<Criterion> criteria_of(const SamplingOptions& options, FirstSamples first, const Creases& creases,
                                   const ThinSizes& thin, SamplingStatistics& statistics) {
    const double tolerance = options.tolerance;
    const std::uint64_t seed = options.seed;
    std::vector<Criterion> criteria;
    if (options.sizing == Sizing::kUniform) {
        criteria.push_back({[=, &statistics](LabelledTriangulation& triangulation) {
            return uniform_samples(triangulation, tolerance, seed, statistics);
        }});
    } else {
        criteria.push_back({[=, &statistics, &thin, largest = first.spacing,
                             facets = std::vector<CrossedFacet>()](LabelledTriangulation& triangulation) mutable {
            return adaptive_samples(triangulation, facets, tolerance, largest, thin, seed, statistics);
        }});
        criteria.push_back({[=, points = std::move(first.seeds)](LabelledTriangulation& triangulation) mutable {
                                return far_samples(triangulation, points, tolerance, seed);
                            },
                            &statistics.far_samples});
    }
    if (!creases.pieces().empty()) {
        criteria.push_back({[=, &creases, &statistics](LabelledTriangulation& triangulation) {
                                return crease_samples(triangulation, creases, tolerance, seed, statistics);
                            },
                            nullptr, true});
    }
    if (std::isfinite(options.facet_distance)) {
        criteria.push_back({[=, &statistics, since = Index{0}](LabelledTriangulation& triangulation) mutable {
                                return deviation_samples(triangulation, options,
                                                         std::exchange(since, triangulation.rounds()), statistics);
                            },
                            &statistics.deviation_samples, true});
    }
    if (options.needs_manifold || options.sizing == Sizing::kAdaptive) {
        // Of facets as large as balls allow some are too large for a manifold, down to the size of uniform ones.
        const double floor = options.needs_manifold ? kManifoldFloor : kLeastSize;
        criteria.push_back({[=, &statistics, attempt = Index{0}](LabelledTriangulation& triangulation) mutable {
                                return manifold_samples(triangulation, tolerance, floor, attempt++, seed, statistics);
                            },
                            &statistics.manifold_samples});
    }
    return criteria;
}

Samples samples_of(const Solid& solid, const SamplingOptions& options, const ThinSizes& thin,
                   const Execution& execution) {
    validate(solid, options);
    return in_arena(execution, [&] {
        const double tolerance = options.tolerance;
        report(execution, "sampling", 0.0);
        Creases creases(options.creases, tolerance);
        FirstSamples first = first_samples(solid, options, creases, execution);
        if (!thin.empty()) {
            sample_densely(first, solid, thin, options, execution);
        }
        std::vector<Point> seeds = std::move(first.samples);
        append(seeds, creases.samples());
        if (seeds.empty()) {
            throw UnusableInput("no point of the solid's boundary was found: it has no volume to speak of");
        }
        report(execution, "sampling", 0.2);

        const Budget budget{options.growth_limit, options.max_samples, kMaxRounds};
        check_budget(budget, seeds.size(), 0);
        SamplingStatistics statistics;
        statistics.seeds = static_cast<Index>(seeds.size());
        const double covering = first.are_dense ? kSeedCovering * first.spacing : kInfinity;
        LabelledTriangulation triangulation(solid, tolerance, covering);
        triangulation.insert(seeds);
        const Refined refined = refine(triangulation, criteria_of(options, std::move(first), creases, thin, statistics),
                                       creases, budget, execution);
        statistics.rounds = refined.rounds;
        statistics.is_growth_limited = refined.is_growth_limited;
        statistics.inside_queries = triangulation.inside_queries();

        Samples samples = std::move(triangulation).finish();
        samples.tolerance = tolerance;
        samples.statistics = statistics;
        count_facets(samples);
        report(execution, "sampling", 1.0);
        return samples;
    });
}

}  // namespace

Samples sample(const Solid& solid, const SamplingOptions& options, const Execution& execution) {
    return samples_of(solid, options, {{}, 0.0}, execution);
}

Samples sample_thin_parts(const Solid& solid, const SamplingOptions& options, std::span<const Ball> thin,
                          const Execution& execution) {
    return samples_of(solid, options, {thin, kReachOfThin * options.tolerance}, execution);
}

}  // namespace scaleaxis::inline v1
