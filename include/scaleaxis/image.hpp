// SPDX-License-Identifier: Apache-2.0
/// \file
/// Three-dimensional images: values at the points of a grid.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// An image whose values are in an array of the caller's, which has to last for the call only. For what the members
/// mean see `Image`.
struct ImageView {
    std::array<Index, 3> sizes{};
    Point origin;
    std::array<Point, 3> steps{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
    std::span<const float> values;
};

/// What a file calls a label, as 3D Slicer does its segments.
struct LabelName {
    float label = 0.0F;
    std::string name;
};

/// The value at (i, j, k) belongs to the place `origin + i steps[0] + j steps[1] + k steps[2]`. The lengths of the
/// steps are the spacing, their directions the orientation of the image, which may be any.
struct Image {
    std::array<Index, 3> sizes{};
    Point origin;
    std::array<Point, 3> steps{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
    std::vector<float> values;  ///< sizes[0] · sizes[1] · sizes[2]; i runs fastest
    std::string unit = {};      ///< of lengths, as "mm"; empty where the image does not say
    std::string space = {};     ///< where x, y and z point, as "right-anterior-superior"; empty where it does not say
    std::vector<LabelName> label_names = {};

    operator ImageView() const { return {sizes, origin, steps, values}; }
};

/// Throws `UnusableInput`, naming the fault, if the sizes and the values do not belong together, the steps do not span
/// space, the image is too small, too large or too far from the origin to compute with, or a value is not a number.
SCALEAXIS_EXPORT void check(const ImageView& image, const Execution& execution = {});

/// A value of an image, how often it is there, and the box of indices around its voxels.
struct LabelCount {
    float label = 0.0F;
    std::int64_t voxels = 0;
    std::array<Index, 3> low{};   ///< the least index along each axis of the image
    std::array<Index, 3> high{};  ///< the largest one
    std::string name = {};        ///< as the file calls it; empty where it does not say
};

/// The values of a label image other than 0, ascending, in one pass over the image. Empty if they are no labels: not
/// all of them integers of at most 24 bits, or more than 65,535 different ones.
SCALEAXIS_EXPORT std::vector<LabelCount> labels(const ImageView& image, const Execution& execution = {});

/// As a mask: 1 where the value is one of `labels`, or other than 0 where there are none; otherwise 0.
/// \throws UnusableInput naming a label that the image does not have, or if the mask is empty; Cancelled
SCALEAXIS_EXPORT Image mask(Image image, std::span<const float> labels, const Execution& execution = {});

/// The voxels of one label as a mask, cut down to as much around them as `smoothed_mask` with any width up to
/// `smoothing_width` and `image_solid` look at: these make the same of it as of the mask of the whole image. Takes time
/// and memory for the box of the label only.
/// \param label one of `labels(image)`
/// \throws InvalidOption, Cancelled
SCALEAXIS_EXPORT Image label_mask(const ImageView& image, const LabelCount& label, double smoothing_width);

struct MaskSmoothing {
    /// Standard deviation of the smoothing, in voxels along each axis of the image; [0, 10], 0: none.
    double width = 0.7;
};

/// A grey image of a mask, above 0.5 inside, without its staircase. It is cut down to what surrounds the mask; only
/// that is copied.
///
/// The mask is blurred by a Gaussian kernel. What is taken off the values is their mean on the boundary nearby, which
/// is low where the solid is thin: so thin parts of thick solids keep their volume. Voxels that would take a part with
/// them, or part one, stay on their side. A constant keeps the volume: that of the interpolant above 0.5 is that of the
/// voxels.
/// \throws InvalidOption, Cancelled; UnusableInput if the image is unusable (see `check`) or the mask is empty
SCALEAXIS_EXPORT Image smoothed_mask(const ImageView& mask, const MaskSmoothing& options = {},
                                     const Execution& execution = {});
/// The same; the memory of `mask` is freed on the way.
SCALEAXIS_EXPORT Image smoothed_mask(Image mask, const MaskSmoothing& options = {}, const Execution& execution = {});

/// Which values of an image are inside: those above `iso`, or below it.
struct Level {
    double iso = 0.5;
    bool is_below = false;
};

/// An image above a level, without voids.
struct FilledImage {
    Image image;
    std::int64_t filled = 0;  ///< voxels
    /// Spaces outside that are separate except beyond the border of the image, as the inside of a tube that the border
    /// cuts is from what is around it; without the largest. They are not filled.
    Index open = 0;
};

/// Fills the voids of what is above `iso`: voxels from which no path over sides of voxels that are not leads to the
/// border of the image. Their values are mirrored at `iso`; those of other voxels stay.
/// \throws UnusableInput if the image is unusable (see `check`); Cancelled
SCALEAXIS_EXPORT FilledImage without_voids(Image image, double iso = 0.5, const Execution& execution = {});

/// How many voxels at the border of the image are inside.
/// \throws UnusableInput if the sizes and the values do not belong together
SCALEAXIS_EXPORT std::int64_t border_voxels(const ImageView& image, const Level& level);

/// The solid where the trilinear interpolant of an image lies above the level (or below it). Its boundary is found to
/// machine precision. Where it touches the border of the image it is closed half a voxel farther out, and `warnings()`
/// says so. Of the values only the part around the solid is copied.
///
/// `bounds()` exceeds the solid by about 1/10 of a voxel.
/// \throws UnusableInput if the image is unusable (see `check`), or no voxel is inside, or all of them are;
/// InvalidOption, Cancelled
SCALEAXIS_EXPORT std::unique_ptr<Solid> image_solid(const ImageView& image, const Level& level,
                                                    const Execution& execution = {});
/// The same; the memory of `image` is freed on the way.
SCALEAXIS_EXPORT std::unique_ptr<Solid> image_solid(Image image, const Level& level, const Execution& execution = {});

/// Topology of the solid that `image_solid` makes, which is that of the trilinear interpolant, exactly; in time linear
/// in the number of voxels.
/// \throws as `image_solid`
SCALEAXIS_EXPORT Topology topology(const ImageView& image, const Level& level, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
