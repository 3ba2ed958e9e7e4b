// SPDX-License-Identifier: Apache-2.0
// The choice of the tolerance δ.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "balls/dual_complex.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "pipeline/run.hpp"
#include "pipeline/solid_union.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "spatial/ball_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// A tolerance, and the union that it led to.
struct Candidate {
    DeltaAttempt attempt;
    std::optional<SampledUnion> made;
};

/// With both ends relative to the diagonal.
DeltaRange relative_range(const DeltaRange& range, double diagonal) {
    const auto relative = [&](const Length& length) {
        return length.is_absolute() ? Length::relative(length.value() / diagonal) : length;
    };
    return {relative(range.coarsest), relative(range.finest)};
}

/// \param range relative
std::vector<double> deltas_of(const DeltaRange& range) {
    std::vector<double> deltas;
    for (int i = 0;; ++i) {
        const double delta =
            range.coarsest.value() * std::ldexp(i % 2 == 0 ? 1.0 : 0.5 * std::numbers::sqrt2, -(i / 2));
        if (delta <= (1.0 + kRelativeRounding) * range.finest.value()) {
            deltas.push_back(range.finest.value());
            return deltas;
        }
        deltas.push_back(delta);
    }
}

Topology topology_of(const SolidUnion& balls, std::uint64_t seed) {
    return balls.fit ? balls.fit->repair.topology
                     : dual_complex(perturbed(balls.balls, MedialAxisOptions().perturbation, seed)).topology;
}

double largest_distance(const SampledUnion& made) {
    if (made.balls.fit) {
        return made.balls.fit->accuracy.largest_distance;
    }
    const BallTree tree = build_ball_tree(made.balls.balls);
    const std::vector<Point>& samples = made.samples.points;
    const auto distances =
        mapped<double>(samples.size(), [&](std::size_t i) { return nearest_ball(tree, samples[i]).distance; });
    return std::max(0.0, std::ranges::max(distances));
}

/// The requirement that a tolerance must meet by itself, and does not; empty: it meets all.
Diagnostic fault_of(const DeltaAttempt& attempt) {
    Words text;
    if (attempt.solid && !agree(*attempt.solid, *attempt.balls_topology)) {
        text << "the union of balls has " << in_words(*attempt.balls_topology) << ", the solid "
             << in_words(*attempt.solid);
        return {"delta.topology", text.str()};
    }
    if (attempt.largest_distance > (1.0 + kRelativeRounding) * attempt.tolerance) {
        text << "a sample is " << attempt.largest_distance << " from the union of balls, farther than delta, which is "
             << attempt.tolerance;
        return {"delta.distance", text.str()};
    }
    return {};
}

/// That the topology is not known, and not the same at the next finer tolerance either.
Diagnostic unconfirmed() {
    return {"delta.unconfirmed",
            "the solid does not know its topology, and no next finer delta leads to the same union of balls"};
}

Candidate tried(const Solid& solid, double delta, SamplingOptions sampling, const UnionOptions& options,
                const Execution& execution) {
    Candidate candidate;
    DeltaAttempt& attempt = candidate.attempt;
    attempt.delta = delta;
    attempt.tolerance = sampling.tolerance = tolerance_of(Length::relative(delta), solid.bounds().diagonal());
    const Stopwatch watch;
    try {
        // A finer delta, not more samples in thin parts, is what is looked for.
        Run run(execution, sampled_union_work(fits_balls(&solid, options.kind)));
        candidate.made = union_of_sizes(solid, sampling, options, run);
        run.finish();
        attempt.samples = static_cast<Index>(candidate.made->samples.points.size());
        attempt.balls = static_cast<Index>(candidate.made->balls.balls.size());
        attempt.solid = candidate.made->topology;
        attempt.balls_topology = topology_of(candidate.made->balls, options.seed);
        attempt.largest_distance = largest_distance(*candidate.made);
        attempt.fault = fault_of(attempt);
    } catch (const UnusableInput& fault) {
        // A solid that contradicts itself does so at any tolerance; others may be too coarse.
        if (fault.diagnostic().code.starts_with("solid.")) {
            throw;
        }
        attempt.fault = fault.diagnostic();
    }
    attempt.seconds = watch.seconds();
    return candidate;
}

Diagnostic warning_of(const DeltaChoice& choice) {
    const DeltaAttempt& chosen = choice.attempts[choice.chosen];
    Words text;
    text << "no delta of " << choice.range.coarsest.value() << " ... " << choice.range.finest.value()
         << " meets all requirements; " << chosen.delta << " is taken, where " << chosen.fault.message;
    return {"axis.delta_choice", text.str()};
}

/// Takes candidates from the coarsest on until one meets the requirements.
class Search {
   public:
    Search(const Solid& solid, const DeltaRange& range) : is_topology_known_(solid.topology().has_value()) {
        choice_.range = range;
    }

    void add(Candidate candidate) {
        choice_.attempts.push_back(std::move(candidate.attempt));
        if (!candidate.made) {
            return;
        }
        const DeltaAttempt& latest = choice_.attempts.back();
        if (is_waiting()) {
            DeltaAttempt& coarser = choice_.attempts[choice_.chosen];
            if (latest.fault.empty() && agree(*latest.balls_topology, *coarser.balls_topology)) {
                is_done_ = true;
                return;
            }
            coarser.fault = unconfirmed();
        }
        chosen_ = std::move(candidate.made);
        choice_.chosen = choice_.attempts.size() - 1;
        is_done_ = is_topology_known_ && latest.fault.empty();
    }

    bool is_done() const { return is_done_; }

    /// \throws UnusableInput if no tolerance has led to a union
    ChosenUnion result() && {
        if (!chosen_) {
            throw UnusableInput(choice_.attempts.back().fault);
        }
        DeltaAttempt& chosen = choice_.attempts[choice_.chosen];
        if (is_waiting() && !is_done_) {
            chosen.fault = unconfirmed();
        }
        if (!chosen.fault.empty()) {
            chosen_->balls.warnings.push_back(warning_of(choice_));
        }
        if (choice_.attempts.size() > 1) {
            double other_seconds = -chosen.seconds;
            for (const DeltaAttempt& attempt : choice_.attempts) {
                other_seconds += attempt.seconds;
            }
            chosen_->costs.insert(chosen_->costs.begin(), {"other deltas", other_seconds, peak_memory()});
        }
        return {std::move(*chosen_), std::move(choice_)};
    }

   private:
    /// Is there a candidate that the next one may confirm?
    bool is_waiting() const { return !is_topology_known_ && chosen_ && choice_.attempts[choice_.chosen].fault.empty(); }

    bool is_topology_known_;
    DeltaChoice choice_;
    std::optional<SampledUnion> chosen_;  // so far
    bool is_done_ = false;
};

std::string name_of_stage(double delta) {
    Words text;
    text << "delta " << delta;
    return text.str();
}

}  // namespace

void validate(const DeltaRange& range) {
    const auto& [coarsest, finest] = range;
    if (coarsest.is_absolute() || finest.is_absolute()) {
        return;  // `choose_delta` knows the diagonal
    }
    if (!kDeltaRange.contains(coarsest.value()) || !kDeltaRange.contains(finest.value()) ||
        finest.value() > coarsest.value()) {
        Words text;
        text << "the deltas to choose from must lie between " << kDeltaRange.min << " and " << kDeltaRange.max
             << ", and the finest one must not be larger than the coarsest one";
        throw InvalidOption(text.str());
    }
}

ChosenUnion choose_delta(const Solid& solid, const DeltaRange& given, const SamplingOptions& sampling,
                         const UnionOptions& options, const Execution& execution) {
    const DeltaRange range = relative_range(given, solid.bounds().diagonal());
    validate(range);
    return in_arena(execution, [&] {
        Search search(solid, range);
        double done = 0.0;
        for (const double delta : deltas_of(range)) {
            // How many there will be is not known.
            const double begin = std::exchange(done, done + 0.5 * (1.0 - done));
            report(execution, name_of_stage(delta), begin);
            search.add(tried(solid, delta, sampling, options, part_of(execution, begin, done)));
            if (search.is_done()) {
                break;
            }
        }
        ChosenUnion result = std::move(search).result();
        report(execution, name_of_stage(result.choice.attempts[result.choice.chosen].delta) + " chosen", 1.0);
        return result;
    });
}

}  // namespace scaleaxis::inline v1
