// SPDX-License-Identifier: Apache-2.0
/// \file
/// Point clouds that are samples of a boundary as they are, in place of stage 1.
#pragma once

#include <optional>
#include <string>

#include "scaleaxis/cloud.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/sampling.hpp"

namespace scaleaxis::inline v1 {

/// The points as samples of `∂S`, with the Delaunay tetrahedra that lie inside: those whose circumcentres are in the
/// power cell of an inner pole. Poles are told apart by propagation from the outside (N. Amenta, S. Choi, R. Kolluri,
/// "The power crust", 2001). Needs no normals, but points that are dense where the solid is thin, and no noise.
/// `tolerance` of the result is the median radius of its surface Delaunay balls.
/// \throws UnusableInput with the report's fault, or if no pole lies inside
SCALEAXIS_EXPORT Samples crust(const PreparedCloud& cloud, const Execution& execution = {});

/// How a point cloud becomes a solid.
enum class CloudMethod {
    kMovingLeastSquares,  ///< an implicit surface near the points: for any density, with noise
    kCrust,               ///< the poles of the points as they are: for dense samples without noise
};

struct CloudChoice {
    CloudMethod method = CloudMethod::kMovingLeastSquares;
    std::string reason;              ///< one line
    std::optional<Samples> samples;  ///< the crust, where that is the method
};

/// The method that suits the points: the crust for clean points without normals that form a closed surface as they are,
/// and are not so dense that they were thinned.
/// \throws UnusableInput as `crust` does
SCALEAXIS_EXPORT CloudChoice choose_method(const PreparedCloud& cloud, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
