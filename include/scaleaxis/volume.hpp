// SPDX-License-Identifier: Apache-2.0
/// \file
/// Images that are larger than memory: the axis and the thickness of one block, which are to the last bit those of the
/// whole.
///
/// All coordinates are in voxels, from the first voxel of the whole volume on. Nothing depends on the block but which
/// part of the result is given: whatever is random, and every tie, is a function of the place alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// A voxel of the volume.
using Voxel = std::array<std::int64_t, 3>;

/// Which part of a volume an array holds, and which of it is asked for: the *core*. The rest is its halo.
struct VolumeBlock {
    std::array<Index, 3> sizes{};  ///< of the array; x runs fastest
    Voxel origin{};                ///< its first voxel
    Voxel core_low{};              ///< the first voxel of the core
    Voxel core_high{};             ///< and the one after the last; cores of all blocks fill the volume
    /// Voxels of the volume along each axis. Beyond its ends nothing is inside: an array that reaches there has at
    /// least one layer of voxels more, outside.
    Voxel volume{};
    /// Layers around the array that are known to be outside, too, and are left out: the array then ends with one.
    Voxel empty_before{};
    Voxel empty_after{};  ///< the same behind it

    std::int64_t known_low(int axis) const { return origin[axis] - empty_before[axis]; }
    std::int64_t known_high(int axis) const { return origin[axis] + sizes[axis] + empty_after[axis]; }
    bool ends_low(int axis) const { return known_low(axis) < 0; }
    bool ends_high(int axis) const { return known_high(axis) > volume[axis]; }
};

/// A mask as values that are negative inside, between -1 and 1: smoothed by [1 2 1]/4 along each axis, so many times.
/// Voxels keep their side: where smoothing takes away one of a part or gap that is one voxel thick its value is
/// mirrored, elsewhere it becomes the least there is. Exact, so that it depends on the voxels around alone; within
/// `passes` voxels from the border of the array it is that of a mask which goes on as at the border.
/// \param mask 1 inside, 0 outside
/// \param passes 0 to 4
SCALEAXIS_EXPORT std::vector<float> mask_values(const std::array<Index, 3>& sizes, std::span<const std::uint8_t> mask,
                                                int passes, const Execution& execution = {});

struct VolumeAxisOptions {
    double scale = 1.1;  ///< ≥ 1
    /// Distance of any voxel in the array to the nearest one outside the solid, at most: of the whole volume, not of
    /// what the array holds.
    double largest_depth = 0.0;
    std::uint64_t seed = 1;  ///< of what is moved to be in general position
    double move = 1e-4;      ///< by how much balls are, of their radii; [0, 0.01]. One for all blocks
};

/// The axis of a block: of what the whole has, all that has its least vertex in the core. Vertices are compared by x,
/// then y, then z.
struct VolumePart {
    std::vector<Point> vertices;               ///< ascending; some of them outside the core
    std::vector<double> radii;                 ///< divided by the scale
    IndexLists faces;                          ///< ascending; the least vertex first, then the less of its neighbours
    std::vector<double> angles;                ///< of each face, its object angle in degrees
    std::vector<std::array<Index, 2>> curves;  ///< the edges without a face, ascending; the less vertex first
    std::int64_t euler = 0;                    ///< vertices in the core, less edges, plus faces
    std::int64_t solid_euler = 0;              ///< what the core adds to the Euler characteristic of the solid
    std::int64_t samples = 0;                  ///< in the array
    std::int64_t balls = 0;                    ///< that the core depends on
    double halo = 0.0;                         ///< in voxels: how much this result needs
    bool is_certain = false;                   ///< has the array that much? Otherwise a larger one may tell otherwise
};

/// The scale axis of the solid between the voxels of a volume: where the trilinear interpolant of the values is
/// negative. Samples are the crossings of the edges of the lattice.
/// \throws InvalidOption, UnusableInput; InconsistentResult (rounding: a larger move helps, in all blocks); Cancelled
SCALEAXIS_EXPORT VolumePart axis_of_block(const VolumeBlock& block, std::span<const float> values,
                                          const VolumeAxisOptions& options, const Execution& execution = {});

/// The halo that `axis_of_block` needs where no face of the axis is large, in voxels.
/// \param core_depth the largest in the core \param largest_depth as in `VolumeAxisOptions`
SCALEAXIS_EXPORT double halo_of_axis(double core_depth, double largest_depth, double scale);

/// Squared distance of each voxel inside to the nearest one outside; 0 outside. Where all voxels of the array are
/// inside, the largest number. Beyond the array nothing is outside.
SCALEAXIS_EXPORT std::vector<std::int32_t> squared_depths(const std::array<Index, 3>& sizes,
                                                          std::span<const std::uint8_t> mask,
                                                          const Execution& execution = {});

/// Local thickness of the voxels of the core, x fastest, in voxels: twice the largest depth of a voxel that is nearer
/// than its own depth; 0 outside. Needs a halo of twice the largest depth.
SCALEAXIS_EXPORT std::vector<float> thickness_of_block(const VolumeBlock& block, std::span<const std::uint8_t> mask,
                                                       const Execution& execution = {});

}  // namespace scaleaxis::inline v1
