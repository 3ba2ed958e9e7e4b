// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "balls/thin_balls.hpp"
#include "base/angles.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/fit.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Chosen by what it finds in 96 models of the Princeton benchmark: wings, fins and boards. With 150 degrees also ears
// of cats and wrists are found; with balls around that are closer, the edges of many blades.
constexpr double kLeastSeparation = 165.0 / 180.0 * std::numbers::pi;  // angle between the contacts
constexpr double kReach = 2.0;                                         // of the balls around, in tolerances

// For `thin_balls`: rods touch balls at three places or more, 120 degrees apart; at edges of 60 degrees and more the
// angle is smaller.
constexpr double kLeastSeparationInRods = 119.0 / 180.0 * std::numbers::pi;

// For `thin_balls`: parts of this thickness in tolerances are found, which the samples are too far apart for. Plates of
// 0.7 tolerances come out right without more samples, those of 0.57 get holes.
constexpr double kThin = 0.65;

// How far around a ball the thickness is that of the part, in tolerances; and a smaller ball counts for what it is
// down to this part of the largest one there. Towards sharp edges balls become as small as one likes.
constexpr double kSamePart = 0.5;
constexpr double kLeastOfPart = 0.25;

bool touches_opposite_sides(const Ball& ball, const Contacts& contacts, double least_separation) {
    const double cosine = dot(unit(contacts[0] - ball.center), unit(contacts[1] - ball.center));
    return cosine < cosine_of(least_separation);
}

}  // namespace

std::vector<Ball> thin_balls(std::span<const Ball> balls, std::span<const Contacts> contacts, double tolerance) {
    enum Kind : std::uint8_t { kThick, kSmall, kOpposite, kAmidSmall };
    std::vector<Kind> kinds(balls.size());
    std::vector<Point> centers(balls.size());
    for_each_index(balls.size(), [&](std::size_t i) {
        const bool is_small = balls[i].radius < 0.5 * kThin * tolerance;
        kinds[i] = !is_small                                                               ? kThick
                   : touches_opposite_sides(balls[i], contacts[i], kLeastSeparationInRods) ? kOpposite
                                                                                           : kSmall;
        centers[i] = balls[i].center;
    });
    if (std::ranges::find(kinds, kOpposite) == kinds.end()) {
        return {};
    }
    const PointTree tree = build_point_tree(centers);
    const auto any_near = [&](std::size_t i, double reach, const auto& is_sought) {
        bool is_any = false;
        for_each_point_near(tree, centers[i], reach * tolerance,
                            [&](Index position, double) { is_any = is_any || is_sought(tree.order[position]); });
        return is_any;
    };
    std::vector<Kind> refined = kinds;
    for_each_index(balls.size(), [&](std::size_t i) {
        if (kinds[i] == kOpposite && !any_near(i, kReach, [&](Index j) { return kinds[j] == kThick; })) {
            refined[i] = kAmidSmall;
        }
    });
    // Where a thin part begins, thick balls are near: those beside balls far from thick ones count.
    using ThinBalls = std::vector<Ball>;
    return collect<ThinBalls>(balls.size(), [&](std::size_t i, ThinBalls& out) {
        if (kinds[i] != kOpposite || !any_near(i, kReach, [&](Index j) { return refined[j] == kAmidSmall; })) {
            return;
        }
        double largest = 0.0;
        for_each_point_near(tree, centers[i], kSamePart * tolerance, [&](Index position, double) {
            const Index j = tree.order[position];
            largest = std::max(largest, kinds[j] == kOpposite ? balls[j].radius : 0.0);
        });
        out.push_back({balls[i].center, std::max(balls[i].radius, kLeastOfPart * largest)});
    });
}

std::optional<ThinPart> thin_part(std::span<const Ball> balls, std::span<const Contacts> contacts, double tolerance,
                                  const Execution& execution) {
    return in_arena(execution, [&]() -> std::optional<ThinPart> {
        report(execution, "thin parts", 0.0);
        std::vector<std::uint8_t> is_thin(balls.size());
        std::vector<Point> centers(balls.size());
        for_each_index(balls.size(), [&](std::size_t i) {
            is_thin[i] =
                balls[i].radius < tolerance && touches_opposite_sides(balls[i], contacts[i], kLeastSeparation) ? 1 : 0;
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
