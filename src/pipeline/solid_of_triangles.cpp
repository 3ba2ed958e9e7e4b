// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "base/random.hpp"
#include "base/text.hpp"
#include "pipeline/solid_of_triangles.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "solid/mesh/distance_solids.hpp"
#include "solid/mesh/repair/repair.hpp"
#include "solid/mesh/winding.hpp"
#include "spatial/extent.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// The parts of a closed surface that are oriented outward.
TriangleMesh outward_parts(const TriangleMesh& mesh) {
    DisjointSets parts = parts_of(mesh);
    // A cavity is oriented inward: its volume is negative.
    std::vector<double> volumes(mesh.vertices.size(), 0.0);
    for (const auto& [u, v, w] : mesh.triangles) {
        const Index part = parts.find(u);
        const Point& o = mesh.vertices[part];
        volumes[part] += dot(mesh.vertices[u] - o, cross(mesh.vertices[v] - o, mesh.vertices[w] - o));
    }
    TriangleMesh result{mesh.vertices, {}};
    std::ranges::copy_if(mesh.triangles, std::back_inserter(result.triangles),
                         [&](const std::array<Index, 3>& triangle) { return volumes[parts.find(triangle[0])] > 0.0; });
    return result;
}

/// The parts of a closed surface that no other part lies around.
TriangleMesh outer_parts(const TriangleMesh& closed) {
    const Bvh bvh = build_bvh(outward_parts(closed));
    const TriangleMesh& mesh = bvh.mesh;
    const Box box = box_around(mesh.vertices);
    DisjointSets parts = parts_of(mesh);
    const auto part_of_triangle = [&](Index t) { return parts.find(mesh.triangles[t][0]); };
    std::vector<std::optional<bool>> is_nested(mesh.vertices.size());
    TriangleMesh result{mesh.vertices, {}};
    for (Index t = 0; t < static_cast<Index>(mesh.triangles.size()); ++t) {
        const Index part = part_of_triangle(t);
        if (!is_nested[part]) {
            is_nested[part] = winding_number(bvh, box, mesh.vertices[part],
                                             [&](Index other) { return part_of_triangle(other) != part; }) != 0;
        }
        if (!*is_nested[part]) {
            result.triangles.push_back(mesh.triangles[t]);
        }
    }
    return result;
}

/// \param thick the triangles, thickened by `thickness`, which is the opening or larger
/// \param tolerance of the samples of its boundary, relative to the opening
/// \throws InvalidOption if there would be too many
void check_opening(const Solid& thick, double thickness, double opening, double tolerance) {
    constexpr double kMostSamples = 5e5;  // they take about a minute of processor time, and 1.1 GB
    constexpr double kClearly = 4.0;      // thickened more, the smallest parts have larger boundaries
    constexpr double kSpare = 1.05;       // the opening that is named is to do even if its boundary is a little larger
    constexpr double kMostSaid = 1e12;    // "or more"
    // As many as there are at a distance of `thickness`, and more by the square of how much closer they are to be.
    const double seeds = static_cast<double>(thick.seeds(thickness, 1, {}).size());
    const double least = thickness / tolerance * std::sqrt(seeds / kMostSamples);
    const double times = (least / opening) * (least / opening);
    if (times > (thickness > opening ? kClearly : 1.0)) {
        Words text(3);
        text << "the opening of " << opening << " is too fine for these triangles: it takes "
             << 1e-6 * std::min(times * kMostSamples, kMostSaid) << " million samples or more, and "
             << 1e-6 * kMostSamples << " are the most; choose an opening of at least " << kSpare * least;
        throw InvalidOption(text.str());
    }
}

/// What a ball of diameter `opening` cannot reach from outside.
/// \throws InvalidOption if the opening is too small, also for the time that it takes; UnusableInput if the ball
/// reaches everything; Cancelled
std::unique_ptr<Solid> wrapped(TriangleMesh mesh, double opening, const Execution& execution) {
    // The centres of balls that come from outside and touch the triangles lie on the outer boundary of the thickened
    // triangles. What is inside of it, and farther from it than the radius, is not reached.
    // Spacing of samples of that boundary where it is flat, in openings, ...
    constexpr double kTolerance = 1.0 / 3.0;
    // ... and distance of the triangles between them where it is bent, around edges with a radius of 1/2.
    constexpr double kDistance = 1.0 / 48.0;
    // Limit of the samples, in multiples of those of a flat boundary: 4 were seen. Where it ended earlier, something
    // would be left of sheets.
    constexpr double kGrowth = 8.0;
    // What rounding off the outer boundary may leave of a sheet, which has no inside; in openings.
    constexpr double kMargin = 1.0 / 50.0;
    // Triangles are thickened by this (fraction of the diagonal) in no time, which tells how long smaller openings
    // take.
    constexpr double kFast = 1.0 / 128.0;
    if (const double fast = kFast * box_around(mesh.vertices).diagonal(); opening < fast) {
        check_opening(*thickened(mesh, fast, "opening", part_of(execution, 0.0, 0.0)), fast, opening, kTolerance);
    }
    const std::unique_ptr<Solid> thick = thickened(std::move(mesh), opening, "opening", part_of(execution, 0.0, 0.3));
    check_opening(*thick, opening, opening, kTolerance);
    SamplingOptions sampling = boundary_sampling(kTolerance * opening);
    sampling.facet_distance = kDistance * opening;
    sampling.growth_limit = kGrowth;
    const Samples samples = sample(*thick, sampling, part_of(execution, 0.3, 0.7));
    return shrunk(outer_parts(boundary_mesh(samples, part_of(execution, 0.7, 0.75)).mesh), (0.5 + kMargin) * opening,
                  part_of(execution, 0.75, 1.0));
}

/// The ball of a wrap gets inside through a hole if it reaches most of what the surface winds around when its holes are
/// closed. \param mesh cleaned \return what to say then
std::optional<Diagnostic> opening_of_hole(TriangleMesh mesh, const Solid& wrap, double opening,
                                          const Execution& execution) {
    // Random points of the bounding box, and how many of them say how much is reached.
    constexpr std::uint64_t kTries = 4000;
    constexpr std::size_t kEnough = 50;
    constexpr double kMost = 0.5;
    RepairedMesh closed = repair(std::move(mesh), part_of(execution, 0.0, 0.0));
    const std::vector<Hole> holes = closed.report.holes;
    if (!closed.report.fault.empty() || holes.empty() || holes.front().width <= opening) {
        return std::nullopt;
    }
    const std::unique_ptr<Solid> solid = mesh_solid(std::move(closed), part_of(execution, 0.0, 0.0));
    const Box box = solid->bounds();
    const Point size = box.max - box.min;
    std::vector<Point> points;
    for (std::uint64_t i = 0; i < kTries; ++i) {
        points.push_back(
            box.min + Point{size.x * random_unit(1, i), size.y * random_unit(1, i, 1), size.z * random_unit(1, i, 2)});
    }
    const std::vector<std::uint8_t> is_inside = sides_of(*solid, points);
    const std::vector<std::uint8_t> is_wrapped = sides_of(wrap, points);
    std::size_t inside = 0;
    std::size_t reached = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        inside += is_inside[i];
        reached += is_inside[i] != 0 && is_wrapped[i] == 0 ? 1 : 0;
    }
    if (inside < kEnough || static_cast<double>(reached) <= kMost * static_cast<double>(inside)) {
        return std::nullopt;
    }
    return Diagnostic{.code = "mesh.wrap_reached",
                      .message = "a ball of diameter " + to_text(opening) + " gets inside, through a hole as that at " +
                                 to_text(holes.front().place) + ", the widest, which is " +
                                 to_text(holes.front().width) + " across: take an opening as large as that",
                      .place = holes.front().place,
                      .hints = {{"opening", to_text(holes.front().width)}}};
}

/// The solids that distances from the triangles make.
SolidOfTriangles solid_by_distance(TriangleMesh mesh, const SolidOptions& options, const Execution& execution) {
    SolidOfTriangles result;
    MeshReport& report = result.report;
    in_arena(execution, [&] { clean(mesh, report); });
    if (report.fault.empty()) {
        report.fault = extent_fault(report.bounds, "vertices");
    }
    if (!report.fault.empty()) {
        return result;
    }
    const bool is_wrap = options.kind == SolidKind::kWrap;
    try {
        if (is_wrap) {
            std::unique_ptr<Solid> wrap = wrapped(mesh, options.opening, part_of(execution, 0.0, 0.95));
            if (const auto fault = opening_of_hole(mesh, *wrap, options.opening, execution)) {
                report.fault = *fault;
                return result;
            }
            result.solid = std::move(wrap);
            result.left_out = std::move(mesh);
        } else {
            result.solid = thickened(std::move(mesh), options.thickness, "thickness", execution);
        }
        report.kind = options.kind;
        report.reason = is_wrap ? "what a ball of diameter " + to_text(options.opening) + " cannot reach from outside"
                                : "all points within " + to_text(0.5 * options.thickness) + " of the triangles";
    } catch (const UnusableInput&) {
        report.fault = {"mesh.no_volume", is_wrap ? "no inside: a ball of diameter " + to_text(options.opening) +
                                                        " gets everywhere; take a larger opening"
                                                  : "no volume: take a larger thickness"};
    }
    return result;
}

}  // namespace

std::string_view name_of(SolidKind kind) {
    switch (kind) {
        case SolidKind::kWinding:
            return "winding";
        case SolidKind::kWrap:
            return "wrap";
        case SolidKind::kThicken:
            return "thicken";
        default:
            return "auto";
    }
}

void validate(const SolidOptions& options) {
    const auto check = [&](SolidKind kind, double length, const std::string& name, const std::string& its_kind) {
        require(options.kind == kind || length == 0.0,
                "the " + name + " has no effect: it is for the solid " + its_kind);
        require(options.kind != kind || (length > 0.0 && std::isfinite(length)),
                "the solid " + its_kind + " needs a positive length: the " + name);
    };
    check(SolidKind::kWrap, options.opening, "opening", "wrap");
    check(SolidKind::kThicken, options.thickness, "thickness", "thicken");
}

SolidOfTriangles solid_of_repaired(RepairedMesh repaired, const Execution& execution) {
    SolidOfTriangles result;
    result.report = repaired.report;
    if (result.report.fault.empty()) {
        result.mesh = repaired.mesh;
        result.left_out = std::move(repaired.left_out);
        result.solid = mesh_solid(std::move(repaired), execution);
    } else if (result.report.fault.code == "mesh.sheet") {
        result.solid = wound_around(std::move(repaired.mesh), execution);
        if (result.solid) {
            result.report.fault = {};
            result.report.kind = SolidKind::kWinding;
            result.report.reason = "pieces that do not meet: where their winding number exceeds 1/2";
        }
    }
    return result;
}

SolidOfTriangles solid_of_triangles(TriangleMesh mesh, const SolidOptions& options, const Execution& execution) {
    validate(options);
    if (options.kind == SolidKind::kWrap || options.kind == SolidKind::kThicken) {
        return solid_by_distance(std::move(mesh), options, execution);
    }
    return solid_of_repaired(repair(std::move(mesh), part_of(execution, 0.0, 0.7)), part_of(execution, 0.7, 1.0));
}

SolidOfTriangles solid_of_triangles(const MeshView& mesh, const SolidOptions& options, const Execution& execution) {
    return solid_of_triangles(
        TriangleMesh{{mesh.vertices.begin(), mesh.vertices.end()}, {mesh.triangles.begin(), mesh.triangles.end()}},
        options, execution);
}

}  // namespace scaleaxis::inline v1
