// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the numbers of a file have to mean, whatever its format. Every check throws a `FileError` that names the first
/// item that fails it.
#pragma once

#include <cstddef>
#include <span>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::io {

/// Coordinates are usable (`is_usable`).
void check_vertices(std::span<const Point> vertices);

/// Polygons have three corners or more, which are vertices.
void check_polygons(const IndexLists& polygons, std::size_t vertex_count);

/// The complex as it stands in a file, where sheets and angles may be absent: vertices are finite, no radius is
/// negative, edges and faces join vertices that exist and differ, no face is there twice, sheets are numbers below that
/// of the faces.
void check_axis(const MedialComplex& complex);

}  // namespace scaleaxis::io
