// SPDX-License-Identifier: Apache-2.0
/// \file
/// Samples closer together than δ where a solid is thinner than that.
#pragma once

#include <optional>
#include <span>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/solid.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {

/// How large facets may be near balls that lie in thin parts.
class ThinSizes {
   public:
    /// \param balls their radii say how thick the solid is there \param reach how far from a ball its size holds
    ThinSizes(std::span<const Ball> balls, double reach);

    /// The size at a place; none where no ball is near.
    std::optional<double> at(const Point& place) const;

    bool empty() const { return sizes_.empty(); }
    /// Of all sizes; infinity where there is none.
    double least() const { return least_; }

   private:
    PointTree tree_;
    std::vector<double> sizes_;  // in the order of the tree
    double reach_ = 0.0;
    double least_;
};

/// As `sample` with adaptive sizes, with smaller ones near the balls. \param thin their radii say how thick the solid
/// is
Samples sample_thin_parts(const Solid& solid, const SamplingOptions& options, std::span<const Ball> thin,
                          const Execution& execution);

}  // namespace scaleaxis::inline v1
