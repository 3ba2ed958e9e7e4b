// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stage 6, optional: smooth boundaries of the sheets.
#pragma once

#include "scaleaxis/execution.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

struct SmoothOptions {
    /// How often every movable vertex goes half the way to the middle of its two neighbours; ≥ 0.
    Index rounds = 0;
    /// Factor `s` by which the balls of the union had been grown before the complex was shrunk, ≥ 1.
    double scale = 1.0;
};

/// Smooths the boundaries of sheets (the paper, section 4): a uniform Laplacian on vertices with exactly two edges of
/// one face and otherwise only edges of two. Ends, seams and curves stay where they are, and so does the connectivity.
/// A moved ball gets the radius with which, grown by `scale`, it stays inside the union and touches its boundary; one
/// that would leave the union goes back. \param complex part of the medial axis of `axis.balls`, filtered and shrunk;
/// contacts and angles of its faces are kept \param axis the whole one \throws InvalidOption, Cancelled
MedialComplex smooth(MedialComplex complex, const MedialAxis& axis, const SmoothOptions& options,
                     const Execution& execution = {});

}  // namespace scaleaxis
