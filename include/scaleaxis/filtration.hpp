// SPDX-License-Identifier: Apache-2.0
/// \file
/// Nested scales: at which scale each ball vanishes in larger ones, and a medial complex in the order in which it does.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// The scale at which something vanishes that never does, or not up to the largest scale that was looked at.
inline constexpr double kNeverVanishes = std::numeric_limits<double>::infinity();

struct FiltrationOptions {
    double largest_scale = 10.0;  ///< up to which to look, [1, 1000]
    double tolerance = 1e-3;      ///< relative, of the scales at which balls vanish, [1e-9, 0.1]
};

/// For each ball the scale s* at which it vanishes: from which on the ball times s is covered by the union of the
/// *larger* balls times s (of balls of the same radius the first one counts as the largest). Covered at s it is covered
/// at all larger scales, and the balls with s* > s, times s, have the same union as all balls times s.
///
/// The result is at least 1 and, up to rounding, no less than s*, and no more than s* (1 + tolerance); where only
/// rounding could tell whether a ball is covered it is kept. `kNeverVanishes` beyond the largest scale.
/// \param balls any number; radii may be 0 \returns #balls
/// \throws InvalidOption, UnusableInput (a ball that is none, see `find_bad_ball`), Cancelled
SCALEAXIS_EXPORT std::vector<double> vanishing_scales(std::span<const Ball> balls,
                                                      const FiltrationOptions& options = {},
                                                      const Execution& execution = {});

/// A medial complex, and the scale at which each of its elements vanishes. At scale s what vanishes later is left: a
/// subcomplex, of the same homotopy type for all s, and the smaller, the larger s is.
struct Filtration {
    MedialComplex complex;              ///< at s = 1
    std::vector<double> ball_scales;    ///< #V, s* of the balls at the vertices (`vanishing_scales`)
    std::vector<double> vertex_scales;  ///< #V, ≥ 1; when the vertex vanishes, not before its ball does
    std::vector<double> edge_scales;    ///< #E, not later than its ends
    std::vector<double> face_scales;    ///< #F, not later than its edges
    /// Up to which it was looked: what never vanishes may do so above.
    double largest_scale = FiltrationOptions().largest_scale;
};

/// Collapses the complex in the order in which the balls at its vertices vanish: a face with a free edge once all balls
/// at its corners have, an edge without faces once that at its free end has. So the balls of every level, times s, have
/// the same union as all of them (`vanishing_scales`): that of the scale axis at s. Scales of single vertices that are
/// far below those around them are raised first, so that the borders of levels are not ragged.
/// \param complex axis at s = 1, e.g. after `clean`
/// \throws InvalidOption, UnusableInput (see `check`), Cancelled
SCALEAXIS_EXPORT Filtration filtration(MedialComplex complex, const FiltrationOptions& options = {},
                                       const Execution& execution = {});

/// The warning that the scale of a complex is not 1: the levels of its filtration are not those of the solid, since
/// what has vanished up to its scale is missing in all of them; nothing where it is 1.
SCALEAXIS_EXPORT std::optional<Diagnostic> grown_axis(const MedialComplex& complex);

/// Throws if a filtration is not what `Filtration` says: scales that are as many as the elements, and elements that do
/// not vanish before those that they belong to.
/// \throws UnusableInput, also as `check` of its complex
SCALEAXIS_EXPORT void check(const Filtration& filtration);

/// What is left at a scale, with its sheets found anew.
/// \param scale ≥ 1 \throws InvalidOption, UnusableInput (see `check`)
SCALEAXIS_EXPORT MedialComplex cut(const Filtration& filtration, double scale);

/// The warning that a level lies above the largest scale of the filtration, so that more of it is left than at that
/// scale of the solid; nothing where it does not.
SCALEAXIS_EXPORT std::optional<Diagnostic> unknown_level(const Filtration& filtration, double scale);

/// What is left at a scale.
struct FiltrationLevel {
    double scale = 1.0;
    Index sheets = 0;
    Index balls = 0;            ///< vertices
    double area = 0.0;          ///< of all sheets, in squared units of the complex
    double curve_length = 0.0;  ///< of all edges without faces
    /// Volume of the union of the balls at the vertices, as large as in the complex, in cubed units of it; counted on
    /// a grid of two million cells.
    double volume = 0.0;
};

/// The levels at scales from 1 to the largest one in equal steps of log s.
/// \param count of the levels, ≥ 2
/// \throws InvalidOption, UnusableInput (see `check`), Cancelled
SCALEAXIS_EXPORT std::vector<FiltrationLevel> profile(const Filtration& filtration, double largest_scale = 10.0,
                                                      Index count = 121, const Execution& execution = {});

/// A range of scales in which little vanishes.
struct ScalePlateau {
    double begin = 1.0;
    double end = 1.0;
    double middle = 1.0;  ///< of log s
};

/// The longest range, in log s, over which the sheets lose no more than 2 % of the area that they have at its begin; of
/// those up to s = 2, above which the main parts of most solids vanish. Of several the first.
/// \param levels with ascending scales, at least one
SCALEAXIS_EXPORT ScalePlateau longest_plateau(std::span<const FiltrationLevel> levels);

}  // namespace scaleaxis::inline v1
