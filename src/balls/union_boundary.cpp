// SPDX-License-Identifier: GPL-3.0-or-later
#include "medial_axis/union_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/parallel.hpp"
#include "medial_axis/dual_complex.hpp"
#include "medial_axis/exposed.hpp"
#include "medial_axis/inner_voronoi.hpp"

namespace scaleaxis {
namespace {

constexpr std::array<Point, 6> kAxisDirections{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

void extend(Box& box, const Point& center, double radius) {
    const Point r{radius, radius, radius};
    box.extend(center - r);
    box.extend(center + r);
}

// A box around the exposed part of the circle with a neighbor, on which `ends` lie; empty if there is none.
Box box_of_arcs(const UnionBoundary& boundary, Index ball, Index neighbor, std::span<const Point> ends) {
    const Circle circle(boundary.balls[ball], boundary.balls[neighbor]);
    Box box;
    if (ends.size() == 2) {
        const Point middle = midpoint(ends[0], ends[1]);
        if (is_exposed(boundary.balls, boundary.neighbors, ball, neighbor, circle.toward(middle - circle.center))) {
            // The arc is less than half of the circle, and nowhere farther from its chord than in its middle.
            const double height =
                circle.radius -
                std::sqrt(std::max(0.0, circle.radius * circle.radius - 0.25 * squared_distance(ends[0], ends[1])));
            extend(box, ends[0], height);
            extend(box, ends[1], height);
            return box;
        }
    }
    if (!ends.empty() || is_exposed(boundary.balls, boundary.neighbors, ball, neighbor, circle.toward({1, 0, 0}))) {
        extend(box, circle.center, circle.radius);
    }
    return box;
}

// A patch with what is looked for with it.
struct FoundPatch {
    Box box;
    std::vector<Index> arcs;
    std::vector<Index> ends;
};

FoundPatch find_patch(const UnionBoundary& boundary, const std::vector<std::array<Index, 3>>& names,
                      const IndexLists& ball_vertices, Index ball) {
    FoundPatch patch;
    const auto& [center, radius] = boundary.balls[ball];
    for (const Point& direction : kAxisDirections) {
        const Point p = center + radius * direction;
        if (is_exposed(boundary.balls, boundary.neighbors, ball, kNone, p)) {
            patch.box.extend(p);
        }
    }
    for (const Index v : ball_vertices[ball]) {
        patch.box.extend(boundary.vertices[v]);
        if (names[v][0] == ball) {
            patch.ends.push_back(v);
        }
    }
    std::vector<Point> ends;
    for (const Index neighbor : boundary.neighbors[ball]) {
        ends.clear();
        for (const Index v : ball_vertices[ball]) {
            if (std::find(names[v].begin(), names[v].end(), neighbor) != names[v].end()) {
                ends.push_back(boundary.vertices[v]);
            }
        }
        const Box box = box_of_arcs(boundary, ball, neighbor, ends);
        if (!box.is_empty()) {
            patch.box.extend(box.min);
            patch.box.extend(box.max);
            if (ball < neighbor) {
                patch.arcs.push_back(neighbor);
            }
        }
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

// The distance from `p` to a patch, its arcs and its vertices, if that is less than `best`.
double distance_to_patch(const UnionBoundary& boundary, Index patch, const Point& p, double best) {
    const auto& [ball, box] = boundary.patches[patch];
    const auto& [center, radius] = boundary.balls[ball];
    if (squared_bound({center, radius}, box, p) > (1.0 + kRounding) * best * best) {
        return best;
    }
    for (const Index v : boundary.ends[patch]) {
        best = std::min(best, distance(p, boundary.vertices[v]));
    }
    const Point from_center = p - center;
    const double length = norm(from_center);
    const Point outward = length > 0.0 ? (1.0 / length) * from_center : Point{1, 0, 0};
    if (std::abs(radius - length) < best &&
        is_exposed(boundary.balls, boundary.neighbors, ball, kNone, center + radius * outward)) {
        best = std::abs(radius - length);
    }
    for (const Index neighbor : boundary.arcs[patch]) {
        const Circle circle(boundary.balls[ball], boundary.balls[neighbor]);
        const Point nearest = circle.toward(p - circle.center);
        const double there = distance(p, nearest);
        if (there < best && is_exposed(boundary.balls, boundary.neighbors, ball, neighbor, nearest)) {
            best = there;
        }
    }
    return best;
}

}  // namespace

UnionBoundary union_boundary(std::vector<Ball> balls) {
    const DualComplex complex = dual_complex(balls);
    BoundaryVertices vertices = boundary_vertices(complex, balls);
    const std::vector<std::array<Index, 3>>& names = vertices.balls;
    const IndexLists ball_vertices = vertices_of_balls(vertices, balls.size());
    UnionBoundary boundary;
    boundary.balls = std::move(balls);
    boundary.vertices = std::move(vertices.points);
    boundary.neighbors = neighbors_of_balls(complex, boundary.balls.size());

    const std::vector<Index> visible = visible_balls(complex, boundary.neighbors);
    std::vector<FoundPatch> found(visible.size());
    kernel::for_each_index(visible.size(),
                           [&](std::size_t i) { found[i] = find_patch(boundary, names, ball_vertices, visible[i]); });
    std::vector<Index> with_patch;
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!found[i].box.is_empty()) {
            with_patch.push_back(static_cast<Index>(i));
            boxes.push_back(found[i].box);
        }
    }
    boundary.tree = kernel::build_box_tree(boxes);
    for (const Index item : boundary.tree.order) {
        const Index i = with_patch[item];
        boundary.patches.push_back({visible[i], found[i].box});
        boundary.arcs.push_back(found[i].arcs);
        boundary.ends.push_back(found[i].ends);
    }
    return boundary;
}

double distance_to(const UnionBoundary& boundary, const Point& p) {
    const kernel::BoxTree& tree = boundary.tree;
    const kernel::FramedPoint framed(tree, p);
    const auto bound = [&](const kernel::BoxTree::Node& node) {
        const kernel::Float4 square = kernel::squared_distances(node, framed);
        const kernel::Float4 distance = {std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]),
                                         std::sqrt(square[3])};
        return distance - framed.slack;
    };
    double nearest = std::numeric_limits<double>::infinity();
    const auto in_frame = [&](double distance) {
        return static_cast<float>(distance * tree.scale) +
               kernel::BoxTree::kPadding * static_cast<float>(1.0 + distance * tree.scale);
    };
    float best = std::numeric_limits<float>::infinity();
    kernel::for_each_better_leaf(tree, bound, best, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            nearest = distance_to_patch(boundary, i, p, nearest);
        }
        best = in_frame(nearest);
    });
    return nearest;
}

}  // namespace scaleaxis
