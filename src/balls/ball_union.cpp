// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/ball_union.hpp"

#include <array>
#include <numeric>
#include <string_view>
#include <type_traits>
#include <utility>

#include "balls/union/union_data.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kStage = "union of balls";

/// Runs a question to a union.
template <class Work>
auto asked(const Execution& execution, const Work& work) {
    return in_arena(execution, [&] {
        report(execution, kStage, 0.0);
        auto result = work();
        report(execution, kStage, 1.0);
        return result;
    });
}

/// `answer(point)` for each point, in parallel.
template <class Answer>
auto answers(std::span<const Point> points, const Answer& answer) {
    return mapped<std::invoke_result_t<Answer, const Point&>>(points.size(),
                                                              [&](std::size_t i) { return answer(points[i]); });
}

}  // namespace

BallUnion::BallUnion() = default;
BallUnion::BallUnion(std::vector<Ball> balls) : data_(std::make_shared<const UnionData>(std::move(balls))) {}
BallUnion::BallUnion(std::shared_ptr<const UnionData> data) : data_(std::move(data)) {}

const UnionData& BallUnion::data() const {
    if (!data_) {
        throw UnusableInput(Diagnostic{"balls.none", "there are no balls: a union needs one at least"});
    }
    return *data_;
}

std::span<const Ball> BallUnion::balls() const {
    return data_ ? std::span<const Ball>(data_->balls()) : std::span<const Ball>();
}

Box BallUnion::bounds() const { return scaleaxis::bounds(balls()); }

Topology BallUnion::topology(const Execution& execution) const {
    return asked(execution, [&] { return data().complex().dual.topology; });
}

IndexLists BallUnion::neighbors(const Execution& execution) const {
    return asked(execution, [&] {
        const UnionComplex& complex = data().complex();
        const IndexLists& neighbors = data().adjacency().neighbors;
        if (complex.given.empty()) {
            return neighbors;
        }
        IndexLists result;
        result.offsets.assign(data().balls().size() + 1, 0);
        for (std::size_t i = 0; i < complex.given.size(); ++i) {
            result.offsets[complex.given[i] + 1] = static_cast<Index>(neighbors[i].size());
        }
        std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
        for (const Index neighbor : neighbors.items) {
            result.items.push_back(complex.given[neighbor]);
        }
        return result;
    });
}

BoundaryVertices BallUnion::boundary_vertices(const Execution& execution) const {
    return asked(execution, [&] {
        const UnionComplex& complex = data().complex();
        BoundaryVertices vertices = complex.vertices;
        for (std::array<Index, 3>& balls : vertices.balls) {
            for (Index& ball : balls) {
                ball = complex.given_ball(ball);
            }
        }
        return vertices;
    });
}

std::vector<NearestBall> BallUnion::nearest_balls(std::span<const Point> points, const Execution& execution) const {
    return asked(execution, [&] {
        const BallTree& tree = data().tree();
        return answers(points, [&](const Point& p) { return nearest_ball(tree, p); });
    });
}

std::vector<double> BallUnion::signed_distances(std::span<const Point> points, const Execution& execution) const {
    return asked(execution, [&] {
        const BallTree& tree = data().tree();
        return answers(points, [&](const Point& p) { return nearest_ball(tree, p).distance; });
    });
}

std::vector<std::uint8_t> BallUnion::inside(std::span<const Point> points, const Execution& execution) const {
    return asked(execution, [&] {
        const BallTree& tree = data().tree();
        return answers(points, [&](const Point& p) -> std::uint8_t { return covering_ball(tree, p) != kNone; });
    });
}

std::vector<double> BallUnion::distances_to_boundary(std::span<const Point> points, const Execution& execution) const {
    return asked(execution, [&] {
        const UnionBoundary& boundary = data().boundary();
        return answers(points, [&](const Point& p) { return nearest_point(boundary, p).distance; });
    });
}

}  // namespace scaleaxis::inline v1
