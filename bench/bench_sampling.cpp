// SPDX-License-Identifier: Apache-2.0
//
// Our sampling beside CGAL's one-at-a-time mesher with nothing but the same bound on the surface Delaunay balls.
#include <CGAL/Exact_rational.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/make_mesh_3.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "bench_common.hpp"
#include "cgal_types.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

using MeshDomain = CGAL::Polyhedral_mesh_domain_3<SurfaceMesh, Kernel>;
using MeshTriangulation = CGAL::Mesh_triangulation_3<MeshDomain, CGAL::Default, CGAL::Sequential_tag>::type;
using MeshComplex = CGAL::Mesh_complex_3_in_triangulation_3<MeshTriangulation>;
using MeshCriteria = CGAL::Mesh_criteria_3<MeshTriangulation>;

struct Settings {
    std::filesystem::path mesh;
    int subdivisions = 0;
    double delta = 0.01;
    int repetitions = 1;
    Outputs outputs;
};

struct Center {
    Point point;
    bool is_inside = false;
};

// The circumcentre, computed with rational numbers: that of a nearly flat tetrahedron is rubbish in doubles.
Point circumcenter(const Delaunay::Cell_handle& cell) {
    using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
    const auto exact = [&](int k) {
        const Kernel::Point_3& p = cell->vertex(k)->point();
        return Exact::Point_3(p.x(), p.y(), p.z());
    };
    const Exact::Point_3 center = CGAL::circumcenter(exact(0), exact(1), exact(2), exact(3));
    return {CGAL::to_double(center.x()), CGAL::to_double(center.y()), CGAL::to_double(center.z())};
}

// Measures all restricted Delaunay facets of the points against the bound, from the definition: circumcentres on
// different sides of the surface, and the distance from a vertex to where the line between them crosses it.
Json check_bound(const Solid& shape, const std::vector<Point>& points, double tolerance) {
    const std::vector<Kernel::Point_3> converted = to_cgal(points);
    const Delaunay triangulation(converted.begin(), converted.end());
    const double far = 3.0 * shape.bounds().diagonal();
    std::map<Delaunay::Cell_handle, Center> centers;
    for (const auto& cell : triangulation.finite_cell_handles()) {
        const Point center = circumcenter(cell);
        centers[cell] = {center, shape.inside(center)};
    }
    std::int64_t restricted = 0;
    std::int64_t uncrossed = 0;
    std::int64_t too_large = 0;
    double largest = 0.0;
    for (const auto& [cell, center] : centers) {
        for (int k = 0; center.is_inside && k < 4; ++k) {
            const Delaunay::Cell_handle neighbor = cell->neighbor(k);
            const bool is_hull = triangulation.is_infinite(neighbor);
            if (!is_hull && centers.at(neighbor).is_inside) {
                continue;
            }
            ++restricted;
            Point direction;
            if (is_hull) {
                const Kernel::Triangle_3 facet = triangulation.triangle(cell, k);
                const Point corner = from_cgal(facet[0]);
                const Point normal = cross(from_cgal(facet[1]) - corner, from_cgal(facet[2]) - corner);
                const double side = dot(normal, from_cgal(cell->vertex(k)->point()) - corner);
                direction = (side > 0.0 ? -far : far) / norm(normal) * normal;
            } else {
                direction = centers.at(neighbor).point - center.point;
                direction = std::min(1.0, far / norm(direction)) * direction;
            }
            const Point corner = from_cgal(cell->vertex((k + 1) % 4)->point());
            const std::optional<Point> crossing = shape.crossing(center.point, center.point + direction, corner);
            const double radius = crossing ? distance(*crossing, corner) : 0.0;
            uncrossed += crossing ? 0 : 1;
            too_large += radius > tolerance * (1.0 + 1e-9) ? 1 : 0;
            largest = std::max(largest, radius / tolerance);
        }
    }
    return {{"restricted_facets", restricted},
            {"without_crossing", uncrossed},
            {"over_the_bound", too_large},
            {"largest_in_tolerances", largest}};
}

Json run_ours(const Settings& settings, const std::filesystem::path& mesh, bool is_checked) {
    const Execution one_thread{1, {}};
    RepairedMesh repaired = read_solid(mesh);
    std::unique_ptr<Solid> shape;
    const double building = seconds_of([&] { shape = mesh_solid(std::move(repaired), one_thread); });
    const double tolerance = settings.delta * shape->bounds().diagonal();
    Samples samples;
    const double sampling =
        seconds_of([&] { samples = sample(*shape, {.tolerance = tolerance, .sizing = Sizing::kUniform}, one_thread); });
    Json report{{"building", building}, {"sampling", sampling}, {"points", samples.points.size()}};
    if (is_checked) {
        report["check"] = check_bound(*shape, samples.points, tolerance);
    }
    return report;
}

Json run_cgal(const Settings& settings, const std::filesystem::path& mesh, bool is_checked) {
    RepairedMesh repaired = read_solid(mesh);
    const SurfaceMesh surface = to_cgal(repaired.mesh);
    const double tolerance = settings.delta * repaired.report.bounds.diagonal();
    std::optional<MeshDomain> domain;
    const double building = seconds_of([&] { domain.emplace(surface); });
    const MeshCriteria criteria(CGAL::parameters::facet_size = tolerance);
    MeshComplex complex;
    const double sampling = seconds_of([&] {
        complex = CGAL::make_mesh_3<MeshComplex>(*domain, criteria, CGAL::parameters::no_perturb(),
                                                 CGAL::parameters::no_exude());
    });
    std::vector<Point> points;
    for (const auto& vertex : complex.triangulation().finite_vertex_handles()) {
        const auto& p = vertex->point();
        points.push_back({p.x(), p.y(), p.z()});
    }
    Json report{{"building", building}, {"sampling", sampling}, {"points", points.size()}};
    if (is_checked) {
        report["check"] = check_bound(*mesh_solid(std::move(repaired)), points, tolerance);
    }
    return report;
}

// The repetitions of one program in one report: medians of the seconds, the first one's points and check.
Json summary(const std::vector<Json>& runs, std::size_t first) {
    std::vector<double> building;
    std::vector<double> sampling;
    for (std::size_t i = first; i < runs.size(); i += 2) {
        if (runs[i].contains("error")) {
            return runs[i];
        }
        building.push_back(runs[i]["building"]);
        sampling.push_back(runs[i]["sampling"]);
    }
    return {{"building", measured(building)},
            {"sampling", measured(sampling)},
            {"points", runs[first]["points"]},
            {"check", runs[first]["check"]},
            {"peak_memory", runs[first]["peak_memory"]}};
}

std::string table(const Settings& settings, const Json& ours, const Json& cgal, const Json& comparison) {
    std::string text = "\n" + settings.mesh.filename().string() + ", " + std::to_string(settings.subdivisions) +
                       " subdivisions, δ = " + fixed(settings.delta, 5) + "; seconds, medians of " +
                       std::to_string(settings.repetitions) + "\n\n" +
                       markdown_header({"sampler", "building", "sampling", "points", "restricted facets",
                                        "over the bound", "largest ÷ δD", "without crossing"});
    for (const auto& [name, report] : {std::pair{"ours", ours}, std::pair{"CGAL make_mesh_3", cgal}}) {
        if (report.contains("error")) {
            text += markdown_row({name, report["error"].get<std::string>()});
            continue;
        }
        const Json& check = report["check"];
        text +=
            markdown_row({name, fixed(report["building"]["median"], 3), fixed(report["sampling"]["median"], 3),
                          report["points"].dump(), check["restricted_facets"].dump(), check["over_the_bound"].dump(),
                          fixed(check["largest_in_tolerances"], 4), check["without_crossing"].dump()});
    }
    if (!comparison.is_null()) {
        text += "\n" + fixed(comparison["times_faster"], 2) + " times faster, with " +
                fixed(100.0 * (comparison["times_points"].get<double>() - 1.0), 1) + " % more points\n";
    }
    return text;
}

void run(const Settings& settings) {
    const SubdividedFile mesh(settings.mesh, settings.subdivisions);
    std::vector<std::function<Json()>> tasks;
    for (int repetition = 0; repetition < settings.repetitions; ++repetition) {
        tasks.push_back([&, repetition] { return run_ours(settings, mesh.path(), repetition == 0); });
        tasks.push_back([&, repetition] { return run_cgal(settings, mesh.path(), repetition == 0); });
    }
    const std::vector<Json> runs = in_own_processes(tasks);
    const Json ours = summary(runs, 0);
    const Json cgal = summary(runs, 1);
    Json comparison;
    if (!ours.contains("error") && !cgal.contains("error")) {
        comparison = {
            {"times_faster", cgal["sampling"]["median"].get<double>() / ours["sampling"]["median"].get<double>()},
            {"times_points", ours["points"].get<double>() / cgal["points"].get<double>()}};
    }
    const std::string text = table(settings, ours, cgal, comparison);
    publish(settings.outputs, text,
            {{"mesh", settings.mesh.string()},
             {"subdivisions", settings.subdivisions},
             {"delta", settings.delta},
             {"ours", ours},
             {"make_mesh_3", cgal},
             {"comparison", comparison}});
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Compares the sampling with CGAL's make_mesh_3 (surface criteria only), one thread each.");
    program.add_option("mesh", settings.mesh, "Closed triangle mesh")->required();
    program.add_option("--subdivide", settings.subdivisions, "Steps of Loop's subdivision before all else");
    program.add_option("--delta", settings.delta, "Tolerance δ, relative to the bounding box")->capture_default_str();
    program.add_option("--repeat", settings.repetitions, "Repetitions")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    add_output_options(program, settings.outputs);
    CLI11_PARSE(program, argc, argv);
    keep_freed_memory();  // as the command line does
    return exit_status([&] { run(settings); });
}
