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

#include "axis/complex.hpp"
#include "axis/edit/clipped.hpp"
#include "axis/envelope_data.hpp"
#include "base/disjoint_sets.hpp"
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

// The sine of half of 54°. The sides of a more acute edge come so close to each other beside the balls around its
// samples that facets join them, and samples that are to part the sides crowd the edge. At 55° no sample is lost, at
// 50° a few, at 45° seventy.
constexpr double kAcute = 0.454;

// In tolerances: radius of the balls with which tips of acute edges end. With half of it facets join the sides there,
// and with more of it a tip of 10° becomes blunt by more than a tolerance.
constexpr double kTip = 1.0 / 16.0;

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

/// The envelope without the ends of tips, which the sampling could not resolve; the same where it has none, or where it
/// would fall to pieces.
Envelope blunted(const Envelope& envelope, double tolerance) {
    std::vector<Slab> tips;  // around acute edges, as far as balls are too small, but no farther than the tolerance
    for (const EnvelopeCrease& crease : envelope.data().creases()) {
        if (crease.sine < kAcute) {
            const double length = tolerance * kTip / std::max(crease.sine, kTip);
            tips.emplace_back(std::array{Ball{crease.ends[0], length}, Ball{crease.ends[1], length}});
        }
    }
    if (tips.empty()) {
        return envelope;
    }
    const SlabTree tree = build_slab_tree(tips);
    const MedialComplex& complex = envelope.data().complex();
    const MedialComplex rest = clipped(complex, mapped<double>(complex.vertices.size(), [&](std::size_t v) {
                                           return nearest_slab(tree, complex.vertices[v]).near.distance;
                                       }));
    return agree(topology_of(rest), topology_of(complex)) ? Envelope(rest) : envelope;
}

/// The sharp edges that the mesh is to have.
std::vector<std::array<Point, 2>> followed_creases(const Envelope& envelope, double tolerance) {
    std::vector<EnvelopeCrease> creases = envelope.data().creases();
    std::erase_if(creases, [](const EnvelopeCrease& crease) { return crease.sine < kAcute; });
    std::map<std::array<double, 3>, Index> numbers;  // of the ends
    const auto number_of = [&](const Point& p) {
        return numbers.try_emplace({p.x, p.y, p.z}, static_cast<Index>(numbers.size())).first->second;
    };
    DisjointSets sets(2 * creases.size());
    for (const auto& [ends, sine] : creases) {
        sets.join(number_of(ends[0]), number_of(ends[1]));
    }
    std::vector<double> lengths(2 * creases.size(), 0.0);  // of those that hang together
    for (const auto& [ends, sine] : creases) {
        lengths[sets.find(number_of(ends[0]))] += distance(ends[0], ends[1]);
    }
    std::vector<std::array<Point, 2>> followed;
    for (const auto& [ends, sine] : creases) {
        if (lengths[sets.find(number_of(ends[0]))] >= kShortCrease * tolerance) {
            followed.push_back(ends);
        }
    }
    return followed;
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
        const Envelope blunt = in_arena(part, [&] { return blunted(envelope, tolerance); });
        return mesh_of([&](const Execution& inner) { return envelope_solid(blunt, 0.0, inner); }, "envelope", tolerance,
                       followed_creases(blunt, tolerance), envelope.topology(), options, part);
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
