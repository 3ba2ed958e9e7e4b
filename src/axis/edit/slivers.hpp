// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sheets so narrow that they are but a seam, or the border of another one.
#pragma once

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// Draws sheets together that are narrower on average than balls of a union are off, `tolerance` / 2, or than a quarter
/// of their smallest ball, by contracting their edges where that keeps the homotopy type; and crumbs, whatever their
/// balls. Sheets at sharp edges of the solid, with balls of radius 0, stay. \param complex with balls that touch the
/// solid: where four sheets of it meet in one seam, a fifth between them has no width \param tolerance infinite: balls
/// alone tell what is narrow
MedialComplex without_slivers(MedialComplex complex, double tolerance);

/// Seams that end less than a `tolerance` before the border of a sheet that is folded along them end on it, so that the
/// sheets on both sides of them are two.
MedialComplex with_seams_to_borders(MedialComplex complex, double tolerance);
/// \param reaches of the vertices: how far from the end of a seam the border may be
/// \param may_be_flat sheets need not be folded: where walls meet two of them often lie in one plane
MedialComplex with_seams_to_borders(MedialComplex complex, std::span<const double> reaches, bool may_be_flat);

/// Contracts edges with an end on a seam that are shorter than this part of the smaller radius at their ends where that
/// keeps the homotopy type.
MedialComplex without_short_edges_at_seams(MedialComplex complex, double part);

}  // namespace scaleaxis::inline v1
