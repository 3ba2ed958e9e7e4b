// SPDX-License-Identifier: Apache-2.0
/// \file
/// Shells: axis of a solid of walls → a mesh for the finite-element method, with triangles of a given size.
#pragma once

#include <array>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/midsurface.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

struct ShellOptions {
    double size = 0.0;  ///< > 0: length of the edges, in units of the axis
    /// Least object angle of what counts as a wall, as `MidsurfaceOptions::angle`.
    double angle = 64.0;
};

/// A conforming mesh of triangles: where walls meet, they share vertices. A *sheet* is a smooth part of it, between
/// seams, bends and borders.
struct ShellMesh {
    TriangleMesh mesh;  ///< an edge of a seam has three triangles or more
    /// #T: of the wall at the corners of each triangle. Walls that share a vertex may differ in thickness there.
    std::vector<std::array<double, 3>> thickness;
    std::vector<Index> triangle_sheets;  ///< #T
    std::vector<MidsurfaceSheet>
        sheets;  ///< the largest area first; least and largest thickness are equal if it is even
    /// Middles of the edges, for quadratic elements: on the middle of the wall where that is curved.
    std::vector<Point> middles;
    std::vector<std::array<Index, 3>> triangle_middles;  ///< #T: of the sides from each corner to the next
    double seam_length = 0.0;                            ///< of the edges of three triangles or more
    double border_length = 0.0;                          ///< of the edges of one triangle
    double least_angle = 0.0;                            ///< of all triangles, in degrees
    double mean_edge = 0.0;                              ///< length
};

/// The midsurface (see midsurface.hpp) as shells:
/// - Walls meet in their middle surfaces, as far as they know of them: from a distance of the junction, where the balls
///   are no larger than the wall is thick. So the section of a T, of an L or of a box is that of its middle lines.
/// - They end at the surface of the solid, a rib that ends on a plate with a vertex of the plate.
/// - Edges are about `size` long, except where sheets are narrower. Flat walls are flat, and have one thickness if it
///   varies by less than 2 %.
///
/// Empty where the solid has no walls. \param complex as for `midsurface`; its envelope stands for the solid
/// \throws InvalidOption, UnusableInput (see `check`; object angles are not known), Cancelled
SCALEAXIS_EXPORT ShellMesh shell_mesh(const MedialComplex& complex, const ShellOptions& options,
                                      const Execution& execution = {});

/// The same for the solid itself. \param solid if it does not know the nearest points of its boundary, the envelope
/// takes its place \throws as above
SCALEAXIS_EXPORT ShellMesh shell_mesh(const MedialComplex& complex, const Solid& solid, const ShellOptions& options,
                                      const Execution& execution = {});

}  // namespace scaleaxis::inline v1
