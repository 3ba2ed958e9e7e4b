// SPDX-License-Identifier: Apache-2.0
// scaleaxis clean: a stored axis → the same without what has little erosion thickness.
#include <memory>
#include <optional>
#include <sstream>

#include "commands.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/report.hpp"
#include "stored_axis.hpp"

namespace scaleaxis::app {

namespace {

constexpr Length kDefaultCleaning = Length::relative(0.005);

struct CleaningOptions {
    StoredAxisOptions stored;
    std::optional<Length> thickness;
};

Status run_clean(const CleaningOptions& options, const std::stop_token& cancel) {
    const auto derive = [&](const MedialComplex& complex, double diagonal, const Execution& execution) {
        const double thickness = options.thickness.value_or(kDefaultCleaning).of(diagonal);
        CleanedComplex cleaned = clean(complex, {thickness}, execution);
        std::ostringstream summary;
        print(summary, cleaned.statistics);
        return DerivedAxis{std::move(cleaned.complex),
                           {{"cleaning", json_of(cleaned.statistics)}},
                           summary.str(),
                           coarse_axis_warning(complex)};
    };
    return run_stored_axis("clean", options.stored, cancel, derive);
}

}  // namespace

Command clean_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("clean", "Clean a stored axis: fewer sheets, curves in thin limbs");
    auto options = std::make_shared<CleaningOptions>();
    std::ostringstream default_value;
    default_value << kDefaultCleaning.value();
    add_clean_options(command, options->thickness, default_value.str());
    add_stored_axis_options(command, "clean", options->stored);
    command.footer(
        "Example:\n"
        "  scaleaxis clean bunny.ma --clean 0.01 -o bunny-clean.ply");
    return {command, [options](const std::stop_token& cancel) { return run_clean(*options, cancel); }};
}

}  // namespace scaleaxis::app
