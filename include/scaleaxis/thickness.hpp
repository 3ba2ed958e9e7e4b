// SPDX-License-Identifier: Apache-2.0
/// \file
/// Thickness of a solid, from its axis: at points of its surface, and as an image.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

class ThicknessData;  // not public

struct ThicknessOptions {
    /// Angle, in degrees, [0, 180), between two of the contacts of a ball, as seen from its centre, from which on it
    /// stands for what is between two sides of the solid. Balls below it lie in edges: at 90 degrees between two faces
    /// they touch both at 90 degrees. Such edges do not read as thin, by default those of
    /// 52 degrees or more. 0: all balls stand for it.
    double angle = 128.0;
};

/// The thickness at a point, in units of the complex; 0 where no ball of positive radius is.
struct PointThickness {
    double thickness = 0.0;  ///< local thickness: diameter of `ball`
    double foot = 0.0;       ///< diameter of the ball that touches the surface here, the nearest one
    Ball ball;               ///< the largest one that contains the point
};

/// The balls of a medial mesh, for questions about thickness. Centres and radii are interpolated linearly along its
/// edges and triangles, into which larger polygons are cut.
///
/// The local thickness at a point is the diameter of the largest ball in the solid that contains it (T. Hildebrand,
/// P. Rüegsegger, "A new method for the model-independent assessment of thickness in three-dimensional images", 1997).
/// All balls in the solid lie in those of its medial axis. Points of the surface are on the border of the ball that
/// touches there; as the balls are known up to the tolerance of the sampling only, that which must grow least to reach
/// the point takes its place, and of others that reach it as soon, to within 1e-6, the largest. Where such a ball lies
/// in an edge (see `ThicknessOptions::angle`) a larger one counts among the others, that reaches the point with the
/// least growth: so a cube reads as its side up to its corners, and so do fillets.
///
/// Copies share what is kept for the questions, which may be asked from several threads at once.
class SCALEAXIS_EXPORT Thickness {
   public:
    /// \throws InvalidOption, UnusableInput (see `check`; no vertices)
    explicit Thickness(const MedialComplex& complex, const ThicknessOptions& options = {});

    /// At points of the surface. \param points #P, near the boundary of the solid \returns #P
    std::vector<PointThickness> at_surface(std::span<const Point> points, const Execution& execution = {}) const;

    /// The same, beside the solid: from an edge the ball moves to where the distance from the boundary grows fastest,
    /// for as long as it grows by more than cos(angle / 2) of the way. Nothing then reads as thinner than the thinnest
    /// wall. \param solid whose axis this is; without effect if it does not know nearest points
    std::vector<PointThickness> at_surface(std::span<const Point> points, const Solid& solid,
                                           const Execution& execution = {}) const;

    /// At the vertices of a mesh: in the solid that it bounds; from the axis alone if it bounds none (see `repair`).
    /// \throws Cancelled
    std::vector<PointThickness> at_surface(const TriangleMesh& surface, const Execution& execution = {}) const;

    /// Local thickness at the points of a grid. The largest ball that contains a point is found to within a hundredth
    /// of the grid's spacing. Points of the solid that no ball contains, as in its corners, take the ball that reaches
    /// them with the least growth.
    /// \param mask other than 0 at the points in the solid
    /// \returns the same grid; 0 where the mask is
    /// \throws UnusableInput (see `check` of images), Cancelled
    Image image(const ImageView& mask, const Execution& execution = {}) const;

   private:
    std::shared_ptr<const ThicknessData> data_;
};

/// A grid of cubes around a box, two points of it outside on each side; without values yet.
/// \param resolution number of points along the longest side, [8, 4096]
/// \throws InvalidOption (resolution out of range), UnusableInput (the box has no extent)
SCALEAXIS_EXPORT Image cubic_grid(const Box& box, Index resolution);

/// Which of some points lie in a solid: `sides[i]` becomes 1 if `points[i]` does, else 0.
using InsideTest = std::function<void(std::span<const Point> points, std::span<std::uint8_t> sides)>;

/// The same grid, with 1 at its points in the solid and 0 elsewhere. \throws Cancelled
SCALEAXIS_EXPORT Image grid_mask(Image grid, const InsideTest& inside, const Execution& execution = {});

/// Values at the vertices of a mesh, over its area, as if they were linear in its triangles.
struct SurfaceValues {
    double area = 0.0;
    double mean = 0.0;
    double deviation = 0.0;  ///< standard deviation
    double min = 0.0;
    double max = 0.0;
    Index min_vertex = kNone;  ///< the first with the least value
    Index max_vertex = kNone;
};

/// \param values #V \throws UnusableInput if the values are not as many as the vertices, or a triangle has others
SCALEAXIS_EXPORT SurfaceValues surface_values(const TriangleMesh& mesh, std::span<const double> values);

/// The part of the area in bins of equal width between 0 and the largest value; each triangle counts with a third of
/// its area at each corner.
struct AreaHistogram {
    double width = 0.0;         ///< of a bin
    std::vector<double> areas;  ///< #bins
};
/// \param bins ≥ 1 \throws InvalidOption, UnusableInput as above
SCALEAXIS_EXPORT AreaHistogram area_histogram(const TriangleMesh& mesh, std::span<const double> values, Index bins);

/// A connected piece of the surface where the values are below a limit.
struct ThinRegion {
    double area = 0.0;  ///< with the parts of triangles that the limit cuts
    double min = 0.0;
    Index min_vertex = kNone;
    Index vertices = 0;
};

struct ThinRegions {
    std::vector<ThinRegion> regions;    ///< the thinnest first
    std::vector<Index> vertex_regions;  ///< #V; `kNone` where the value is not below the limit
};

/// Vertices belong to the same piece if an edge of the mesh joins them. \param values #V
/// \throws UnusableInput as above
SCALEAXIS_EXPORT ThinRegions thin_regions(const TriangleMesh& mesh, std::span<const double> values, double limit);

/// Says so if much of the boundary of a mask's solid is where that is thinner than two voxels across: what is measured
/// there is as uncertain as voxels are long in the direction across, which counts most where slices are thick.
/// \param thickness #V \param steps of the image \throws UnusableInput as above
SCALEAXIS_EXPORT std::optional<Diagnostic> unresolved_thickness(const TriangleMesh& surface,
                                                                std::span<const double> thickness,
                                                                const std::array<Point, 3>& steps);

/// The same surface with no edge longer than a length: edges are halved as often as it takes. The vertices given come
/// first. \param length > 0 \throws InvalidOption (also if it took more than 2e7 triangles), UnusableInput, Cancelled
SCALEAXIS_EXPORT TriangleMesh with_short_edges(TriangleMesh mesh, double length, const Execution& execution = {});

/// A mesh with vertices on the boundary of a solid, whose volume is that of the solid more nearly: edges that the
/// boundary bulges away from are halved, and go through a point beyond it by a third of the distance, so that on both
/// sides of the boundary there is as much between it and the mesh. The vertices given come first.
/// \param solid knows nearest points \throws UnusableInput, Cancelled
SCALEAXIS_EXPORT TriangleMesh with_bulging_edges(TriangleMesh mesh, const Solid& solid,
                                                 const Execution& execution = {});

}  // namespace scaleaxis::inline v1
