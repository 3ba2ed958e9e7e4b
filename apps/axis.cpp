// SPDX-License-Identifier: Apache-2.0
// scaleaxis axis: solids → their discrete scale axes.
#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "batch.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "page.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/union_mesh.hpp"
#include "scaleaxis/view.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

const Choices<Method> kMethodNames{{"scale", Method::kScale}, {"angle", Method::kAngle}, {"lambda", Method::kLambda}};

struct AxisOptions {
    std::vector<fs::path> inputs;
    SourceOptions source;
    std::string output;
    std::string output_format;
    bool has_polygons = false;
    std::string balls;     ///< where to write the balls; empty: nowhere
    std::string mesh;      ///< where to write the simplified solid; empty: nowhere
    std::string view;      ///< where to write the interactive page; empty: nowhere
    std::string combined;  ///< where to write the axes of all labels of an image together; empty: nowhere
    ScaleAxisOptions pipeline;
    bool chooses_scale = false;  ///< in place of that of `pipeline`, the middle of the longest plateau of each solid
    bool is_compact = false;
    CompactOptions compact;
    bool is_unfiltered = false;
    bool is_as_in_paper = false;
    bool skips_existing = false;
    CommonOptions common;
};

/// One solid and the files that it leads to.
struct Job {
    Source source;
    std::vector<fs::path> axes;  ///< one for each scale
    std::optional<fs::path> balls;
    std::vector<fs::path> meshes;    ///< one for each scale, or none
    fs::path view;                   ///< the page, which other inputs may share; empty: none
    std::vector<fs::path> combined;  ///< one for each scale, which all labels of an image share, or none
};

/// What there is to tell of a job when it is done.
struct Finished {
    Json entry;  ///< in the statistics
    std::string summary;
    std::string note;
    std::string error;
    std::string model;                ///< for the page
    std::vector<MedialComplex> axes;  ///< for the combined files, one for each scale
};

/// What a job has led to.
struct FoundAxes {
    LoadedSolid input;  ///< without the solid
    ScaleAxis axis;
    std::optional<ScalePlateau> plateau;  ///< if the scale was chosen
    std::vector<UnionMesh> meshes;        ///< one for each scale, or none
    TriangleMesh boundary;                ///< of the input, for the page
    std::vector<AxisReport> reports;      ///< one for each scale
    std::vector<StageCost> costs;         ///< of what all scales share
};

std::vector<Job> planned_jobs(const AxisOptions& options, const std::vector<Input>& inputs) {
    const std::vector<double>& scales = options.pipeline.scales;
    const std::string axis_pattern = output_pattern(options.output, "axis", scales.size() > 1, options.output_format);
    const std::string balls_pattern = output_pattern(options.balls, "balls", false);
    const std::string mesh_pattern = output_pattern(options.mesh, "mesh", scales.size() > 1);
    const std::string view_pattern = output_pattern(options.view, "view", false, "html");
    const std::string combined_pattern = output_pattern(options.combined, "labels", scales.size() > 1);
    std::vector<Job> jobs;
    for (const Source& source : sources_of(inputs, options.source)) {
        const fs::path& input = source.name;
        Job job{source, {}, std::nullopt, {}, {}, {}};
        for (const double scale : scales) {
            if (!options.output.empty()) {
                job.axes.push_back(expand(axis_pattern, input, scale));
            }
            if (!options.combined.empty()) {
                job.combined.push_back(expand(combined_pattern, source.file, scale));
            }
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

/// All files that belong to this job alone.
std::vector<fs::path> files_of(const Job& job) {
    std::vector<fs::path> files = job.axes;
    files.insert(files.end(), job.meshes.begin(), job.meshes.end());
    if (job.balls) {
        files.push_back(*job.balls);
    }
    if (!job.view.empty()) {
        files.push_back(job.view);
    }
    return files;
}

/// As `check_axis_output` for a file with labels.
void check_labelled_output(const fs::path& file, bool has_polygons) {
    axis_output_check({}, has_polygons)(file);
    if (const std::string extension = file.extension().string(); extension != ".ply" && extension != ".vtp") {
        throw FileError(file.string() + ": labels are written to .ply and .vtp");
    }
}

bool is_last_of_its_page(const std::vector<Job>& jobs, std::size_t j) {
    return std::none_of(jobs.begin() + static_cast<std::ptrdiff_t>(j) + 1, jobs.end(),
                        [&](const Job& later) { return later.view == jobs[j].view; });
}

bool shares_page(const std::vector<Job>& jobs) {
    return jobs.size() > 1 && !jobs.front().view.empty() && jobs[0].view == jobs[1].view;
}

/// \return whether one of them is stdout
bool check_outputs(const AxisOptions& options, const std::vector<Job>& jobs) {
    std::vector<Output> outputs;
    for (std::size_t j = 0; j < jobs.size(); ++j) {
        const auto add = [&](const fs::path& file, const OutputCheck& check) {
            check_output(file, check);
            outputs.push_back({file, jobs[j].source.name});
        };
        for (const fs::path& file : jobs[j].axes) {
            add(file, axis_output_check(options.output_format, options.has_polygons));
        }
        if (jobs[j].balls) {
            add(*jobs[j].balls, with_format(check_balls_output, {}));
        }
        for (const fs::path& file : jobs[j].meshes) {
            add(file, with_format(check_mesh_output, {}));
        }
        if (j == 0 || !is_of_same_image(jobs[j - 1].source, jobs[j].source)) {
            for (const fs::path& file : jobs[j].combined) {
                add(file, [&](const fs::path& path) { check_labelled_output(path, options.has_polygons); });
            }
        }
        if (!jobs[j].view.empty() && is_last_of_its_page(jobs, j)) {
            add(jobs[j].view, check_view_output);
        }
    }
    const bool has_data_on_stdout = std::ranges::any_of(outputs, is_stdout, &Output::file);
    add_statistics_file(options.common.statistics, outputs);
    check_distinct(outputs);
    if (options.skips_existing && !options.combined.empty()) {
        throw InvalidOption("--skip-existing: the file of --combined would lack the labels that are skipped");
    }
    if (options.skips_existing && shares_page(jobs)) {
        throw InvalidOption(
            "--skip-existing: a page of several inputs would lack those that are skipped; use {name} in the name of "
            "the "
            "page, or make it by scaleaxis view");
    }
    return has_data_on_stdout;
}

Json length_to_json(const std::optional<Length>& length, bool is_absolute) {
    return length && length->is_absolute() == is_absolute ? Json(length->value()) : Json(nullptr);
}

Json compact_to_json(const std::optional<CompactOptions>& compact) {
    if (!compact) {
        return nullptr;
    }
    return {{"error", length_to_json(compact->error, false)},
            {"absolute_error", length_to_json(compact->error, true)},
            {"vertices", compact->vertices ? Json(*compact->vertices) : Json(nullptr)}};
}

Json options_to_json(const AxisOptions& options) {
    const ScaleAxisOptions& pipeline = options.pipeline;
    const Length delta = pipeline.delta.value_or(kDefaultDelta);
    const Length lambda = pipeline.lambda.value_or(kDefaultLambda);
    return {{"delta", pipeline.delta_range ? Json("auto") : length_to_json(delta, false)},
            {"absolute_delta", length_to_json(delta, true)},
            {"union", pipeline.union_kind ? Json(name_of(*pipeline.union_kind)) : Json(nullptr)},
            {"scales", options.chooses_scale ? Json("auto") : Json(pipeline.scales)},
            {"method", kMethodNames.at(static_cast<std::size_t>(pipeline.method)).first},
            {"filter_angle", pipeline.filter_angle.value_or(FilterOptions().angle)},
            {"lambda", length_to_json(lambda, false)},
            {"absolute_lambda", length_to_json(lambda, true)},
            {"dense", pipeline.is_dense},
            {"sharp", pipeline.reaches_sharp_edges},
            {"sharp_angle", sharp_angle_of(pipeline)},
            {"cleaning", length_to_json(pipeline.cleaning, false)},
            {"absolute_cleaning", length_to_json(pipeline.cleaning, true)},
            {"compact", compact_to_json(pipeline.compact)},
            {"centered", pipeline.is_centered},
            {"smoothing_rounds", pipeline.smoothing_rounds ? Json(*pipeline.smoothing_rounds) : Json(nullptr)},
            {"sampling", name_of(pipeline.sizing)},
            {"input", to_json(options.source)},
            {"seed", pipeline.seed},
            {"threads", options.common.threads}};
}

/// The shares of loading, of the axis, and of the meshes in the work of a job, for the progress only.
struct Shares {
    WorkShare load;
    WorkShare axis;
    std::vector<WorkShare> meshes;
};

Shares shares_of(const Job& job) {
    Shares shares{{0.0, 0.15}, {0.15, job.meshes.empty() ? 1.0 : 0.6}, {}};
    const auto count = static_cast<double>(job.meshes.size());
    for (double i = 0.0; i < count; ++i) {
        shares.meshes.push_back({0.6 + 0.4 * i / count, 0.6 + 0.4 * (i + 1.0) / count});
    }
    return shares;
}

/// The boundary of the input for the page: its mesh, or one of its samples.
TriangleMesh viewed_boundary(LoadedSolid& input, std::optional<Samples> samples, const Execution& execution) {
    return input.mesh.triangles.empty() ? boundary_mesh(*samples, execution).mesh : std::move(input.mesh);
}

ScaleAxis axis_of(LoadedSolid& input, const Job& job, ScaleAxisOptions options, const Execution& execution) {
    options.keeps_samples = !job.view.empty() && input.mesh.triangles.empty();
    if (!input.samples) {
        return scale_axis(*input.solid, options, execution);
    }
    check_can_fit(input, options.union_kind);
    options.union_kind.reset();
    return scale_axis(std::move(*input.samples), without_sampling_options(options), execution);
}

/// Where the axis of a solid depends least on the scale.
ScalePlateau plateau_of(const LoadedSolid& input, ScaleAxisOptions options, const Execution& execution) {
    options.scales = {1.0};
    options.compact.reset();
    options.is_dense = false;
    LoadedSolid samples;
    samples.samples = input.samples;
    const ScaleAxis axis = input.samples ? scale_axis(std::move(*samples.samples), options, execution)
                                         : scale_axis(*input.solid, options, execution);
    return longest_plateau(profile(filtration(axis.axes[0].complex, {}, execution)));
}

/// The boundary of the simplified solid: of the balls of a dense axis, else of what is interpolated between them.
UnionMesh simplified_solid(const AxisAtScale& axis, const AxisOptions& options, double tolerance,
                           const Execution& execution) {
    const UnionMeshOptions mesh_options{Length::absolute(tolerance), options.common.seed};
    return options.pipeline.is_dense ? union_mesh(balls_of(axis.complex), mesh_options, execution)
                                     : envelope_mesh(Envelope(axis.complex), mesh_options, execution);
}

/// Computes all that one job asks for.
FoundAxes computed(const Job& job, const AxisOptions& options, const Listener& listener) {
    const auto warn = listener.warn_about(job.source.name);
    const auto& execution = listener.execution;
    const Shares shares = shares_of(job);
    FoundAxes outcome;
    LoadedSolid& input = outcome.input;
    Source source = job.source;
    source.options.load.delta = finest_delta(options.pipeline);
    input = load_source(source, execution(shares.load), warn, !job.view.empty());
    if (input.samples && has_sampling_options(options.pipeline)) {
        input.warnings.push_back(unused_sampling_options());
        warn(input.warnings.back());
    }
    ScaleAxisOptions pipeline = options.pipeline;
    WorkShare axis_share = shares.axis;
    if (options.chooses_scale) {
        const double middle = 0.5 * (axis_share.begin + axis_share.end);
        outcome.plateau = plateau_of(input, pipeline, execution({axis_share.begin, middle}));
        pipeline.scales = {outcome.plateau->middle};
        axis_share.begin = middle;
    }
    outcome.axis = axis_of(input, job, pipeline, execution(axis_share));
    if (input.solid) {  // what it tells was told when it was loaded
        std::vector<Diagnostic>& warnings = outcome.axis.warnings;
        warnings.erase(warnings.begin(), warnings.begin() + std::ssize(input.solid->warnings()));
    }
    input.solid.reset();
    std::ranges::for_each(outcome.axis.warnings, warn);
    if (!job.view.empty()) {
        outcome.boundary =
            viewed_boundary(input, std::move(outcome.axis.kept_samples), execution({shares.axis.end, shares.axis.end}));
    }
    for (std::size_t i = 0; i < job.meshes.size(); ++i) {
        outcome.meshes.push_back(
            simplified_solid(outcome.axis.axes[i], options, outcome.axis.tolerance, execution(shares.meshes[i])));
        for (const Diagnostic& warning : outcome.meshes.back().warnings) {
            listener.warn(job.meshes[i], warning);
        }
    }
    return outcome;
}

/// Writes the files of a job, and adds reports and costs.
void write_files(const Job& job, const AxisOptions& options, const std::stop_token& cancel, FoundAxes& outcome) {
    Stopwatch watch;
    for (std::size_t i = 0; i < outcome.axis.axes.size(); ++i) {
        stop_if_requested(cancel);
        const AxisAtScale& axis = outcome.axis.axes[i];
        if (!job.axes.empty()) {
            write_axis_file(job.axes[i], axis.complex, written_format(job.axes[i], options.output_format),
                            options.has_polygons, {options.common.threads, {}, cancel});
        }
        outcome.reports.push_back(
            report_of(axis, outcome.axis.solid_topology, job.axes.empty() ? job.combined[i] : job.axes[i]));
    }
    if (job.balls) {
        stop_if_requested(cancel);
        write_balls(*job.balls, outcome.axis.balls, written_format(*job.balls, {}));
    }
    for (std::size_t i = 0; i < job.meshes.size(); ++i) {
        stop_if_requested(cancel);
        write_mesh(job.meshes[i], outcome.meshes[i].boundary.mesh, written_format(job.meshes[i], {}));
    }
    outcome.costs = outcome.input.costs;
    outcome.costs.insert(outcome.costs.end(), outcome.axis.costs.begin(), outcome.axis.costs.end());
    outcome.costs.push_back(watch.lap("writing"));
}

std::string summary_of(const Job& job, const FoundAxes& outcome) {
    const ScaleAxis& axis = outcome.axis;
    std::ostringstream text;
    text << job.source.name.string() << '\n';
    print(text, outcome.input.input);
    print_samples(text, axis.samples, axis.tolerance, axis.sampling_statistics);
    if (axis.delta_choice) {
        print(text, *axis.delta_choice);
    }
    print_balls(text, axis.balls.size(), job.balls.value_or(fs::path()));
    if (axis.fit) {
        print(text, *axis.fit);
    }
    if (outcome.plateau) {
        const auto& [begin, end, middle] = *outcome.plateau;
        label(text, "scale") << middle << ", the middle of " << begin << " ... " << end
                             << ", over which the sheets change least\n";
    }
    print(text, outcome.costs);
    for (std::size_t i = 0; i < outcome.reports.size(); ++i) {
        print(text, outcome.reports[i]);
        if (!outcome.meshes.empty()) {
            print(text, outcome.meshes[i], job.meshes[i]);
            print(text, outcome.meshes[i].costs);
        }
    }
    return text.str();
}

Json axis_to_json(const Job& job, const FoundAxes& outcome, std::size_t i) {
    Json json = json_of(outcome.reports[i]);
    json["surface"] = nullptr;
    if (!outcome.meshes.empty()) {
        json["surface"] = Json::parse(to_json(outcome.meshes[i], job.meshes[i]));
        json["surface"]["costs"] = json_of(outcome.meshes[i].costs);
    }
    return json;
}

Json statistics_of(const Job& job, const FoundAxes& outcome) {
    const ScaleAxis& axis = outcome.axis;
    std::vector<Diagnostic> warnings = outcome.input.warnings;
    warnings.insert(warnings.end(), axis.warnings.begin(), axis.warnings.end());
    const std::string unit = unit_of(outcome.input.input);
    Json statistics{{std::string(name_of(outcome.input.input)), json_of(outcome.input.input)},
                    {"solid", json_of(axis.solid_topology)},
                    {"unit", unit.empty() ? Json(nullptr) : Json(unit)},
                    {"tolerance", axis.tolerance},
                    {"diagonal", axis.diagonal},
                    {"delta_choice", json_of(axis.delta_choice)},
                    {"scale_choice", json_of(outcome.plateau)},
                    {"samples", axis.samples},
                    {"sampling", json_of(axis.sampling_statistics)},
                    {"balls", axis.balls.size()},
                    {"fit", json_of(axis.fit)},
                    {"balls_file", job.balls ? Json(job.balls->string()) : Json(nullptr)},
                    {"costs", json_of(outcome.costs)},
                    {"warnings", json_of(warnings)},
                    {"axes", Json::array()}};
    for (std::size_t i = 0; i < outcome.reports.size(); ++i) {
        statistics["axes"].push_back(axis_to_json(job, outcome, i));
    }
    return statistics;
}

/// The model as it stands on the page. Takes the complexes and the meshes, which are no longer needed.
ViewedModel viewed_model(const Job& job, const AxisOptions& options, const Json& statistics, FoundAxes outcome) {
    ViewedModel model{job.source.name.stem().string(), std::move(outcome.boundary), {}, {}};
    Json about = statistics;
    about.erase("axes");
    about["input"] = job.source.name.string();
    about["options"] = options_to_json(options);
    model.statistics = to_text(about);
    for (std::size_t i = 0; i < outcome.axis.axes.size(); ++i) {
        AxisAtScale& axis = outcome.axis.axes[i];
        model.axes.push_back({std::move(axis.complex),
                              outcome.meshes.empty() ? TriangleMesh() : std::move(outcome.meshes[i].boundary.mesh),
                              to_text(statistics.at("axes").elements()[i])});
    }
    return model;
}

/// Computes and writes the axes of one input.
void run_job(const Job& job, const AxisOptions& options, const Listener& listener, const std::stop_token& cancel,
             Finished& finished) {
    FoundAxes outcome = computed(job, options, listener);
    write_files(job, options, cancel, outcome);
    finished.summary = summary_of(job, outcome);
    const Json statistics = statistics_of(job, outcome);
    finished.entry.update(statistics);
    if (!job.combined.empty()) {
        for (const AxisAtScale& axis : outcome.axis.axes) {
            finished.axes.push_back(axis.complex);
        }
    }
    if (!job.view.empty()) {
        finished.model =
            view_data(viewed_model(job, options, statistics, std::move(outcome)), listener.execution({1.0, 1.0}));
    }
}

bool is_done_already(const Job& job) {
    return std::ranges::all_of(files_of(job), [](const fs::path& file) { return fs::exists(file); });
}

/// `run_job`, or the reason why there is nothing to run or to tell.
Finished finished_job(const Job& job, const AxisOptions& options, const Listener& listener,
                      const std::stop_token& cancel) {
    Finished finished;
    finished.entry = entry_of(job.source);
    if (options.skips_existing && is_done_already(job)) {
        finished.note = job.source.name.string() + ": skipped, since all its results are there";
        finished.entry["skipped"] = true;
        return finished;
    }
    try {
        run_job(job, options, listener, cancel, finished);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        finished.error = add_error(job.source, error, finished.entry);
    }
    return finished;
}

/// All inputs of a call. What there is to tell of them is told in their order.
class AxisRun {
   public:
    AxisRun(const AxisOptions& options, const std::vector<Job>& jobs, const std::stop_token& cancel, Json head)
        : options_(options),
          cancel_(cancel),
          jobs_(jobs),
          finished_(jobs.size()),
          statistics_(options.common.statistics, std::move(head), options.skips_existing) {}

    Status run() {
        std::vector<Source> sources;
        std::ranges::transform(jobs_, std::back_inserter(sources), &Job::source);
        for_each_source(
            sources, options_.common, cancel_,
            [&](std::size_t j, const Listener& listener) {
                finished_[j] = finished_job(jobs_[j], options_, listener, cancel_);
            },
            [&](std::size_t j) {
                Finished finished = std::exchange(finished_[j], {});
                combine(jobs_[j], finished);
                tell(j, std::move(finished));
                write_together(j);
            });
        print_failures(failures_, jobs_.size());
        statistics_.finish(worst_);
        return worst_;
    }

   private:
    /// Adds the axes of a label to those of its image.
    void combine(const Job& job, const Finished& finished) {
        together_.resize(job.combined.size());
        for (std::size_t i = 0; i < finished.axes.size(); ++i) {
            append_labelled(together_[i], finished.axes[i], static_cast<Index>(job.source.label->label));
        }
    }

    /// After the last label of an image.
    void write_together(std::size_t j) {
        const Job& job = jobs_[j];
        if (j + 1 < jobs_.size() && is_of_same_image(job.source, jobs_[j + 1].source)) {
            return;
        }
        const std::vector<MedialComplex> together = std::exchange(together_, {});
        for (std::size_t i = 0; i < together.size() && !together[i].vertices.empty(); ++i) {
            try {
                write_axis_file(job.combined[i], together[i], {}, options_.has_polygons,
                                {options_.common.threads, {}, cancel_});
                if (options_.common.has_summary()) {
                    print_text("\nall labels -> " + job.combined[i].string() + "\n");
                }
            } catch (const FileError& error) {
                print_error(describe(error, job.source.file));
                worst_ = std::max(worst_, status_of(error));
            }
        }
    }

    /// Prints what there is to tell of a job, and adds it to the statistics and to its page.
    void tell(std::size_t j, Finished finished) {
        const Job& job = jobs_[j];
        if (!finished.note.empty() && !options_.common.is_quiet) {
            print_note(finished.note);
        }
        try {
            if (options_.common.has_summary()) {
                print_text(finished.summary);
            }
            if (!finished.model.empty()) {
                pages_[job.view].add(job.source.name.stem().string(), std::move(finished.model));
            }
        } catch (const std::exception& error) {
            finished.error = add_error(job.source, error, finished.entry);
        }
        if (!finished.error.empty()) {
            print_error(finished.error);
        }
        const auto status = finished.entry["status"].get<Status>();
        worst_ = std::max(worst_, status);
        failures_ += status == kDone ? 0 : 1;
        statistics_.add(std::move(finished.entry));
        finish_page(j);
    }

    /// Writes the page of a job once its last model is there, unless all of them failed.
    void finish_page(std::size_t j) {
        const fs::path& file = jobs_[j].view;
        if (file.empty() || !is_last_of_its_page(jobs_, j)) {
            return;
        }
        if (!pages_[file].models.empty()) {
            pages_[file].write(file);
            if (options_.common.has_summary()) {
                print_page(file);
            }
        }
        pages_.erase(file);
    }

    const AxisOptions& options_;
    const std::stop_token& cancel_;
    const std::vector<Job>& jobs_;
    std::vector<Finished> finished_;       ///< those not told yet
    std::vector<MedialComplex> together_;  ///< of the labels of an image so far, for each scale
    BatchStatistics statistics_;
    std::map<fs::path, Page> pages_;
    Status worst_ = kDone;
    std::size_t failures_ = 0;
};

Status run_axis(AxisOptions options, const std::stop_token& cancel) {
    options.pipeline.seed = options.common.seed;
    if (options.is_unfiltered) {
        options.pipeline.filter_angle = 0.0;
    }
    if (options.is_as_in_paper) {
        options.pipeline.sizing = Sizing::kUniform;
        options.pipeline.union_kind = UnionKind::kPolar;
        options.pipeline.is_dense = true;
        options.pipeline.cleaning = Length::relative(0.0);
    }
    if (options.is_compact || options.compact.error || options.compact.vertices) {
        options.pipeline.compact = options.compact;
    }
    if (options.chooses_scale) {
        if (options.pipeline.scales.size() > 1) {
            throw InvalidOption("--scale auto chooses one scale: leave out the others");
        }
        for (const std::string& pattern : {options.output, options.mesh, options.combined}) {
            if (pattern.find("{scale}") != std::string::npos) {
                throw InvalidOption(
                    "with --scale auto the name of a file cannot have the scale in it, which is not known "
                    "before: leave out {scale}");
            }
        }
    }
    if (options.output.empty() && options.combined.empty()) {
        throw InvalidOption("--output is required");
    }
    validate(options.pipeline);
    std::vector<double> scales = options.pipeline.scales;
    std::ranges::sort(scales);
    if (std::ranges::adjacent_find(scales) != scales.end()) {
        throw InvalidOption("--scale has the same number twice: leave one of them out");
    }
    check_sampling_options(options.source, has_sampling_options(options.pipeline));
    const std::vector<Job> jobs = planned_jobs(options, expanded(options.inputs));
    options.common.has_data_on_stdout = check_outputs(options, jobs);
    Json head = new_document("scaleaxis.axis/2");
    head["options"] = options_to_json(options);
    return AxisRun(options, jobs, cancel, std::move(head)).run();
}

}  // namespace

Command axis_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("axis", "Discrete scale axis of solids: closed meshes, 3D images, implicit functions");
    auto options = std::make_shared<AxisOptions>();
    command
        .add_option("INPUT", options->inputs,
                    "Meshes (.obj, .off, .ply, .stl, .gltf, .glb, .3mf),\n"
                    "points (.xyz, .pts, .pwn, .csv, .tsv, .las, .pcd, .ply),\n"
                    "3D images (.nrrd, .nii, .mha, .tif, .vti, .npy, .vol...), or balls;\n"
                    "-: standard input; folders; @LIST: a text with an input on each line;\n"
                    "none with --implicit")
        .value_text("...");
    add_output_option(command, options->output, options->output_format,
                      "Axis: .ply, .ma, .vtp, .obj or .glb; a folder gets {name}-axis.ply;\n"
                      "{name} (of the input) and {scale} are filled in;\n"
                      "with several scales and no {scale} the name gets -s{scale} appended");
    command.option("--output").required(false);  // or --combined
    add_delta_options(command, options->pipeline.delta, &options->pipeline.delta_range);
    add_sampling_option(command, options->pipeline.sizing);
    const Option union_option = add_union_option(command, options->pipeline.union_kind);
    add_choice(command, "--method", options->pipeline.method, kMethodNames,
               "What is kept: 'scale': the discrete scale axis; for comparison 'angle': of the medial axis\n"
               "what has an object angle of --angle at least, 'lambda': what has a circumradius of\n"
               "--lambda at least; these two take no --scale and may change the topology\n[default scale]");
    const Option scale =
        command
            .add_option("--scale", options->pipeline.scales,
                        "Factor by which balls are grown: 1 keeps every feature, larger factors drop those\n"
                        "that are small relative to what they sit on; all share one sampling. auto: the middle\n"
                        "of the longest range of scales over which the sheets change least" +
                            range_and_default(kScaleRange, options->pipeline.scales.front()))
            .transform([options](std::string& text) {
                if (text == "auto") {
                    options->chooses_scale = true;
                    text = "1";
                }
                return std::string();
            })
            .check(in_range(kScaleRange))
            .delimiter(',')
            .one_text_each()
            .value_text("S[,S...]");
    const Option angle =
        add_number(command, "--angle", options->pipeline.filter_angle,
                   "Remove sheets whose object angle is smaller, where that keeps the topology; degrees", kAngleRange,
                   "A", FilterOptions().angle);
    add_length_options(command, "--lambda", options->pipeline.lambda, kLambdaRange,
                       "Least radius of a ball around the closest boundary points, for --method lambda,\n"
                       "relative to the diagonal of the solid's bounding box" +
                           range_and_default(kLambdaRange, kDefaultLambda.value()));
    const Option sharp_angle =
        add_number(command, "--sharp-angle", options->pipeline.sharp_angle,
                   "Sheets end on convex sharp edges of the solid, seams in its corners, in balls of radius 0: edges\n"
                   "where the normals on both sides differ by this angle at least; degrees",
                   kSharpAngleRange, "A", "twice --angle and a degree");
    command
        .add_flag_callback(
            "--no-sharp", [options] { options->pipeline.reaches_sharp_edges = false; },
            "Sheets end before sharp edges, where the balls do")
        .excludes(sharp_angle)
        .value_text(" ");
    add_clean_options(command, options->pipeline.cleaning, "half of delta");
    add_smooth_option(command, options->pipeline.smoothing_rounds,
                      std::to_string(kDefaultSmoothing) + "; 0 where nothing is cleaned");
    command
        .add_flag_callback(
            "--no-center", [options] { options->pipeline.is_centered = false; },
            "Leave the balls as the union has them: they end up to about a third of delta inside the solid")
        .value_text(" ");
    command
        .add_flag("--compact", options->is_compact,
                  "Simplify the axis to a mesh of few vertices, between which balls are interpolated; asked for by\n"
                  "--error and --vertices, too")
        .value_text(" ");
    add_compact_options(command, options->compact, "a quarter of delta");
    const Option dense = add_dense_option(command, options->pipeline.is_dense);
    add_polygons_option(command, options->has_polygons);
    command
        .add_flag("--paper", options->is_as_in_paper,
                  "All as in the paper: --sampling uniform --union polar --clean 0 --dense")
        .excludes(union_option)
        .excludes(dense)
        .excludes(command.option("--sampling"))
        .excludes(command.option("--clean"))
        .excludes(command.option("--clean-abs"))
        .value_text(" ");
    command.add_flag("--no-filter", options->is_unfiltered, "Remove no sheets").excludes(angle).value_text(" ");
    command
        .add_option("--balls", options->balls,
                    "Also write the union of balls: .ply, .balls, .txt, .xyzr or .woff;\n"
                    "a folder gets {name}-balls.ply; {name} is filled in")
        .value_text("FILE");
    command
        .add_option("--mesh", options->mesh,
                    "Also write the boundary of the simplified solid: .ply, .obj, .off or .stl;\n"
                    "a folder gets {name}-mesh.ply; {name} and {scale} as for --output")
        .value_text("FILE");
    add_source_options(command, options->source);
    command
        .add_option("--combined", options->combined,
                    "With --each-label: the axes of all labels of an image in one file, whose cells have an attribute\n"
                    "'label': .vtp or .ply; in place of --output or beside it")
        .needs(command.option("--each-label"))
        .value_text("FILE");
    command
        .add_option("--view", options->view,
                    "Also write a page that any browser shows: .html; all inputs on one,\n"
                    "or with {name} one for each; a folder gets {name}-view.html")
        .value_text("FILE");
    command
        .add_flag("--skip-existing", options->skips_existing,
                  "Skip inputs whose results are all there; with --stats FILE.jsonl the lines of an earlier run stay")
        .value_text(" ");
    add_common_options(command, options->common);
    command.footer(
        "Examples:\n"
        "  scaleaxis axis cat.obj -o cat-axis.ply --view cat.html\n"
        "  scaleaxis axis cat.obj --delta 0.005 --scale 1.05,1.1,1.2 -o cat-axis.ply\n"
        "      writes cat-axis-s1.05.ply, cat-axis-s1.1.ply, cat-axis-s1.2.ply\n"
        "  scaleaxis axis *.off -o 'results/{name}-{scale}.vtp' --stats results/statistics.json\n"
        "  scaleaxis axis liver.nii.gz --label 2 -o liver-axis.ply\n"
        "  scaleaxis axis --implicit '(sqrt(x^2+y^2)-1)^2+z^2-0.1' --bounds -2,-2,-1,2,2,1 -o torus-axis.ply");
    return {command, [options, scale](const std::stop_token& cancel) {
                if (options->pipeline.method != Method::kScale && scale.count() == 0) {
                    options->pipeline.scales = {1.0};  // the local methods grow nothing
                }
                return run_axis(*options, cancel);
            }};
}

}  // namespace scaleaxis::app
