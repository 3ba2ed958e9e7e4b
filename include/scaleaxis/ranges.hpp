// SPDX-License-Identifier: Apache-2.0
/// \file
/// The ranges of options, for the library and for programs that check what their users give.
#pragma once

namespace scaleaxis::inline v1 {

/// All numbers from `min` to `max`, both included; no NaN.
struct Range {
    double min = 0.0;
    double max = 0.0;

    constexpr bool contains(double value) const { return value >= min && value <= max; }
};

inline constexpr Range kDeltaRange{1e-5, 0.5};           ///< tolerance δ, in diagonals of the solid's bounding box
inline constexpr Range kScaleRange{1.0, 10.0};           ///< scale s
inline constexpr Range kLargestScaleRange{1.0, 1000.0};  ///< up to which a filtration looks, and is cut
inline constexpr Range kPerturbationRange{0.0, 0.01};    ///< of balls, in their radii
inline constexpr Range kAngleRange{0.0, 90.0};           ///< object angle of the filter, degrees
inline constexpr Range kLambdaRange{0.0, 0.5};           ///< λ, in diagonals of the solid's bounding box
inline constexpr Range kCleaningRange{0.0, 0.5};         ///< erosion thickness, in diagonals of the box
inline constexpr Range kSharpAngleRange{10.0, 150.0};    ///< between the normals at a sharp edge, degrees
inline constexpr Range kCompactErrorRange{1e-6, 0.5};    ///< error of a compact axis, in diagonals of the box
inline constexpr Range kContactAngleRange{0.0,
                                          179.0};     ///< between contacts of a ball that counts for thickness, degrees
inline constexpr Range kWallAngleRange{60.0, 179.0};  ///< between contacts of a wall or gap, degrees
inline constexpr Range kWallEdgeRange{1e-4, 1.0};     ///< edges at which walls are looked at, in diagonals of the box
inline constexpr Range kElementsAcrossRange{0.1, 100.0};  ///< elements of a mesh across a wall
inline constexpr Range kGradationRange{0.01, 10.0};       ///< difference of their sizes for each unit of distance
inline constexpr Range kSpacingRange{1e-6, 1.0};          ///< of the nodes of a skeleton, in diagonals of the box
inline constexpr Range kSignificanceRange{0.0, 100.0};    ///< of the branches of a skeleton, in their radii
inline constexpr Range kSmoothingRange{0.0, 1000.0};      ///< rounds of smoothing
inline constexpr Range kMeetingAngleRange{90.0, 175.0};   ///< at which balls meet after densifying, degrees
inline constexpr Range kMostVerticesRange{1.0, 1e8};      ///< limit of the vertices after densifying
inline constexpr Range kMaskSmoothingRange{0.0, 10.0};    ///< standard deviation of the smoothing of masks, voxels
inline constexpr Range kKernelRange{1.5, 100.0};          ///< support of moving least squares, spacings of the points
inline constexpr Range kResolutionRange{8.0, 4096.0};     ///< points along the longest side of an image of distances
inline constexpr Range kThreadsRange{0.0, 1024.0};        ///< number of threads; 0: all that the machine has

}  // namespace scaleaxis::inline v1
