// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A solid shape as the stages see it: an oracle.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
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
    /// for each `spacing²` of area, the shape's own vertices among them; or almost such a sample itself. Every
    /// component of `∂S` gets some. Empty where the shape has no cheap way to find any.
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

struct ImplicitOptions {
    /// Where to look for the solid, which must end within. Outside of it the function is never asked.
    Box bounds;
    /// The function is taken to change sign at most once along a segment of this length, and every part of the solid
    /// and every cavity to hold a ball of this diameter, so that it is found; 0: 1/128 of the diagonal of the bounds.
    double smallest_feature = 0.0;
};

/// The solid where `function` is negative. Its boundary is found to machine precision, by bracketing; the function need
/// not be a distance, nor smooth, nor even continuous. It is called from several threads at once.
///
/// `bounds()` exceeds the solid by about half of the smallest feature.
/// \throws InvalidOption if the bounds or the smallest feature are not what they should be
/// \throws UnusableShape if there is nothing inside, if the bounds cut the solid, or if the function is not a number
/// somewhere (then any call can throw)
std::unique_ptr<Shape> implicit_shape(std::function<double(const Point&)> function, const ImplicitOptions& options,
                                      const Execution& execution = {});

/// The solid where the trilinear interpolant of an image lies above the level (or below it). Its boundary is found to
/// machine precision. Where it touches the border of the image it is closed half a voxel farther out.
///
/// `bounds()` exceeds the solid by about 1/10 of a voxel.
/// \throws UnusableShape if the image is unusable (see `check`), or no voxel is inside, or all of them are
std::unique_ptr<Shape> image_shape(Image image, const Level& level, const Execution& execution = {});

}  // namespace scaleaxis
