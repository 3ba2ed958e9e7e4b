// SPDX-License-Identifier: GPL-3.0-or-later
// scaleaxis axis: solids → their discrete scale axes.
#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "page.hpp"
#include "report.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/view.hpp"
#include "solid.hpp"
#include "stopwatch.hpp"
#include "surface.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

const std::vector<std::pair<std::string, Method>> kMethodNames{
    {"scale", Method::kScale}, {"angle", Method::kAngle}, {"lambda", Method::kLambda}};

struct AxisOptions {
    std::vector<fs::path> inputs;
    SourceOptions source;
    std::string output;
    std::string balls;  ///< where to write the balls; empty: nowhere
    std::string mesh;   ///< where to write the simplified shape; empty: nowhere
    std::string view;   ///< where to write the interactive page; empty: nowhere
    ScaleAxisOptions pipeline;
    bool is_unfiltered = false;
    CommonOptions common;
};

/// One solid and the files that it leads to.
struct Job {
    Source source;
    std::vector<fs::path> axes;  ///< one for each scale
    std::optional<fs::path> balls;
    std::vector<fs::path> meshes;  ///< one for each scale, or none
    fs::path view;                 ///< the page, which other inputs may share; empty: none
};

/// What a job has led to.
struct Outcome {
    Json statistics;
    std::string view;  ///< the model on its page, or empty
};

std::vector<Job> planned_jobs(const AxisOptions& options) {
    const std::vector<double>& scales = options.pipeline.scales;
    const std::string axis_pattern = output_pattern(options.output, "axis", scales.size() > 1);
    const std::string balls_pattern = output_pattern(options.balls, "balls", false);
    const std::string mesh_pattern = output_pattern(options.mesh, "mesh", scales.size() > 1);
    const std::string view_pattern = output_pattern(options.view, "view", false, ".html");
    std::vector<Job> jobs;
    for (const Source& source : sources_of(options.inputs, options.source)) {
        const fs::path& input = source.name;
        Job job{source, {}, std::nullopt, {}, {}};
        for (const double scale : scales) {
            job.axes.push_back(expand(axis_pattern, input, scale));
            if (!options.mesh.empty()) {
                job.meshes.push_back(expand(mesh_pattern, input, scale));
            }
        }
        if (!options.balls.empty()) {
            job.balls = expand(balls_pattern, input, 1.0);
        }
        if (!options.view.empty()) {
            job.view = expand(view_pattern, input, 1.0);
        }
        jobs.push_back(std::move(job));
    }
    return jobs;
}

bool is_last_of_its_page(const std::vector<Job>& jobs, std::size_t j) {
    return std::none_of(jobs.begin() + static_cast<std::ptrdiff_t>(j) + 1, jobs.end(),
                        [&](const Job& later) { return later.view == jobs[j].view; });
}

void check_outputs(const AxisOptions& options, const std::vector<Job>& jobs) {
    std::vector<fs::path> outputs;
    for (const Job& job : jobs) {
        for (const fs::path& file : job.axes) {
            check_usage([&] { check_axis_output(file); });
            outputs.push_back(file);
        }
        if (job.balls) {
            check_usage([&] { check_balls_output(*job.balls); });
            outputs.push_back(*job.balls);
        }
        for (const fs::path& file : job.meshes) {
            check_usage([&] { check_mesh_output(file); });
            outputs.push_back(file);
        }
    }
    for (std::size_t j = 0; j < jobs.size(); ++j) {
        if (!jobs[j].view.empty() && is_last_of_its_page(jobs, j)) {
            check_usage([&] { check_view_output(jobs[j].view); });
            outputs.push_back(jobs[j].view);
        }
    }
    add_statistics_file(options.common.statistics, outputs);
    check_distinct(options.inputs, outputs);
}

Json options_to_json(const AxisOptions& options) {
    const ScaleAxisOptions& pipeline = options.pipeline;
    return {{"delta", pipeline.absolute_delta ? Json(nullptr) : Json(pipeline.delta)},
            {"absolute_delta", pipeline.absolute_delta ? Json(*pipeline.absolute_delta) : Json(nullptr)},
            {"scales", pipeline.scales},
            {"method", kMethodNames.at(static_cast<std::size_t>(pipeline.method)).first},
            {"filter_angle", pipeline.filter_angle},
            {"lambda", pipeline.absolute_lambda ? Json(nullptr) : Json(pipeline.lambda)},
            {"absolute_lambda", pipeline.absolute_lambda ? Json(*pipeline.absolute_lambda) : Json(nullptr)},
            {"smoothing_rounds", pipeline.smoothing_rounds},
            {"features", pipeline.suits_features},
            {"tight", pipeline.limits_deviation},
            {"input", to_json(options.source)},
            {"seed", pipeline.seed},
            {"threads", options.common.threads}};
}

AxisReport report_of(const AxisAtScale& axis, const fs::path& file, const std::optional<Topology>& solid) {
    AxisReport report;
    report.scale = axis.scale;
    report.file = file;
    report.medial = axis.medial_statistics;
    report.filter = axis.filter_statistics;
    report.solid = solid;
    report.costs = axis.costs;
    report.set_result(axis.complex);
    return report;
}

/// The model as it stands on the page. Takes the complexes and the meshes, which are no longer needed.
ViewedModel viewed_model(const Job& job, const AxisOptions& options, TriangleMesh shape, ScaleAxis& result,
                         std::vector<Surface>& surfaces, const Json& statistics) {
    ViewedModel model{job.source.name.stem().string(), std::move(shape), {}, {}};
    Json about = statistics;
    about.erase("axes");
    about["input"] = job.source.name.string();
    about["options"] = options_to_json(options);
    model.statistics = to_text(about);
    for (std::size_t i = 0; i < result.axes.size(); ++i) {
        model.axes.push_back({result.axes[i].scale, std::move(result.axes[i].complex),
                              surfaces.empty() ? TriangleMesh() : std::move(surfaces[i].boundary.mesh),
                              to_text(statistics["axes"][i])});
    }
    return model;
}

/// The boundary of the input for the page: its mesh, or one of its samples, which are not kept and so made again.
TriangleMesh viewed_boundary(Solid& solid, const ScaleAxisOptions& options, const Execution& execution) {
    if (!solid.mesh.triangles.empty()) {
        return std::move(solid.mesh);
    }
    if (solid.samples) {
        return boundary_mesh(*solid.samples, execution).mesh;
    }
    const double length = tolerance(solid.shape->bounds().diagonal(), options.delta, options.absolute_delta);
    return boundary_mesh(sample(*solid.shape, {.tolerance = length, .seed = options.seed}, execution), execution).mesh;
}

/// Computes and writes the axes of one input.
Outcome run_job(const Job& job, const AxisOptions& options) {
    ProgressBar bar(job.source.name.filename().string(), options.common.verbosity());
    const Execution execution = bar.execution(options.common.threads);
    Solid solid = read_solid(job.source, execution, !job.view.empty());
    TriangleMesh shape = job.view.empty() ? TriangleMesh() : viewed_boundary(solid, options.pipeline, execution);
    ScaleAxis result = solid.samples ? scale_axis(std::move(*solid.samples), options.pipeline, execution)
                                     : scale_axis(*solid.shape, options.pipeline, execution);
    std::vector<Surface> surfaces;
    for (std::size_t i = 0; i < job.meshes.size(); ++i) {
        surfaces.push_back(surface_of(balls_of(result.axes[i].complex), result.tolerance,
                                      options.pipeline.limits_deviation, options.common.seed, execution));
    }
    bar.erase();
    for (const std::string& warning : result.warnings) {
        print_warning(job.source.name.string() + ": " + warning);
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        for (const std::string& warning : surfaces[i].warnings) {
            print_warning(job.meshes[i].string() + ": " + warning);
        }
    }

    Stopwatch watch;
    std::vector<AxisReport> axes;
    for (std::size_t i = 0; i < result.axes.size(); ++i) {
        stop_if_interrupted();
        write_axis(job.axes[i], result.axes[i].complex);
        axes.push_back(report_of(result.axes[i], job.axes[i], result.shape_topology));
    }
    if (job.balls) {
        write_balls(*job.balls, result.balls);
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        stop_if_interrupted();
        write_mesh(job.meshes[i], surfaces[i].boundary.mesh);
    }
    std::vector<StageCost> costs = solid.costs;
    costs.insert(costs.end(), result.costs.begin(), result.costs.end());
    costs.push_back(watch.lap("writing"));

    if (options.common.has_summary()) {
        std::ostringstream text;
        text << job.source.name.string() << '\n';
        text << solid.description.text;
        print(text, result.samples, result.tolerance, result.sampling_statistics);
        print_balls(text, result.balls.size(), job.balls);
        print(text, costs);
        for (std::size_t i = 0; i < axes.size(); ++i) {
            print(text, axes[i]);
            if (!surfaces.empty()) {
                print(text, surfaces[i], job.meshes[i]);
                print(text, surfaces[i].costs);
            }
        }
        print_text(text.str());
    }

    std::vector<std::string> warnings = solid.warnings;
    warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
    Json statistics{{solid.description.kind, solid.description.json},
                    {"solid", result.shape_topology ? to_json(*result.shape_topology) : Json(nullptr)},
                    {"tolerance", result.tolerance},
                    {"diagonal", result.diagonal},
                    {"samples", result.samples},
                    {"sampling", to_json(result.sampling_statistics)},
                    {"balls", result.balls.size()},
                    {"balls_file", job.balls ? Json(job.balls->string()) : Json(nullptr)},
                    {"costs", to_json(costs)},
                    {"warnings", warnings},
                    {"axes", Json::array()}};
    for (std::size_t i = 0; i < axes.size(); ++i) {
        statistics["axes"].push_back(to_json(axes[i]));
        Json surface;
        if (!surfaces.empty()) {
            surface = to_json(surfaces[i], job.meshes[i]);
            surface["costs"] = to_json(surfaces[i].costs);
        }
        statistics["axes"].back()["surface"] = std::move(surface);
    }
    std::string view;
    if (!job.view.empty()) {
        view = view_data(viewed_model(job, options, std::move(shape), result, surfaces, statistics));
    }
    return {std::move(statistics), std::move(view)};
}

Status run_axis(AxisOptions options) {
    options.pipeline.seed = options.common.seed;
    if (options.is_unfiltered) {
        options.pipeline.filter_angle = 0.0;
    }
    const std::vector<Job> jobs = planned_jobs(options);
    check_outputs(options, jobs);

    Json document = new_document("scaleaxis.axis/1");
    document["options"] = options_to_json(options);
    document["results"] = Json::array();
    Status worst = kDone;
    std::size_t failures = 0;
    std::map<fs::path, Page> pages;
    for (std::size_t j = 0; j < jobs.size(); ++j) {
        const Job& job = jobs[j];
        Json entry{{"input", job.source.name.string()}, {"status", kDone}, {"error", nullptr}};
        try {
            Outcome outcome = run_job(job, options);
            entry.update(outcome.statistics);
            if (!job.view.empty()) {
                pages[job.view].add(job.source.name.stem().string(), std::move(outcome.view));
            }
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            const std::string message = describe(error, job.source.name);
            print_error(message);
            entry["status"] = status_of(error);
            entry["error"] = message;
            worst = std::max(worst, status_of(error));
            ++failures;
        }
        document["results"].push_back(std::move(entry));
        if (pages.contains(job.view) && is_last_of_its_page(jobs, j)) {
            pages[job.view].write(job.view);
            pages.erase(job.view);
            if (options.common.has_summary()) {
                print_page(job.view);
            }
        }
    }
    if (failures > 0 && jobs.size() > 1) {
        print_error(std::to_string(failures) + " of " + std::to_string(jobs.size()) + " inputs failed");
    }
    document["status"] = worst;
    write_statistics(options.common.statistics, document);
    return worst;
}

}  // namespace

Command axis_command(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("axis", "Discrete scale axis of solids: closed meshes, 3D images, implicit functions");
    auto options = std::make_shared<AxisOptions>();
    command
        ->add_option("INPUT", options->inputs,
                     "Meshes (.obj, .off, .ply, .stl), 3D images (.nrrd, .nii, .mha, .tif, .vtk, .inr, .vol...),\n"
                     "or balls; none with --implicit")
        ->option_text("...");
    command
        ->add_option("-o,--output", options->output,
                     "Axis: .ply, .ma, .vtp, .obj or .glb; a folder gets {name}-axis.ply;\n"
                     "{name} (of the input) and {scale} are filled in;\n"
                     "with several scales and no {scale} the name gets -s{scale} appended")
        ->required()
        ->option_text("OUT");
    add_delta_options(*command, options->pipeline.delta, options->pipeline.absolute_delta);
    add_quality_options(*command, options->pipeline.suits_features, options->pipeline.limits_deviation);
    CLI::Option* method =
        command
            ->add_option("--method", options->pipeline.method,
                         "What is kept: 'scale': the discrete scale axis; for comparison 'angle': of the medial axis\n"
                         "what has an object angle of --angle at least, 'lambda': what has a circumradius of\n"
                         "--lambda at least; these two take no --scale and may change the topology\n[default scale]")
            ->transform(CLI::CheckedTransformer(kMethodNames))
            ->option_text("scale|angle|lambda");
    const CLI::Option* scale =
        command
            ->add_option("--scale", options->pipeline.scales,
                         "Factor by which balls are grown: 1 keeps every feature, larger factors drop those\n"
                         "that are small relative to what they sit on; all share one sampling" +
                             range_and_default(kScaleRange, options->pipeline.scales.front()))
            ->check(in_range(kScaleRange))
            ->delimiter(',')
            ->allow_extra_args(false)
            ->option_text("S[,S...]");
    CLI::Option* angle =
        command
            ->add_option("--angle", options->pipeline.filter_angle,
                         "Remove sheets whose object angle is smaller, where that keeps the topology; degrees" +
                             range_and_default(kAngleRange, options->pipeline.filter_angle))
            ->check(in_range(kAngleRange))
            ->option_text("A");
    CLI::Option* lambda =
        command
            ->add_option("--lambda", options->pipeline.lambda,
                         "Least radius of a ball around the closest boundary points, for --method lambda,\n"
                         "relative to the diagonal of the shape's bounding box" +
                             range_and_default(kLambdaRange, options->pipeline.lambda))
            ->check(in_range(kLambdaRange))
            ->needs(method)
            ->option_text("R");
    command
        ->add_option("--lambda-abs", options->pipeline.absolute_lambda,
                     "The same as a length in units of the input, in place of --lambda")
        ->check(in_range({0.0, std::numeric_limits<double>::max()}))
        ->excludes(lambda)
        ->needs(method)
        ->option_text("LENGTH");
    command
        ->add_option("--smooth", options->pipeline.smoothing_rounds,
                     "Rounds of smoothing of the sheets' boundaries" +
                         range_and_default(kRoundsRange, options->pipeline.smoothing_rounds))
        ->check(in_range(kRoundsRange))
        ->option_text("N");
    command->add_flag("--no-filter", options->is_unfiltered, "Remove no sheets")->excludes(angle)->option_text(" ");
    command
        ->add_option("--balls", options->balls,
                     "Also write the union of balls: .ply, .balls, .txt, .xyzr or .woff;\n"
                     "a folder gets {name}-balls.ply; {name} is filled in")
        ->option_text("FILE");
    command
        ->add_option("--mesh", options->mesh,
                     "Also write the boundary of the simplified shape: .ply, .obj, .off or .stl;\n"
                     "a folder gets {name}-mesh.ply; {name} and {scale} as for --output")
        ->option_text("FILE");
    add_source_options(*command, options->source);
    command
        ->add_option("--view", options->view,
                     "Also write a page that any browser shows: .html; all inputs on one,\n"
                     "or with {name} one for each; a folder gets {name}-view.html")
        ->option_text("FILE");
    add_common_options(*command, options->common);
    command->footer(
        "Examples:\n"
        "  scaleaxis axis cat.obj -o cat-axis.ply --view cat.html\n"
        "  scaleaxis axis cat.obj --delta 0.005 --scale 1.05,1.1,1.2 -o cat-axis.ply\n"
        "      writes cat-axis-s1.05.ply, cat-axis-s1.1.ply, cat-axis-s1.2.ply\n"
        "  scaleaxis axis *.off -o 'results/{name}-{scale}.vtp' --stats results/statistics.json\n"
        "  scaleaxis axis liver.nii.gz --label 2 -o liver-axis.ply\n"
        "  scaleaxis axis --implicit '(sqrt(x^2+y^2)-1)^2+z^2-0.1' --bounds -2,-2,-1,2,2,1 -o torus-axis.ply");
    return {command, [options, scale] {
                if (options->pipeline.method != Method::kScale && scale->count() == 0) {
                    options->pipeline.scales = {1.0};  // the local methods grow nothing
                }
                return run_axis(*options);
            }};
}

}  // namespace scaleaxis::app
