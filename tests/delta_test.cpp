// SPDX-License-Identifier: Apache-2.0
//
// Is the tolerance fine enough for the solid? Its choice, and warnings of parts that are thin for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "executions.hpp"
#include "images.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using namespace test;

// The choice.

/// Its holes are lost at the coarser tolerances of the range.
ImplicitSolid holed() { return holed_solid(0.25); }

/// Its cavity is lost at the coarser tolerances.
std::unique_ptr<Solid> shell() {
    return mesh_solid(together(ball_mesh(1.0, 30), turned_inside_out(ball_mesh(0.9, 30))));
}

constexpr DeltaRange deltas(double coarsest, double finest) {
    return {Length::relative(coarsest), Length::relative(finest)};
}

constexpr DeltaRange kRange = deltas(0.2, 0.03);

std::optional<Diagnostic> warning_of(const SampledUnion& made, const std::string& code) {
    const std::vector<Diagnostic>& warnings = made.balls.warnings;
    const auto found = std::ranges::find(warnings, code, &Diagnostic::code);
    return found == warnings.end() ? std::nullopt : std::optional(*found);
}

TEST(DeltaChoice, IsTheCoarsestThatMeetsTheRequirements) {
    const std::unique_ptr<Solid> mesh = shell();
    const ImplicitSolid polar = holed();
    for (const Solid* solid : {static_cast<const Solid*>(mesh.get()), static_cast<const Solid*>(&polar)}) {
        const ChosenUnion result = choose_delta(*solid, kRange);
        const auto& [range, attempts, chosen] = result.choice;
        ASSERT_GT(attempts.size(), 1U) << "the case is too easy";
        EXPECT_EQ(chosen, attempts.size() - 1);
        for (std::size_t i = 0; i < attempts.size(); ++i) {
            EXPECT_NEAR(attempts[i].delta, kRange.coarsest.value() * std::pow(0.5, 0.5 * static_cast<double>(i)),
                        1e-12);
            EXPECT_EQ(attempts[i].fault.empty(), i == chosen) << attempts[i].fault.message;
            // As each of them alone.
            const double tolerance = tolerance_of(Length::relative(attempts[i].delta), solid->bounds().diagonal());
            EXPECT_EQ(attempts[i].tolerance, tolerance);
            if (attempts[i].balls == 0) {
                EXPECT_EQ(attempts[i].fault.code, "balls.none");
                continue;
            }
            EXPECT_EQ(attempts[i].fault.code, i == chosen ? "" : "delta.topology");
            if (i == chosen) {  // alone, coarser ones may get more samples in thin parts
                const SampledUnion alone = sampled_union(*solid, {.tolerance = tolerance});
                EXPECT_EQ(static_cast<Index>(alone.samples.points.size()), attempts[i].samples);
                EXPECT_EQ(alone.balls.balls, result.chosen.balls.balls);
                EXPECT_EQ(alone.samples.points, result.chosen.samples.points);
            }
        }
        EXPECT_NE(attempts[chosen - 1].balls, 0);
        EXPECT_EQ(attempts[chosen].balls_topology, solid->topology());
        EXPECT_LE(attempts[chosen].largest_distance, attempts[chosen].tolerance);
        EXPECT_FALSE(warning_of(result.chosen, "axis.delta_choice").has_value());
    }
}

TEST(DeltaChoice, HasTheUnionCloseToTheSamples) {
    // The bar is too thin for balls: topology does not tell that it is lost.
    const ImplicitSolid solid(
        {{-1, -1, -1}, {3, 1, 1}},
        [](const Point& p) {
            const double bar = std::max({std::abs(p.z) - 0.05, std::abs(p.y) - 0.05, std::abs(p.x - 1.5) - 1.5});
            return std::min(norm(p) - 1.0, bar);
        },
        known_topology(1, 0, 0));
    const ChosenUnion result = choose_delta(solid, deltas(0.1, 0.1));
    EXPECT_EQ(result.choice.attempts[0].fault.code, "delta.distance");
    EXPECT_GT(result.choice.attempts[0].largest_distance, result.choice.attempts[0].tolerance);
}

TEST(DeltaChoice, OfUnknownTopologyIsConfirmedByTheNextOne) {
    const ImplicitSolid known = holed();
    const ImplicitSolid unknown(known.bounds(), known.function());
    const ChosenUnion result = choose_delta(unknown, kRange);
    const auto& [range, attempts, chosen] = result.choice;
    ASSERT_EQ(attempts.size(), chosen + 2);
    EXPECT_TRUE(attempts[0].fault.code == "delta.unconfirmed" || attempts[0].fault.code == "delta.topology");
    EXPECT_EQ(attempts[chosen].balls_topology, known.topology());
    EXPECT_EQ(attempts[chosen + 1].balls_topology, known.topology());
    EXPECT_EQ(result.chosen.samples.tolerance, attempts[chosen].tolerance);
    EXPECT_TRUE(result.chosen.balls.warnings.empty());
    // Nothing confirms the finest one.
    const ChosenUnion last = choose_delta(unknown, deltas(attempts[chosen].delta, attempts[chosen].delta));
    EXPECT_EQ(last.choice.attempts[0].fault.code, "delta.unconfirmed");
    ASSERT_EQ(last.chosen.balls.warnings.size(), 1U);
    EXPECT_EQ(last.chosen.balls.warnings[0].code, "axis.delta_choice");
}

TEST(DeltaChoice, IsTheFinestWhereNoneMeetsTheRequirements) {
    const ImplicitSolid known = holed();
    const ImplicitSolid wrong(known.bounds(), known.function(), known_topology(7, 0, 0));
    const ChosenUnion result = choose_delta(wrong, deltas(0.15, 0.06));
    const auto& [range, attempts, chosen] = result.choice;
    EXPECT_EQ(attempts.size(), 4U);  // 0.15, 0.106, 0.075, 0.06
    EXPECT_EQ(chosen, 3U);
    EXPECT_EQ(attempts[chosen].delta, 0.06);
    ASSERT_EQ(result.chosen.balls.warnings.size(), 1U);
    const Diagnostic& warning = result.chosen.balls.warnings[0];
    EXPECT_EQ(warning.code, "axis.delta_choice");
    EXPECT_NE(warning.message.find("7 components"), std::string::npos) << warning.message;
}

TEST(DeltaChoice, PassesOverTolerancesWithoutBalls) {
    const SamplingOptions uniform{.sizing = Sizing::kUniform};
    const ChosenUnion result = choose_delta(holed(), deltas(0.4, 0.05), uniform);
    EXPECT_EQ(result.choice.attempts[0].balls, 0);
    EXPECT_TRUE(result.choice.attempts[result.choice.chosen].fault.empty());
    EXPECT_THROW(choose_delta(holed(), deltas(0.4, 0.4), uniform), UnusableInput);
    EXPECT_GT(choose_delta(holed(), deltas(0.4, 0.4)).choice.attempts[0].balls, 0) << "sizes suit the solid";
}

TEST(DeltaChoice, IsThatOfThePipeline) {
    const std::unique_ptr<Solid> solid = shell();
    const ScaleAxis chosen = scale_axis(*solid, {.delta_range = kRange, .scales = {1.0, 1.05}});
    ASSERT_TRUE(chosen.delta_choice.has_value());
    const double delta = chosen.delta_choice->attempts[chosen.delta_choice->chosen].delta;
    const ScaleAxis given = scale_axis(*solid, {.delta = Length::relative(delta), .scales = {1.0, 1.05}});
    EXPECT_FALSE(given.delta_choice.has_value());
    EXPECT_EQ(chosen.tolerance, given.tolerance);
    EXPECT_EQ(chosen.samples, given.samples);
    EXPECT_EQ(chosen.balls, given.balls);
    EXPECT_EQ(chosen.solid_topology, given.solid_topology);
    for (int i : {0, 1}) {
        EXPECT_EQ(chosen.axes[i].complex.vertices, given.axes[i].complex.vertices);
    }
    ASSERT_EQ(chosen.costs.size(), given.costs.size() + 1);
    EXPECT_EQ(chosen.costs[0].stage, "other deltas");
    EXPECT_GT(chosen.costs[0].seconds, 0.0);
}

TEST(DeltaChoice, IsTheSameForAnyNumberOfThreads) {
    const std::unique_ptr<Solid> solid = shell();
    const ChosenUnion one = choose_delta(*solid, kRange, {}, {}, {1});
    const ChosenUnion two = choose_delta(*solid, kRange, {}, {}, {2});
    EXPECT_EQ(one.choice.chosen, two.choice.chosen);
    EXPECT_EQ(one.chosen.balls.balls, two.chosen.balls.balls);
    for (std::size_t i = 0; i < one.choice.attempts.size(); ++i) {
        EXPECT_EQ(one.choice.attempts[i].largest_distance, two.choice.attempts[i].largest_distance);
        EXPECT_EQ(one.choice.attempts[i].fault.message, two.choice.attempts[i].fault.message);
    }
}

TEST(DeltaChoice, ReportsProgressAndCanBeCancelled) {
    const std::unique_ptr<Solid> solid = shell();
    expect_progress_and_cancellation(
        [&](const Execution& execution) { choose_delta(*solid, kRange, {}, {}, execution); });
    expect_progress_and_cancellation(
        [&](const Execution& execution) { scale_axis(*solid, {.delta_range = kRange}, execution); });
}

TEST(DeltaChoice, AnAbsoluteRangeIsTheSameInUnitsOfTheSolid) {
    const ImplicitSolid solid = holed();
    const double diagonal = solid.bounds().diagonal();
    const DeltaRange absolute{Length::absolute(kRange.coarsest.of(diagonal)), kRange.finest};
    const DeltaChoice expected = choose_delta(solid, kRange).choice;
    const DeltaChoice choice = choose_delta(solid, absolute).choice;
    EXPECT_EQ(choice.chosen, expected.chosen);
    EXPECT_NEAR(choice.attempts[choice.chosen].delta, expected.attempts[expected.chosen].delta, 1e-12);
}

TEST(DeltaChoice, RefusesWhatIsNoRange) {
    const ImplicitSolid solid = holed();
    for (const auto& [coarsest, finest] :
         std::vector<std::pair<double, double>>{{0.01, 0.02}, {0.6, 0.1}, {0.1, 1e-6}, {std::nan(""), 0.1}}) {
        const double diagonal = solid.bounds().diagonal();
        EXPECT_THROW(choose_delta(solid, {Length::absolute(coarsest * diagonal), Length::absolute(finest * diagonal)}),
                     InvalidOption);
        EXPECT_THROW(choose_delta(solid, deltas(coarsest, finest)), InvalidOption);
        EXPECT_THROW(scale_axis(solid, {.delta_range = deltas(coarsest, finest)}), InvalidOption);
        EXPECT_THROW(validate(ScaleAxisOptions{.delta_range = deltas(coarsest, finest)}), InvalidOption);
    }
    EXPECT_THROW(scale_axis(solid, {.delta = Length::relative(0.1), .delta_range = kRange}), InvalidOption);
    EXPECT_THROW(scale_axis(sample(solid, {.tolerance = 0.3}), {.delta_range = kRange}), InvalidOption);
}

// Thin parts.

std::optional<Diagnostic> warning_of_thin_part(const Solid& solid, double tolerance) {
    return warning_of(sampled_union(solid, {.tolerance = tolerance}), "axis.thin_part");
}

TEST(ThinPart, IsAPlateThatIsThinForTheSamples) {
    const auto plate = mesh_solid(box_mesh({0, 0, 0}, {0.8, 0.6, 0.05}));
    const SampledUnion made = sampled_union(*plate, {.tolerance = 0.05});
    const std::optional<ThinPart> thin = made.balls.fit->thin_part;
    ASSERT_TRUE(thin.has_value());
    EXPECT_NEAR(thin->thickness, 0.05, 0.001);
    EXPECT_NEAR(thin->place.z, 0.025, 0.001);
    EXPECT_FALSE(thin->is_gap);
    const std::optional<Diagnostic> warning = warning_of_thin_part(*plate, 0.05);
    ASSERT_TRUE(warning.has_value());
    EXPECT_EQ(warning->place, thin->place);
    ASSERT_EQ(warning->hints.size(), 1U);
    EXPECT_EQ(warning->hints[0].option, "delta-abs");
    EXPECT_EQ(warning->hints[0].value.substr(0, 5), "0.024");
    EXPECT_TRUE(warning_of_thin_part(*plate, 0.028).has_value());
    EXPECT_FALSE(warning_of_thin_part(*plate, 0.024).has_value());
}

/// A blade: the convex hull of a rectangle and an edge.
TriangleMesh wedge_mesh(double length, double depth, double thickness) {
    const double t = 0.5 * thickness;
    return {{{0, 0, -t}, {0, 0, t}, {depth, 0, 0}, {0, length, -t}, {0, length, t}, {depth, length, 0}},
            {{0, 1, 4}, {0, 4, 3}, {0, 5, 2}, {0, 3, 5}, {1, 2, 5}, {1, 5, 4}, {0, 2, 1}, {3, 4, 5}}};
}

TEST(ThinPart, IsNoEdgeAndNoTip) {
    const std::vector<std::pair<std::string, TriangleMesh>> solids{
        {"box", box_mesh({0, 0, 0}, {1, 0.7, 0.4})},
        {"ball", ball_mesh(1.0, 30)},
        {"blade", wedge_mesh(1.0, 1.0, 0.4)},
        {"needle", revolved({{0.0, -1.0}, {0.3, -1.0}, {0.0, 1.0}}, 24)}};
    for (const auto& [name, mesh] : solids) {
        SCOPED_TRACE(name);
        const auto solid = mesh_solid(repair(mesh).mesh);
        EXPECT_FALSE(warning_of_thin_part(*solid, 0.02 * solid->bounds().diagonal()).has_value());
    }
}

// Parts much thinner than the tolerance.

/// A tube around a helix of three turns that no two samples of this tolerance fit across.
TriangleMesh thin_helix(double radius, int corners) {
    TriangleMesh mesh;
    constexpr int kPlaces = 200;
    for (int i = 0; i <= kPlaces; ++i) {
        const double t = 6.0 * std::numbers::pi * i / kPlaces;
        const Point center{std::cos(t), std::sin(t), 0.2 * t};
        const Point along = unit({-std::sin(t), std::cos(t), 0.2});
        const Point out{std::cos(t), std::sin(t), 0.0};
        const Point up = cross(along, out);
        for (int k = 0; k < corners; ++k) {
            const double u = 2.0 * std::numbers::pi * k / corners;
            mesh.vertices.push_back(center + (radius * std::cos(u)) * out + (radius * std::sin(u)) * up);
        }
    }
    const auto id = [&](int i, int k) { return static_cast<Index>(i * corners + k % corners); };
    for (int k = 0; k < corners; ++k) {
        for (int i = 0; i < kPlaces; ++i) {
            mesh.triangles.push_back({id(i, k), id(i + 1, k + 1), id(i + 1, k)});
            mesh.triangles.push_back({id(i, k), id(i, k + 1), id(i + 1, k + 1)});
        }
        if (k > 0 && k + 1 < corners) {
            mesh.triangles.push_back({id(0, 0), id(0, k + 1), id(0, k)});
            mesh.triangles.push_back({id(kPlaces, 0), id(kPlaces, k), id(kPlaces, k + 1)});
        }
    }
    return mesh;
}

TEST(ThinPart, MuchThinnerThanDeltaGetsMoreSamples) {
    struct Thin {
        std::string name;
        TriangleMesh mesh;
        double tolerance;
        double thickness;
    };
    const std::vector<Thin> solids{
        {"plate", box_mesh({0, 0, 0}, {10, 10, 0.25}), 0.7, 0.25},
        // A thin plate on a block: samples of the block stay as far apart as they are.
        {"fin", prism({{0, 0}, {10, 0}, {10, 0.15}, {4, 0.15}, {4, 4}, {0, 4}}, 10.0), 0.7, 0.15},
        {"helix without a ball", thin_helix(0.02, 5), 0.12, 0.04},
    };
    for (const auto& [name, mesh, tolerance, thickness] : solids) {
        SCOPED_TRACE(name);
        const std::unique_ptr<Solid> solid = mesh_solid(repair(mesh));
        const SampledUnion made = sampled_union(*solid, {.tolerance = tolerance});
        ASSERT_TRUE(made.balls.fit.has_value());
        EXPECT_EQ(made.balls.fit->repair.topology, known_topology(1, 0, 0));
        const std::optional<Diagnostic> warning = warning_of(made, "axis.thin_samples");
        ASSERT_TRUE(warning.has_value());
        EXPECT_TRUE(warning->place.has_value());
        double area = 0.0;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Point& o = mesh.vertices[a];
            area += 0.5 * norm(cross(mesh.vertices[b] - o, mesh.vertices[c] - o));
        }
        EXPECT_LT(static_cast<double>(made.samples.points.size()), 4.0 * area / (thickness * thickness));
    }
}

TEST(ThinPart, TooThinForSamplesIsNamedWithItsDelta) {
    const TriangleMesh plate = box_mesh({0, 0, 0}, {10, 10, 0.01});
    const auto on_block = mesh_solid(repair(together(plate, box_mesh({0, 0, -4}, {4, 4, 0.005}))));
    const std::optional<Diagnostic> warning = warning_of_thin_part(*on_block, 0.5);
    ASSERT_TRUE(warning.has_value());
    ASSERT_EQ(warning->hints.size(), 1U);
    EXPECT_EQ(warning->hints[0].option, "delta-abs");
    EXPECT_NEAR(std::stod(warning->hints[0].value), 0.005, 0.001);
    try {
        sampled_union(*mesh_solid(plate), {.tolerance = 0.5});
        FAIL() << "no ball fits";
    } catch (const UnusableInput& fault) {
        EXPECT_EQ(fault.diagnostic().code, "axis.thin_part") << fault.what();
        ASSERT_EQ(fault.diagnostic().hints.size(), 1U);
        EXPECT_NEAR(std::stod(fault.diagnostic().hints[0].value), 0.005, 0.001);
    }
}

TEST(ThinPart, SamplesThereAreTheSameForAnyThreads) {
    const auto plate = mesh_solid(box_mesh({0, 0, 0}, {4, 4, 0.25}));
    std::vector<std::vector<Ball>> balls;
    for (const int threads : {1, 2, 3}) {
        balls.push_back(sampled_union(*plate, {.tolerance = 0.7}, {}, {.threads = threads}).balls.balls);
    }
    EXPECT_EQ(balls[0], balls[1]);
    EXPECT_EQ(balls[0], balls[2]);
}

/// Balls of radius 0.5 in a plane, at the points of a grid. Those farther than `width` from the middle touch no
/// opposite sides.
std::optional<ThinPart> thin_part_of_grid(int half, double spacing, double width) {
    std::vector<Ball> balls;
    std::vector<Contacts> contacts;
    for (int i = -half; i <= half; ++i) {
        for (int j = -half; j <= half; ++j) {
            const Point center{spacing * i, spacing * j, 0.0};
            balls.push_back({center, 0.5});
            const Point side = norm(center) <= width ? Point{0, 0, -0.5} : Point{0, 0.5, 0};
            contacts.push_back({center + Point{0, 0, 0.5}, center + side});
        }
    }
    return thin_part(balls, contacts, 1.0);
}

TEST(ThinPart, IsSurroundedByItsLike) {
    EXPECT_TRUE(thin_part_of_grid(8, 0.5, 10.0).has_value());
    const std::optional<ThinPart> thin = thin_part_of_grid(8, 0.5, 2.3);
    ASSERT_TRUE(thin.has_value());
    EXPECT_LE(norm(thin->place), 0.51);
    EXPECT_EQ(thin->thickness, 1.0);
    EXPECT_FALSE(thin_part_of_grid(8, 0.5, 1.8).has_value()) << "a rim is too near";
    EXPECT_FALSE(thin_part_of_grid(1, 0.3, 10.0).has_value()) << "too small";
    EXPECT_FALSE(thin_part({}, {}, 1.0).has_value());
}

TEST(ThinPart, OfAnImageIsAVoxelThick) {
    const Box around{{-8, -8, -8}, {8, 8, 8}};
    const auto image_of = [&](const Function& mask) {
        return image_solid(smoothed_mask(sampled(mask, around, 17)), Level());
    };
    const auto shell = image_of(as_mask([](const Point& p) { return std::abs(norm(p) - 6.0) - 0.5; }));
    const std::optional<ThinPart> thin = shell->thin_part();
    ASSERT_TRUE(thin.has_value());
    EXPECT_EQ(thin->thickness, 1.0);
    EXPECT_NEAR(norm(thin->place), 6.0, 1.0);
    EXPECT_FALSE(thin->is_gap);
    EXPECT_TRUE(warning_of_thin_part(*shell, 0.8).has_value());
    EXPECT_FALSE(warning_of_thin_part(*shell, 0.35).has_value());

    const auto ball = image_of(as_mask([](const Point& p) { return norm(p) - 6.0; }));
    EXPECT_FALSE(ball->thin_part().has_value());
    EXPECT_FALSE(warning_of_thin_part(*ball, 0.8).has_value());

    const auto with_bump = [](const Point& p) {
        const bool is_inside =
            (std::abs(p.x) < 3.5 && std::abs(p.y) < 3.5 && std::abs(p.z) < 3.5) || p == Point{4, 1, 2};
        return is_inside ? 1.0 : 0.0;
    };
    EXPECT_FALSE(image_solid(sampled(with_bump, around, 17), Level())->thin_part().has_value());

    const auto cut = image_of(as_mask([](const Point& p) { return std::max(norm(p) - 6.0, 0.5 - std::abs(p.x)); }));
    const std::optional<ThinPart> gap = cut->thin_part();
    ASSERT_TRUE(gap.has_value());
    EXPECT_TRUE(gap->is_gap);
    EXPECT_EQ(gap->place.x, 0.0);
}

}  // namespace
}  // namespace scaleaxis
