// SPDX-License-Identifier: Apache-2.0
//
// Polar balls and fitted balls of the same samples side by side: topology, sheets, sizes, and what fit and repair cost.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "bench_common.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/fit.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::vector<std::filesystem::path> models;
    std::vector<double> scales{1.0, 1.1};
    Batch batch{.limit = 900};
    Outputs outputs;
};

Json axis_at(std::span<const Ball> balls, double scale, const std::optional<Topology>& solid,
             const Execution& execution) {
    MedialAxis axis;
    const double seconds = seconds_of([&] { axis = medial_axis(scaled(balls, scale), {}, execution); });
    const FilteredComplex filtered_axis = filter(axis.complex, {}, execution);
    const Topology& dual = axis.statistics.dual_complex;
    return {{"scale", scale},
            {"is_right", solid ? Json(agree(dual, *solid)) : Json(nullptr)},
            {"topology", bench::to_json(dual)},
            {"sheets", filtered_axis.statistics.sheets_after},
            {"vertices", filtered_axis.complex.vertices.size()},
            {"seconds", seconds}};
}

Json axes_of(std::span<const Ball> balls, const Settings& settings, const std::optional<Topology>& solid,
             const Execution& execution) {
    Json json{{"balls", balls.size()}, {"axes", Json::array()}};
    for (const double scale : settings.scales) {
        json["axes"].push_back(axis_at(balls, scale, solid, execution));
    }
    return json;
}

double seconds_of_stage(const SolidUnion& fitted, std::string_view stage) {
    return std::ranges::find(fitted.costs, stage, &StageCost::stage)->seconds;
}

Json measure(const Settings& settings, const std::filesystem::path& model) {
    const Execution execution{settings.batch.threads, {}};
    const std::unique_ptr<Solid> solid = mesh_solid(read_solid(model), execution);
    const std::optional<Topology> topology = solid->topology();
    SamplingOptions sampling;
    sampling.tolerance = tolerance_of(Length::relative(settings.batch.delta), solid->bounds().diagonal());
    Samples samples;
    const double sampling_seconds = seconds_of([&] { samples = sample(*solid, sampling, execution); });
    const SolidUnion polar = scaleaxis::union_of(samples, *solid, {UnionKind::kPolar}, execution);
    const SolidUnion fitted = scaleaxis::union_of(samples, *solid, {UnionKind::kFitted, topology}, execution);
    return {{"solid", bench::to_json(topology)},
            {"samples", samples.points.size()},
            {"sampling_seconds", sampling_seconds},
            {"ball_seconds", seconds_of_stage(fitted, "balls")},
            {"fit_seconds", seconds_of_stage(fitted, "fit")},
            {"repair_seconds", seconds_of_stage(fitted, "union repair")},
            {"accuracy_seconds", seconds_of_stage(fitted, "accuracy")},
            {"fit", Json::parse(scaleaxis::to_json(*fitted.fit))},
            {"polar", axes_of(polar.balls, settings, topology, execution)},
            {"fitted", axes_of(fitted.balls, settings, topology, execution)}};
}

std::string betti_numbers(const Json& t) {
    const auto number = [&](const char* key) { return t[key].is_null() ? "?" : t[key].dump(); };
    return t.is_null() ? "?" : number("components") + "," + number("tunnels") + "," + number("voids");
}

std::string verdict(const Json& axis) { return axis["is_right"] == true ? "right" : betti_numbers(axis["topology"]); }

std::string steps_in_words(const Json& steps) {
    std::string text;
    for (const Json& step : steps) {
        text += (text.empty() ? "" : "; ") + step["name"].get<std::string>() + " +" + step["added"].dump();
    }
    return text.empty() ? "-" : text;
}

std::string table(const Settings& settings, const std::vector<Json>& reports) {
    std::string text = "\nδ = " + fixed(settings.batch.delta, 4) + "; polar → fitted\n\n" +
                       markdown_header({"model", "solid", "s", "topology", "sheets", "vertices", "balls", "sampling s",
                                        "fit s", "repair s", "steps"});
    for (const Json& report : reports) {
        if (report.contains("error")) {
            text += markdown_row({report["model"], report["error"]});
            continue;
        }
        for (std::size_t i = 0; i < settings.scales.size(); ++i) {
            const Json& polar = report["polar"]["axes"][i];
            const Json& fitted = report["fitted"]["axes"][i];
            const auto both = [&](const char* key) { return polar[key].dump() + " → " + fitted[key].dump(); };
            text +=
                markdown_row({report["model"], betti_numbers(report["solid"]), fixed(settings.scales[i], 2),
                              verdict(polar) + " → " + verdict(fitted), both("sheets"), both("vertices"),
                              report["polar"]["balls"].dump() + " → " + report["fitted"]["balls"].dump(),
                              fixed(report["sampling_seconds"], 2), fixed(report["fit_seconds"], 2),
                              fixed(report["repair_seconds"], 2), steps_in_words(report["fit"]["repair"]["steps"])});
        }
    }
    text += "\n" + markdown_header({"s", "known", "right, polar", "right, fitted", "sheets, median", "vertices, median",
                                    "balls", "fit ÷ sampling", "repair ÷ sampling"});
    for (std::size_t i = 0; i < settings.scales.size(); ++i) {
        std::array<std::vector<double>, 2> sheets, vertices;
        std::array<int, 2> right{};
        std::array<double, 2> balls{};
        int known = 0;
        double sampling = 0.0, fit = 0.0, repair = 0.0;
        for (const Json& report : reports) {
            if (report.contains("error")) {
                continue;
            }
            known += report["solid"].is_null() ? 0 : 1;
            sampling += report["sampling_seconds"].get<double>();
            fit += report["fit_seconds"].get<double>();
            repair += report["repair_seconds"].get<double>();
            for (std::size_t k = 0; k < 2; ++k) {
                const Json& one = report[k == 0 ? "polar" : "fitted"];
                right[k] += one["axes"][i]["is_right"] == true ? 1 : 0;
                balls[k] += one["balls"].get<double>();
                sheets[k].push_back(one["axes"][i]["sheets"]);
                vertices[k].push_back(one["axes"][i]["vertices"]);
            }
        }
        if (sheets[0].empty()) {
            continue;
        }
        const auto medians = [](const auto& values) {
            return fixed(median(values[0]), 0) + " → " + fixed(median(values[1]), 0);
        };
        text +=
            markdown_row({fixed(settings.scales[i], 2), std::to_string(known), std::to_string(right[0]),
                          std::to_string(right[1]), medians(sheets), medians(vertices),
                          fixed(balls[1] / balls[0], 3) + " ×", fixed(fit / sampling, 2), fixed(repair / sampling, 2)});
    }
    return text;
}

void run(const Settings& settings) {
    std::vector<std::filesystem::path> models;
    for (const std::filesystem::path& path : settings.models) {
        if (std::filesystem::is_directory(path)) {
            const auto inside = models_of(path);
            models.insert(models.end(), inside.begin(), inside.end());
        } else {
            models.push_back(path);
        }
    }
    std::vector<std::function<Json()>> tasks;
    for (const std::filesystem::path& model : models) {
        tasks.push_back([&settings, model] { return measure(settings, model); });
    }
    const auto show = [&](std::size_t task, const Json&) { std::cerr << models[task].string() << '\n'; };
    std::vector<Json> reports = in_own_processes(tasks, settings.batch.jobs, settings.batch.limit, show);
    for (std::size_t i = 0; i < reports.size(); ++i) {
        reports[i] = named({{"model", models[i].filename().string()}}, reports[i]);
    }
    publish(settings.outputs, table(settings, reports), {{"delta", settings.batch.delta}, {"runs", reports}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Polar and fitted balls side by side.");
    program.add_option("models", settings.models, "Meshes, or folders with meshes")->required();
    program.add_option("--scales", settings.scales, "Scales s")->delimiter(',')->capture_default_str();
    add_batch_options(program, settings.batch);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    keep_freed_memory();  // as the command line does
    return exit_status([&] { run(settings); });
}
