// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/volume.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr int kMostPasses = 4;  // sums of 64⁴ are the largest that a float holds exactly

/// [1 2 1] along one axis.
void smooth_lines(std::vector<std::int32_t>& sums, const std::array<Index, 3>& sizes, int axis) {
    const std::array<std::ptrdiff_t, 3> strides{1, sizes[0], std::ptrdiff_t{sizes[0]} * sizes[1]};
    const int u = axis == 2 ? 1 : 2;  // shared among the threads; the other one runs within
    const int v = 3 - axis - u;
    for_each_index(
        sizes[u],
        [&](Index p) {
            for (Index q = 0; q < sizes[v]; ++q) {
                std::int32_t* at = sums.data() + p * strides[u] + q * strides[v];
                std::int32_t before = *at;
                for (Index i = 0; i < sizes[axis]; ++i) {
                    const std::int32_t here = *at;
                    const std::int32_t after = i + 1 < sizes[axis] ? at[strides[axis]] : here;
                    *at = before + 2 * here + after;
                    before = here;
                    at += strides[axis];
                }
            }
        },
        Index{1});
}

}  // namespace

std::vector<float> mask_values(const std::array<Index, 3>& sizes, std::span<const std::uint8_t> mask, int passes,
                               const Execution& execution) {
    const auto& [width, height, depth] = sizes;
    require(mask.size() == static_cast<std::size_t>(width) * height * depth && !mask.empty(),
            "a mask needs as many values as its sizes say, and at least one");
    require(passes >= 0 && passes <= kMostPasses, "a mask is smoothed 0 to 4 times");
    return in_arena(execution, [&, width = width, height = height, depth = depth] {
        auto sums = mapped<std::int32_t>(mask.size(), [&](std::size_t i) { return mask[i] != 0 ? 1 : 0; });
        std::int32_t most = 1;
        for (int pass = 0; pass < passes; ++pass, most *= 64) {
            for (int axis = 0; axis < 3; ++axis) {
                smooth_lines(sums, sizes, axis);
            }
        }
        const auto side = [&, width, height, depth](Index i, Index j, Index k) {
            const auto in = [](Index at, Index size) { return std::size_t(std::clamp<Index>(at, 0, size - 1)); };
            return mask[(in(k, depth) * height + in(j, height)) * width + in(i, width)] != 0;
        };
        // In no block of 2 x 2 x 2 voxels of its side.
        const auto is_thin = [&](Index i, Index j, Index k) {
            const bool inside = side(i, j, k);
            for (int block = 0; block < 8; ++block) {
                bool is_even = true;
                for (int c = 1; c < 8 && is_even; ++c) {
                    const auto step = [&](int bit) { return (c >> bit & 1) * ((block >> bit & 1) == 0 ? 1 : -1); };
                    is_even = side(i + step(0), j + step(1), k + step(2)) == inside;
                }
                if (is_even) {
                    return false;
                }
            }
            return true;
        };
        std::vector<float> values(mask.size());
        for_each_index(
            depth,
            [&, width, height](Index k) {
                std::size_t at = static_cast<std::size_t>(k) * height * width;
                for (Index j = 0; j < height; ++j) {
                    for (Index i = 0; i < width; ++i, ++at) {
                        const std::int32_t out = most - 2 * sums[at];  // negative inside
                        const bool inside = mask[at] != 0;
                        std::int32_t value = std::abs(out);
                        if (value == 0 || (out < 0) != inside) {
                            value = is_thin(i, j, k) ? std::max(value, 1) : 1;
                        }
                        values[at] = static_cast<float>(inside ? -value : value) / static_cast<float>(most);
                    }
                }
            },
            Index{1});
        return values;
    });
}

}  // namespace scaleaxis::inline v1
