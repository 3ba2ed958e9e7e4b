// SPDX-License-Identifier: Apache-2.0
//
// Writes random points of a mesh, with the normals of its triangles: an input for bench_pipeline --points.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iomanip>
#include <limits>

#include "base/random.hpp"
#include "bench_common.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::bench;

struct Settings {
    std::filesystem::path input;
    std::filesystem::path output;
    std::uint64_t points = 100'000;
    std::uint64_t seed = 1;
};

/// Half of its length is the area.
Point normal_of(const TriangleMesh& mesh, const std::array<Index, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    return cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
}

void run(const Settings& settings) {
    const TriangleMesh mesh = read_mesh(settings.input);
    std::vector<double> areas;  // of all triangles up to each one
    double sum = 0.0;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        areas.push_back(sum += norm(normal_of(mesh, triangle)));
    }
    if (!(sum > 0.0)) {
        throw UnusableInput("the mesh has no area");
    }
    std::ofstream file(settings.output);
    file << std::setprecision(std::numeric_limits<double>::max_digits10);
    for (std::uint64_t i = 0; i < settings.points; ++i) {
        const auto random = [&](std::uint64_t k) { return random_unit(settings.seed, i, k); };
        const auto at = std::ranges::upper_bound(areas, random(0) * sum) - areas.begin();
        const std::array<Index, 3>& triangle = mesh.triangles[std::min<std::size_t>(at, areas.size() - 1)];
        const Point p = point_of_triangle(mesh, triangle, random(1), random(2));
        const Point normal = normal_of(mesh, triangle);
        const Point unit = (1.0 / norm(normal)) * normal;
        file << p.x << ' ' << p.y << ' ' << p.z << ' ' << unit.x << ' ' << unit.y << ' ' << unit.z << '\n';
    }
    if (!file.flush()) {
        throw std::runtime_error(settings.output.string() + ": cannot be written");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App program("Writes random points of a mesh with normals, for bench_pipeline --points.");
    program.add_option("mesh", settings.input, "Mesh")->required();
    program.add_option("-o", settings.output, "Points, as text (.xyz)")->required();
    program.add_option("--points", settings.points, "How many")->capture_default_str();
    program.add_option("--seed", settings.seed, "Seed of the random choices")->capture_default_str();
    CLI11_PARSE(program, argc, argv);
    return exit_status([&] { run(settings); });
}
