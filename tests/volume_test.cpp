// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

struct Mask {
    std::array<Index, 3> sizes;
    std::vector<std::uint8_t> values;

    std::size_t place(Index i, Index j, Index k) const {
        return (static_cast<std::size_t>(k) * sizes[1] + j) * sizes[0] + i;
    }
};

template <class IsInside>
Mask mask_of(const std::array<Index, 3>& sizes, const IsInside& is_inside) {
    Mask mask{sizes, {}};
    for (Index k = 0; k < sizes[2]; ++k) {
        for (Index j = 0; j < sizes[1]; ++j) {
            for (Index i = 0; i < sizes[0]; ++i) {
                mask.values.push_back(is_inside(i, j, k) ? 1 : 0);
            }
        }
    }
    return mask;
}

Mask random_mask(const std::array<Index, 3>& sizes, double share) {
    std::mt19937 random(7);
    return mask_of(sizes, [&](Index, Index, Index) { return static_cast<double>(random()) < share * 4294967296.0; });
}

// A bar of 5 x 5 voxels with a hole, along x.
constexpr std::array<Index, 3> kBar{120, 9, 9};
Mask bar() {
    return mask_of(kBar, [](Index i, Index j, Index k) {
        const bool is_hole = i > 57 && i < 63 && j == 4;
        return i > 2 && i < 117 && j > 1 && j < 7 && k > 1 && k < 7 && !is_hole;
    });
}

// The axis of the bar between two planes, from an array with a layer beyond the volume and a halo along x.
VolumePart part_of_bar(Index low, Index high, Index halo) {
    const Mask mask = bar();
    const Index begin = std::max(low - halo, -1);
    const Index end = std::min(high + halo + 1, kBar[0] + 1);
    const VolumeBlock block{{end - begin, 11, 11}, {begin, -1, -1}, {low, 0, 0}, {high, 9, 9}, {120, 9, 9}};
    std::vector<float> values;
    for (Index k = -1; k < 10; ++k) {
        for (Index j = -1; j < 10; ++j) {
            for (Index i = begin; i < end; ++i) {
                const bool is_within = std::min({i, j, k}) >= 0 && i < kBar[0] && j < 9 && k < 9;
                values.push_back(is_within && mask.values[mask.place(i, j, k)] != 0 ? -1.0F : 1.0F);
            }
        }
    }
    return axis_of_block(block, values, {1.1, 3.0});
}

std::set<std::vector<double>> faces_of(const VolumePart& part) {
    std::set<std::vector<double>> faces;
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
        std::vector<double> numbers{part.angles[f]};
        for (const Index v : part.faces[f]) {
            const auto& [x, y, z] = part.vertices[v];
            numbers.insert(numbers.end(), {x, y, z, part.radii[v]});
        }
        EXPECT_TRUE(faces.insert(numbers).second);
    }
    return faces;
}

TEST(Volume, BlocksGiveWhatTheWholeGives) {
    const VolumePart whole = part_of_bar(0, 120, 1);
    ASSERT_TRUE(whole.is_certain);
    EXPECT_EQ(whole.solid_euler, 0);
    EXPECT_EQ(whole.euler, 0);
    std::set<std::vector<double>> all;
    std::int64_t euler = 0;
    std::int64_t solid_euler = 0;
    for (Index low = 0; low < 120; low += 30) {
        const auto halo = static_cast<Index>(std::ceil(halo_of_axis(3.0, 3.0, 1.1))) + 1;
        const VolumePart part = part_of_bar(low, low + 30, halo);
        ASSERT_TRUE(part.is_certain);
        euler += part.euler;
        solid_euler += part.solid_euler;
        const auto faces = faces_of(part);
        for (const auto& face : faces) {
            EXPECT_TRUE(all.insert(face).second) << "a face has two owners";
        }
    }
    EXPECT_EQ(all, faces_of(whole));
    EXPECT_EQ(euler, whole.euler);
    EXPECT_EQ(solid_euler, whole.solid_euler);
}

// The bar in a volume that is empty but for it, from an array of its own size, and from one that has the voids, too.
TEST(Volume, VoidsMayBeLeftOut) {
    const Mask mask = bar();
    const auto part_with = [&](Index layers, const Voxel& low, const Voxel& high, Index empty) {
        const std::array<Index, 3> sizes{kBar[0] + 2 * layers, kBar[1] + 2 * layers, kBar[2] + 2 * layers};
        std::vector<float> values;
        for (Index k = -layers; k < kBar[2] + layers; ++k) {
            for (Index j = -layers; j < kBar[1] + layers; ++j) {
                for (Index i = -layers; i < kBar[0] + layers; ++i) {
                    const bool is_within = std::min({i, j, k}) >= 0 && i < kBar[0] && j < kBar[1] && k < kBar[2];
                    values.push_back(is_within && mask.values[mask.place(i, j, k)] != 0 ? -1.0F : 1.0F);
                }
            }
        }
        const Voxel at{90 - layers, 90 - layers, 90 - layers};
        return axis_of_block({sizes, at, low, high, {300, 300, 300}, {empty, empty, empty}, {empty, empty, empty}},
                             values, {1.1, 3.0});
    };
    // Both halos are known as far; the core begins in the voids, and lies in them for the third block.
    const std::array<std::array<Voxel, 2>, 3> cores{
        {{{{80, 80, 80}, {220, 110, 110}}}, {{{150, 80, 80}, {220, 110, 110}}}, {{{80, 80, 80}, {110, 88, 110}}}}};
    for (const auto& [low, high] : cores) {
        const VolumePart full = part_with(60, low, high, 0);
        const VolumePart cut = part_with(0, low, high, 60);
        ASSERT_TRUE(full.is_certain && cut.is_certain);
        EXPECT_EQ(faces_of(cut), faces_of(full));
        EXPECT_EQ(cut.euler, full.euler);
        EXPECT_EQ(cut.solid_euler, full.solid_euler);
        EXPECT_EQ(cut.samples, full.samples);
        EXPECT_EQ(cut.halo, full.halo);
    }
    // What is not known is not believed to be empty.
    EXPECT_FALSE(part_with(0, {150, 90, 90}, {200, 97, 97}, 2).is_certain);
    EXPECT_THROW(part_with(0, cores[0][0], cores[0][1], 2), InvalidOption);
}

TEST(Volume, SmallHalosAreFoundOut) {
    const VolumePart part = part_of_bar(30, 60, 10);
    EXPECT_FALSE(part.is_certain);
    EXPECT_GT(part.halo, 10.0);
}

TEST(Volume, MaskValuesKeepTheSideOfEachVoxel) {
    const Mask mask = random_mask({17, 12, 9}, 0.4);
    for (int passes = 0; passes <= 4; ++passes) {
        const std::vector<float> values = mask_values(mask.sizes, mask.values, passes);
        for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_EQ(values[i] < 0.0F, mask.values[i] != 0);
            ASSERT_LE(std::abs(values[i]), 1.0F);
        }
    }
    EXPECT_THROW(mask_values(mask.sizes, mask.values, 5), InvalidOption);
}

TEST(Volume, MaskValuesOfAPlaneAreSymmetric) {
    const Mask mask = mask_of({8, 6, 6}, [](Index i, Index, Index) { return i < 4; });
    const std::vector<float> values = mask_values(mask.sizes, mask.values, 1);
    EXPECT_FLOAT_EQ(values[mask.place(3, 3, 3)], -0.5F);
    EXPECT_FLOAT_EQ(values[mask.place(4, 3, 3)], 0.5F);
    EXPECT_FLOAT_EQ(values[mask.place(2, 3, 3)], -1.0F);
}

TEST(Volume, DepthsAreThoseOfBruteForce) {
    for (const double share : {0.5, 0.97, 1.0}) {
        const Mask mask = random_mask({11, 8, 7}, share);
        const std::vector<std::int32_t> depths = squared_depths(mask.sizes, mask.values);
        const auto& [width, height, depth] = mask.sizes;
        for (std::size_t p = 0; p < depths.size(); ++p) {
            std::int64_t least = std::numeric_limits<std::int32_t>::max();
            for (std::size_t q = 0; q < depths.size(); ++q) {
                const auto at = [width = width, height = height](std::size_t n) {
                    const auto number = static_cast<std::int64_t>(n);
                    return std::array{number % width, number / width % height, number / width / height};
                };
                const auto [a, b, c] = at(p);
                const auto [x, y, z] = at(q);
                if (mask.values[q] == 0) {
                    least = std::min(least, (a - x) * (a - x) + (b - y) * (b - y) + (c - z) * (c - z));
                }
            }
            ASSERT_EQ(depths[p], least);
        }
    }
}

TEST(Volume, ThicknessOfABallIsItsDiameter) {
    const auto square = [](Index i) { return (i - 10) * (i - 10); };
    const Mask mask =
        mask_of({21, 21, 21}, [&](Index i, Index j, Index k) { return square(i) + square(j) + square(k) < 64; });
    const VolumeBlock block{mask.sizes, {0, 0, 0}, {0, 0, 0}, {21, 21, 21}, {21, 21, 21}};
    const std::vector<float> thickness = thickness_of_block(block, mask.values);
    for (std::size_t i = 0; i < thickness.size(); ++i) {
        ASSERT_FLOAT_EQ(thickness[i], mask.values[i] != 0 ? 16.0F : 0.0F);
    }
}

// More than a tile in each direction, deep and shallow; and of a core alone.
TEST(Volume, ThicknessIsThatOfBruteForce) {
    const std::array<Index, 3> sizes{75, 38, 36};
    const auto wave = [](Index i, Index period) { return std::abs(i % (2 * period) - period); };
    const Mask mask = mask_of(sizes, [&](Index i, Index j, Index k) {
        return wave(i, 19) + wave(j, 13) + wave(k, 11) > 15 && (i + 2 * j + 3 * k) % 41 != 0;
    });
    const std::vector<std::int32_t> depths = squared_depths(sizes, mask.values);
    std::vector<std::int32_t> largest(depths.size());
    for (Index k = 0; k < sizes[2]; ++k) {
        for (Index j = 0; j < sizes[1]; ++j) {
            for (Index i = 0; i < sizes[0]; ++i) {
                const std::int32_t depth = depths[mask.place(i, j, k)];
                for (Index z = 0; z < sizes[2]; ++z) {
                    for (Index y = 0; y < sizes[1]; ++y) {
                        const Index away = (z - k) * (z - k) + (y - j) * (y - j);
                        for (Index x = 0; away < depth && x < sizes[0]; ++x) {
                            if (away + (x - i) * (x - i) < depth) {
                                std::int32_t& here = largest[mask.place(x, y, z)];
                                here = std::max(here, depth);
                            }
                        }
                    }
                }
            }
        }
    }
    EXPECT_GT(*std::ranges::max_element(largest), 15);
    const std::array<Index, 3> low{5, 3, 0};
    const std::array<Index, 3> high{75, 37, 30};
    const VolumeBlock whole{sizes, {0, 0, 0}, {0, 0, 0}, {75, 38, 36}, {75, 38, 36}};
    const VolumeBlock part{sizes, {0, 0, 0}, {5, 3, 0}, {75, 37, 30}, {75, 38, 36}};
    const std::vector<float> all = thickness_of_block(whole, mask.values);
    const std::vector<float> of_core = thickness_of_block(part, mask.values);
    std::size_t n = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        ASSERT_FLOAT_EQ(all[i], 2.0F * std::sqrt(static_cast<float>(largest[i])));
    }
    for (Index k = low[2]; k < high[2]; ++k) {
        for (Index j = low[1]; j < high[1]; ++j) {
            for (Index i = low[0]; i < high[0]; ++i) {
                ASSERT_EQ(of_core[n++], all[mask.place(i, j, k)]);
            }
        }
    }
}

// Deeper than what is found step by step, and wider than the lines that are taken together.
TEST(Volume, DepthsOfDeepSolidsAreThoseOfBruteForce) {
    const std::array<Index, 3> sizes{50, 45, 47};
    const Mask mask = mask_of(sizes, [](Index i, Index j, Index k) { return (i * j + 3 * k) % 1999 != 7; });
    const std::vector<std::int32_t> depths = squared_depths(sizes, mask.values);
    std::vector<std::array<Index, 3>> outside;
    for (Index k = 0; k < sizes[2]; ++k) {
        for (Index j = 0; j < sizes[1]; ++j) {
            for (Index i = 0; i < sizes[0]; ++i) {
                if (mask.values[mask.place(i, j, k)] == 0) {
                    outside.push_back({i, j, k});
                }
            }
        }
    }
    ASSERT_FALSE(outside.empty());
    for (Index k = 0; k < sizes[2]; ++k) {
        for (Index j = 0; j < sizes[1]; ++j) {
            for (Index i = 0; i < sizes[0]; ++i) {
                std::int32_t least = std::numeric_limits<std::int32_t>::max();
                for (const auto& [x, y, z] : outside) {
                    least = std::min(least, (x - i) * (x - i) + (y - j) * (y - j) + (z - k) * (z - k));
                }
                ASSERT_EQ(depths[mask.place(i, j, k)], least);
            }
        }
    }
    EXPECT_GT(*std::ranges::max_element(depths), 17 * 17);
}

TEST(Volume, RefusesWhatDoesNotFit) {
    const std::vector<float> values(27, 1.0F);
    EXPECT_THROW(axis_of_block({{3, 3, 3}, {0, 0, 0}, {0, 0, 0}, {4, 3, 3}, {9, 9, 9}}, values, {}), InvalidOption);
    EXPECT_THROW(axis_of_block({{3, 3, 2}, {0, 0, 0}, {0, 0, 0}, {2, 2, 2}, {9, 9, 9}}, values, {}), InvalidOption);
    EXPECT_THROW(axis_of_block({{3, 3, 3}, {-1, -1, -1}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}}, values, {0.5}),
                 InvalidOption);
}

}  // namespace
}  // namespace scaleaxis
