// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the library measured, found and warns of: as JSON (docs/statistics.md has the keys) and as text for people.
/// Both say the same. `to_json` returns one JSON value without line breaks; `print` writes lines.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scaleaxis/centering.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/delta.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/few_balls.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/fit.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/measures.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/simplification.hpp"
#include "scaleaxis/skeleton.hpp"
#include "scaleaxis/topology.hpp"
#include "scaleaxis/union_mesh.hpp"
#include "scaleaxis/walls.hpp"

namespace scaleaxis::inline v1 {

/// The axis of a union of balls, as `scale_axis` makes one for each scale.
struct AxisReport {
    double scale = 1.0;
    std::filesystem::path file;  ///< where it was written; empty: nowhere
    MedialAxisStatistics medial;
    std::optional<FilterStatistics> filter;      ///< unset where nothing was filtered
    std::optional<SharpEdgeStatistics> sharp;    ///< unset where no sharp edges were looked for
    std::optional<CleanStatistics> clean;        ///< unset where nothing was cleaned
    std::optional<CenterStatistics> center;      ///< unset where balls stay as the union has them
    std::optional<FilterStatistics> narrow;      ///< unset where nothing was filtered again
    std::optional<SimplifyStatistics> simplify;  ///< unset where nothing was made compact
    std::optional<EnvelopeAccuracy> accuracy;    ///< of the compact axis
    std::optional<Topology> solid;               ///< of the input solid; unset where it is not known
    Index vertices = 0;                          ///< of the result: its balls
    Index edges = 0;
    Index faces = 0;
    Index sheets = 0;
    std::vector<Gap> closed_gaps;  ///< see `AxisAtScale`
    std::vector<StageCost> costs;

    SCALEAXIS_EXPORT void set_result(const MedialComplex& complex);
};
SCALEAXIS_EXPORT AxisReport report_of(const AxisAtScale& axis, const std::optional<Topology>& solid,
                                      std::filesystem::path file = {});

/// Does each complex have the topology of the one before it? Unset where one of the two is not known.
struct Agreement {
    std::optional<bool> solid_and_dual;
    bool dual_and_medial = false;
    std::optional<bool> medial_and_filtered;
    std::optional<bool> filtered_and_sharp;
    std::optional<bool> filtered_and_cleaned;
    std::optional<bool> compact_and_before;
};
SCALEAXIS_EXPORT Agreement agreement(const AxisReport& axis);

SCALEAXIS_EXPORT std::string to_json(const Box& box);  ///< `null` for an empty box
SCALEAXIS_EXPORT std::string to_json(const Topology& topology);
SCALEAXIS_EXPORT std::string to_json(const MeshReport& mesh);
SCALEAXIS_EXPORT std::string to_json(const ImageReport& image);
SCALEAXIS_EXPORT std::string to_json(const PointsReport& points);
SCALEAXIS_EXPORT std::string to_json(const UnionReport& balls);
SCALEAXIS_EXPORT std::string to_json(const ComplexReport& complex);
SCALEAXIS_EXPORT std::string to_json(const FunctionReport& function);
SCALEAXIS_EXPORT std::string to_json(const InputReport& input);
SCALEAXIS_EXPORT std::string to_json(const SamplingStatistics& sampling);
SCALEAXIS_EXPORT std::string to_json(const DeltaChoice& choice);
SCALEAXIS_EXPORT std::string to_json(const FitReport& fit);
SCALEAXIS_EXPORT std::string to_json(const FewBallsStatistics& statistics);
SCALEAXIS_EXPORT std::string to_json(const BallScores& scores);
SCALEAXIS_EXPORT std::string to_json(const AxisReport& axis);
SCALEAXIS_EXPORT std::string to_json(const FilterStatistics& filter);
SCALEAXIS_EXPORT std::string to_json(const CleanStatistics& clean);
SCALEAXIS_EXPORT std::string to_json(const SimplifyStatistics& simplify);
SCALEAXIS_EXPORT std::string to_json(const SkeletonStatistics& skeleton);
SCALEAXIS_EXPORT std::string to_json(const Measures& measures);
SCALEAXIS_EXPORT std::string to_json(const Walls& walls);  ///< the tolerance and the findings
SCALEAXIS_EXPORT std::string to_json(std::span<const FiltrationLevel> levels);
SCALEAXIS_EXPORT std::string to_json(const ScalePlateau& plateau);
SCALEAXIS_EXPORT std::string to_json(const UnionMesh& mesh, const std::filesystem::path& file);
SCALEAXIS_EXPORT std::string to_json(std::span<const StageCost> costs);
SCALEAXIS_EXPORT std::string to_json(const Diagnostic& diagnostic);  ///< `null` for an empty one
SCALEAXIS_EXPORT std::string to_json(std::span<const Diagnostic> diagnostics);

/// What is left over the scale as a table: a line for each level, with the names of `FiltrationLevel` above.
SCALEAXIS_EXPORT std::string to_csv(std::span<const FiltrationLevel> levels);

/// A picture of what is left over the scale, as SVG: area of the sheets, volume and balls as parts of those at s = 1,
/// length of the curves as a part of the largest, and the number of sheets; the plateau is shaded. \param levels as
/// `profile` has them \param title above it
SCALEAXIS_EXPORT std::string to_svg(std::span<const FiltrationLevel> levels, const ScalePlateau& plateau,
                                    std::string_view title);

/// The key of an input in JSON: "mesh", "image", "points", "union" or "function".
SCALEAXIS_EXPORT std::string_view name_of(const InputReport& input);

/// Begins a line with its first column.
SCALEAXIS_EXPORT std::ostream& label(std::ostream& out, std::string_view name);

SCALEAXIS_EXPORT void print(std::ostream& out, const Box& box);
SCALEAXIS_EXPORT void print(std::ostream& out, const MeshReport& mesh);
SCALEAXIS_EXPORT void print(std::ostream& out, const ImageReport& image);
SCALEAXIS_EXPORT void print(std::ostream& out, const PointsReport& points);
SCALEAXIS_EXPORT void print(std::ostream& out, const UnionReport& balls);
SCALEAXIS_EXPORT void print(std::ostream& out, const ComplexReport& complex);
SCALEAXIS_EXPORT void print(std::ostream& out, const FunctionReport& function);
SCALEAXIS_EXPORT void print(std::ostream& out, const InputReport& input);
SCALEAXIS_EXPORT void print_solid(std::ostream& out, const Diagnostic& fault, const std::optional<Topology>& topology);
SCALEAXIS_EXPORT void print_samples(std::ostream& out, Index samples, double tolerance,
                                    const SamplingStatistics& sampling);
SCALEAXIS_EXPORT void print(std::ostream& out, const DeltaChoice& choice);
SCALEAXIS_EXPORT void print_balls(std::ostream& out, std::size_t balls,
                                  const std::filesystem::path& file = {});  ///< empty: no file
SCALEAXIS_EXPORT void print(std::ostream& out, const FitReport& fit);
SCALEAXIS_EXPORT void print(std::ostream& out, const FewBallsStatistics& statistics);
SCALEAXIS_EXPORT void print(std::ostream& out, const BallScores& scores);
SCALEAXIS_EXPORT void print(std::ostream& out, const AxisReport& axis);
SCALEAXIS_EXPORT void print(std::ostream& out, const FilterStatistics& filter);
SCALEAXIS_EXPORT void print(std::ostream& out, const CleanStatistics& clean);
SCALEAXIS_EXPORT void print(std::ostream& out, const SimplifyStatistics& simplify);
SCALEAXIS_EXPORT void print(std::ostream& out, const SkeletonStatistics& skeleton);
SCALEAXIS_EXPORT void print(std::ostream& out, const UnionMesh& mesh, const std::filesystem::path& file);
SCALEAXIS_EXPORT void print(std::ostream& out, std::span<const StageCost> costs);

}  // namespace scaleaxis::inline v1
