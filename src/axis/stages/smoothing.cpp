// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/smoothing.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/stages/stages.hpp"
#include "balls/union/union_data.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Of the way to the middle of the neighbours, in turn. The second is a little larger than the first, so that waves of
// more than about 16 edges grow by a little in place of shrinking, and shorter ones still vanish (Taubin 1995).
constexpr double kSmoothingStep = 0.5;
constexpr double kStepBack = -0.52;

// Degrees at which the balls meet that stand for the solid of a complex: what they lack between their centres is less
// than 1 % of the radius.
constexpr double kMeetingAngle = 165.0;

// A vertex that can move, and its neighbours along the boundary of the sheet or the curve.
struct Movable {
    Index vertex;
    std::array<Index, 2> neighbors;
};

std::vector<Movable> movable_vertices(const MedialComplex& complex) {
    const std::vector<Index> faces_at_edge = face_counts(complex);
    struct Neighborhood {
        std::array<Index, 2> neighbors{};
        int boundary_edges = 0;
        int curve_edges = 0;
        bool is_in_sheet = false;
        bool is_at_seam = false;

        bool can_move() const {
            return !is_at_seam && (is_in_sheet ? boundary_edges == 2 && curve_edges == 0 : curve_edges == 2);
        }
    };
    std::vector<Neighborhood> around(complex.vertices.size());
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        const auto& [p, q] = complex.edges[e];
        for (const auto& [vertex, other] : {std::pair(p, q), std::pair(q, p)}) {
            Neighborhood& at = around[vertex];
            const Index faces = faces_at_edge[e];
            at.is_in_sheet = at.is_in_sheet || faces > 0;
            at.is_at_seam = at.is_at_seam || faces > 2;
            if (faces < 2) {
                int& count = faces == 1 ? at.boundary_edges : at.curve_edges;
                if (count < 2) {
                    at.neighbors[count] = other;
                }
                ++count;
            }
        }
    }
    std::vector<Movable> result;
    for (Index v = 0; v < static_cast<Index>(around.size()); ++v) {
        if (around[v].can_move() && !is_on_sharp_edge(complex, v)) {
            result.push_back({v, around[v].neighbors});
        }
    }
    return result;
}

void validate(const SmoothOptions& options) {
    require(options.rounds >= 0, "the number of smoothing rounds must be at least 0");
}

}  // namespace

BallUnion grown_union(const MedialComplex& complex, const Execution& execution) {
    const MedialComplex dense = densified(complex, {.meeting_angle = kMeetingAngle}, execution);
    std::vector<Ball> balls;
    for (std::size_t v = 0; v < dense.vertices.size(); ++v) {
        if (!is_on_sharp_edge(dense, v)) {
            balls.push_back({dense.vertices[v], dense.scale * dense.radii[v]});
        }
    }
    return BallUnion(std::move(balls));
}

MedialComplex linearized_around_borders(MedialComplex complex, double tolerance) {
    std::vector<std::uint8_t> moves(complex.vertices.size());
    for (const Movable& movable : movable_vertices(complex)) {
        moves[movable.vertex] = 1;
    }
    const auto may_move = [&](Index v) { return std::cmp_greater_equal(v, moves.size()) || moves[v] != 0; };
    return linearized(std::move(complex), tolerance, [&](Index a, Index b) { return !may_move(a) && !may_move(b); });
}

MedialComplex smooth(MedialComplex complex, const BallUnion& ball_union, const SmoothOptions& options,
                     const Execution& execution) {
    validate(options);
    return in_arena(execution, [&] {
        check(complex);
        constexpr std::string_view kStage = "smoothing";
        report(execution, kStage, 0.0);
        if (options.rounds == 0) {
            report(execution, kStage, 1.0);
            return std::move(complex);
        }
        const std::vector<Movable> movable = movable_vertices(complex);
        std::vector<Point> positions = complex.vertices;
        std::vector<Point> moved(movable.size());
        CancellationPoint cancellation_point;
        for (Index round = 0; round < options.rounds; ++round) {
            const double step = round % 2 == 0 ? kSmoothingStep : kStepBack;
            for (std::size_t i = 0; i < movable.size(); ++i) {
                cancellation_point();
                const auto& [vertex, neighbors] = movable[i];
                const Point& p = positions[vertex];
                moved[i] = p + step * (midpoint(positions[neighbors[0]], positions[neighbors[1]]) - p);
            }
            for (std::size_t i = 0; i < movable.size(); ++i) {
                positions[movable[i].vertex] = moved[i];
            }
        }
        report(execution, kStage, 0.2);
        const UnionInterior& interior = ball_union.data().interior();
        report(execution, kStage, 0.5);
        for_each_index(
            movable.size(),
            [&](std::size_t i) {
                const Index v = movable[i].vertex;
                const auto nearest = nearest_from_inside(interior, positions[v]);
                const double radius = nearest ? nearest->distance / complex.scale : 0.0;
                // A curve may turn back where a ball is largest.
                if (nearest && radius >= (1.0 - kRadiusError) * complex.radii[v]) {
                    complex.vertices[v] = positions[v];
                    complex.radii[v] = radius;
                    complex.vertex_origins[v] = {VertexKind::kTouching};
                }
            },
            std::size_t{64});
        report(execution, kStage, 1.0);
        return std::move(complex);
    });
}

MedialComplex smooth(MedialComplex complex, const SmoothOptions& options, const Execution& execution) {
    validate(options);
    check(complex);
    if (options.rounds == 0 || complex.vertices.empty()) {
        return complex;
    }
    const BallUnion ball_union = grown_union(complex, {execution.threads, {}, execution.cancel});
    const double length = kLeastDip * kDefaultTolerance * box_of_balls(complex).diagonal();
    return in_arena(execution, [&] {
        return smooth(linearized_around_borders(std::move(complex), length), ball_union, options, execution);
    });
}

}  // namespace scaleaxis::inline v1
