// SPDX-License-Identifier: Apache-2.0
//
// A few balls that cover a solid: what the library finds, and greedy set cover of the same candidates.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bench_common.hpp"
#include "scaleaxis/few_balls.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::vector<std::filesystem::path> models;
    Index count = 32;
    double error = 0.0;  ///< relative to the diagonal; 0: by the count
    Index search_size = 3000;
    double effort = 1.0;
    bool is_inside = false;
    bool checks_all = true;
    Batch batch{.limit = 900};
    Outputs outputs;
};

Json json_of(const FewBalls& found, const BallScores& scores, double diagonal, double seconds) {
    return {{"balls", found.balls.size()},
            {"seconds", seconds},
            {"error", found.statistics.error / diagonal},
            {"count_bound", found.statistics.count_bound},
            {"candidates", found.statistics.candidates},
            {"search_points", found.statistics.search_points},
            {"coverage", scores.coverage},
            {"surface_coverage", scores.surface_coverage},
            {"largest_gap", scores.largest_gap / diagonal},
            {"largest_protrusion", scores.largest_protrusion / diagonal},
            {"mean_protrusion", scores.mean_protrusion / diagonal},
            {"protrusion_95", scores.protrusion_95 / diagonal},
            {"volume_ratio", scores.volume_ratio}};
}

Json measure(const Settings& settings, const std::filesystem::path& model) {
    const Execution execution{settings.batch.threads, {}};
    const std::unique_ptr<Solid> solid = mesh_solid(read_solid(model), execution);
    const double diagonal = solid->bounds().diagonal();
    const SamplingOptions sampling{.tolerance = tolerance_of(Length::relative(settings.batch.delta), diagonal)};
    const SampledUnion made = sampled_union(*solid, sampling, {}, execution);
    // Other points than the search has seen.
    const std::vector<Point> points = solid->seeds(0.004 * diagonal, 7, execution);
    Json result;
    for (const bool improves : {true, false}) {
        FewBallsOptions options{.kind = settings.is_inside ? FewBallsKind::kInside : FewBallsKind::kCover,
                                .search_size = settings.search_size,
                                .effort = settings.effort,
                                .improves = improves,
                                .checks_all = settings.checks_all};
        if (settings.error > 0.0) {
            options.error = settings.error * diagonal;
        } else {
            options.count = settings.count;
        }
        FewBalls found;
        const double seconds =
            seconds_of([&] { found = few_balls(made.balls.balls, made.samples.points, *solid, options, execution); });
        const BallScores scores = ball_scores(found.balls, points, *solid, 1, execution);
        result[improves ? "ours" : "greedy"] = json_of(found, scores, diagonal, seconds);
    }
    return result;
}

const std::vector<std::string> kColumns{
    "balls",           "coverage",      "surface_coverage", "largest_gap", "error", "largest_protrusion",
    "mean_protrusion", "protrusion_95", "volume_ratio",     "seconds"};

std::string both(const Json& report, const std::string& key) {
    const auto text = [&](const char* name) {
        const Json& value = report[name][key];
        return value.is_number_integer() ? value.dump() : fixed(value, key == "seconds" ? 2 : 5);
    };
    return text("greedy") + " → " + text("ours");
}

std::string table(const std::vector<Json>& reports) {
    std::vector<std::string> header{"model", "count_bound"};
    header.insert(header.end(), kColumns.begin(), kColumns.end());
    std::string text = "\nGreedy set cover → ours; lengths relative to the diagonal\n\n" + markdown_header(header);
    std::vector<std::vector<double>> ours(kColumns.size()), greedy(kColumns.size());
    int better = 0;
    for (const Json& report : reports) {
        if (report.contains("error")) {
            text += markdown_row({report["model"], report["error"]});
            continue;
        }
        std::vector<std::string> row{report["model"], report["ours"]["count_bound"].dump()};
        for (std::size_t i = 0; i < kColumns.size(); ++i) {
            row.push_back(both(report, kColumns[i]));
            ours[i].push_back(report["ours"][kColumns[i]]);
            greedy[i].push_back(report["greedy"][kColumns[i]]);
        }
        better += report["ours"]["coverage"] >= report["greedy"]["coverage"] &&
                          report["ours"]["surface_coverage"] >= report["greedy"]["surface_coverage"] &&
                          // Balls that leave a gap stick out so much more once they are enlarged until they cover.
                          report["ours"]["largest_protrusion"] <= report["greedy"]["largest_protrusion"].get<double>() +
                                                                      report["greedy"]["largest_gap"].get<double>() &&
                          report["ours"]["mean_protrusion"] <= report["greedy"]["mean_protrusion"]
                      ? 1
                      : 0;
        text += markdown_row(row);
    }
    std::vector<std::string> row{"median", ""};
    for (std::size_t i = 0; i < kColumns.size() && !ours[0].empty(); ++i) {
        row.push_back(fixed(median(greedy[i]), 5) + " → " + fixed(median(ours[i]), 5));
    }
    return text + markdown_row(row) +
           "\nIn coverage, of volume and surface, and protrusion, largest and mean, no worse: " +
           std::to_string(better) + " of " + std::to_string(ours[0].size()) + "\n";
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
    publish(settings.outputs, table(reports), {{"count", settings.count}, {"runs", reports}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Few balls and greedy set cover side by side.");
    program.add_option("models", settings.models, "Meshes, or folders with meshes")->required();
    program.add_option("--count", settings.count, "Number of balls")->capture_default_str();
    program.add_option("--error", settings.error, "In place of the number: the error, relative to the diagonal");
    program.add_option("--search-size", settings.search_size, "Points and candidates")->capture_default_str();
    program.add_option("--effort", settings.effort, "How long the search goes on")->capture_default_str();
    program.add_flag("--inside", settings.is_inside, "Inner balls in place of covering ones");
    program.add_flag("!--search-only", settings.checks_all, "The points of the search alone count");
    add_batch_options(program, settings.batch);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    keep_freed_memory();  // as the command line does
    return exit_status([&] { run(settings); });
}
