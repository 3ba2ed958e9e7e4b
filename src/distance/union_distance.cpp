// SPDX-License-Identifier: GPL-3.0-or-later
#include "distance/union_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/parallel.hpp"
#include "medial_axis/dual_complex.hpp"
#include "medial_axis/inner_voronoi.hpp"

namespace scaleaxis {
namespace {

using Circle = UnionBoundary::Circle;

Circle circle_of(std::span<const Ball> balls, const std::array<Index, 2>& pair) {
    const auto& [center, radius] = balls[pair[0]];
    const auto& [other_center, other_radius] = balls[pair[1]];
    const Point direction = other_center - center;
    const double length = norm(direction);
    const double along = (radius * radius - other_radius * other_radius + length * length) / (2.0 * length);
    const Point normal = (1.0 / length) * direction;
    return {center + along * normal, normal, std::sqrt(std::max(0.0, radius * radius - along * along)), pair};
}

/// Pairs of balls whose spheres meet in a circle that is partly visible: circles end in vertices, or are whole.
std::vector<std::array<Index, 2>> pairs_with_arcs(const DualComplex& complex, const BoundaryVertices& vertices) {
    std::vector<std::array<Index, 2>> pairs = complex.singular_edges;
    for (auto& [p, q] : pairs) {
        if (p > q) {
            std::swap(p, q);
        }
    }
    for (const auto& [p, q, r] : vertices.balls) {  // ascending
        pairs.insert(pairs.end(), {{p, q}, {q, r}, {p, r}});
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

Box box_of(const Point& p) { return {p, p}; }

Box box_of(const Circle& circle) {
    const auto extent = [&](double normal) { return circle.radius * std::sqrt(std::max(0.0, 1.0 - normal * normal)); };
    const Point half{extent(circle.normal.x), extent(circle.normal.y), extent(circle.normal.z)};
    return {circle.center - half, circle.center + half};
}

/// A tree over the items, which come into the order of its leaves.
template <class Item>
kernel::BoxTree build_tree(std::vector<Item>& items) {
    if (items.empty()) {
        return {};
    }
    std::vector<Box> boxes(items.size());
    std::transform(items.begin(), items.end(), boxes.begin(), [](const Item& item) { return box_of(item); });
    kernel::BoxTree tree = kernel::build_box_tree(boxes);
    std::vector<Item> ordered(items.size());
    std::transform(tree.order.begin(), tree.order.end(), ordered.begin(), [&](Index i) { return items[i]; });
    items = std::move(ordered);
    return tree;
}

Point nearest_on(const Point& vertex, const Point&) { return vertex; }

Point nearest_on(const Circle& circle, const Point& p) {
    const Point from_center = p - circle.center;
    const Point radial = from_center - dot(from_center, circle.normal) * circle.normal;
    const double length = norm(radial);
    if (length > 1e-12 * circle.radius) {
        return circle.center + (circle.radius / length) * radial;
    }
    // All are equally near. One that is not visible is no loss: then the arcs end in vertices as near.
    const Point& n = circle.normal;
    const Point across = cross(n, std::abs(n.x) < 0.5 ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0});
    return circle.center + (circle.radius / norm(across)) * across;
}

/// The search for the nearest point of the boundary.
class Search {
   public:
    Search(const UnionBoundary& boundary, const Point& p) : boundary_(boundary), p_(p) {}

    void try_vertices() {
        try_all(
            boundary_.vertex_tree, boundary_.vertices, [](const Point&) { return std::span<const Index>(); }, false);
    }

    void try_circles() {
        try_all(
            boundary_.circle_tree, boundary_.circles, [](const Circle& c) { return std::span(c.balls); }, true);
    }

    void try_spheres() {
        const kernel::BallTree& tree = boundary_.balls;
        float best = in_frame(tree);
        kernel::for_each_near_sphere(tree, {tree, p_}, best, [&](Index first, Index count) {
            for (Index i = first; i < first + count; ++i) {
                const auto& [center, radius] = tree.balls[i];
                const Point from_center = p_ - center;
                const double length = norm(from_center);
                const Point direction = length > 0.0 ? (1.0 / length) * from_center : Point{1.0, 0.0, 0.0};
                offer(center + radius * direction, std::span(&tree.order[i], 1));
            }
            best = in_frame(tree);
        });
    }

    double nearest() const { return nearest_; }

   private:
    float in_frame(const kernel::BoxTree& tree) const {
        return static_cast<float>(nearest_ * tree.scale) * (1.0F + kernel::BoxTree::kPadding) +
               kernel::BoxTree::kPadding;
    }

    /// A point that lies on some spheres is one of the boundary if no other ball covers it.
    void offer(const Point& x, std::span<const Index> on) {
        const double distance = scaleaxis::distance(p_, x);
        if (distance < nearest_ && kernel::covering_ball(boundary_.balls, x, on) == kNone) {
            nearest_ = distance;
        }
    }

    template <class Item, class Balls>
    void try_all(const kernel::BoxTree& tree, const std::vector<Item>& items, const Balls& balls, bool may_be_covered) {
        if (items.empty()) {
            return;
        }
        const kernel::FramedPoint framed(tree, p_);
        const auto bound = [&](const kernel::BoxTree::Node& node) { return kernel::squared_distances(node, framed); };
        const auto squared_best = [&] {
            const float best = in_frame(tree) + framed.slack;
            return best * best;
        };
        float best = squared_best();
        kernel::for_each_better_leaf(tree, bound, best, [&](Index first, Index count) {
            for (Index i = first; i < first + count; ++i) {
                const Point x = nearest_on(items[i], p_);
                if (may_be_covered) {
                    offer(x, balls(items[i]));
                } else {
                    nearest_ = std::min(nearest_, scaleaxis::distance(p_, x));
                }
            }
            best = squared_best();
        });
    }

    const UnionBoundary& boundary_;
    Point p_;
    double nearest_ = std::numeric_limits<double>::infinity();
};

}  // namespace

UnionBoundary union_boundary(std::span<const Ball> balls) {
    const DualComplex complex = dual_complex(balls);
    BoundaryVertices vertices = boundary_vertices(complex, balls);
    UnionBoundary boundary;
    for (const std::array<Index, 2>& pair : pairs_with_arcs(complex, vertices)) {
        boundary.circles.push_back(circle_of(balls, pair));
    }
    boundary.balls = kernel::build_ball_tree(balls);
    boundary.circle_tree = build_tree(boundary.circles);
    boundary.vertices = std::move(vertices.points);
    boundary.vertex_tree = build_tree(boundary.vertices);
    return boundary;
}

double distance_to_boundary(const UnionBoundary& boundary, const Point& p) {
    const double signed_distance = kernel::nearest_ball(boundary.balls, p).distance;
    if (signed_distance >= 0.0) {
        return signed_distance;
    }
    // From inside, creases and vertices are mostly nearer than spheres, and cheaper to find.
    Search search(boundary, p);
    search.try_vertices();
    search.try_circles();
    search.try_spheres();
    return search.nearest();
}

}  // namespace scaleaxis
