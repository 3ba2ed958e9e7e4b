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
#include "kernel/grouped.hpp"
#include "kernel/parallel.hpp"
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

/// The balls that have a part of the power diagram: others hide the rest completely.
struct PowerDiagram {
    VisibleSpheres spheres;
    IndexLists neighbors;  // of each ball
};

PowerDiagram power_diagram(const std::vector<Ball>& balls, const DualComplex& complex) {
    std::vector<Index> new_index(balls.size(), kNone);
    for (const kernel::Tetrahedron& cell : complex.triangulation.cells) {
        for (const Index v : cell.vertices) {
            if (!kernel::is_ghost(v)) {
                new_index[v] = 0;
            }
        }
    }
    PowerDiagram diagram;
    VisibleSpheres& spheres = diagram.spheres;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (new_index[i] != kNone) {
            new_index[i] = static_cast<Index>(spheres.balls.size());
            spheres.balls.push_back(balls[i]);
        }
    }
    const IndexLists neighbors = kernel::power_neighbors(complex.triangulation, balls.size());
    std::vector<Index> list;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (new_index[i] != kNone) {
            list.assign(neighbors[i].begin(), neighbors[i].end());
            std::transform(list.begin(), list.end(), list.begin(), [&](Index other) { return new_index[other]; });
            diagram.neighbors.push_back(list);
        }
    }

    spheres.neighbors = kernel::grouped(spheres.balls.size(), [&](const auto& add) {
        for (const auto& [a, b] : complex.edges) {
            add(new_index[a], new_index[b]);
            add(new_index[b], new_index[a]);
        }
    });
    for (const Index single : complex.singular_vertices) {
        spheres.visible.push_back(new_index[single]);
    }
    for (Index i = 0; i < static_cast<Index>(spheres.balls.size()); ++i) {
        if (!spheres.neighbors[i].empty()) {
            spheres.visible.push_back(i);
        }
    }

    BoundaryVertices vertices = boundary_vertices(complex, balls);
    spheres.vertices = std::move(vertices.points);
    spheres.vertex_balls = std::move(vertices.balls);
    for (std::array<Index, 3>& names : spheres.vertex_balls) {
        std::transform(names.begin(), names.end(), names.begin(), [&](Index ball) { return new_index[ball]; });
    }
    spheres.ball_vertices = kernel::grouped(spheres.balls.size(), [&](const auto& add) {
        for (Index v = 0; v < static_cast<Index>(spheres.vertices.size()); ++v) {
            for (const Index ball : spheres.vertex_balls[v]) {
                add(ball, v);
            }
        }
    });
    return diagram;
}

class UnionOfBalls final : public Shape {
   public:
    explicit UnionOfBalls(const std::vector<Ball>& balls) : box_(scaleaxis::bounds(balls)) {
        const DualComplex complex = dual_complex(balls);
        topology_ = complex.topology;
        diagram_ = power_diagram(balls, complex);
        const VisibleSpheres& spheres = diagram_.spheres;
        std::vector<Ball> visible(spheres.visible.size());
        std::transform(spheres.visible.begin(), spheres.visible.end(), visible.begin(),
                       [&](Index i) { return spheres.balls[i]; });
        tree_ = kernel::build_ball_tree(visible);
        std::for_each(visible.begin(), visible.end(), [](Ball& ball) { ball.radius = 0.0; });
        centers_ = kernel::build_ball_tree(visible);
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
            kernel::exits(diagram_.spheres.balls, diagram_.neighbors, diagram_.spheres.neighbors,
                          diagram_.spheres.visible[covering], inside_end, outside_end);
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
            std::vector<Point> points = visible_points(diagram_.spheres, area, seed);
            // Every part of the boundary has vertices, but for those of one or two spheres.
            kernel::append(points, diagram_.spheres.vertices);
            return points;
        });
    }

    std::optional<Topology> topology() const override { return topology_; }

   private:
    /// A ball that contains `p`: the one with the nearest centre if it does, for that reaches far in all directions.
    Index covering_ball(const Point& p) const {
        const Index nearest = kernel::nearest_ball(centers_, p).ball;
        const Ball& ball = diagram_.spheres.balls[diagram_.spheres.visible[nearest]];
        const bool is_covering = squared_distance(ball.center, p) < ball.radius * ball.radius;
        return is_covering ? nearest : kernel::covering_ball(tree_, p);
    }

    /// \throws InvalidOption if there would be more of them than indices
    void check_number_of_seeds(double area, std::uint64_t seed) const {
        if (visible_area(diagram_.spheres, seed) / area > std::numeric_limits<Index>::max()) {
            throw InvalidOption("too many samples: the balls would take more than " +
                                std::to_string(std::numeric_limits<Index>::max()) +
                                " seeds; choose a larger tolerance");
        }
    }

    Box box_;
    Topology topology_;
    PowerDiagram diagram_;
    kernel::BallTree centers_;  // of the visible balls, as balls of radius 0
    kernel::BallTree tree_;     // of the visible balls: the others add nothing to the union
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
