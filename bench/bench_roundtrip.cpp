// SPDX-License-Identifier: Apache-2.0
//
// Mesh → balls → mesh, or mesh → axis → mesh, on the models of a folder: how far the two meshes are from each other,
// and whether the second one has the topology of the first.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bench_common.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/union_mesh.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::filesystem::path folder;
    bool is_uniform = false;
    bool is_polar = false;
    bool is_of_axis = false;
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

/// What a model becomes, and what became of it on the way back.
struct Return {
    std::vector<Ball> balls;  ///< of the union, or at the vertices of the axis
    Index samples = 0;
    std::int64_t euler = 0;  ///< of the boundary of the union, or of the envelope
    BoundaryMesh mesh;
    SamplingStatistics statistics;
    double seconds_there = 0.0;  ///< from the model to its samples, or to its axis
    double seconds_of_union = 0.0;
    double seconds_of_meshing = 0.0;
};

Return through_balls(const Solid& shape, double tolerance, const Settings& settings, const Execution& execution) {
    Return result;
    Samples samples;
    result.seconds_there = seconds_of([&] {
        samples = sample(shape,
                         {.tolerance = tolerance, .sizing = settings.is_uniform ? Sizing::kUniform : Sizing::kAdaptive},
                         execution);
    });
    result.samples = static_cast<Index>(samples.points.size());
    const UnionKind kind = settings.is_polar ? UnionKind::kPolar : UnionKind::kFitted;
    result.balls = scaleaxis::union_of(samples, shape, {.kind = kind, .topology = shape.topology()}, execution).balls;
    std::unique_ptr<Solid> united;
    result.seconds_of_union = seconds_of([&] { united = union_solid(result.balls, execution); });
    result.euler = 2 * united->topology()->euler;
    result.seconds_of_meshing = seconds_of([&] {
        const Samples again = sample(*united, boundary_sampling(tolerance), execution);
        result.statistics = again.statistics;
        result.mesh = boundary_mesh(again, execution);
    });
    return result;
}

Return through_axis(const Solid& shape, double tolerance, const Settings& settings, const Execution& execution) {
    Return result;
    ScaleAxisOptions options;
    options.delta = Length::absolute(tolerance);
    options.scales = {1.0};
    options.sizing = settings.is_uniform ? Sizing::kUniform : Sizing::kAdaptive;
    MedialComplex axis;
    result.seconds_there = seconds_of([&] { axis = scale_axis(shape, options, execution).axes.front().complex; });
    result.balls = balls_of(axis);
    std::optional<Envelope> envelope;
    result.seconds_of_union = seconds_of([&] { envelope.emplace(axis); });
    result.euler = 2 * envelope->topology().euler;
    result.seconds_of_meshing = seconds_of([&] {
        UnionMesh mesh = envelope_mesh(*envelope, {.delta = Length::absolute(tolerance)}, execution);
        result.statistics = mesh.sampling;
        result.mesh = std::move(mesh.boundary);
    });
    return result;
}

Json measure(const Settings& settings, const std::filesystem::path& model) {
    const Execution execution{settings.batch.threads, {}};
    RepairedMesh repaired = read_solid(model);
    const TriangleMesh input = repaired.mesh;
    const MeshReport before = repaired.report;
    const std::unique_ptr<Solid> shape = mesh_solid(std::move(repaired), execution);
    const double tolerance = settings.batch.delta * before.bounds.diagonal();
    const Return result = settings.is_of_axis ? through_axis(*shape, tolerance, settings, execution)
                                              : through_balls(*shape, tolerance, settings, execution);
    const MeshReport after = repair(result.mesh.mesh, execution).report;
    const SurfaceDistance distance = surface_distance(
        input, result.mesh.mesh, {.spacing = 0.25 * tolerance, .accuracy = 0.01 * tolerance}, execution);
    const OneSidedDistance& farther = distance.a_to_b.max > distance.b_to_a.max ? distance.a_to_b : distance.b_to_a;
    const bool is_manifold = after.fault.empty() && after.is_closed() && after.is_manifold() &&
                             after.self_intersections == 0 && after.reversed_triangles == 0 &&
                             after.split_vertices == 0;
    return {{"samples", result.samples},
            {"balls", result.balls.size()},
            {"triangles", result.mesh.mesh.triangles.size()},
            {"input_to_result", to_json(distance.a_to_b, tolerance)},
            {"result_to_input", to_json(distance.b_to_a, tolerance)},
            {"hausdorff", distance.max() / tolerance},
            {"thickness", thickness_at(farther.farthest, result.balls) / tolerance},
            {"euler_of_input", before.euler},
            {"euler_of_union", result.euler},
            {"euler_of_result", after.euler},
            {"is_manifold", is_manifold},
            {"cuts", result.mesh.copied_vertices + result.mesh.parted_edges},
            {"lost_samples", result.mesh.lost_samples},
            {"manifold_samples", result.statistics.manifold_samples},
            {"seconds_of_sampling", result.seconds_there},
            {"seconds_of_union", result.seconds_of_union},
            {"seconds_of_meshing", result.seconds_of_meshing}};
}

std::string table(const Settings& settings, const std::vector<Json>& reports) {
    std::string text = "\n" + settings.folder.filename().string() + ", δ = " + fixed(settings.batch.delta, 4) +
                       ", s = 1; distances in δ\n\n" +
                       markdown_header({"model", "balls", "triangles", "Hausdorff", "thickness there", "input → result",
                                        "result → input", "mean", "χ input", "χ union", "χ result", "closed manifold",
                                        "cuts", "lost", "way back / way there"});
    std::vector<double> distances, means, ratios;
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
        means.push_back(r["input_to_result"]["mean"]);
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
                "; closed manifold " + std::to_string(manifold) + of + "; mean distance of the input: median " +
                fixed(median(means), 3) + " δ; time: median " + fixed(median(ratios), 2) + " × " +
                (settings.is_of_axis ? "that of the axis" : "the sampling of the input") + "\n";
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
    CLI::App program("Mesh to balls, or to axis, to mesh: distance and topology.");
    program.add_option("folder", settings.folder, "Folder with meshes")->required()->check(CLI::ExistingDirectory);
    program.add_flag("--uniform", settings.is_uniform, "Samples of one distance, as in the paper");
    program.add_flag("--polar", settings.is_polar, "Polar balls in place of fitted ones");
    program.add_flag("--axis", settings.is_of_axis,
                     "Through the axis, as it is by default, and its envelope, in place of the union");
    program.add_option("--models", settings.models, "How many of them")->capture_default_str();
    add_batch_options(program, settings.batch);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    keep_freed_memory();  // as the command line does
    return exit_status([&] { run(settings); });
}
