// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis::inline v1 {

/// A view of an image in the order in which its axes are nearest to x, y and z and point the same way: so that results
/// do not depend on the order in which values are stored.
struct CanonicalImage {
    std::array<Index, 3> sizes{};
    Point origin;
    std::array<Point, 3> steps;
    const float* first = nullptr;             ///< the value at (0, 0, 0)
    std::array<std::ptrdiff_t, 3> strides{};  ///< from a value to the next one along each axis
    std::array<int, 3> axes{};                ///< that of the image which each axis is
    std::array<bool, 3> is_turned{};          ///< whether it runs the other way

    /// `count` values along the first axis. \param memory holds them where they do not lie beside each other
    std::span<const float> row(Index begin, Index count, Index j, Index k, std::vector<float>& memory) const {
        const float* values = first + begin * strides[0] + j * strides[1] + k * strides[2];
        if (strides[0] == 1) {
            return {values, static_cast<std::size_t>(count)};
        }
        memory.resize(count);
        for (Index i = 0; i < count; ++i) {
            memory[i] = values[i * strides[0]];
        }
        return memory;
    }
    std::span<const float> row(Index j, Index k, std::vector<float>& memory) const {
        return row(0, sizes[0], j, k, memory);
    }
};

/// \param image has passed `check`
CanonicalImage canonical(const ImageView& image);

/// Ranges of indices, the ends of which belong to them.
struct IndexBox {
    std::array<Index, 3> low{};
    std::array<Index, 3> high{};
};

/// Those voxels of an image that are inside, and the box of indices around them.
struct InsideVoxels {
    std::int64_t count = 0;
    std::array<Index, 3> low{};  ///< meaningful if there are any
    std::array<Index, 3> high{};
};

template <class Predicate>
InsideVoxels inside_voxels(const CanonicalImage& image, const Predicate& is_inside) {
    InsideVoxels result{0, image.sizes, {-1, -1, -1}};
    std::vector<float> memory;
    for (Index k = 0; k < image.sizes[2]; ++k) {
        stop_if_cancelled();
        for (Index j = 0; j < image.sizes[1]; ++j) {
            const std::span<const float> row = image.row(j, k, memory);
            Index count = 0;
            for (const float value : row) {
                count += is_inside(value) ? 1 : 0;
            }
            if (count > 0) {
                const auto first = std::find_if(row.begin(), row.end(), is_inside);
                const auto last = std::find_if(row.rbegin(), row.rend(), is_inside);
                const std::array<Index, 3> from{static_cast<Index>(first - row.begin()), j, k};
                const std::array<Index, 3> to{static_cast<Index>(row.rend() - last) - 1, j, k};
                for (int axis = 0; axis < 3; ++axis) {
                    result.low[axis] = std::min(result.low[axis], from[axis]);
                    result.high[axis] = std::max(result.high[axis], to[axis]);
                }
                result.count += count;
            }
        }
    }
    return result;
}

}  // namespace scaleaxis::inline v1
