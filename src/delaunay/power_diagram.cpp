// SPDX-License-Identifier: Apache-2.0
#include "delaunay/power_diagram.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/grouped.hpp"
#include "delaunay/edges.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// The power of a ball along the segment from `a` to `a + direction`, without the term that all balls share.
struct PowerLine {
    double slope;
    double offset;
};

PowerLine power_line(const Ball& ball, const Point& a, const Point& direction) {
    const Point from_center = a - ball.center;
    return {2.0 * dot(direction, from_center), squared_norm(from_center) - ball.radius * ball.radius};
}

/// A walk along a segment, which leaves the union for the first time where it has hopped from ball to ball until none
/// covers the place, and goes on from power cell to power cell. The powers are lines, the least of them is their lower
/// envelope; along it slopes decrease, so that the walk ends, whatever rounding does.
class SegmentWalk {
   public:
    SegmentWalk(std::span<const Ball> balls, const IndexLists& neighbors, const Point& a, const Point& b)
        : balls_(balls), neighbors_(neighbors), a_(a), direction_(b - a), square_(squared_norm(direction_)) {}

    std::optional<Exits> exits(const IndexLists& dual_neighbors, Index covering) {
        enter(covering);
        position_ = chord(line_).last;
        while (const std::optional<Hop> hop = longest_hop(dual_neighbors[ball_])) {
            enter(hop->ball);
            position_ = hop->position;
        }
        if (!(position_ < 1.0)) {
            return std::nullopt;
        }
        Exits exits{position_, position_};
        bool is_covered = false;
        while (position_ < 1.0) {
            const auto [next, end] = next_cell();
            const bool is_end_covered = (square_ * end + line_.slope) * end + line_.offset <= 0.0;
            if (!is_end_covered) {
                if (const std::optional<double> exit = exit_of_ball(is_covered, end)) {
                    exits.last = *exit;
                }
            }
            is_covered = is_end_covered;
            position_ = end;
            if (next != kNone) {
                enter(next);
            }
        }
        return is_covered ? std::nullopt : std::optional(exits);
    }

   private:
    struct Hop {
        Index ball = kNone;
        double position = 1.0;
    };

    void enter(Index ball) {
        ball_ = ball;
        line_ = power_line(balls_[ball], a_, direction_);
    }

    /// The part of the line that a ball covers; empty (last < first) if it passes by.
    Exits chord(const PowerLine& line) const {
        const double root_square = line.slope * line.slope - 4.0 * square_ * line.offset;
        if (!(root_square >= 0.0)) {
            return {1.0, 0.0};
        }
        const double root = std::sqrt(root_square);
        return {(-line.slope - root) / (2.0 * square_), (-line.slope + root) / (2.0 * square_)};
    }

    /// To where the segment leaves the ball that contains this place and reaches farthest, if one does.
    std::optional<Hop> longest_hop(std::span<const Index> candidates) const {
        std::optional<Hop> hop;
        double farthest = position_;
        for (const Index other : candidates) {
            const auto [first, last] = chord(power_line(balls_[other], a_, direction_));
            if (first <= position_ && last > farthest) {
                farthest = last;
                hop = {other, last};
            }
        }
        return hop;
    }

    Hop next_cell() const {
        Hop next;
        for (const Index other : neighbors_[ball_]) {
            const PowerLine line = power_line(balls_[other], a_, direction_);
            if (line.slope < line_.slope) {
                const double meeting = (line.offset - line_.offset) / (line_.slope - line.slope);
                if (meeting < next.position) {
                    next = {other, std::max(meeting, position_)};
                }
            }
        }
        return next;
    }

    /// Where the segment leaves the ball between here and `end`, which is outside.
    std::optional<double> exit_of_ball(bool is_covered, double end) const {
        const double foot = -0.5 * line_.slope / square_;
        const auto& [center, radius] = balls_[ball_];
        const double half_chord_square = radius * radius - squared_distance(a_ + foot * direction_, center);
        if (!is_covered && !(half_chord_square > 0.0 && foot > position_ && foot < end)) {
            return std::nullopt;
        }
        return std::clamp(foot + std::sqrt(std::max(half_chord_square, 0.0) / square_), position_, end);
    }

    std::span<const Ball> balls_;
    const IndexLists& neighbors_;
    Point a_;
    Point direction_;
    double square_;
    Index ball_ = kNone;
    PowerLine line_{};
    double position_ = 0.0;
};

}  // namespace

IndexLists power_neighbors(const Triangulation& triangulation, std::size_t balls) {
    using Edges = std::vector<std::array<Index, 2>>;
    const auto is_wanted = [](Index) { return true; };
    const Edges edges = collect_edges<Edges>(triangulation, is_wanted, [&](const auto& around, Edges& out) {
        const std::array<Index, 2> ends = ends_of_edge(triangulation, around.front());
        if (!is_ghost(ends[0]) && !is_ghost(ends[1])) {
            out.push_back(ends);
        }
    });
    return grouped_both_ways(balls, edges);
}

std::optional<Exits> exits(std::span<const Ball> balls, const IndexLists& neighbors, const IndexLists& dual_neighbors,
                           Index covering, const Point& a, const Point& b) {
    return SegmentWalk(balls, neighbors, a, b).exits(dual_neighbors, covering);
}

}  // namespace scaleaxis::inline v1
