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

#include "batch.hpp"
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
    std::string output_format;
    std::optional<Length> delta;
    std::optional<DeltaRange> delta_range;
    Sizing sizing = Sizing::kAdaptive;
    std::optional<UnionKind> union_kind;
    CommonOptions common;
};

/// Samples and balls; and what was tried before, if the tolerance was chosen.
struct Made {
    SampledUnion made;
    std::optional<DeltaChoice> delta_choice;
};

Made made_of_samples(Samples samples, const Execution& execution) {
    Made result;
    Stopwatch watch;
    result.made.balls.balls = inner_balls(samples, execution);
    result.made.costs.push_back(watch.lap("balls"));
    result.made.samples = std::move(samples);
    return result;
}

Made made_of_solid(const Solid& solid, const BallsOptions& options, const Execution& execution) {
    SamplingOptions sampling{.sizing = options.sizing, .seed = options.common.seed};
    const UnionOptions union_options{options.union_kind, std::nullopt, options.common.seed};
    if (options.delta_range) {
        ChosenUnion found = choose_delta(solid, *options.delta_range, sampling, union_options, execution);
        return {std::move(found.chosen), std::move(found.choice)};
    }
    sampling.tolerance = tolerance_of(options.delta.value_or(kDefaultDelta), solid.bounds().diagonal());
    return {sampled_union(solid, sampling, union_options, execution), std::nullopt};
}

Source single_source(const BallsOptions& options) {
    const std::vector<Source> sources =
        sources_of(options.input ? expanded({*options.input}) : std::vector<Input>(), options.source);
    if (sources.size() > 1 && !options.source.is_each_label) {
        throw InvalidOption("one input is needed, and these are " + std::to_string(sources.size()) +
                            ": use scaleaxis axis with --balls");
    }
    if (sources.size() > 1) {
        throw InvalidOption(std::string(options.source.is_each_object ? "--each-object" : "--each-label") +
                            " needs more outputs than one: use scaleaxis axis with --balls");
    }
    return sources.front();
}

Status run_balls_of(BallsOptions options, Source source, const ScaleAxisOptions& sampling,
                    const std::stop_token& cancel) {
    const fs::path output =
        checked_output(output_pattern(options.output, "balls", false, options.output_format), source.name, 1.0,
                       options.common.statistics, with_format(check_balls_output, options.output_format));
    options.common.has_data_on_stdout = is_stdout(output);

    source.options.load.delta = finest_delta(sampling);
    ProgressBar bar(source.name.filename().string(), options.common.verbosity());
    LoadedSolid input =
        load_source(source, bar.execution(options.common.threads, cancel, {0.0, 0.3}), warn_above(bar, source.name));
    if (input.samples && has_sampling_options(sampling)) {
        warn_above(bar, source.name)(unused_sampling_options());
    }
    check_can_fit(input, options.union_kind);
    const Execution execution = bar.execution(options.common.threads, cancel, {0.3, 1.0});
    const Made result = input.samples ? made_of_samples(std::move(*input.samples), execution)
                                      : made_of_solid(*input.solid, options, execution);
    const Samples& samples = result.made.samples;
    const std::vector<Ball>& balls = result.made.balls.balls;
    const std::optional<FitReport>& fit = result.made.balls.fit;
    const auto sample_count = static_cast<Index>(samples.points.size());
    std::vector<StageCost> costs = input.costs;
    costs.insert(costs.end(), result.made.costs.begin(), result.made.costs.end());
    std::vector<Diagnostic> warnings = input.warnings;
    warnings.insert(warnings.end(), result.made.balls.warnings.begin(), result.made.balls.warnings.end());
    std::ranges::for_each(result.made.balls.warnings, warn_above(bar, source.name));
    Stopwatch watch;
    bar.erase();
    stop_if_requested(cancel);
    write_balls(output, balls, written_format(output, options.output_format));
    costs.push_back(watch.lap("writing"));

    if (options.common.has_summary()) {
        std::ostringstream text;
        text << source.name.string() << '\n';
        print(text, input.input);
        print_samples(text, sample_count, samples.tolerance, samples.statistics);
        if (result.delta_choice) {
            print(text, *result.delta_choice);
        }
        print_balls(text, balls.size(), output);
        if (fit) {
            print(text, *fit);
        }
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.balls/2");
    document.update({{"input", source.name.string()},
                     {std::string(name_of(input.input)), json_of(input.input)},
                     {"tolerance", samples.tolerance},
                     {"delta_choice", json_of(result.delta_choice)},
                     {"seed", options.common.seed},
                     {"samples", sample_count},
                     {"sampling", json_of(samples.statistics)},
                     {"balls", balls.size()},
                     {"fit", json_of(fit)},
                     {"balls_file", output.string()},
                     {"costs", json_of(costs)},
                     {"warnings", json_of(warnings)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

Status run_balls(const BallsOptions& options, const std::stop_token& cancel) {
    const ScaleAxisOptions sampling{
        .delta = options.delta, .delta_range = options.delta_range, .sizing = options.sizing};
    check_sampling_options(options.source, has_sampling_options(sampling));
    const Source source = single_source(options);
    return telling_source(source, [&] { return run_balls_of(options, source, sampling, cancel); });
}

}  // namespace

Command balls_command(CommandLine program) {
    const CommandLine command = program.add_subcommand("balls", "Union of balls that approximates a solid");
    auto options = std::make_shared<BallsOptions>();
    command.add_option("INPUT", options->input, "Mesh, 3D image, points or balls; none with --implicit")
        .value_text(" ");
    add_output_option(command, options->output, options->output_format,
                      "Balls: .ply, .balls, .txt, .xyzr or .woff;\n"
                      "a folder gets {name}-balls.ply; {name} is filled in");
    add_delta_options(command, options->delta, &options->delta_range);
    add_sampling_option(command, options->sizing);
    add_union_option(command, options->union_kind);
    add_source_options(command, options->source);
    add_common_options(command, options->common);
    command.footer("Example:\n  scaleaxis balls cat.obj --delta 0.02 -o cat-balls.ply");
    return {command, [options](const std::stop_token& cancel) { return run_balls(*options, cancel); }};
}

}  // namespace scaleaxis::app
