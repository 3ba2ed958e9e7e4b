// SPDX-License-Identifier: Apache-2.0
#include "surface/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scaleaxis {
namespace {

Point nearest_on_segment(const Point& a, const Point& b, const Point& p) {
    const Point d = b - a;
    const double square = squared_norm(d);
    return square > 0.0 ? a + std::clamp(dot(p - a, d) / square, 0.0, 1.0) * d : a;
}

}  // namespace

Point nearest_point(const Point& a, const Point& b, const Point& c, const Point& p) {
    const Point u = b - a;
    const Point v = c - a;
    const Point normal = cross(u, v);
    const double square = squared_norm(normal);
    if (square > 0.0) {
        const Point w = p - a;
        const double at_b = dot(cross(w, v), normal) / square;
        const double at_c = dot(cross(u, w), normal) / square;
        if (at_b >= 0.0 && at_c >= 0.0 && at_b + at_c <= 1.0) {
            return a + at_b * u + at_c * v;
        }
    }
    const Point candidates[]{nearest_on_segment(a, b, p), nearest_on_segment(b, c, p), nearest_on_segment(c, a, p)};
    return *std::min_element(std::begin(candidates), std::end(candidates), [&](const Point& x, const Point& y) {
        return squared_distance(x, p) < squared_distance(y, p);
    });
}

double distance_to_mesh(const Bvh& bvh, const Point& p) {
    const FramedPoint framed(bvh, p);
    // Squared, in the frame: the slack makes up for rounding.
    const auto bound = [&](const Bvh::Node& node) { return squared_distances(node, framed); };
    double nearest = std::numeric_limits<double>::infinity();
    float best = std::numeric_limits<float>::infinity();
    for_each_better_leaf(bvh, bound, best, [&](Index first, Index count) {
        for (Index t = first; t < first + count; ++t) {
            const auto& [u, v, w] = bvh.mesh.triangles[t];
            const std::vector<Point>& x = bvh.mesh.vertices;
            nearest = std::min(nearest, squared_distance(p, nearest_point(x[u], x[v], x[w], p)));
        }
        const float reach = static_cast<float>(std::sqrt(nearest) * bvh.scale) * (1.0F + Bvh::kPadding) + framed.slack;
        best = reach * reach;
    });
    return std::sqrt(nearest);
}

}  // namespace scaleaxis
