// SPDX-License-Identifier: Apache-2.0
// Implicit functions as solids, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "complexes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;
using Function = std::function<double(const Point&)>;

double ball(const Point& p) { return norm(p) - 1.0; }
double torus(const Point& p) { return std::hypot(std::hypot(p.x, p.y) - 1.0, p.z) - 0.4; }

/// What `action` throws.
template <class Exception>
std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Exception& error) {
        return error.what();
    }
    return "nothing was thrown";
}

const Box kAround = centered_box(1.7, 1.8, 1.9);

TEST(FunctionSolid, CrossesWhereTheFunctionIsZero) {
    const auto solid = function_solid(ball, {.bounds = kAround});
    Random random(21);
    for (int i = 0; i < 2000; ++i) {
        const Point a = uniform(random, 0.0, 0.999) * random_direction(random);
        const Point b = uniform(random, 1.001, 20.0) * random_direction(random);
        // |a + t d| = 1
        const Point d = b - a;
        const double half = dot(a, d);
        const double t = (-half + std::sqrt(half * half + squared_norm(d) * (1.0 - squared_norm(a)))) / squared_norm(d);
        const std::optional<Point> crossing = solid->crossing(a, b, b);
        ASSERT_TRUE(crossing);
        // A chord that is nearly tangent magnifies rounding.
        EXPECT_LT(distance(*crossing, a + t * d), 1e-13 / std::abs(dot(*crossing, (1.0 / norm(d)) * d)));
        EXPECT_TRUE(solid->inside(a));
        EXPECT_FALSE(solid->inside(b));
        EXPECT_FALSE(solid->crossing(b, a, a));
        EXPECT_FALSE(solid->crossing(a, 0.5 * a, a));
    }
}

TEST(FunctionSolid, TakesTheFarthestOfAnOddNumberOfCrossings) {
    const auto solid = function_solid(torus, {.bounds = kAround});
    const std::optional<Point> far = solid->crossing({-1, 0, 0}, {3, 0, 0}, {-1.4, 0, 0});
    const std::optional<Point> near = solid->crossing({-1, 0, 0}, {3, 0, 0}, {1.0, 0, 0});
    ASSERT_TRUE(far && near);
    EXPECT_NEAR(far->x, 1.4, 1e-14);
    EXPECT_NEAR(near->x, -0.6, 1e-14);
    EXPECT_FALSE(solid->crossing({-1, 0, 0}, {1, 0, 0}, {}));  // an even number
}

// Values that are infinite, discontinuous or of any size only have to have the right sign.
TEST(FunctionSolid, NeedsNothingButTheSign) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const std::vector<Function> functions{
        [](const Point& p) { return ball(p) < 0.0 ? -kInfinity : kInfinity; },
        [](const Point& p) { return ball(p) < 0.0 ? -1.0 : 1e300; },
        [](const Point& p) { return 1e-300 * ball(p); },
        [](const Point& p) { return std::pow(ball(p), 9.0); },
        [](const Point& p) { return std::max(ball(p), 0.0); },  // nowhere negative: has no inside
    };
    for (std::size_t i = 0; i + 1 < functions.size(); ++i) {
        const auto solid = function_solid(functions[i], {.bounds = kAround});
        const std::optional<Point> crossing = solid->crossing({0, 0, 0}, {1, 2, 3}, {});
        ASSERT_TRUE(crossing) << i;
        EXPECT_NEAR(norm(*crossing), 1.0, 1e-12) << i;
    }
    EXPECT_THROW(function_solid(functions.back(), {.bounds = kAround}), UnusableInput);
}

TEST(FunctionSolid, SeedsLieOnTheSurfaceAndAreDense) {
    const double area = 4.0 * std::numbers::pi * std::numbers::pi * 0.4;
    // Where nothing but the sign is known, they are found all the same.
    const Function sign = [](const Point& p) { return torus(p) < 0.0 ? -1.0 : 1.0; };
    for (const Function& function : {Function(torus), sign}) {
        for (const double feature : {0.05, 0.2}) {
            const auto solid = function_solid(function, {.bounds = kAround, .smallest_feature = feature});
            for (const double spacing : {0.05, 0.3}) {
                const std::vector<Point> seeds = solid->seeds(spacing, 3, {});
                for (const Point& p : seeds) {
                    ASSERT_NEAR(torus(p), 0.0, 1e-13);
                }
                const double wanted = area / (spacing * spacing);
                EXPECT_GT(static_cast<double>(seeds.size()), 0.5 * wanted) << feature << ' ' << spacing;
                EXPECT_LT(static_cast<double>(seeds.size()), wanted + 200.0) << feature << ' ' << spacing;
                // No place is far from all of them.
                Random random(5);
                for (int i = 0; i < 300; ++i) {
                    const double u = uniform(random, 0.0, 6.3);
                    const double v = uniform(random, 0.0, 6.3);
                    const double ring = 1.0 + 0.4 * std::cos(v);
                    const Point p{ring * std::cos(u), ring * std::sin(u), 0.4 * std::sin(v)};
                    const bool has_near = std::any_of(seeds.begin(), seeds.end(),
                                                      [&](const Point& q) { return distance(p, q) < 1.5 * spacing; });
                    EXPECT_TRUE(has_near) << feature << ' ' << spacing;
                }
            }
        }
    }
}

// Far from the surface the lattice tells the side. Close to it an interpolant tells where to look.
TEST(FunctionSolid, AsksLittle) {
    std::int64_t calls = 0;
    const auto counted = [&](const Point& p) {
        ++calls;
        return torus(p);
    };
    const Execution execution{.threads = 1};
    const auto solid = function_solid(counted, {.bounds = kAround}, execution);
    calls = 0;
    EXPECT_TRUE(solid->inside({1.0, 0.0, 0.0}));
    EXPECT_FALSE(solid->inside({0.0, 0.0, 0.0}));
    EXPECT_EQ(calls, 0);
    EXPECT_TRUE(solid->crossing({1.0, 0.0, 0.0}, {1.7, 0.3, 0.2}, {}));
    EXPECT_LT(calls, 20);
    calls = 0;
    const Samples samples = sample(*solid, {.tolerance = 0.02, .sizing = Sizing::kUniform}, execution);
    EXPECT_LT(static_cast<double>(calls), 40.0 * static_cast<double>(samples.points.size()));
}

TEST(FunctionSolid, BoundsHoldTheSolidAndHardlyMore) {
    for (const double feature : {0.05, 0.3}) {
        const auto solid = function_solid(
            [](const Point& p) {
                return norm({p.x - 0.1, p.y, p.z / 1.5}) - 1.0;
            },
            {.bounds = kAround, .smallest_feature = feature});
        const Box box = solid->bounds();
        for (const auto& [low, high, least, most] :
             {std::array{box.min.x, box.max.x, -0.9, 1.1}, std::array{box.min.y, box.max.y, -1.0, 1.0},
              std::array{box.min.z, box.max.z, -1.5, 1.5}}) {
            EXPECT_LE(low, least);
            EXPECT_GE(low, least - 0.51 * feature);
            EXPECT_GE(high, most);
            EXPECT_LE(high, most + 0.51 * feature);
        }
    }
}

// Balls as small as the smallest feature, anywhere: each becomes a component.
TEST(FunctionSolid, FindsAllPartsThatAreLargeEnough) {
    constexpr double kFeature = 0.1;
    Random random(8);
    std::vector<Point> centers;
    while (centers.size() < 60) {
        const Point p = random_point(random, 1.5);
        if (std::none_of(centers.begin(), centers.end(), [&](const Point& q) { return distance(p, q) < 0.3; })) {
            centers.push_back(p);
        }
    }
    const auto solid = function_solid(
        [&](const Point& p) {
            double least = 10.0;
            for (const Point& center : centers) {
                least = std::min(least, distance(p, center) - kFeature);
            }
            return least;
        },
        {.bounds = kAround, .smallest_feature = kFeature});
    for (const double spacing : {0.03, 2.0}) {
        const std::vector<Point> seeds = solid->seeds(spacing, 1, {});
        for (const Point& center : centers) {
            EXPECT_TRUE(std::any_of(seeds.begin(), seeds.end(), [&](const Point& p) {
                return distance(p, center) < 1.01 * kFeature;
            })) << spacing;
        }
    }
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.01), .scales = {1.0}});
    EXPECT_EQ(axis.axes[0].medial_statistics.dual_complex.components, 60);
    EXPECT_EQ(axis.axes[0].medial_statistics.dual_complex.euler, 60);
}

TEST(FunctionSolid, HasTheTopologyOfTheSolid) {
    // A gyroid in a ball has handles, none of them much thinner than the others. The same function as the test's own
    // oracle, which looks for its boundary without any lattice, must lead to the same topology.
    const auto gyroid = [](const Point& p) {
        const double g = std::sin(4 * p.x) * std::cos(4 * p.y) + std::sin(4 * p.y) * std::cos(4 * p.z) +
                         std::sin(4 * p.z) * std::cos(4 * p.x);
        return std::max(g, 3.0 * (norm(p) - 1.2));
    };
    const auto shell = [](const Point& p) { return std::max(norm(p) - 1.0, 0.5 - norm(p)); };
    struct Case {
        Function function;
        double delta;
    };
    const ImplicitSolid box = box_solid({1.0, 0.7, 0.4});
    for (const auto& [function, delta] : {Case{ball, 0.05}, Case{torus, 0.03}, Case{shell, 0.05}, Case{gyroid, 0.01},
                                          Case{[&](const Point& p) { return box.value(p); }, 0.025}}) {
        const auto solid = function_solid(function, {.bounds = kAround});
        const ImplicitSolid truth(kAround, function);
        // The oracle knows no nearest points.
        const ScaleAxisOptions options{.delta = Length::relative(delta),
                                       .union_kind = UnionKind::kPolar,
                                       .scales = {1.0},
                                       .sizing = Sizing::kUniform};
        const ScaleAxis axis = scale_axis(*solid, options);
        const ScaleAxis expected =
            scale_axis(truth, {.delta = Length::absolute(axis.tolerance), .scales = {1.0}, .sizing = Sizing::kUniform});
        const Topology& dual = axis.axes[0].medial_statistics.dual_complex;
        EXPECT_EQ(dual, expected.axes[0].medial_statistics.dual_complex);
        EXPECT_TRUE(agree(dual, axis.axes[0].medial_statistics.medial_complex));
    }
}

TEST(FunctionSolid, IsTheSameForAnyNumberOfThreads) {
    const auto one = function_solid(torus, {.bounds = kAround}, {.threads = 1});
    const auto many = function_solid(torus, {.bounds = kAround}, {.threads = 4});
    EXPECT_EQ(one->bounds().min, many->bounds().min);
    EXPECT_EQ(one->seeds(0.05, 7, {.threads = 1}), many->seeds(0.05, 7, {.threads = 4}));
    EXPECT_NE(one->seeds(0.05, 7, {}), one->seeds(0.05, 8, {}));
}

TEST(FunctionSolid, TellsWhatIsWrong) {
    EXPECT_NE(message_of<UnusableInput>([] {
                  function_solid(ball, {.bounds = {{-2, -2, -2}, {2, 2, 0.5}}});
              }).find("bounds cut the solid at ("),
              std::string::npos);
    EXPECT_NE(message_of<UnusableInput>([] {
                  function_solid([](const Point& p) { return 2.0 + p.x; }, {.bounds = centered_box(1, 1, 1)});
              }).find("nowhere negative"),
              std::string::npos);
    EXPECT_NE(message_of<UnusableInput>([] {
                  function_solid([](const Point& p) { return std::sqrt(p.x); }, {.bounds = centered_box(1, 1, 1)});
              }).find("not a number at (-1, "),
              std::string::npos);
    EXPECT_THROW(function_solid(ball, {}), InvalidOption);
    EXPECT_THROW(function_solid(ball, {.bounds = {{1, 1, 1}, {-1, -1, -1}}}), InvalidOption);
    EXPECT_THROW(function_solid(ball, {.bounds = {{-2, -2, 0}, {2, 2, 0}}}), InvalidOption);
    EXPECT_THROW(function_solid(ball, {.bounds = kAround, .smallest_feature = -1.0}), InvalidOption);
    EXPECT_THROW(function_solid(ball, {.bounds = kAround, .smallest_feature = std::nan("")}), InvalidOption);
    EXPECT_THROW(function_solid(ball, {.bounds = kAround, .smallest_feature = 1e-9}), InvalidOption);
}

TEST(FunctionSolid, SuggestsTheOtherSign) {
    EXPECT_NE(message_of<UnusableInput>([] {
                  function_solid([](const Point& p) { return 1.0 - norm(p); }, {.bounds = kAround});
              }).find("change its sign"),
              std::string::npos);
    EXPECT_EQ(message_of<UnusableInput>([] {
                  function_solid(ball, {.bounds = {{-2, -2, -2}, {2, 2, 0.5}}});
              }).find("change its sign"),
              std::string::npos);
}

TEST(FunctionSolid, IsClosedByItsBounds) {
    const Box bounds{{-2, -2, -2}, {2, 2, 0.5}};
    std::atomic<bool> was_asked_outside = false;
    const auto asked = [&](const Point& p) {
        was_asked_outside = was_asked_outside || !bounds.contains(p);
        return ball(p);
    };
    const auto solid = function_solid(asked, {.bounds = bounds, .is_clipped = true});
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const auto coordinate = [&](std::uint64_t k) { return 4.0 * random_unit(31, i, k) - 2.0; };
        const Point p{coordinate(0), coordinate(1), coordinate(2)};
        EXPECT_EQ(solid->inside(p), ball(p) < 0.0 && p.z < 0.5) << p.x << ' ' << p.y << ' ' << p.z;
    }
    const auto top = solid->crossing({0.1, 0.1, 0.2}, {0.1, 0.1, 1.9}, {0.1, 0.1, 0.2});
    ASSERT_TRUE(top);
    EXPECT_NEAR(top->z, 0.5, 1e-12);
    EXPECT_FALSE(was_asked_outside);
    ScaleAxisOptions options;
    options.delta = Length::relative(0.03);
    EXPECT_TRUE(agree(scale_axis(*solid, options).axes[0].medial_statistics.dual_complex, known_topology(1, 0, 0)));
    // A solid that ends within the bounds is the same.
    const auto whole = function_solid(ball, {.bounds = kAround, .is_clipped = true});
    EXPECT_TRUE(whole->inside({0.0, 0.0, 0.9}));
    EXPECT_FALSE(whole->inside({0.0, 0.0, 1.1}));
}

TEST(FunctionSolid, ADistanceIsAskedAtFewPlaces) {
    std::atomic<int> calls = 0;
    const auto asked = [&](const Point& p) {
        ++calls;
        return std::max(norm(p) - 1.0, 0.4 - norm(p - Point{0.3, 0, 0}));  // a ball with a void
    };
    const auto samples_of = [&](bool is_distance) {
        calls = 0;
        const auto solid = function_solid(
            asked, {.bounds = kAround, .smallest_feature = 0.02, .is_distance = is_distance}, {.threads = 1});
        const int to_find = calls;
        return std::pair(sample(*solid, {.tolerance = 0.1, .sizing = Sizing::kUniform}).points, to_find);
    };
    const auto [points, all] = samples_of(false);
    const auto [same_points, few] = samples_of(true);
    EXPECT_EQ(points, same_points);
    EXPECT_LT(few, all / 2);
}

// Functions that give many values at a time.

/// A function of this kind, and what it is asked.
struct Batches {
    explicit Batches(Function function) : value(std::move(function)) {}

    std::function<void(std::span<const Point>, std::span<double>)> function() {
        return [this](std::span<const Point> points, std::span<double> values) {
            EXPECT_EQ(++running, 1) << "two calls at a time";
            EXPECT_EQ(points.size(), values.size());
            EXPECT_GT(points.size(), 0U);
            ++calls;
            places += static_cast<std::int64_t>(points.size());
            most = std::max(most, points.size());
            std::ranges::transform(points, values.begin(), value);
            --running;
        };
    }

    Function value;
    std::atomic<int> running = 0;
    std::int64_t calls = 0;
    std::int64_t places = 0;
    std::size_t most = 0;
};

bool same(const Samples& a, const Samples& b) {
    return same_bytes(a.points, b.points) && same_bytes(a.tetrahedra, b.tetrahedra) && same_bytes(a.inside, b.inside);
}

TEST(BatchedFunction, GivesTheSameSolidAsOnePointAtATime) {
    const auto sign = [](const Point& p) { return torus(p) < 0.0 ? -1.0 : 1.0; };
    for (const Function& function : {Function(torus), Function(sign)}) {
        for (const double feature : {0.0, 0.3}) {
            std::atomic<std::int64_t> places = 0;
            const auto counted = [&](const Point& p) {
                ++places;
                return function(p);
            };
            const FunctionOptions options{.bounds = kAround, .smallest_feature = feature};
            const auto expected = function_solid(counted, options);
            const Samples expected_samples = sample(*expected, {.tolerance = 0.06, .sizing = Sizing::kUniform});
            for (const int threads : {1, 4}) {
                Batches batches(function);
                const auto solid = function_solid(batches.function(), options, {.threads = threads});
                EXPECT_EQ(solid->bounds().min, expected->bounds().min);
                EXPECT_EQ(solid->bounds().max, expected->bounds().max);
                const Samples samples =
                    sample(*solid, {.tolerance = 0.06, .sizing = Sizing::kUniform}, {.threads = threads});
                EXPECT_TRUE(same(samples, expected_samples)) << feature << ", " << threads << " threads";
                EXPECT_EQ(batches.places, places);
            }
        }
    }
}

TEST(BatchedFunction, IsAskedForManyPlacesAtATime) {
    Batches batches(torus);
    const auto solid = function_solid(batches.function(), {.bounds = kAround});
    EXPECT_GT(batches.places / batches.calls, 1000);
    EXPECT_LE(batches.most, 16384U);
    batches.calls = batches.places = 0;
    const std::vector<Point> seeds = solid->seeds(0.02, 1, {});
    EXPECT_GT(batches.places / batches.calls, 500);
    batches.calls = batches.places = 0;
    const Samples samples = sample(*solid, {.tolerance = 0.02, .sizing = Sizing::kUniform});
    EXPECT_GT(batches.places / batches.calls, 500) << batches.places;
    // A single question.
    batches.calls = batches.places = 0;
    EXPECT_TRUE(solid->crossing({1.0, 0.0, 0.0}, {1.7, 0.3, 0.2}, {}));
    EXPECT_LT(batches.places, 20);
}

TEST(BatchedFunction, PassesErrorsOn) {
    int calls = 0;
    const auto failing = [&](std::span<const Point>, std::span<double>) {
        if (++calls == 3) {
            throw std::runtime_error("the device is gone");
        }
    };
    EXPECT_EQ(message_of<std::runtime_error>([&] { function_solid(failing, {.bounds = kAround}); }),
              "the device is gone");
    const auto no_number = [](std::span<const Point> points, std::span<double> values) {
        std::ranges::transform(points, values.begin(), [](const Point& p) { return std::sqrt(p.x); });
    };
    EXPECT_NE(message_of<UnusableInput>([&] { function_solid(no_number, {.bounds = kAround}); }).find("not a number"),
              std::string::npos);
}

TEST(BatchedFunction, IsCancelledBetweenCalls) {
    for (const int calls_before : {1, 40, 200}) {
        std::stop_source stop;
        Batches batches(torus);
        int calls_after = 0;
        const auto function = [&, asked = batches.function()](std::span<const Point> points, std::span<double> values) {
            calls_after += stop.stop_requested() ? 1 : 0;
            asked(points, values);
            if (batches.calls == calls_before) {
                stop.request_stop();
            }
        };
        const Execution execution{.threads = 2, .cancel = stop.get_token()};
        EXPECT_THROW(sample(*function_solid(function, {.bounds = kAround}, execution),
                            {.tolerance = 0.005, .sizing = Sizing::kUniform}, execution),
                     Cancelled);
        EXPECT_EQ(calls_after, 0) << calls_before;
    }
}

}  // namespace
}  // namespace scaleaxis
