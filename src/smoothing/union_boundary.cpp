// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/union_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "kernel/parallel.hpp"

namespace scaleaxis {
namespace {

// Points on a sphere are taken for covered only if they lie deeper in another ball than rounding can tell, relative to
// its squared radius.
constexpr double kRounding = 1e-12;

IndexLists lists_of(std::size_t lists, std::span<const std::pair<Index, Index>> entries) {
    IndexLists result;
    result.offsets.assign(lists + 1, 0);
    for (const auto& [list, item] : entries) {
        ++result.offsets[list + 1];
    }
    std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
    result.items.resize(entries.size());
    std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
    for (const auto& [list, item] : entries) {
        result.items[next[list]++] = item;
    }
    return result;
}

// Where two spheres meet.
struct Circle {
    Point center;
    Point normal;
    double radius;

    Circle(const Ball& a, const Ball& b) {
        const Point along = b.center - a.center;
        const double length = norm(along);
        normal = (1.0 / length) * along;
        const double position = 0.5 * (length + (a.radius - b.radius) * (a.radius + b.radius) / length);
        center = a.center + position * normal;
        radius = std::sqrt(std::max(0.0, a.radius * a.radius - position * position));
    }

    // The point of the circle in a direction, which need not lie in its plane.
    Point toward(const Point& direction) const {
        const Point in_plane = direction - dot(direction, normal) * normal;
        const double length = norm(in_plane);
        if (length > 0.0) {
            return center + (radius / length) * in_plane;
        }
        // All of the circle is as near; which point does not matter.
        const Point any = std::abs(normal.x) < 0.5 ? Point{1, 0, 0} : Point{0, 1, 0};
        return toward(any);
    }
};

constexpr std::array<Point, 6> kAxisDirections{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

// Is a point on the sphere of a ball (and perhaps on that of one neighbor) covered by no neighbor? Of all balls it is
// enough to ask the neighbors in the dual complex: the way from the ball's own part of the power diagram to a point
// that another ball covers leads, within the ball, into the part of a neighbor that covers the point too.
bool is_exposed(const UnionBoundary& boundary, Index ball, Index other, const Point& p) {
    const std::span<const Index> neighbors = boundary.neighbors[ball];
    return std::none_of(neighbors.begin(), neighbors.end(), [&](Index k) {
        const auto& [center, radius] = boundary.balls[k];
        return k != other && squared_distance(p, center) < (1.0 - kRounding) * radius * radius;
    });
}

void extend(Box& box, const Point& center, double radius) {
    const Point r{radius, radius, radius};
    box.extend(center - r);
    box.extend(center + r);
}

// A box around the exposed part of the circle with a neighbor, if there is any.
void extend_by_arcs(Box& box, const UnionBoundary& boundary, Index ball, Index neighbor, std::span<const Point> ends) {
    const Circle circle(boundary.balls[ball], boundary.balls[neighbor]);
    if (ends.size() == 2) {
        const Point middle = midpoint(ends[0], ends[1]);
        if (is_exposed(boundary, ball, neighbor, circle.toward(middle - circle.center))) {
            extend(box, middle, 0.5 * distance(ends[0], ends[1]));
            return;
        }
    } else if (ends.empty() && !is_exposed(boundary, ball, neighbor, circle.toward({1, 0, 0}))) {
        return;
    }
    extend(box, circle.center, circle.radius);
}

Box box_of_patch(const UnionBoundary& boundary, const std::vector<std::array<Index, 3>>& names, Index ball) {
    Box box;
    const auto& [center, radius] = boundary.balls[ball];
    for (const Point& direction : kAxisDirections) {
        const Point p = center + radius * direction;
        if (is_exposed(boundary, ball, kNone, p)) {
            box.extend(p);
        }
    }
    for (const Index v : boundary.vertices_of_balls[ball]) {
        box.extend(boundary.vertices[v]);
    }
    std::vector<Point> ends;
    for (const Index neighbor : boundary.neighbors[ball]) {
        ends.clear();
        for (const Index v : boundary.vertices_of_balls[ball]) {
            if (std::find(names[v].begin(), names[v].end(), neighbor) != names[v].end()) {
                ends.push_back(boundary.vertices[v]);
            }
        }
        extend_by_arcs(box, boundary, ball, neighbor, ends);
    }
    return box;
}

// The distance from `p` to the patch of a ball, if it is less than `best`.
double distance_to_patch(const UnionBoundary& boundary, Index ball, const Point& p, double best) {
    for (const Index v : boundary.vertices_of_balls[ball]) {
        best = std::min(best, distance(p, boundary.vertices[v]));
    }
    const auto& [center, radius] = boundary.balls[ball];
    const Point from_center = p - center;
    const double length = norm(from_center);
    const Point outward = length > 0.0 ? (1.0 / length) * from_center : Point{1, 0, 0};
    if (std::abs(radius - length) < best && is_exposed(boundary, ball, kNone, center + radius * outward)) {
        best = std::abs(radius - length);
    }
    for (const Index neighbor : boundary.neighbors[ball]) {
        const Circle circle(boundary.balls[ball], boundary.balls[neighbor]);
        const Point nearest = circle.toward(p - circle.center);
        const double there = distance(p, nearest);
        if (there < best && is_exposed(boundary, ball, neighbor, nearest)) {
            best = there;
        }
    }
    return best;
}

}  // namespace

UnionBoundary union_boundary(const MedialAxis& axis) {
    UnionBoundary boundary;
    boundary.balls = axis.balls;
    boundary.vertices = axis.complex.boundary_vertices;
    std::vector<std::pair<Index, Index>> entries;
    for (const auto& [a, b] : axis.dual_edges) {
        entries.emplace_back(a, b);
        entries.emplace_back(b, a);
    }
    boundary.neighbors = lists_of(boundary.balls.size(), entries);
    entries.clear();
    const std::vector<std::array<Index, 3>>& names = axis.complex.boundary_vertex_balls;
    for (Index v = 0; v < static_cast<Index>(names.size()); ++v) {
        for (const Index ball : names[v]) {
            entries.emplace_back(ball, v);
        }
    }
    boundary.vertices_of_balls = lists_of(boundary.balls.size(), entries);

    std::vector<Box> boxes(boundary.balls.size());
    kernel::for_each_index(static_cast<Index>(boxes.size()), [&](Index ball) {
        if (!boundary.neighbors[ball].empty()) {
            boxes[ball] = box_of_patch(boundary, names, ball);
        }
    });
    for (const Index ball : axis.isolated_balls) {
        boxes[ball] = box_of_patch(boundary, names, ball);
    }
    std::vector<Box> patch_boxes;
    for (Index ball = 0; ball < static_cast<Index>(boxes.size()); ++ball) {
        if (!boxes[ball].is_empty()) {
            boundary.patches.push_back(ball);
            patch_boxes.push_back(boxes[ball]);
        }
    }
    boundary.tree = kernel::build_box_tree(patch_boxes);
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
    float best = std::numeric_limits<float>::infinity();
    kernel::for_each_better_leaf(tree, bound, best, [&](Index first, Index count) {
        for (Index i = first; i < first + count; ++i) {
            nearest = distance_to_patch(boundary, boundary.patches[tree.order[i]], p, nearest);
        }
        best = static_cast<float>(nearest * tree.scale) +
               kernel::BoxTree::kPadding * static_cast<float>(1.0 + nearest * tree.scale);
    });
    return nearest;
}

}  // namespace scaleaxis
