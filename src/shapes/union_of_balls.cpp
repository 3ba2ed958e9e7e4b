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

// The power diagram of a union of balls, without those that others hide completely.
struct PowerDiagram {
    std::vector<Ball> balls;
    IndexLists neighbors;
};

PowerDiagram power_diagram(const std::vector<Ball>& balls, const kernel::Triangulation& triangulation) {
    std::vector<Index> new_index(balls.size(), kNone);
    for (const kernel::Tetrahedron& cell : triangulation.cells) {
        for (const Index v : cell.vertices) {
            if (!kernel::is_ghost(v)) {
                new_index[v] = 0;
            }
        }
    }
    PowerDiagram diagram;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (new_index[i] != kNone) {
            new_index[i] = static_cast<Index>(diagram.balls.size());
            diagram.balls.push_back(balls[i]);
        }
    }
    const IndexLists neighbors = kernel::power_neighbors(triangulation, balls.size());
    std::vector<Index> list;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (new_index[i] != kNone) {
            list.assign(neighbors[i].begin(), neighbors[i].end());
            std::transform(list.begin(), list.end(), list.begin(), [&](Index other) { return new_index[other]; });
            diagram.neighbors.push_back(list);
        }
    }
    return diagram;
}

class UnionOfBalls final : public Shape {
   public:
    explicit UnionOfBalls(const std::vector<Ball>& balls) : box_(scaleaxis::bounds(balls)) {
        const DualComplex complex = dual_complex(balls);
        topology_ = complex.topology;
        vertices_ = boundary_vertices(complex, balls).points;
        PowerDiagram diagram = power_diagram(balls, complex.triangulation);
        balls_ = std::move(diagram.balls);
        neighbors_ = std::move(diagram.neighbors);
        tree_ = kernel::build_ball_tree(balls_);
    }

    Box bounds() const override { return box_; }

    bool inside(const Point& p) const override { return kernel::covering_ball(tree_, p) != kNone; }

    std::optional<Point> crossing(const Point& inside_end, const Point& outside_end,
                                  const Point& reference) const override {
        const Index covering = kernel::covering_ball(tree_, inside_end);
        if (covering == kNone) {
            return std::nullopt;
        }
        const std::optional<kernel::Exits> exits = kernel::exits(balls_, neighbors_, covering, inside_end, outside_end);
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
            std::vector<Point> points = visible_points(balls_, neighbors_, area, seed);
            kernel::append(points, vertices_);
            return points;
        });
    }

    std::optional<Topology> topology() const override { return topology_; }

   private:
    /// \throws InvalidOption if there would be more of them than indices
    void check_number_of_seeds(double area, std::uint64_t seed) const {
        constexpr double kMost = std::numeric_limits<Index>::max();
        constexpr double kTrials = 1e5;
        double spheres = 0.0;
        for (const Ball& ball : balls_) {
            spheres += 4.0 * std::numbers::pi * ball.radius * ball.radius;
        }
        if (spheres / area < kMost) {
            return;
        }
        const double coarse = spheres / kTrials;
        const auto trials = static_cast<double>(visible_points(balls_, neighbors_, coarse, seed).size());
        if (trials * coarse / area > kMost) {
            throw InvalidOption("too many samples: the balls would take more than " +
                                std::to_string(std::numeric_limits<Index>::max()) +
                                " seeds; choose a larger tolerance");
        }
    }

    Box box_;
    Topology topology_;
    std::vector<Point> vertices_;  // of the boundary: every part of it has some, but for those of one or two spheres
    std::vector<Ball> balls_;
    IndexLists neighbors_;  // in the power diagram
    kernel::BallTree tree_;
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
