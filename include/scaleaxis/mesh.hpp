// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is in a triangle mesh, and how to make it a solid's boundary.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis {

/// What was found in a mesh. Counts refer to the mesh before any repair, unless they say otherwise.
struct MeshReport {
    std::int64_t vertices = 0;
    std::int64_t triangles = 0;
    Box bounds;

    // Repaired by `repair`:
    std::int64_t isolated_vertices = 0;
    std::int64_t duplicate_vertices = 0;    ///< welded, where that closes the mesh
    std::int64_t degenerate_triangles = 0;  ///< of two equal corners, or (where that leaves the mesh closed) no area
    std::int64_t duplicate_triangles = 0;
    std::int64_t split_vertices = 0;       ///< non-manifold vertices, given one copy for each fan
    std::int64_t reversed_triangles = 0;   ///< turned to agree with their neighbours
    std::int64_t reversed_components = 0;  ///< inward-oriented, turned outward

    // After the repair:
    std::int64_t boundary_edges = 0;
    std::int64_t non_manifold_edges = 0;
    std::int64_t components = 0;          ///< of the surface
    std::int64_t euler = 0;               ///< Euler characteristic of the surface
    std::int64_t genus = 0;               ///< sum over the components; meaningful for a closed surface
    std::int64_t self_intersections = 0;  ///< pairs of triangles that meet where they share no corner
    double area = 0.0;
    double volume = 0.0;  ///< signed

    Diagnostic fault;  ///< why it bounds no solid: one line with the place; empty if it does

    bool is_closed() const { return boundary_edges == 0; }
    bool is_manifold() const { return non_manifold_edges == 0; }
    /// One line for each kind of repair or remaining oddity (self-intersections), with its count; empty for a clean
    /// mesh.
    SCALEAXIS_EXPORT std::vector<Diagnostic> warnings() const;
};

struct RepairedMesh {
    TriangleMesh mesh;
    MeshReport report;
};

/// A triangle mesh in arrays of the caller's, #V and #F long. They have to last for the call only.
struct MeshView {
    std::span<const Point> vertices;
    std::span<const std::array<Index, 3>> triangles;
};

/// Repairs what can be repaired without a change of the solid (see `MeshReport`) and reports what was found. Never
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

}  // namespace scaleaxis
