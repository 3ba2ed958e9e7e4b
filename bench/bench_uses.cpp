// SPDX-License-Identifier: Apache-2.0
//
// What is made of an axis, beside the axis itself: seconds of each, on all models of a folder.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <string_view>

#include "bench_common.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/measures.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/midsurface.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/skeleton.hpp"
#include "scaleaxis/thickness.hpp"
#include "scaleaxis/view.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

constexpr std::array<std::string_view, 7> kUses{"axis",  "skeleton", "thickness", "midsurface",
                                                "table", "page",     "compare"};

struct Settings {
    std::filesystem::path folder;
    double scale = 1.1;
    Batch batch;
    Outputs outputs;
};

Json measure(const Settings& settings, const std::filesystem::path& model) {
    const Execution execution{settings.batch.threads, {}};
    const RepairedMesh input = read_solid(model);
    const std::unique_ptr<Solid> shape = mesh_solid(input, execution);
    ScaleAxisOptions options;
    options.delta = Length::relative(settings.batch.delta);
    options.scales = {settings.scale};
    Json seconds;
    MedialComplex axis;
    double diagonal = 0.0;
    seconds["axis"] = seconds_of([&] {
        ScaleAxis result = scale_axis(*shape, options, execution);
        diagonal = result.diagonal;
        axis = std::move(result.axes[0].complex);
    });
    Skeleton curves;
    seconds["skeleton"] = seconds_of([&] { curves = skeleton(axis, *shape, {}, execution); });
    seconds["thickness"] = seconds_of([&] { Thickness(axis).at_surface(input.mesh.vertices, execution); });
    seconds["midsurface"] = seconds_of([&] { midsurface(axis, *shape, {}, execution); });
    seconds["table"] = seconds_of([&] { measures(axis, curves, input.mesh, {}, execution); });
    std::size_t bytes = 0;
    seconds["page"] = seconds_of([&] {
        ViewedModel viewed{model.stem().string(), input.mesh, {}, {}};
        viewed.axes.push_back({axis, {}, {}});
        bytes = view_data(viewed, execution).size();
    });
    seconds["compare"] =
        seconds_of([&] { surface_distance(Envelope(axis), input.mesh, {.spacing = 0.002 * diagonal}, execution); });
    return {{"vertices", axis.vertices.size()},
            {"triangles", input.mesh.triangles.size()},
            {"page_bytes", bytes},
            {"seconds", seconds}};
}

std::string table(const Settings& settings, const std::vector<std::filesystem::path>& models,
                  const std::vector<Json>& reports) {
    std::vector<std::string> titles{"model", "vertices of the axis", "triangles", "page, kB"};
    for (const std::string_view use : kUses) {
        titles.push_back(std::string(use) + " s");
    }
    std::string text = "\n" + settings.folder.filename().string() + ", δ = " + fixed(settings.batch.delta, 4) +
                       ", s = " + fixed(settings.scale, 2) + "\n\n" + markdown_header(titles);
    std::vector<std::vector<double>> columns(3 + kUses.size());
    for (std::size_t m = 0; m < models.size(); ++m) {
        const Json& r = reports[m];
        std::vector<std::string> row{models[m].stem().string()};
        if (r.contains("error")) {
            text += markdown_row({row[0], r["error"].get<std::string>()});
            continue;
        }
        std::vector<double> values{r["vertices"].get<double>(), r["triangles"].get<double>(),
                                   r["page_bytes"].get<double>() / 1000.0};
        for (const std::string_view use : kUses) {
            values.push_back(r["seconds"][std::string(use)].get<double>());
        }
        for (std::size_t k = 0; k < values.size(); ++k) {
            columns[k].push_back(values[k]);
            row.push_back(fixed(values[k], k < 3 ? 0 : 3));
        }
        text += markdown_row(row);
    }
    if (!columns[0].empty()) {
        for (const bool is_median : {true, false}) {
            std::vector<std::string> row{is_median ? "median" : "most"};
            for (std::size_t k = 0; k < columns.size(); ++k) {
                row.push_back(fixed(is_median ? median(columns[k]) : std::ranges::max(columns[k]), k < 3 ? 0 : 3));
            }
            text += markdown_row(row);
        }
    }
    return text;
}

void run(const Settings& settings) {
    const std::vector<std::filesystem::path> models = models_of(settings.folder);
    std::vector<std::function<Json()>> tasks;
    for (const std::filesystem::path& model : models) {
        tasks.emplace_back([&settings, model] { return measure(settings, model); });
    }
    const std::vector<Json> reports =
        in_own_processes(tasks, settings.batch.jobs, settings.batch.limit, [&](std::size_t task, const Json& report) {
            std::cerr << models[task].filename().string() << ": "
                      << (report.contains("error") ? report["error"].get<std::string>() : std::string("done")) << '\n';
        });
    publish(settings.outputs, table(settings, models, reports),
            {{"delta", settings.batch.delta}, {"runs", by_model(models, reports)}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Seconds of what is made of an axis, on all models of a folder");
    program.add_option("folder", settings.folder, "Folder with meshes")->required()->check(CLI::ExistingDirectory);
    program.add_option("--scale", settings.scale, "Scale of the axis");
    add_batch_options(program, settings.batch);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    return exit_status([&] { run(settings); });
}
