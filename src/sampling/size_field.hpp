// SPDX-License-Identifier: Apache-2.0
/// \file
/// How large facets may be at each sample, so that the union of the balls stays close to the solid.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "sampling/crossed_facets.hpp"
#include "sampling/thin_sizes.hpp"

namespace scaleaxis::inline v1 {

/// What bounds the size of a facet.
enum class SizeBound : std::uint8_t {
    kStart,      ///< the spacing of the first samples
    kThickness,  ///< how thick the solid is
    kGap,        ///< how wide a gap is
    kDip,        ///< how deep the union dips between its balls
};

/// A bound on the radii of surface Delaunay balls. Of equal ones the first in the order of `SizeBound` counts.
struct FacetSize {
    double length = 0.0;
    SizeBound bound = SizeBound::kStart;

    friend auto operator<=>(const FacetSize&, const FacetSize&) = default;
};

/// How far the boundary may be from what stands for it, in tolerances, while samples are still moved and added to: the
/// union between its balls, facets, and points that nothing has shown yet. The rest up to δ/2 is for fitting, which
/// draws in balls that stick out.
inline constexpr double kSamplingError = 0.4;

/// No size is less than this, in tolerances, except in thin parts, so that samples are no denser than uniform ones.
inline constexpr double kLeastSize = 1.0;

/// Sizes at the samples, 1-Lipschitz along the edges of the facets. See docs/dev/sampling.md.
/// \param facets all crossed ones \param largest the spacing of the first samples
std::vector<FacetSize> size_field(const LabelledTriangulation& triangulation, std::span<const CrossedFacet> facets,
                                  double tolerance, double largest, const ThinSizes& thin);

}  // namespace scaleaxis::inline v1
