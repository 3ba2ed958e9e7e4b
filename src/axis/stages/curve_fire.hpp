// SPDX-License-Identifier: Apache-2.0
/// \file
/// The fire on curves, once it has burnt the sheets.
#pragma once

#include <vector>

#include "axis/edit/remainder.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// An edge without faces, burnt from a tip on.
struct BurntEdge {
    Index edge;
    Index from;
    Index to;       // the vertex that the fire came to
    Index feeder;   // of the burnt edges before, the one on which the fire came last
    Index next;     // the burnt edge after
    double length;  // from the tip to `to`, straight
    double time;    // at `to`
};

/// Burns the edges that are left without faces, from their tips on, in the order of time; where several come together
/// the fire goes on when the last one but one has come.
/// \param start_times of the vertices: a fire that starts or comes by there burns on no sooner
std::vector<BurntEdge> burn_curves(const MedialComplex& complex, const std::vector<double>& start_times,
                                   Remainder remainder);

}  // namespace scaleaxis::inline v1
