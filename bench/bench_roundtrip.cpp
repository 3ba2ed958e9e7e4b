// SPDX-License-Identifier: Apache-2.0
//
// Mesh → balls → mesh on the models of a folder: how far the two meshes are from each other, and whether the second one
// has the topology of the first.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "bench_common.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::filesystem::path folder = "../shared/data/psb";
    bool suits_features = false;
    bool limits_deviation = false;
    bool is_polar = false;
    std::size_t models = 20;
    Batch batch;
    Outputs outputs;
};

// Models that bound a solid and do not intersect themselves, evenly spread over the folder.
std::vector<std::filesystem::path> chosen_models(const Settings& settings) {
    std::vector<std::filesystem::path> fit;
    for (const std::filesystem::path& model : models_of(settings.folder)) {
        const MeshReport report = repair(read_mesh(model)).report;
        if (report.fault.empty() && report.self_intersections == 0) {
            fit.push_back(model);
        }
    }
    const std::size_t count = std::min(settings.models, fit.size());
    std::vector<std::filesystem::path> chosen;
    for (std::size_t i = 0; i < count; ++i) {
        chosen.push_back(fit[i * fit.size() / count]);
    }
    return chosen;
}

// The diameter of the ball whose sphere is nearest to a point of the surface: how thick the solid is there.
double thickness_at(const Point& p, const std::vector<Ball>& balls) {
    const auto gap = [&](const Ball& ball) { return std::abs(scaleaxis::distance(p, ball.center) - ball.radius); };
    const auto nearest =
        std::min_element(balls.begin(), balls.end(), [&](const Ball& a, const Ball& b) { return gap(a) < gap(b); });
    return 2.0 * nearest->radius;
}

Json to_json(const OneSidedDistance& distance, double tolerance) {
    return {{"max", distance.max / tolerance},
            {"error", distance.error / tolerance},
            {"mean", distance.mean / tolerance},
            {"rms", distance.rms / tolerance},
            {"samples", distance.samples}};
}

Json measure(const Settings& settings, const std::filesystem::path& model) {
    const Execution execution{settings.batch.threads, {}};
    RepairedMesh repaired = read_solid(model);
    const TriangleMesh input = repaired.mesh;
    const MeshReport before = repaired.report;
    const std::unique_ptr<Solid> shape = mesh_solid(std::move(repaired), execution);
    const double tolerance = settings.batch.delta * before.bounds.diagonal();
    Samples samples;
    const double sampling = seconds_of([&] {
        samples = sample(*shape,
                         {.tolerance = tolerance,
                          .suits_features = settings.suits_features,
                          .limits_deviation = settings.limits_deviation},
                         execution);
    });
    const UnionKind kind = settings.is_polar ? UnionKind::kPolar : UnionKind::kFitted;
    const std::vector<Ball> balls =
        scaleaxis::union_of(samples, *shape, {.kind = kind, .topology = shape->topology()}, execution).balls;
    std::unique_ptr<Solid> united;
    const double uniting = seconds_of([&] { united = union_solid(balls, execution); });
    BoundaryMesh result;
    SamplingStatistics statistics;
    const double meshing = seconds_of([&] {
        const Samples again = sample(*united, boundary_sampling(tolerance, settings.limits_deviation), execution);
        statistics = again.statistics;
        result = boundary_mesh(again, execution);
    });
    const MeshReport after = repair(result.mesh, execution).report;
    const SurfaceDistance distance =
        surface_distance(input, result.mesh, {.spacing = 0.25 * tolerance, .accuracy = 0.01 * tolerance}, execution);
    const OneSidedDistance& farther = distance.a_to_b.max > distance.b_to_a.max ? distance.a_to_b : distance.b_to_a;
    const bool is_manifold = after.fault.empty() && after.is_closed() && after.is_manifold() &&
                             after.self_intersections == 0 && after.reversed_triangles == 0 &&
                             after.split_vertices == 0;
    return {{"samples", samples.points.size()},
            {"balls", balls.size()},
            {"triangles", result.mesh.triangles.size()},
            {"input_to_result", to_json(distance.a_to_b, tolerance)},
            {"result_to_input", to_json(distance.b_to_a, tolerance)},
            {"hausdorff", distance.max() / tolerance},
            {"thickness", thickness_at(farther.farthest, balls) / tolerance},
            {"euler_of_input", before.euler},
            {"euler_of_union", 2 * united->topology()->euler},
            {"euler_of_result", after.euler},
            {"is_manifold", is_manifold},
            {"cuts", result.copied_vertices + result.parted_edges},
            {"lost_samples", result.lost_samples},
            {"manifold_samples", statistics.manifold_samples},
            {"seconds_of_sampling", sampling},
            {"seconds_of_union", uniting},
            {"seconds_of_meshing", meshing}};
}

std::string table(const Settings& settings, const std::vector<Json>& reports) {
    std::string text = "\n" + settings.folder.filename().string() + ", δ = " + fixed(settings.batch.delta, 4) +
                       ", s = 1; distances in δ\n\n" +
                       markdown_header({"model", "balls", "triangles", "Hausdorff", "thickness there", "input → result",
                                        "result → input", "mean", "χ input", "χ union", "χ result", "closed manifold",
                                        "cuts", "lost", "(union + mesh) / sampling"});
    std::vector<double> distances, ratios;
    int right = 0, manifold = 0, near = 0, near_or_thin = 0;
    for (const Json& r : reports) {
        const std::string name = r["model"];
        if (r.contains("error")) {
            text += markdown_row({name, r["error"], "", "", "", "", "", "", "", "", "", "", "", ""});
            continue;
        }
        const double ratio = (r["seconds_of_union"].get<double>() + r["seconds_of_meshing"].get<double>()) /
                             r["seconds_of_sampling"].get<double>();
        distances.push_back(r["hausdorff"]);
        ratios.push_back(ratio);
        right += r["euler_of_input"] == r["euler_of_result"] ? 1 : 0;
        manifold += r["is_manifold"].get<bool>() ? 1 : 0;
        near += r["hausdorff"] <= 1.0 ? 1 : 0;
        near_or_thin += r["hausdorff"] <= 1.0 || r["thickness"] < 4.0 ? 1 : 0;
        text += markdown_row({name, r["balls"].dump(), r["triangles"].dump(), fixed(r["hausdorff"], 2),
                              fixed(r["thickness"], 1), fixed(r["input_to_result"]["max"], 2),
                              fixed(r["result_to_input"]["max"], 2), fixed(r["input_to_result"]["mean"], 3),
                              r["euler_of_input"].dump(), r["euler_of_union"].dump(), r["euler_of_result"].dump(),
                              r["is_manifold"].get<bool>() ? "yes" : "NO", r["cuts"].dump(), r["lost_samples"].dump(),
                              fixed(ratio, 2)});
    }
    if (!distances.empty()) {
        const std::string of = " of " + std::to_string(reports.size());
        text += "\nHausdorff distance: median " + fixed(median(distances), 2) + " δ, at most δ for " +
                std::to_string(near) + of + ", or the solid thinner than 4 δ there for " +
                std::to_string(near_or_thin) + of + "; Euler characteristic right for " + std::to_string(right) + of +
                "; closed manifold " + std::to_string(manifold) + of + "; time: median " + fixed(median(ratios), 2) +
                " × the sampling of the input\n";
    }
    return text;
}

void run(const Settings& settings) {
    const std::vector<std::filesystem::path> models = chosen_models(settings);
    std::vector<std::function<Json()>> tasks;
    for (const std::filesystem::path& model : models) {
        tasks.push_back([&settings, model] { return measure(settings, model); });
    }
    std::vector<Json> reports = in_own_processes(tasks, settings.batch.jobs, settings.batch.limit);
    for (std::size_t i = 0; i < reports.size(); ++i) {
        reports[i] = named({{"model", models[i].filename().string()}}, reports[i]);
    }
    const std::string text = table(settings, reports);
    publish(settings.outputs, text,
            {{"folder", settings.folder.string()},
             {"delta", settings.batch.delta},
             {"threads", settings.batch.threads},
             {"runs", reports}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Mesh to balls to mesh: distance and topology.");
    program.add_option("folder", settings.folder, "Folder with meshes")->capture_default_str();
    program.add_flag("--features", settings.suits_features, "Sample more densely where the shape is thin");
    program.add_flag("--tight", settings.limits_deviation,
                     "Sample more densely where the balls, or the result, are far from the shape");
    program.add_flag("--polar", settings.is_polar, "Polar balls in place of fitted ones");
    program.add_option("--models", settings.models, "How many of them")->capture_default_str();
    add_batch_options(program, settings.batch);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    keep_freed_memory();  // as the command line does
    return exit_status([&] { run(settings); });
}
