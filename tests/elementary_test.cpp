// SPDX-License-Identifier: Apache-2.0
// Angles, powers and logarithms that are the same on all platforms, compared with those of the C library.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "base/angles.hpp"
#include "base/powers.hpp"

namespace scaleaxis {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Over numbers in [low, high]. \param most error, of the larger of the value and `scale`
void expect_near(const std::function<double(double)>& own, const std::function<double(double)>& known, double low,
                 double high, double most = 2e-15, double scale = 0.0) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> number(low, high);
    for (int i = 0; i < 20'000; ++i) {
        const double x = number(random);
        ASSERT_NEAR(own(x), known(x), most * std::max(scale, std::abs(known(x)))) << "of " << x;
    }
}

TEST(Elementary, AnglesAreThoseOfTheCLibrary) {
    const auto sine = [](double x) { return at_angle(x)[1]; };
    expect_near(
        cosine_of, [](double x) { return std::cos(x); }, -10.0, 10.0, 1e-15, 1.0);
    expect_near(
        sine, [](double x) { return std::sin(x); }, -1e4, 1e4, 1e-15, 1.0);
    expect_near(
        sine, [](double x) { return std::sin(x); }, -1e-3, 1e-3);
    expect_near(
        cosine_of_degrees, [](double x) { return std::cos(x * std::numbers::pi / 180.0); }, -360.0, 360.0, 1e-15, 2.0);
    for (const double x : {-1.0, -1e-9, 1e-9, 0.3, 1.0}) {
        const auto own = [=](double y) { return signed_angle_of(x, y); };
        expect_near(
            own, [=](double y) { return std::atan2(y, x); }, -2.0, 2.0);
    }
    EXPECT_EQ(cosine_of_degrees(90.0), 0.0);
    EXPECT_EQ(cosine_of_degrees(180.0), -1.0);
    EXPECT_TRUE(std::isnan(cosine_of(kInf)));
    EXPECT_LE(std::abs(cosine_of(1e300)), 1.0);
}

TEST(Elementary, PowersAreThoseOfTheCLibrary) {
    expect_near(
        exponential, [](double x) { return std::exp(x); }, -700.0, 700.0);
    expect_near(
        exponential, [](double x) { return std::exp(x); }, -1.0, 1.0);
    for (const double most : {2.0, 1e-300, 1e300}) {
        expect_near(
            logarithm, [](double x) { return std::log(x); }, 0.5 * most, most);
        expect_near(
            cube_root, [](double x) { return std::cbrt(x); }, -most, most);
    }
    for (const double exponent : {-7.0, 0.0, 1.0, 2.0, 3.0, 64.0, 65.0, 77.0}) {
        const auto own = [=](double x) { return power(x, exponent); };
        expect_near(
            own, [=](double x) { return std::pow(x, exponent); }, -3.0, 3.0, 1e-13);
    }
    const auto own = [](double x) { return power(x, 2.5); };
    expect_near(
        own, [](double x) { return std::pow(x, 2.5); }, 0.0, 1e3, 1e-14);
    EXPECT_EQ(exponential(1000.0), kInf);
    EXPECT_EQ(exponential(-1000.0), 0.0);
    EXPECT_EQ(logarithm(0.0), -kInf);
    EXPECT_TRUE(std::isnan(logarithm(-1.0)));
    EXPECT_TRUE(std::isnan(power(-2.0, 0.5)));
    EXPECT_EQ(power(0.0, 0.5), 0.0);
}

}  // namespace
}  // namespace scaleaxis
