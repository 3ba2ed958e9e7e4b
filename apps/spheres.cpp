// SPDX-License-Identifier: Apache-2.0
// scaleaxis spheres: solid, axis or robot → a few spheres that cover it, or lie inside.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
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
#include "scaleaxis/errors.hpp"
#include "scaleaxis/few_balls.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/robot.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "source.hpp"
#include "sphere_files.hpp"
#include "status.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"
#include "xacro.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr Range kEffortRange{0.01, 1000.0};

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
    std::optional<Index> total;
    std::optional<Index> large;  ///< 1 if it is not given
    std::vector<std::string> clip;
    std::vector<std::string> rest;
    std::vector<std::string> xacro;
    std::vector<fs::path> packages;
    CommonOptions common;

    FewBallsKind kind() const { return is_inside ? FewBallsKind::kInside : FewBallsKind::kCover; }
};

/// What was found for one solid.
struct Spheres {
    NamedSpheres link;
    std::string summary;
};

/// A plane of `--clip-plane`: "LINK:z:0", "LINK:-x:0.1", "LINK:0,1,1:0.2"; of a solid that is no robot without the
/// link.
struct ClipPlane {
    std::string link;
    HalfSpace space;
};

ClipPlane clip_plane(const std::string& text) {
    static const std::map<std::string, Point> kAxes{{"x", {1, 0, 0}},   {"y", {0, 1, 0}},   {"z", {0, 0, 1}},
                                                    {"-x", {-1, 0, 0}}, {"-y", {0, -1, 0}}, {"-z", {0, 0, -1}}};
    const std::size_t last = text.rfind(':');
    const std::size_t middle = last == std::string::npos || last == 0 ? last : text.rfind(':', last - 1);
    const std::string axis = last == std::string::npos
                                 ? ""
                                 : text.substr(middle == std::string::npos ? 0 : middle + 1,
                                               last - (middle == std::string::npos ? 0 : middle + 1));
    ClipPlane plane{middle == std::string::npos ? "" : text.substr(0, middle), {}};
    bool is_good = last != std::string::npos;
    if (const auto known = kAxes.find(axis); known != kAxes.end()) {
        plane.space.normal = known->second;
    } else {
        std::istringstream stream(axis);
        char comma = 0, other = 0;
        Point& n = plane.space.normal;
        is_good = is_good && stream >> n.x >> comma >> n.y >> other >> n.z && comma == ',' && other == ',' &&
                  stream.eof() && norm(n) > 0.0;
    }
    std::istringstream offset(is_good ? text.substr(last + 1) : "");
    if (!(offset >> plane.space.offset) || !offset.eof()) {
        throw InvalidOption("--clip-plane " + text +
                            ": LINK:AXIS:OFFSET is expected, as in base:z:0, where the axis may also be "
                            "-z or a normal as in 0,1,1");
    }
    return plane;
}

std::string summary_of(std::size_t balls, const FewBallsStatistics& statistics, const BallScores& scores) {
    std::ostringstream text;
    print_balls(text, balls);
    print(text, statistics);
    print(text, scores);
    return text.str();
}

Json statistics_of(const FewBallsStatistics& found, double diagonal, const BallScores& scores) {
    Json statistics = json_of(found);
    statistics["diagonal"] = diagonal;
    statistics["scores"] = json_of(scores);
    return statistics;
}

Spheres spheres_of(const std::string& name, const Solid& solid, const SampledUnion& made, const SpheresOptions& options,
                   const TriangleMesh& left_out, const Execution& execution) {
    const double diagonal = solid.bounds().diagonal();
    FewBallsOptions few_options{.kind = options.kind(), .count = options.count, .effort = options.effort};
    if (options.error) {
        few_options.error = options.error->of(diagonal);
    }
    for (const std::string& text : options.clip) {
        few_options.clip.push_back(clip_plane(text).space);
    }
    FewBalls few = few_balls(made.balls.balls, made.samples.points, solid, few_options, execution);
    const std::vector<Point> points = points_to_score(solid, made.samples, left_out, options.common.seed, execution);
    const BallScores scores = ball_scores(few.balls, points, solid, options.common.seed, execution);
    const std::string summary = summary_of(few.balls.size(), few.statistics, scores);
    return {{name, std::move(few.balls), statistics_of(few.statistics, diagonal, scores)}, summary};
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
                   const SpheresOptions& options, const TriangleMesh& left_out, const Execution& execution) {
    if (solid != nullptr && solid->knows_nearest()) {
        return spheres_of(name, *solid, union_for(*solid, options, execution), options, left_out, execution);
    }
    SampledUnion made;
    if (samples) {
        made.samples = std::move(*samples);
        made.balls.balls = inner_balls(made.samples, execution);
    } else {
        made = union_for(*solid, options, execution);
    }
    const std::unique_ptr<Solid> approximation = union_solid(made.balls.balls, execution);
    return spheres_of(name, *approximation, union_for(*approximation, options, execution), options, left_out,
                      execution);
}

Robot read_robot(const SpheresOptions& options, const Source& source) {
    RobotOptions robot_options{.packages = options.packages};
    for (const std::string& text : options.rest) {
        const std::size_t equals = text.rfind('=');
        std::istringstream value(equals == std::string::npos ? "" : text.substr(equals + 1));
        double position = 0.0;
        if (!(value >> position) || !value.eof()) {
            throw InvalidOption("--rest " + text + ": JOINT=POSITION is expected, as in elbow=-1.5");
        }
        robot_options.rest[text.substr(0, equals)] = position;
    }
    Robot robot = is_xacro(source.file) ? Robot(expanded_xacro(source.file, options.xacro), source.file, robot_options)
                                        : Robot(source.file, robot_options);
    for (const Diagnostic& warning : robot.warnings()) {
        print_warning(with_hints(warning));
    }
    return robot;
}

std::vector<Spheres> spheres_of_links(const SpheresOptions& options, const Robot& robot, const Listener& listener) {
    RobotSpheresOptions own{.kind = options.kind(),
                            .count = options.count,
                            .total = options.total,
                            .error = options.error,
                            .effort = options.effort,
                            .delta = options.delta.value_or(kDefaultDelta),
                            .sizing = options.sizing,
                            .seed = options.common.seed,
                            .solid = options.source.load.solid};
    for (const std::string& text : options.clip) {
        const ClipPlane plane = clip_plane(text);
        own.clip[plane.link].push_back(plane.space);
    }
    std::vector<Spheres> found;
    for (LinkSpheres& link : robot_spheres(robot, own, listener.execution({0.0, 1.0}))) {
        Spheres& next = found.emplace_back(Spheres{{link.link, std::move(link.balls), {}}, {}});
        if (link.statistics && link.scores) {
            next.link.statistics = statistics_of(*link.statistics, link.diagonal, *link.scores);
            next.summary = summary_of(next.link.balls.size(), *link.statistics, *link.scores);
        }
    }
    return found;
}

Spheres spheres_of_input(const SpheresOptions& options, Source source, const Listener& listener) {
    const Execution execution = listener.execution({0.3, 1.0});
    const std::string name = stem_of(source.name);
    if (source.is_axis) {
        const BallsOrAxis given = reading(source, [](const fs::path& path) { return read_balls_or_axis(path, false); });
        const std::unique_ptr<Solid> solid = envelope_solid(std::get<Envelope>(given.solid), 0.0, execution);
        return spheres_of(name, solid.get(), std::nullopt, options, {}, execution);
    }
    source.options.load.delta = options.delta;
    LoadedSolid loaded = load_source(source, listener.execution({0.0, 0.3}), listener.warn_about(source.name));
    return spheres_of(name, loaded.solid.get(), std::move(loaded.samples), options, loaded.left_out, execution);
}

bool is_urdf(const fs::path& file) { return format_of(file, "") == "urdf"; }
bool is_robot(const fs::path& file) { return is_urdf(file) || is_xacro(file); }

std::string extension_for(const Source& source) { return is_robot(source.file) ? "urdf" : "json"; }

SourceResult run_source(const SpheresOptions& options, const Source& source, const fs::path& output,
                        const Listener& listener, const std::stop_token& cancel) {
    Stopwatch watch;
    std::optional<Robot> robot;
    if (is_robot(source.file)) {
        robot.emplace(read_robot(options, source));
    }
    const std::vector<Spheres> found =
        robot ? spheres_of_links(options, *robot, listener) : std::vector{spheres_of_input(options, source, listener)};
    std::vector<StageCost> costs{watch.lap("spheres")};
    stop_if_requested(cancel);

    std::vector<NamedSpheres> links;
    std::ranges::transform(found, std::back_inserter(links), &Spheres::link);
    std::vector<IgnoredPair> pairs;
    if (robot) {
        std::vector<LinkBalls> balls;
        std::ranges::transform(links, std::back_inserter(balls), [](const NamedSpheres& link) {
            return LinkBalls{link.link, link.balls};
        });
        pairs = robot->ignored_pairs(balls);
    }
    const std::string format = written_format(output, options.output_format, extension_for(source));
    if (robot && is_robot_format(output, format)) {
        write_robot(output, format, *robot, links, options.large.value_or(1));
    } else {
        write_spheres(output, format, robot ? robot->name() : stem_of(source.name), links, pairs);
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
    if (robot) {
        label(text, "ignored") << pairs.size()
                               << " pairs of links: " << std::ranges::count_if(pairs, &IgnoredPair::is_adjacent)
                               << " adjacent, the others touch at rest\n";
    }
    text << "-> " << output.string() << '\n';
    print(text, costs);
    Json by_link = Json::array();
    for (const NamedSpheres& link : links) {
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
    if (!options.count && !options.total && !options.error) {
        throw InvalidOption("--count, --total or --error is needed");
    }
    if (options.total && (options.count || options.error)) {
        throw InvalidOption("--total shares all spheres out: it goes with neither --count nor --error");
    }
    if (options.is_inside && options.count && options.error) {
        throw InvalidOption("--inside takes either --count or --error, not both: balls inside stick out nowhere");
    }
    std::vector<Source> sources =
        sources_of(options.input ? expanded({*options.input}) : std::vector<Input>(), options.source);
    if (sources.size() != 1 && !is_each(options.source)) {
        throw InvalidOption("one input is needed, and these are " + std::to_string(sources.size()));
    }
    std::vector<fs::path> files;
    std::vector<Output> outputs;
    for (Source& source : sources) {
        const bool has_links = is_robot(source.file);
        if (has_links) {
            check_unused(options.source, "a robot, whose links are meshes", {"--solid", "--opening", "--thickness"});
        } else if (find_kind(source); source.is_axis) {
            check_unused_beside_axis(options.source);
        }
        for (const auto& [name, is_given] :
             {std::pair{"--package", !options.packages.empty()}, std::pair{"--total", options.total.has_value()},
              std::pair{"--rest", !options.rest.empty()}}) {
            if (is_given && !has_links) {
                throw InvalidOption(std::string(name) + " is for robots (.urdf, .xacro)");
            }
        }
        if (!options.xacro.empty() && !is_xacro(source.file)) {
            throw InvalidOption("--xacro is for robots in .xacro");
        }
        for (const std::string& text : options.clip) {
            if (clip_plane(text).link.empty() == has_links) {
                throw InvalidOption("--clip-plane " + text +
                                    (has_links ? ": which link? LINK:AXIS:OFFSET is expected of a robot"
                                               : ": a link is for robots (.urdf, .xacro)"));
            }
        }
        const std::string extension = extension_for(source);
        files.push_back(expand(
            output_pattern(options.output, "spheres", false, spheres_extension(options.output_format), extension),
            source.name, 1.0));
        if (options.large && format_of(files.back(), options.output_format) != "vamp") {
            throw InvalidOption("--large is for --output-format vamp: leave it out");
        }
        outputs.push_back({files.back(), source.name});
        check_output(files.back(), [&](const fs::path& file) {
            check_spheres_output(file, written_format(file, options.output_format, extension), has_links);
        });
    }
    check_all_outputs(outputs, options.common);
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
                    "Mesh, 3D image, points, balls, axis, or robot (.urdf, .xacro); none with --implicit")
        .value_text(" ");
    add_output_option(
        command, options->output, options->output_format,
        "Spheres: .json, .yaml (cuRobo), .csv, .urdf, .srdf, or balls: .ply, .balls, .txt, .xyzr, .woff;\n"
        "of a robot by --output-format all that a planner reads: curobo, vamp, ballpark;\n"
        "a folder gets {name}-spheres.json; {name} is filled in");
    command.add_option("--count", options->count, "Number of spheres; of a robot, for each link")
        .check(whole_in_range({1, 100000}))
        .value_text("N");
    add_length_options(command, "--error", options->error, kCompactErrorRange,
                       "As few as stick out of the solid by no more than this, or with --inside leave no larger gap;\n"
                       "with --count so many, which stick out no farther and need not cover all; relative to the\n"
                       "diagonal of the bounding box [1e-06 ... 0.5]");
    command
        .add_option("--total", options->total,
                    "Number of spheres of all links of a robot: each next one for the link that sticks out most")
        .check(whole_in_range({1, 100000}))
        .value_text("N");
    add_number(command, "--effort", options->effort,
               "How long the search for fewer or better balls goes on, relative to the default", kEffortRange, "E");
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
    command
        .add_option(
            "--clip-plane", options->clip,
            "No sphere of a link reaches below OFFSET along an axis of the link's frame, as base:z:0: x, y, z,\n"
            "-x, -y, -z, or a normal as 0,1,1; of a solid AXIS:OFFSET")
        .one_text_each()
        .value_text("LINK:AXIS:OFFSET");
    command
        .add_option("--rest", options->rest,
                    "Position of a joint at rest, where links may touch; 0 by default, or the middle of its limits")
        .one_text_each()
        .value_text("JOINT=POSITION");
    command
        .add_option("--large", options->large,
                    "For VAMP: so many large spheres of each link around the others [1 ... 1000]\n(default 1)")
        .check(whole_in_range({1, 1000}))
        .value_text("N");
    command.add_option("--xacro", options->xacro, "Argument for xacro, which expands a .xacro")
        .one_text_each()
        .value_text("NAME:=VALUE");
    add_delta_options(command, options->delta, nullptr);
    add_sampling_option(command, options->sizing);
    add_source_options(command, options->source);
    add_common_options(command, options->common);
    command.footer(
        "Examples:\n"
        "  scaleaxis spheres gripper.stl --count 16 -o gripper.yaml\n"
        "  scaleaxis spheres robot.urdf --total 64 --clip-plane base:z:0 --output-format curobo -o robot.yml\n"
        "  scaleaxis spheres cat-axis.ply --count 60 --inside -o cat-few.ply");
    return {command, [options](const std::stop_token& cancel) { return run_spheres(*options, cancel); }};
}

}  // namespace scaleaxis::app
