// SPDX-License-Identifier: Apache-2.0
#include "sampling/size_field.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/parallel.hpp"

namespace scaleaxis {
namespace {

// Between balls of radius `R` that touch the boundary `2ρ` apart their union dips by `ρ²/2R`; this is how deep it may,
// in tolerances. The rest up to δ/2 is for fitting, which moves the balls.
constexpr double kDip = 0.4;

// Surface Delaunay balls may have this part of half the thickness. Both sides of a wall then are sampled so densely
// that cells between them have their centres inside.
constexpr double kOfThickness = 0.8;

// The same of half the width of a gap: a facet as large as the gap is wide does not bridge it yet, and what the gap is
// like inside does not matter.
constexpr double kOfGap = 2.0;

std::pair<double, SizeBound> size_at(double inner_pole, double outer_pole, double tolerance, double largest) {
    using Bound = std::pair<double, SizeBound>;
    const Bound least =
        std::min({Bound{largest, SizeBound::kStart}, Bound{kOfThickness * inner_pole, SizeBound::kThickness},
                  Bound{kOfGap * outer_pole, SizeBound::kGap},
                  Bound{std::sqrt(2.0 * kDip * tolerance * inner_pole), SizeBound::kDip}});
    return {std::max(least.first, kLeastSize * tolerance), least.second};
}

}  // namespace

SizeField size_field(const LabelledTriangulation& triangulation, std::span<const CrossedFacet> facets, double tolerance,
                     double largest) {
    const LabelledTriangulation::PoleDistances poles = triangulation.pole_distances();
    SizeField field{std::vector<double>(triangulation.points()), std::vector<SizeBound>(triangulation.points())};
    for (std::size_t v = 0; v < triangulation.points(); ++v) {
        std::tie(field.sizes[v], field.bounds[v]) = size_at(poles.inner[v], poles.outer[v], tolerance, largest);
    }
    // What sizes are in the end does not depend on the order of the facets.
    const auto relax = [&](Index v, Index w) {
        const double size = field.sizes[w] + distance(triangulation.point(v), triangulation.point(w));
        const bool is_less = size < field.sizes[v];
        if (is_less) {
            field.sizes[v] = size;
            field.bounds[v] = field.bounds[w];
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
    return field;
}

}  // namespace scaleaxis
