// SPDX-License-Identifier: Apache-2.0
#include "solid/zero_set/foot_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scaleaxis::inline v1 {
namespace {

constexpr int kMostSteps = 16;
constexpr std::size_t kMostPlanes = 4;

// What is left of the way does not matter below this part of the distance, which it changes by the square, and of the
// step.
constexpr double kEnough = 1e-5;
constexpr double kEnoughOfStep = 1e-9;

// Points within this part of a step behind a plane are on it.
constexpr double kOnPlane = 1e-9;

// A surface that turns faster than about once in this part of a step has an edge.
constexpr double kSharp = 1.5;

// By this part of a step a foot may be farther than the start of its search.
constexpr double kVeryNear = 0.25;

// The first search for a sign change along the normal goes so far, in steps.
constexpr double kFirstReach = 1e-9;
constexpr double kWidening = 16.0;
constexpr double kMostReach = 2.0;

}  // namespace

FootSearch::FootSearch(const Point& p, const Point& start, double step, double accuracy, bool is_smooth)
    : p_(p),
      step_(step),
      accuracy_(accuracy),
      // Very near to a smooth surface `p` is as good a place to start.
      place_(is_smooth && distance(p, start) < kVeryNear * step ? p : start),
      start_(start),
      trust_(step),
      best_{start, distance(p, start) > 0.0 ? unit(start - p) : Point{1, 0, 0}},
      least_(std::numeric_limits<double>::infinity()) {}

void FootSearch::tell(double value, const Point& gradient) {
    switch (stage_) {
        case Stage::kDescent:
            descend(value, gradient);
            break;
        case Stage::kStart:
            value_at_best_ = value;
            if (value == 0.0) {
                finish(best_.point);
                break;
            }
            stage_ = Stage::kBracket;
            reach_ = std::max(2.0 * accuracy_, kFirstReach * step_);
            place_ = along(reach_);
            break;
        case Stage::kBracket:
        case Stage::kRoot:
            refine(value);
            break;
        case Stage::kDone:
            break;
    }
}

void FootSearch::step_back() {
    if (!last_ || ++count_ > kMostSteps) {
        look_along_normal();
        return;
    }
    trust_ = 0.25 * distance(place_, last_->foot);
    place_ = last_->foot + 0.25 * (place_ - last_->foot);
}

void FootSearch::descend(double value, const Point& gradient) {
    const double square = squared_norm(gradient);
    if (!(square > 0.0) || !std::isfinite(square)) {
        if (value == 0.0 && distance(p_, place_) < least_) {  // a corner that was met exactly
            least_ = distance(p_, place_);
            best_.point = place_;
        }
        step_back();
        return;
    }
    // The surface as the tangent plane tells.
    const Point way = (-value / square) * gradient;
    const double length = norm(way);
    const Point foot = place_ + (length > step_ ? step_ / length : 1.0) * way;
    Point normal = unit(gradient);
    normal = dot(normal, foot - p_) < 0.0 ? -1.0 * normal : normal;
    const double far = distance(p_, foot);
    const Point rest = (p_ - foot) - dot(p_ - foot, normal) * normal;
    const double enough = kEnough * far + kEnoughOfStep * step_;
    const bool is_foot = norm(rest) <= enough && length <= std::sqrt(enough * step_);
    // The tangent plane is off the surface by about the square of the length.
    const double counts = far + length * length / step_;
    if (is_foot || counts < least_) {
        least_ = counts;
        best_ = {foot, normal};
        trust_ = std::min(step_, 2.0 * trust_);
    } else if (last_ && planes_.size() == 1) {
        trust_ = std::min(trust_, 0.5 * distance(foot, last_->foot));
    }
    if (is_foot || trust_ <= enough || ++count_ >= kMostSteps) {
        look_along_normal();
        return;
    }
    // Planes count together at an edge alone: where the normal turns too fast for a smooth surface, and the surface is
    // behind the other plane.
    std::erase_if(planes_, [&](const Plane& plane) {
        return dot(plane.normal, foot - plane.point) < -kOnPlane * step_ ||
               !(norm(plane.normal - normal) * step_ > kSharp * distance(plane.point, foot) + kOnPlane * step_);
    });
    if (planes_.size() == kMostPlanes) {
        planes_.erase(planes_.begin());
    }
    planes_.push_back({foot, normal});
    const Point to = target(foot, rest);
    const double wanted = distance(foot, to);
    if (distance(place_, to) <= enough) {
        // On an edge: planes tell of nearer places in front of a re-entrant one, along whose normals the function need
        // not change its sign.
        if (planes_.size() > 1) {
            best_ = {foot, far > accuracy_ ? unit(foot - p_) : normal};
        }
        look_along_normal();
        return;
    }
    last_ = {foot, rest};
    place_ = wanted > trust_ ? foot + (trust_ / wanted) * (to - foot) : to;
}

Point FootSearch::target(const Point& foot, const Point& rest) {
    const std::size_t count = planes_.size();
    if (count == 1) {
        double part = 1.0;
        if (last_) {
            constexpr double kLeast = 0.1;
            constexpr double kMost = 20.0;
            const Point moved = foot - last_->foot;
            const double change = -dot(moved, rest - last_->rest);
            part = change > 0.0 ? std::clamp(squared_norm(moved) / change, kLeast, kMost) : kMost;
        }
        return foot + part * rest;
    }
    // The point nearest to `p` behind all planes: on one, two or three of them.
    const auto is_behind_all = [&](const Point& q) {
        return std::ranges::all_of(
            planes_, [&](const Plane& plane) { return dot(plane.normal, q - plane.point) >= -kOnPlane * step_; });
    };
    const auto height = [&](std::size_t i) { return dot(planes_[i].normal, planes_[i].point - p_); };
    for (std::size_t i = count; i-- > 0;) {
        const Point q = p_ + height(i) * planes_[i].normal;
        if (is_behind_all(q)) {
            return q;
        }
    }
    for (std::size_t i = count; i-- > 0;) {
        for (std::size_t j = i; j-- > 0;) {
            const Point &u = planes_[i].normal, &v = planes_[j].normal;
            const double cosine = dot(u, v);
            const double square = 1.0 - cosine * cosine;
            const double at_u = (height(i) - cosine * height(j)) / square;
            const double at_v = (height(j) - cosine * height(i)) / square;
            const Point q = p_ + at_u * u + at_v * v;
            if (square > 1e-12 && at_u >= 0.0 && at_v >= 0.0 && is_behind_all(q)) {
                return q;
            }
        }
    }
    for (std::size_t i = count; i-- > 0;) {
        for (std::size_t j = i; j-- > 0;) {
            for (std::size_t k = j; k-- > 0;) {
                const Point &u = planes_[i].normal, &v = planes_[j].normal, &w = planes_[k].normal;
                const double volume = dot(u, cross(v, w));
                const Point q =
                    p_ + (1.0 / volume) * (height(i) * cross(v, w) + height(j) * cross(w, u) + height(k) * cross(u, v));
                if (std::abs(volume) > 1e-9 && is_behind_all(q)) {
                    return q;
                }
            }
        }
    }
    return foot + rest;
}

void FootSearch::look_along_normal() {
    stage_ = Stage::kStart;
    place_ = best_.point;
}

void FootSearch::widen() {
    // On one side, on the other one, then farther.
    const double most = kMostReach * step_;
    if (reach_ <= -most) {
        finish(std::nullopt);
        return;
    }
    reach_ = reach_ > 0.0 ? -reach_ : std::min(-kWidening * reach_, most);
    place_ = along(reach_);
}

void FootSearch::refine(double value) {
    if (stage_ == Stage::kBracket) {
        if (value == 0.0) {
            finish(place_);
            return;
        }
        if ((value < 0.0) == (value_at_best_ < 0.0)) {
            widen();
            return;
        }
        if (std::abs(reach_) <= kFirstReach * step_) {
            // On so short a way the function is a line, or leaps.
            finish(along(value_at_best_ / (value_at_best_ - value) * reach_));
            return;
        }
        stage_ = Stage::kRoot;
        root_ = reach_ > 0.0 ? RootFinder(0.0, reach_, value_at_best_, value, accuracy_)
                             : RootFinder(reach_, 0.0, value, value_at_best_, accuracy_);
    } else {
        root_->tell(value);
    }
    if (root_->is_found()) {
        finish(along(root_->root()));
    } else {
        place_ = along(root_->place());
    }
}

void FootSearch::finish(const std::optional<Point>& found) {
    if (found && (!result_ || distance(p_, *found) < distance(p_, *result_))) {
        result_ = found;
    }
    const double far = distance(p_, start_);
    const std::array<Point, 4> directions{
        far > 0.0 ? (1.0 / far) * (start_ - p_) : Point{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if ((result_ && distance(p_, *result_) < far + kVeryNear * step_) || attempts_ == 4) {
        stage_ = Stage::kDone;
        return;
    }
    best_ = {start_, directions[attempts_++]};
    look_along_normal();
}

}  // namespace scaleaxis::inline v1
