// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/fast_winding.hpp"

#include "base/angles.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", 1983.
double solid_angle(const Point& a, const Point& b, const Point& c) {
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2.0 * signed_angle_of(below, dot(a, cross(b, c)));
}

SurfacePart part_of(const TriangleMesh& mesh, Index triangle) {
    const auto& [u, v, w] = mesh.triangles[triangle];
    const Point &a = mesh.vertices[u], &b = mesh.vertices[v], &c = mesh.vertices[w];
    SurfacePart part;
    part.normal = 0.5 * cross(b - a, c - a);
    part.area = norm(part.normal);
    part.moment = (part.area / 3.0) * (a + b + c);
    part.box = box_of_triangle(mesh, triangle);
    return part;
}

}  // namespace

FastWinding::FastWinding(const Bvh& bvh)
    : bvh_(bvh), dipoles_(bvh, [&](Index triangle) { return part_of(bvh.mesh, triangle); }) {}

double FastWinding::operator()(const Point& p) const {
    return dipoles_.winding_number(bvh_, p, [&](Index triangle) {
        const auto& [u, v, w] = bvh_.mesh.triangles[triangle];
        const std::vector<Point>& x = bvh_.mesh.vertices;
        return solid_angle(x[u] - p, x[v] - p, x[w] - p);
    });
}

}  // namespace scaleaxis::inline v1
