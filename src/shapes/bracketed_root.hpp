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
    // Closer numbers than this there are hardly any.
    const double width =
        std::max(accuracy, 2.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(begin), std::abs(end)));
    std::uintmax_t most_steps = 200;
    const auto is_found = [width](double a, double b) { return b - a <= width; };
    const auto [low, high] =
        boost::math::tools::toms748_solve(function, begin, end, value_at_begin, value_at_end, is_found, most_steps);
    return 0.5 * (low + high);
}

}  // namespace scaleaxis
