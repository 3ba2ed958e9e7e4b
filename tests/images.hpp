// SPDX-License-Identifier: Apache-2.0
/// \file
/// Images of known solids.
#pragma once

#include <array>
#include <functional>
#include <utility>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis::test {

using Function = std::function<double(const Point&)>;

/// The values of a function at the points of a grid.
inline Image sampled(const Function& function, const std::array<Index, 3>& sizes, const Point& origin,
                     const std::array<Point, 3>& steps) {
    Image image;
    image.sizes = sizes;
    image.origin = origin;
    image.steps = steps;
    for (Index k = 0; k < sizes[2]; ++k) {
        for (Index j = 0; j < sizes[1]; ++j) {
            for (Index i = 0; i < sizes[0]; ++i) {
                const Point p = origin + i * steps[0] + j * steps[1] + k * steps[2];
                image.values.push_back(static_cast<float>(function(p)));
            }
        }
    }
    return image;
}

/// On a grid around a box, with `resolution` points along each side.
inline Image sampled(const Function& function, const Box& box, Index resolution) {
    const Point step = (1.0 / (resolution - 1)) * (box.max - box.min);
    return sampled(function, {resolution, resolution, resolution}, box.min,
                   {Point{step.x, 0, 0}, Point{0, step.y, 0}, Point{0, 0, step.z}});
}

/// 1 where the function is negative, otherwise 0.
inline Function as_mask(Function function) {
    return [function = std::move(function)](const Point& p) { return function(p) < 0.0 ? 1.0 : 0.0; };
}

/// The same image with its axes in another order and some of them turned around: all places keep their values.
/// \param axes which axis of the image is the first, second, third
/// \param turned bit `a`: turn the new axis `a` around
inline Image reordered(const Image& image, const std::array<int, 3>& axes, int turned) {
    Image result;
    result.origin = image.origin;
    for (int a = 0; a < 3; ++a) {
        result.sizes[a] = image.sizes[axes[a]];
        result.steps[a] = image.steps[axes[a]];
        if ((turned >> a & 1) != 0) {
            result.origin = result.origin + (result.sizes[a] - 1) * result.steps[a];
            result.steps[a] = -1.0 * result.steps[a];
        }
    }
    std::array<Index, 3> n{};
    for (n[2] = 0; n[2] < result.sizes[2]; ++n[2]) {
        for (n[1] = 0; n[1] < result.sizes[1]; ++n[1]) {
            for (n[0] = 0; n[0] < result.sizes[0]; ++n[0]) {
                std::array<Index, 3> from{};
                for (int a = 0; a < 3; ++a) {
                    from[axes[a]] = (turned >> a & 1) != 0 ? result.sizes[a] - 1 - n[a] : n[a];
                }
                result.values.push_back(
                    image.values[(static_cast<std::size_t>(from[2]) * image.sizes[1] + from[1]) * image.sizes[0] +
                                 from[0]]);
            }
        }
    }
    return result;
}

/// The trilinear interpolant at a point of an image whose axes are x, y and z.
inline double interpolated(const Image& image, const Point& p) {
    const Point q = p - image.origin;
    const std::array<double, 3> index{q.x / image.steps[0].x, q.y / image.steps[1].y, q.z / image.steps[2].z};
    double sum = 0.0;
    std::array<Index, 3> low{};
    for (int a = 0; a < 3; ++a) {
        low[a] = std::clamp(static_cast<Index>(std::floor(index[a])), 0, image.sizes[a] - 2);
    }
    for (int c = 0; c < 8; ++c) {
        double weight = 1.0;
        std::array<Index, 3> at{};
        for (int a = 0; a < 3; ++a) {
            const double t = index[a] - low[a];
            at[a] = low[a] + (c >> a & 1);
            weight *= (c >> a & 1) != 0 ? t : 1.0 - t;
        }
        sum +=
            weight * image.values[(static_cast<std::size_t>(at[2]) * image.sizes[1] + at[1]) * image.sizes[0] + at[0]];
    }
    return sum;
}

}  // namespace scaleaxis::test
