// SPDX-License-Identifier: Apache-2.0
//
// Damages all models of a folder in several ways, and tells how far the result is from that of the model as it was.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "bench_common.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

using Random = std::mt19937_64;
using Triangle = std::array<Index, 3>;

struct Settings {
    std::filesystem::path folder;
    std::size_t models = 96;
    std::vector<std::string> damages;
    std::uint64_t seed = 1;
    Batch batch;
    Outputs outputs;
};

double uniform(Random& random) { return std::uniform_real_distribution<double>(0.0, 1.0)(random); }

double area_of(const TriangleMesh& mesh, const Triangle& t) {
    const std::vector<Point>& p = mesh.vertices;
    return 0.5 * norm(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
}

double area_of(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        sum += area_of(mesh, t);
    }
    return sum;
}

Box box_of(const TriangleMesh& mesh) {
    Box box;
    for (const Point& p : mesh.vertices) {
        box.extend(p);
    }
    return box;
}

/// Triangles around one of them, nearest first, until they have a part of the area.
std::vector<Index> part_around(const TriangleMesh& mesh, Index start, double share) {
    std::vector<std::vector<Index>> at(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const Index v : mesh.triangles[t]) {
            at[v].push_back(static_cast<Index>(t));
        }
    }
    const auto center = [&](Index t) {
        const auto& [u, v, w] = mesh.triangles[t];
        return (1.0 / 3.0) * (mesh.vertices[u] + mesh.vertices[v] + mesh.vertices[w]);
    };
    const Point origin = center(start);
    std::set<std::pair<double, Index>> next{{0.0, start}};
    std::vector<char> is_met(mesh.triangles.size(), 0);
    is_met[start] = 1;
    std::vector<Index> part;
    double left = share * area_of(mesh);
    while (!next.empty() && left > 0.0) {
        const Index t = next.begin()->second;
        next.erase(next.begin());
        part.push_back(t);
        left -= area_of(mesh, mesh.triangles[t]);
        for (const Index v : mesh.triangles[t]) {
            for (const Index other : at[v]) {
                if (!is_met[other]) {
                    is_met[other] = 1;
                    next.insert({distance(center(other), origin), other});
                }
            }
        }
    }
    return part;
}

TriangleMesh without(TriangleMesh mesh, double share, Random& random) {
    std::erase_if(mesh.triangles, [&](const Triangle&) { return uniform(random) < share; });
    return mesh;
}

/// Is a connected part of a surface a disc? One that goes all around a limb is not: without it, that is cut off.
bool is_disc(const TriangleMesh& mesh, const std::vector<Index>& part) {
    std::set<Index> vertices;
    std::set<std::array<Index, 2>> edges;
    for (const Index t : part) {
        for (int k = 0; k < 3; ++k) {
            const Index a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            vertices.insert(a);
            edges.insert({std::min(a, b), std::max(a, b)});
        }
    }
    return std::ssize(vertices) - std::ssize(edges) + std::ssize(part) == 1;
}

TriangleMesh with_holes(TriangleMesh mesh, Random& random) {
    std::vector<char> is_gone(mesh.triangles.size(), 0);
    for (int i = 0; i < 3; ++i) {
        std::vector<Index> part;
        do {
            part = part_around(mesh, static_cast<Index>(random() % mesh.triangles.size()), 0.01);
        } while (!is_disc(mesh, part));
        for (const Index t : part) {
            is_gone[t] = 1;
        }
    }
    std::size_t t = 0;
    std::erase_if(mesh.triangles, [&](const Triangle&) { return is_gone[t++] != 0; });
    return mesh;
}

TriangleMesh with_turned(TriangleMesh mesh, Random& random) {
    for (Triangle& t : mesh.triangles) {
        if (uniform(random) < 0.2) {
            std::swap(t[1], t[2]);
        }
    }
    return mesh;
}

TriangleMesh torn(const TriangleMesh& mesh, Random& random) {
    const double most = 1e-6 * box_of(mesh).diagonal() / std::sqrt(3.0);
    const auto moved = [&](double x) { return x + most * (2.0 * uniform(random) - 1.0); };
    TriangleMesh result;
    for (const Triangle& t : mesh.triangles) {
        const auto first = static_cast<Index>(result.vertices.size());
        for (const Index v : t) {
            const Point& p = mesh.vertices[v];
            result.vertices.push_back({moved(p.x), moved(p.y), moved(p.z)});
        }
        result.triangles.push_back({first, first + 1, first + 2});
    }
    return result;
}

TriangleMesh twice(TriangleMesh mesh) {
    const std::vector<Triangle> copy = mesh.triangles;
    mesh.triangles.insert(mesh.triangles.end(), copy.begin(), copy.end());
    return mesh;
}

/// A smaller copy of a part in the largest of some balls inside.
TriangleMesh with_walls(TriangleMesh mesh, const Solid& solid, Random& random) {
    const Box box = box_of(mesh);
    Ball largest{{}, 0.0};
    for (int i = 0; i < 3000; ++i) {
        const Point d = box.max - box.min;
        const Point p{box.min.x + d.x * uniform(random), box.min.y + d.y * uniform(random),
                      box.min.z + d.z * uniform(random)};
        if (solid.inside(p)) {
            const double radius = distance(p, *solid.nearest(p));
            largest = radius > largest.radius ? Ball{p, radius} : largest;
        }
    }
    const std::vector<Index> part = part_around(mesh, static_cast<Index>(random() % mesh.triangles.size()), 0.1);
    Box around;
    for (const Index t : part) {
        for (const Index v : mesh.triangles[t]) {
            around.extend(mesh.vertices[v]);
        }
    }
    const double scale = 0.8 * largest.radius / (0.5 * around.diagonal());
    std::map<Index, Index> copies;
    for (const Index t : part) {
        Triangle copy = mesh.triangles[t];
        for (Index& v : copy) {
            const auto [place, is_new] = copies.emplace(v, static_cast<Index>(mesh.vertices.size()));
            if (is_new) {
                mesh.vertices.push_back(largest.center + scale * (mesh.vertices[v] - midpoint(around.min, around.max)));
            }
            v = place->second;
        }
        mesh.triangles.push_back(copy);
    }
    return mesh;
}

const std::vector<std::string> kDamages{"removed 1 %", "removed 5 %", "holes", "turned", "torn", "twice", "walls"};

TriangleMesh damaged(const TriangleMesh& mesh, const Solid& solid, const std::string& damage, Random& random) {
    if (damage == "removed 1 %") {
        return without(mesh, 0.01, random);
    }
    if (damage == "removed 5 %") {
        return without(mesh, 0.05, random);
    }
    if (damage == "holes") {
        return with_holes(mesh, random);
    }
    if (damage == "turned") {
        return with_turned(mesh, random);
    }
    if (damage == "torn") {
        return torn(mesh, random);
    }
    return damage == "twice" ? twice(mesh) : with_walls(mesh, solid, random);
}

/// Seconds of processor time: what else runs on the machine matters less.
double processor_seconds_of(const std::function<void()>& work) {
    const std::clock_t start = std::clock();
    work();
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// What comes of a mesh.
struct Outcome {
    SolidOfTriangles solid;
    std::vector<Point> samples;
    double volume = 0.0;  ///< of the inner tetrahedra of the samples
    Topology topology;    ///< of the union of balls
    double seconds = 0.0;
};

Outcome outcome_of(const TriangleMesh& mesh, double tolerance, const Execution& execution) {
    Outcome outcome;
    SampledUnion united;
    outcome.seconds = processor_seconds_of([&] {
        outcome.solid = solid_of_triangles(mesh, {}, execution);
        if (!outcome.solid.solid) {
            throw UnusableInput(outcome.solid.report.fault);
        }
        united = sampled_union(*outcome.solid.solid, {.tolerance = tolerance}, {}, execution);
    });
    outcome.topology = BallUnion(united.balls.balls).topology(execution);
    const Samples& samples = united.samples;
    for (std::size_t t = 0; t < samples.tetrahedra.size(); ++t) {
        const auto& [a, b, c, d] = samples.tetrahedra[t];
        const std::vector<Point>& p = samples.points;
        outcome.volume += samples.inside[t] ? std::abs(dot(p[b] - p[a], cross(p[c] - p[a], p[d] - p[a]))) / 6.0 : 0.0;
    }
    outcome.samples = samples.points;
    return outcome;
}

struct Farthest {
    double distance = 0.0;
    Point place;
};

/// Of the points of one boundary the farthest from another one, without those that are as close to a closed hole as
/// it is wide.
Farthest farthest(const std::vector<Point>& points, const Solid& solid, const std::vector<Hole>& holes) {
    Farthest result;
    for (const Point& p : points) {
        const double far = distance(p, *solid.nearest(p));
        const bool is_at_hole =
            std::ranges::any_of(holes, [&](const Hole& hole) { return distance(hole.place, p) < 1.5 * hole.width; });
        if (far > result.distance && !is_at_hole) {
            result = {far, p};
        }
    }
    return result;
}

std::vector<Json> measure(const Settings& settings, const std::filesystem::path& model) {
    const Execution execution{settings.batch.threads, {}};
    const TriangleMesh mesh = read_solid(model).mesh;
    const double tolerance = settings.batch.delta * box_of(mesh).diagonal();
    const Outcome whole = outcome_of(mesh, tolerance, execution);
    std::vector<Json> reports;
    for (const std::string& damage : settings.damages) {
        Random random(settings.seed);
        const TriangleMesh given = damaged(mesh, *whole.solid.solid, damage, random);
        Json report{{"model", model.filename().string()}, {"damage", damage}};
        try {
            const Outcome now = outcome_of(given, tolerance, execution);
            const std::vector<Hole>& holes = now.solid.report.holes;
            const double there = farthest(now.samples, *whole.solid.solid, {}).distance;
            const double back = farthest(whole.samples, *now.solid.solid, {}).distance;
            const double away = std::max(farthest(now.samples, *whole.solid.solid, holes).distance,
                                         farthest(whole.samples, *now.solid.solid, holes).distance);
            report["reason"] = now.solid.report.reason;
            report["holes"] = holes.size();
            report["is_topology_right"] = now.topology == whole.topology;
            report["topology"] = to_json(now.topology);
            report["topology_of_whole"] = to_json(whole.topology);
            report["volume"] = now.volume / whole.volume;
            report["hausdorff"] = std::max(there, back) / tolerance;
            report["hausdorff_away_from_holes"] = away / tolerance;
            report["seconds"] = now.seconds;
            report["seconds_of_whole"] = whole.seconds;
        } catch (const std::exception& error) {
            report["error"] = error.what();
        }
        reports.push_back(report);
    }
    return reports;
}

std::string table(const Settings& settings, const std::vector<Json>& reports) {
    std::string text =
        "\n" + settings.folder.filename().string() + ", δ = " + fixed(settings.batch.delta, 4) + "\n\n" +
        markdown_header({"damage", "models", "finished", "right topology", "volume within 2 %", "Hausdorff ≤ 2 δ",
                         "the same away from holes", "median time ÷ undamaged", "largest"});
    for (const std::string& damage : settings.damages) {
        const auto count = [&](const auto& question) {
            return std::to_string(
                std::ranges::count_if(reports, [&](const Json& r) { return r["damage"] == damage && question(r); }));
        };
        const auto finished = [](const Json& r) { return !r.contains("error"); };
        const auto at_most = [&](const char* key) {
            return count([&](const Json& r) { return finished(r) && r[key] <= 2.0; });
        };
        std::vector<double> ratios;
        for (const Json& r : reports) {
            if (r["damage"] == damage && finished(r)) {
                ratios.push_back(r["seconds"].get<double>() / r["seconds_of_whole"].get<double>());
            }
        }
        const bool is_any = !ratios.empty();
        text += markdown_row(
            {damage, count([](const Json&) { return true; }), count(finished),
             count([&](const Json& r) { return finished(r) && r["is_topology_right"] == true; }),
             count([&](const Json& r) { return finished(r) && std::abs(r["volume"].get<double>() - 1.0) <= 0.02; }),
             at_most("hausdorff"), at_most("hausdorff_away_from_holes"), is_any ? fixed(median(ratios), 2) : "",
             is_any ? fixed(*std::ranges::max_element(ratios), 2) : ""});
    }
    text += "\nExceptions\n\n" + markdown_header({"model", "damage", "what is wrong"});
    for (const Json& r : reports) {
        std::string wrong;
        const auto add = [&](const std::string& what) { wrong += (wrong.empty() ? "" : "; ") + what; };
        if (r.contains("error")) {
            add(r["error"]);
        } else {
            if (r["is_topology_right"] != true) {
                add("topology " + r["topology"].dump() + " in place of " + r["topology_of_whole"].dump());
            }
            if (std::abs(r["volume"].get<double>() - 1.0) > 0.02) {
                add("volume " + fixed(r["volume"], 3));
            }
            if (r["hausdorff_away_from_holes"] > 2.0) {
                add("Hausdorff away from holes " + fixed(r["hausdorff_away_from_holes"], 2) + " δ");
            }
            if (r["seconds"] > 3.0 * r["seconds_of_whole"].get<double>()) {
                add("time " + fixed(r["seconds"].get<double>() / r["seconds_of_whole"].get<double>(), 1) + " ×");
            }
        }
        if (!wrong.empty()) {
            text += markdown_row({r["model"], r["damage"], wrong});
        }
    }
    return text;
}

void run(const Settings& settings) {
    std::vector<std::filesystem::path> models = models_of(settings.folder);
    std::vector<std::filesystem::path> chosen;
    const std::size_t count = std::min(settings.models, models.size());
    for (std::size_t i = 0; i < count; ++i) {
        chosen.push_back(models[i * models.size() / count]);
    }
    std::vector<std::function<Json()>> tasks;
    for (const std::filesystem::path& model : chosen) {
        tasks.push_back([&settings, model] { return Json{{"runs", measure(settings, model)}}; });
    }
    const auto tell = [&](std::size_t task, const Json& result) {
        std::cerr << chosen[task].filename().string() << ' ' << result.dump() << '\n';
    };
    const std::vector<Json> results = in_own_processes(tasks, settings.batch.jobs, settings.batch.limit, tell);
    std::vector<Json> reports;
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (results[i].contains("error")) {
            for (const std::string& damage : settings.damages) {
                reports.push_back(
                    {{"model", chosen[i].filename().string()}, {"damage", damage}, {"error", results[i]["error"]}});
            }
            continue;
        }
        for (const Json& report : results[i]["runs"]) {
            reports.push_back(report);
        }
    }
    publish(settings.outputs, table(settings, reports),
            {{"folder", settings.folder.string()},
             {"delta", settings.batch.delta},
             {"seed", settings.seed},
             {"runs", reports}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    settings.damages = kDamages;
    CLI::App program("Damaged meshes beside whole ones.");
    program.add_option("folder", settings.folder, "Folder with meshes that bound solids")
        ->required()
        ->check(CLI::ExistingDirectory);
    program.add_option("--models", settings.models, "How many of them")->capture_default_str();
    program.add_option("--damage", settings.damages, "Which kinds of damage")
        ->check(CLI::IsMember(kDamages))
        ->delimiter(',');
    program.add_option("--seed", settings.seed, "Of the damage")->capture_default_str();
    add_batch_options(program, settings.batch);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    keep_freed_memory();  // as the command line does
    return exit_status([&] { run(settings); });
}
