// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stage 7, on demand: axis with thousands of vertices → compact medial mesh.
#pragma once

#include <optional>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

struct SimplifyOptions {
    /// Error ε, > 0, in the units of the complex; unset: as large as the number of vertices asks for. No ball of the
    /// complex, at its vertices and inside of edges and faces much longer than ε, sticks out of the envelope of the
    /// result (see `Envelope`) by more than this, and none of the balls of the result, at places as dense as ε or half
    /// the mean edge of the complex, whichever is larger, out of that of the complex.
    std::optional<double> error = {};
    /// Number of vertices at which to stop, ≥ 1; unset: as few as the error allows. One of the two must be set. Without
    /// an error it grows until the number is reached; beyond 0.005 of the diagonal seams, borders and sheets may
    /// vanish.
    std::optional<Index> vertices = {};
    /// Vertices of the complex that stay as they are.
    std::vector<Index> anchors = {};
};

struct SimplifyStatistics {
    Index vertices_before = 0;
    Index vertices_after = 0;
    Index triangles = 0;       ///< of the result
    Index curve_edges = 0;     ///< of the result: edges without a face
    double error = 0.0;        ///< ε that was kept to
    double largest_gap = 0.0;  ///< how far a ball of the complex sticks out of the envelope of the result, at most
    double largest_protrusion = 0.0;  ///< how far a ball of the result sticks out of that of the complex, at most
    Topology topology;                ///< of the result
};

struct SimplifiedComplex {
    MedialComplex complex;
    SimplifyStatistics statistics;
};

/// Collapses edges in the order of their slab quadrics (P. Li et al., "Q-MAT: computing medial axis transform by
/// quadratic error minimization", 2015; M. Garland, P. Heckbert, "Surface simplification using quadric error metrics",
/// 1997). A collapse must meet the link condition, which keeps the homotopy type (T. Dey et al., "Topology preserving
/// edge contraction", 1999), and the error on both sides; seams, borders of sheets, and curves stay what they are,
/// their ends and junctions stay where they are.
///
/// Faces of the result are triangles. Radii are interpolated linearly (`linear_vertex`).
/// \param complex e.g. a scale axis, best after `clean`
/// \throws InvalidOption, UnusableInput (see `check`; no vertices), Cancelled
SCALEAXIS_EXPORT SimplifiedComplex simplify(const MedialComplex& complex, const SimplifyOptions& options,
                                            const Execution& execution = {});

/// The warning that more vertices are left than were asked for, and why; nothing where these are not.
SCALEAXIS_EXPORT std::optional<Diagnostic> too_many_vertices(const SimplifyStatistics& statistics,
                                                             const SimplifyOptions& options);

}  // namespace scaleaxis::inline v1
