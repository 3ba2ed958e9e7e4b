// SPDX-License-Identifier: Apache-2.0
#include "pipeline/solid_union.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {
namespace {

void check_any(const std::vector<Ball>& balls) {
    if (balls.empty()) {
        throw UnusableInput("no ball fits into the solid at this tolerance: use a smaller delta");
    }
}

// Uniform samples are taken where adaptive ones lead to the wrong topology, up to this many times as many: what it
// costs to halve delta, which is the advice else.
constexpr double kMostUniformSamples = 4.0;

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
        std::ostringstream warning;
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
        std::ostringstream warning;
        warning << counted(std::int64_t{repair.far_points}, "point") << " of the boundary, of " << repair.points
                << " that were looked at, " << (repair.far_points == 1 ? "is" : "are")
                << " farther than half of delta from the union of balls, which is " << kPromise * tolerance
                << "; the farthest is " << repair.largest_distance << " away, at " << to_text(repair.farthest_point)
                << ": use a smaller delta";
        result.warnings.push_back({"balls.far_points", warning.str()});
    }
}

void fit_balls(const Samples& samples, const Solid& solid, const UnionOptions& options, SolidUnion& result, Run& run) {
    const double slack = kDefaultSlack * samples.tolerance;
    const FittedBalls fitted = run.stage("fit", 0.5 * kFitWork, result.costs, [&](const Execution& execution) {
        return fit(result.balls, solid, {slack}, execution);
    });
    check_any(fitted.balls);
    RepairOptions repair_options;
    repair_options.topology = options.topology;
    repair_options.slack = slack;
    repair_options.perturbation = MedialAxisOptions().perturbation;
    repair_options.seed = options.seed;
    RepairedBalls repaired = run.stage("union repair", 0.4 * kFitWork, result.costs, [&](const Execution& execution) {
        return repair(fitted, samples, solid, repair_options, execution);
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
                           thin_part(result.balls, result.contacts, samples.tolerance)};
    warn_of_polar_balls(result);
    if (options.topology) {
        warn_of_far_points(samples.tolerance, result);
    }
}

/// A number of three digits that is no larger.
std::string rounded_down(double value) {
    const double digit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
    std::ostringstream text;
    text << digit * std::floor(value / digit);
    return text.str();
}

/// That samples are too far from each other for what is thin. Thin is what two of them do not fit across.
void warn_of_thin_part(const Solid& solid, double tolerance, SolidUnion& result) {
    std::optional<ThinPart> thin = result.fit ? result.fit->thin_part : std::nullopt;
    if (const std::optional<ThinPart> known = solid.thin_part(); !thin && known && known->thickness < 2.0 * tolerance) {
        thin = known;
    }
    if (thin) {
        std::ostringstream warning;
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

SampledUnion union_of_samples(const Solid& solid, const SamplingOptions& sampling, const UnionOptions& options,
                              Run& run) {
    SampledUnion result;
    result.samples = run.stage("sampling", kSamplingWork, result.costs,
                               [&](const Execution& execution) { return sample(solid, sampling, execution); });
    result.topology = solid.topology();
    if (!result.topology) {
        result.topology = topology(result.samples);
    }
    result.balls = solid_union(result.samples, &solid, {options.kind, result.topology, options.seed}, run);
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
        uniform = union_of_samples(solid, sampling, options, run);
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

}  // namespace

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

SampledUnion sampled_union(const Solid& solid, const SamplingOptions& sampling, const UnionOptions& options, Run& run) {
    SampledUnion result = union_of_samples(solid, sampling, options, run);
    if (sampling.sizing == Sizing::kAdaptive && has_wrong_topology(result)) {
        const Stopwatch watch;
        if (std::optional<SampledUnion> denser = run.part(0.0, [&](const Execution& execution) {
                return right_uniform_union(solid, sampling, options, result, execution);
            })) {
            return std::move(*denser);
        }
        result.costs.push_back({"uniform samples", watch.seconds(), peak_memory()});
    }
    return result;
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
