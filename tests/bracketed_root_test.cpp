// SPDX-License-Identifier: Apache-2.0
#include "solid/zero_set/bracketed_root.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

TEST(BracketedRoot, IsFoundToTheAccuracy) {
    const auto function = [](double t) { return t * t - 2.0; };
    EXPECT_NEAR(bracketed_root(function, 0.0, 2.0, -2.0, 2.0), std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(bracketed_root(function, 0.0, 2.0, -2.0, 2.0, 1e-3), std::sqrt(2.0), 1e-3);
    EXPECT_EQ(bracketed_root(function, 0.0, std::sqrt(2.0), -2.0, 0.0), std::sqrt(2.0));
}

TEST(BracketedRoot, OfAnIntervalShorterThanTheAccuracyLiesInIt) {
    const double begin = 0.25;
    const auto step = [](double t) { return t <= 0.25 ? -1.0 : 1.0; };
    for (const double accuracy : {1e-3, 1e-5, 0.0}) {
        for (const double length : {1e-6 * accuracy, 1e-3 * accuracy, 1e-16}) {
            const double end = std::max(begin + length, std::nextafter(begin, 1.0));
            const double root = bracketed_root(step, begin, end, -1.0, 1.0, accuracy);
            EXPECT_NEAR(root, begin, std::max(accuracy, 1e-15)) << accuracy << ' ' << length;
        }
    }
}

/// The places that Boost's solver asks for, and at the end the root. Its steps are not shorter than the rounding of the
/// place, so that places are moved for a larger accuracy.
template <class Function>
std::vector<double> steps_of_boost(const Function& function, double begin, double end, double accuracy) {
    constexpr double kRounding = 2.0 * std::numeric_limits<double>::epsilon();
    const double shift = accuracy > 0.0 ? accuracy / kRounding - begin : 0.0;
    const double width = std::max(accuracy, kRounding * std::max(std::abs(begin + shift), std::abs(end + shift)));
    std::vector<double> steps;
    const auto noted = [&](double t) {
        steps.push_back(t - shift);
        return function(t - shift);
    };
    std::uintmax_t most_steps = 200;
    const auto [low, high] = boost::math::tools::toms748_solve(
        noted, begin + shift, end + shift, function(begin), function(end),
        [width](double a, double b) { return b - a <= width; }, most_steps);
    steps.push_back(0.5 * (low + high) - shift);
    return steps;
}

TEST(RootFinder, TakesTheStepsOfBoost) {
    Random random(4);
    int count = 0;
    int smooth_count = 0;
    std::size_t smooth_steps = 0;
    for (int i = 0; i < 60000; ++i) {
        const std::array<double, 4> c{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1),
                                      uniform(random, -1, 1)};
        const auto cubic = [&](double x) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); };
        const std::vector<std::function<double(double)>> functions{
            cubic,
            [&](double x) { return cubic(x) < 0.0 ? -1e100 : 1e100; },
            [&](double x) { return cubic(x) < 0.0 ? -1.0 : 1e-300; },
            [&](double x) { return 1e-300 * cubic(x); },
            [&](double x) { return std::pow(cubic(x), 9.0); },
            [&](double x) { return std::sin(20.0 * cubic(x)); },
            [&](double x) { return std::exp(30.0 * cubic(x)) - 1.0; },
            [&](double x) { return 0.125 * std::floor(8.0 * cubic(x)); },
        };
        const auto& function = functions[i % functions.size()];
        const double begin = uniform(random, -2.0, 2.0);
        const double end = begin + uniform(random, 0.01, 2.0);
        const double at_begin = function(begin);
        const double at_end = function(end);
        if (at_begin == 0.0 || at_end == 0.0 || (at_begin < 0.0) == (at_end < 0.0)) {
            continue;
        }
        ++count;
        const double accuracy = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1e-6 : 1e-3;
        RootFinder finder(begin, end, at_begin, at_end, accuracy);
        std::vector<double> steps;
        while (!finder.is_found()) {
            steps.push_back(finder.place());
            finder.tell(function(finder.place()));
        }
        steps.push_back(finder.root());
        ASSERT_EQ(steps, steps_of_boost(function, begin, end, accuracy)) << i;
        ASSERT_EQ(bracketed_root(function, begin, end, at_begin, at_end, accuracy), finder.root());
        if (i % functions.size() == 0 && accuracy > 0.0) {
            ++smooth_count;
            smooth_steps += steps.size() - 1;
        }
    }
    EXPECT_GT(count, 10000);
    EXPECT_LT(static_cast<double>(smooth_steps), 7.0 * smooth_count);
}

TEST(BracketedRoot, TakesAnIntervalThatIsSmallerThanTheAccuracy) {
    const auto identity = [](double x) { return x; };
    for (const double accuracy : {1.0, 1e-3}) {
        EXPECT_NEAR(bracketed_root(identity, -1e-20, 1e-20, -1e-20, 1e-20, accuracy), 0.0, accuracy);
    }
    EXPECT_EQ(bracketed_root(identity, 0.0, 1.0, 0.0, 1.0), 0.0);
    EXPECT_EQ(bracketed_root(identity, -1.0, 0.0, -1.0, 0.0), 0.0);
}

TEST(BracketedRoot, RejectsWhatIsNoBracketInItsOwnWords) {
    const auto constant = [](double) { return 1.0; };
    for (const double at_begin : {1.0, std::nan("")}) {
        try {
            bracketed_root(constant, 0.0, 1.0, at_begin, 2.0);
            ADD_FAILURE() << "taken for a bracket";
        } catch (const UnusableInput& error) {
            EXPECT_NE(std::string(error.what()).find("different sides of 0"), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace scaleaxis
