// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "balls/union/union_data.hpp"
#include "balls/visible_points.hpp"
#include "base/parallel.hpp"
#include "delaunay/power_diagram.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/solid.hpp"
#include "solid/pointwise_solid.hpp"
#include "solid/seeds.hpp"
#include "spatial/ball_tree.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// Asks about the balls in general position.
class UnionSolid final : public PointwiseSolid {
   public:
    explicit UnionSolid(const BallUnion& balls)
        : union_(balls),
          complex_(balls.data().complex()),
          adjacency_(balls.data().adjacency()),
          power_neighbors_(power_neighbors(complex_.dual.triangulation, complex_.balls.size())) {
        std::vector<Ball> visible;
        std::vector<Point> centers;
        for (const Index i : adjacency_.visible) {
            visible.push_back(complex_.balls[i]);
            centers.push_back(complex_.balls[i].center);
        }
        tree_ = build_ball_tree(visible);
        centers_ = build_point_tree(centers);
    }

    Box bounds() const override { return scaleaxis::bounds(complex_.balls); }

    bool is_inside(const Point& p) const override { return scaleaxis::covering_ball(tree_, p) != kNone; }

    std::optional<Point> crossing_of(const Point& inside_end, const Point& outside_end,
                                     const Point& reference) const override {
        const Index covering = covering_ball(inside_end);
        if (covering == kNone) {
            return std::nullopt;
        }
        const std::optional<Exits> exits =
            scaleaxis::exits(complex_.balls, power_neighbors_, adjacency_.neighbors, covering, inside_end, outside_end);
        if (!exits) {
            return std::nullopt;
        }
        // The distance from a point is a convex function along a line: it is largest at one of the ends.
        const Point direction = outside_end - inside_end;
        const Point first = inside_end + exits->first * direction;
        const Point last = inside_end + exits->last * direction;
        return squared_distance(first, reference) > squared_distance(last, reference) ? first : last;
    }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return in_arena(execution, [&] {
            const double area = spacing * spacing / kSeedsOfBalls;
            check_number_of_seeds(number_of_seeds(area, seed));
            std::vector<Point> points = visible_points(complex_, adjacency_, area, seed);
            // Every part of the boundary has vertices, but for those of one or two spheres. Where the balls are those
            // of a sampling as dense as the spacing, these are as many again.
            append(points, complex_.vertices.points);
            return points;
        });
    }

    std::optional<Topology> topology() const override { return complex_.dual.topology; }

    void prepare() const override {
        union_.data().boundary();
        union_.data().interior();
    }

    std::optional<Point> nearest_to(const Point& p, double bound) const override {
        // Near the medial axis many patches are about as near as the nearest one.
        const std::optional<NearBoundaryPoint> inner = nearest_from_inside(union_.data().interior(), p);
        const NearBoundaryPoint nearest = inner ? *inner : nearest_point(union_.data().boundary(), p, bound);
        return nearest.distance < bound ? std::optional(nearest.point) : std::nullopt;
    }

   private:
    /// A visible ball that contains `p`: the one with the nearest centre if it does, for that reaches far in all
    /// directions.
    Index covering_ball(const Point& p) const {
        const Index nearest = adjacency_.visible[centers_.order[nearest_point(centers_, p).position]];
        const auto& [center, radius] = complex_.balls[nearest];
        if (squared_distance(center, p) < radius * radius) {
            return nearest;
        }
        const Index covering = scaleaxis::covering_ball(tree_, p);
        return covering == kNone ? kNone : adjacency_.visible[covering];
    }

    /// How many seeds there will be, about: at most. The visible area takes time, and is asked for only where the whole
    /// area is too large.
    double number_of_seeds(double area, std::uint64_t seed) const {
        double most = 0.0;  // of the area, covered parts included
        for (const Index i : adjacency_.visible) {
            most += 4.0 * std::numbers::pi * complex_.balls[i].radius * complex_.balls[i].radius;
        }
        return most / area < std::numeric_limits<Index>::max() ? most / area
                                                               : visible_area(complex_, adjacency_, seed) / area;
    }

    BallUnion union_;  // owns what the next two refer to
    const UnionComplex& complex_;
    const UnionAdjacency& adjacency_;
    IndexLists power_neighbors_;  // of each ball: in the power diagram
    BallTree tree_;               // of the visible balls; the others add nothing to the union
    PointTree centers_;           // of the same
};

}  // namespace

std::unique_ptr<Solid> union_solid(const BallUnion& balls, const Execution& execution) {
    return in_arena(execution, [&] {
        report(execution, "union of balls", 0.0);
        std::unique_ptr<Solid> solid = std::make_unique<UnionSolid>(balls);
        report(execution, "union of balls", 1.0);
        return solid;
    });
}

std::unique_ptr<Solid> union_solid(std::vector<Ball> balls, const Execution& execution) {
    return union_solid(BallUnion(std::move(balls)), execution);
}

}  // namespace scaleaxis::inline v1
