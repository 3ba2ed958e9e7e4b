// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A solid shape as the stages see it: an oracle.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis {

/// A bounded solid `S` with boundary `∂S`. All questions may be asked from several threads at once, and the same
/// question always has the same answer.
class Shape {
   public:
    Shape() = default;
    Shape(const Shape&) = delete;
    Shape& operator=(const Shape&) = delete;
    virtual ~Shape() = default;

    /// The bounding box of `S`.
    virtual Box bounds() const = 0;

    /// Does `p` lie in `S`?
    virtual bool inside(const Point& p) const = 0;

    /// Where the segment from a point of `S` to a point outside leaves `S`. Of several such places (an odd number) it
    /// is the one farthest from `reference`. Nothing if the segment crosses `∂S` nowhere, or an even number of times:
    /// then one of the ends is not where the caller takes it to be.
    virtual std::optional<Point> crossing(const Point& inside_end, const Point& outside_end,
                                          const Point& reference) const = 0;

    /// Points of `∂S`, dense enough for a Poisson-disk sample of radius `spacing` to be chosen from them: about ten
    /// for each `spacing²` of area, the shape's own vertices among them. Every component of `∂S` gets some.
    /// Empty where the shape has no cheap way to find any.
    virtual std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const = 0;

    /// Topology of the solid, if it is known.
    virtual std::optional<Topology> topology() const { return std::nullopt; }
};

/// The solid bounded by a closed triangle mesh: all points of non-zero winding number.
/// \throws UnusableShape with the report's fault, if the mesh bounds no solid
std::unique_ptr<Shape> mesh_shape(RepairedMesh mesh, const Execution& execution = {});

/// The same for a mesh as it is: repairs it first.
std::unique_ptr<Shape> mesh_shape(TriangleMesh mesh, const Execution& execution = {});

/// The union of balls, in any position to each other.
/// \throws UnusableShape if there are none, or naming the first that has a NaN, an infinite coordinate or a radius that
/// is not positive
std::unique_ptr<Shape> union_of_balls(std::vector<Ball> balls, const Execution& execution = {});

}  // namespace scaleaxis
