// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/distance_solids.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "solid/mesh/fast_winding.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis {
namespace {

// The lattice on which a solid is looked for has cells at least this small, and at most, as parts of the diagonal.
constexpr double kCoarsest = 1.0 / 128.0;
constexpr double kFinest = 1.0 / 1024.0;

/// Triangles with what it takes to tell how far they are.
struct Surface {
    explicit Surface(TriangleMesh mesh) : bvh(build_bvh(std::move(mesh))), bounds(triangle_bounds(bvh)) {
        for (const Point& p : bvh.mesh.vertices) {
            box.extend(p);
        }
    }

    /// The distance, or `most` if that is less.
    double distance(const Point& p, double most) const {
        const NearTriangle nearest = nearest_triangle(bvh, bounds, p, most);
        return nearest.triangle == kNone ? most : std::sqrt(nearest.squared_distance);
    }

    Bvh bvh;
    TriangleBounds bounds;
    Box box;
};

Box widened(const Box& box, double by) { return {box.min - Point{by, by, by}, box.max + Point{by, by, by}}; }

/// The largest cells that show a solid of this thickness.
/// \throws InvalidOption if they are too small
double feature_of(double thickness, const Box& box, const std::string& name) {
    const double feature = std::min(0.5 * thickness, kCoarsest * box.diagonal());
    if (feature < kFinest * box.diagonal()) {
        throw InvalidOption("the " + name + " is too small for these triangles: take " +
                            to_text(2.0 * kFinest * box.diagonal() * 1.01) + " or more");
    }
    return feature;
}

/// The parts of a closed surface that no other part lies around.
TriangleMesh outer_parts(const TriangleMesh& mesh) {
    DisjointSets sets(mesh.vertices.size());
    for (const auto& [u, v, w] : mesh.triangles) {
        sets.join(u, v);
        sets.join(u, w);
    }
    // A cavity is oriented inward: its volume is negative.
    std::vector<double> volumes(mesh.vertices.size(), 0.0);
    for (const auto& [u, v, w] : mesh.triangles) {
        const Index part = sets.find(u);
        const Point& o = mesh.vertices[part];
        volumes[part] += dot(mesh.vertices[u] - o, cross(mesh.vertices[v] - o, mesh.vertices[w] - o));
    }
    TriangleMesh result{mesh.vertices, {}};
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        if (volumes[sets.find(triangle[0])] > 0.0) {
            result.triangles.push_back(triangle);
        }
    }
    return result;
}

/// Is the winding number clearly that of inside and outside on the two sides of most of the area? On those of a sheet
/// it is near ±1/2.
bool bounds_most(const TriangleMesh& mesh, const FastWinding& winding, double step) {
    constexpr std::size_t kTriangles = 2000;  // that are looked at
    const std::size_t stride = mesh.triangles.size() / kTriangles + 1;
    double all = 0.0;
    double clear = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += stride) {
        const auto& [u, v, w] = mesh.triangles[t];
        const Point& origin = mesh.vertices[u];
        const Point normal = cross(mesh.vertices[v] - origin, mesh.vertices[w] - origin);
        const double area = norm(normal);
        if (!(area > 0.0)) {
            continue;
        }
        const Point center = (1.0 / 3.0) * (origin + mesh.vertices[v] + mesh.vertices[w]);
        all += area;
        clear += winding(center + (step / area) * normal) < 0.25 && winding(center - (step / area) * normal) > 0.75
                     ? area
                     : 0.0;
    }
    return clear > 0.5 * all;
}

}  // namespace

std::unique_ptr<Solid> thickened(TriangleMesh mesh, double thickness, const Execution& execution) {
    const auto surface = std::make_shared<const Surface>(std::move(mesh));
    const double feature = feature_of(thickness, widened(surface->box, 0.5 * thickness), "thickness");
    return function_solid(
        [surface, thickness](const Point& p) { return surface->distance(p, thickness) - 0.5 * thickness; },
        {widened(surface->box, thickness), feature}, execution);
}

std::unique_ptr<Solid> wrapped(TriangleMesh mesh, double opening, const Execution& execution) {
    // The centres of balls that come from outside and touch the triangles lie on the outer boundary of the thickened
    // triangles. What is inside of it, and farther from it than the radius, is not reached.
    constexpr double kTolerance = 1.0 / 6.0;  // of the opening
    // Of the opening: what rounding off the outer boundary may leave of a sheet, which has no inside.
    constexpr double kMargin = 1.0 / 50.0;
    const std::unique_ptr<Solid> thick = thickened(std::move(mesh), opening, part_of(execution, 0.0, 0.3));
    const Samples samples = sample(*thick, boundary_sampling(kTolerance * opening, true), part_of(execution, 0.3, 0.7));
    const TriangleMesh outer = outer_parts(boundary_mesh(samples, part_of(execution, 0.7, 0.75)).mesh);
    const auto surface = std::make_shared<const Surface>(outer);
    const std::shared_ptr<const Solid> inside = mesh_solid(outer, part_of(execution, 0.75, 0.85));
    const double feature = feature_of(opening, surface->box, "opening");
    const double radius = 0.5 * opening;
    return function_solid(
        [surface, inside, radius](const Point& p) {
            const double distance = surface->distance(p, 2.0 * radius);
            return radius + kMargin * 2.0 * radius - (inside->inside(p) ? distance : -distance);
        },
        {surface->box, feature}, part_of(execution, 0.85, 1.0));
}

std::unique_ptr<Solid> wound_around(TriangleMesh mesh, const Execution& execution) {
    const auto surface = std::make_shared<const Surface>(std::move(mesh));
    const auto winding = std::make_shared<const FastWinding>(surface->bvh);
    const double most = surface->box.diagonal();
    if (!bounds_most(surface->bvh.mesh, *winding, 1e-6 * most)) {
        return nullptr;
    }
    // Times the distance the function is continuous, and near the triangles it is the signed distance.
    return function_solid(
        [surface, winding, most](const Point& p) { return (1.0 - 2.0 * (*winding)(p)) * surface->distance(p, most); },
        {widened(surface->box, 0.05 * most), kCoarsest * most}, execution);
}

}  // namespace scaleaxis
