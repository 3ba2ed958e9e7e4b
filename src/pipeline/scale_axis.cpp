// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/scale_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "axis/complex.hpp"
#include "axis/edit/slivers.hpp"
#include "axis/stages/refit.hpp"
#include "axis/stages/stages.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "pipeline/envelope_accuracy.hpp"
#include "pipeline/run.hpp"
#include "pipeline/solid_union.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {
namespace {

static_assert(kDefaultDelta == Length::relative(kDefaultTolerance));

// The error of a compact axis as a part of δ, unless options say otherwise.
constexpr double kCompactError = 0.25;

// How far from touching the solid the balls of a compact axis may be, as parts of its error; and how many times its
// vertices that may take.
constexpr std::array kRefitParts{0.6, 0.3, 0.15, 0.07};
constexpr double kRefitGrowth = 2.0;

// In δ: an envelope as close as this is that of a solid with plane faces up to rounding, and does not come closer.
constexpr double kExact = 1e-3;

// Distances differ if one is less than this part of the other.
constexpr double kCloser = 0.95;

// Of the progress of making an axis compact: the first time.
constexpr double kSimplified = 0.9;

// Of the angle of the filter, where sheets are filtered again once their angles are right: so much do those of a union
// scatter. With 1 parts of sheets go that are a degree wider than the angle, with 0.75 sheets between ribs are lost.
constexpr double kFirstAngle = 0.93;

// Work of choosing delta in that of a union with the chosen one, for the progress only: with the coarser ones before.
constexpr double kSearchFactor = 2.0;

double lambda_of(const ScaleAxisOptions& options, double diagonal) {
    return options.lambda.value_or(kDefaultLambda).of(diagonal);
}

double filter_angle_of(const ScaleAxisOptions& options) { return options.filter_angle.value_or(FilterOptions().angle); }

bool is_cleaned(const ScaleAxisOptions& options, bool) {
    return options.method == Method::kScale && !(options.cleaning && options.cleaning->value() == 0.0);
}

bool reaches_sharp_edges(const ScaleAxisOptions& options, bool is_fitted) {
    return is_fitted && options.method == Method::kScale && options.reaches_sharp_edges;
}

bool is_centered(const ScaleAxisOptions& options, bool is_fitted) {
    return is_fitted && is_cleaned(options, is_fitted) && options.is_centered && !options.is_dense;
}

Index smoothing_of(const ScaleAxisOptions& options) {
    return options.smoothing_rounds.value_or(is_cleaned(options, false) ? kDefaultSmoothing : 0);
}

bool is_smoothed(const ScaleAxisOptions& options, bool) { return smoothing_of(options) > 0; }

/// Are narrow sheets removed at the end? The axes of uniform samples stay as they have been.
bool is_filtered_again(const ScaleAxisOptions& options, bool is_fitted) {
    return is_centered(options, is_fitted) && filter_angle_of(options) > 0.0 && options.sizing == Sizing::kAdaptive;
}

bool is_compact(const ScaleAxisOptions& options, bool) { return options.compact.has_value(); }

bool always(const ScaleAxisOptions&, bool) { return true; }

void check_diagonal(double diagonal) {
    if (!(diagonal > 0.0) || !std::isfinite(diagonal)) {
        throw UnusableInput("the solid is empty or not bounded: its bounding box has no finite diagonal");
    }
}

void check_lambda(const ScaleAxisOptions& options, double diagonal) {
    const double lambda = lambda_of(options, diagonal);
    require(lambda >= kLambdaRange.min && lambda <= kLambdaRange.max * diagonal,
            "lambda must lie between 0 and half the bounding box's diagonal");
}

void refuse_options_of_sampling(const ScaleAxisOptions& options) {
    const auto refuse = [](bool is_given, const std::string& option) {
        require(!is_given, option + " has no effect where the samples are given: leave it out");
    };
    require(options.union_kind != UnionKind::kFitted,
            "balls cannot be fitted where samples are given in place of a solid: take polar balls");
    refuse(options.delta || options.delta_range, "delta");
    refuse(options.sizing != ScaleAxisOptions().sizing, "the sizing of the samples");
    refuse(options.sharp_angle.has_value(), "the angle of sharp edges");
}

FilteredComplex filtered_by(const ScaleAxisOptions& options, double angle, double diagonal,
                            const MedialComplex& complex, const Execution& execution) {
    switch (options.method) {
        case Method::kAngle:
            return thresholded(complex, LocalMeasure::kObjectAngle, angle);
        case Method::kLambda:
            return thresholded(complex, LocalMeasure::kCircumradius, lambda_of(options, diagonal));
        default:
            return filtered(complex, {angle}, execution);
    }
}

double largest_distance(const EnvelopeAccuracy& accuracy) {
    return std::max(accuracy.solid_to_envelope, accuracy.envelope_to_solid.value_or(0.0));
}

double mean_distance(const EnvelopeAccuracy& accuracy) {
    return std::max(accuracy.mean_solid_to_envelope, accuracy.mean_envelope_to_solid.value_or(0.0));
}

/// Where a fault that both have is the largest distance the mean decides.
bool is_closer(const EnvelopeAccuracy& accuracy, const EnvelopeAccuracy& other) {
    const double largest = largest_distance(accuracy);
    const double largest_of_other = largest_distance(other);
    return largest < kCloser * largest_of_other ||
           (largest <= largest_of_other / kCloser && mean_distance(accuracy) < kCloser * mean_distance(other));
}

/// Has the balls of a compact axis touch the solid, where that brings it closer and takes few vertices, and where it
/// keeps the error. Solids with plane faces come much closer: of what is curved more vertices would be needed.
/// \param axis measured \param before what it was made of
void refit(AxisAtScale& axis, const MedialComplex& before, const Solid& solid, std::span<const Point> samples,
           double tolerance, const SimplifyOptions& options, const Execution& execution) {
    const MedialComplex compact = axis.complex;
    const double error = *options.error;
    const auto most = static_cast<Index>(kRefitGrowth * static_cast<double>(compact.vertices.size()));
    // Strips of compact meshes are long: they do not always tell where their feet belong.
    for (const Feet feet : {Feet::kComeToSeams, Feet::kStay}) {
        for (const double part : kRefitParts) {
            if (largest_distance(*axis.accuracy) < kExact * tolerance) {
                return;
            }
            std::optional<MedialComplex> closer = refitted(
                compact, solid, {.tolerance = tolerance, .error = part * error, .most_vertices = most, .feet = feet},
                execution);
            if (!closer) {
                if (part == kRefitParts.front()) {
                    return;  // all is curved
                }
                break;
            }
            const EnvelopeAccuracy accuracy = accuracy_of(Envelope(*closer), samples, &solid, 0.5 * tolerance);
            if (!is_closer(accuracy, *axis.accuracy)) {
                continue;
            }
            const SimplifyStatistics statistics = compared(before, *closer, options, execution);
            if (statistics.largest_gap <= error && agree(statistics.topology, axis.simplify_statistics->topology)) {
                axis.complex = std::move(*closer);
                axis.accuracy = accuracy;
                axis.simplify_statistics = statistics;
            }
        }
    }
}

/// What the stages at one scale work on: each takes `result.complex` from the one before.
struct StageData {
    const ScaleAxis& given;
    const ScaleAxisOptions& options;
    const Solid* fitted_solid;       ///< that the balls were fitted to, or null
    const Solid* nearest_solid;      ///< that knows nearest points, or null
    std::span<const Point> samples;  ///< for compact axes
    double scale;                    ///< by which balls are grown
    AxisAtScale result;
    BallUnion grown{};  ///< while it is needed
    std::vector<Diagnostic> warnings{};
};

void take_medial_axis(StageData& data, const Execution& execution) {
    MedialAxisOptions options;
    options.seed = data.options.seed;
    options.compares_union = false;  // with the solid, later
    MedialAxis axis = medial_axis(scaled(data.given.balls, data.scale), options, execution);
    data.result.complex = std::move(axis.complex);
    data.result.medial_statistics = axis.statistics;
    if (is_smoothed(data.options, false)) {
        data.grown = std::move(axis.ball_union);
    }
}

void filter_sheets(StageData& data, const Execution& execution) {
    const bool is_last = !is_filtered_again(data.options, data.fitted_solid != nullptr);
    const double angle = (is_last ? 1.0 : kFirstAngle) * filter_angle_of(data.options);
    FilteredComplex filtered = filtered_by(data.options, angle, data.given.diagonal, data.result.complex, execution);
    data.result.complex = std::move(filtered.complex);
    data.result.filter_statistics = filtered.statistics;
}

void reach_sharp_edges(StageData& data, const Execution& execution) {
    const SharpEdgeOptions options{
        .angle = sharp_angle_of(data.options), .tolerance = data.given.tolerance, .scale = data.scale};
    SharpComplex sharp =
        extended_to_sharp_edges(std::move(data.result.complex), *data.fitted_solid, options, execution);
    data.result.complex = std::move(sharp.complex);
    data.result.sharp_statistics = sharp.statistics;
}

void clean_sheets(StageData& data, const Execution& execution) {
    const std::optional<Length>& given = data.options.cleaning;
    // The axes of uniform samples stay as they have been: their faces are hardly wider than what is cleaned.
    const CleanOptions options{.thickness = given ? given->of(data.given.diagonal) : 0.5 * data.given.tolerance,
                               .finds_ridges = data.options.sizing == Sizing::kAdaptive};
    CleanedComplex rest = cleaned(data.result.complex, options, execution);
    data.result.complex = std::move(rest.complex);
    data.result.clean_statistics = rest.statistics;
}

void shrink_balls(StageData& data, const Execution& execution) {
    MedialComplex complex = shrunk(std::move(data.result.complex), data.scale);
    if (data.options.is_dense) {
        complex = densified(std::move(complex), {}, execution);
    }
    data.result.complex = std::move(complex);
}

void smooth_sheets(StageData& data, const Execution& execution) {
    MedialComplex complex = in_arena(execution, [&] {
        return linearized_around_borders(std::move(data.result.complex), kLeastDip * data.given.tolerance);
    });
    data.result.complex =
        smooth(std::move(complex), std::exchange(data.grown, {}), {smoothing_of(data.options)}, execution);
}

void center_balls(StageData& data, const Execution& execution) {
    CenteredComplex in_middle =
        centered(std::move(data.result.complex), *data.fitted_solid, {.tolerance = data.given.tolerance}, execution);
    data.result.complex = std::move(in_middle.complex);
    data.result.center_statistics = in_middle.statistics;
}

void draw_slivers_together(StageData& data, const Execution&) {
    const double tolerance = data.given.tolerance;
    data.result.complex = without_slivers(with_seams_to_borders(std::move(data.result.complex), tolerance), tolerance);
}

void filter_narrow_sheets(StageData& data, const Execution& execution) {
    FilteredComplex wide =
        filtered_by_area(data.result.complex, filter_angle_of(data.options), data.given.tolerance, execution);
    data.result.complex = std::move(wide.complex);
    data.result.narrow_statistics = wide.statistics;
    if (wide.statistics.faces_removed > 0) {
        draw_slivers_together(data, execution);
    }
}

void make_compact(StageData& data, const Execution& execution) {
    AxisAtScale& axis = data.result;
    const double tolerance = data.given.tolerance;
    const auto& [error, vertices] = *data.options.compact;
    SimplifyOptions options{.vertices = vertices};
    if (error || !vertices) {
        options.error = error ? error->of(data.given.diagonal) : kCompactError * tolerance;
    }
    SimplifiedComplex simplified = simplify(axis.complex, options, part_of(execution, 0.0, kSimplified));
    const MedialComplex before = std::exchange(axis.complex, std::move(simplified.complex));
    axis.complex.scale = 1.0;  // its radii are linear at any scale: growing them would only round them
    axis.simplify_statistics = simplified.statistics;
    axis.accuracy = accuracy_of(Envelope(axis.complex), data.samples, data.nearest_solid, 0.5 * tolerance);
    if (axis.center_statistics && !vertices) {
        refit(axis, before, *data.nearest_solid, data.samples, tolerance, options,
              part_of(execution, kSimplified, kSimplified));
    }
    if (data.nearest_solid != nullptr) {
        double& most = axis.accuracy->solid_to_envelope;
        most = std::max(most, largest_distance_from(*data.nearest_solid, Envelope(axis.complex), 0.5 * tolerance,
                                                    part_of(execution, 1.0, 1.0)));
    }
    axis.complex.scale = before.scale;
    if (const auto warning = too_many_vertices(*axis.simplify_statistics, options)) {
        data.warnings.push_back(*warning);
    }
}

struct Stage {
    const char* name;
    double work;  ///< rough share in the time of a run, for the progress only
    bool (*is_wanted)(const ScaleAxisOptions& options, bool is_fitted);
    void (*run)(StageData& data, const Execution& execution);
};

/// From the grown union of balls to the axis, in this order.
constexpr std::array kStages{
    Stage{"medial axis", 4.0, always, take_medial_axis},
    Stage{"filter", 1.0, always, filter_sheets},
    Stage{"sharp edges", 0.3, reaches_sharp_edges, reach_sharp_edges},
    Stage{"cleaning", 0.5, is_cleaned, clean_sheets},
    Stage{"shrinking", 0.5, always, shrink_balls},
    Stage{"smoothing", 0.5, is_smoothed, smooth_sheets},
    Stage{"centering", 0.2, is_centered, center_balls},
    Stage{"slivers", 0.05, is_centered, draw_slivers_together},
    Stage{"narrow sheets", 0.05, is_filtered_again, filter_narrow_sheets},
    Stage{"simplification", 1.0, is_compact, make_compact},
};

double work_of_axes(const ScaleAxisOptions& options, bool is_fitted) {
    double work = 0.0;
    for (const Stage& stage : kStages) {
        work += stage.is_wanted(options, is_fitted) ? stage.work : 0.0;
    }
    return work * static_cast<double>(options.scales.size());
}

AxisAtScale axis_at_scale(StageData data, std::vector<Diagnostic>& warnings, Run& run) {
    for (const Stage& stage : kStages) {
        if (stage.is_wanted(data.options, data.fitted_solid != nullptr)) {
            run.stage(stage.name, stage.work, data.result.costs, [&](const Execution& execution) {
                stage.run(data, execution);
                return 0;
            });
        }
    }
    append(warnings, data.warnings);
    return std::move(data.result);
}

/// Compares the grown union with the one before.
void compare_growth(AxisAtScale& axis, const Topology& before, std::span<const Gap> gaps,
                    std::vector<Diagnostic>& warnings) {
    Words warning;
    warning << "growing the balls by s = " << axis.complex.scale << " changes the topology of their union: from "
            << in_words(before) << " to " << in_words(axis.medial_statistics.dual_complex);
    const auto end = std::ranges::upper_bound(gaps, axis.complex.scale, {}, &Gap::scale);
    axis.closed_gaps.assign(gaps.begin(), end);
    if (!axis.closed_gaps.empty()) {
        const Gap& first = axis.closed_gaps.front();
        const auto places = static_cast<std::int64_t>(axis.closed_gaps.size());
        warning << "; it closes gaps at " << counted(places, "place") << ", the first " << to_text(first.place) << ", "
                << first.width << " wide";
    }
    warnings.push_back({"axis.growth_topology", warning.str()});
}

void compare_topology(AxisAtScale& axis, ScaleAxis& result) {
    const Topology& dual = axis.medial_statistics.dual_complex;
    const bool is_changed = result.fit && !agree(dual, result.fit->repair.topology);
    if (is_changed) {
        compare_growth(axis, result.fit->repair.topology, result.fit->repair.gaps, result.warnings);
    }
    const bool was_right =
        is_changed && result.solid_topology && agree(result.fit->repair.topology, *result.solid_topology);
    if (result.solid_topology && !agree(dual, *result.solid_topology) && !was_right) {
        Words warning;
        warning << "at s = " << axis.complex.scale << " the union of balls has " << in_words(dual)
                << ", the input solid " << in_words(*result.solid_topology)
                << ": parts thinner than delta get lost or merge (and growing closes gaps); use a smaller delta";
        result.warnings.push_back({.code = "axis.union_topology", .message = warning.str()});
        // Where the union was right before, no delta helps against what growing does to it.
        if (axis.complex.scale == 1.0 || (result.fit && !agree(result.fit->repair.topology, *result.solid_topology))) {
            const bool is_thin = result.fit && result.fit->thin_part;
            const double thickness = is_thin ? result.fit->thin_part->thickness : result.tolerance;
            result.warnings.back().hints = {{"delta-abs", rounded_down(0.5 * std::min(thickness, result.tolerance))}};
        }
    }
    const Topology& kept = axis.simplify_statistics ? axis.simplify_statistics->topology
                           : axis.clean_statistics  ? axis.clean_statistics->topology
                           : axis.sharp_statistics  ? axis.sharp_statistics->topology
                                                    : axis.filter_statistics.topology;
    if (!agree(dual, kept)) {
        result.warnings.push_back({"axis.method_topology", "the method has changed the topology: what it keeps has " +
                                                               in_words(kept) + ", the medial axis " + in_words(dual)});
    }
}

/// All that follows the union of balls. \param result has the diagonal \param solid null where samples were given
ScaleAxis axes_of(ScaleAxis result, const Solid* solid, SampledUnion given, const ScaleAxisOptions& options, Run& run) {
    result.tolerance = given.samples.tolerance;
    result.samples = static_cast<Index>(given.samples.points.size());
    result.sampling_statistics = given.samples.statistics;
    result.solid_topology = given.topology;
    result.balls = std::move(given.balls.balls);
    result.contacts = std::move(given.balls.contacts);
    result.fit = std::move(given.balls.fit);
    append(result.costs, given.costs);
    append(result.warnings, given.balls.warnings);
    std::vector<Point> points;
    if (options.compact) {
        points = given.samples.points;
    }
    if (options.keeps_samples) {
        result.kept_samples = std::move(given.samples);
    }
    given = {};
    const Solid* nearest_solid = solid != nullptr && solid->knows_nearest() ? solid : nullptr;
    const Solid* fitted_solid = result.fit ? solid : nullptr;
    for (const double scale : options.scales) {
        StageData data{result, options, fitted_solid, nearest_solid, points, scale, {}};
        result.axes.push_back(axis_at_scale(std::move(data), result.warnings, run));
        compare_topology(result.axes.back(), result);
    }
    run.finish();
    return result;
}

}  // namespace

void validate(const ScaleAxisOptions& options) {
    require(!options.scales.empty(), "at least one scale is needed");
    for (const double scale : options.scales) {
        require(kScaleRange.contains(scale), "every scale must lie between 1 and 10");
    }
    require(!options.delta || !options.delta_range,
            "delta has no effect beside a range to choose it from: leave one out");
    if (options.delta_range) {
        validate(*options.delta_range);
    }
    require(options.method == Method::kScale || options.scales == std::vector{1.0},
            "the local methods grow nothing: with method angle or lambda the only scale is 1");
    require(!options.lambda || options.method == Method::kLambda,
            "lambda has no effect with the methods scale and angle: leave it out, or choose method lambda");
    require(!options.filter_angle || options.method != Method::kLambda,
            "the filter angle has no effect with method lambda: leave it out, or choose method scale or angle");
    require(kAngleRange.contains(filter_angle_of(options)), "the filter angle must lie between 0 and 90 degrees");
    require(!options.cleaning || options.method == Method::kScale || options.cleaning->value() == 0.0,
            "cleaning has no effect with the local methods, which keep what their measure says: leave it out");
    require(
        !options.cleaning || (options.cleaning->value() >= kCleaningRange.min &&
                              (options.cleaning->is_absolute() || kCleaningRange.contains(options.cleaning->value()))),
        "the erosion thickness to clean by must lie between 0 and half the bounding box's diagonal");
    if (options.compact) {
        require(!options.is_dense, "a dense axis cannot be compact: leave out one of the two options");
        const std::optional<Length>& error = options.compact->error;
        require(!error || (error->is_absolute() ? error->value() > 0.0 : kCompactErrorRange.contains(error->value())),
                "the error of a compact axis must be a positive length, and lie between 1e-6 and half the bounding "
                "box's diagonal");
        require(!options.compact->vertices || *options.compact->vertices >= 1,
                "the number of vertices of a compact axis must be at least 1");
    }
    require(!options.sharp_angle || (options.reaches_sharp_edges && options.method == Method::kScale &&
                                     options.union_kind != UnionKind::kPolar),
            "the angle of sharp edges has no effect where sheets do not go on to them: leave it out");
    require(!options.sharp_angle || kSharpAngleRange.contains(*options.sharp_angle),
            "the angle of sharp edges must lie between 10 and 150 degrees");
    require(kSmoothingRange.contains(smoothing_of(options)),
            "the number of smoothing rounds must lie between 0 and 1000");
}

double sharp_angle_of(const ScaleAxisOptions& options) {
    // A sheet into an edge has half the angle between its normals.
    const double least = options.sizing == Sizing::kAdaptive ? 2.0 * (filter_angle_of(options) + kClearlyWider) : 0.0;
    return options.sharp_angle.value_or(std::clamp(least, SharpEdgeOptions().angle, kSharpAngleRange.max));
}

Length finest_delta(const ScaleAxisOptions& options) {
    return options.delta_range ? options.delta_range->finest : options.delta.value_or(kDefaultDelta);
}

double tolerance_of(const Length& delta, double diagonal) {
    check_diagonal(diagonal);
    const double tolerance = delta.of(diagonal);
    Words range;
    range << "delta must lie between " << kDeltaRange.min << " and " << kDeltaRange.max
          << " of the bounding box's diagonal, which is " << diagonal;
    require(tolerance >= kDeltaRange.min * diagonal && tolerance <= kDeltaRange.max * diagonal, range.str());
    return tolerance;
}

ScaleAxis scale_axis(const Solid& solid, const ScaleAxisOptions& options, const Execution& execution) {
    ScaleAxis result;
    result.diagonal = solid.bounds().diagonal();
    check_diagonal(result.diagonal);
    validate(options);
    check_lambda(options, result.diagonal);
    const bool is_fitted = fits_balls(&solid, options.union_kind);
    if (is_fitted) {
        check_knows_nearest(solid);
    }
    SamplingOptions sampling{.sizing = options.sizing, .seed = options.seed};
    if (!options.delta_range) {
        sampling.tolerance = tolerance_of(options.delta.value_or(kDefaultDelta), result.diagonal);
    }
    const UnionOptions union_options{options.union_kind, std::nullopt, options.seed};
    result.warnings = solid.warnings();
    return in_arena(execution, [&] {
        const double union_work = (options.delta_range ? kSearchFactor : 1.0) * sampled_union_work(is_fitted);
        Run run(execution, union_work + work_of_axes(options, is_fitted));
        if (!options.delta_range) {
            return axes_of(std::move(result), &solid, sampled_union(solid, sampling, union_options, run), options, run);
        }
        ChosenUnion found = run.part(union_work, [&](const Execution& inner) {
            return choose_delta(solid, *options.delta_range, sampling, union_options, inner);
        });
        result.delta_choice = std::move(found.choice);
        return axes_of(std::move(result), &solid, std::move(found.chosen), options, run);
    });
}

ScaleAxis scale_axis(Samples samples, const ScaleAxisOptions& options, const Execution& execution) {
    refuse_options_of_sampling(options);
    const Box box = box_around(samples.points);
    ScaleAxis result;
    result.diagonal = box.diagonal();
    check_diagonal(result.diagonal);
    validate(options);
    check_lambda(options, result.diagonal);
    return in_arena(execution, [&] {
        Run run(execution, kBallsWork + work_of_axes(options, false));
        SampledUnion given;
        given.samples = std::move(samples);
        given.balls = solid_union(given.samples, nullptr, {}, run);
        given.costs = given.balls.costs;
        return axes_of(std::move(result), nullptr, std::move(given), options, run);
    });
}

}  // namespace scaleaxis::inline v1
