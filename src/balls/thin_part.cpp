// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/parallel.hpp"
#include "scaleaxis/fit.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Chosen by what it finds in 96 models of the Princeton benchmark: wings, fins and boards. With 150 degrees also ears
// of cats and wrists are found; with balls around that are closer, the edges of many blades.
constexpr double kLeastSeparation = 165.0 / 180.0 * std::numbers::pi;  // angle between the contacts
constexpr double kReach = 2.0;                                         // of the balls around, in tolerances

bool touches_opposite_sides(const Ball& ball, const Contacts& contacts) {
    const double cosine = dot(unit(contacts[0] - ball.center), unit(contacts[1] - ball.center));
    return cosine < std::cos(kLeastSeparation);
}

}  // namespace

std::optional<ThinPart> thin_part(std::span<const Ball> balls, std::span<const Contacts> contacts, double tolerance,
                                  const Execution& execution) {
    return in_arena(execution, [&]() -> std::optional<ThinPart> {
        report(execution, "thin parts", 0.0);
        std::vector<std::uint8_t> is_thin(balls.size());
        std::vector<Point> centers(balls.size());
        for_each_index(balls.size(), [&](std::size_t i) {
            is_thin[i] = balls[i].radius < tolerance && touches_opposite_sides(balls[i], contacts[i]) ? 1 : 0;
            centers[i] = balls[i].center;
        });
        const PointTree tree = build_point_tree(centers);
        // Amid thin balls that reach half as far at least, so that a few tiny ones do not count.
        const auto is_amid_thin_ones = [&](std::size_t i) {
            const double reach = kReach * tolerance;
            bool are_thin = true;
            double farthest = 0.0;
            for_each_point_near(tree, centers[i], reach, [&](Index position, double squared_distance) {
                are_thin = are_thin && is_thin[tree.order[position]] != 0;
                farthest = std::max(farthest, squared_distance);
            });
            return are_thin && farthest > 0.25 * reach * reach;
        };
        using Positions = std::vector<std::size_t>;
        const Positions amid = collect<Positions>(balls.size(), [&](std::size_t i, Positions& out) {
            if (is_thin[i] != 0 && is_amid_thin_ones(i)) {
                out.push_back(i);
            }
        });
        report(execution, "thin parts", 1.0);
        if (amid.empty()) {
            return std::nullopt;
        }
        const Ball& thinnest =
            balls[*std::ranges::min_element(amid, {}, [&](std::size_t i) { return balls[i].radius; })];
        return ThinPart{thinnest.center, 2.0 * thinnest.radius};
    });
}

}  // namespace scaleaxis::inline v1
