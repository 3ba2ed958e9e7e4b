// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/distance_solids.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/mesh.hpp"
#include "solid/mesh/fast_winding.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {
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
/// \throws InvalidOption if they are too small, or the box is not finite
double feature_of(double thickness, const Box& box, const std::string& name) {
    require(std::isfinite(box.diagonal()), "the " + name + " is too large to compute with");
    const double feature = std::min(0.5 * thickness, kCoarsest * box.diagonal());
    require(feature >= kFinest * box.diagonal(), "the " + name + " is too small for these triangles: take " +
                                                     to_text(2.0 * kFinest * box.diagonal() * 1.01) + " or more");
    return feature;
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

std::unique_ptr<Solid> thickened(TriangleMesh mesh, double thickness, const std::string& name,
                                 const Execution& execution) {
    const auto surface = std::make_shared<const Surface>(std::move(mesh));
    const double feature = feature_of(thickness, widened(surface->box, 0.5 * thickness), name);
    return function_solid(
        [surface, thickness](const Point& p) { return surface->distance(p, thickness) - 0.5 * thickness; },
        {.bounds = widened(surface->box, thickness), .smallest_feature = feature, .is_distance = true}, execution);
}

std::unique_ptr<Solid> shrunk(TriangleMesh mesh, double by, const Execution& execution) {
    const auto surface = std::make_shared<const Surface>(mesh);
    const std::shared_ptr<const Solid> inside = mesh_solid(std::move(mesh), part_of(execution, 0.0, 0.3));
    const double feature = feature_of(2.0 * by, surface->box, "opening");
    return function_solid(
        [surface, inside, by](const Point& p) {
            const double distance = surface->distance(p, 4.0 * by);
            return by - (inside->inside(p) ? distance : -distance);
        },
        {.bounds = surface->box, .smallest_feature = feature, .is_distance = true}, part_of(execution, 0.3, 1.0));
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

}  // namespace scaleaxis::inline v1
