// SPDX-License-Identifier: GPL-3.0-or-later
// scaleaxis balls: solid → union of balls.
#include "scaleaxis/balls.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "report.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/sampling.hpp"
#include "solid.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct BallsOptions {
    std::optional<fs::path> input;
    SourceOptions source;
    std::string output;
    double delta = ScaleAxisOptions().delta;
    std::optional<double> absolute_delta;
    bool suits_features = false;
    bool limits_deviation = false;
    CommonOptions common;
};

Samples sampled(const Shape& shape, const BallsOptions& options, const Execution& execution) {
    return sample(shape,
                  {.tolerance = tolerance(shape.bounds().diagonal(), options.delta, options.absolute_delta),
                   .seed = options.common.seed,
                   .suits_features = options.suits_features,
                   .limits_deviation = options.limits_deviation},
                  execution);
}

Status run_balls(const BallsOptions& options) {
    const std::vector<Source> sources =
        sources_of(options.input ? std::vector{*options.input} : std::vector<fs::path>(), options.source);
    if (sources.size() > 1) {
        throw InvalidOption("--each-label needs more outputs than one: use scaleaxis axis with --balls");
    }
    const Source& source = sources.front();
    const fs::path output = checked_output(output_pattern(options.output, "balls", false), source.name, 1.0,
                                           options.common.statistics, check_balls_output);

    ProgressBar bar(source.name.filename().string(), options.common.verbosity());
    const Execution execution = bar.execution(options.common.threads);
    Solid solid = read_solid(source, execution);
    std::vector<StageCost> costs = solid.costs;
    Stopwatch watch;
    const Samples samples = solid.samples ? std::move(*solid.samples) : sampled(*solid.shape, options, execution);
    const auto sample_count = static_cast<Index>(samples.points.size());
    costs.push_back(watch.lap("sampling"));
    const std::vector<Ball> balls = inner_balls(samples, execution);
    costs.push_back(watch.lap("balls"));
    bar.erase();
    stop_if_interrupted();
    write_balls(output, balls);
    costs.push_back(watch.lap("writing"));

    if (options.common.has_summary()) {
        std::ostringstream text;
        text << source.name.string() << '\n';
        text << solid.description.text;
        print(text, sample_count, samples.tolerance, samples.statistics);
        print_balls(text, balls.size(), output);
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.balls/1");
    document.update({{"input", source.name.string()},
                     {solid.description.kind, solid.description.json},
                     {"tolerance", samples.tolerance},
                     {"seed", options.common.seed},
                     {"samples", sample_count},
                     {"sampling", to_json(samples.statistics)},
                     {"balls", balls.size()},
                     {"balls_file", output.string()},
                     {"costs", to_json(costs)},
                     {"warnings", solid.warnings}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace

Command balls_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("balls", "Union of balls that approximates a solid");
    auto options = std::make_shared<BallsOptions>();
    command->add_option("INPUT", options->input, "Mesh, 3D image, points or balls; none with --implicit")
        ->option_text(" ");
    command
        ->add_option("-o,--output", options->output,
                     "Balls: .ply, .balls, .txt, .xyzr or .woff;\n"
                     "a folder gets {name}-balls.ply; {name} is filled in")
        ->required()
        ->option_text("OUT");
    add_delta_options(*command, options->delta, options->absolute_delta);
    add_quality_options(*command, options->suits_features, options->limits_deviation);
    add_source_options(*command, options->source);
    add_common_options(*command, options->common);
    command->footer("Example:\n  scaleaxis balls cat.obj --delta 0.02 -o cat-balls.ply");
    return {command, [options] { return run_balls(*options); }};
}

}  // namespace scaleaxis::app
