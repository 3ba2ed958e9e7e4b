// SPDX-License-Identifier: Apache-2.0
#include "uses/uphill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/numbers.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Lengths of a step, in radii, tried one after the other. The first is short enough not to leap over a thin place, and
// gets over the roughness of scans; where the last one leads no further, about 0.2 % of the radius is missing.
constexpr std::array kSteps{0.5, 0.08, 0.0125, 0.002};

constexpr double kFirstStep = 1e-5;  // of the diagonal: the shortest step, for balls that start in a sharp edge

constexpr int kDirections = 8;  // tried for a step: the corner of a box takes about six, and 2 fail on L profiles

// Never reached: on the way out of an edge a radius grows by a quarter or more with each step, and 1e5 is 1.25^52.
constexpr int kMostSteps = 200;

// Distance of a place from the boundary, negative outside, and its gradient.
struct Depth {
    Point place;
    double value = 0.0;
    Point gradient;
};

class Hill {
   public:
    // In an edge whose slope is the limit itself balls stay.
    Hill(const Solid& solid, double slope)
        : solid_(solid), slope_(slope + kFileRounding), diagonal_(solid.bounds().diagonal()) {}

    double first_step() const { return kFirstStep * diagonal_; }

    Depth depth_at(const Point& place) const {
        return depth(place, solid_.nearest(place), [&] { return solid_.inside(place); });
    }

    // A place near one whose depth is known, which differs by the distance at most.
    Depth depth_near(const Depth& known, const Point& place) const {
        const double way = distance(place, known.place);
        const double bound = (1.0 + kFileRounding) * (std::abs(known.value) + way);
        std::optional<Point> nearest = solid_.nearest(place, bound);
        if (!nearest) {
            nearest = solid_.nearest(place);
        }
        return depth(place, nearest, [&] { return known.value > way || solid_.inside(place); });
    }

    struct Step {
        std::optional<Depth> place;  // deeper by more than the slope; nothing: there is none
        double most = 0.0;           // upper bound of the gain
    };

    // A deeper place at the distance `length`. In a convex solid depth is concave: each place looked at bounds the
    // depth by a plane, the tangent of its graph. A mean of these planes is kept, the one with the least maximum within
    // `length`, and the place of this maximum is looked at next: the method of Frank and Wolfe, on the dual problem.
    Step step_from(const Depth& start, const Point& first_direction, double length) const {
        Point mean = start.gradient;
        double offset = 0.0;
        Point direction = first_direction;
        double most = length;
        for (int k = 0; k < kDirections && most > slope_ * length; ++k) {
            const Depth next = depth_near(start, start.place + length * direction);
            const double gain = next.value - start.value;
            if (gain > slope_ * length) {
                return {next, most};
            }
            const double next_offset = gain - length * dot(next.gradient, direction);
            const double part = best_part(mean, offset, next.gradient, next_offset, length);
            mean = (1.0 - part) * mean + part * next.gradient;
            offset = (1.0 - part) * offset + part * next_offset;
            most = offset + length * norm(mean);
            direction = unit(mean);
        }
        return {std::nullopt, most};
    }

   private:
    // Places on the boundary have no gradient of their own, and take that of a place beside, where few faces lie.
    static constexpr Point kAside{0.48, 0.6, 0.64};

    template <class IsInside>
    Depth depth(const Point& place, const std::optional<Point>& nearest, const IsInside& is_inside) const {
        if (!nearest) {
            return {place, 0.0, {}};
        }
        const double way = distance(place, *nearest);
        if (way > kRelativeRounding * diagonal_) {
            const double side = is_inside() ? 1.0 : -1.0;
            return {place, side * way, side / way * (place - *nearest)};
        }
        const Point beside = place + kFileRounding * diagonal_ * kAside;
        const Point outwards = beside - solid_.nearest(beside).value_or(place);
        return {place, 0.0, (solid_.inside(beside) ? 1.0 : -1.0) * unit(outwards)};
    }

    // The share of plane b in the mean of two planes offset + gradient · step whose maximum over all steps of a length
    // is least.
    static double best_part(const Point& a, double a_offset, const Point& b, double b_offset, double length) {
        const Point change = b - a;
        const double square = squared_norm(change);
        if (!(square > 0.0)) {
            return b_offset < a_offset ? 1.0 : 0.0;
        }
        // The derivative of offset + length · |a + t change| is 0.
        const double middle = dot(a, change) / square;
        const double apart = std::max(0.0, squared_norm(a) / square - middle * middle);
        const double fall = (a_offset - b_offset) / (length * std::sqrt(square));
        if (std::abs(fall) >= 1.0) {
            return fall > 0.0 ? 1.0 : 0.0;
        }
        return std::clamp(fall * std::sqrt(apart / (1.0 - fall * fall)) - middle, 0.0, 1.0);
    }

    const Solid& solid_;
    double slope_;
    double diagonal_;
};

}  // namespace

Ball uphill(const Solid& solid, const Ball& start, double slope, double most) {
    const Hill hill(solid, slope);
    Depth at = hill.depth_at(start.center);
    Point direction = at.gradient;
    for (int count = 0; count < kMostSteps && at.value < most; ++count) {
        Hill::Step step;
        for (const double part : kSteps) {
            const double length = std::max(part * at.value, hill.first_step());
            step = hill.step_from(at, direction, length);
            if (step.place || step.most <= kNegligible * at.value || length == hill.first_step()) {
                break;
            }
        }
        if (!step.place) {
            break;
        }
        direction = unit(step.place->place - at.place);
        at = *step.place;
    }
    return {at.place, std::max(0.0, at.value)};
}

}  // namespace scaleaxis::inline v1
