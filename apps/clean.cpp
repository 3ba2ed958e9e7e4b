// SPDX-License-Identifier: Apache-2.0
// scaleaxis clean: a stored axis → the same without what has little erosion thickness.
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/report.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr Length kDefaultCleaning = 0.005;

struct StoredAxisOptions {
    fs::path input;
    std::string format;  ///< of the input; empty: its name or content tells
    std::string output;
    std::string output_format;
    std::optional<Length> cleaning;
    double scale = 1.0;
    CommonOptions common;
};

Status run_clean(StoredAxisOptions options, const std::stop_token& cancel) {
    const fs::path output =
        checked_output(output_pattern(options.output, "clean", false, options.output_format), options.input,
                       options.scale, options.common.statistics, with_format(check_axis_output, options.output_format));
    options.common.has_data_on_stdout = is_stdout(output);
    ProgressBar bar(options.input.filename().string(), options.common.verbosity());
    Stopwatch watch;
    const MedialComplex complex =
        reading(options.input, options.format, [](const fs::path& path) { return read_axis(path); });
    const ComplexReport before = report_of(complex);
    std::vector<StageCost> costs{watch.lap("reading")};
    const double thickness = options.cleaning.value_or(kDefaultCleaning).of(before.bounds.diagonal());
    const CleanedComplex cleaned =
        clean(complex, {thickness, options.scale}, bar.execution(options.common.threads, cancel));
    costs.push_back(watch.lap("cleaning"));
    bar.erase();
    stop_if_requested(cancel);
    write_axis(output, cleaned.complex, written_format(output, options.output_format));
    costs.push_back(watch.lap("writing"));

    const ComplexReport after = report_of(cleaned.complex);
    if (options.common.has_summary()) {
        std::ostringstream text;
        text << options.input.string() << '\n';
        print(text, before);
        print(text, cleaned.statistics);
        text << "\n-> " << output.string() << '\n';
        print(text, after);
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.clean/1");
    document.update({{"input", options.input.string()},
                     {"scale", options.scale},
                     {"before", json_of(before)},
                     {"cleaning", json_of(cleaned.statistics)},
                     {"file", output.string()},
                     {"after", json_of(after)},
                     {"costs", json_of(costs)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace

Command clean_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("clean", "Clean a stored axis: fewer sheets, curves in thin limbs");
    auto options = std::make_shared<StoredAxisOptions>();
    command->add_option("AXIS", options->input, "Axis: .ply or .ma, of this program or of others")
        ->required()
        ->option_text(" ");
    add_format_option(*command, options->format);
    add_output_option(*command, options->output, options->output_format,
                      "Axis: .ply, .ma, .vtp, .obj or .glb; a folder gets {name}-clean.ply;\n"
                      "{name} and {scale} are filled in");
    std::ostringstream default_value;
    default_value << kDefaultCleaning.value();
    add_clean_options(*command, options->cleaning, default_value.str());
    command
        ->add_option("--scale", options->scale,
                     "Factor by which the balls had been grown, and the radii of the axis divided" +
                         range_and_default(kScaleRange, options->scale))
        ->check(in_range(kScaleRange))
        ->option_text("S");
    add_common_options(*command, options->common);
    command->footer(
        "Example:\n"
        "  scaleaxis clean bunny.ma --clean 0.01 -o bunny-clean.ply");
    return {command, [options](const std::stop_token& cancel) { return run_clean(*options, cancel); }};
}

}  // namespace scaleaxis::app
