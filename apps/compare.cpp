// SPDX-License-Identifier: Apache-2.0
// scaleaxis compare: distances between two surfaces.
#include <array>
#include <filesystem>
#include <iomanip>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "balls_or_axis.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr Range kSpacingRange{1e-5, 0.5};
constexpr double kAccuracyOfSpacing = 0.01;

struct CompareOptions {
    std::array<fs::path, 2> inputs;
    double spacing = 0.002;
    bool takes_balls_only = false;
    bool is_json = false;
    int threads = 0;
    std::uint64_t seed = 1;
};

Surface read_surface(const fs::path& file, bool takes_balls_only) {
    return reading(file, {}, [&](const fs::path& path) {
        if (file_kind(path) == FileKind::kMesh) {
            return Surface(read_mesh_with_warnings(path, file));
        }
        return std::visit([](auto solid) { return Surface(std::move(solid)); },
                          read_balls_or_axis(path, takes_balls_only).solid);
    });
}

std::string_view kind_of(const Surface& surface) { return std::array{"mesh", "balls", "axis"}.at(surface.index()); }

/// Lengths beside the same relative to the diagonal of A.
Json with_relative(double length, double diagonal) {
    return {{"absolute", length}, {"relative", diagonal > 0.0 ? Json(length / diagonal) : Json(nullptr)}};
}

Json side_to_json(const OneSidedDistance& distance, double diagonal) {
    return {{"max", with_relative(distance.max, diagonal)},
            {"error", with_relative(distance.error, diagonal)},
            {"mean", with_relative(distance.mean, diagonal)},
            {"rms", with_relative(distance.rms, diagonal)},
            {"farthest", {distance.farthest.x, distance.farthest.y, distance.farthest.z}},
            {"samples", distance.samples}};
}

void print_side(std::ostream& out, std::string_view name, const OneSidedDistance& distance, double diagonal) {
    const auto line = [&](std::string_view first, std::string_view what, double length) {
        std::ostringstream text;
        text << std::left << std::setw(26) << what << std::right << std::setw(12) << length << std::setw(14)
             << length / diagonal;
        label(out, first) << text.str() << '\n';
    };
    line(name, "Hausdorff, one-sided", distance.max);
    line("", "  at most larger by", distance.error);
    line("", "mean", distance.mean);
    line("", "root mean square", distance.rms);
    label(out, "") << "of " << distance.samples << " points; farthest at " << distance.farthest.x << ' '
                   << distance.farthest.y << ' ' << distance.farthest.z << '\n';
}

Status run_compare(const CompareOptions& options, const std::stop_token& cancel) {
    ProgressBar bar("compare", options.is_json ? Verbosity::kQuiet : Verbosity::kNormal);
    const Execution execution = bar.execution(options.threads, cancel);
    Stopwatch watch;
    const std::array<Surface, 2> surfaces{read_surface(options.inputs[0], options.takes_balls_only),
                                          read_surface(options.inputs[1], options.takes_balls_only)};
    std::vector<StageCost> costs{watch.lap("reading")};
    const double diagonal = surface_bounds(surfaces[0]).diagonal();
    const double spacing = options.spacing * diagonal;
    const SurfaceDistance distance =
        surface_distance(surfaces[0], surfaces[1], {spacing, kAccuracyOfSpacing * spacing, options.seed}, execution);
    costs.push_back(watch.lap("distance"));
    bar.erase();

    if (options.is_json) {
        Json document = new_document("scaleaxis.compare/1");
        document.update({{"a", {{"file", options.inputs[0].string()}, {"kind", kind_of(surfaces[0])}}},
                         {"b", {{"file", options.inputs[1].string()}, {"kind", kind_of(surfaces[1])}}},
                         {"diagonal", diagonal},
                         {"spacing", with_relative(spacing, diagonal)},
                         {"hausdorff", with_relative(distance.max(), diagonal)},
                         {"error", with_relative(distance.error(), diagonal)},
                         {"a_to_b", side_to_json(distance.a_to_b, diagonal)},
                         {"b_to_a", side_to_json(distance.b_to_a, diagonal)},
                         {"costs", json_of(costs)}});
        print_text(to_text(document));
        return kDone;
    }
    std::ostringstream text;
    text << "A = " << options.inputs[0].string() << " (" << kind_of(surfaces[0])
         << "), B = " << options.inputs[1].string() << " (" << kind_of(surfaces[1]) << ")\n";
    label(text, "") << std::string(26, ' ') << "    absolute    / diagonal of A\n";
    print_side(text, "A to B", distance.a_to_b, diagonal);
    print_side(text, "B to A", distance.b_to_a, diagonal);
    label(text, "Hausdorff") << "two-sided " << distance.max() << ", relative " << distance.max() / diagonal
                             << "; at most larger by " << distance.error() << '\n';
    label(text, "points") << "at most " << spacing << " from any other one of their surface; diagonal of A " << diagonal
                          << '\n';
    print(text, costs);
    print_text(text.str());
    return kDone;
}

}  // namespace

Command compare_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("compare", "Distances between two surfaces: meshes, unions of balls, axes");
    auto options = std::make_shared<CompareOptions>();
    command.add_option("A", options->inputs[0], "Mesh, balls or axis").required().value_text(" ");
    command.add_option("B", options->inputs[1], "Mesh, balls or axis").required().value_text(" ");
    add_number(command, "--spacing", options->spacing,
               "Every point of a surface is at most this far from one whose distance is computed,\n"
               "relative to the diagonal of A",
               kSpacingRange, "R");
    add_balls_only_option(command, options->takes_balls_only);
    command.add_flag("--json", options->is_json, "As JSON").value_text(" ");
    add_threads_option(command, options->threads);
    add_seed_option(command, options->seed);
    command.footer(
        "Of a union of balls the boundary is measured, of an axis that of the envelope of its balls, interpolated "
        "along\n"
        "edges and faces. Of several closed parts, nested ones too, all surfaces count.\n"
        "Example:\n  scaleaxis compare cat.obj cat-balls.ply --json");
    return {command, [options](const std::stop_token& cancel) { return run_compare(*options, cancel); }};
}

}  // namespace scaleaxis::app
