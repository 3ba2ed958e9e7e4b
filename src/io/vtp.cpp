// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "axis/complex.hpp"
#include "io/formats.hpp"
#include "io/meshes/shells.hpp"
#include "scaleaxis/centerlines.hpp"
#include "scaleaxis/skeleton.hpp"

namespace scaleaxis::io {
namespace {

/// A `DataArray` of the values `value(0)`, …, `value(count - 1)`.
template <class Value>
void write_array(OutputFile& out, std::string_view name, std::size_t count, const Value& value) {
    constexpr bool is_real = std::is_same_v<std::decay_t<decltype(value(0))>, double>;
    out.text("<DataArray type=\"", is_real ? "Float64" : "Int32", "\" Name=\"", name, "\" format=\"ascii\">\n");
    for (std::size_t i = 0; i < count; ++i) {
        out.text(value(i), '\n');
    }
    out.text("</DataArray>\n");
}

/// Cells of one kind: the points of one after the other, and where each cell ends.
void write_cells(OutputFile& out, std::string_view kind, const IndexLists& cells) {
    out.text('<', kind, ">\n");
    write_array(out, "connectivity", cells.items.size(), [&](std::size_t i) { return cells.items[i]; });
    write_array(out, "offsets", cells.size(), [&](std::size_t i) { return cells.offsets[i + 1]; });
    out.text("</", kind, ">\n");
}

void write_values(OutputFile& out, std::span<const VertexValues> all) {
    for (const auto& [name, values] : all) {
        write_array(out, name, values.size(),
                    [&, &values = values](std::size_t v) { return finite_or_minus_one(values[v]); });
    }
}

/// The cells of a file by their kinds.
struct Cells {
    IndexLists vertices;
    IndexLists lines;
    IndexLists polygons;
};

/// Up to the values of points.
void begin_piece(OutputFile& out, std::size_t points, const Cells& cells, std::string_view scalars) {
    out.text("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n");
    out.text("<PolyData>\n<Piece NumberOfPoints=\"", points, "\" NumberOfVerts=\"", cells.vertices.size(),
             "\" NumberOfLines=\"", cells.lines.size(), "\" NumberOfStrips=\"0\" NumberOfPolys=\"",
             cells.polygons.size(), "\">\n<PointData Scalars=\"", scalars, "\">\n");
}

void write_points(OutputFile& out, const std::vector<Point>& points) {
    out.text("<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n");
    for (const Point& p : points) {
        out.text(p.x, ' ', p.y, ' ', p.z, '\n');
    }
    out.text("</DataArray>\n</Points>\n");
}

/// What follows all values.
void end_piece(OutputFile& out, const std::vector<Point>& points, const Cells& cells, bool has_polygons_only = false) {
    write_points(out, points);
    if (!has_polygons_only) {
        write_cells(out, "Verts", cells.vertices);
        write_cells(out, "Lines", cells.lines);
    }
    write_cells(out, "Polys", cells.polygons);
    out.text("</Piece>\n</PolyData>\n</VTKFile>\n");
}

}  // namespace

/// Isolated balls become vertices, curves lines, faces polygons; only these have a sheet and an angle.
void write_vtp_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options) {
    const std::vector<Index> isolated = isolated_vertices(complex);
    const std::vector<Index> edges = listed_edges(complex, options);
    const std::size_t first_face = isolated.size() + edges.size();
    const std::size_t cell_count = first_face + complex.faces.size();
    Cells cells{{}, {}, complex.faces};
    for (const Index v : isolated) {
        cells.vertices.push_back(std::array{v});
    }
    for (const Index e : edges) {
        cells.lines.push_back(complex.edges[e]);
    }
    begin_piece(out, complex.vertices.size(), cells, "radius");
    write_array(out, "radius", complex.vertices.size(), [&](std::size_t v) { return complex.radii[v]; });
    write_values(out, options.vertex_values);
    write_array(out, "ball", complex.vertices.size(),
                [&](std::size_t v) { return stored_number(complex.vertex_origins[v]); });
    const bool has_labels = !complex.vertex_labels.empty();
    if (has_labels) {
        write_array(out, "label", complex.vertices.size(), [&](std::size_t v) { return complex.vertex_labels[v]; });
    }
    out.text("</PointData>\n<CellData Scalars=\"sheet\">\n");
    write_array(out, "sheet", cell_count,
                [&](std::size_t i) { return i < first_face ? kNone : complex.face_sheets[i - first_face]; });
    write_array(out, "angle", cell_count,
                [&](std::size_t i) { return i < first_face ? 0.0 : complex.face_angles[i - first_face]; });
    if (!options.edge_scales.empty() || !options.face_scales.empty()) {
        write_array(out, kVanishingScale, cell_count, [&](std::size_t i) {
            return finite_or_minus_one(i < isolated.size() ? kNeverVanishes
                                       : i < first_face    ? options.edge_scales[edges[i - isolated.size()]]
                                                           : options.face_scales[i - first_face]);
        });
    }
    if (has_labels) {
        const auto vertex_of = [&](std::size_t i) {
            return i < isolated.size() ? isolated[i]
                   : i < first_face    ? complex.edges[edges[i - isolated.size()]][0]
                                       : complex.faces[i - first_face].front();
        };
        write_array(out, "label", cell_count, [&](std::size_t i) { return complex.vertex_labels[vertex_of(i)]; });
    }

    out.text("</CellData>\n");
    end_piece(out, complex.vertices, cells);
}

namespace {

/// The curves of a skeleton as VMTK has centerlines: each line has its own points, in the direction away from the root.
struct Centerlines {
    std::vector<Index> nodes;                ///< of each point; the first ones are all nodes in their order
    IndexLists lines;                        ///< points
    BranchPlaces places;                     ///< of the lines
    std::vector<BranchGeometry> geometries;  ///< of the lines, along them
};

Centerlines centerlines_of(const Skeleton& skeleton) {
    Centerlines result;
    result.places = branch_places(skeleton);
    Skeleton turned = skeleton;
    turned.branches = {};
    std::vector<char> has_line(skeleton.nodes.size());
    for (Index n = 0; n < static_cast<Index>(skeleton.nodes.size()); ++n) {
        result.nodes.push_back(n);
    }
    for (std::size_t b = 0; b < skeleton.branches.size(); ++b) {
        std::vector<Index> nodes(skeleton.branches[b].begin(), skeleton.branches[b].end());
        if (result.places.is_backwards[b] != 0) {
            std::ranges::reverse(nodes);
        }
        turned.branches.push_back(nodes);
        std::vector<Index> points;
        for (const Index node : nodes) {
            if (has_line[node] == 0) {
                has_line[node] = 1;
                points.push_back(node);
            } else {
                points.push_back(static_cast<Index>(result.nodes.size()));
                result.nodes.push_back(node);
            }
        }
        result.lines.push_back(points);
        result.geometries.push_back(branch_geometry(turned, static_cast<Index>(b)));
    }
    return result;
}

/// An array of what the lines have at each of their points; other points have zeros.
template <class Value>
void write_along(OutputFile& out, std::string_view name, const Centerlines& curves,
                 std::vector<Value> BranchGeometry::*values) {
    std::vector<Value> all(curves.nodes.size());
    for (std::size_t b = 0; b < curves.lines.size(); ++b) {
        for (std::size_t k = 0; k < curves.lines[b].size(); ++k) {
            all[curves.lines[b][k]] = (curves.geometries[b].*values)[k];
        }
    }
    if constexpr (std::is_same_v<Value, Point>) {
        out.text("<DataArray type=\"Float64\" Name=\"", name, "\" NumberOfComponents=\"3\" format=\"ascii\">\n");
        for (const Point& p : all) {
            out.text(p.x, ' ', p.y, ' ', p.z, '\n');
        }
        out.text("</DataArray>\n");
    } else {
        write_array(out, name, all.size(), [&](std::size_t i) { return all[i]; });
    }
}

}  // namespace

/// Single nodes become vertices, branches lines, sheets around voids polygons, which are of no branch. Names and types
/// of VMTK (L. Antiga, D. Steinman; vmtk.org: vmtkcenterlines, vmtkbranchextractor, vmtkcenterlinegeometry,
/// vmtkcenterlineattributes, vmtkcenterlinesections), whose filters find arrays by them, and our own.
void write_vtp_skeleton(OutputFile& out, const Skeleton& skeleton) {
    const std::vector<Index> degree = degrees(skeleton);
    const Centerlines curves = centerlines_of(skeleton);
    const std::size_t count = curves.nodes.size();
    Cells cells{{}, curves.lines, skeleton.faces};
    for (Index n = 0; n < static_cast<Index>(skeleton.nodes.size()); ++n) {
        if (degree[n] == 0) {
            cells.vertices.push_back(std::array{n});
        }
    }
    const auto of_nodes = [&](std::string_view name, const auto& value) {
        write_array(out, name, count, [&](std::size_t i) { return value(curves.nodes[i]); });
    };
    const auto radius = [&](Index n) { return skeleton.radii[n]; };
    begin_piece(out, count, cells, "radius");
    of_nodes("radius", radius);
    of_nodes("degree", [&](Index n) { return degree[n]; });
    of_nodes("branch", [&](Index n) { return skeleton.node_branches[n]; });
    of_nodes("component", [&](Index n) { return skeleton.node_components[n]; });
    of_nodes("node", [](Index n) { return n; });
    of_nodes("MaximumInscribedSphereRadius", radius);
    write_along(out, "Abscissas", curves, &BranchGeometry::abscissas);
    write_along(out, "Curvature", curves, &BranchGeometry::curvature);
    write_along(out, "Torsion", curves, &BranchGeometry::torsion);
    write_along(out, "FrenetTangent", curves, &BranchGeometry::tangents);
    write_along(out, "FrenetNormal", curves, &BranchGeometry::normals);
    write_along(out, "FrenetBinormal", curves, &BranchGeometry::binormals);
    write_along(out, "ParallelTransportNormals", curves, &BranchGeometry::transported);
    if (!skeleton.sections.empty()) {
        const auto section = [&](std::string_view name, const auto& value) {
            of_nodes(name, [&](Index n) { return value(skeleton.sections[n]); });
        };
        section("CenterlineSectionArea", [](const Section& s) { return s.area; });
        section("CenterlineSectionMinSize", [](const Section& s) { return s.least_width; });
        section("CenterlineSectionMaxSize", [](const Section& s) { return s.largest_width; });
        section("CenterlineSectionShape",
                [](const Section& s) { return s.largest_width > 0.0 ? s.least_width / s.largest_width : 0.0; });
        section("CenterlineSectionClosed", [](const Section& s) { return s.is_closed ? 1 : 0; });
    }
    out.text("</PointData>\n<CellData Scalars=\"branch\">\n");
    const std::size_t cell_count = cells.vertices.size() + cells.lines.size() + cells.polygons.size();
    const auto of_lines = [&](std::string_view name, const auto& others, const auto& value) {
        write_array(out, name, cell_count, [&](std::size_t cell) {
            const std::size_t b = cell - cells.vertices.size();
            return cell >= cells.vertices.size() && b < cells.lines.size() ? value(b) : others;
        });
    };
    const auto number = [](std::size_t b) { return static_cast<Index>(b); };
    const auto length = [&](std::size_t b) { return branch_length(skeleton, static_cast<Index>(b)); };
    of_lines("branch", kNone, number);
    of_lines("length", 0.0, length);
    of_lines("CenterlineIds", kNone, [&](std::size_t b) { return curves.places.centerlines[b]; });
    of_lines("TractIds", kNone, [&](std::size_t b) { return curves.places.tracts[b]; });
    of_lines("GroupIds", kNone, number);
    of_lines("Blanking", Index{1}, [](std::size_t) { return Index{0}; });
    of_lines("Length", 0.0, length);
    of_lines("Tortuosity", 0.0, [&](std::size_t b) { return curves.geometries[b].tortuosity; });
    out.text("</CellData>\n");
    std::vector<Point> points;
    std::ranges::transform(curves.nodes, std::back_inserter(points), [&](Index n) { return skeleton.nodes[n]; });
    end_piece(out, points, cells);
}

void write_vtp_surface(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values) {
    Cells cells;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        cells.polygons.push_back(triangle);
    }
    begin_piece(out, mesh.vertices.size(), cells, values.front().name);
    write_values(out, values);
    out.text("</PointData>\n");
    end_piece(out, mesh.vertices, cells, true);
}

void write_vtu_shells(OutputFile& out, const ShellMesh& shells, bool has_middles) {
    const ShellNodes nodes = shell_nodes(shells, has_middles);
    const std::size_t count = nodes.triangles.size();
    out.text(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n");
    out.text("<UnstructuredGrid>\n<Piece NumberOfPoints=\"", nodes.places.size(), "\" NumberOfCells=\"", count,
             "\">\n<PointData Scalars=\"thickness\">\n");
    write_array(out, "thickness", nodes.thickness.size(), [&](std::size_t v) { return nodes.thickness[v]; });
    out.text("</PointData>\n<CellData Scalars=\"sheet\">\n");
    write_array(out, "sheet", count, [&](std::size_t t) { return shells.triangle_sheets[t]; });
    write_array(out, "thickness", count, [&](std::size_t t) { return mean_thickness(shells, t); });
    out.text("</CellData>\n");
    write_points(out, nodes.places);
    constexpr int kTriangle = 5;
    constexpr int kQuadraticTriangle = 22;
    out.text("<Cells>\n");
    write_array(out, "connectivity", nodes.triangles.items.size(),
                [&](std::size_t i) { return nodes.triangles.items[i]; });
    write_array(out, "offsets", count, [&](std::size_t t) { return nodes.triangles.offsets[t + 1]; });
    write_array(out, "types", count, [&](std::size_t) { return has_middles ? kQuadraticTriangle : kTriangle; });
    out.text("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

}  // namespace scaleaxis::io
