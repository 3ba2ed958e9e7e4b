// SPDX-License-Identifier: Apache-2.0
//
// Times the pipeline stage by stage beside one plain Delaunay triangulation of uniform samples.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <iostream>

#include "bench_common.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "source.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;
using Json = scaleaxis::bench::Json;  // not that of the library, which the inputs bring

struct Settings {
    std::filesystem::path input;
    app::SourceOptions source;
    int subdivisions = 0;
    std::vector<double> deltas;
    std::vector<double> samples;
    std::vector<double> balls;
    double scale = 1.1;
    bool is_uniform = false;
    bool is_as_in_paper = false;
    std::vector<int> threads{1};
    int repetitions = 3;
    Outputs outputs;
};

struct Configuration {
    double delta = 0.0;
    int threads = 1;
};

constexpr std::array kStages{"input",     "sampling",    "balls",      "fit",         "union repair",
                             "accuracy",  "medial axis", "filter",     "sharp edges", "cleaning",
                             "shrinking", "smoothing",   "scale axis", "delaunay"};

double median_of(const Json& report, const char* stage) { return report["seconds"][stage]["median"].get<double>(); }

// δ for which about `target` samples (or, with `balls`, balls) come out. Their number is about proportional to 1/δ².
double find_delta(const Solid& shape, double target, bool balls) {
    constexpr int kMostRuns = 6;
    constexpr double kNearEnough = 0.01;
    const double diagonal = shape.bounds().diagonal();
    double delta = 0.02;
    double best = delta;
    double best_error = std::numeric_limits<double>::infinity();
    for (int run = 0; run < kMostRuns && best_error > kNearEnough; ++run) {
        const Samples samples = sample(shape, {.tolerance = delta * diagonal, .sizing = Sizing::kUniform});
        const std::size_t count = balls ? inner_balls(samples).size() : samples.points.size();
        const double ratio = static_cast<double>(count) / target;
        if (std::abs(std::log(ratio)) < best_error) {
            best_error = std::abs(std::log(ratio));
            best = delta;
        }
        delta = std::clamp(delta * std::sqrt(ratio), 1e-5, 0.5);
    }
    return best;
}

/// The one input, its mesh subdivided where that is asked for.
app::Source source_of(const Settings& settings, const std::filesystem::path& file) {
    const std::vector<app::Source> sources =
        app::sources_of(file.empty() ? std::vector<app::Input>() : app::expanded({file}), settings.source);
    if (sources.size() != 1) {
        throw InvalidOption("one solid at a time can be measured");
    }
    return sources.front();
}

std::vector<double> chosen_deltas(const Settings& settings, const app::Source& source) {
    if (!settings.deltas.empty()) {
        return settings.deltas;
    }
    const auto find = [&]() -> Json {
        const std::unique_ptr<Solid> solid = app::load_source(source, {}).solid;
        Json deltas = Json::array();
        for (const double target : settings.samples) {
            deltas.push_back(find_delta(*solid, target, false));
        }
        for (const double target : settings.balls) {
            deltas.push_back(find_delta(*solid, target, true));
        }
        return {{"deltas", deltas}};
    };
    const Json found = in_own_processes({find})[0];
    if (found.contains("error")) {
        throw std::runtime_error(found["error"].get<std::string>());
    }
    return found["deltas"].get<std::vector<double>>();
}

Json counts(const ScaleAxis& result) {
    const AxisAtScale& axis = result.axes[0];
    return {{"samples", result.samples},
            {"inside_queries", result.sampling_statistics.inside_queries},
            {"crossing_queries", result.sampling_statistics.crossing_queries},
            {"refinement_rounds", result.sampling_statistics.rounds},
            {"conflicts", result.sampling_statistics.conflicts},
            {"balls", result.balls.size()},
            {"hidden_balls", axis.medial_statistics.hidden_balls},
            {"boundary_vertices", axis.medial_statistics.boundary_vertices},
            {"cells", axis.medial_statistics.cells},
            {"faces", axis.medial_statistics.faces},
            {"retries", axis.medial_statistics.retries},
            {"sheets", axis.filter_statistics.sheets_before},
            {"sheets_after_filter", axis.filter_statistics.sheets_after},
            {"balls_out", axis.complex.vertices.size()}};
}

Json topology_of(const ScaleAxis& result) {
    const Topology& dual = result.axes[0].medial_statistics.dual_complex;
    const Topology& medial = result.axes[0].medial_statistics.medial_complex;
    const Topology& filtered = result.axes[0].filter_statistics.topology;
    return {{"solid", bench::to_json(result.solid_topology)},
            {"dual", bench::to_json(dual)},
            {"medial_is_dual", agree(medial, dual)},
            {"filtered_is_dual", agree(filtered, dual)},
            {"dual_is_solid", result.solid_topology ? Json(agree(dual, *result.solid_topology)) : Json(nullptr)}};
}

// One configuration: the whole way from the file, again and again, each time followed by the plain triangulation.
Json measure(const Settings& settings, const app::Source& source, const Configuration& configuration) {
    const Execution execution{configuration.threads, {}};
    Json report;
    Json seconds;
    std::vector<Point> samples;
    for (int repetition = 0; repetition < settings.repetitions; ++repetition) {
        LoadedSolid input;
        ScaleAxis result;
        ScaleAxisOptions options;
        options.delta = Length::relative(configuration.delta);
        options.scales = {settings.scale};
        if (settings.is_uniform || settings.is_as_in_paper) {
            options.sizing = Sizing::kUniform;
        }
        if (settings.is_as_in_paper) {
            options.union_kind = UnionKind::kPolar;
            options.is_dense = true;
            options.cleaning = Length::relative(0.0);
        }
        seconds["input"].push_back(seconds_of([&] { input = app::load_source(source, execution); }));
        seconds["scale axis"].push_back(seconds_of([&] { result = scale_axis(*input.solid, options, execution); }));
        for (const auto& costs : {input.costs, result.costs, result.axes[0].costs}) {
            for (const StageCost& cost : costs) {
                seconds[cost.stage].push_back(cost.seconds);
            }
        }
        if (repetition == 0) {
            report["peak_memory"] = peak_memory();
            report["counts"] = counts(result);
            report["topology"] = topology_of(result);
            samples =
                sample(*input.solid, {.tolerance = result.tolerance, .sizing = Sizing::kUniform, .seed = options.seed},
                       execution)
                    .points;
        }
        seconds["delaunay"].push_back(delaunay_seconds(samples));
    }
    for (const auto& [stage, values] : seconds.items()) {
        report["seconds"][stage] = measured(values.get<std::vector<double>>());
    }
    const double total = median_of(report, "scale axis");
    const double delaunay = median_of(report, "delaunay");
    report["times_delaunay"] = total / delaunay;
    report["times_delaunay_with_input"] = (total + median_of(report, "input")) / delaunay;
    report["seconds_per_sample"] = total / static_cast<double>(samples.size());
    return report;
}

// How the configurations compare: threads with the first number of threads, costs with those of the first δ.
void compare(std::vector<Json>& reports, std::size_t thread_counts) {
    for (std::size_t i = 0; i < reports.size(); ++i) {
        Json& report = reports[i];
        const Json& first_threads = reports[i - i % thread_counts];
        const Json& first_delta = reports[i % thread_counts];
        if (report.contains("error")) {
            continue;
        }
        if (!first_threads.contains("error")) {
            report["speed_up"] = median_of(first_threads, "scale axis") / median_of(report, "scale axis");
        }
        if (!first_delta.contains("error")) {
            report["growth_per_sample"] =
                report["seconds_per_sample"].get<double>() / first_delta["seconds_per_sample"].get<double>();
        }
    }
}

std::string table(const Settings& settings, const std::vector<Json>& reports) {
    const std::string name =
        settings.input.empty() ? settings.source.function.expression : settings.input.filename().string();
    std::string text = "\n" + name + ", " + std::to_string(settings.subdivisions) +
                       " subdivisions, s = " + fixed(settings.scale, 2) + "; seconds, medians of " +
                       std::to_string(settings.repetitions) + "\n\n";
    std::vector<std::string> titles{"δ", "threads", "samples", "balls"};
    titles.insert(titles.end(), kStages.begin(), kStages.end());
    titles.insert(titles.end(), {"÷ delaunay", "with input", "speed-up", "µs/sample", "growth", "peak MB",
                                 "medial = dual", "dual = solid"});
    text += markdown_header(titles);
    for (const Json& report : reports) {
        if (report.contains("error")) {
            text += markdown_row({fixed(report["delta"], 5), report["threads"].dump(), report["error"]});
            continue;
        }
        const auto number = [&](const char* key, double factor, int digits) {
            return report.contains(key) ? fixed(factor * report[key].get<double>(), digits) : "";
        };
        std::vector<std::string> cells{fixed(report["delta"], 5), report["threads"].dump(),
                                       report["counts"]["samples"].dump(), report["counts"]["balls"].dump()};
        for (const char* stage : kStages) {
            cells.push_back(report["seconds"].contains(stage) ? fixed(median_of(report, stage), 3) : "");
        }
        cells.insert(
            cells.end(),
            {number("times_delaunay", 1.0, 2), number("times_delaunay_with_input", 1.0, 2), number("speed_up", 1.0, 2),
             number("seconds_per_sample", 1e6, 1), number("growth_per_sample", 1.0, 2), number("peak_memory", 1e-6, 0),
             report["topology"]["medial_is_dual"].dump(), report["topology"]["dual_is_solid"].dump()});
        text += markdown_row(cells);
    }
    return text;
}

void run(const Settings& settings) {
    const SubdividedFile file(settings.input, settings.subdivisions);
    const app::Source source = source_of(settings, file.path());
    std::vector<Configuration> configurations;
    std::vector<std::function<Json()>> tasks;
    for (const double delta : chosen_deltas(settings, source)) {
        for (const int threads : settings.threads) {
            configurations.push_back({delta, threads});
            tasks.push_back([&, delta, threads] { return measure(settings, source, {delta, threads}); });
        }
    }
    std::vector<Json> reports = in_own_processes(tasks);
    for (std::size_t i = 0; i < reports.size(); ++i) {
        reports[i] = named({{"delta", configurations[i].delta}, {"threads", configurations[i].threads}}, reports[i]);
    }
    compare(reports, settings.threads.size());
    const std::string text = table(settings, reports);
    publish(settings.outputs, text,
            {{"input", settings.input.string()},
             {"options", Json::parse(app::to_json(settings.source).dump())},
             {"subdivisions", settings.subdivisions},
             {"scale", settings.scale},
             {"paper", settings.is_as_in_paper},
             {"configurations", reports}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Times the pipeline stage by stage beside one plain Delaunay triangulation of uniform samples.");
    program.add_option("input", settings.input, "Mesh, image or balls; none with --implicit");
    program.add_option("--subdivide", settings.subdivisions, "Steps of Loop's subdivision of a mesh before all else");
    CLI::Option_group* size = program.add_option_group("size", "How fine; several values: one configuration each");
    size->add_option("--delta", settings.deltas, "Tolerance δ, relative to the bounding box")->delimiter(',');
    size->add_option("--samples", settings.samples, "Number of uniform samples; finds δ")->delimiter(',');
    size->add_option("--balls", settings.balls, "Number of balls; finds δ")->delimiter(',');
    size->require_option(1);
    program.add_flag("--uniform", settings.is_uniform, "Samples of one distance, as in the paper");
    program.add_flag("--paper", settings.is_as_in_paper,
                     "Polar balls and a dense axis, nothing cleaned, as in the paper");
    program.add_option("--scale", settings.scale, "Scale s")->capture_default_str();
    program.add_option("--threads", settings.threads, "Numbers of threads")->delimiter(',')->capture_default_str();
    program.add_option("--repeat", settings.repetitions, "Repetitions")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app::add_source_options(program, settings.source);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    keep_freed_memory();  // as the command line does
    return exit_status([&] { run(settings); });
}
