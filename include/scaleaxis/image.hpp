// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Three-dimensional images: values at the points of a grid.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis {

/// The value at (i, j, k) belongs to the place `origin + i steps[0] + j steps[1] + k steps[2]`. The lengths of the
/// steps are the spacing, their directions the orientation of the image, which may be any.
struct Image {
    std::array<Index, 3> sizes{};
    Point origin;
    std::array<Point, 3> steps{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
    std::vector<float> values;  ///< i runs fastest
};

/// Throws `UnusableShape`, naming the fault, if the sizes and the values do not belong together, the steps do not span
/// space, or a value is not a number.
void check(const Image& image);

/// A value of an image and how often it is there.
struct LabelCount {
    float label = 0.0F;
    std::int64_t voxels = 0;
};

/// The values of a label image other than 0, ascending. Empty if they are no labels: not all of them integers of at
/// most 24 bits, or more than 65,535 different ones.
std::vector<LabelCount> labels(const Image& image);

/// As a mask: 1 where the value is one of `labels`, or other than 0 where there are none; otherwise 0.
/// \throws UnusableShape naming a label that the image does not have, or if the mask is empty
Image mask(Image image, std::span<const float> labels);

struct MaskSmoothing {
    /// Standard deviation of the smoothing, in voxels along each axis of the image; [0, 10], 0: none.
    double width = 0.7;
};

/// A grey image of a mask, above 0.5 inside, without its staircase. It is cut down to what surrounds the mask.
///
/// The mask is smoothed by a Gaussian kernel, and a constant is added that keeps its volume. Voxels of parts and gaps
/// that are one voxel thick (in no block of 2 x 2 x 2 voxels of their side) would be lost: where they end up far on the
/// wrong side they are mirrored back.
/// \throws InvalidOption, Cancelled; UnusableShape if nothing is left of it
Image smoothed_mask(Image mask, const MaskSmoothing& options = {}, const Execution& execution = {});

/// Which values of an image are inside: those above `iso`, or below it.
struct Level {
    double iso = 0.5;
    bool is_below = false;
};

/// How many voxels at the border of the image are inside.
std::int64_t border_voxels(const Image& image, const Level& level);

}  // namespace scaleaxis
