// SPDX-License-Identifier: Apache-2.0
#include "solid/image/mask_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

using VoxelValues = std::array<float, 27>;

// Lines through a voxel along each of the first two axes. Along the third, mostly that of slices, which may be as thick
// as the part, the interpolant is linear from voxel to voxel, and crosses the level where it says.
constexpr int kLinesAlong = 5;

/// Interpolates along one axis. \param from `outer` times three values `inner` apart \param to as many times
/// `kLinesAlong` values
void interpolate_along(const float* from, float* to, int outer, int inner) {
    for (int o = 0; o < outer; ++o) {
        for (int n = 0; n < kLinesAlong; ++n) {
            const float at = (static_cast<float>(n) + 0.5F) / kLinesAlong - 0.5F;
            const float* middle = from + (3 * o + 1) * inner;
            const float* next = middle + (at < 0.0F ? -inner : inner);
            const float part = std::abs(at);
            for (int i = 0; i < inner; ++i) {
                *to++ = (1.0F - part) * middle[i] + part * next[i];
            }
        }
    }
}

/// The part above the level of the half of a line between two voxels that is nearer to the first.
float half_above(float first, float second, float level) {
    const float a = first - level;
    const float b = 0.5F * (first + second) - level;
    if (a > 0.0F && b > 0.0F) {
        return 1.0F;
    }
    return a <= 0.0F && b <= 0.0F ? 0.0F : std::max(a, b) / std::abs(a - b);
}

/// The part of a voxel above the level.
double part_above(const VoxelValues& values, float level) {
    const auto [least, most] = std::ranges::minmax(values);
    if (most <= level) {
        return 0.0;
    }
    if (least > level) {
        return 1.0;
    }
    constexpr int kLines = kLinesAlong * kLinesAlong;
    std::array<float, 9 * kLinesAlong> across{};
    std::array<float, 3 * kLines> lines{};
    interpolate_along(values.data(), across.data(), 9, 1);
    interpolate_along(across.data(), lines.data(), 3, kLinesAlong);
    double sum = 0.0;
    for (int i = 0; i < kLines; ++i) {
        const float middle = lines[kLines + i];
        sum += half_above(middle, lines[i], level) + half_above(middle, lines[2 * kLines + i], level);
    }
    return sum / (2.0 * kLines);
}

}  // namespace

double interpolated_volume(const ImageView& image, float level) {
    const Index width = image.sizes[0];
    const Index height = image.sizes[1];
    const Index depth = image.sizes[2];
    std::vector<double> parts(depth);
    for_each_index(
        static_cast<std::size_t>(depth),
        [&](std::size_t slice) {
            const auto k = static_cast<Index>(slice);
            for (Index j = 0; j < height; ++j) {
                std::array<const float*, 9> rows{};
                for (int dk = -1; dk <= 1; ++dk) {
                    for (int dj = -1; dj <= 1; ++dj) {
                        const std::size_t z = std::clamp<Index>(k + dk, 0, depth - 1);
                        const std::size_t y = std::clamp<Index>(j + dj, 0, height - 1);
                        rows[3 * (dk + 1) + dj + 1] = image.values.data() + (z * height + y) * width;
                    }
                }
                for (Index i = 0; i < width; ++i) {
                    const std::array<Index, 3> at{std::max(i - 1, 0), i, std::min(i + 1, width - 1)};
                    VoxelValues values{};
                    for (int row = 0; row < 9; ++row) {
                        for (int n = 0; n < 3; ++n) {
                            values[3 * row + n] = rows[row][at[n]];
                        }
                    }
                    parts[slice] += part_above(values, level);
                }
            }
        },
        std::size_t{1});
    return std::accumulate(parts.begin(), parts.end(), 0.0);
}

}  // namespace scaleaxis::inline v1
