// SPDX-License-Identifier: GPL-3.0-or-later
// scaleaxis sample-field: union of balls → image of its signed distance.
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "report.hpp"
#include "scaleaxis/field.hpp"
#include "scaleaxis/io.hpp"
#include "solid.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr Range kResolutionRange{8, 4096};

struct FieldOptions {
    fs::path input;
    std::string output;
    Index resolution = 128;
    CommonOptions common;
};

Status run_sample_field(const FieldOptions& options) {
    const fs::path output =
        checked_output(options.output, options.input, 1.0, options.common.statistics, check_image_output);

    ProgressBar bar(options.input.filename().string(), options.common.verbosity());
    const Execution execution = bar.execution(options.common.threads);
    Stopwatch watch;
    const std::vector<Ball> balls = read_union(options.input);
    std::vector<StageCost> costs{watch.lap("reading")};
    const Image image = signed_distance_image(balls, options.resolution, execution);
    costs.push_back(watch.lap("field"));
    bar.erase();
    stop_if_interrupted();
    write_image(output, image);
    costs.push_back(watch.lap("writing"));

    const auto& [sizes, origin, steps, values] = image;
    const double spacing = norm(steps[0]);
    if (options.common.has_summary()) {
        std::ostringstream text;
        text << options.input.string() << '\n';
        print_balls(text, balls.size(), std::nullopt);
        label(text, "field") << sizes[0] << " x " << sizes[1] << " x " << sizes[2] << " points, " << spacing
                             << " apart -> " << output.string() << '\n';
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.field/1");
    document.update({{"input", options.input.string()},
                     {"balls", balls.size()},
                     {"file", output.string()},
                     {"sizes", sizes},
                     {"origin", {origin.x, origin.y, origin.z}},
                     {"spacing", spacing},
                     {"costs", to_json(costs)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace

Command sample_field_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("sample-field", "Signed distance to a union of balls as a 3D image");
    auto options = std::make_shared<FieldOptions>();
    add_union_argument(*command, options->input);
    command->add_option("-o,--output", options->output, "Image: .nrrd (32-bit floats); {name} is filled in")
        ->required()
        ->option_text("OUT");
    command
        ->add_option(
            "--resolution", options->resolution,
            "Points along the longest side of the grid" + range_and_default(kResolutionRange, options->resolution))
        ->check(in_range(kResolutionRange))
        ->option_text("N");
    add_common_options(*command, options->common);
    command->footer(
        "The value is the least of |p - centre| - radius: negative inside, and outside the distance to the union.\n"
        "Example:\n  scaleaxis sample-field cat-balls.ply --resolution 256 -o cat.nrrd");
    return {command, [options] { return run_sample_field(*options); }};
}

}  // namespace scaleaxis::app
