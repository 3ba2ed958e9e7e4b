// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 4: medial complex → the same without spurious sheets.
#pragma once

#include <cstdint>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// What the object angle of a sheet is.
enum class SheetAngle : std::uint8_t {
    kLargest,  ///< the largest on its faces, as in the paper
    kByArea,   ///< that which faces of a fifth of its area exceed: for clean axes whose balls touch the solid
};

struct FilterOptions {
    /// Sheets and curves whose object angle is smaller are candidates for removal; degrees, [0, 90].
    double angle = 30.0;
    /// With `kByArea` curves stay, and so do sheets of half a degree more at least: edges of regular polygons are to be
    /// kept or removed together. Where narrow sheets meet each other alone, as in a bar with six sides, a curve stays.
    SheetAngle measure = SheetAngle::kLargest;
};

/// The complex with object angles for those faces that have none (0), as in files: computed from the radii. Those of a
/// union of balls say where the contacts of a face are; where radii are linear (`is_linear`, `with_linear_radii`) their
/// slope is the cosine of the angle. Radii are those of the grown balls. The angle is at least 0.001 degrees, as where
/// one ball lies in another. \throws UnusableInput (see `check`)
SCALEAXIS_EXPORT MedialComplex with_object_angles(MedialComplex complex);

struct FilterStatistics {
    Index sheets_before = 0;
    Index sheets_after = 0;
    Index faces_removed = 0;
    Topology topology;  ///< of the filtered complex
};

struct FilteredComplex {
    MedialComplex complex;
    FilterStatistics statistics;
};

/// Removes sheets in order of their importance (object angle), the least first, as long as the removal is a sequence of
/// elementary collapses, which keep the homotopy type (the paper, section 4.2). The same goes for curves, chains of
/// edges without faces, with the angles at which the boundary of the grown balls is seen. Vertices whose balls are
/// larger than all around them stay, whatever the angles there. The results for growing angles are nested; with
/// `kByArea`, which asks again where sheets have become one, they need not be.
/// \param complex with object angles, unless `options.angle` is 0
/// \throws InvalidOption, UnusableInput (see `check`; or no angles), Cancelled
SCALEAXIS_EXPORT FilteredComplex filter(const MedialComplex& complex, const FilterOptions& options = {},
                                        const Execution& execution = {});

/// How large a part of the axis is as seen from the boundary: measures for the local methods.
enum class LocalMeasure {
    kObjectAngle,   ///< half the angle between the closest boundary points, degrees: θ-simplified medial axis (M.
                    ///< Foskey, M. Lin, D. Manocha, "Efficient computation of a simplified medial axis", 2003)
    kCircumradius,  ///< radius of the smallest ball around the closest boundary points: λ-medial axis (F. Chazal,
                    ///< A. Lieutier, "The λ-medial axis", 2005)
};

/// What a local method keeps, for comparison with the scale axis: the faces and the edges without faces on which the
/// measure somewhere is at least `threshold`, and what they consist of. It may change the topology.
/// \param complex with object angles or with contacts, depending on the measure
/// \param threshold degrees or a length, ≥ 0
/// \throws InvalidOption, UnusableInput (see `check`; or no angles, no contacts), Cancelled
SCALEAXIS_EXPORT FilteredComplex thresholded(const MedialComplex& complex, LocalMeasure measure, double threshold,
                                             const Execution& execution = {});

}  // namespace scaleaxis::inline v1
