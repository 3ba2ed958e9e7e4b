// SPDX-License-Identifier: Apache-2.0
/// \file
/// The boundary of an envelope as points, and how far it is.
#pragma once

#include <vector>

#include "axis/envelope_data.hpp"
#include "scaleaxis/envelope.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {

class EnvelopeBoundary {
   public:
    /// \param spacing of the points: every point of the boundary is at most this far from one of them
    /// \throws InvalidOption if they would be too many
    EnvelopeBoundary(const Envelope& envelope, double spacing);

    const std::vector<SurfacePoint>& points() const { return points_; }

    /// The distance of a point, inside or outside, to the boundary. Where a re-entrant edge is nearest to a point
    /// inside, it is too small by up to the spacing.
    double distance(const Point& p) const;

   private:
    Envelope envelope_;
    double spacing_;
    std::vector<SurfacePoint> points_;
    PointTree tree_;
};

}  // namespace scaleaxis::inline v1
