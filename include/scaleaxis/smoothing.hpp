// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 6: smooth boundaries of sheets, smooth curves.
#pragma once

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

struct SmoothOptions {
    /// Number of rounds, ≥ 0. In the first and then every other one, every movable vertex goes half the way to the
    /// middle of its two neighbours, in those between 0.52 of that way back, so that nothing shrinks.
    Index rounds = 0;
};

/// Smooths the boundaries of sheets (Miklos, Giesen, Pauly, "Discrete scale axis representations for 3D geometry",
/// 2010, section 4): a uniform Laplacian, back and forth (G. Taubin, "A signal processing
/// approach to fair surface design", 1995), on vertices with exactly two edges of one face and otherwise only edges of
/// two. Vertices inside curves, of two edges without faces, move too. Ends, seams, junctions and sharp edges (balls of
/// radius 0) stay where they are, and connectivity does not change. The ball of a moved vertex gets the radius with
/// which, times the complex's `scale`, it stays inside the union and touches its boundary; one whose centre would leave
/// the union goes back. Contacts and angles of faces stay those before smoothing. \param complex part of the medial
/// axis of a union, filtered and shrunk \param ball_union that union: `MedialAxis::ball_union` \throws InvalidOption,
/// UnusableInput (the union is empty), Cancelled
SCALEAXIS_EXPORT MedialComplex smooth(MedialComplex complex, const BallUnion& ball_union, const SmoothOptions& options,
                                      const Execution& execution = {});

/// The same for a complex alone, as from a file: the union is that of its balls after `densify`, grown by the scale.
/// Between these balls it is a little smaller than the solid, so that moved balls lose up to about 1 % of their radius.
/// Radii become linear around moved vertices: where that is not right to 0.002 of the diagonal of the balls' box, faces
/// and edges are divided first; the vertices given come first in the result.
/// \throws InvalidOption, UnusableInput (see `check` and `densify`), Cancelled
SCALEAXIS_EXPORT MedialComplex smooth(MedialComplex complex, const SmoothOptions& options,
                                      const Execution& execution = {});

}  // namespace scaleaxis::inline v1
