// SPDX-License-Identifier: Apache-2.0
/// \file
/// The fire on a complex that has vertices where it changes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "axis/edit/halving.hpp"
#include "axis/stages/fire.hpp"
#include "base/numbers.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// A complex, and the fire on it.
struct BurntComplex {
    MedialComplex complex;
    std::vector<double> radii;  ///< of the grown balls: at which the fire starts
    Sides sides;
    Sectors sectors;
    Fire fire;
};

/// \param tolerance as of `burn`
BurntComplex burnt_complex(MedialComplex complex, double tolerance = kInfinity);

/// Cuts edges inside sheets or on their border: the fire burns as before, and comes by the new vertices. \return
/// whether there was any to cut
bool cut(BurntComplex& burnt, const Halving& cuts);

/// Notes that an edge is to be cut at the part `at` of it.
void note_cut(const BurntComplex& burnt, Index edge, double at, Halving& cuts);

/// An edge inside a sheet where fires from both of its ends meet.
struct RidgeCrossing {
    std::array<double, 2> end_thickness;  ///< the erosion thickness at the ends
    double thickness;
    std::array<double, 2> end_radii;
    double radius;
};

/// When the edges of faces burn: in the middle, which may be a dip of the union; or at the ends, where fires from there
/// meet in between. Faces collapse in this order of their free edges, so that what is left has burnt last.
/// \param parts a complex whose faces are parts of those that burnt \param sides of it \param radii of its vertices
/// \param parents the face of which each of its faces is a part
/// \param counts faces whose edges are looked at; those of others have infinite times
std::vector<double> edge_times(const BurntComplex& burnt, const MedialComplex& parts, const Sides& sides,
                               const std::vector<double>& radii, std::span<const Index> parents,
                               std::span<const std::uint8_t> counts);

/// How often what is cut is looked at again.
inline constexpr int kMostCutRounds = 2;  // a third hardly finds more

/// Where fires meet between the ends of an edge: the fire, which is known at vertices, would miss the ridge.
/// \param is_missed tells whether a ridge needs a vertex
Halving cuts_at_ridges(const BurntComplex& burnt, const std::function<bool(const RidgeCrossing&)>& is_missed);

/// The radius at the part `t` of an edge. \param radii of the vertices
double radius_on_edge(const MedialComplex& complex, const std::vector<double>& radii, Index edge, double t);

}  // namespace scaleaxis::inline v1
