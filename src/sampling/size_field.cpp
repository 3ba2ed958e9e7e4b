// SPDX-License-Identifier: Apache-2.0
#include "sampling/size_field.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Surface Delaunay balls may have this part of half the thickness. Both sides of a wall then are sampled so densely
// that cells between them have their centres inside.
constexpr double kOfThickness = 0.8;

// The same of half the width of a gap: a facet as large as the gap is wide does not bridge it yet, and what the gap is
// like inside does not matter.
constexpr double kOfGap = 2.0;

// Between balls of radius `R` that touch the boundary `2ρ` apart their union dips by `ρ²/2R`.
FacetSize size_at(double inner_pole, double outer_pole, double tolerance, double largest) {
    FacetSize size =
        std::min({FacetSize{largest, SizeBound::kStart}, FacetSize{kOfThickness * inner_pole, SizeBound::kThickness},
                  FacetSize{kOfGap * outer_pole, SizeBound::kGap},
                  FacetSize{std::sqrt(2.0 * kSamplingError * tolerance * inner_pole), SizeBound::kDip}});
    size.length = std::max(size.length, kLeastSize * tolerance);
    return size;
}

}  // namespace

std::vector<FacetSize> size_field(const LabelledTriangulation& triangulation, std::span<const CrossedFacet> facets,
                                  double tolerance, double largest, const ThinSizes& thin) {
    const LabelledTriangulation::PoleDistances poles = triangulation.pole_distances();
    std::vector<FacetSize> sizes(triangulation.points());
    for_each_index(sizes.size(), [&](std::size_t v) {
        sizes[v] = size_at(poles.inner[v], poles.outer[v], tolerance, largest);
        if (const std::optional<double> length = thin.at(triangulation.point(static_cast<Index>(v)))) {
            sizes[v] = std::min(sizes[v], FacetSize{*length, SizeBound::kThickness});
        }
    });
    // What sizes are in the end does not depend on the order of the facets.
    const auto relax = [&](Index v, Index w) {
        const double length = distance(triangulation.point(v), triangulation.point(w));
        const FacetSize size{sizes[w].length + length, sizes[w].bound};
        const bool is_less = size < sizes[v];
        if (is_less) {
            sizes[v] = size;
        }
        return is_less;
    };
    for (bool has_changed = true; has_changed;) {
        stop_if_cancelled();
        has_changed = false;
        for (const CrossedFacet& facet : facets) {
            for (int k = 0; k < 3; ++k) {
                const Index v = facet.vertices[k];
                const Index w = facet.vertices[(k + 1) % 3];
                has_changed |= relax(v, w) || relax(w, v);
            }
        }
    }
    return sizes;
}

}  // namespace scaleaxis::inline v1
