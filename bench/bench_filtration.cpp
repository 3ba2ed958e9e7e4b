// SPDX-License-Identifier: Apache-2.0
//
// The filtration of the axis by scale of all models of a folder: is every level a part of the one before, with the
// topology of the whole, and how long does it take beside one scale of the axis?
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "bench_common.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "spatial/ball_tree.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::filesystem::path folder;
    int levels = 30;
    double largest_scale = 3.0;
    Batch batch;
    Outputs outputs;
};

bool is_part(const MedialComplex& part, const MedialComplex& whole) {
    // Elements keep their order.
    const auto is_subsequence = [](const auto& few, const auto& all) {
        auto at = all.begin();
        return std::ranges::all_of(few, [&](const auto& item) {
            at = std::find(at, all.end(), item);
            return at != all.end() && (++at, true);
        });
    };
    const auto sides = [](const MedialComplex& complex) {
        std::vector<std::array<Point, 2>> result;
        for (const auto& [a, b] : complex.edges) {
            result.push_back({complex.vertices[a], complex.vertices[b]});
        }
        return result;
    };
    const auto polygons = [](const MedialComplex& complex) {
        std::vector<std::vector<Point>> result(complex.faces.size());
        for (std::size_t f = 0; f < result.size(); ++f) {
            for (const Index v : complex.faces[f]) {
                result[f].push_back(complex.vertices[v]);
            }
        }
        return result;
    };
    return is_subsequence(part.vertices, whole.vertices) && is_subsequence(sides(part), sides(whole)) &&
           is_subsequence(polygons(part), polygons(whole));
}

/// Points on a complex, hardly farther apart than its vertices.
std::vector<Ball> points_of(const MedialComplex& complex) {
    std::vector<Ball> points;
    for (const Point& p : complex.vertices) {
        points.push_back({p, 0.0});
    }
    for (const auto& [a, b] : complex.edges) {
        points.push_back({midpoint(complex.vertices[a], complex.vertices[b]), 0.0});
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        Point sum{};
        for (const Index v : complex.faces[f]) {
            sum = sum + complex.vertices[v];
        }
        points.push_back({(1.0 / static_cast<double>(complex.faces[f].size())) * sum, 0.0});
    }
    return points;
}

/// How far the points of a complex are from those of another, in the mean and for 95 % of them.
Json distance_to(const MedialComplex& from, const MedialComplex& to, double diagonal) {
    const BallTree tree = build_ball_tree(points_of(to));
    std::vector<double> distances;
    double sum = 0.0;
    for (const Ball& point : points_of(from)) {
        distances.push_back(nearest_ball(tree, point.center).distance / diagonal);
        sum += distances.back();
    }
    std::ranges::sort(distances);
    return {{"mean", sum / static_cast<double>(distances.size())},
            {"percentile_95", distances[distances.size() * 95 / 100]},
            {"max", distances.back()}};
}

/// The levels beside the axes of the grown balls.
Json compared(const Filtration& nested, const Solid& shape, ScaleAxisOptions options, const Execution& execution) {
    Json result = Json::array();
    options.scales = {1.05, 1.1, 1.2, 1.5};
    const ScaleAxis grown = scale_axis(shape, options, execution);
    for (const AxisAtScale& axis : grown.axes) {
        const MedialComplex level = cut(nested, axis.complex.scale);
        result.push_back({{"scale", axis.complex.scale},
                          {"level_to_grown", distance_to(level, axis.complex, grown.diagonal)},
                          {"grown_to_level", distance_to(axis.complex, level, grown.diagonal)},
                          {"sheets_of_level", level.sheets},
                          {"sheets_of_grown", axis.complex.sheets}});
    }
    return result;
}

Json measure(const Settings& settings, const std::filesystem::path& model) {
    const Execution execution{settings.batch.threads, {}};
    const std::unique_ptr<Solid> shape = mesh_solid(read_solid(model), execution);
    ScaleAxisOptions options;
    options.delta = Length::relative(settings.batch.delta);
    options.scales = {1.0};
    ScaleAxis axis;
    const double all_seconds = seconds_of([&] { axis = scale_axis(*shape, options, execution); });
    double scale_seconds = 0.0;  // without the sampling and the balls, which several scales share
    for (const StageCost& cost : axis.axes[0].costs) {
        scale_seconds += cost.seconds;
    }
    Filtration nested;
    const double seconds = seconds_of([&] { nested = filtration(axis.axes[0].complex, {}, execution); });
    const Topology whole = topology(nested.complex);
    int nested_levels = 0;
    int homotopic_levels = 0;
    Json sheets = Json::array();
    MedialComplex before = nested.complex;
    for (int k = 0; k < settings.levels; ++k) {
        MedialComplex level = cut(nested, std::pow(settings.largest_scale, k / (settings.levels - 1.0)));
        nested_levels += is_part(level, before) ? 1 : 0;
        homotopic_levels += topology(level) == whole ? 1 : 0;
        sheets.push_back(level.sheets);
        before = std::move(level);
    }
    const auto never = std::ranges::count(nested.ball_scales, kNeverVanishes);
    return {{"nested", nested_levels},
            {"homotopic", homotopic_levels},
            {"voids_known", whole.voids.has_value()},
            {"balls", nested.complex.vertices.size()},
            {"balls_that_never_vanish", never},
            {"compared", compared(nested, *shape, options, execution)},
            {"sheets", sheets},
            {"seconds", seconds},
            {"scale_seconds", scale_seconds},
            {"all_seconds", all_seconds}};
}

std::string table(const Settings& settings, const std::vector<std::filesystem::path>& models,
                  const std::vector<Json>& reports) {
    std::string text = "\n" + settings.folder.filename().string() + ", δ = " + fixed(settings.batch.delta, 4) + "\n\n" +
                       markdown_header({"model", "balls", "nested", "homotopic", "filtration s", "one scale s",
                                        "with sampling s", "sheets at the first, middle and last level"});
    int fine = 0;
    std::vector<double> ratios;
    std::vector<double> ratios_all;
    for (std::size_t m = 0; m < models.size(); ++m) {
        const Json& r = reports[m];
        const std::string name = models[m].stem().string();
        if (r.contains("error")) {
            text += markdown_row({name, r["error"].get<std::string>()});
            continue;
        }
        const auto number = [&](const char* key) { return r[key].dump(); };
        const auto seconds = [&](const char* key) { return r[key].get<double>(); };
        fine += r["nested"] == settings.levels && r["homotopic"] == settings.levels ? 1 : 0;
        ratios.push_back(seconds("seconds") / seconds("scale_seconds"));
        ratios_all.push_back(seconds("seconds") / seconds("all_seconds"));
        const Json& sheets = r["sheets"];
        text += markdown_row(
            {name, number("balls"), number("nested"), number("homotopic"), fixed(seconds("seconds"), 2),
             fixed(seconds("scale_seconds"), 2), fixed(seconds("all_seconds"), 2),
             sheets.front().dump() + ", " + sheets[sheets.size() / 2].dump() + ", " + sheets.back().dump()});
    }
    text += "\nNested and homotopic at all of " + std::to_string(settings.levels) + " levels: " + std::to_string(fine) +
            " of " + std::to_string(models.size()) + " models.\n";
    text += "\n" + markdown_header({"s", "level to grown axis: mean, 95 %, largest", "grown axis to level",
                                    "sheets of the "
                                    "level, of the grown axis"});
    for (std::size_t k = 0; k < 4; ++k) {
        const auto median_of = [&](const auto& of) {
            std::vector<double> values;
            for (const Json& r : reports) {
                if (!r.contains("error")) {
                    values.push_back(of(r["compared"][k]));
                }
            }
            return values.empty() ? 0.0 : median(values);
        };
        const auto distances = [&](const char* way) {
            std::string words;
            for (const char* key : {"mean", "percentile_95", "max"}) {
                const double value = median_of([&](const Json& c) { return c[way][key].get<double>(); });
                words += (words.empty() ? "" : ", ") + fixed(100.0 * value, 2) + " %";
            }
            return words;
        };
        const auto sheets = [&](const char* of) {
            return fixed(median_of([&](const Json& c) { return c[of].get<double>(); }), 0);
        };
        text += markdown_row({fixed(median_of([](const Json& c) { return c["scale"].get<double>(); }), 2),
                              distances("level_to_grown"), distances("grown_to_level"),
                              sheets("sheets_of_level") + ", " + sheets("sheets_of_grown")});
    }
    text += "Medians over the models, of the diagonal of the box.\n";
    if (!ratios.empty()) {
        text += "Time of the filtration as a part of that of one scale: median " + fixed(median(ratios), 2) +
                ", at most " + fixed(std::ranges::max(ratios), 2) + "; of one scale with its sampling: median " +
                fixed(median(ratios_all), 2) + ", at most " + fixed(std::ranges::max(ratios_all), 2) + ".\n";
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
                      << (report.contains("error") ? report["error"].get<std::string>()
                                                   : fixed(report["seconds"].get<double>(), 2) + " s")
                      << '\n';
        });
    publish(settings.outputs, table(settings, models, reports),
            {{"delta", settings.batch.delta}, {"runs", by_model(models, reports)}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Filtration of the axis by scale of all models of a folder");
    program.add_option("folder", settings.folder, "Folder with meshes")->required()->check(CLI::ExistingDirectory);
    program.add_option("--levels", settings.levels, "Levels that are looked at")->check(CLI::Range(2, 1000));
    program.add_option("--largest-scale", settings.largest_scale, "Scale of the last one");
    add_batch_options(program, settings.batch);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    return exit_status([&] { run(settings); });
}
