// SPDX-License-Identifier: Apache-2.0
// scaleaxis sample-field: union of balls → image of its signed distance.
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "balls_or_axis.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/field.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct FieldOptions {
    BallsOrAxisOptions given;
    std::string output;
    std::string output_format;
    Index resolution = 128;
    CommonOptions common;
};

Status run_sample_field(FieldOptions options, const std::stop_token& cancel) {
    const fs::path output = checked_output(
        output_pattern(options.output, "field", false, options.output_format, "nrrd"), options.given.input, 1.0,
        options.common.statistics, with_format(check_image_output, options.output_format, "nrrd"));
    const std::string format = written_format(output, options.output_format, "nrrd");
    options.common.has_data_on_stdout = is_stdout(output);

    ProgressBar bar(options.given.input.filename().string(), options.common.verbosity());
    const Execution execution = bar.execution(options.common.threads, cancel);
    Stopwatch watch;
    const BallsOrAxis given = reading(options.given.input, options.given.format, [&](const fs::path& path) {
        return read_balls_or_axis(path, options.given.takes_balls_only, options.given.scale);
    });
    std::vector<StageCost> costs{watch.lap("reading")};
    const Image image = std::visit(
        [&](const auto& solid) { return signed_distance_image(solid, options.resolution, execution); }, given.solid);
    costs.push_back(watch.lap("field"));
    bar.erase();
    stop_if_requested(cancel);
    write_image(output, image, format);
    costs.push_back(watch.lap("writing"));

    const auto& sizes = image.sizes;
    const Point& origin = image.origin;
    const double spacing = norm(image.steps[0]);
    if (options.common.has_summary()) {
        std::ostringstream text;
        text << options.given.input.string() << '\n';
        print_balls(text, given.balls);
        label(text, "field") << sizes[0] << " x " << sizes[1] << " x " << sizes[2] << " points, " << spacing
                             << " apart -> " << output.string() << '\n';
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.field/1");
    document.update({{"input", options.given.input.string()},
                     {"balls", given.balls},
                     {"file", output.string()},
                     {"sizes", sizes},
                     {"origin", {origin.x, origin.y, origin.z}},
                     {"spacing", spacing},
                     {"costs", json_of(costs)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace

Command sample_field_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("sample-field", "Signed distance to a union of balls, or to an axis, as a 3D image");
    auto options = std::make_shared<FieldOptions>();
    add_balls_or_axis_options(command, options->given);
    add_output_option(command, options->output, options->output_format,
                      "Image: .nrrd (32-bit floats); a folder gets {name}-field.nrrd; {name} is filled in");
    add_number(command, "--resolution", options->resolution, "Points along the longest side of the grid",
               kResolutionRange, "N");
    add_common_options(command, options->common);
    command.footer(
        "The value is the least of |p - centre| - radius: negative inside, and outside the distance to the union.\n"
        "Example:\n  scaleaxis sample-field cat-balls.ply --resolution 256 -o cat.nrrd");
    return {command, [options](const std::stop_token& cancel) { return run_sample_field(*options, cancel); }};
}

}  // namespace scaleaxis::app
