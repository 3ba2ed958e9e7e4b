// SPDX-License-Identifier: Apache-2.0
/// \file
/// How large facets may be at each sample, so that the union of the balls stays close to the solid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sampling/crossed_facets.hpp"

namespace scaleaxis {

/// What bounds the size of a facet.
enum class SizeBound : std::uint8_t {
    kStart,      ///< the spacing of the first samples
    kThickness,  ///< how thick the solid is
    kGap,        ///< how wide a gap is
    kDip,        ///< how deep the union dips between its balls
};

/// Bounds on the radii of surface Delaunay balls at the samples, and where each comes from.
struct SizeField {
    std::vector<double> sizes;
    std::vector<SizeBound> bounds;
};

/// No size is less than this, in tolerances, so that samples are nowhere denser than uniform ones.
inline constexpr double kLeastSize = 1.0;

/// The field at the samples, 1-Lipschitz along the edges of the facets. See docs/sampling.md.
/// \param facets all crossed ones \param largest the spacing of the first samples
SizeField size_field(const LabelledTriangulation& triangulation, std::span<const CrossedFacet> facets, double tolerance,
                     double largest);

}  // namespace scaleaxis
