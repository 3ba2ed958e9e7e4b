// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sheets that run into convex sharp edges of the solid: filtered complex → the same up to these edges.
#pragma once

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

struct SharpEdgeOptions {
    /// Least angle, in degrees, (0, 180), between the normals on both sides of an edge that is sharp.
    double angle = 30.0;
    /// Tolerance δ of the sampling, a length > 0: the complex must come as near to an edge as 12 δ.
    double tolerance = 0.0;
    /// Factor ≥ 1 by which the balls have been grown, of a complex that is not shrunk yet. Edges whose sheets growing
    /// takes, those of wide wedges, are left out.
    double scale = 1.0;
};

struct SharpEdgeStatistics {
    double angle = 0.0;   ///< of the options
    Index points = 0;     ///< vertices added, on sharp edges and in corners
    Index corners = 0;    ///< of these, in corners
    double length = 0.0;  ///< of the sharp edges that were reached
    /// Of the convex edges of this angle, and of 40° at least, that the solid knows, except those that growing
    /// takes.
    double known = 0.0;
    Index sheets = 0;   ///< of the result: a sheet may have got a seam
    Topology topology;  ///< of the result
};

struct SharpComplex {
    MedialComplex complex;
    SharpEdgeStatistics statistics;
};

/// The medial axis of a solid ends on its convex edges, in balls of radius 0, which no union of balls has. Goes on with
/// the sheets up to the edges that the solid knows, or else to those that balls at the border see, where the tangent
/// planes at their two contacts meet, traced on to corners or around rims. Each edge from corner to corner gets a strip
/// of triangles between the complex below it and vertices of radius 0 on it (`kSharpEdge`: linear in between), where
/// the balls of the strip touch both sides of the edge and lie in the solid. Each strip is glued on along an arc, so
/// the homotopy type stays. What is round or rough stays as it is. \param complex part of the medial axis of a union of
/// balls inside the solid; the balls may have been grown \throws InvalidOption, UnusableInput (see `check`; or the
/// solid does not know nearest points), Cancelled
SCALEAXIS_EXPORT SharpComplex extend_to_sharp_edges(const MedialComplex& complex, const Solid& solid,
                                                    const SharpEdgeOptions& options, const Execution& execution = {});

}  // namespace scaleaxis::inline v1
