// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Point clouds: samples of the boundary of a solid, and the two ways from there on: an implicit surface through them
/// (a `Shape`, for stage 1), or their poles directly (in place of stage 1).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/shape.hpp"

namespace scaleaxis {

/// #P points.
struct PointCloud {
    std::vector<Point> points;
    std::vector<Point> normals;  ///< #P, of any length, outward; (0, 0, 0) where unknown. Empty: all unknown
};

/// What `prepare` found and did.
struct CloudReport {
    Index points = 0;                  ///< as given
    Index duplicates = 0;              ///< points at the place of an earlier one, which were left out
    Index outliers = 0;                ///< points far from all others, which were left out as well
    bool has_normals = false;          ///< were normals given?
    Index unknown_normals = 0;         ///< of length 0 or not finite, among the given ones
    Index opposed_normals = 0;         ///< given ones that are against that of the nearest point
    bool are_normals_flipped = false;  ///< the given normals pointed inward
    Index parts = 0;          ///< the points fall into so many parts, each oriented on its own (0: given normals)
    double spacing = 0.0;     ///< median distance of the points from each other, as a length
    double noise = 0.0;       ///< median deviation of the points from quadrics fitted to neighbours, in spacings
    double kernel = 0.0;      ///< suits the noise, for `MlsOptions`
    Index border_points = 0;  ///< points that have others on one side only
    Box bounds;
    std::string fault;  ///< why this is no solid; empty if it may be one

    /// Do so many given normals contradict each other that they were turned to agree, as estimated ones are?
    bool are_normals_inconsistent() const;
    /// What was done to the points, one line each.
    std::vector<std::string> warnings() const;
    /// What there is to know about the normals; one line.
    std::string note() const;
};

/// Distinct points with unit normals that point outward.
struct PreparedCloud {
    PointCloud cloud;
    std::vector<double> spacings;  ///< #P, of the points around each
    CloudReport report;
};

/// Merges points at the same place and orients the normals; those not given are estimated. Given normals are
/// believed up to their common sense: all of them are flipped if they point inward. Where they contradict each other at
/// many points, only their lines are.
PreparedCloud prepare(PointCloud cloud, const Execution& execution = {});

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

/// The method that suits the points: the crust for clean points without normals that form a closed surface as they are.
/// \throws UnusableShape as `crust` does
CloudChoice choose_method(const PreparedCloud& cloud, const Execution& execution = {});

struct MlsOptions {
    /// Radius of the weights' support, in spacings of the points around; [1.5, 100]. Larger ones smooth more. None:
    /// `CloudReport::kernel`.
    std::optional<double> kernel = {};
};

/// The solid behind the surface that moving least squares put through the points: algebraic spheres (G. Guennebaud,
/// M. Gross, "Algebraic point set surfaces", 2007), fitted to points whose normals agree (A. Öztireli and others,
/// "Feature preserving point set surfaces", 2009). Where the surface is open it is continued, and closed where it
/// leaves the hull of the points. \throws UnusableShape with the report's fault, InvalidOption
std::unique_ptr<Shape> moving_least_squares(const PreparedCloud& cloud, const MlsOptions& options = {},
                                            const Execution& execution = {});

/// The points as samples of `∂S`, with the Delaunay tetrahedra that lie inside: those whose circumcentres are in the
/// power cell of an inner pole. Poles are told apart by propagation from the outside (N. Amenta, S. Choi, R. Kolluri,
/// "The power crust", 2001). Needs no normals, but points that are dense where the solid is thin, and no noise.
/// `tolerance` of the result is the median radius of its surface Delaunay balls.
/// \throws UnusableShape with the report's fault, or if no pole lies inside
Samples crust(const PreparedCloud& cloud, const Execution& execution = {});

}  // namespace scaleaxis
