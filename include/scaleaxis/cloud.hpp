// SPDX-License-Identifier: Apache-2.0
/// \file
/// Point clouds: samples of the boundary of a solid, and the implicit surface through them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// #P points. Those with a coordinate that is not finite or beyond 1e18 (a scanner's places without a depth)
/// count as none.
struct PointCloud {
    std::vector<Point> points;
    std::vector<Point> normals;  ///< #P, of any length, outward; (0, 0, 0) where unknown. Empty: all unknown
};

/// The same in arrays of the caller's, which have to last for the call only.
struct CloudView {
    std::span<const Point> points;
    std::span<const Point> normals;  ///< see `PointCloud`
};

struct PrepareOptions {
    /// Where points are dense, no two that are kept are closer than this, and those left out are closer than this to
    /// one that is: a length ≥ 0. Nothing is thinned where half of the points would stay. 0: all are kept. A quarter of
    /// the tolerance that the solid will be sampled with changes little.
    double thinning = 0.0;
};

/// A place where the surface of a cloud is open.
struct CloudHole {
    Point place;         ///< a point of its rim
    double width = 0.0;  ///< the diagonal of the rim's bounding box
    Index points = 0;    ///< of the rim
};

/// What `prepare` found and did.
struct CloudReport {
    Index points = 0;              ///< as given
    Index not_finite = 0;          ///< points with a coordinate that is not finite or beyond 1e18, left out
    Index duplicates = 0;          ///< points at the place of an earlier one, which were left out
    Index thinned = 0;             ///< points left out by `PrepareOptions::thinning`
    Index outliers = 0;            ///< points off the surface that the others lie on, which were left out as well
    bool has_normals = false;      ///< were normals given?
    Index unknown_normals = 0;     ///< of length 0 or not finite, among the given ones
    Index opposed_normals = 0;     ///< given ones that are against that of the nearest point
    Index flipped_normals = 0;     ///< given ones that pointed into the solid: all, or those of closed parts
    Index parts = 0;               ///< parts of the points, each oriented on its own (0: given normals)
    double spacing = 0.0;          ///< median distance of the points from each other, as a length
    double noise = 0.0;            ///< median deviation of the points from quadrics fitted to neighbours, in spacings
    double kernel = 0.0;           ///< suits the noise, for `MlsOptions`
    Index border_points = 0;       ///< points that have others on one side only
    std::vector<CloudHole> holes;  ///< that such points surround, the widest first
    Box bounds;
    Diagnostic fault;  ///< why this is no solid; empty if it may be one

    /// How many points are left.
    SCALEAXIS_EXPORT Index kept() const;
    /// Did the given normals contradict each other, so that they were turned to agree, as estimated ones are?
    SCALEAXIS_EXPORT bool are_normals_inconsistent() const;
    /// Do enough points lie on a border for the surface to be open there?
    SCALEAXIS_EXPORT bool is_open() const;
    /// What was done to the points, one line each.
    SCALEAXIS_EXPORT std::vector<Diagnostic> warnings() const;
    /// What there is to know about the normals; one line.
    SCALEAXIS_EXPORT std::string note() const;
};

/// Distinct points with unit normals that point outward.
struct PreparedCloud {
    PointCloud cloud;
    std::vector<double> spacings;  ///< #P, of the points around each
    CloudReport report;
};

/// Leaves out points that are not finite, merges those at the same place and orients the normals; those not given are
/// estimated. Given normals are believed up to their common sense: all of them are flipped if they point inward. Where
/// they contradict each other at many points, only their lines are. Never throws for bad points: `report.fault` then
/// says why they bound no solid.
/// \throws InvalidOption for a thinning that is no length, or a bad `execution`; Cancelled
SCALEAXIS_EXPORT PreparedCloud prepare(PointCloud cloud, const PrepareOptions& options = {},
                                       const Execution& execution = {});
/// The same for arrays of the caller's, which are copied once.
SCALEAXIS_EXPORT PreparedCloud prepare(const CloudView& cloud, const PrepareOptions& options = {},
                                       const Execution& execution = {});

struct MlsOptions {
    /// Radius of the weights' support, in spacings of the points around; [1.5, 100]. Larger ones smooth more. None:
    /// `CloudReport::kernel`.
    std::optional<double> kernel = {};
};

/// The solid behind the surface that moving least squares put through the points: algebraic spheres (G. Guennebaud,
/// M. Gross, "Algebraic point set surfaces", 2007), fitted to points whose normals agree (A. Öztireli and others,
/// "Feature preserving point set surfaces", 2009). Where the surface is open it is continued, and closed where it
/// leaves the hull of the points. Its `warnings()` are those of the report.
/// \throws UnusableInput with the report's fault, InvalidOption, Cancelled
SCALEAXIS_EXPORT std::unique_ptr<Solid> cloud_solid(const PreparedCloud& cloud, const MlsOptions& options = {},
                                                    const Execution& execution = {});

}  // namespace scaleaxis::inline v1
