// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/union_mesh.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "axis/envelope_data.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "pipeline/run.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/solid.hpp"
#include "solid/mesh/repair/cleaning.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/weld.hpp"

namespace scaleaxis::inline v1 {
namespace {

// In tolerances: sharp edges that are shorter in all are those of thin tips, where samples on them would leave none of
// the few that the sides have.
constexpr double kShortCrease = 10.0;

// In degrees: the sides of a more acute edge come so close to each other beside the balls around its samples that
// facets join them, and samples that are to part the sides crowd the edge. At 55 no sample is lost, at 50 a few, at 45
// seventy.
constexpr double kAcuteCrease = 54.0;

// Share of the progress bar taken by the first mesh of an envelope. A second one is seldom needed.
constexpr double kFirstWork = 0.9;

// In tolerances: smaller parts of the mesh come from samples on sharp edges, which may lie closer together than those
// beside them.
constexpr double kSpeck = 0.25;

/// Leaves out parts of the mesh that are far smaller than the tolerance, if there are more parts than the solid has.
void drop_specks(BoundaryMesh& boundary, const Topology& solid, double tolerance) {
    TriangleMesh& mesh = boundary.mesh;
    DisjointSets parts = parts_of(mesh);
    std::map<Index, Box> boxes;
    for (Index v = 0; v < static_cast<Index>(mesh.vertices.size()); ++v) {
        boxes[parts.find(v)].extend(mesh.vertices[v]);
    }
    std::vector<std::pair<double, Index>> sizes;
    for (const auto& [part, box] : boxes) {
        sizes.emplace_back(box.diagonal(), part);
    }
    std::ranges::sort(sizes);
    std::set<Index> specks;
    const auto surplus = std::ssize(sizes) - solid.components - solid.voids.value_or(0);
    for (std::ptrdiff_t k = 0; k < surplus && sizes[k].first < kSpeck * tolerance; ++k) {
        specks.insert(sizes[k].second);
    }
    if (specks.empty()) {
        return;
    }
    std::erase_if(mesh.triangles, [&](const auto& triangle) { return specks.contains(parts.find(triangle[0])); });
    boundary.lost_samples += static_cast<Index>(drop_isolated_vertices(mesh));
    std::vector<Point> places = mesh.vertices;
    weld(places);
    boundary.copied_vertices = static_cast<Index>(mesh.vertices.size() - places.size());
}

// Half the Euler characteristic of the boundary is that of the solid.
bool has_topology_of_solid(const UnionMesh& mesh) { return !mesh.solid || mesh.report.euler == 2 * mesh.solid->euler; }

std::vector<Diagnostic> warnings_of(const UnionMesh& mesh) {
    std::vector<Diagnostic> warnings;
    const Index cuts = mesh.boundary.copied_vertices + mesh.boundary.parted_edges;
    if (cuts > 0) {
        warnings.push_back({"mesh.cut", "the boundary of the balls is no manifold in " + std::to_string(cuts) +
                                            " places, where parts touch: the mesh is cut apart there"});
    }
    if (mesh.boundary.lost_samples > 0) {
        warnings.push_back(
            {"mesh.lost_samples", std::to_string(mesh.boundary.lost_samples) +
                                      " samples have no triangle: parts of the boundary that are much smaller than the "
                                      "tolerance are left out; use a smaller one to have them"});
    }
    if (!has_topology_of_solid(mesh)) {
        warnings.push_back({"mesh.union_topology",
                            "the Euler characteristic of the mesh is " + std::to_string(mesh.report.euler) +
                                ", that of the boundary of the balls is " + std::to_string(2 * mesh.solid->euler) +
                                ": they have tunnels, gaps or voids smaller than the tolerance; use a smaller one"});
    }
    return warnings;
}

/// \param solid_of makes the solid \param creases of it \param topology of it, if it does not know
template <class SolidOf>
UnionMesh mesh_of(const SolidOf& solid_of, const std::string& stage, double tolerance,
                  std::vector<std::array<Point, 2>> creases, const std::optional<Topology>& topology,
                  const UnionMeshOptions& options, const Execution& execution) {
    UnionMesh result;
    result.tolerance = tolerance;
    SamplingOptions sampling = boundary_sampling(tolerance);
    sampling.seed = options.seed;
    sampling.creases = std::move(creases);
    return in_arena(execution, [&] {
        Run run(execution, 6.0);
        const std::unique_ptr<Solid> solid = run.stage(stage, 1.0, result.costs, solid_of);
        result.solid = topology ? topology : solid->topology();
        const Samples samples = run.stage("sampling", 3.0, result.costs,
                                          [&](const Execution& inner) { return sample(*solid, sampling, inner); });
        result.samples = static_cast<Index>(samples.points.size());
        result.sampling = samples.statistics;
        result.boundary = run.stage("boundary mesh", 1.0, result.costs,
                                    [&](const Execution& inner) { return boundary_mesh(samples, inner); });
        if (result.solid) {
            drop_specks(result.boundary, *result.solid, tolerance);
        }
        result.report = run.stage("mesh check", 1.0, result.costs,
                                  [&](const Execution& inner) { return repair(result.boundary.mesh, inner).report; });
        result.warnings = warnings_of(result);
        run.finish();
        return std::move(result);
    });
}

}  // namespace

UnionMesh union_mesh(std::vector<Ball> balls, const UnionMeshOptions& options, const Execution& execution) {
    const double tolerance = options.delta.of(bounds(balls).diagonal());
    return mesh_of([&](const Execution& inner) { return union_solid(std::move(balls), inner); }, "union of balls",
                   tolerance, {}, std::nullopt, options, execution);
}

UnionMesh envelope_mesh(const Envelope& envelope, const UnionMeshOptions& options, const Execution& execution) {
    const auto mesh_at = [&](double tolerance, const Execution& part) {
        return mesh_of([&](const Execution& inner) { return envelope_solid(envelope, 0.0, inner); }, "envelope",
                       tolerance, envelope.data().creases(kShortCrease * tolerance, kAcuteCrease), envelope.topology(),
                       options, part);
    };
    const double tolerance = options.delta.of(envelope.bounds().diagonal());
    UnionMesh mesh = mesh_at(tolerance, part_of(execution, 0.0, kFirstWork));
    if (!has_topology_of_solid(mesh)) {
        // Walls thinner than the tolerance get holes.
        UnionMesh finer = mesh_at(0.5 * tolerance, part_of(execution, kFirstWork, 1.0));
        if (has_topology_of_solid(finer)) {
            finer.costs.insert(finer.costs.begin(), mesh.costs.begin(), mesh.costs.end());
            mesh = std::move(finer);
        }
    }
    report(execution, "boundary mesh", 1.0);
    return mesh;
}

}  // namespace scaleaxis::inline v1
