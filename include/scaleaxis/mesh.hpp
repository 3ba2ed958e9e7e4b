// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is in a triangle mesh, and how to make it a solid's boundary.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// What triangles make solid.
enum class SolidKind : std::uint8_t {
    kAuto,     ///< `kWinding` where that makes sense
    kWinding,  ///< what the surface winds around, after its holes were closed
    kWrap,     ///< what a ball of a given diameter cannot reach from outside
    kThicken,  ///< what is close to the triangles
};

/// The name of a kind: "auto", "winding", "wrap" or "thicken".
SCALEAXIS_EXPORT std::string_view name_of(SolidKind kind);

/// How triangles become a solid.
struct SolidOptions {
    SolidKind kind = SolidKind::kAuto;
    double opening = 0.0;    ///< of `kWrap`: the diameter of the ball, in units of the mesh, > 0
    double thickness = 0.0;  ///< of `kThicken`: twice the distance up to which points count, in units of the mesh, > 0
};

/// A hole of a surface, and the patch that closes it.
struct Hole {
    Point place;         ///< a point of its rim
    double width = 0.0;  ///< the diagonal of the rim's bounding box
    double area = 0.0;   ///< of the patch
    std::int64_t edges = 0;
    Point center;  ///< centroid of the rim
};

/// What was found in a mesh. Counts refer to the mesh before any repair, unless they say otherwise.
struct MeshReport {
    std::int64_t vertices = 0;
    std::int64_t triangles = 0;
    Box bounds;
    std::string unit;  ///< of lengths, where the file says it (`MeshObjects::unit`)

    // Repaired by `repair`:
    std::int64_t isolated_vertices = 0;
    std::int64_t duplicate_vertices = 0;    ///< welded, where that closes the mesh
    std::int64_t degenerate_triangles = 0;  ///< of two equal corners, or (where that leaves the mesh closed) no area
    std::int64_t duplicate_triangles = 0;
    std::int64_t split_vertices = 0;       ///< non-manifold vertices, given one copy for each fan
    std::int64_t reversed_triangles = 0;   ///< turned to agree with their neighbours
    std::int64_t reversed_components = 0;  ///< inward-oriented, turned outward
    double weld_tolerance = 0.0;           ///< vertices this close were welded; 0: those at the same place
    std::int64_t wall_triangles = 0;       ///< of walls and fins between parts of a closed surface, left out
    std::int64_t sheet_triangles = 0;      ///< of sheets beside parts that have an inside, left out
    std::vector<Hole> holes;               ///< closed, the widest first

    // What the repair of vertices and triangles left, before walls were left out and holes were closed:
    std::int64_t boundary_edges = 0;
    std::int64_t non_manifold_edges = 0;

    // After the repair:
    std::int64_t components = 0;          ///< of the surface
    std::int64_t euler = 0;               ///< Euler characteristic of the surface
    std::int64_t genus = 0;               ///< sum over the components; meaningful for a closed surface
    std::int64_t self_intersections = 0;  ///< pairs of triangles that meet where they share no corner
    double area = 0.0;
    double volume = 0.0;  ///< signed

    Diagnostic fault;  ///< why it bounds no solid: one line with the place; empty if it does

    SolidKind kind = SolidKind::kAuto;  ///< how it became a solid; `kAuto` if it did not
    std::string reason;                 ///< for the kind, one line

    /// Was it closed before its holes were?
    bool is_closed() const { return boundary_edges == 0; }
    bool is_manifold() const { return non_manifold_edges == 0; }
    double hole_area() const {
        double sum = 0.0;
        for (const Hole& hole : holes) {
            sum += hole.area;
        }
        return sum;
    }
    /// One line for each kind of repair or remaining oddity (self-intersections), with its count; empty for a clean
    /// mesh.
    SCALEAXIS_EXPORT std::vector<Diagnostic> warnings() const;
};

struct RepairedMesh {
    TriangleMesh mesh;
    MeshReport report;
    TriangleMesh left_out{};  ///< the walls and sheets that `report` counts
};

/// A triangle mesh in arrays of the caller's, #V and #F long. They have to last for the call only.
struct MeshView {
    std::span<const Point> vertices;
    std::span<const std::array<Index, 3>> triangles;
};

/// Makes a mesh the closed, coherently oriented boundary of a solid (see `MeshReport`) and reports what was found and
/// done: what can be repaired without a change of the solid, then holes are closed by patches of small area. Never
/// throws for a bad mesh: `report.fault` then says why `mesh` bounds no solid.
/// \throws InvalidOption for a bad `execution`, Cancelled
SCALEAXIS_EXPORT RepairedMesh repair(TriangleMesh mesh, const Execution& execution = {});
/// The same for arrays of the caller's, which are copied once: the copy becomes the repaired mesh.
SCALEAXIS_EXPORT RepairedMesh repair(const MeshView& mesh, const Execution& execution = {});

/// The solid bounded by a closed triangle mesh: all points of non-zero winding number. Its `warnings()` are those of
/// the report. \throws UnusableInput with the report's fault, if the mesh bounds no solid; Cancelled
SCALEAXIS_EXPORT std::unique_ptr<Solid> mesh_solid(RepairedMesh mesh, const Execution& execution = {});

/// The same for a mesh as it is: repairs it first.
SCALEAXIS_EXPORT std::unique_ptr<Solid> mesh_solid(TriangleMesh mesh, const Execution& execution = {});
/// The same for arrays of the caller's, which are copied once.
SCALEAXIS_EXPORT std::unique_ptr<Solid> mesh_solid(const MeshView& mesh, const Execution& execution = {});

/// A solid made of triangles, with a report on them.
struct SolidOfTriangles {
    std::unique_ptr<Solid> solid;  ///< null if the triangles make none: `report.fault` says why
    MeshReport report;
    TriangleMesh mesh;  ///< the closed surface that bounds it; empty where there is none but that of samples
    /// Triangles given of which some may be no part of its boundary: those of `RepairedMesh`, or all of a wrap.
    TriangleMesh left_out{};
};

/// The solid that triangles make, of whatever kind. Never throws for bad triangles: see `SolidOfTriangles::solid`.
/// \throws InvalidOption for options that do not go together; Cancelled
SCALEAXIS_EXPORT SolidOfTriangles solid_of_triangles(TriangleMesh mesh, const SolidOptions& options,
                                                     const Execution& execution = {});

/// The same for arrays of the caller's, which are copied once.
SCALEAXIS_EXPORT SolidOfTriangles solid_of_triangles(const MeshView& mesh, const SolidOptions& options,
                                                     const Execution& execution = {});

/// \throws InvalidOption if a length is missing, or has no effect
SCALEAXIS_EXPORT void validate(const SolidOptions& options);

}  // namespace scaleaxis::inline v1
