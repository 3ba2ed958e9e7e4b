// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "axis/complex.hpp"
#include "io/formats.hpp"
#include "io/meshes/shells.hpp"
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

/// Single nodes become vertices, branches lines, sheets around voids polygons, which are of no branch.
void write_vtp_skeleton(OutputFile& out, const Skeleton& skeleton) {
    const std::vector<Index> degree = degrees(skeleton);
    const std::size_t count = skeleton.nodes.size();
    Cells cells{{}, skeleton.branches, skeleton.faces};
    for (Index n = 0; n < static_cast<Index>(count); ++n) {
        if (degree[n] == 0) {
            cells.vertices.push_back(std::array{n});
        }
    }
    begin_piece(out, count, cells, "radius");
    write_array(out, "radius", count, [&](std::size_t n) { return skeleton.radii[n]; });
    write_array(out, "degree", count, [&](std::size_t n) { return degree[n]; });
    write_array(out, "branch", count, [&](std::size_t n) { return skeleton.node_branches[n]; });
    write_array(out, "component", count, [&](std::size_t n) { return skeleton.node_components[n]; });
    out.text("</PointData>\n<CellData Scalars=\"branch\">\n");
    const auto branch_of = [&](std::size_t cell) {
        const std::size_t b = cell - cells.vertices.size();
        return cell >= cells.vertices.size() && b < cells.lines.size() ? static_cast<Index>(b) : kNone;
    };
    const std::size_t cell_count = cells.vertices.size() + cells.lines.size() + cells.polygons.size();
    write_array(out, "branch", cell_count, branch_of);
    write_array(out, "length", cell_count, [&](std::size_t cell) {
        const Index branch = branch_of(cell);
        return branch == kNone ? 0.0 : branch_length(skeleton, branch);
    });
    out.text("</CellData>\n");
    end_piece(out, skeleton.nodes, cells);
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
