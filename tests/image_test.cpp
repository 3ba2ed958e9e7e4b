// SPDX-License-Identifier: Apache-2.0
// Images as solids, against dense sampling of the interpolant and against solids of known topology.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "executions.hpp"
#include "images.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

const Box kAround = centered_box(1.6, 1.6, 1.6);

double torus(const Point& p) { return std::hypot(std::hypot(p.x, p.y) - 1.0, p.z) - 0.4; }
double ball(const Point& p) { return norm(p) - 1.0; }
const Function three_holes = holed_solid(0.25).function();

Image random_image(Random& random, const std::array<Index, 3>& sizes = {9, 8, 7}) {
    Image image = sampled([&](const Point&) { return uniform(random, -1.0, 1.0); }, sizes, {-3.0, 2.0, 1.0},
                          {Point{0.5, 0, 0}, Point{0, 0.7, 0}, Point{0, 0, 1.1}});
    // Outside at the border, so that nothing is added there.
    for (Index k = 0; k < sizes[2]; ++k) {
        for (Index j = 0; j < sizes[1]; ++j) {
            for (Index i = 0; i < sizes[0]; ++i) {
                if (i == 0 || j == 0 || k == 0 || i == sizes[0] - 1 || j == sizes[1] - 1 || k == sizes[2] - 1) {
                    image.values[(k * sizes[1] + j) * sizes[0] + i] = -1.0F;
                }
            }
        }
    }
    return image;
}

/// The interpolant at the points of a grid that is `factor` times as fine.
Image refined(const Image& image, Index factor) {
    const auto finer = [&](Index size) { return (size - 1) * factor + 1; };
    Image fine{{finer(image.sizes[0]), finer(image.sizes[1]), finer(image.sizes[2])}, image.origin, image.steps, {}};
    for (Point& step : fine.steps) {
        step = (1.0 / factor) * step;
    }
    for (Index k = 0; k < fine.sizes[2]; ++k) {
        for (Index j = 0; j < fine.sizes[1]; ++j) {
            for (Index i = 0; i < fine.sizes[0]; ++i) {
                const Point p =
                    fine.origin + 1.0 * i * fine.steps[0] + 1.0 * j * fine.steps[1] + 1.0 * k * fine.steps[2];
                fine.values.push_back(static_cast<float>(interpolated(image, p)));
            }
        }
    }
    return fine;
}

/// Of the cubes, squares, edges and points of the grid whose corners are all inside: counted one by one.
Topology cubical_topology(const Image& image) {
    const auto [width, height, depth] = image.sizes;
    const auto is_inside = [&, width = width, height = height, depth = depth](Index i, Index j, Index k) {
        return i >= 0 && j >= 0 && k >= 0 && i < width && j < height && k < depth &&
               image.values[(static_cast<std::size_t>(k) * height + j) * width + i] > 0.0F;
    };
    std::int64_t euler = 0;
    const auto slots = static_cast<std::size_t>(width + 2) * (height + 2) * (depth + 2);
    const auto slot = [&, width = width, height = height](Index i, Index j, Index k) {
        return (static_cast<Index>(k + 1) * (height + 2) + j + 1) * (width + 2) + i + 1;
    };
    std::vector<std::uint8_t> seen(slots);
    std::array<std::int64_t, 2> parts{};
    for (Index k = -1; k <= depth; ++k) {
        for (Index j = -1; j <= height; ++j) {
            for (Index i = -1; i <= width; ++i) {
                for (int extent = 0; extent < 8; ++extent) {  // the element that reaches as far along these axes
                    bool is_full = true;
                    for (int corner = 0; corner < 8; ++corner) {
                        is_full = is_full && ((corner & ~extent) != 0 ||
                                              is_inside(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2)));
                    }
                    euler += !is_full ? 0 : std::popcount(static_cast<unsigned>(extent)) % 2 == 0 ? 1 : -1;
                }
                if (seen[slot(i, j, k)] != 0) {
                    continue;
                }
                // Inside, points are connected by edges; outside by what is left, so by diagonals too.
                const bool side = is_inside(i, j, k);
                ++parts[side ? 0 : 1];
                std::vector<std::array<Index, 3>> stack{{i, j, k}};
                seen[slot(i, j, k)] = 1;
                while (!stack.empty()) {
                    const auto [x, y, z] = stack.back();
                    stack.pop_back();
                    for (int n = 0; n < 27; ++n) {
                        const Index a = n % 3 - 1, b = n / 3 % 3 - 1, c = n / 9 - 1;
                        const Index u = x + a, v = y + b, w = z + c;
                        if ((side && std::abs(a) + std::abs(b) + std::abs(c) > 1) || u < -1 || v < -1 || w < -1 ||
                            u > width || v > height || w > depth || seen[slot(u, v, w)] != 0 ||
                            is_inside(u, v, w) != side) {
                            continue;
                        }
                        seen[slot(u, v, w)] = 1;
                        stack.push_back({u, v, w});
                    }
                }
            }
        }
    }
    return known_topology(parts[0], parts[0] + parts[1] - 1 - euler, parts[1] - 1);
}

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

// Random voxels make a surface that a segment crosses many times, often twice or three times in one cell.
TEST(ImageSolid, CrossingsAreThoseOfTheInterpolant) {
    constexpr int kSteps = 40000;
    Random random(31);
    const Image image = random_image(random);
    const auto solid = image_solid(image, {0.0, false});
    const Box box{image.origin, image.origin + 8 * image.steps[0] + 7 * image.steps[1] + 6 * image.steps[2]};
    const auto point = [&] {
        return Point{uniform(random, box.min.x, box.max.x), uniform(random, box.min.y, box.max.y),
                     uniform(random, box.min.z, box.max.z)};
    };
    int several = 0;
    for (int n = 0; n < 150; ++n) {
        const Point a = point();
        const Point b = n % 3 == 0 ? point() + Point{10, 0, 0} : n % 3 == 1 ? point() : Point{a.x, a.y, box.max.z};
        const Point reference = point();
        const auto is_inside = [&](const Point& p) {
            return p.x >= box.min.x && p.y >= box.min.y && p.z >= box.min.z && p.x <= box.max.x && p.y <= box.max.y &&
                   p.z <= box.max.z && interpolated(image, p) > 0.0;
        };
        EXPECT_EQ(solid->inside(a), is_inside(a));
        EXPECT_EQ(solid->inside(b), is_inside(b));
        int count = 0;
        double farthest = -1.0;
        Point expected;
        bool before = is_inside(a);
        for (int i = 1; i <= kSteps; ++i) {
            const Point p = a + (1.0 * i / kSteps) * (b - a);
            if (is_inside(p) != before) {
                before = !before;
                ++count;
                const Point middle = a + ((i - 0.5) / kSteps) * (b - a);
                if (distance(middle, reference) > farthest) {
                    farthest = distance(middle, reference);
                    expected = middle;
                }
            }
        }
        several += count > 2 ? 1 : 0;
        const std::optional<Point> crossing = solid->crossing(a, b, reference);
        if (!is_inside(a) || is_inside(b)) {
            EXPECT_FALSE(crossing);
        } else {
            ASSERT_TRUE(crossing);
            EXPECT_LT(distance(*crossing, expected), 2.0 / kSteps * distance(a, b)) << count;
            EXPECT_NEAR(interpolated(image, *crossing), 0.0, 1e-12);
        }
    }
    EXPECT_GT(several, 10);
}

TEST(ImageSolid, SeedsLieOnTheSurfaceAndAreDense) {
    const Image image = sampled(torus, kAround, 33);
    const auto solid = image_solid(image, {0.0, true});
    const double area = 4.0 * std::numbers::pi * std::numbers::pi * 0.4;
    for (const double spacing : {0.05, 0.4}) {
        const std::vector<Point> seeds = solid->seeds(spacing, 1, {});
        for (const Point& p : seeds) {
            ASSERT_NEAR(interpolated(image, p), 0.0, 1e-12);
        }
        EXPECT_GT(static_cast<double>(seeds.size()), 5.0 * area / (spacing * spacing));
        EXPECT_LT(static_cast<double>(seeds.size()), 12.0 * area / (spacing * spacing) + 300.0);
    }
    const Box box = solid->bounds();
    EXPECT_NEAR(box.max.x, 1.4, 0.05);
    EXPECT_NEAR(box.min.z, -0.4, 0.05);
}

TEST(ImageSolid, BothSensesOfTheLevel) {
    const Image image = sampled(ball, kAround, 33);
    const auto below = image_solid(image, {0.0, true});
    EXPECT_TRUE(below->inside({0, 0, 0}));
    EXPECT_FALSE(below->inside({1.5, 0, 0}));
    Image negated = image;
    std::ranges::transform(negated.values, negated.values.begin(), std::negate());
    const auto above = image_solid(negated, {0.0, false});
    EXPECT_EQ(above->seeds(0.2, 1, {}), below->seeds(0.2, 1, {}));
}

struct Named {
    std::string name;
    Function function;
    Topology topology;
};

std::vector<Named> solids() {
    const ImplicitSolid box = box_solid({1.0, 0.7, 0.4});
    return {{"ball", ball, known_topology(1, 0, 0)},
            {"torus", torus, known_topology(1, 1, 0)},
            {"box", box.function(), known_topology(1, 0, 0)},
            {"three holes", three_holes, known_topology(1, 3, 0)},
            {"shell", [](const Point& p) { return std::max(norm(p) - 1.0, 0.5 - norm(p)); }, known_topology(1, 0, 1)}};
}

// The same solid as a grey image, as a mask, and as a function.
TEST(ImageSolid, HasTheTopologyOfTheSolid) {
    for (const Named& named : solids()) {
        const auto grey = image_solid(sampled(named.function, kAround, 48), {0.0, true});
        const Image mask = sampled(as_mask(named.function), kAround, 48);
        for (const double width : {0.0, 0.7}) {
            const auto solid = width == 0.0 ? image_solid(mask, {0.5, false})
                                            : image_solid(smoothed_mask(mask, {width}), {0.5, false});
            for (const Solid* each : {grey.get(), solid.get()}) {
                const ScaleAxis axis = scale_axis(*each, {.delta = Length::relative(0.015)});
                EXPECT_TRUE(agree(axis.axes[0].medial_statistics.dual_complex, named.topology)) << named.name;
                // The balls stay within the solid but for the tolerance and the size of a voxel.
                for (const Ball& ball : axis.balls) {
                    EXPECT_LT(named.function(ball.center), -ball.radius + 0.1 + axis.tolerance) << named.name;
                }
            }
        }
    }
}

// A staircase has branches; a smoothed mask has the axis of what it stands for.
TEST(ImageSolid, SmoothingTakesAwayTheBranchesOfTheStaircase) {
    const Function turned = [](const Point& p) {  // a box, parallel to nothing
        const double u = 0.8 * p.x + 0.6 * p.y;
        const Point q{u, 0.28 * (0.8 * p.y - 0.6 * p.x) + 0.96 * p.z, 0.28 * p.z - 0.96 * (0.8 * p.y - 0.6 * p.x)};
        return box_solid({1.0, 0.7, 0.4}).value(q);
    };
    const auto sheets = [&](const Image& image, const Level& level) {
        return scale_axis(*image_solid(image, level),
                          {.delta = Length::relative(0.01), .cleaning = Length::relative(0.0)})
            .axes[0]
            .complex.sheets;
    };
    const Image mask = sampled(as_mask(turned), kAround, 64);
    const Index of_solid = sheets(sampled(turned, kAround, 64), {0.0, true});
    const Index raw = sheets(mask, {});
    const Index smooth = sheets(smoothed_mask(mask), {});
    EXPECT_LT(smooth, 3 * of_solid + 20);
    EXPECT_GT(raw, 3 * smooth);
}

// Bars and dots of one voxel would vanish in the blur.
TEST(Image, SmoothingKeepsThinParts) {
    const auto is_inside = [](Index i, Index j, Index k) {
        const bool is_block = i < 20 && j < 20 && k < 20 && std::min({i, j, k}) > 5;
        const bool is_bar = i == 9 && j == 9 && k >= 20 && k < 30;
        const bool is_dot = i == 25 && j == 25 && k == 25;
        return is_block || is_bar || is_dot;
    };
    const Image mask =
        sampled([&](const Point& p) { return is_inside(Index(p.x), Index(p.y), Index(p.z)) ? 1.0 : 0.0; }, {36, 36, 36},
                {}, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
    const auto solid = image_solid(smoothed_mask(mask), {});
    for (Index k = 0; k < 36; ++k) {
        EXPECT_EQ(solid->inside({9, 9, 1.0 * k}), k > 5 && k < 30) << k;
    }
    EXPECT_TRUE(solid->inside({25, 25, 25}));
    EXPECT_NEAR(solid->bounds().max.x, 25.6, 0.1);  // half a voxel, and the margin of the box
}

// A branch, an island, and a void in the block.
TEST(Image, SmoothingKeepsWhatItWouldTakeAllOf) {
    const auto is_in = [](const Point& p, const std::array<int, 3>& low, const std::array<int, 3>& high) {
        return p.x >= low[0] && p.y >= low[1] && p.z >= low[2] && p.x < high[0] && p.y < high[1] && p.z < high[2];
    };
    for (const std::array<int, 2>& size : {std::array{1, 1}, {2, 1}, {1, 2}, {3, 1}, {2, 2}}) {
        SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]));
        const Image mask = sampled(
            [&](const Point& p) {
                const bool is_block = is_in(p, {4, 4, 4}, {20, 20, 20}) && !is_in(p, {11, 11, 11}, {13, 13, 13});
                const bool is_branch = is_in(p, {20, 9, 9}, {34, 9 + size[0], 9 + size[1]});
                const bool is_island = is_in(p, {28, 28, 28}, {28 + size[0], 30, 28 + size[1]});
                return is_block || is_branch || is_island ? 1.0 : 0.0;
            },
            {40, 40, 40}, {}, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
        const Image smooth = smoothed_mask(mask);
        EXPECT_EQ(topology(smooth, {}), known_topology(2, 0, 1));
        const auto solid = image_solid(smooth, {});
        for (Index i = 20; i < 33; ++i) {  // the tip is rounded
            EXPECT_TRUE(solid->inside({1.0 * i, 8.5 + 0.5 * size[0], 8.5 + 0.5 * size[1]})) << i;
        }
    }
}

/// The volume of a solid, by random points.
double volume_of(const Solid& solid) {
    const auto [low, high] = solid.bounds();
    const Point size = high - low;
    constexpr int kAlong = 60;  // one point in each cell of a grid: as good as a hundred times as many anywhere
    int inside = 0;
    for (std::uint64_t i = 0; i < kAlong * kAlong * kAlong; ++i) {
        const auto along = [&](std::uint64_t cell, std::uint64_t axis) {
            return (static_cast<double>(cell) + random_unit(3, i, axis)) / kAlong;
        };
        const Point part{along(i % kAlong, 0), along(i / kAlong % kAlong, 1), along(i / kAlong / kAlong, 2)};
        inside += solid.inside(low + Point{size.x * part.x, size.y * part.y, size.z * part.z}) ? 1 : 0;
    }
    return inside * size.x * size.y * size.z / (kAlong * kAlong * kAlong);
}

double volume_of_voxels(const Image& mask) {
    const auto& [a, b, c] = mask.steps;
    return std::abs(dot(a, cross(b, c))) * static_cast<double>(std::ranges::count(mask.values, 1.0F));
}

/// The mask of a solid within 20 of the origin, far from the border, whose centre is at no voxel, in voxels of these
/// sizes.
Image mask_of(const Function& function, const Point& voxel) {
    std::array<Index, 3> sizes{};
    std::ranges::transform(std::array{voxel.x, voxel.y, voxel.z}, sizes.begin(),
                           [](double size) { return static_cast<Index>(std::ceil(60.0 / size)); });
    return sampled(as_mask(function), sizes, {-29.91, -29.83, -29.77},
                   {Point{voxel.x, 0, 0}, Point{0, voxel.y, 0}, Point{0, 0, voxel.z}});
}

/// \param angle in degrees, to the slices
Function rod(double angle, double radius) {
    const double a = angle * std::numbers::pi / 180.0;
    const Point along = unit({std::cos(a), 0.1, std::sin(a)});
    return [=](const Point& p) { return distance(p, std::clamp(dot(p, along), -15.0, 15.0) * along) - radius; };
}

TEST(Image, SmoothingKeepsVolumeInThickSlicesAndOfThinParts) {
    struct Case {
        std::string name;
        Function function;
        Point voxel;
        double true_volume;
        double error;  ///< of the voxels
    };
    const auto ball_of = [](double r) { return [=](const Point& p) { return norm(p) - r; }; };
    const auto volume_of_ball = [](double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; };
    const auto volume_of_rod = [&](double r) { return volume_of_ball(r) + 30.0 * std::numbers::pi * r * r; };
    const Function ellipsoid = [](const Point& p) { return norm({p.x / 9.0, p.y / 5.0, p.z / 3.0}) - 1.0; };
    const std::vector<Case> cases{{"ball", ball_of(6.0), {1, 1, 2}, volume_of_ball(6.0), 0.02},
                                  {"small ball", ball_of(1.7), {1, 1, 1}, volume_of_ball(1.7), 0.1},
                                  {"ellipsoid", ellipsoid, {0.7, 0.7, 3}, volume_of_ball(1.0) * 135.0, 0.15},
                                  {"thin rod", rod(10.0, 1.0), {1, 1, 1}, volume_of_rod(1.0), 0.1},
                                  {"rod in slices", rod(5.0, 2.5), {0.7, 0.7, 3}, volume_of_rod(2.5), 0.1},
                                  {"steep rod", rod(30.0, 4.5), {3, 3, 10}, volume_of_rod(4.5), 0.1},
                                  {"wide rod", rod(60.0, 4.5), {1, 2, 4}, volume_of_rod(4.5), 0.03}};
    for (const Case& one : cases) {
        const Image mask = mask_of(one.function, one.voxel);
        for (const double width : {0.7, 1.5}) {
            const double volume = volume_of(*image_solid(smoothed_mask(mask, {width}), {}));
            EXPECT_NEAR(volume / volume_of_voxels(mask), 1.0, 0.01) << one.name << ' ' << width;
            EXPECT_NEAR(volume / one.true_volume, 1.0, one.error) << one.name << ' ' << width;
        }
    }
}

/// The area, at x = 42, of what is inside a solid near a box in that plane, or outside.
double area_near(const Solid& solid, const Point& low, const Point& high, bool is_inside) {
    constexpr int kAlong = 80;
    const Point start = low - Point{0.0, 2.5, 2.5};  // voxels reach half a step beyond their centres
    const Point size = high + Point{0.0, 1.5, 1.5} - start;
    int count = 0;
    for (int i = 0; i < kAlong * kAlong; ++i) {
        const Point p{42.0, start.y + size.y * (i % kAlong + 0.5) / kAlong,
                      start.z + size.z * (i / kAlong + 0.5) / kAlong};
        count += solid.inside(p) == is_inside ? 1 : 0;
    }
    return count * size.y * size.z / (kAlong * kAlong);
}

// A bar of a block, or a blind hole in one; alone the bar would keep its volume anyway.
TEST(Image, SmoothingKeepsVolumeOfThinPartsOfThickOnes) {
    struct Case {
        int width, height;
        double least;
    };
    for (const auto& [width, height, least] : {Case{1, 1, 0.55},
                                               {2, 1, 0.7},
                                               {2, 2, 0.85},
                                               {3, 2, 0.93},
                                               {3, 3, 0.93},
                                               {4, 4, 0.97},
                                               {1, 20, 0.95},
                                               {2, 20, 0.95}}) {
        for (const bool is_bar : {true, false}) {
            const auto is_in = [](const Point& p, const Point& low, const Point& high) {
                return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x < high.x && p.y < high.y && p.z < high.z;
            };
            const Point low{30, 17, 17};
            const Point high{50, low.y + width, low.z + height};
            const Image mask = sampled(
                [&](const Point& p) {
                    const bool is_in_block = is_in(p, {4, 4, 4}, {is_bar ? 34.0 : 58.0, 44, 44});
                    return (is_bar ? is_in_block || is_in(p, low, high) : is_in_block && !is_in(p, low, high)) ? 1 : 0;
                },
                {62, 48, 48}, {}, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
            const double area = area_near(*image_solid(smoothed_mask(mask), {}), low, high, is_bar);
            EXPECT_GT(area / (width * height), least) << width << " x " << height << ' ' << is_bar;
            EXPECT_LT(area / (width * height), 1.03) << width << " x " << height << ' ' << is_bar;
        }
    }
}

TEST(Image, SmoothingKeepsVolumeOfNoise) {
    Random random(4);
    for (const double part : {0.3, 0.7}) {
        const Image mask = mask_of(
            [&](const Point& p) { return norm(p) < 12.0 && uniform(random, 0.0, 1.0) < part ? -1.0 : 1.0; }, {1, 1, 1});
        EXPECT_NEAR(volume_of(*image_solid(smoothed_mask(mask), {})) / volume_of_voxels(mask), 1.0, 0.012) << part;
    }
}

TEST(Image, SmoothingKeepsBallsRoundInSlices) {
    const auto solid = image_solid(smoothed_mask(mask_of([](const Point& p) { return norm(p) - 6.0; }, {1, 1, 2})), {});
    const auto radius_along = [&](const Point& direction) {
        double inside = 0.0;
        while (solid->inside((inside + 0.01) * direction)) {
            inside += 0.01;
        }
        return inside;
    };
    for (const Point& direction : {Point{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, unit({1, 1, 1}), unit({1, 0, 1})}) {
        EXPECT_NEAR(0.5 * (radius_along(direction) + radius_along(-1.0 * direction)), 6.0, 0.25)
            << direction.x << " " << direction.z;
    }
}

TEST(Image, SmoothingLeavesMasksThatFillTheirImage) {
    const Image full =
        sampled([](const Point&) { return 1.0; }, {20, 10, 10}, {}, {Point{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    EXPECT_NEAR(volume_of(*image_solid(smoothed_mask(full), {})), 2000.0, 20.0);
}

TEST(Image, SmoothingLeavesTheSmallestMasks) {
    const Image mask = sampled([](const Point& p) { return norm(p) < 1.0 ? 1.0 : 0.0; }, {20, 20, 20},
                               {-9.5, -9.5, -9.5}, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
    EXPECT_NEAR(volume_of(*image_solid(smoothed_mask(mask, {3.0}), {})), 8.0, 0.2);
}

/// A tube along x through the middle of an image of 30 x 20 x 20 voxels, hollow, in which one voxel is missing.
Image hollow_tube(Index begin, Index end, bool is_closed) {
    Image image = sampled([](const Point&) { return 0.0; }, {30, 20, 20}, {}, {Point{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    for (Index k = 0; k < 20; ++k) {
        for (Index j = 0; j < 20; ++j) {
            for (Index i = begin; i < end; ++i) {
                const double r = std::hypot(j - 9.5, k - 9.5);
                const bool is_cap = is_closed && (i < begin + 3 || i >= end - 3);
                const bool is_missing = i == 15 && j == 4 && k == 9;
                image.values[(k * 20 + j) * 30 + i] = r < 7.0 && (r > 3.0 || is_cap) && !is_missing ? 1.0F : 0.0F;
            }
        }
    }
    return image;
}

TEST(Image, VoidsAreFilled) {
    const auto tunnels_and_voids = [](const Image& mask) { return topology(mask, {}); };
    const FilledImage closed = without_voids(hollow_tube(3, 27, true));
    EXPECT_EQ(closed.open, 0);
    EXPECT_GT(closed.filled, 400);
    EXPECT_EQ(tunnels_and_voids(closed.image), known_topology(1, 0, 0));
    const FilledImage open = without_voids(hollow_tube(3, 27, false));
    EXPECT_EQ(open.open, 0);
    EXPECT_EQ(open.filled, 1);
    EXPECT_EQ(tunnels_and_voids(open.image), known_topology(1, 1, 0));
    const FilledImage cut = without_voids(hollow_tube(0, 30, false));
    EXPECT_EQ(cut.open, 1);
    EXPECT_EQ(cut.filled, 1);
}

TEST(ImageSolid, LoadingFillsVoids) {
    const auto loaded = [](Image mask, double smoothing) {
        LoadOptions options;
        options.fills_voids = true;
        options.mask_smoothing = smoothing;
        return load_solid(std::move(mask), options);
    };
    for (const double smoothing : {0.0, 0.7}) {
        EXPECT_EQ(loaded(hollow_tube(3, 27, true), smoothing).solid->topology(), known_topology(1, 0, 0));
    }
    const LoadedSolid cut = loaded(hollow_tube(0, 27, false), 0.7);
    EXPECT_EQ(std::ranges::count(cut.warnings, "image.open_voids", &Diagnostic::code), 0);  // it leads out at one end
    EXPECT_EQ(
        std::ranges::count(loaded(hollow_tube(0, 30, false), 0.7).warnings, "image.open_voids", &Diagnostic::code), 1);
    // A dent that smoothing closes.
    Random random(5);
    Image noise = hollow_tube(3, 27, true);
    for (float& value : noise.values) {
        value = value > 0.0F && uniform(random, 0.0, 1.0) < 0.75 ? 1.0F : 0.0F;
    }
    LoadOptions options;
    EXPECT_GT(load_solid(noise, options).solid->topology()->voids, 0);
    EXPECT_EQ(loaded(noise, 0.7).solid->topology()->voids, 0);
}

TEST(ImageSolid, LoadingTellsThatTheVolumeIsNotThatOfTheMask) {
    const auto codes = [](Image mask, double smoothing) {
        LoadOptions options;
        options.mask_smoothing = smoothing;
        std::vector<std::string> result;
        for (const Diagnostic& warning : load_solid(std::move(mask), options).warnings) {
            result.push_back(warning.code);
        }
        return result;
    };
    const Image thin = mask_of(rod(10.0, 1.5), {1, 1, 1});
    EXPECT_EQ(codes(thin, 0.0), std::vector<std::string>{"image.mask_volume"});
    EXPECT_TRUE(codes(thin, 0.7).empty());
    EXPECT_TRUE(codes(mask_of(rod(10.0, 8.0), {0.5, 0.5, 0.5}), 0.0).empty());
    EXPECT_TRUE(codes(mask_of([](const Point& p) { return norm(p) - 3.0; }, {1, 1, 1}), 0.0)
                    .empty());  // 3 %: so much the voxels are unsure of
}

TEST(Image, SmoothingKeepsVolume) {
    for (const Named& named : solids()) {
        const Image mask = sampled(as_mask(named.function), kAround, 40);
        const double volume = volume_of(*image_solid(smoothed_mask(mask), {}));
        EXPECT_NEAR(volume / volume_of_voxels(mask), 1.0, 0.01) << named.name;
    }
}

TEST(ImageSolid, IsTheSameInAll48Orientations) {
    // Powers of two: places do not depend on where one begins to count.
    const Image image = sampled(three_holes, {27, 15, 33}, {-1.625, -0.875, -0.5},
                                {Point{0.125, 0, 0}, Point{0, 0.125, 0}, Point{0, 0, 0.03125}});
    const auto inside_of = [](Image grey) {
        std::ranges::transform(grey.values, grey.values.begin(),
                               [](float value) { return value < 0.0F ? 1.0F : 0.0F; });
        return grey;
    };
    const auto solid = image_solid(image, {0.0, true});
    const auto mask_solid = image_solid(smoothed_mask(inside_of(image)), {});
    const std::vector<Point> seeds = solid->seeds(0.2, 1, {});
    EXPECT_NEAR(solid->bounds().max.x, 1.4, 0.03);
    EXPECT_NEAR(solid->bounds().max.z, 0.35, 0.01);
    std::array<int, 3> axes{0, 1, 2};
    int orientations = 0;
    do {
        for (int turned = 0; turned < 8; ++turned) {
            const Image other = reordered(image, axes, turned);
            const auto other_solid = image_solid(other, {0.0, true});
            EXPECT_EQ(other_solid->bounds().min, solid->bounds().min);
            EXPECT_EQ(other_solid->bounds().max, solid->bounds().max);
            EXPECT_EQ(other_solid->seeds(0.2, 1, {}), seeds);
            const Image smooth = smoothed_mask(inside_of(other));
            EXPECT_EQ(image_solid(smooth, {})->seeds(0.2, 1, {}), mask_solid->seeds(0.2, 1, {}));
            ++orientations;
        }
    } while (std::ranges::next_permutation(axes).found);
    EXPECT_EQ(orientations, 48);
}

// Oblique directions and unequal spacing: the solid is where it is.
TEST(ImageSolid, HonoursSpacingAndDirection) {
    const double c = std::cos(0.5), s = std::sin(0.5);
    const std::array<Point, 3> steps{0.08 * Point{c, s, 0}, 0.05 * Point{-s, c, 0}, Point{0, 0, 0.1}};
    const Point corner = -20.0 * steps[0] - 32.0 * steps[1] - 8.0 * steps[2];
    const Image image = sampled(torus, {41, 65, 17}, corner, steps);
    const auto solid = image_solid(image, {0.0, true});
    Random random(4);
    for (int i = 0; i < 3000; ++i) {
        const Point p = random_point(random, 1.5);
        if (std::abs(torus(p)) > 0.02) {
            EXPECT_EQ(solid->inside(p), torus(p) < 0.0);
        }
    }
    for (const Point& p : solid->seeds(0.1, 1, {})) {
        EXPECT_NEAR(torus(p), 0.0, 0.02);
    }
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.02)});
    EXPECT_TRUE(agree(axis.axes[0].medial_statistics.dual_complex, known_topology(1, 1, 0)));
}

TEST(ImageSolid, IsClosedHalfAVoxelBeyondTheBorder) {
    // A bar that runs through the whole image along x.
    const Image image = sampled([](const Point& p) { return std::hypot(p.y, p.z) - 0.5; }, {11, 21, 21}, {0, -1, -1},
                                {Point{0.3, 0, 0}, Point{0, 0.1, 0}, Point{0, 0, 0.1}});
    EXPECT_GT(border_voxels(image, {0.0, true}), 100);
    const auto all = static_cast<std::int64_t>(21 * 21 * 11 - 19 * 19 * 9);
    EXPECT_EQ(border_voxels(image, {0.01, false}), all - border_voxels(image, {0.01, true}));
    const auto solid = image_solid(image, {0.0, true});
    const std::optional<Point> crossing = solid->crossing({1, 0.1, 0.1}, {10, 0.1, 0.1}, {});
    ASSERT_TRUE(crossing);
    EXPECT_NEAR(crossing->x, 3.15, 1e-12);
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.03)});
    EXPECT_TRUE(agree(axis.axes[0].medial_statistics.dual_complex, known_topology(1, 0, 0)));
}

TEST(Image, LabelsAndMasks) {
    Image image;
    image.sizes = {3, 2, 1};
    image.values = {0, 3, 3, 7, 0, -2};
    const std::vector<LabelCount> found = labels(image);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].label, -2.0F);
    EXPECT_EQ(found[1].voxels, 2);
    EXPECT_EQ(found[1].low, (std::array<Index, 3>{1, 0, 0}));
    EXPECT_EQ(found[1].high, (std::array<Index, 3>{2, 0, 0}));
    EXPECT_EQ(found[2].low, (std::array<Index, 3>{0, 1, 0}));
    EXPECT_EQ(found[2].high, found[2].low);
    const std::array<float, 2> wanted{3.0F, -2.0F};
    EXPECT_EQ(mask(image, wanted).values, (std::vector<float>{0, 1, 1, 0, 0, 1}));
    EXPECT_EQ(mask(image, {}).values, (std::vector<float>{0, 1, 1, 1, 0, 1}));
    const std::array<float, 2> absent{3.0F, 5.0F};
    EXPECT_NE(message_of([&] { mask(image, absent); }).find("no voxel has the label 5"), std::string::npos);
    image.values = {0, 0.5F, 3, 7, 0, -2};
    EXPECT_TRUE(labels(image).empty());
    image.values.assign(6, 0.0F);
    EXPECT_NE(message_of([&] { mask(image, {}); }).find("the mask is empty"), std::string::npos);
}

/// Labels that touch each other and the border of the image, with holes, and one of a single voxel.
Image touching_labels() {
    const auto label = [](const Point& p) {
        const double from_first = norm(p - Point{3, 4, 5});
        const double from_second = norm(p - Point{11, 6, 6});
        return from_second < 5.3 && from_second > 2.0 ? 9.0 : from_first < 5.1 ? -4.0 : norm(p) < 0.5 ? 2.0 : 0.0;
    };
    Image image = sampled(label, {17, 13, 14}, {}, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
    image.origin = {0.1, -70.3, 1e3 / 3.0};
    image.steps = {Point{0.782, 0.01, 0}, Point{-0.01, 0.7, 0.1}, Point{0, -0.1, 1.3}};
    return image;
}

void expect_same_solid(const LoadedSolid& a, const LoadedSolid& b) {
    const auto messages = [](const LoadedSolid& loaded) {
        std::vector<std::string> result;
        for (const Diagnostic& warning : loaded.warnings) {
            result.push_back(warning.message);
        }
        return result;
    };
    EXPECT_EQ(messages(a), messages(b));
    EXPECT_EQ(a.solid->topology(), b.solid->topology());
    const ScaleAxisOptions options{.delta = Length::relative(0.03)};
    const std::vector<Ball> balls = scale_axis(*a.solid, options).balls;
    const std::vector<Ball> others = scale_axis(*b.solid, options).balls;
    ASSERT_EQ(balls.size(), others.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
        ASSERT_EQ(balls[i].center, others[i].center);  // to the last bit
        ASSERT_EQ(balls[i].radius, others[i].radius);
    }
}

TEST(Image, ALabelAloneIsThatOfTheWholeImage) {
    const Image given = touching_labels();
    for (const auto& [axes, turned] : std::vector<std::pair<std::array<int, 3>, int>>{{{0, 1, 2}, 0}, {{2, 0, 1}, 5}}) {
        const Image image = reordered(given, axes, turned);
        const ImageReport report = report_of(image);
        ASSERT_EQ(report.labels.size(), 3u);
        for (const double width : {0.0, 0.7, 2.0}) {
            for (const float label : {-4.0F, 9.0F}) {
                SCOPED_TRACE(testing::Message() << "label " << label << ", width " << width << ", turned " << turned);
                LoadOptions options;
                options.mask_smoothing = width;
                const LoadedSolid alone = load_label(image, report, label, options);
                options.labels = {label};
                expect_same_solid(alone, load_solid(image, options));
            }
        }
        EXPECT_NE(message_of([&] { load_label(image, report, 3.0F, {}); }).find("no voxel has the label 3"),
                  std::string::npos);
        EXPECT_THROW(label_mask(image, report.labels[0], 11.0), InvalidOption);
    }
}

TEST(Image, SaysWhichLabelsThereAre) {
    Image image = touching_labels();
    LoadOptions options;
    options.labels = {3.0F};
    const std::string absent = message_of([&] { load_solid(image, options); });
    EXPECT_NE(absent.find("no voxel has the label 3: its labels are -4"), std::string::npos) << absent;
    for (float& value : image.values) {
        value *= 0.99F;  // as a scale in the head makes of them
    }
    const std::string scaled = message_of([&] { load_solid(image, options); });
    EXPECT_NE(scaled.find("are not whole numbers"), std::string::npos) << scaled;
    EXPECT_NE(scaled.find("-3.96, "), std::string::npos) << scaled;
    image.values[0] = 0x1p25F;
    EXPECT_NE(message_of([&] { load_solid(image, options); }).find("beyond 2^24"), std::string::npos);
}

// As where the name of a segment and its number are given.
TEST(Image, ALabelThatIsGivenTwiceCountsOnce) {
    Image image = touching_labels();
    image.label_names = {{9.0F, "nine"}};
    EXPECT_EQ(mask(image, std::array{9.0F, -4.0F, 9.0F}).values, mask(image, std::array{-4.0F, 9.0F}).values);
    EXPECT_THROW(mask(image, std::array{9.0F, 3.0F, 3.0F}), UnusableInput);
    LoadOptions options;
    options.labels = {9.0F};
    const LoadedSolid once = load_solid(image, options);
    options.label_names = {"nine"};
    expect_same_solid(once, load_solid(image, options));
}

TEST(Image, AMaskOfALabelIsAsLargeAsItIsLookedAt) {
    const Image image = sampled(
        [](const Point& p) {
            return p == Point{20, 30, 2} ? 5.0 : 0.0;
        },
        {60, 50, 40}, {}, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
    const Image part = label_mask(image, labels(image).at(0), 0.7);
    EXPECT_EQ(part.sizes, (std::array<Index, 3>{11, 11, 8}));
    EXPECT_EQ(part.origin, (Point{15, 25, 0}));
    EXPECT_EQ(std::ranges::count(part.values, 1.0F), 1);
    EXPECT_EQ(std::ranges::count(part.values, 0.0F), std::ssize(part.values) - 1);
}

TEST(Execution, RunsAllConcurrently) {
    for (const int threads : {1, 3}) {
        std::vector<int> calls(100);
        std::vector<std::size_t> order;
        run_concurrently(calls.size(),
                         [&](std::size_t i) {
                             ++calls[i];
                             if (threads == 1) {
                                 order.push_back(i);
                             }
                         },
                         {.threads = threads});
        EXPECT_EQ(calls, std::vector<int>(100, 1));
        EXPECT_TRUE(std::ranges::is_sorted(order));
    }
    EXPECT_THROW(run_concurrently(5, [](std::size_t i) { i == 3 ? throw FileError("here") : void(); }), FileError);
}

TEST(ImageSolid, ClosesAMaskThatFillsItsImage) {
    const Image full{{4, 3, 2}, {}, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}}, std::vector<float>(24, 1.0F)};
    const std::unique_ptr<Solid> solid = image_solid(full, {0.5, false});
    const std::vector<Point> at{{1, 1, 0}, {3.49, 1, 0}, {1, -0.49, 0}, {3.51, 1, 0}, {1, -0.51, 0}, {1, 1, 1.51}};
    std::vector<std::uint8_t> sides(at.size());
    solid->inside(at, sides);
    EXPECT_EQ(sides, (std::vector<std::uint8_t>{1, 1, 1, 0, 0, 0}));
    EXPECT_EQ(solid->topology()->components, 1);
    EXPECT_EQ(solid->warnings().at(0).code, "image.border");
}

TEST(ImageSolid, TellsWhatIsWrong) {
    const Image image = sampled(ball, kAround, 12);
    const auto fault = [&](const std::function<void(Image&)>& damage, Level level = {0.0, true}) {
        Image bad = image;
        damage(bad);
        return message_of([&] { image_solid(bad, level); });
    };
    EXPECT_EQ(fault([](Image&) {}), "nothing was thrown");
    EXPECT_NE(fault([](Image&) {}, {-9.0, true}).find("no voxel is below -9: the values are "), std::string::npos);
    EXPECT_NE(fault([](Image&) {}, {9.0, true}).find("all voxels are below 9"), std::string::npos);
    EXPECT_NE(fault([](Image&) {}, {std::nan(""), true}).find("finite number"), std::string::npos);
    EXPECT_NE(
        fault([](Image& bad) { bad.values[5 + 12 * (2 + 12 * 7)] = NAN; }).find("voxel (5, 2, 7) is not a number"),
        std::string::npos);
    EXPECT_NE(fault([](Image& bad) { bad.values.pop_back(); }).find("1727 values, its sizes are 12 x 12 x 12"),
              std::string::npos);
    EXPECT_NE(fault([](Image& bad) { bad.sizes[1] = 0; }).find("no voxels"), std::string::npos);
    EXPECT_NE(fault([](Image& bad) { bad.steps[2] = bad.steps[1]; }).find("do not span space"), std::string::npos);
    EXPECT_NE(fault([](Image& bad) { bad.steps[2] = {}; }).find("do not span space"), std::string::npos);
    EXPECT_NE(fault([](Image& bad) {
                  bad.sizes = {1 << 30, 1 << 30, 1 << 30};
              }).find("its sizes are 1073741824"),
              std::string::npos);
    EXPECT_NE(fault([](Image& bad) { bad.origin.y = 1e12; }).find("too far from the origin"), std::string::npos);
    EXPECT_NE(fault([](Image& bad) {
                  for (Point& step : bad.steps) {
                      step = 1e-60 * step;
                  }
                  bad.origin = {};
              }).find("too small"),
              std::string::npos);
    EXPECT_THROW(smoothed_mask(image, {-1.0}), InvalidOption);
    EXPECT_THROW(smoothed_mask(image, {std::nan("")}), InvalidOption);
}

TEST(Image, OfTheWrongSizeIsNotRead) {
    Image image = sampled(as_mask(ball), kAround, 12);
    image.values.resize(1000);
    EXPECT_NE(message_of([&] { smoothed_mask(image); }).find("1000 values"), std::string::npos);
    EXPECT_NE(message_of([&] { border_voxels(image, {}); }).find("1000 values"), std::string::npos);
    EXPECT_NE(message_of([&] { mask(image, {}); }).find("1000 values"), std::string::npos);
    image.values.assign(12 * 12 * 12, 0.0F);
    EXPECT_NE(message_of([&] { smoothed_mask(image); }).find("the mask is empty"), std::string::npos);
}

TEST(ImageSolid, TellsThatItIsClosedAtTheBorder) {
    const Image image = sampled(ball, kAround, 12);
    EXPECT_TRUE(image_solid(image, {0.0, true})->warnings().empty());
    const std::vector<Diagnostic> warnings = image_solid(image, {0.0, false})->warnings();
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].code, "image.border");
    EXPECT_NE(warnings[0].message.find("728 voxels"), std::string::npos) << warnings[0].message;  // 12³ - 10³
}

TEST(ImageSolid, TakesArraysOfTheCallers) {
    const Image image = sampled(ball, kAround, 12);
    const ImageView view = image;
    EXPECT_EQ(view.values.data(), image.values.data());
    EXPECT_EQ(image_solid(view, {0.0, true})->seeds(0.2, 1, {}), image_solid(image, {0.0, true})->seeds(0.2, 1, {}));
    const Image mask = sampled(as_mask(ball), kAround, 12);
    EXPECT_EQ(smoothed_mask(ImageView(mask)).values, smoothed_mask(mask).values);
}

TEST(ImageSolid, ReportsProgressAndStops) {
    const Image image = sampled(ball, kAround, 40);
    const Image inside = sampled(as_mask(ball), kAround, 40);
    expect_progress_and_cancellation([&](const Execution& execution) { image_solid(image, {0.0, true}, execution); });
    expect_progress_and_cancellation([&](const Execution& execution) { smoothed_mask(inside, {}, execution); });
    std::stop_source source;
    source.request_stop();
    const Execution stopped{.cancel = source.get_token()};
    EXPECT_THROW(check(image, stopped), Cancelled);
    EXPECT_THROW(labels(inside, stopped), Cancelled);
    EXPECT_THROW(mask(inside, {}, stopped), Cancelled);
}

// The poles of so small a ball are single voxels, sharp tips of the interpolant.
TEST(ImageSolid, BoundsHoldSharpTips) {
    const Image image = sampled([](const Point& p) { return norm(p) < 4.01 ? 1.0 : 0.0; }, {11, 11, 11}, {-5, -5, -5},
                                {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
    const auto solid = image_solid(image, {});
    EXPECT_GE(solid->bounds().max.x, 4.5);
    EXPECT_LE(solid->bounds().max.x, 4.65);
    EXPECT_NO_THROW(scale_axis(*solid, {.delta = Length::relative(0.003)}));
}

// Infinite values are only inside or outside.
TEST(ImageSolid, TakesInfiniteValues) {
    const Image image = sampled(
        [](const Point& p) { return ball(p) < 0.0 ? -std::numeric_limits<double>::infinity() : 1.0; }, kAround, 16);
    const auto solid = image_solid(image, {0.0, true});
    EXPECT_TRUE(solid->inside({0, 0, 0}));
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.05)});
    EXPECT_TRUE(agree(axis.axes[0].medial_statistics.dual_complex, known_topology(1, 0, 0)));
}

TEST(ImageSolid, IsTheSameForAnyNumberOfThreads) {
    const Image mask = sampled(as_mask(torus), kAround, 40);
    const auto one = image_solid(smoothed_mask(mask, {}, {.threads = 1}), {}, {.threads = 1});
    const auto many = image_solid(smoothed_mask(mask, {}, {.threads = 4}), {}, {.threads = 4});
    EXPECT_EQ(one->bounds().min, many->bounds().min);
    EXPECT_EQ(one->seeds(0.05, 7, {.threads = 1}), many->seeds(0.05, 7, {.threads = 4}));
}

// Within cells the interpolant has tunnels and bridges that the corners do not show.
void expect_topology_of_the_interpolant(unsigned first_seed, unsigned last_seed, int least_compared) {
    int compared = 0;
    int found_by_corners = 0;
    for (unsigned seed = first_seed; seed <= last_seed; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Image image = random_image(random, {6, 6, 6});
        const Topology truth = cubical_topology(refined(image, 19));
        if (truth != cubical_topology(refined(image, 13))) {
            continue;  // details that are too small for this grid
        }
        ++compared;
        found_by_corners += cubical_topology(image) == truth ? 1 : 0;
        EXPECT_EQ(image_solid(image, {0.0})->topology(), truth);
        EXPECT_EQ(topology(image, {0.0}), truth);
    }
    EXPECT_GE(compared, least_compared);
    EXPECT_LT(found_by_corners, compared / 2);
}

TEST(ImageSolid, KnowsTheTopologyOfTheInterpolant) { expect_topology_of_the_interpolant(1, 6, 4); }

TEST(ImageSolidSweep, KnowsTheTopologyOfTheInterpolant) { expect_topology_of_the_interpolant(7, 20, 8); }

TEST(ImageSolid, KnowsItsTopology) {
    for (const Index size : {12, 25, 40}) {
        for (const Named& named : solids()) {
            SCOPED_TRACE(named.name + ", " + std::to_string(size));
            EXPECT_EQ(image_solid(sampled(as_mask(named.function), kAround, 2 * size), {0.5})->topology(),
                      named.topology);
        }
    }
    // Equal values, zeros among them; voxels that touch at edges and corners.
    Image image{{6, 6, 6}, {0, 0, 0}, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}}, std::vector<float>(216)};
    const auto set = [&](Index i, Index j, Index k) { image.values[(k * 6 + j) * 6 + i] = 1.0F; };
    set(1, 1, 1);
    set(3, 3, 3);
    EXPECT_EQ(image_solid(image, {0.5})->topology(), known_topology(2, 0, 0));
    set(2, 1, 1);
    set(3, 2, 1);
    set(3, 1, 1);
    set(3, 2, 2);
    set(3, 2, 3);
    EXPECT_EQ(image_solid(image, {0.5})->topology(), known_topology(1, 0, 0));
    image.values.assign(216, 0.0F);
    for (const auto& [i, j] : {std::array{1, 1}, {2, 1}, {3, 1}, {1, 2}, {3, 2}, {1, 3}, {2, 3}, {3, 3}}) {
        set(i, j, 2);
    }
    EXPECT_EQ(image_solid(image, {0.5})->topology(), known_topology(1, 1, 0));
    EXPECT_EQ(image_solid(image, {0.0})->topology(), known_topology(1, 1, 0));
}

TEST(ImageSolid, LoadingTellsThatSmoothingChangesTheTopology) {
    Random random(7);
    Image noise = random_image(random, {10, 10, 10});
    for (float& value : noise.values) {
        value = value > 0.0F ? 1.0F : 0.0F;
    }
    const Image round = sampled(as_mask(ball), kAround, 24);
    const auto codes_of = [](const Image& image, const LoadOptions& options) {
        std::vector<std::string> codes;
        for (const Diagnostic& warning : load_solid(image, options).warnings) {
            codes.push_back(warning.code);
        }
        return codes;
    };
    using Codes = std::vector<std::string>;
    EXPECT_EQ(codes_of(noise, {.is_nonzero = true}), Codes{"image.smoothed_topology"});
    EXPECT_EQ(codes_of(noise, {.is_nonzero = true, .mask_smoothing = 0.0}), Codes{"image.mask_volume"});
    EXPECT_EQ(codes_of(round, {.is_nonzero = true}), Codes());
}

}  // namespace
}  // namespace scaleaxis
