// SPDX-License-Identifier: Apache-2.0
/// \file
/// Results as a page that any browser shows: one HTML file, which needs nothing else.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// When the elements of an axis vanish, as in `Filtration`, for a page that shows the axis at any scale.
struct ViewedScales {
    std::vector<double> vertices;         ///< #V
    std::vector<double> edges;            ///< #E
    std::vector<double> faces;            ///< #F
    std::vector<FiltrationLevel> levels;  ///< what the page draws over the scale, at least one; see `profile`
    ScalePlateau plateau;                 ///< which it marks; it opens at the middle
};

/// The axis for one scale, or for all of them.
struct ViewedAxis {
    MedialComplex complex;   ///< its `scale` is that of the axis
    TriangleMesh surface;    ///< of the simplified shape; may be empty
    std::string statistics;  ///< a JSON object that the page shows beside it, or empty
    /// The scales of a filtration, whose `complex` is at s = 1 and which is the only axis of its model; or nothing.
    std::optional<ViewedScales> scales = std::nullopt;
};

/// A filtration as the page shows it, with the longest plateau of its levels. \param levels see `profile`
SCALEAXIS_EXPORT ViewedAxis viewed(Filtration filtration, std::vector<FiltrationLevel> levels);

/// Thickness at the vertices of a surface (see `Thickness`), by which the page colours it.
struct ViewedThickness {
    std::vector<double> local;                   ///< #V
    std::vector<double> foot;                    ///< #V
    std::vector<Index> regions = {};             ///< #V, of `thin_regions`: a vertex's, or `kNone`; or empty
    std::optional<double> limit = std::nullopt;  ///< below which regions are thin
};

/// One input and what was made of it.
struct ViewedModel {
    std::string name;
    TriangleMesh shape;                                       ///< the input; may be empty
    std::vector<ViewedAxis> axes;                             ///< in any order
    std::string statistics;                                   ///< as above
    std::optional<ViewedThickness> thickness = std::nullopt;  ///< of the vertices of `shape`
};

enum class ViewLayout {
    kSideBySide,    ///< all models beside each other, seen by one camera
    kContactSheet,  ///< a small picture of each model, which leads to its view
};

/// A model as the page reads it: compressed bytes, described in docs/dev/viewer.md. Before compression they are at most
/// 24 for a triangle and 24 for a ball (vertex of an axis), and its statistics and a hundred more for each array; of a
/// filtration 8 more for each face, each vertex and each edge that outlives its faces, and with thickness 8 more for
/// each vertex of the shape. Coordinates and radii of axes are rounded to about a millionth of the model's box,
/// coordinates of meshes to 1/65535 of it, object angles to 90°/65535. Computes what the page shows besides: which
/// sheets of several scales have the same colour, and the erosion thickness (of the grown balls, as `clean` does).
/// \throws FileError if the coordinates are too large for single precision, UnusableInput (see `check`; `scales` that
/// are not as many as the elements, or thicknesses as the vertices), Cancelled
SCALEAXIS_EXPORT std::string view_data(const ViewedModel& model, const Execution& execution = {});

/// Writes the page, under a temporary name until it is complete.
/// \param models what `view_data` has made of each
/// \throws FileError
SCALEAXIS_EXPORT void write_view(const std::filesystem::path& file, const std::string& title, ViewLayout layout,
                                 std::span<const std::string> models);

/// Throws `FileError` if the file is not called .html or .htm, or its folder cannot be written to.
SCALEAXIS_EXPORT void check_view_output(const std::filesystem::path& file);

}  // namespace scaleaxis::inline v1
