// SPDX-License-Identifier: Apache-2.0
// The implicit form of a union of balls against brute force, and its image as other programs would read it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/field.hpp"
#include "scaleaxis/io.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;
namespace fs = std::filesystem;

NearestBall nearest_by_trying_all(const Balls& balls, const Point& p) {
    NearestBall nearest{kNone, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const double distance = norm(p - balls[i].center) - balls[i].radius;
        if (distance < nearest.distance) {
            nearest = {static_cast<Index>(i), distance};
        }
    }
    return nearest;
}

TEST(Field, NearestBallsAreThoseOfBruteForce) {
    constexpr std::uint64_t kSeed = 31;
    std::cout << "seed " << kSeed << '\n';
    Random random(kSeed);
    for (const Balls& balls :
         {chain_of_balls(1, 0.0, 1.0), chain_of_balls(50, 0.1, 0.3), grid_of_balls(5, 5, 5, 0.6),
          scattered_balls(random, 500, 1.0, 0.01, 0.2), balls_of_all_sizes(random, 500),
          balls_around_a_void(random, 300, 0.4), balls_through_points(random, 300, 20), aligned_balls(random, 100)}) {
        std::vector<Point> points;
        for (int i = 0; i < 2000; ++i) {
            points.push_back(random_point(random, i % 4 == 0 ? 1000.0 : 2.0));
        }
        points.push_back(balls[0].center);
        points.push_back({1e12, 0.0, 0.0});
        const std::vector<NearestBall> nearest = BallUnion(balls).nearest_balls(points);
        ASSERT_EQ(nearest.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const NearestBall truth = nearest_by_trying_all(balls, points[i]);
            ASSERT_EQ(nearest[i].ball, truth.ball) << i;
            ASSERT_EQ(nearest[i].distance, truth.distance) << i;
        }
    }
}

TEST(Field, OfSeveralNearestBallsTheFirstCounts) {
    const Balls balls{{{0, 0, 0}, 1.0}, {{4, 0, 0}, 1.0}, {{0, 0, 0}, 1.0}, {{2, 2, 0}, 1.0}};
    const auto nearest = BallUnion(balls).nearest_balls(std::vector<Point>{{2, 0, 0}, {0, 0, 3}, {4, 0, 0}});
    EXPECT_EQ(nearest[0].ball, 0);
    EXPECT_EQ(nearest[0].distance, 1.0);
    EXPECT_EQ(nearest[1].ball, 0);
    EXPECT_EQ(nearest[2].ball, 1);
    EXPECT_EQ(nearest[2].distance, -1.0);
}

TEST(Field, ImageHasTheDistanceAtEveryPoint) {
    Random random(32);
    const Balls balls = scattered_balls(random, 60, 1.0, 0.05, 0.4);
    const Image image = signed_distance_image(BallUnion(balls), 40);
    const auto [nx, ny, nz] = image.sizes;
    const double spacing = image.steps[0].x;
    EXPECT_EQ(std::max({nx, ny, nz}), 40);
    ASSERT_EQ(image.values.size(), static_cast<std::size_t>(nx) * ny * nz);
    bool has_inside = false;
    for (Index k = 0; k < nz; ++k) {
        for (Index j = 0; j < ny; ++j) {
            for (Index i = 0; i < nx; ++i) {
                const Point p = image.origin + spacing * Point{1.0 * i, 1.0 * j, 1.0 * k};
                const float value = image.values[(static_cast<std::size_t>(k) * ny + j) * nx + i];
                ASSERT_EQ(value, static_cast<float>(nearest_by_trying_all(balls, p).distance));
                const bool is_at_side = i < 2 || j < 2 || k < 2 || i >= nx - 2 || j >= ny - 2 || k >= nz - 2;
                EXPECT_TRUE(!is_at_side || value > -1e-6);
                has_inside = has_inside || value < 0.0F;
            }
        }
    }
    EXPECT_TRUE(has_inside);
    EXPECT_EQ(signed_distance_image(BallUnion(balls), 40, {.threads = 1}).values, image.values);
}

TEST(Field, ImageFileIsWhatItsHeadSays) {
    const fs::path file = fs::temp_directory_path() / ("scaleaxis-field-" + std::to_string(getpid()) + ".nrrd");
    const Image image = signed_distance_image(BallUnion(chain_of_balls(2, 1.0, 0.7)), 20);
    write_image(file, image);
    const std::string content = [&] {  // closed again: Windows removes no open file
        std::ifstream stream(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    }();
    fs::remove(file);
    const std::size_t end = content.find("\n\n");
    ASSERT_NE(end, std::string::npos);
    const std::string head = content.substr(0, end + 1);
    EXPECT_TRUE(head.starts_with("NRRD0004\n"));
    for (const std::string line : {"type: float\n", "dimension: 3\n", "endian: little\n", "encoding: raw\n",
                                   "sizes: 20 14 14\n", "space dimension: 3\n"}) {
        EXPECT_NE(head.find('\n' + line), std::string::npos) << line;
    }
    // The longest side of 2.4 and twice two points around it.
    EXPECT_DOUBLE_EQ(image.steps[0].x, 2.4 / 15.0);
    EXPECT_NEAR(image.origin.x, -0.7 - 2.0 * image.steps[0].x, 1e-12);
    const auto number_after = [&](const std::string& key) {
        return std::stod(head.substr(head.find(key) + key.size()));
    };
    EXPECT_EQ(number_after("space directions: ("), image.steps[0].x);
    EXPECT_EQ(number_after("space origin: ("), image.origin.x);
    ASSERT_EQ(content.size() - (end + 2), image.values.size() * sizeof(float));
    EXPECT_EQ(std::memcmp(content.data() + end + 2, image.values.data(), image.values.size() * sizeof(float)), 0);
    EXPECT_THROW(check_image_output("field.png"), FileError);
}

TEST(Field, WhatCannotBeIsAnError) {
    const Balls balls = chain_of_balls(2, 1.0, 0.7);
    EXPECT_THROW(signed_distance_image(BallUnion(), 20), UnusableInput);
    EXPECT_THROW(signed_distance_image(BallUnion(balls), 7), InvalidOption);
    EXPECT_THROW(BallUnion().nearest_balls(std::vector<Point>{{0, 0, 0}}), UnusableInput);
    EXPECT_THROW(signed_distance_image(BallUnion(balls), 100,
                                       {.threads = 1, .progress = [](std::string_view, double) { return false; }}),
                 Cancelled);
}

}  // namespace
}  // namespace scaleaxis
