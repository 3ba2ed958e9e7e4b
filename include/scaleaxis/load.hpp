// SPDX-License-Identifier: Apache-2.0
/// \file
/// A file of any kind → solid, with a report on the input as data.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scaleaxis/cloud.hpp"
#include "scaleaxis/crust.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// How a file becomes a solid. Options of another kind of input than the file's are refused.
struct LoadOptions {
    /// What the file holds; unset: what its content says, or else its name.
    std::optional<FileKind> kind = {};

    // Meshes.
    SolidOptions solid = {};
    std::vector<Index> objects = {};  ///< of those of `read_objects`, counted from 1; empty: all

    // Images. What is solid is said by one of `iso`, `labels` and `is_nonzero`; a mask (one value other than 0) needs
    // none of them.
    std::optional<double> iso = {};             ///< the values above it, interpolated between voxels
    bool is_below = false;                      ///< with `iso`: the values below it
    std::vector<float> labels = {};             ///< the voxels with one of these values
    std::vector<std::string> label_names = {};  ///< the same by the names that the file has for them
    bool is_nonzero = false;                    ///< all voxels other than 0
    std::optional<double> mask_smoothing = {};  ///< `MaskSmoothing::width`, where the solid is not that of an `iso`
    bool fills_voids = false;                   ///< see `without_voids`; where the solid is not that of an `iso`

    // Point clouds.
    std::optional<CloudMethod> cloud_method = {};  ///< unset: that of `choose_method`
    std::optional<double> kernel = {};             ///< `MlsOptions::kernel`; not for `CloudMethod::kCrust`
    /// The finest tolerance that the solid will be sampled with (`finest_delta`), relative to the diagonal of the
    /// points' bounding box or absolute: points much closer together are thinned. Unset: all are kept.
    std::optional<Length> delta = {};

    /// Whether the result holds the repaired mesh of a mesh.
    bool keeps_mesh = false;

    /// Called with each warning as it arises, also where the call then throws.
    std::function<void(const Diagnostic&)> on_warning = {};
};

/// What is in an image.
struct ImageReport {
    std::array<Index, 3> sizes{};
    Point origin;
    std::array<double, 3> spacing{};
    std::array<Point, 3> directions{};  ///< of the three axes, unit vectors
    float min = 0.0F;
    float max = 0.0F;
    std::vector<LabelCount> labels;  ///< see `scaleaxis::labels`
    std::string unit;                ///< see `Image`
    std::string space;
};
SCALEAXIS_EXPORT ImageReport report_of(const Image& image);
/// The same of values without `unit` and `space`.
SCALEAXIS_EXPORT ImageReport report_of(const ImageView& image);

/// What is in a point cloud, and how it became a solid.
struct PointsReport {
    CloudReport cloud;
    std::optional<CloudMethod> method;  ///< unset where that was not decided
    std::string reason;                 ///< for the method, one line
};

/// What is in a list of balls.
struct UnionReport {
    std::int64_t balls = 0;
    std::int64_t distinct = 0;  ///< without coinciding ones
    Box bounds;                 ///< of the balls
    double min_radius = 0.0;    ///< 0 where there are no balls
    double max_radius = 0.0;
};
/// \throws UnusableInput as `cleaned` does
SCALEAXIS_EXPORT UnionReport report_of(std::span<const Ball> balls);

/// What is in a medial complex.
struct ComplexReport {
    std::int64_t vertices = 0;
    std::int64_t edges = 0;
    std::int64_t faces = 0;
    std::int64_t sheets = 0;
    Topology topology;
    Box bounds;               ///< of the balls at its vertices
    double min_radius = 0.0;  ///< 0 where there are no vertices
    double max_radius = 0.0;
};
SCALEAXIS_EXPORT ComplexReport report_of(const MedialComplex& complex);

/// A function that a program was given as text.
struct FunctionReport {
    std::string expression;
    Box bounds;  ///< of the solid
};

/// The report on an input, by its kind.
using InputReport = std::variant<MeshReport, ImageReport, PointsReport, UnionReport, FunctionReport>;
/// The unit of all lengths of an input, as "mm"; empty where it does not say.
SCALEAXIS_EXPORT std::string unit_of(const InputReport& input);

/// A solid, or in its place the samples of its boundary where the input is such samples already
/// (`CloudMethod::kCrust`).
struct LoadedSolid {
    InputReport input;
    std::unique_ptr<Solid> solid;
    std::optional<Samples> samples;  ///< set where `solid` is not
    TriangleMesh mesh;               ///< if `LoadOptions::keeps_mesh`
    TriangleMesh left_out;           ///< see `SolidOfTriangles`
    std::vector<Diagnostic> warnings;
    std::vector<StageCost> costs;
};

/// What suits points that become a solid to be sampled with this tolerance: `LoadOptions::delta`.
SCALEAXIS_EXPORT PrepareOptions prepare_options(std::span<const Point> points, const std::optional<Length>& delta);

/// Makes a solid of a file that `read_mesh`, `read_image`, `read_points`, `read_balls` or `read_axis` reads; an axis is
/// the union of its balls.
/// \throws FileError, UnusableInput, InvalidOption, Cancelled
SCALEAXIS_EXPORT LoadedSolid load_solid(const std::filesystem::path& file, const LoadOptions& options = {},
                                        const Execution& execution = {});

SCALEAXIS_EXPORT LoadedSolid load_solid(const FileBytes& file, const LoadOptions& options = {},
                                        const Execution& execution = {});

/// The same of an image that was read already. \throws UnusableInput, InvalidOption, Cancelled
SCALEAXIS_EXPORT LoadedSolid load_solid(Image image, const LoadOptions& options, const Execution& execution = {});

/// The same of the objects of a file that were read already. \throws UnusableInput, InvalidOption, Cancelled
SCALEAXIS_EXPORT LoadedSolid load_solid(MeshObjects objects, const LoadOptions& options,
                                        const Execution& execution = {});

/// The same of one label of an image that was read already, which is as if it were the only label of `options`. Takes
/// the time and memory of the part of the image around the label, not of all of it.
/// \param report that of the image, which `check` has passed
/// \throws UnusableInput, also if the image does not have the label; InvalidOption, Cancelled
SCALEAXIS_EXPORT LoadedSolid load_label(const ImageView& image, const ImageReport& report, float label,
                                        LoadOptions options, const Execution& execution = {});

/// Refuses options that have no effect on an input of this kind ("mesh", "image", "points", "balls", "axis",
/// "function"), or beside each other. \throws InvalidOption
SCALEAXIS_EXPORT void validate(const LoadOptions& options, std::string_view kind);

/// The name of a kind in messages: "mesh", "points", "balls", "axis" or "image".
SCALEAXIS_EXPORT std::string_view name_of(FileKind kind);

/// The balls at the vertices of an axis: of the simplified solid. Those of radius 0, on sharp edges, are left out.
SCALEAXIS_EXPORT std::vector<Ball> balls_of(const MedialComplex& complex);

/// The balls of a file that holds balls or an axis.
/// \throws FileError
SCALEAXIS_EXPORT std::vector<Ball> read_union(const std::filesystem::path& file);
SCALEAXIS_EXPORT std::vector<Ball> read_union(const FileBytes& file);

}  // namespace scaleaxis::inline v1
