// SPDX-License-Identifier: Apache-2.0
#include "balls/union/union_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "balls/exposed.hpp"
#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::array<Point, 6> kAxisDirections{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

// So much larger than the patches are their boxes, relative to the radius: of balls that are almost the same, rounding
// moves vertices by more than their arithmetic shows.
constexpr double kBoxMargin = 1e-6;

// A box around the exposed part of the circle with a neighbor, on which `ends` lie; empty if there is none. It reaches
// farthest along an axis at an end, or where the circle does.
Box box_of_arcs(const UnionBoundary& boundary, Index ball, Index neighbor, std::span<const Point> ends) {
    const Circle circle(boundary.complex.balls[ball], boundary.complex.balls[neighbor]);
    Box box;
    for (const Point& end : ends) {
        box.extend(end);
    }
    for (const Point& direction : kAxisDirections) {
        const Point p = circle.toward(direction);
        if (!box.contains(p) && is_exposed(boundary.complex.balls, boundary.adjacency.neighbors, ball, neighbor, p)) {
            box.extend(p);
        }
    }
    return box;
}

// A patch with what is looked for with it.
struct FoundPatch {
    Box box;
    std::vector<Index> arcs;
    std::vector<Index> ends;
};

FoundPatch find_patch(const UnionBoundary& boundary, Index ball) {
    const std::vector<std::array<Index, 3>>& names = boundary.complex.vertices.balls;
    const std::span<const Index> vertices = boundary.adjacency.vertices[ball];
    FoundPatch patch;
    const auto& [center, radius] = boundary.complex.balls[ball];
    for (const Point& direction : kAxisDirections) {
        const Point p = center + radius * direction;
        if (is_exposed(boundary.complex.balls, boundary.adjacency.neighbors, ball, kNone, p)) {
            patch.box.extend(p);
        }
    }
    for (const Index v : vertices) {
        patch.box.extend(boundary.complex.vertices.points[v]);
        if (names[v][0] == ball) {
            patch.ends.push_back(v);
        }
    }
    std::vector<Point> ends;
    for (const Index neighbor : boundary.adjacency.neighbors[ball]) {
        ends.clear();
        for (const Index v : vertices) {
            if (std::find(names[v].begin(), names[v].end(), neighbor) != names[v].end()) {
                ends.push_back(boundary.complex.vertices.points[v]);
            }
        }
        const Box box = box_of_arcs(boundary, ball, neighbor, ends);
        if (!box.is_empty()) {
            patch.box.extend(box);
            if (ball < neighbor) {
                patch.arcs.push_back(neighbor);
            }
        }
    }
    if (!patch.box.is_empty()) {
        const Point margin{kBoxMargin * radius, kBoxMargin * radius, kBoxMargin * radius};
        patch.box = {patch.box.min - margin, patch.box.max + margin};
    }
    return patch;
}

// A lower bound for the squared distance from `p` to a patch: |y - p|² = r² + |p - c|² - 2 (y - c) (p - c) for a point
// y of the sphere around c, and the linear term is largest in a corner of the patch's box.
double squared_bound(const Ball& ball, const Box& box, const Point& p) {
    const Point d = p - ball.center;
    const auto larger = [](double low, double high, double center, double slope) {
        return std::max((low - center) * slope, (high - center) * slope);
    };
    return ball.radius * ball.radius + squared_norm(d) -
           2.0 * (larger(box.min.x, box.max.x, ball.center.x, d.x) + larger(box.min.y, box.max.y, ball.center.y, d.y) +
                  larger(box.min.z, box.max.z, ball.center.z, d.z));
}

// Is no point of the patch of a ball within `most` of `p`, for a neighbor covers that part of the sphere? The
// difference of the powers of both balls is linear, and not positive in the patch but for what `is_exposed` leaves to
// rounding.
bool is_far_behind_neighbor(const UnionBoundary& boundary, Index ball, const Point& p, double most) {
    const auto& [center, radius] = boundary.complex.balls[ball];
    const Point d = p - center;
    const double rounding = 2.0 * kRounding * squared_norm(d);
    const std::span<const Index> neighbors = boundary.adjacency.neighbors[ball];
    return std::ranges::any_of(neighbors, [&, radius = radius, center = center](Index k) {
        const auto& [other, other_radius] = boundary.complex.balls[k];
        const Point along = other - center;
        const double square = squared_norm(along);
        const double beyond = 2.0 * dot(d, along) - square - (radius - other_radius) * (radius + other_radius) -
                              2.0 * kRounding * (radius * radius + other_radius * other_radius) - rounding;
        return beyond > 0.0 && beyond * beyond > 4.0 * (1.0 + kRounding) * square * most * most;
    });
}

// Puts the nearest point of a patch, its arcs and its vertices in the place of `best` if that is farther.
void try_patch(const UnionBoundary& boundary, Index patch, const Point& p, NearBoundaryPoint& best) {
    const auto& [ball, box] = boundary.patches[patch];
    const auto& [center, radius] = boundary.complex.balls[ball];
    if (squared_bound({center, radius}, box, p) > (1.0 + kRounding) * best.distance * best.distance) {
        return;
    }
    for (const Index v : boundary.ends[patch]) {
        const Point& vertex = boundary.complex.vertices.points[v];
        if (const double there = distance(p, vertex); there < best.distance) {
            best = {vertex, there};
        }
    }
    if (is_far_behind_neighbor(boundary, ball, p, best.distance)) {
        return;
    }
    const Point from_center = p - center;
    const double length = norm(from_center);
    const Point outward = length > 0.0 ? (1.0 / length) * from_center : Point{1, 0, 0};
    const Point on_sphere = center + radius * outward;
    if (std::abs(radius - length) < best.distance &&
        is_exposed(boundary.complex.balls, boundary.adjacency.neighbors, ball, kNone, on_sphere)) {
        best = {on_sphere, std::abs(radius - length)};
    }
    for (const Index neighbor : boundary.arcs[patch]) {
        const Circle circle(boundary.complex.balls[ball], boundary.complex.balls[neighbor]);
        const Point nearest = circle.toward(p - circle.center);
        const double there = distance(p, nearest);
        if (there < best.distance &&
            is_exposed(boundary.complex.balls, boundary.adjacency.neighbors, ball, neighbor, nearest)) {
            best = {nearest, there};
        }
    }
}

}  // namespace

UnionBoundary union_boundary(const UnionComplex& complex, const UnionAdjacency& adjacency) {
    UnionBoundary boundary{complex, adjacency, {}, {}, {}, {}};
    const std::vector<Index>& visible = adjacency.visible;
    const auto found =
        mapped<FoundPatch>(visible.size(), [&](std::size_t i) { return find_patch(boundary, visible[i]); });
    std::vector<Index> with_patch;
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!found[i].box.is_empty()) {
            with_patch.push_back(static_cast<Index>(i));
            boxes.push_back(found[i].box);
        }
    }
    boundary.tree = build_box_tree(boxes);
    stop_if_cancelled();
    for (const Index item : boundary.tree.order) {
        const Index i = with_patch[item];
        boundary.patches.push_back({visible[i], found[i].box});
        boundary.arcs.push_back(found[i].arcs);
        boundary.ends.push_back(found[i].ends);
    }
    return boundary;
}

NearBoundaryPoint nearest_point(const UnionBoundary& boundary, const Point& p, double bound) {
    const BoxTree& tree = boundary.tree;
    const FramedPoint framed(tree, p);
    const auto least_distances = [&](const BoxTree::Node& node) {
        const Float4 square = squared_distances(node, framed);
        const Float4 distance = {std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]),
                                 std::sqrt(square[3])};
        return distance - framed.slack;
    };
    NearBoundaryPoint nearest{{}, bound};
    const auto in_frame = [&](double distance) {
        return static_cast<float>(distance * tree.scale) +
               BoxTree::kPadding * static_cast<float>(1.0 + distance * tree.scale);
    };
    float best = in_frame(bound);
    for_each_better_leaf(tree, least_distances, best, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            try_patch(boundary, i, p, nearest);
        }
        best = in_frame(nearest.distance);
    });
    return nearest.distance < bound ? nearest : NearBoundaryPoint{};
}

}  // namespace scaleaxis::inline v1
