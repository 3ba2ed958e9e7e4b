// SPDX-License-Identifier: Apache-2.0
/// \file
/// What tables say of solids: size, thickness, branches and topology, of the whole, of components, or of parts.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/skeleton.hpp"
#include "scaleaxis/thickness.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// What a row stands for.
enum class MeasuredPieces {
    kWhole,
    kComponents,  ///< of the skeleton, in its order
    kParts,       ///< those of the solid that belong to the branches of its skeleton, in their order; then those that
                  ///< belong to none: balls, and sheets that no face could leave without changing the topology
};

/// Lengths, areas and volumes are in units of the solid.
struct Measures {
    std::optional<double> volume;  ///< that the surface encloses; unset for parts, which have no surface of their own
    SurfaceValues thickness;       ///< local thickness over the surface, and the area of that
    double sheet_area = 0.0;       ///< of the sheets of the axis
    Index sheets = 0;              ///< of the axis
    double curve_length = 0.0;     ///< of the branches of the skeleton
    Index branches = 0;            ///< of the skeleton
    Index ends = 0;                ///< nodes of one edge
    Index junctions = 0;           ///< nodes where three or more branches meet
    Topology topology;             ///< of the skeleton
};

struct MeasureOptions {
    MeasuredPieces pieces = MeasuredPieces::kWhole;
    ThicknessOptions thickness;
};

/// Measures a solid by its axis. The surface and the sheets belong to the nodes of the skeleton that they are nearest
/// to (`nearest_nodes`, `Skeleton::vertex_nodes`), and with them to a component or a part; a triangle or a sheet that
/// belongs to several counts for that of its first corner.
/// \param axis cleaned \param skeleton of the axis \param surface the boundary of the solid, closed; its vertices are
///     where thickness is asked: see `with_short_edges`
/// \returns one row; or one for each component, or part. A piece that no vertex of the surface belongs to has an area
///     and a thickness of 0.
/// \throws InvalidOption, UnusableInput (see `Thickness`, `nearest_nodes`), Cancelled
SCALEAXIS_EXPORT std::vector<Measures> measures(const MedialComplex& axis, const Skeleton& skeleton,
                                                const TriangleMesh& surface, const MeasureOptions& options = {},
                                                const Execution& execution = {});

/// The same where thickness is known, as that of a solid whose surface is sampled; volume and area are those of another
/// surface, one that is closer to the solid: see `with_bulging_edges`. \param thickness #V of `surface`
SCALEAXIS_EXPORT std::vector<Measures> measures(const MedialComplex& axis, const Skeleton& skeleton,
                                                const TriangleMesh& surface, std::span<const double> thickness,
                                                const TriangleMesh& closer, const MeasureOptions& options = {},
                                                const Execution& execution = {});

}  // namespace scaleaxis::inline v1
