// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sizes of elements for meshers: from how thick a solid is, everywhere in it, with bounded growth.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

class SizeData;  // not public

enum class SizeMeasure : std::uint8_t {
    kThickness,  ///< of the wall at a point of the surface, as `wall_at` has it
    /// Twice the local feature size: the distance to the medial axis, inside or outside, without what of it lies in
    /// edges, see `angle`, or outside is farther from the solid than half the least side of its box. In a plate it is
    /// the thickness, in a hole the diameter, in a slot the width.
    kFeatureSize,
};

struct SizeOptions {
    SizeMeasure measure = SizeMeasure::kThickness;
    /// Sizes are the measure divided by this: how many elements lie across a wall. [0.1, 100]
    double elements_across = 3.0;
    std::optional<double> min_size = std::nullopt;  ///< > 0, in units of the solid; 1/1000 of its diagonal if unset
    std::optional<double> max_size = std::nullopt;  ///< at least `min_size`
    /// Largest difference of sizes for each unit of distance, [0.01, 10]. 0.3: from one element to the next they grow
    /// by a third, about.
    double gradation = 0.3;
    double angle = 128.0;  ///< as `WallOptions::angle`
};

/// Tetrahedra with sizes at their vertices, between which they are linear.
struct SizeMesh {
    std::vector<Point> vertices;
    std::vector<double> sizes;                     ///< #V
    std::vector<std::array<Index, 4>> tetrahedra;  ///< positively oriented; they fill a box around the solid
};

/// Sizes of elements at all points. At a point of the surface the size is the measure there by `elements_across`, kept
/// between the limits. It is the same from there to the centre of the ball between the two sides, so that elements do
/// not grow across a wall. From all these places sizes grow with the distance by `gradation`, and everywhere the least
/// counts: |size(p) - size(q)| ≤ gradation |p - q| for all points. Where the measure jumps, sizes are therefore smaller
/// than asked for, and at most a tenth of a size larger.
///
/// Copies share the data. Questions may be asked from several threads at once.
class SCALEAXIS_EXPORT SizeField {
   public:
    /// \param surface of the solid, closed; the field refines it where sizes change
    /// \throws InvalidOption, UnusableInput (the solid does not know nearest points), Cancelled
    SizeField(const Solid& solid, TriangleMesh surface, const SizeOptions& options = {},
              const Execution& execution = {});

    double operator()(const Point& p) const;
    std::vector<double> operator()(std::span<const Point> points, const Execution& execution = {}) const;

    const TriangleMesh& surface() const;               ///< with more vertices than the one given
    const std::vector<double>& surface_sizes() const;  ///< #V: the field at its vertices

    /// For programs that take sizes in a file: vertices on the surface and halfway between its sides, about half a size
    /// apart or, where walls are even, more.
    SizeMesh background(const Execution& execution = {}) const;

   private:
    std::shared_ptr<const SizeData> data_;
};

}  // namespace scaleaxis::inline v1
