// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/fast_winding.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "base/angles.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Beyond this distance, in radii, triangles count as one: an error below 1e-2 near them, of 1e-3 on average.
constexpr double kFarRadii = 2.5;

constexpr double kFullSphere = 4.0 * std::numbers::pi;

/// A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", 1983.
double solid_angle(const Point& a, const Point& b, const Point& c) {
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2.0 * signed_angle_of(below, dot(a, cross(b, c)));
}

/// Sums over triangles.
struct Sums {
    double area = 0.0;
    Point moment;  ///< of the centroids, by area
    Point normal;
    Box box;

    void add(const Sums& other) {
        area += other.area;
        moment = moment + other.moment;
        normal = normal + other.normal;
        box.extend(other.box);
    }
};

Sums sums_of(const TriangleMesh& mesh, Index triangle) {
    const auto& [u, v, w] = mesh.triangles[triangle];
    const Point &a = mesh.vertices[u], &b = mesh.vertices[v], &c = mesh.vertices[w];
    Sums sums;
    sums.normal = 0.5 * cross(b - a, c - a);
    sums.area = norm(sums.normal);
    sums.moment = (sums.area / 3.0) * (a + b + c);
    for (const Point& p : {a, b, c}) {
        sums.box.extend(p);
    }
    return sums;
}

}  // namespace

FastWinding::FastWinding(const Bvh& bvh) : bvh_(bvh), dipoles_(bvh.nodes.size()) {
    std::vector<Sums> of_node(bvh.nodes.size());
    for (std::size_t n = bvh.nodes.size(); n-- > 0;) {  // children come after their parents
        const Bvh::Node& node = bvh.nodes[n];
        for (int k = 0; k < Bvh::kWidth; ++k) {
            Sums sums;
            for (Index t = node.first[k]; t < node.first[k] + node.count[k]; ++t) {
                sums.add(sums_of(bvh.mesh, t));
            }
            if (node.count[k] == 0 && node.first[k] > 0 && !(node.bounds[0][0][k] > node.bounds[1][0][k])) {
                sums = of_node[n + node.first[k]];
            }
            if (sums.box.is_empty()) {
                continue;
            }
            Dipole& dipole = dipoles_[n][k];
            dipole.area = sums.normal;
            dipole.center = sums.area > 0.0 ? (1.0 / sums.area) * sums.moment : midpoint(sums.box.min, sums.box.max);
            const Point& center = dipole.center;
            const Point farthest{std::max(center.x - sums.box.min.x, sums.box.max.x - center.x),
                                 std::max(center.y - sums.box.min.y, sums.box.max.y - center.y),
                                 std::max(center.z - sums.box.min.z, sums.box.max.z - center.z)};
            dipole.reach = kFarRadii * kFarRadii * squared_norm(farthest);
            of_node[n].add(sums);
        }
    }
}

double FastWinding::operator()(const Point& p) const { return below(0, p) / kFullSphere; }

double FastWinding::below(Index n, const Point& p) const {
    const Bvh::Node& node = bvh_.nodes[n];
    double angle = 0.0;
    for (int k = 0; k < Bvh::kWidth; ++k) {
        const Dipole& dipole = dipoles_[n][k];
        if (dipole.reach < 0.0) {
            continue;
        }
        const Point d = dipole.center - p;
        const double square = squared_norm(d);
        if (square > dipole.reach) {
            angle += dot(dipole.area, d) / (square * std::sqrt(square));
        } else if (node.count[k] > 0) {
            for (Index t = node.first[k]; t < node.first[k] + node.count[k]; ++t) {
                const auto& [u, v, w] = bvh_.mesh.triangles[t];
                const std::vector<Point>& x = bvh_.mesh.vertices;
                angle += solid_angle(x[u] - p, x[v] - p, x[w] - p);
            }
        } else {
            angle += below(n + node.first[k], p);
        }
    }
    return angle;
}

}  // namespace scaleaxis::inline v1
