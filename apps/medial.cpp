// SPDX-License-Identifier: Apache-2.0
// scaleaxis medial: union of balls → its medial axis.
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
#include "readable.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/shrinking.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct MedialOptions {
    fs::path input;
    std::string format;  ///< of the input; empty: its name or content tells
    std::string output;
    std::string output_format;
    bool has_polygons = false;
    double scale = 1.0;
    bool is_dense = false;
    std::optional<double> filter_angle;
    CommonOptions common;
};

/// The axis of the balls, with all that it took in `report`.
MedialComplex computed(const std::vector<Ball>& balls, const MedialOptions& options, ProgressBar& bar,
                       const std::stop_token& cancel, AxisReport& report) {
    const auto execution = [&](double begin, double end) {
        return bar.execution(options.common.threads, cancel, {begin, end});
    };
    Stopwatch watch;
    MedialAxis axis = medial_axis(scaled(balls, options.scale), {.seed = options.common.seed}, execution(0.0, 0.7));
    MedialComplex complex = std::move(axis.complex);
    report.medial = axis.statistics;
    if (const std::optional<Diagnostic> warning = changed_union(axis.statistics)) {
        warn_above(bar, options.input)(*warning);
    }
    report.costs.push_back(watch.lap("medial axis"));
    if (options.filter_angle) {
        FilteredComplex filtered = filter(complex, {*options.filter_angle}, execution(0.7, 0.9));
        complex = std::move(filtered.complex);
        report.filter = filtered.statistics;
        report.costs.push_back(watch.lap("filter"));
    }
    complex = shrink(std::move(complex), options.scale);
    if (options.is_dense) {
        complex = densify(complex, {}, execution(0.9, 1.0));
    }
    report.costs.push_back(watch.lap("shrinking"));
    report.set_result(complex);
    return complex;
}

Status run_medial(MedialOptions options, const std::stop_token& cancel) {
    const fs::path output = checked_output(output_pattern(options.output, "medial", false, options.output_format),
                                           options.input, options.scale, options.common.statistics,
                                           axis_output_check(options.output_format, options.has_polygons));
    const std::string format = written_format(output, options.output_format);
    options.common.has_data_on_stdout = is_stdout(output);

    ProgressBar bar(options.input.filename().string(), options.common.verbosity());
    AxisReport report;
    report.scale = options.scale;
    report.file = output;
    Stopwatch watch;
    const std::vector<Ball> given =
        reading(options.input, options.format, [](const fs::path& path) { return read_balls(path); });
    const std::vector<Ball> balls = distinct_balls(given);
    report.costs.push_back(watch.lap("reading"));
    const MedialComplex complex = computed(balls, options, bar, cancel, report);
    bar.erase();
    stop_if_requested(cancel);
    watch.lap("");
    write_axis_file(output, complex, format, options.has_polygons, {options.common.threads, {}, cancel});
    report.costs.push_back(watch.lap("writing"));

    if (options.common.has_summary()) {
        std::ostringstream text;
        text << options.input.string() << '\n';
        print_balls(text, given.size());
        print(text, report);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.medial/1");
    document.update({{"input", options.input.string()},
                     {"seed", options.common.seed},
                     {"filter_angle", options.filter_angle ? Json(*options.filter_angle) : Json(nullptr)},
                     {"balls", given.size()},
                     {"axis", json_of(report)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace

Command medial_command(CommandLine program) {
    const CommandLine command = program.add_subcommand("medial", "Medial axis of any union of balls");
    auto options = std::make_shared<MedialOptions>();
    command.add_option("BALLS", options->input, "Balls: .ply with radius, text of x y z r a line, .woff")
        .required()
        .value_text(" ");
    add_format_option(command, options->format);
    add_output_option(command, options->output, options->output_format,
                      "Axis: .ply, .ma, .vtp, .obj or .glb; a folder gets {name}-medial.ply;\n"
                      "{name} and {scale} are filled in");
    add_number(command, "--scale", options->scale,
               "Factor by which the balls are grown, and the axis shrunk again; 1: exact medial axis", kScaleRange,
               "S");
    command
        .add_option("--angle", options->filter_angle,
                    "Remove sheets whose object angle is smaller, where that keeps the topology; degrees\n"
                    "[0 ... 90; default: no filter]")
        .check(in_range(kAngleRange))
        .value_text("A");
    add_dense_option(command, options->is_dense);
    add_polygons_option(command, options->has_polygons);
    add_common_options(command, options->common);
    command.footer(
        "Examples:\n"
        "  scaleaxis medial molecule.xyzr -o molecule-axis.ply\n"
        "  scaleaxis medial cat-balls.ply --scale 1.1 --angle 30 -o cat-axis.ply");
    return {command, [options](const std::stop_token& cancel) { return run_medial(*options, cancel); }};
}

}  // namespace scaleaxis::app
