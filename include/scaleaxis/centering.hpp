// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 6, last part: vertices of the axis in the middle of the solid itself.
#pragma once

#include <cstdint>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

struct CenterOptions {
    /// Tolerance δ of the sampling, a length > 0: no vertex moves farther, and no ball grows by more.
    double tolerance = 0.0;
};

struct CenterStatistics {
    Index fitted = 0;            ///< balls that touch the solid now
    Index moved = 0;             ///< of these, with another centre
    double largest_move = 0.0;   ///< of a centre
    double mean_growth = 0.0;    ///< of the radii of all vertices
    Index halved = 0;            ///< edges with a new vertex in the middle
    std::int64_t questions = 0;  ///< points asked for the nearest one of the boundary
};

struct CenteredComplex {
    MedialComplex complex;
    CenterStatistics statistics;
};

/// Makes the balls of an axis touch the solid. Those of the medial axis of a union end where spheres meet, which is
/// inside the solid where the balls of the union fit it. A vertex goes to where the tangent planes of the solid at the
/// contacts of its ball are equally far, if its ball becomes larger there: those in a sheet have two sides, on seams
/// three, in junctions four. Vertices on curves see the solid around them. The radius becomes the distance from the
/// boundary of the solid. What has changed is `kTouching`. Vertices that are centres of input balls and those of
/// radius 0 stay as they are, and so do balls that stick out of the solid. Connectivity does not change, except of
/// faces that end in balls of radius 0: their edges are halved where balls in between do not touch the solid. \param
/// complex part of the medial axis of a union of balls, filtered and shrunk; its contacts are those before
///     shrinking \throws InvalidOption, UnusableInput (see `check`; or the solid does not know nearest points),
///     Cancelled
SCALEAXIS_EXPORT CenteredComplex center(MedialComplex complex, const Solid& solid, const CenterOptions& options,
                                        const Execution& execution = {});

}  // namespace scaleaxis::inline v1
