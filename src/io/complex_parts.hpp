// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of a medial complex below two dimensions, which some formats list on their own.
#pragma once

#include <array>
#include <vector>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::io {

/// The edges without a face: the curves of the axis.
std::vector<std::array<Index, 2>> curve_edges(const MedialComplex& complex);

/// The vertices without an edge: the isolated balls.
std::vector<Index> isolated_vertices(const MedialComplex& complex);

}  // namespace scaleaxis::io
