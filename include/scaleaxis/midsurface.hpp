// SPDX-License-Identifier: Apache-2.0
/// \file
/// Midsurface: axis of a solid of walls → a triangulated surface halfway between their sides, with thickness.
#pragma once

#include <array>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

struct MidsurfaceOptions {
    /// Least object angle of a face, in degrees, (0, 90], from which on it stands for what is between two sides: half
    /// the angle between its contacts, seen from it. Faces that run into convex edges at 90 degrees have 45.
    double angle = 64.0;
    /// Whether the surface goes on from its border to the surface of the solid, as from the middle of a plate to its
    /// rim. Else it ends where a ball touches the rim, half the thickness before it.
    bool extends = true;
};

/// A sheet of a midsurface; thickness over its area, as if it were linear in its triangles.
struct MidsurfaceSheet {
    double area = 0.0;
    double mean = 0.0;  ///< thickness
    double min = 0.0;
    double max = 0.0;
};

/// Sheets that meet in seams, in units of the axis. Triangles of a sheet have the same orientation, where it is
/// orientable.
struct Midsurface {
    TriangleMesh mesh;                    ///< an edge of a seam has three triangles or more
    std::vector<double> thickness;        ///< #V; diameter of the ball there
    std::vector<Index> triangle_sheets;   ///< #T
    std::vector<MidsurfaceSheet> sheets;  ///< the largest area first; connected across edges of two triangles
    Index seams = 0;                      ///< chains of edges of three triangles or more, from one fork to the next
    double seam_length = 0.0;
    double border_length = 0.0;    ///< of the edges of one triangle
    double left_out_area = 0.0;    ///< of the faces of the axis that stand for no wall
    Index left_out_curves = 0;     ///< edges of the axis without a face, which stand for rods …
    double left_out_length = 0.0;  ///< … and their length
};

/// What is between two opposite sides of a solid, from its axis:
/// - Faces of a large object angle stay, and in their sheets those of a smaller one that part them from a seam, as
///   where a rib meets a wall. The others run into edges of the solid. Parts narrower than half of their thickness,
///   or with less area than its square, go too. Curves stand
///   for rods, and are left out.
/// - The border goes on, along the tangent of its sheet, up to the boundary of the solid, with the same thickness;
///   where none is within 2 radii it stays.
///
/// Empty where the solid has no walls, as a ball. \param complex best extended to sharp edges (see
/// `extend_to_sharp_edges`); its envelope stands for the solid \throws InvalidOption, UnusableInput (see `check`;
/// object angles are not known), Cancelled
SCALEAXIS_EXPORT Midsurface midsurface(const MedialComplex& complex, const MidsurfaceOptions& options = {},
                                       const Execution& execution = {});

/// The same for the solid itself. \param solid if it does not know the nearest points of its boundary, the envelope
/// takes its place \throws as above
SCALEAXIS_EXPORT Midsurface midsurface(const MedialComplex& complex, const Solid& solid,
                                       const MidsurfaceOptions& options = {}, const Execution& execution = {});

/// The midsurface as a medial complex, for all that takes one: `write_axis` names its sheets, and its envelope is the
/// solid that it stands for, except at the rims.
SCALEAXIS_EXPORT MedialComplex complex_of(const Midsurface& surface);

}  // namespace scaleaxis::inline v1
