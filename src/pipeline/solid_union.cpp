// SPDX-License-Identifier: Apache-2.0
#include "pipeline/solid_union.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "balls/covering_balls.hpp"
#include "balls/inward_seeds.hpp"
#include "balls/repair.hpp"
#include "balls/thin_balls.hpp"
#include "base/parallel.hpp"
#include "base/powers.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "sampling/thin_sizes.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr const char* kNoBalls = "balls.none";

void check_any(const std::vector<Ball>& balls) {
    if (balls.empty()) {
        throw UnusableInput(Diagnostic{kNoBalls, "no ball fits into the solid at this tolerance: use a smaller delta"});
    }
}

// Uniform samples are taken where adaptive ones lead to the wrong topology, up to this many times as many: what it
// costs to halve delta, which is the advice else.
constexpr double kMostUniformSamples = 4.0;

// More samples than this are not taken for thin parts, by themselves: all stages take about half a minute and 1.5 GB
// with so many.
constexpr double kMostThinSamples = 3e5;

// How often balls that come to light in thin parts lead to more samples there.
constexpr int kThinRounds = 3;

double seconds_of(std::span<const StageCost> costs) {
    double seconds = 0.0;
    for (const StageCost& cost : costs) {
        seconds += cost.seconds;
    }
    return seconds;
}

/// That not all balls are inscribed ones.
void warn_of_polar_balls(SolidUnion& result) {
    const RepairReport& repair = result.fit->repair;
    if (repair.largest_protrusion > 0.0) {
        Words warning;
        warning << counted(std::int64_t{repair.steps.back().added}, "polar ball") << " of the union "
                << (repair.steps.back().added == 1 ? "sticks" : "stick") << " out of the solid, by up to "
                << repair.largest_protrusion
                << ": balls inside it alone leave a tunnel along a crevice much narrower than delta";
        result.warnings.push_back({"axis.polar_balls", warning.str()});
    }
}

/// That the promise does not hold.
void warn_of_far_points(double tolerance, SolidUnion& result) {
    const RepairReport& repair = result.fit->repair;
    if (repair.far_points > 0) {
        Words warning;
        warning << counted(std::int64_t{repair.far_points}, "point") << " of the boundary, of " << repair.points
                << " that were looked at, " << (repair.far_points == 1 ? "is" : "are")
                << " farther than half of delta from the union of balls, which is " << kPromise * tolerance
                << "; the farthest is " << repair.largest_distance << " away, at " << to_text(repair.farthest_point)
                << ": use a smaller delta";
        result.warnings.push_back({"balls.far_points", warning.str()});
    }
}

/// How far samples and contacts may be from the union of the balls that are taken, in tolerances. At twice as much
/// hardly any ball less is taken, and a T profile loses the shape of its junction; at half of it a tenth more are.
constexpr double kReach = 0.05;

/// Of fitted balls as many as it takes to keep the samples, and the contacts of all, within reach of the union.
FittedBalls needed_balls(const FittedBalls& fitted, const Samples& samples) {
    std::vector<Point> points = samples.points;
    for (const Contacts& contacts : fitted.contacts) {
        points.insert(points.end(), contacts.begin(), contacts.end());
    }
    return selected(fitted, covering_balls(fitted.balls, points, kReach * samples.tolerance));
}

void fit_balls(const Samples& samples, const Solid& solid, const UnionOptions& options, SolidUnion& result, Run& run) {
    const double slack = kDefaultSlack * samples.tolerance;
    std::optional<FittedBalls> chosen;
    const FittedBalls fitted = run.stage("fit", 0.5 * kFitWork, result.costs, [&](const Execution& execution) {
        FittedBalls all = fit(result.balls, solid, {slack}, execution);
        check_any(all.balls);
        if (!options.keeps_all) {
            chosen = needed_balls(all, samples);
        }
        return all;
    });
    Index not_needed = 0;
    RepairOptions repair_options;
    repair_options.topology = options.topology;
    repair_options.slack = slack;
    repair_options.perturbation = MedialAxisOptions().perturbation;
    repair_options.seed = options.seed;
    RepairedBalls repaired = run.stage("union repair", 0.4 * kFitWork, result.costs, [&](const Execution& execution) {
        if (chosen && chosen->balls.size() < fitted.balls.size()) {
            if (std::optional<RepairedBalls> balls =
                    repair_at_samples(*chosen, samples, solid, repair_options, part_of(execution, 0.0, 0.5))) {
                not_needed = static_cast<Index>(fitted.balls.size() - chosen->balls.size());
                return std::move(*balls);
            }
        }
        return repair(fitted, samples, solid, repair_options, part_of(execution, 0.5, 1.0));
    });
    result.balls = std::move(repaired.balls);
    result.contacts = std::move(repaired.contacts);
    UnionAccuracy accuracy = run.stage("accuracy", 0.1 * kFitWork, result.costs, [&](const Execution& execution) {
        return union_accuracy(result.balls, result.contacts, samples, execution);
    });
    if (repaired.report.largest_distance > accuracy.largest_distance) {
        accuracy.largest_distance = repaired.report.largest_distance;
        accuracy.farthest_sample = repaired.report.farthest_point;
    }
    result.fit = FitReport{fitted.statistics, std::move(repaired.report), accuracy,
                           thin_part(result.balls, result.contacts, samples.tolerance), not_needed};
    warn_of_polar_balls(result);
    if (options.topology) {
        warn_of_far_points(samples.tolerance, result);
    }
}

/// That samples are too far from each other for what is thin. Thin is what two of them do not fit across.
void warn_of_thin_part(const Solid& solid, double tolerance, SolidUnion& result) {
    std::optional<ThinPart> thin = result.fit ? result.fit->thin_part : std::nullopt;
    if (const std::optional<ThinPart> known = solid.thin_part(); !thin && known && known->thickness < 2.0 * tolerance) {
        thin = known;
    }
    if (thin) {
        Words warning;
        warning << (thin->is_gap ? "a gap in the solid is " : "the solid is ") << thin->thickness << " thick at "
                << to_text(thin->place) << ", less than twice delta, which is " << tolerance
                << ": parts as thin as that may get holes, or be lost, unless delta is half of it";
        result.warnings.push_back({.code = "axis.thin_part",
                                   .message = warning.str(),
                                   .place = thin->place,
                                   .hints = {{"delta-abs", rounded_down(0.5 * thin->thickness)}}});
    }
}

/// See `solid_union`.
SolidUnion polar_or_fitted_union(const Samples& samples, const Solid* solid, const UnionOptions& options, Run& run) {
    SolidUnion result;
    result.balls = run.stage("balls", kBallsWork, result.costs,
                             [&](const Execution& execution) { return inner_balls(samples, execution); });
    check_any(result.balls);
    if (!fits_balls(solid, options.kind)) {
        return result;
    }
    try {
        fit_balls(samples, *solid, options, result, run);
    } catch (const UnusableInput& fault) {
        if (options.kind || fault.diagnostic().code != "solid.nearest") {
            throw;
        }
        result.warnings.push_back({"balls.polar", std::string(fault.what()) + "; polar balls are taken"});
    }
    return result;
}

/// \param thin balls in parts that take more samples
SampledUnion union_of_samples(const Solid& solid, const SamplingOptions& sampling, std::span<const Ball> thin,
                              const UnionOptions& options, Run& run) {
    SampledUnion result;
    result.samples = run.stage("sampling", kSamplingWork, result.costs, [&](const Execution& execution) {
        return thin.empty() ? sample(solid, sampling, execution) : sample_thin_parts(solid, sampling, thin, execution);
    });
    result.topology = solid.topology();
    if (!result.topology) {
        result.topology = topology(result.samples);
    }
    const bool keeps_all = options.keeps_all || sampling.sizing == Sizing::kUniform;
    result.balls = solid_union(result.samples, &solid, {options.kind, result.topology, options.seed, keeps_all}, run);
    append(result.costs, result.balls.costs);
    return result;
}

/// Is the topology of the union known to be another one than that of the solid?
bool has_wrong_topology(const SampledUnion& made) {
    return made.topology && made.balls.fit && !agree(*made.topology, made.balls.fit->repair.topology);
}

/// The union of uniform samples in place of one that has the wrong topology, if they are affordable and it is right.
std::optional<SampledUnion> right_uniform_union(const Solid& solid, SamplingOptions sampling,
                                                const UnionOptions& options, const SampledUnion& adaptive,
                                                const Execution& execution) {
    sampling.sizing = Sizing::kUniform;
    sampling.max_samples =
        static_cast<Index>(std::min(kMostUniformSamples * static_cast<double>(adaptive.samples.points.size()),
                                    static_cast<double>(sampling.max_samples)));
    std::optional<SampledUnion> uniform;
    try {
        Run run(execution, sampled_union_work(true));
        uniform = union_of_samples(solid, sampling, {}, options, run);
        uniform->costs.insert(uniform->costs.begin(), {"adaptive samples", seconds_of(adaptive.costs), peak_memory()});
    } catch (const UnusableInput&) {  // too many samples
        return std::nullopt;
    }
    if (has_wrong_topology(*uniform)) {
        return std::nullopt;
    }
    uniform->balls.warnings.push_back(
        {"axis.uniform_samples",
         "adaptive samples led to a union with another topology than the solid; uniform ones, " +
             std::to_string(uniform->samples.points.size()) + " in place of " +
             std::to_string(adaptive.samples.points.size()) + ", are taken"});
    return uniform;
}

/// Balls in thin parts, where the samples show no inside at all.
std::vector<Ball> thin_balls_at_samples(const Solid& solid, const SamplingOptions& sampling,
                                        const Execution& execution) {
    const Samples samples = sample(solid, sampling, execution);
    const double tolerance = samples.tolerance;
    const FittedBalls fitted = fit(shallow_seeds(ways_inside(samples.points, solid, tolerance), tolerance), solid,
                                   {kDefaultSlack * tolerance}, execution);
    return thin_balls(fitted.balls, fitted.contacts, tolerance);
}

std::vector<Ball> thin_balls_of(const SampledUnion& made) {
    return thin_balls(made.balls.balls, made.balls.contacts, made.samples.tolerance);
}

/// A place in words, and the tolerance that keeps what is there.
Diagnostic too_thin(const std::vector<Ball>& thin, double tolerance) {
    const Ball& thinnest = *std::ranges::min_element(thin, {}, &Ball::radius);
    Words text;
    text << "the solid is " << 2.0 * thinnest.radius << " thick at " << to_text(thinnest.center)
         << ", much less than delta, which is " << tolerance
         << ", and to take samples close enough to each other there would take more than " << kMostThinSamples
         << ": parts as thin as that are lost, or get holes, unless delta is half of it";
    return {.code = "axis.thin_part",
            .message = text.str(),
            .place = thinnest.center,
            .hints = {{"delta-abs", rounded_down(thinnest.radius)}}};
}

/// That samples are closer to each other than others.
Diagnostic thin_samples(const std::vector<Ball>& thin, const SampledUnion& made) {
    const Ball& thinnest = *std::ranges::min_element(thin, {}, &Ball::radius);
    Words text;
    text << "the solid is " << 2.0 * thinnest.radius << " thick at " << to_text(thinnest.center)
         << ", much less than delta, which is " << made.samples.tolerance
         << ": samples are closer to each other in such parts, " << made.samples.points.size() << " in all";
    return {.code = "axis.thin_samples", .message = text.str(), .place = thinnest.center};
}

/// Fewer components too many, or too few, and then fewer tunnels and voids.
bool is_closer(const Topology& a, const Topology& b, const Topology& right) {
    const auto fault = [&](const Topology& t) {
        return std::pair(std::abs(t.components - right.components), std::abs(t.euler - right.euler));
    };
    return fault(a) < fault(b);
}

/// The union of samples that are closer to each other in parts much thinner than the tolerance, if they are affordable
/// and it is better. \param made of other samples; none: these show no inside \param thin balls in thin parts
std::optional<SampledUnion> union_with_thin_parts(const Solid& solid, SamplingOptions sampling,
                                                  const UnionOptions& options, const SampledUnion* made,
                                                  std::vector<Ball> thin, const Execution& execution) {
    sampling.max_samples = static_cast<Index>(std::min(kMostThinSamples, static_cast<double>(sampling.max_samples)));
    std::optional<SampledUnion> best;
    for (int round = 0; round < kThinRounds && !thin.empty(); ++round) {
        SampledUnion denser;
        try {
            Run run(execution, sampled_union_work(true));
            denser = union_of_samples(solid, sampling, thin, options, run);
        } catch (const UnusableInput&) {  // too many samples, or still no ball
            return best;
        }
        const SampledUnion* last = best ? &*best : made;
        if (denser.balls.fit && denser.topology && last != nullptr && last->topology &&
            !is_closer(denser.balls.fit->repair.topology, last->balls.fit->repair.topology, *denser.topology)) {
            return best;
        }
        const bool is_done = !has_wrong_topology(denser);
        std::erase_if(denser.balls.warnings,
                      [&](const Diagnostic& warning) { return is_done && warning.code == "axis.thin_part"; });
        denser.balls.warnings.push_back(thin_samples(thin, denser));
        best = std::move(denser);
        if (is_done) {
            return best;
        }
        append(thin, thin_balls_of(*best));
    }
    return best;
}

}  // namespace

std::string rounded_down(double value) {
    const double exponent = std::floor(logarithm(value) / std::numbers::ln10 + 1e-9);  // 3 of 1000, not 2.9…
    const double digit = power(10.0, exponent - 2.0);
    Words text;
    text << digit * std::floor(value / digit);
    return text.str();
}

bool fits_balls(const Solid* solid, const std::optional<UnionKind>& kind) {
    return solid != nullptr && kind.value_or(default_union(*solid)) == UnionKind::kFitted;
}

SolidUnion solid_union(const Samples& samples, const Solid* solid, const UnionOptions& options, Run& run) {
    SolidUnion result = polar_or_fitted_union(samples, solid, options, run);
    if (solid != nullptr) {
        warn_of_thin_part(*solid, samples.tolerance, result);
    }
    return result;
}

SampledUnion union_of_sizes(const Solid& solid, const SamplingOptions& sampling, const UnionOptions& options,
                            Run& run) {
    SampledUnion result = union_of_samples(solid, sampling, {}, options, run);
    if (sampling.sizing == Sizing::kAdaptive && has_wrong_topology(result)) {
        const Stopwatch watch;
        if (std::optional<SampledUnion> uniform = run.part(0.0, [&](const Execution& execution) {
                return right_uniform_union(solid, sampling, options, result, execution);
            })) {
            return std::move(*uniform);
        }
        result.costs.push_back({"uniform samples", watch.seconds(), peak_memory()});
    }
    return result;
}

SampledUnion sampled_union(const Solid& solid, const SamplingOptions& sampling, const UnionOptions& options, Run& run) {
    const bool is_adaptive = sampling.sizing == Sizing::kAdaptive && fits_balls(&solid, options.kind);
    std::optional<SampledUnion> result;
    std::vector<Ball> thin;
    try {
        result = union_of_sizes(solid, sampling, options, run);
        // Where it is not known nothing tells whether more samples help: surfaces that intersect themselves may leave
        // a solid no thickness.
        if (is_adaptive && has_wrong_topology(*result)) {
            thin = thin_balls_of(*result);
        }
    } catch (const UnusableInput& fault) {
        if (fault.diagnostic().code == kNoBalls && is_adaptive) {
            thin = run.part(
                0.0, [&](const Execution& execution) { return thin_balls_at_samples(solid, sampling, execution); });
        }
        if (thin.empty()) {
            throw;
        }
    }
    if (thin.empty()) {
        return std::move(*result);
    }
    std::optional<SampledUnion> denser = run.part(0.0, [&](const Execution& execution) {
        return union_with_thin_parts(solid, sampling, options, result ? &*result : nullptr, thin, execution);
    });
    if (denser) {
        denser->costs.insert(denser->costs.begin(),
                             {"other samples", result ? seconds_of(result->costs) : 0.0, peak_memory()});
        return std::move(*denser);
    }
    if (!result) {
        throw UnusableInput(too_thin(thin, sampling.tolerance));
    }
    std::erase_if(result->balls.warnings, [](const Diagnostic& warning) { return warning.code == "axis.thin_part"; });
    result->balls.warnings.push_back(too_thin(thin, sampling.tolerance));
    return std::move(*result);
}

double sampled_union_work(bool is_fitted) { return kSamplingWork + kBallsWork + (is_fitted ? kFitWork : 0.0); }

UnionKind default_union(const Solid& solid) { return solid.knows_nearest() ? UnionKind::kFitted : UnionKind::kPolar; }

SolidUnion union_of(const Samples& samples, const Solid& solid, const UnionOptions& options,
                    const Execution& execution) {
    return in_arena(execution, [&] {
        Run run(execution, kBallsWork + kFitWork);
        SolidUnion result = solid_union(samples, &solid, options, run);
        run.finish();
        return result;
    });
}

SampledUnion sampled_union(const Solid& solid, const SamplingOptions& sampling, const UnionOptions& options,
                           const Execution& execution) {
    return in_arena(execution, [&] {
        Run run(execution, sampled_union_work(fits_balls(&solid, options.kind)));
        SampledUnion result = sampled_union(solid, sampling, options, run);
        run.finish();
        return result;
    });
}

}  // namespace scaleaxis::inline v1
