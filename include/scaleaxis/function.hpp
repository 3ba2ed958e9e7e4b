// SPDX-License-Identifier: Apache-2.0
/// \file
/// Implicit functions as solids.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

struct FunctionOptions {
    /// Where to look for the solid, which must end within unless it `is_clipped`. Outside of it the function is never
    /// asked.
    Box bounds;
    /// The function is taken to change sign at most once along a segment of this length, and every part of the solid
    /// and every cavity to hold a ball of this diameter, so that it is found; 0: 1/128 of the diagonal of the bounds.
    double smallest_feature = 0.0;
    /// Whether a solid that reaches the bounds is closed by them: the solid is what is negative within the bounds.
    bool is_clipped = false;
    /// Whether the function is nowhere farther from 0 than the boundary of the solid is away: signed distances are so,
    /// their minima and maxima, and all functions that change by no more than the length of a way along it. Far from
    /// the boundary it is then asked at few places. The result is the same.
    bool is_distance = false;
};

/// The solid where `function` is negative. Its boundary is found to machine precision, by bracketing; the function need
/// not be a distance, nor smooth, nor even continuous. It is called from several threads at once.
///
/// `bounds()` exceeds the solid by about half of the smallest feature.
/// \throws InvalidOption if the bounds or the smallest feature are not what they should be
/// \throws UnusableInput if there is nothing inside, if the bounds cut the solid and it is not to be clipped, or if the
/// function is not a number somewhere (then any call can throw)
SCALEAXIS_EXPORT std::unique_ptr<Solid> function_solid(std::function<double(const Point&)> function,
                                                       const FunctionOptions& options, const Execution& execution = {});

/// The same solid, from a function that gives many values at a time: `function(points, values)` sets `values[i]` for
/// `points[i]`. For functions whose calls have a cost of their own: those of a script, or of a GPU. It is called from
/// one thread at a time, though not always the same, with hundreds of points at least where there are as many to ask,
/// and with at most 16,384.
SCALEAXIS_EXPORT std::unique_ptr<Solid> function_solid(
    std::function<void(std::span<const Point>, std::span<double>)> function, const FunctionOptions& options,
    const Execution& execution = {});

}  // namespace scaleaxis::inline v1
