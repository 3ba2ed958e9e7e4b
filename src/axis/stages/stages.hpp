// SPDX-License-Identifier: Apache-2.0
/// \file
/// The stages of `scale_axis`, each of a complex that has been checked or was computed here.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "axis/complex.hpp"
#include "base/angles.hpp"
#include "scaleaxis/centering.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/shrinking.hpp"
#include "scaleaxis/simplification.hpp"

namespace scaleaxis::inline v1 {

/// Degrees by which a sheet must be wider than the angle of the filter to stay (`SheetAngle::kByArea`). Where sides are
/// plane its angle is right to a tenth of a degree; sheets into the edges of a hexagonal prism have the default
/// exactly.
inline constexpr double kClearlyWider = 0.5;

/// Cosine of 10 degrees. Contacts that are seen at a smaller angle from each other count as one; at 26 degrees
/// envelopes are off by up to a twenty-fifth more. Triangles that meet at a larger one lie on both sides of a crease;
/// at 20 degrees only 10 or 11 of the 12 sheets of a truncated cube come apart, whose creases have 40.
inline const double kSamePlaneDirection = cosine_of_degrees(10.0);

/// Of the diagonal: δ by default (`kDefaultDelta`), where a stage does not know it.
inline constexpr double kDefaultTolerance = 0.01;

/// Of the diagonal: a length that is small beside all parts of a solid. The error where none is asked for, as of linear
/// radii, and the radius of balls that are points.
inline constexpr double kSmallLength = 1e-4;

/// `filter` of such a complex.
FilteredComplex filtered(const MedialComplex& complex, const FilterOptions& options, const Execution& execution);

/// `filter` of such a complex with `SheetAngle::kByArea`. \param tolerance of its balls: parts of sheets between
/// creases that are wider go like sheets
FilteredComplex filtered_by_area(const MedialComplex& complex, double angle, double tolerance,
                                 const Execution& execution);

/// `clean` of such a complex.
CleanedComplex cleaned(const MedialComplex& complex, const CleanOptions& options, const Execution& execution);

/// `extend_to_sharp_edges` of such a complex.
SharpComplex extended_to_sharp_edges(MedialComplex complex, const Solid& solid, const SharpEdgeOptions& options,
                                     const Execution& execution);

/// `shrink` of such a complex.
MedialComplex shrunk(MedialComplex complex, double scale);
MedialComplex densified(MedialComplex complex, const DensifyOptions& options, const Execution& execution);

/// `center` of such a complex.
CenteredComplex centered(MedialComplex complex, const Solid& solid, const CenterOptions& options,
                         const Execution& execution);

/// What feet of strips do, triangles up to sharp edges, whose balls would become smaller on a seam.
enum class Feet : std::uint8_t { kComeToSeams, kStay };

/// The same without halving edges. A complex without contacts, as a compact one, has those of the slabs of its faces.
CenteredComplex centered_as_it_is(MedialComplex complex, const Solid& solid, const CenterOptions& options, Feet feet,
                                  const Execution& execution);

/// What `simplify` would tell of a simplified complex that has been changed since. \param options with an error
SimplifyStatistics compared(const MedialComplex& complex, const MedialComplex& simplified,
                            const SimplifyOptions& options, const Execution& execution);

/// The union of the balls of a shrunk complex before it was shrunk, of so many that it is its solid.
BallUnion grown_union(const MedialComplex& complex, const Execution& execution);

/// How far linear radii may be above those of the union, between the vertices of an axis that is smoothed or centered,
/// or simplified: a part of δ, or of the error.
inline constexpr double kLeastDip = 0.2;

/// Is it known of a pair of vertices that a linear radius between them will do?
using LinearPairs = std::function<bool(Index, Index)>;
inline bool no_pairs(Index, Index) { return false; }

/// The same complex with more vertices, so that interpolating the radii linearly between them is right to within a
/// tolerance, > 0, or known to do. The vertices given come first. Faces that are right stay polygons.
MedialComplex linearized(MedialComplex complex, double tolerance, const LinearPairs& known = no_pairs);

/// The edges, and the diagonals of faces from their first corners, which `linearized` would cut if nothing were known;
/// the first vertex is the lesser one.
std::vector<std::array<Index, 2>> pairs_off_linear(const MedialComplex& complex, double tolerance);

/// `linearized` where `smooth` moves vertices: radii become linear around them, and would be too large on the faces.
MedialComplex linearized_around_borders(MedialComplex complex, double tolerance);

/// What a filter has kept of a complex, with its sheets found anew: where a seam has gone, two are one now.
FilteredComplex with_statistics(MedialComplex kept, const MedialComplex& complex);

}  // namespace scaleaxis::inline v1
