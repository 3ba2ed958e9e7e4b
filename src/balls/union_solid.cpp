// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "balls/general_position.hpp"
#include "kernel/ball_tree.hpp"
#include "kernel/parallel.hpp"
#include "kernel/point_tree.hpp"
#include "kernel/power_diagram.hpp"
#include "medial_axis/dual_complex.hpp"
#include "medial_axis/inner_voronoi.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/shape.hpp"
#include "shapes/visible_spheres.hpp"

namespace scaleaxis {
namespace {

// Candidates for each square of the spacing. The vertices of the boundary come on top: where the balls are those of a
// sampling as dense as the spacing, these are as many again.
constexpr double kSeedsPerSquare = 6.0;

VisibleSpheres visible_spheres(std::vector<Ball> balls, const DualComplex& complex) {
    BoundaryVertices vertices = boundary_vertices(complex, balls);
    VisibleSpheres spheres;
    spheres.neighbors = neighbors_of_balls(complex, balls.size());
    spheres.visible = visible_balls(complex, spheres.neighbors);
    spheres.ball_vertices = vertices_of_balls(vertices, balls.size());
    spheres.vertices = std::move(vertices.points);
    spheres.vertex_balls = std::move(vertices.balls);
    spheres.balls = std::move(balls);
    return spheres;
}

class UnionOfBalls final : public Shape {
   public:
    explicit UnionOfBalls(std::vector<Ball> balls) : box_(scaleaxis::bounds(balls)) {
        const DualComplex complex = dual_complex(balls);
        topology_ = complex.topology;
        neighbors_ = kernel::power_neighbors(complex.triangulation, balls.size());
        spheres_ = visible_spheres(std::move(balls), complex);
        std::vector<Ball> visible;
        std::vector<Point> centers;
        for (const Index i : spheres_.visible) {
            visible.push_back(spheres_.balls[i]);
            centers.push_back(spheres_.balls[i].center);
        }
        tree_ = kernel::build_ball_tree(visible);
        centers_ = kernel::build_point_tree(centers);
    }

    Box bounds() const override { return box_; }

    bool inside(const Point& p) const override { return kernel::covering_ball(tree_, p) != kNone; }

    std::optional<Point> crossing(const Point& inside_end, const Point& outside_end,
                                  const Point& reference) const override {
        const Index covering = covering_ball(inside_end);
        if (covering == kNone) {
            return std::nullopt;
        }
        const std::optional<kernel::Exits> exits =
            kernel::exits(spheres_.balls, neighbors_, spheres_.neighbors, covering, inside_end, outside_end);
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
        return kernel::in_arena(execution, [&] {
            const double area = spacing * spacing / kSeedsPerSquare;
            check_number_of_seeds(area, seed);
            std::vector<Point> points = visible_points(spheres_, area, seed);
            // Every part of the boundary has vertices, but for those of one or two spheres.
            kernel::append(points, spheres_.vertices);
            return points;
        });
    }

    std::optional<Topology> topology() const override { return topology_; }

   private:
    /// A visible ball that contains `p`: the one with the nearest centre if it does, for that reaches far in all
    /// directions.
    Index covering_ball(const Point& p) const {
        const Index nearest = spheres_.visible[centers_.order[kernel::nearest_point(centers_, p).position]];
        const auto& [center, radius] = spheres_.balls[nearest];
        if (squared_distance(center, p) < radius * radius) {
            return nearest;
        }
        const Index covering = kernel::covering_ball(tree_, p);
        return covering == kNone ? kNone : spheres_.visible[covering];
    }

    /// \throws InvalidOption if there would be more of them than indices
    void check_number_of_seeds(double area, std::uint64_t seed) const {
        constexpr double kMost = std::numeric_limits<Index>::max();
        double most = 0.0;  // of the area, covered parts included
        for (const Index i : spheres_.visible) {
            most += 4.0 * std::numbers::pi * spheres_.balls[i].radius * spheres_.balls[i].radius;
        }
        if (most / area > kMost && visible_area(spheres_, seed) / area > kMost) {
            throw InvalidOption("too many samples: the balls would take more than " +
                                std::to_string(std::numeric_limits<Index>::max()) +
                                " seeds; choose a larger tolerance");
        }
    }

    Box box_;
    Topology topology_;
    VisibleSpheres spheres_;
    IndexLists neighbors_;  // of each ball: in the power diagram
    // The others add nothing to the union:
    kernel::BallTree tree_;      // of the visible balls
    kernel::PointTree centers_;  // of the same
};

}  // namespace

std::unique_ptr<Shape> union_of_balls(std::vector<Ball> balls, const Execution& execution) {
    if (balls.empty()) {
        throw UnusableShape("there are no balls: a shape needs one at least");
    }
    return kernel::in_arena(execution,
                            [&] { return std::make_unique<UnionOfBalls>(in_general_position(cleaned(balls))); });
}

}  // namespace scaleaxis
