// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <utility>

#include "base/progress.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"

namespace scaleaxis {
std::string_view name_of(SolidKind kind) {
    switch (kind) {
        case SolidKind::kWinding:
            return "winding";
        case SolidKind::kWrap:
            return "wrap";
        case SolidKind::kThicken:
            return "thicken";
        default:
            return "auto";
    }
}

void validate(const SolidOptions& options) {
    const auto check = [&](SolidKind kind, double length, const std::string& name, const std::string& its_kind) {
        if (options.kind != kind && length != 0.0) {
            throw InvalidOption("the " + name + " has no effect: it is for the solid " + its_kind);
        }
        if (options.kind == kind && !(length > 0.0 && std::isfinite(length))) {
            throw InvalidOption("the solid " + its_kind + " needs a positive length: the " + name);
        }
    };
    check(SolidKind::kWrap, options.opening, "opening", "wrap");
    check(SolidKind::kThicken, options.thickness, "thickness", "thicken");
}

SolidOfTriangles solid_of_triangles(TriangleMesh mesh, const SolidOptions& options, const Execution& execution) {
    validate(options);
    SolidOfTriangles result;
    RepairedMesh repaired = repair(std::move(mesh), part_of(execution, 0.0, 0.7));
    result.report = repaired.report;
    if (result.report.fault.empty()) {
        result.mesh = repaired.mesh;
        result.solid = mesh_solid(std::move(repaired), part_of(execution, 0.7, 1.0));
    }
    return result;
}

SolidOfTriangles solid_of_triangles(const MeshView& mesh, const SolidOptions& options, const Execution& execution) {
    return solid_of_triangles(
        TriangleMesh{{mesh.vertices.begin(), mesh.vertices.end()}, {mesh.triangles.begin(), mesh.triangles.end()}},
        options, execution);
}

}  // namespace scaleaxis
