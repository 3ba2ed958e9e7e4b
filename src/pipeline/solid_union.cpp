// SPDX-License-Identifier: Apache-2.0
#include "pipeline/solid_union.hpp"

#include <string>
#include <utility>

#include "base/parallel.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

void check_any(const std::vector<Ball>& balls) {
    if (balls.empty()) {
        throw UnusableInput("no ball fits into the solid at this tolerance: use a smaller delta");
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
    const UnionAccuracy accuracy = run.stage("accuracy", 0.1 * kFitWork, result.costs, [&](const Execution& execution) {
        return union_accuracy(result.balls, result.contacts, samples, execution);
    });
    result.fit = FitReport{fitted.statistics, std::move(repaired.report), accuracy};
}

}  // namespace

bool fits_balls(const Solid* solid, const std::optional<UnionKind>& kind) {
    return solid != nullptr && kind.value_or(default_union(*solid)) == UnionKind::kFitted;
}

SolidUnion solid_union(const Samples& samples, const Solid* solid, const UnionOptions& options, Run& run) {
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

}  // namespace scaleaxis
