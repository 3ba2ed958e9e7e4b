// SPDX-License-Identifier: Apache-2.0
/// \file
/// Edges of an axis that are cut in halves where balls between its vertices do not touch the solid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// By how much the largest balls in a solid are larger than these with the same centres; nothing where by more than
/// twice the error.
std::vector<std::optional<double>> growths_in(const Solid& solid, std::span<const Ball> balls, double error);

/// Will such a ball do between two that touch the solid? It may lack the error, but stick out by half of it only.
bool touches_nearly(std::optional<double> growth, double error);

struct HalvingOptions {
    double error = 0.0;                           ///< that balls may have between vertices, see `touches_nearly`
    std::span<const std::uint8_t> asked_faces{};  ///< 1: look at these and their edges; empty: at all
};

/// The edges in whose middle, or beside them in that of a face, balls do not touch the solid.
struct Halving {
    std::vector<std::uint8_t> is_halved;  ///< of each edge
    std::vector<double> radii;            ///< of the balls in their middle that are in the solid
    /// Of each edge where it is cut in place of the middle, as a part of it; the balls there are those of the medial
    /// axis. Empty: all are cut in the middle.
    std::vector<double> parts{};
    std::size_t count() const;
};
Halving edges_to_halve(const MedialComplex& complex, const Solid& solid, const HalvingOptions& options);

/// The complex with these edges halved, and the faces beside them cut into triangles. The vertices given come first,
/// new ones are `kTouching`, except those of the medial axis.
MedialComplex halved(const MedialComplex& complex, const Halving& halving);

/// The same, and which face each of its faces is a part of.
struct HalvedComplex {
    MedialComplex complex;
    std::vector<Index> parents;
};
HalvedComplex halved_with_parents(const MedialComplex& complex, const Halving& halving);

}  // namespace scaleaxis::inline v1
