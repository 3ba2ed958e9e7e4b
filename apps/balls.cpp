// SPDX-License-Identifier: Apache-2.0
// scaleaxis balls: solid → union of balls.
#include "scaleaxis/balls.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct BallsOptions {
    std::optional<fs::path> input;
    SourceOptions source;
    std::string output;
    std::optional<Length> delta;
    bool suits_features = false;
    bool limits_deviation = false;
    std::optional<UnionKind> union_kind;
    CommonOptions common;
};

Samples sampled(LoadedSolid& input, const BallsOptions& options, const Execution& execution) {
    if (input.samples) {
        return std::move(*input.samples);
    }
    const Solid& solid = *input.solid;
    return sample(solid,
                  {.tolerance = tolerance_of(options.delta.value_or(kDefaultDelta), solid.bounds().diagonal()),
                   .seed = options.common.seed,
                   .suits_features = options.suits_features,
                   .limits_deviation = options.limits_deviation},
                  execution);
}

SolidUnion union_of_input(const Samples& samples, const LoadedSolid& input, const BallsOptions& options,
                          const Execution& execution) {
    if (input.solid) {
        const std::optional<Topology> known = input.solid->topology();
        return union_of(samples, *input.solid,
                        {options.union_kind, known ? known : topology(samples), options.common.seed}, execution);
    }
    SolidUnion result;
    Stopwatch watch;
    result.balls = inner_balls(samples, execution);
    result.costs.push_back(watch.lap("balls"));
    return result;
}

Source single_source(const BallsOptions& options) {
    const std::vector<Source> sources =
        sources_of(options.input ? std::vector{*options.input} : std::vector<fs::path>(), options.source);
    if (sources.size() > 1) {
        throw InvalidOption("--each-label needs more outputs than one: use scaleaxis axis with --balls");
    }
    return sources.front();
}

Status run_balls(const BallsOptions& options, const std::stop_token& cancel) {
    const bool has_sampling_options = options.delta || options.suits_features || options.limits_deviation;
    check_sampling_options(options.source, has_sampling_options);
    const Source source = single_source(options);
    const fs::path output = checked_output(output_pattern(options.output, "balls", false), source.name, 1.0,
                                           options.common.statistics, check_balls_output);

    ProgressBar bar(source.name.filename().string(), options.common.verbosity());
    LoadedSolid input =
        load_source(source, bar.execution(options.common.threads, cancel, {0.0, 0.3}), warn_above(bar, source.name));
    if (input.samples && has_sampling_options) {
        warn_above(bar, source.name)(unused_sampling_options());
    }
    check_can_fit(input, options.union_kind);
    const Execution execution = bar.execution(options.common.threads, cancel, {0.3, 1.0});
    std::vector<StageCost> costs = input.costs;
    Stopwatch watch;
    const Samples samples = sampled(input, options, execution);
    const auto sample_count = static_cast<Index>(samples.points.size());
    costs.push_back(watch.lap("sampling"));
    const SolidUnion result = union_of_input(samples, input, options, execution);
    costs.insert(costs.end(), result.costs.begin(), result.costs.end());
    std::ranges::for_each(result.warnings, warn_above(bar, source.name));
    watch.lap("");
    const std::vector<Ball>& balls = result.balls;
    bar.erase();
    stop_if_requested(cancel);
    write_balls(output, balls);
    costs.push_back(watch.lap("writing"));

    if (options.common.has_summary()) {
        std::ostringstream text;
        text << source.name.string() << '\n';
        print(text, input.input);
        print_samples(text, sample_count, samples.tolerance, samples.statistics);
        print_balls(text, balls.size(), output);
        if (result.fit) {
            print(text, *result.fit);
        }
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.balls/2");
    document.update({{"input", source.name.string()},
                     {std::string(name_of(input.input)), json_of(input.input)},
                     {"tolerance", samples.tolerance},
                     {"seed", options.common.seed},
                     {"samples", sample_count},
                     {"sampling", json_of(samples.statistics)},
                     {"balls", balls.size()},
                     {"fit", json_of(result.fit)},
                     {"balls_file", output.string()},
                     {"costs", json_of(costs)},
                     {"warnings", json_of(input.warnings)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace

Command balls_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("balls", "Union of balls that approximates a solid");
    auto options = std::make_shared<BallsOptions>();
    command->add_option("INPUT", options->input, "Mesh, 3D image, points or balls; none with --implicit")
        ->option_text(" ");
    add_output_option(*command, options->output,
                      "Balls: .ply, .balls, .txt, .xyzr or .woff;\n"
                      "a folder gets {name}-balls.ply; {name} is filled in");
    add_delta_options(*command, options->delta);
    add_quality_options(*command, options->suits_features, options->limits_deviation);
    add_union_option(*command, options->union_kind);
    add_source_options(*command, options->source);
    add_common_options(*command, options->common);
    command->footer("Example:\n  scaleaxis balls cat.obj --delta 0.02 -o cat-balls.ply");
    return {command, [options](const std::stop_token& cancel) { return run_balls(*options, cancel); }};
}

}  // namespace scaleaxis::app
