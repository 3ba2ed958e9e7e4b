// SPDX-License-Identifier: Apache-2.0
/// \file
/// Erosion thickness of a medial complex, and cleaning by it: filtered complex → the same without teeth, crumbs and
/// hairs, limbs as curves.
#pragma once

#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// When a fire that starts at the border of a medial complex comes by (Y. Yan, K. Sykes, E. Chambers, D. Letscher,
/// T. Ju, "Erosion thickness on medial axes of 3D shapes", 2016). It starts at each point of the border when the radius
/// there has passed, and burns along sheets and curves with unit speed. Where sheets meet it waits until all but one
/// have burnt. Infinite where it never comes: around voids, and on curves that are part of loops.
struct ErosionThickness {
    std::vector<double> burn_times;  ///< #V; the latest of the sheets and curves at the vertex
    /// #V; burn time minus radius: how far the largest ball at the border sticks out of the ball here
    std::vector<double> thickness;
    /// Of each corner of each face, in the order of `MedialComplex::faces.items`: burn time on the side of this face.
    std::vector<double> corner_burn_times;
};

/// \throws UnusableInput (see `check`), Cancelled
SCALEAXIS_EXPORT ErosionThickness erosion_thickness(const MedialComplex& complex, const Execution& execution = {});

struct CleanOptions {
    /// Erosion thickness T below which parts of sheets are spurious, in the units of the complex, ≥ 0; 0 keeps
    /// everything. Where the axis is thin half the radius takes its place, if that is less.
    double thickness = 0.0;
    /// Whether edges are cut at ridges that no vertex tells of: where fires from both of their ends meet so late that
    /// the ball there is to be kept, though those at the ends are not. Sheets whose faces are as large as the sheets
    /// are wide would be lost that are wider than about 2 T. Seams that end less than 2 T before the border of a sheet
    /// folded along them end on it.
    bool finds_ridges = true;
};

struct CleanStatistics {
    double thickness = 0.0;  ///< T
    Index sheets_before = 0;
    Index sheets_after = 0;
    Index curves = 0;              ///< of the result: chains of edges without faces, between tips, sheets and junctions
    double area_removed = 0.0;     ///< of the sheets
    double largest_retreat = 0.0;  ///< distance of a vertex that was removed from the vertices kept, at most
    double largest_loss = 0.0;     ///< how far a ball that was removed sticks out of those that were kept, at most
    double mean_loss = 0.0;        ///< its average over the vertices removed
    Index vertices_removed = 0;    ///< those of the result that cuts have added not counted
    Topology topology;             ///< of the result
};

struct CleanedComplex {
    MedialComplex complex;
    CleanStatistics statistics;
};

/// Removes what has little erosion thickness: teeth, crumbs and spikes, which are of the size of the sampling. Sheets
/// narrower than about 2 T become curves. Sheets recede nowhere where a disc as large as the way of the fire fits
/// (opening), nor from sharp edges of the solid (balls of radius 0); faces are cut, so that borders are smooth. Curves
/// shorter than about 2 T go, the others reach their tips. All by collapses, which keep the homotopy type. The fire
/// takes the radii of the grown balls (`MedialComplex::scale`). \throws InvalidOption, UnusableInput (see `check`),
/// Cancelled
SCALEAXIS_EXPORT CleanedComplex clean(const MedialComplex& complex, const CleanOptions& options,
                                      const Execution& execution = {});

/// Draws sheets together that are narrower on average than `tolerance` / 2, or than a quarter of their smallest ball,
/// by contractions that keep the homotopy type. Where four sheets of a solid meet in a seam, those of a union meet by
/// threes, and what lies between has no width once its balls touch the solid (see `center`). Sheets with balls of
/// radius 0 stay. Seams that end less than `tolerance` before the border of a sheet folded along them end on it. \param
/// tolerance δ of the sampling, a length > 0 \throws InvalidOption, UnusableInput (see `check`), Cancelled
SCALEAXIS_EXPORT MedialComplex contract_slivers(const MedialComplex& complex, double tolerance,
                                                const Execution& execution = {});

}  // namespace scaleaxis::inline v1
