// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace scaleaxis {

/// Where a function crosses zero between `begin` and `end`, to within `accuracy`, or machine precision. Its values
/// there are known, and either one of them is zero, or their signs differ.
template <class Function>
double bracketed_root(const Function& function, double begin, double end, double value_at_begin, double value_at_end,
                      double accuracy = 0.0) {
    if (value_at_begin == 0.0 || value_at_end == 0.0) {
        return value_at_end == 0.0 ? end : begin;
    }
    // The solver goes in steps of the rounding of its variable at least: so this is moved to where that is the
    // accuracy.
    constexpr double kRounding = 2.0 * std::numeric_limits<double>::epsilon();
    const double shift = accuracy > 0.0 ? accuracy / kRounding - begin : 0.0;
    const double width = std::max(accuracy, kRounding * std::max(std::abs(begin + shift), std::abs(end + shift)));
    std::uintmax_t most_steps = 200;
    const auto is_found = [width](double a, double b) { return b - a <= width; };
    const auto [low, high] =
        boost::math::tools::toms748_solve([&](double t) { return function(t - shift); }, begin + shift, end + shift,
                                          value_at_begin, value_at_end, is_found, most_steps);
    return 0.5 * (low + high) - shift;
}

}  // namespace scaleaxis
