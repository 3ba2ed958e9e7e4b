// SPDX-License-Identifier: Apache-2.0
/// \file
/// Images of Python: an array of values whose last index belongs to the first axis of the image, and four rows: the
/// origin and the three steps.
#pragma once

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <string>
#include <utility>

#include "arrays.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis::python {

using FrameIn = std::pair<std::string, std::string>;

inline ImageView image_view(const FloatsIn& values, const PointsIn& place) {
    const std::span<const Point> rows = points(place);
    return {
        {static_cast<Index>(values.shape(2)), static_cast<Index>(values.shape(1)), static_cast<Index>(values.shape(0))},
        rows[0],
        {rows[1], rows[2], rows[3]},
        {values.data(), values.size()}};
}

/// \param frame the unit of lengths and where x, y and z point, see `Image`
inline Image image_of(const FloatsIn& values, const PointsIn& place, const FrameIn& frame) {
    const ImageView view = image_view(values, place);
    return {view.sizes, view.origin, view.steps, copy(view.values), frame.first, frame.second};
}

}  // namespace scaleaxis::python
