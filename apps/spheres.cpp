// SPDX-License-Identifier: Apache-2.0
// scaleaxis spheres: solid, axis or robot → a few spheres that cover it, or lie inside.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "balls_or_axis.hpp"
#include "batch.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/few_balls.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/thickness.hpp"
#include "source.hpp"
#include "sphere_files.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"
#include "urdf.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr Range kEffortRange{0.01, 1000.0};

// Of the diagonal: spacing of the points that the result is measured at.
constexpr double kScoredSpacing = 0.004;
constexpr double kPointsOfSpacing = 10.0;  // of `points_left_out` for each square of its spacing

struct SpheresOptions {
    std::optional<fs::path> input;
    SourceOptions source;
    std::string output;
    std::string output_format;
    std::optional<Index> count;
    std::optional<Length> error;
    double effort = FewBallsOptions().effort;
    bool covers = false;
    bool is_inside = false;
    std::optional<Length> delta;
    Sizing sizing = Sizing::kAdaptive;
    std::vector<fs::path> packages;
    CommonOptions common;

    FewBallsKind kind() const { return is_inside ? FewBallsKind::kInside : FewBallsKind::kCover; }
};

/// What was found for one solid.
struct Spheres {
    LinkSpheres link;
    std::string summary;
};

Spheres spheres_of(const std::string& name, const Solid& solid, const SampledUnion& made, const SpheresOptions& options,
                   const std::optional<Index>& count, const TriangleMesh& left_out, const Execution& execution) {
    const double diagonal = solid.bounds().diagonal();
    FewBallsOptions few_options{.kind = options.kind(), .count = count, .effort = options.effort};
    if (options.error) {
        few_options.error = options.error->of(diagonal);
    }
    FewBalls few = few_balls(made.balls.balls, made.samples.points, solid, few_options, execution);
    const double spacing = kScoredSpacing * diagonal;
    std::vector<Point> points = solid.seeds(spacing, options.common.seed + 1, {});
    if (points.empty()) {
        points = made.samples.points;
    }
    if (!left_out.triangles.empty()) {
        // As dense as the points of the solid, which may be ten for each square of the spacing, or one.
        const TriangleMesh boundary = boundary_mesh(made.samples, execution).mesh;
        const double area = surface_values(boundary, std::vector<double>(boundary.vertices.size())).area;
        const double as_dense = std::sqrt(kPointsOfSpacing * area / static_cast<double>(points.size()));
        const std::vector<Point> others = points_left_out({left_out.vertices, left_out.triangles}, solid, as_dense,
                                                          options.common.seed + 1, execution);
        points.insert(points.end(), others.begin(), others.end());
    }
    const BallScores scores = ball_scores(few.balls, points, solid, options.common.seed, execution);
    std::ostringstream text;
    print_balls(text, few.balls.size());
    print(text, few.statistics);
    print(text, scores);
    Json statistics = json_of(few.statistics);
    statistics["diagonal"] = diagonal;
    statistics["scores"] = json_of(scores);
    return {{name, std::move(few.balls), std::move(statistics)}, text.str()};
}

SampledUnion union_for(const Solid& solid, const SpheresOptions& options, const Execution& execution) {
    const double diagonal = solid.bounds().diagonal();
    const SamplingOptions sampling{.tolerance = tolerance_of(options.delta.value_or(kDefaultDelta), diagonal),
                                   .sizing = options.sizing,
                                   .seed = options.common.seed};
    return sampled_union(solid, sampling, {.seed = options.common.seed, .keeps_all = true}, execution);
}

/// A solid that does not know the nearest points of its boundary is replaced by the union of its balls.
/// \param left_out see `SolidOfTriangles`
Spheres spheres_of(const std::string& name, const Solid* solid, std::optional<Samples> samples,
                   const SpheresOptions& options, const std::optional<Index>& count, const TriangleMesh& left_out,
                   const Execution& execution) {
    if (solid != nullptr && solid->knows_nearest()) {
        return spheres_of(name, *solid, union_for(*solid, options, execution), options, count, left_out, execution);
    }
    SampledUnion made;
    if (samples) {
        made.samples = std::move(*samples);
        made.balls.balls = inner_balls(made.samples, execution);
    } else {
        made = union_for(*solid, options, execution);
    }
    const std::unique_ptr<Solid> approximation = union_solid(made.balls.balls, execution);
    return spheres_of(name, *approximation, union_for(*approximation, options, execution), options, count, left_out,
                      execution);
}

/// Spheres that a link has already stay as they are, and count.
Spheres spheres_of(const LinkShape& shape, const SpheresOptions& options, const std::string& where,
                   const Execution& execution) {
    Spheres result{{shape.link, {}, {}}, {}};
    if (!shape.mesh.triangles.empty()) {
        const SolidOfTriangles made = solid_of_triangles(shape.mesh, options.source.load.solid, execution);
        if (!made.solid) {
            Diagnostic fault = made.report.fault;
            fault.message.insert(0, where + ": link " + shape.link + ": ");
            throw UnusableInput(fault);
        }
        std::optional<Index> count = options.count;
        if (count) {
            *count = std::max<Index>(1, *count - static_cast<Index>(shape.spheres.size()));
        }
        result = spheres_of(shape.link, made.solid.get(), std::nullopt, options, count, made.left_out, execution);
    }
    std::vector<Ball>& balls = result.link.balls;
    balls.insert(balls.end(), shape.spheres.begin(), shape.spheres.end());
    return result;
}

bool is_axis(const fs::path& file, const SpheresOptions& options) {
    return !options.source.load.kind && options.source.format.empty() && fs::is_regular_file(file) &&
           file_kind(file) == FileKind::kAxis;
}

Spheres spheres_of_input(const SpheresOptions& options, Source source, const Listener& listener) {
    const Execution execution = listener.execution({0.3, 1.0});
    const std::string name = stem_of(source.name);
    if (is_axis(source.file, options)) {
        const BallsOrAxis given = read_balls_or_axis(source.file, false);
        const std::unique_ptr<Solid> solid = envelope_solid(std::get<Envelope>(given.solid), 0.0, execution);
        return spheres_of(name, solid.get(), std::nullopt, options, options.count, {}, execution);
    }
    source.options.load.delta = options.delta;
    LoadedSolid loaded = load_source(source, listener.execution({0.0, 0.3}), listener.warn_about(source.name));
    return spheres_of(name, loaded.solid.get(), std::move(loaded.samples), options, options.count, loaded.left_out,
                      execution);
}

std::vector<Spheres> spheres_of_links(const SpheresOptions& options, const Source& source, const Robot& robot,
                                      const Listener& listener) {
    std::vector<Spheres> found;
    const auto count = static_cast<double>(robot.links().size());
    for (std::size_t i = 0; i < robot.links().size(); ++i) {
        const WorkShare share{static_cast<double>(i) / count, static_cast<double>(i + 1) / count};
        found.push_back(spheres_of(robot.links()[i], options, source.name.string(), listener.execution(share)));
    }
    return found;
}

std::string extension_for(const Source& source) { return is_urdf(source.file) ? "urdf" : "json"; }

SourceResult run_source(const SpheresOptions& options, const Source& source, const fs::path& output,
                        const Listener& listener, const std::stop_token& cancel) {
    Stopwatch watch;
    std::optional<Robot> robot;
    if (is_urdf(source.file)) {
        robot.emplace(source.file, options.packages);
    }
    const std::vector<Spheres> found = robot ? spheres_of_links(options, source, *robot, listener)
                                             : std::vector{spheres_of_input(options, source, listener)};
    std::vector<StageCost> costs{watch.lap("spheres")};
    stop_if_requested(cancel);

    std::vector<LinkSpheres> links;
    std::ranges::transform(found, std::back_inserter(links), &Spheres::link);
    const std::string format = written_format(output, options.output_format, extension_for(source));
    if (robot && (format == "urdf" || (format.empty() && is_urdf(output)))) {
        const std::string text = robot->with_spheres(links);
        is_stdout(output) ? print_text(text) : write_text(output, text);
    } else {
        write_spheres(output, format, robot ? robot->name() : stem_of(source.name), links);
    }
    costs.push_back(watch.lap("writing"));

    std::ostringstream text;
    text << source.name.string() << '\n';
    for (const Spheres& each : found) {
        if (robot) {
            label(text, "link") << each.link.link << ", " << each.link.balls.size() << " in all\n";
        }
        text << each.summary;
    }
    text << "-> " << output.string() << '\n';
    print(text, costs);
    Json by_link = Json::array();
    for (const LinkSpheres& link : links) {
        by_link.push_back({{"link", link.link}, {"balls", link.balls.size()}, {"statistics", link.statistics}});
    }
    return {{{"input", source.name.string()},
             {"kind", options.is_inside ? "inside" : "cover"},
             {"seed", options.common.seed},
             {"links", by_link},
             {"file", output.string()},
             {"costs", json_of(costs)}},
            text.str()};
}

Status run_spheres(SpheresOptions options, const std::stop_token& cancel) {
    if (options.count.has_value() == options.error.has_value()) {
        throw InvalidOption("either --count or --error is needed" + std::string(options.count ? ", not both" : ""));
    }
    const std::vector<Source> sources =
        sources_of(options.input ? expanded({*options.input}) : std::vector<Input>(), options.source);
    if (sources.size() != 1 && !is_each(options.source)) {
        throw InvalidOption("one input is needed, and these are " + std::to_string(sources.size()));
    }
    std::vector<fs::path> files;
    for (const Source& source : sources) {
        const bool is_robot = is_urdf(source.file);
        if (is_robot) {
            check_unused(options.source, "a robot, whose links are meshes", {"--solid", "--opening", "--thickness"});
        } else if (is_axis(source.file, options)) {
            check_unused(options.source, "an axis that is there already", {});
        }
        if (!options.packages.empty() && !is_robot) {
            throw InvalidOption("--package is for robots (.urdf)");
        }
        const std::string extension = extension_for(source);
        files.push_back(expand(output_pattern(options.output, "spheres", false, options.output_format, extension),
                               source.name, 1.0));
        check_output(files.back(), [&](const fs::path& file) {
            check_spheres_output(file, written_format(file, options.output_format, extension));
        });
    }
    check_all_outputs(sources, files, options.common);
    return run_sources(sources, options.source, options.common, new_document("scaleaxis.spheres/1"), cancel,
                       [&](std::size_t i, const Listener& listener) {
                           return run_source(options, sources[i], files[i], listener, cancel);
                       });
}

}  // namespace

Command spheres_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("spheres", "A few spheres that cover a solid or the links of a robot, or lie inside");
    auto options = std::make_shared<SpheresOptions>();
    command
        .add_option("INPUT", options->input,
                    "Mesh, 3D image, points, balls, axis, or robot (.urdf); none with --implicit")
        .value_text(" ");
    add_output_option(
        command, options->output, options->output_format,
        "Spheres: .json, .yaml (cuRobo), .csv, .urdf, .srdf, or balls: .ply, .balls, .txt, .xyzr, .woff;\n"
        "a folder gets {name}-spheres.json; {name} is filled in");
    command.add_option("--count", options->count, "Number of spheres; of a robot, for each link")
        .check(whole_in_range({1, 100000}))
        .value_text("N");
    add_length_options(command, "--error", options->error, kCompactErrorRange,
                       "In place of the number: as few as stick out of the solid by no more than this, or with\n"
                       "--inside leave no larger gap; relative to the diagonal of the bounding box\n[1e-06 ... 0.5]");
    command
        .add_option("--effort", options->effort,
                    "How long the search for fewer or better balls goes on, relative to the default" +
                        range_and_default(kEffortRange, options->effort))
        .check(in_range(kEffortRange))
        .value_text("E");
    const Option cover =
        command.add_flag("--cover", options->covers, "Spheres that cover the solid (default)").value_text(" ");
    command.add_flag("--inside", options->is_inside, "Spheres that lie inside the solid")
        .excludes(cover)
        .value_text(" ");
    command
        .add_option("--package", options->packages,
                    "Of a robot: the folder of a package that package:// names, or that packages are in")
        .one_text_each()
        .value_text("DIR");
    add_delta_options(command, options->delta, nullptr);
    add_sampling_option(command, options->sizing);
    add_source_options(command, options->source);
    add_common_options(command, options->common);
    command.footer(
        "Examples:\n"
        "  scaleaxis spheres gripper.stl --count 16 -o gripper.yaml\n"
        "  scaleaxis spheres robot.urdf --error 0.02 -o robot-spheres.urdf\n"
        "  scaleaxis spheres cat-axis.ply --count 60 --inside -o cat-few.ply");
    return {command, [options](const std::stop_token& cancel) { return run_spheres(*options, cancel); }};
}

}  // namespace scaleaxis::app
