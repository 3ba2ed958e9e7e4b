// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "io/formats.hpp"
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
template <class Corner, class End>
void write_cells(OutputFile& out, std::string_view kind, std::size_t corner_count, const Corner& corner,
                 std::size_t cell_count, const End& end) {
    out.text('<', kind, ">\n");
    write_array(out, "connectivity", corner_count, corner);
    write_array(out, "offsets", cell_count, end);
    out.text("</", kind, ">\n");
}

constexpr std::string_view kHead =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
    "byte_order=\"LittleEndian\">\n<PolyData>\n";

void write_points(OutputFile& out, const std::vector<Point>& points) {
    out.text("<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n");
    for (const Point& p : points) {
        out.text(p.x, ' ', p.y, ' ', p.z, '\n');
    }
    out.text("</DataArray>\n</Points>\n");
}

}  // namespace

/// Isolated balls become vertices, curves lines, faces polygons; only these have a sheet and an angle.
void write_vtp_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options) {
    const std::vector<Index> isolated = isolated_vertices(complex);
    const std::vector<Index> edges = listed_edges(complex, options);
    const std::size_t first_face = isolated.size() + edges.size();
    const std::size_t cell_count = first_face + complex.faces.size();

    out.text(kHead);
    out.text("<Piece NumberOfPoints=\"", complex.vertices.size(), "\" NumberOfVerts=\"", isolated.size(),
             "\" NumberOfLines=\"", edges.size(), "\" NumberOfStrips=\"0\" NumberOfPolys=\"", complex.faces.size(),
             "\">\n");

    out.text("<PointData Scalars=\"radius\">\n");
    write_array(out, "radius", complex.vertices.size(), [&](std::size_t v) { return complex.radii[v]; });
    for (const VertexValues& attribute : options.vertex_values) {
        write_array(out, attribute.name, attribute.values.size(),
                    [&](std::size_t v) { return finite_or_minus_one(attribute.values[v]); });
    }
    write_array(out, "ball", complex.vertices.size(), [&](std::size_t v) { return complex.vertex_balls[v]; });
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
    write_points(out, complex.vertices);

    write_cells(
        out, "Verts", isolated.size(), [&](std::size_t i) { return isolated[i]; }, isolated.size(),
        [](std::size_t i) { return i + 1; });
    write_cells(
        out, "Lines", 2 * edges.size(), [&](std::size_t i) { return complex.edges[edges[i / 2]][i % 2]; }, edges.size(),
        [](std::size_t i) { return 2 * (i + 1); });
    write_cells(
        out, "Polys", complex.faces.items.size(), [&](std::size_t i) { return complex.faces.items[i]; },
        complex.faces.size(), [&](std::size_t f) { return complex.faces.offsets[f + 1]; });
    out.text("</Piece>\n</PolyData>\n</VTKFile>\n");
}

/// Single nodes become vertices, branches lines, sheets around voids polygons, which are of no branch.
void write_vtp_skeleton(OutputFile& out, const Skeleton& skeleton) {
    const std::vector<Index> degree = degrees(skeleton);
    std::vector<Index> single;
    for (Index n = 0; n < static_cast<Index>(degree.size()); ++n) {
        if (degree[n] == 0) {
            single.push_back(n);
        }
    }
    const std::size_t count = skeleton.nodes.size();
    const IndexLists& branches = skeleton.branches;
    const IndexLists& faces = skeleton.faces;
    out.text(kHead, "<Piece NumberOfPoints=\"", count, "\" NumberOfVerts=\"", single.size(), "\" NumberOfLines=\"",
             branches.size(), "\" NumberOfStrips=\"0\" NumberOfPolys=\"", faces.size(), "\">\n");
    out.text("<PointData Scalars=\"radius\">\n");
    write_array(out, "radius", count, [&](std::size_t n) { return skeleton.radii[n]; });
    write_array(out, "degree", count, [&](std::size_t n) { return degree[n]; });
    write_array(out, "branch", count, [&](std::size_t n) { return skeleton.node_branches[n]; });
    write_array(out, "component", count, [&](std::size_t n) { return skeleton.node_components[n]; });
    out.text("</PointData>\n<CellData Scalars=\"branch\">\n");
    const auto branch_of = [&](std::size_t cell) {
        const std::size_t b = cell - single.size();
        return cell >= single.size() && b < branches.size() ? static_cast<Index>(b) : kNone;
    };
    const std::size_t cells = single.size() + branches.size() + faces.size();
    write_array(out, "branch", cells, branch_of);
    write_array(out, "length", cells, [&](std::size_t cell) {
        const Index branch = branch_of(cell);
        return branch == kNone ? 0.0 : branch_length(skeleton, branch);
    });
    out.text("</CellData>\n");
    write_points(out, skeleton.nodes);
    write_cells(
        out, "Verts", single.size(), [&](std::size_t i) { return single[i]; }, single.size(),
        [](std::size_t i) { return i + 1; });
    for (const auto& [kind, lists] : {std::pair("Lines", &branches), std::pair("Polys", &faces)}) {
        const IndexLists& all = *lists;
        write_cells(
            out, kind, all.items.size(), [&](std::size_t i) { return all.items[i]; }, all.size(),
            [&](std::size_t i) { return all.offsets[i + 1]; });
    }
    out.text("</Piece>\n</PolyData>\n</VTKFile>\n");
}

void write_vtp_surface(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values) {
    out.text(kHead, "<Piece NumberOfPoints=\"", mesh.vertices.size(),
             "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"", mesh.triangles.size(),
             "\">\n<PointData Scalars=\"", values.front().name, "\">\n");
    for (const VertexValues& attribute : values) {
        write_array(out, attribute.name, attribute.values.size(),
                    [&](std::size_t v) { return finite_or_minus_one(attribute.values[v]); });
    }
    out.text("</PointData>\n");
    write_points(out, mesh.vertices);
    write_cells(
        out, "Polys", 3 * mesh.triangles.size(), [&](std::size_t i) { return mesh.triangles[i / 3][i % 3]; },
        mesh.triangles.size(), [](std::size_t f) { return 3 * (f + 1); });
    out.text("</Piece>\n</PolyData>\n</VTKFile>\n");
}

}  // namespace scaleaxis::io
