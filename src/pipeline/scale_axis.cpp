// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/scale_axis.hpp"

#include <chrono>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "kernel/parallel.hpp"
#include "pipeline/resources.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

constexpr double kMinDelta = 1e-5;
constexpr double kMaxDelta = 0.5;
constexpr double kMaxLambda = 0.5;
constexpr double kMaxScale = 10.0;
constexpr Index kMaxSmoothingRounds = 1000;

// Rough share of the stages in the time of a run, for the progress only.
constexpr double kSamplingWork = 3.0;
constexpr double kBallsWork = 0.2;
constexpr double kMedialAxisWork = 4.0;
constexpr double kFilterWork = 1.0;
constexpr double kShrinkingWork = 0.5;
constexpr double kSmoothingWork = 0.5;

// Runs stages one after the other: turns the progress of each into that of the whole, and measures it.
class Run {
   public:
    Run(const Execution& execution, double total_work) : execution_(execution), total_work_(total_work) {}

    template <class Stage>
    auto stage(const std::string& name, double work, std::vector<StageCost>& costs, const Stage& run_stage) {
        Execution inner;
        inner.threads = execution_.threads;
        if (execution_.progress) {
            inner.progress = [this, work](std::string_view stage, double part) {
                return execution_.progress(stage, std::min(1.0, (done_work_ + part * work) / total_work_));
            };
        }
        const auto start = std::chrono::steady_clock::now();
        auto result = run_stage(inner);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        costs.push_back({name, seconds.count(), peak_memory()});
        done_work_ += work;
        return result;
    }

   private:
    const Execution& execution_;
    double total_work_;
    double done_work_ = 0.0;
};

void require(bool condition, const std::string& message) {
    if (!condition) {
        throw InvalidOption(message);
    }
}

double lambda_of(const ScaleAxisOptions& options, double diagonal) {
    return options.absolute_lambda.value_or(options.lambda * diagonal);
}

void validate(const ScaleAxisOptions& options, double diagonal) {
    if (!(diagonal > 0.0) || !std::isfinite(diagonal)) {
        throw UnusableShape("the shape is empty or not bounded: its bounding box has no finite diagonal");
    }
    require(!options.scales.empty(), "at least one scale is needed");
    for (const double scale : options.scales) {
        require(scale >= 1.0 && scale <= kMaxScale, "every scale must lie between 1 and 10");
    }
    require(options.method == Method::kScale || options.scales == std::vector{1.0},
            "the local methods grow nothing: with method angle or lambda the only scale is 1");
    const double lambda = lambda_of(options, diagonal);
    require(lambda >= 0.0 && lambda <= kMaxLambda * diagonal,
            "lambda must lie between 0 and half the bounding box's diagonal");
    require(options.smoothing_rounds >= 0 && options.smoothing_rounds <= kMaxSmoothingRounds,
            "the number of smoothing rounds must lie between 0 and 1000");
    require(options.filter_angle >= 0.0 && options.filter_angle <= 90.0,
            "the filter angle must lie between 0 and 90 degrees");
}

double validated_tolerance(const ScaleAxisOptions& options, double diagonal) {
    const double tolerance = options.absolute_delta.value_or(options.delta * diagonal);
    std::ostringstream range;
    range << "delta must lie between " << kMinDelta << " and " << kMaxDelta
          << " of the bounding box's diagonal, which is " << diagonal;
    require(tolerance >= kMinDelta * diagonal && tolerance <= kMaxDelta * diagonal, range.str());
    return tolerance;
}

std::string describe(const Topology& t) {
    std::ostringstream text;
    text << t.components << (t.components == 1 ? " component" : " components") << ", Euler characteristic " << t.euler;
    return text.str();
}

FilteredComplex filtered_by(const ScaleAxisOptions& options, double diagonal, const MedialComplex& complex,
                            const Execution& execution) {
    switch (options.method) {
        case Method::kAngle:
            return thresholded(complex, LocalMeasure::kObjectAngle, options.filter_angle);
        case Method::kLambda:
            return thresholded(complex, LocalMeasure::kCircumradius, lambda_of(options, diagonal));
        default:
            return filter(complex, {options.filter_angle}, execution);
    }
}

AxisAtScale axis_at_scale(const std::vector<Ball>& balls, double scale, double diagonal,
                          const ScaleAxisOptions& options, Run& run) {
    AxisAtScale result;
    result.scale = scale;
    MedialAxis axis = run.stage("medial axis", kMedialAxisWork, result.costs, [&](const Execution& execution) {
        MedialAxisOptions medial_options;
        medial_options.seed = options.seed;
        return medial_axis(scaled(balls, scale), medial_options, execution);
    });
    result.medial_statistics = axis.statistics;
    FilteredComplex filtered = run.stage("filter", kFilterWork, result.costs, [&](const Execution& execution) {
        return filtered_by(options, diagonal, axis.complex, execution);
    });
    if (options.smoothing_rounds == 0) {
        axis = {};  // not needed any more, and large
    }
    result.filter_statistics = filtered.statistics;
    result.complex = run.stage("shrinking", kShrinkingWork, result.costs, [&](const Execution& execution) {
        ShrinkOptions shrink_options;
        shrink_options.scale = scale;
        return shrink(filtered.complex, shrink_options, execution);
    });
    if (options.smoothing_rounds > 0) {
        filtered = {};
        result.complex = run.stage("smoothing", kSmoothingWork, result.costs, [&](const Execution& execution) {
            return smooth(std::move(result.complex), axis, {options.smoothing_rounds, scale}, execution);
        });
    }
    return result;
}

Run run_of(const ScaleAxisOptions& options, const Execution& execution) {
    const double smoothing_work = options.smoothing_rounds > 0 ? kSmoothingWork : 0.0;
    const double work_per_scale = kMedialAxisWork + kFilterWork + kShrinkingWork + smoothing_work;
    return {execution, kSamplingWork + kBallsWork + work_per_scale * static_cast<double>(options.scales.size())};
}

/// All that follows the sampling. \param result has the diagonal, and the topology of the shape, if that is known
ScaleAxis axes_of(ScaleAxis result, Samples samples, const ScaleAxisOptions& options, Run& run) {
    result.tolerance = samples.tolerance;
    result.samples = static_cast<Index>(samples.points.size());
    result.sampling_statistics = samples.statistics;
    result.balls = run.stage("balls", kBallsWork, result.costs,
                             [&](const Execution& inner) { return inner_balls(samples, inner); });
    samples = {};
    if (result.balls.empty()) {
        throw UnusableShape("no ball fits into the shape at this tolerance: use a smaller delta");
    }
    for (const double scale : options.scales) {
        result.axes.push_back(axis_at_scale(result.balls, scale, result.diagonal, options, run));
        const Topology& dual = result.axes.back().medial_statistics.dual_complex;
        if (result.shape_topology && !agree(dual, *result.shape_topology)) {
            std::ostringstream warning;
            warning << "at s = " << scale << " the union of balls has " << describe(dual) << ", the input solid "
                    << describe(*result.shape_topology)
                    << ": parts thinner than delta get lost or merge (and growing closes gaps); use a smaller delta";
            result.warnings.push_back(warning.str());
        }
        const Topology& kept = result.axes.back().filter_statistics.topology;
        if (!agree(dual, kept)) {
            result.warnings.push_back("the method has changed the topology: what it keeps has " + describe(kept) +
                                      ", the medial axis " + describe(dual));
        }
    }
    return result;
}

}  // namespace

ScaleAxis scale_axis(const Shape& shape, const ScaleAxisOptions& options, const Execution& execution) {
    ScaleAxis result;
    result.diagonal = shape.bounds().diagonal();
    validate(options, result.diagonal);
    const SamplingOptions sampling{.tolerance = validated_tolerance(options, result.diagonal),
                                   .seed = options.seed,
                                   .suits_features = options.suits_features,
                                   .limits_deviation = options.limits_deviation};
    result.shape_topology = shape.topology();
    return kernel::in_arena(execution, [&] {
        Run run = run_of(options, execution);
        Samples samples = run.stage("sampling", kSamplingWork, result.costs,
                                    [&](const Execution& inner) { return sample(shape, sampling, inner); });
        return axes_of(std::move(result), std::move(samples), options, run);
    });
}

ScaleAxis scale_axis(Samples samples, const ScaleAxisOptions& options, const Execution& execution) {
    Box box;
    for (const Point& p : samples.points) {
        box.extend(p);
    }
    ScaleAxis result;
    result.diagonal = box.diagonal();
    validate(options, result.diagonal);
    return kernel::in_arena(execution, [&] {
        Run run = run_of(options, execution);
        return axes_of(std::move(result), std::move(samples), options, run);
    });
}

}  // namespace scaleaxis
