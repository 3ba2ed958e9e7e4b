// SPDX-License-Identifier: Apache-2.0
//
// Runs all models of a folder with default options and tells where the topology is not what it should be.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "bench_common.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::filesystem::path folder;
    std::vector<double> scales{1.0, 1.05, 1.1};
    bool is_uniform = false;
    Batch batch;
    Outputs outputs;
};

struct Job {
    std::filesystem::path model;
    double scale = 1.0;
};

Json measure(const Settings& settings, const Job& job) {
    const Execution execution{settings.batch.threads, {}};
    RepairedMesh repaired = read_solid(job.model);
    const MeshReport mesh = repaired.report;
    const TriangleMesh boundary = repaired.mesh;
    const std::unique_ptr<Solid> shape = mesh_solid(std::move(repaired), execution);
    ScaleAxisOptions options;
    options.delta = Length::relative(settings.batch.delta);
    options.sizing = settings.is_uniform ? Sizing::kUniform : Sizing::kAdaptive;
    options.scales = {job.scale};
    ScaleAxis whole;
    const double axis_seconds = seconds_of([&] { whole = scale_axis(*shape, options, execution); });
    const SurfaceDistance envelope =
        surface_distance(Envelope(whole.axes[0].complex), boundary, {.spacing = whole.tolerance}, execution);
    options.compact = CompactOptions{};
    ScaleAxis result;
    const double seconds = seconds_of([&] { result = scale_axis(*shape, options, execution); });
    const AxisAtScale& axis = result.axes[0];
    const Topology& dual = axis.medial_statistics.dual_complex;
    const std::optional<Topology>& solid = result.solid_topology;
    // What the surface bounds if none of its components lies within another and none cuts another or itself.
    const Topology surface{mesh.components, mesh.euler / 2, std::nullopt, std::nullopt};
    return {{"medial_is_dual", agree(axis.medial_statistics.medial_complex, dual)},
            {"filtered_is_dual", agree(axis.filter_statistics.topology, dual)},
            {"cleaned_is_dual", agree(axis.clean_statistics->topology, dual)},
            {"dual_is_solid", solid ? Json(agree(dual, *solid)) : Json(nullptr)},
            {"dual_is_surface", agree(dual, surface)},
            {"solid", to_json(solid)},
            {"surface", to_json(surface)},
            {"dual", to_json(dual)},
            {"seconds", seconds},
            {"axis_seconds", axis_seconds},
            {"union_distance", result.fit->accuracy.largest_distance / result.tolerance},
            {"envelope_mean", std::max(envelope.a_to_b.mean, envelope.b_to_a.mean) / whole.tolerance},
            {"envelope_largest", envelope.max() / whole.tolerance},
            {"axis_sheets", whole.axes[0].complex.sheets},
            {"triangles", mesh.triangles},
            {"self_intersections", mesh.self_intersections},
            {"samples", result.samples},
            {"irregular_samples", result.sampling_statistics.irregular_samples},
            {"conflicts", result.sampling_statistics.conflicts},
            {"balls", result.balls.size()},
            {"boundary_vertices", axis.medial_statistics.boundary_vertices},
            {"faces", axis.medial_statistics.faces},
            {"sheets", axis.filter_statistics.sheets_before},
            {"sheets_after_filter", axis.filter_statistics.sheets_after},
            {"sheets_after_cleaning", axis.clean_statistics->sheets_after},
            {"curves", axis.clean_statistics->curves},
            {"cleaning_loss", axis.clean_statistics->largest_loss / axis.clean_statistics->thickness},
            {"compact_is_dual", agree(axis.simplify_statistics->topology, dual)},
            {"balls_out", axis.simplify_statistics->vertices_before},
            {"balls_compact", axis.simplify_statistics->vertices_after},
            {"simplification_seconds", axis.costs.back().seconds},
            {"envelope_to_solid", axis.accuracy->envelope_to_solid.value_or(-1.0) / result.diagonal},
            {"retries", axis.medial_statistics.retries}};
}

bool is_true(const Json& report, const char* key) { return report.contains(key) && report[key] == true; }

bool is_fine(const Json& report) {
    return is_true(report, "medial_is_dual") && is_true(report, "filtered_is_dual") &&
           is_true(report, "cleaned_is_dual") && is_true(report, "compact_is_dual") && is_true(report, "dual_is_solid");
}

// "tunnels +2, voids -1"
std::string difference(const Json& solid, const Json& dual) {
    std::string text;
    for (const char* what : {"components", "tunnels", "voids"}) {
        if (!solid[what].is_null() && !dual[what].is_null() && solid[what] != dual[what]) {
            const auto more = dual[what].get<std::int64_t>() - solid[what].get<std::int64_t>();
            text += std::string(text.empty() ? "" : ", ") + what + (more > 0 ? " +" : " ") + std::to_string(more);
        }
    }
    return text.empty() ? "Euler characteristic" : text;
}

std::string what_is_wrong(const Json& report) {
    if (report.contains("error")) {
        return report["error"];
    }
    std::string text;
    const auto add = [&](const std::string& fault) { text += (text.empty() ? "" : "; ") + fault; };
    if (!is_true(report, "medial_is_dual")) {
        add("medial is not dual");
    }
    if (!is_true(report, "filtered_is_dual")) {
        add("filtered is not dual");
    }
    if (!is_true(report, "cleaned_is_dual")) {
        add("cleaned is not dual");
    }
    if (!is_true(report, "compact_is_dual")) {
        add("compact is not dual");
    }
    if (report["dual_is_solid"].is_null()) {
        add("topology of the input unknown, the union " +
            std::string(is_true(report, "dual_is_surface") ? "agrees" : "disagrees") + " with the surface");
    } else if (!is_true(report, "dual_is_solid")) {
        add(difference(report["solid"], report["dual"]));
    }
    return text;
}

// "b0, b1, b2 (χ)"
std::string betti_numbers(const Json& report, const char* which) {
    if (!report.contains(which) || report[which].is_null()) {
        return "?";
    }
    const Json& t = report[which];
    const auto number = [&](const char* key) { return t[key].is_null() ? "?" : t[key].dump(); };
    return number("components") + ", " + number("tunnels") + ", " + number("voids") + " (" + number("euler") + ")";
}

std::string table(const Settings& settings, const std::vector<Json>& reports) {
    std::string text =
        "\n" + settings.folder.filename().string() + ", δ = " + fixed(settings.batch.delta, 4) + ", " +
        std::to_string(settings.batch.jobs) + " models at a time, " + std::to_string(settings.batch.threads) +
        " threads each\n\n" +
        markdown_header({"s", "models", "finished", "medial = dual", "filtered = dual", "cleaned = dual",
                         "compact = dual", "sheets, filtered, cleaned and of the whole axis",
                         "vertices, cleaned and compact", "µs/vertex of simplification", "input known", "dual = solid",
                         "dual = surface", "samples", "balls", "seconds", "seconds of the whole axis",
                         "boundary to union, largest of all, δ", "whole envelope, medians of mean and largest, δ"});
    for (const double scale : settings.scales) {
        const auto total = [&](const auto& value) {
            double sum = 0.0;
            for (const Json& report : reports) {
                sum += report["scale"] == scale ? static_cast<double>(value(report)) : 0.0;
            }
            return sum;
        };
        const auto values = [&](const char* key) {
            std::vector<double> list;
            for (const Json& report : reports) {
                if (report["scale"] == scale && report.contains(key)) {
                    list.push_back(report[key]);
                }
            }
            return list.empty() ? std::vector{0.0} : list;
        };
        const auto count = [&](const auto& question) { return fixed(total(question), 0); };
        const auto sum = [&](const char* key, int digits) {
            return fixed(total([&](const Json& r) { return r.value(key, 0.0); }), digits);
        };
        text += markdown_row(
            {fixed(scale, 2), count([](const Json&) { return true; }),
             count([](const Json& r) { return !r.contains("error"); }),
             count([](const Json& r) { return is_true(r, "medial_is_dual"); }),
             count([](const Json& r) { return is_true(r, "filtered_is_dual"); }),
             count([](const Json& r) { return is_true(r, "cleaned_is_dual"); }),
             count([](const Json& r) { return is_true(r, "compact_is_dual"); }),
             sum("sheets_after_filter", 0) + ", " + sum("sheets_after_cleaning", 0) + ", " + sum("axis_sheets", 0),
             sum("balls_out", 0) + ", " + sum("balls_compact", 0),
             fixed(1e6 * total([](const Json& r) { return r.value("simplification_seconds", 0.0); }) /
                       total([](const Json& r) { return r.value("balls_out", 0.0); }),
                   0),
             count([](const Json& r) { return r.contains("solid") && !r["solid"].is_null(); }),
             count([](const Json& r) { return is_true(r, "dual_is_solid"); }),
             count([](const Json& r) { return is_true(r, "dual_is_surface"); }), sum("samples", 0), sum("balls", 0),
             sum("seconds", 1), sum("axis_seconds", 1), fixed(std::ranges::max(values("union_distance")), 2),
             fixed(median(values("envelope_mean")), 3) + ", " + fixed(median(values("envelope_largest")), 3)});
    }
    text += "\nExceptions (Betti numbers b0, b1, b2 and the Euler characteristic in brackets)\n\n" +
            markdown_header({"model", "s", "what is wrong", "solid", "surface", "union of balls", "irregular samples",
                             "samples", "self-intersections"});
    for (const Json& report : reports) {
        if (!is_fine(report)) {
            const auto number = [&](const char* key) { return report.contains(key) ? report[key].dump() : "?"; };
            text += markdown_row({report["model"].get<std::string>(), fixed(report["scale"], 2), what_is_wrong(report),
                                  betti_numbers(report, "solid"), betti_numbers(report, "surface"),
                                  betti_numbers(report, "dual"), number("irregular_samples"), number("samples"),
                                  number("self_intersections")});
        }
    }
    return text;
}

void run(const Settings& settings) {
    std::vector<Job> jobs;
    for (const std::filesystem::path& model : models_of(settings.folder)) {
        for (const double scale : settings.scales) {
            jobs.push_back({model, scale});
        }
    }
    std::vector<std::function<Json()>> tasks;
    for (const Job& job : jobs) {
        tasks.push_back([&settings, job] { return measure(settings, job); });
    }
    const auto show = [&](std::size_t task, const Json& report) {
        std::cerr << jobs[task].model.filename().string() << ", s = " << jobs[task].scale << ": "
                  << (is_fine(report) ? "right" : what_is_wrong(report)) << '\n';
    };
    std::vector<Json> reports = in_own_processes(tasks, settings.batch.jobs, settings.batch.limit, show);
    for (std::size_t i = 0; i < reports.size(); ++i) {
        reports[i] = named({{"model", jobs[i].model.filename().string()}, {"scale", jobs[i].scale}}, reports[i]);
    }
    const std::string text = table(settings, reports);
    publish(settings.outputs, text,
            {{"folder", settings.folder.string()},
             {"delta", settings.batch.delta},
             {"jobs", settings.batch.jobs},
             {"threads", settings.batch.threads},
             {"runs", reports}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Runs all models of a folder and tells where the topology is not what it should be.");
    program.add_option("folder", settings.folder, "Folder with meshes")->required()->check(CLI::ExistingDirectory);
    program.add_option("--scales", settings.scales, "Scales s")->delimiter(',')->capture_default_str();
    program.add_flag("--uniform", settings.is_uniform, "Samples of one distance, as in the paper");
    add_batch_options(program, settings.batch);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    keep_freed_memory();  // as the command line does
    return exit_status([&] { run(settings); });
}
