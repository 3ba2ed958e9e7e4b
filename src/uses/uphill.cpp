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

// Of weight after each plane: 95 of 100 planes take one at most, one in 1,000 more than 20.
constexpr int kMostShifts = 64;

// Never reached: on the way out of an edge a radius grows by a quarter or more with each step, and 1e5 is 1.25^52.
constexpr int kMostSteps = 200;

// Distance of a place from the boundary, negative outside, and its gradient.
struct Depth {
    Point place;
    double value = 0.0;
    Point gradient;
};

// The graph of offset + gradient · step.
struct TangentPlane {
    Point gradient;
    double offset = 0.0;
};

// Planes, and the mean of them whose maximum within a length of the origin is least.
class TangentPlanes {
   public:
    // \param enough what the maximum need not be less than
    TangentPlanes(double length, double enough) : length_(length), enough_(enough) {}

    // Moves weight from the highest plane at the maximum of the mean to the lowest one for as long as this lowers the
    // maximum: the pairwise steps of Frank and Wolfe, whose errors fall geometrically.
    void add(const TangentPlane& plane) {
        planes_[count_] = plane;
        weights_[count_] = count_ == 0 ? 1.0 : 0.0;
        mean_ = count_ == 0 ? plane : mean_;
        ++count_;
        for (int k = 0; k < kMostShifts; ++k) {
            const Point step = length_ * direction();
            std::array<double, kDirections + 1> values{};
            int lowest = 0;
            int highest = -1;
            for (int i = 0; i < count_; ++i) {
                values[i] = planes_[i].offset + dot(planes_[i].gradient, step);
                lowest = values[i] < values[lowest] ? i : lowest;
                if (weights_[i] > 0.0 && (highest < 0 || values[i] > values[highest])) {
                    highest = i;
                }
            }
            const TangentPlane& a = planes_[highest];
            const TangentPlane& b = planes_[lowest];
            if (values[highest] - values[lowest] <= kNegligible * length_ || most() <= enough_) {
                return;
            }
            const TangentPlane shifted{mean_.gradient + weights_[highest] * (b.gradient - a.gradient),
                                       mean_.offset + weights_[highest] * (b.offset - a.offset)};
            const double part = best_part(shifted);
            const double weight = part * weights_[highest];
            mean_ = {(1.0 - part) * mean_.gradient + part * shifted.gradient,
                     (1.0 - part) * mean_.offset + part * shifted.offset};
            weights_[lowest] += weight;
            weights_[highest] = part < 1.0 ? weights_[highest] - weight : 0.0;
        }
    }

    Point direction() const { return unit(mean_.gradient); }
    double most() const { return mean_.offset + length_ * norm(mean_.gradient); }

   private:
    // The share of a plane beside the mean with which the maximum, offset + length · |gradient|, becomes least.
    double best_part(const TangentPlane& plane) const {
        const Point change = plane.gradient - mean_.gradient;
        const double square = squared_norm(change);
        if (!(square > 0.0)) {
            return plane.offset < mean_.offset ? 1.0 : 0.0;
        }
        // Its derivative is 0.
        const double middle = dot(mean_.gradient, change) / square;
        const double apart = std::max(0.0, squared_norm(mean_.gradient) / square - middle * middle);
        const double fall = (mean_.offset - plane.offset) / (length_ * std::sqrt(square));
        if (std::abs(fall) >= 1.0) {
            return fall > 0.0 ? 1.0 : 0.0;
        }
        return std::clamp(fall * std::sqrt(apart / (1.0 - fall * fall)) - middle, 0.0, 1.0);
    }

    double length_;
    double enough_;
    int count_ = 0;
    std::array<TangentPlane, kDirections + 1> planes_;
    std::array<double, kDirections + 1> weights_{};
    TangentPlane mean_;
};

class Hill {
   public:
    // In an edge whose slope is the limit itself balls stay.
    Hill(const Solid& solid, double slope)
        : solid_(solid), slope_(slope + kFileRounding), bounds_(solid.bounds()), diagonal_(bounds_.diagonal()) {}

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

    // Is the end of another way a place that a step may lead to, or nearer than the last step?
    bool leads_to(const Depth& at, const Ball& end) const {
        const double way = distance(at.place, end.center);
        return end.radius > at.value && ((way <= kSteps.front() * at.value && end.radius - at.value > slope_ * way) ||
                                         way <= kSteps.back() * at.value);
    }

    // Surfaces of points have holes, through which balls would leave and grow without end.
    bool has_left(const Point& place) const { return !bounds_.contains(place) && !solid_.inside(place); }

    struct Step {
        std::optional<Depth> place;  // deeper by more than the slope; nothing: there is none
        double most = 0.0;           // upper bound of the gain
    };

    // A deeper place at the distance `length`. In a convex solid depth is concave: each place looked at bounds the
    // depth by a plane, the tangent of its graph. Of all means of these planes the one with the least maximum within
    // `length` is found, and the place of this maximum is looked at next: the method of Frank and Wolfe, on the dual
    // problem, in its fully corrective form.
    Step step_from(const Depth& start, const Point& first_direction, double length) const {
        TangentPlanes planes(length, slope_ * length);
        planes.add({start.gradient, 0.0});
        Point direction = first_direction;
        for (int k = 0; k < kDirections && planes.most() > slope_ * length; ++k) {
            const Depth next = depth_near(start, start.place + length * direction);
            const double gain = next.value - start.value;
            if (gain > slope_ * length) {
                return {next, planes.most()};
            }
            planes.add({next.gradient, gain - length * dot(next.gradient, direction)});
            direction = planes.direction();
        }
        return {std::nullopt, planes.most()};
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

    const Solid& solid_;
    double slope_;
    Box bounds_;
    double diagonal_;
};

}  // namespace

Ball uphill(const Solid& solid, const Ball& start, double slope, double most, const Ball& known) {
    const Hill hill(solid, slope);
    Depth at = hill.depth_at(start.center);
    Point direction = at.gradient;
    for (int count = 0; count < kMostSteps && at.value < most; ++count) {
        if (hill.leads_to(at, known)) {
            return known;
        }
        Hill::Step step;
        for (const double part : kSteps) {
            const double length = std::max(part * at.value, hill.first_step());
            step = hill.step_from(at, direction, length);
            if (step.place || step.most <= kNegligible * at.value || length == hill.first_step()) {
                break;
            }
        }
        if (!step.place || hill.has_left(step.place->place)) {
            break;
        }
        direction = unit(step.place->place - at.place);
        at = *step.place;
    }
    return {at.place, std::max(0.0, at.value)};
}

}  // namespace scaleaxis::inline v1
