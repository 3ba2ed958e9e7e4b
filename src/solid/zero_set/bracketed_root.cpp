// SPDX-License-Identifier: Apache-2.0
//
// The steps are those of toms748_solve of Boost.Math, (C) Copyright John Maddock 2006, under the Boost Software
// License, Version 1.0: see NOTICE.
#include "solid/zero_set/bracketed_root.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

using RootSample = RootFinder::Sample;

constexpr double kRootEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kRootRounding = 2.0 * kRootEpsilon;

void check_bracket(double begin, double end, double value_at_begin, double value_at_end) {
    const bool has_signs =
        (value_at_begin <= 0.0 && value_at_end >= 0.0) || (value_at_begin >= 0.0 && value_at_end <= 0.0);
    if (!(begin <= end) || !has_signs) {
        std::ostringstream text;
        text << "the surface cannot be found between two places: the values there, " << value_at_begin << " and "
             << value_at_end << ", should be on different sides of 0";
        throw UnusableInput(Diagnostic{"zero_set.bracket", text.str()});
    }
}

bool have_same_sign(double a, double b) { return std::signbit(a) == std::signbit(b); }

/// a / b, or `otherwise` where that would overflow.
double safe_quotient(double a, double b, double otherwise) {
    const bool overflows = std::abs(b) < 1.0 && std::abs(b * std::numeric_limits<double>::max()) <= std::abs(a);
    return overflows ? otherwise : a / b;
}

/// Where the secant is zero; the middle if that is close to an end, for this is asked where other interpolations
/// failed.
double secant_zero(const RootSample& a, const RootSample& b) {
    constexpr double kClose = 5.0 * kRootEpsilon;
    const double c = a.place - a.value / (b.value - a.value) * (b.place - a.place);
    const bool is_inside = c > a.place + std::abs(a.place) * kClose && c < b.place - std::abs(b.place) * kClose;
    return is_inside ? c : (a.place + b.place) / 2.0;
}

/// Where the parabola through three samples is zero, after so many steps of Newton's method; else that of the secant.
double parabola_zero(const RootSample& a, const RootSample& b, const RootSample& d, int newton_steps) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    const double slope = safe_quotient(b.value - a.value, b.place - a.place, kLargest);
    const double next_slope = safe_quotient(d.value - b.value, d.place - b.place, kLargest);
    const double bend = safe_quotient(next_slope - slope, d.place - a.place, 0.0);
    if (bend == 0.0) {
        return secant_zero(a, b);
    }
    double c = have_same_sign(bend, a.value) ? a.place : b.place;
    for (int i = 0; i < newton_steps; ++i) {
        c -= safe_quotient(a.value + (slope + bend * (c - b.place)) * (c - a.place),
                           slope + bend * (2.0 * c - a.place - b.place), 1.0 + c - a.place);
    }
    return c <= a.place || c >= b.place ? secant_zero(a, b) : c;
}

/// The inverse cubic through four samples at zero, or the zero of a parabola where values are equal.
double cubic_zero(const RootSample& a, const RootSample& b, const RootSample& d, const RootSample& e,
                  int newton_steps) {
    constexpr double kEqual = 32.0 * std::numeric_limits<double>::min();
    const auto are_equal = [](const RootSample& p, const RootSample& q) {
        return std::abs(p.value - q.value) < kEqual;
    };
    if (are_equal(a, b) || are_equal(a, d) || are_equal(a, e) || are_equal(b, d) || are_equal(b, e) ||
        are_equal(d, e)) {
        return parabola_zero(a, b, d, newton_steps);
    }
    const double q11 = (d.place - e.place) * d.value / (e.value - d.value);
    const double q21 = (b.place - d.place) * b.value / (d.value - b.value);
    const double q31 = (a.place - b.place) * a.value / (b.value - a.value);
    const double d21 = (b.place - d.place) * d.value / (d.value - b.value);
    const double d31 = (a.place - b.place) * b.value / (b.value - a.value);
    const double q22 = (d21 - q11) * b.value / (e.value - b.value);
    const double q32 = (d31 - q21) * a.value / (d.value - a.value);
    const double d32 = (d31 - q21) * d.value / (d.value - a.value);
    const double q33 = (d32 - q22) * a.value / (e.value - a.value);
    const double c = q31 + q32 + q33 + a.place;
    return c <= a.place || c >= b.place ? parabola_zero(a, b, d, 3) : c;
}

/// Twice as far as the secant from the better end, at most to the middle.
double double_secant_place(const RootSample& a, const RootSample& b) {
    const RootSample& best = std::abs(a.value) < std::abs(b.value) ? a : b;
    const double c = best.place - 2.0 * (best.value / (b.value - a.value)) * (b.place - a.place);
    return std::abs(c - best.place) > (b.place - a.place) / 2.0 ? a.place + (b.place - a.place) / 2.0 : c;
}

/// A place between the ends, moved away from them by the rounding at least.
double kept_inside(double c, double a, double b) {
    if (b - a < 2.0 * kRootRounding * a) {
        return a + (b - a) / 2.0;
    }
    if (c <= a + std::abs(a) * kRootRounding) {
        return a + std::abs(a) * kRootRounding;
    }
    return c >= b - std::abs(b) * kRootRounding ? b - std::abs(b) * kRootRounding : c;
}

}  // namespace

RootFinder::RootFinder(double begin, double end, double value_at_begin, double value_at_end, double accuracy) {
    check_bracket(begin, end, value_at_begin, value_at_end);
    if (value_at_begin == 0.0 || value_at_end == 0.0) {
        finish(value_at_end == 0.0 ? end : begin);
        return;
    }
    // Steps are as long as the rounding of the place at least: so places are moved to where that is the accuracy.
    shift_ = accuracy > 0.0 ? accuracy / kRootRounding - begin : 0.0;
    a_ = {begin + shift_, value_at_begin};
    b_ = {end + shift_, value_at_end};
    width_ = std::max(accuracy, kRootRounding * std::max(std::abs(a_.place), std::abs(b_.place)));
    if (!(a_.place < b_.place)) {
        finish(0.5 * (begin + end));  // shorter than the accuracy
    } else if (is_narrow()) {
        finish(0.5 * (a_.place + b_.place) - shift_);
    } else {
        take(Step::kSecant);
    }
}

void RootFinder::finish(double root) {
    root_ = root;
    is_found_ = true;
}

void RootFinder::take(Step step) {
    step_ = step;
    double c = 0.0;
    switch (step) {
        case Step::kSecant:
            c = secant_zero(a_, b_);
            break;
        case Step::kQuadratic:
            c = parabola_zero(a_, b_, d_, 2);
            break;
        case Step::kCubic:
            width_of_round_ = b_.place - a_.place;
            c = cubic_zero(a_, b_, d_, e_, 2);
            break;
        case Step::kSecondCubic:
            c = cubic_zero(a_, b_, d_, e_, 3);
            break;
        case Step::kDoubleSecant:
            c = double_secant_place(a_, b_);
            break;
        case Step::kBisection:
            c = a_.place + (b_.place - a_.place) / 2.0;
            break;
    }
    if (step != Step::kSecondCubic) {
        e_ = d_;
    }
    next_ = kept_inside(c, a_.place, b_.place);
}

RootFinder::Step RootFinder::following() const {
    switch (step_) {
        case Step::kSecant:
            return Step::kQuadratic;
        case Step::kCubic:
            return Step::kSecondCubic;
        case Step::kSecondCubic:
            return Step::kDoubleSecant;
        case Step::kDoubleSecant:
            // Three steps should halve the bracket.
            return b_.place - a_.place < 0.5 * width_of_round_ ? Step::kCubic : Step::kBisection;
        case Step::kQuadratic:
        case Step::kBisection:
            break;
    }
    return Step::kCubic;
}

void RootFinder::tell(double value) {
    if (value == 0.0) {
        finish(place());
        return;
    }
    Sample& replaced = have_same_sign(a_.value, value) ? a_ : b_;
    d_ = replaced;
    replaced = {next_, value};
    if (--steps_left_ == 0 || is_narrow()) {
        finish(0.5 * (a_.place + b_.place) - shift_);
    } else {
        take(following());
    }
}

}  // namespace scaleaxis
