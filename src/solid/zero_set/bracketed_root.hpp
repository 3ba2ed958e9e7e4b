// SPDX-License-Identifier: Apache-2.0
/// \file
/// Zeros of functions of one variable, by bracketing.
#pragma once

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace scaleaxis::inline v1 {

/// Throws `UnusableInput` unless the values at the ends of an interval are on different sides of zero.
void check_bracket(double begin, double end, double value_at_begin, double value_at_end);

/// Where a function crosses zero between `begin` and `end`, to within `accuracy`, or to machine precision. The values
/// there are known, and either one of them is zero, or their signs differ.
/// \throws UnusableInput if that is not so
template <class Function>
double bracketed_root(const Function& function, double begin, double end, double value_at_begin, double value_at_end,
                      double accuracy = 0.0) {
    check_bracket(begin, end, value_at_begin, value_at_end);
    if (value_at_begin == 0.0 || value_at_end == 0.0) {
        return value_at_end == 0.0 ? end : begin;
    }
    // The solver goes in steps of the rounding of its variable at least: so this is moved to where that is the
    // accuracy.
    constexpr double kRounding = 2.0 * std::numeric_limits<double>::epsilon();
    const double shift = accuracy > 0.0 ? accuracy / kRounding - begin : 0.0;
    const double width = std::max(accuracy, kRounding * std::max(std::abs(begin + shift), std::abs(end + shift)));
    if (!(begin + shift < end + shift)) {
        return 0.5 * (begin + end);  // shorter than the accuracy
    }
    // The bracket is checked, so that the solver finds no fault; words for faults would take streams.
    using NoFaults =
        boost::math::policies::policy<boost::math::policies::domain_error<boost::math::policies::ignore_error>>;
    std::uintmax_t most_steps = 200;
    const auto is_found = [width](double a, double b) { return b - a <= width; };
    const auto [low, high] =
        boost::math::tools::toms748_solve([&](double t) { return function(t - shift); }, begin + shift, end + shift,
                                          value_at_begin, value_at_end, is_found, most_steps, NoFaults());
    return 0.5 * (low + high) - shift;
}

/// The same search with values that are told from outside, so that many searches can go on together: until
/// `is_found()`, `tell` the value at `place()`.
///
/// The solver calls its function and cannot be suspended, but a value of zero ends it at once. So each `tell` runs it
/// again on the values told so far, and it ends at the first place whose value is not known yet. A search takes about
/// seven values, each of which costs far more than these steps.
class RootFinder {
   public:
    RootFinder(double begin, double end, double value_at_begin, double value_at_end, double accuracy = 0.0);

    bool is_found() const { return is_found_; }
    double root() const { return root_; }

    /// Where the value is wanted.
    double place() const { return place_; }
    void tell(double value);

   private:
    void run();

    double begin_, end_, value_at_begin_, value_at_end_, accuracy_;
    std::vector<double> values_;  // told so far, in the order of the places
    double place_ = 0.0;
    double root_ = 0.0;
    bool is_found_ = false;
};

}  // namespace scaleaxis::inline v1
