// SPDX-License-Identifier: Apache-2.0
// Sizes of elements as meshers read them: views of Gmsh, and mesh and solution of Medit's formats for mmg.
#include "scaleaxis/sizes.hpp"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "io/formats.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {

namespace {

constexpr int kTetrahedronOfGmsh = 4;

// Each vertex of a view stands there some 25 times: seven digits of its size make the file smaller.
float single(double value) { return static_cast<float>(value); }

void write_place(OutputFile& out, const Point& p) { out.text(p.x, ' ', p.y, ' ', p.z); }

}  // namespace

/// Gmsh's parsed views: of each tetrahedron corners and sizes.
void write_pos_sizes(OutputFile& out, const SizeField& field, const Execution& execution) {
    const SizeMesh mesh = field.background(execution);
    out.text("// made by scaleaxis: gmsh part.step -bgm this.pos -3\nView \"size\" {\n");
    for (const std::array<Index, 4>& tetrahedron : mesh.tetrahedra) {
        char separator = '(';
        out.text("SS");
        for (const Index v : tetrahedron) {
            const Point& p = mesh.vertices[v];
            out.text(separator, p.x, ',', p.y, ',', p.z);
            separator = ',';
        }
        separator = '{';
        out.text(')');
        for (const Index v : tetrahedron) {
            out.text(separator, single(mesh.sizes[v]));
            separator = ',';
        }
        out.text("};\n");
    }
    out.text("};\n");
}

/// Gmsh 4.1, in the text form.
void write_msh_sizes(OutputFile& out, const SizeField& field, const Execution& execution) {
    const SizeMesh mesh = field.background(execution);
    Box box;
    std::ranges::for_each(mesh.vertices, [&](const Point& p) { box.extend(p); });
    const std::size_t nodes = mesh.vertices.size();
    out.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 ");
    write_place(out, box.min);
    out.text(' ');
    write_place(out, box.max);
    out.text(" 0 0\n$EndEntities\n$Nodes\n1 ", nodes, " 1 ", nodes, "\n3 1 0 ", nodes, '\n');
    for (std::size_t v = 1; v <= nodes; ++v) {
        out.text(v, '\n');
    }
    for (const Point& p : mesh.vertices) {
        write_place(out, p);
        out.text('\n');
    }
    const std::size_t elements = mesh.tetrahedra.size();
    out.text("$EndNodes\n$Elements\n1 ", elements, " 1 ", elements, "\n3 1 ", kTetrahedronOfGmsh, ' ', elements, '\n');
    for (std::size_t t = 0; t < elements; ++t) {
        const auto& [a, b, c, d] = mesh.tetrahedra[t];
        out.text(t + 1, ' ', a + 1, ' ', b + 1, ' ', c + 1, ' ', d + 1, '\n');
    }
    out.text("$EndElements\n$NodeData\n1\n\"size\"\n1\n0\n3\n0\n1\n", nodes, '\n');
    for (std::size_t v = 0; v < nodes; ++v) {
        out.text(v + 1, ' ', mesh.sizes[v], '\n');
    }
    out.text("$EndNodeData\n");
}

void write_medit_surface(OutputFile& out, const TriangleMesh& mesh) {
    out.text("MeshVersionFormatted 2\nDimension 3\nVertices\n", mesh.vertices.size(), '\n');
    for (const Point& p : mesh.vertices) {
        write_place(out, p);
        out.text(" 0\n");
    }
    out.text("Triangles\n", mesh.triangles.size(), '\n');
    for (const auto& [a, b, c] : mesh.triangles) {
        out.text(a + 1, ' ', b + 1, ' ', c + 1, " 0\n");
    }
    out.text("End\n");
}

void write_sol(OutputFile& out, std::span<const double> sizes) {
    constexpr int kScalar = 1;
    out.text("MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n", sizes.size(), "\n1 ", kScalar, '\n');
    for (const double size : sizes) {
        out.text(size, '\n');
    }
    out.text("End\n");
}

void write_sol_sizes(OutputFile& out, const SizeField& field, const Execution& /*execution*/) {
    write_sol(out, field.surface_sizes());
}

std::vector<Point> read_medit_vertices(std::string_view content) {
    TextReader reader(content);
    reader.expect("meshversionformatted", "a mesh in Medit's text format");
    for (std::string_view word = reader.any_word(); !word.empty(); word = reader.any_word()) {
        if (word == "Dimension") {
            if (reader.any_integer() != 3) {
                reader.fail("a mesh of three dimensions is needed", "file.unsupported");
            }
        } else if (word == "Vertices") {
            std::vector<Point> vertices(reader.any_count("vertices", std::string_view("0 0 0 0 ").size()));
            for (Point& vertex : vertices) {
                vertex = reader.any_point();
                reader.any_number();  // a reference
            }
            return vertices;
        }
    }
    reader.fail_at_end("Vertices");
}

}  // namespace scaleaxis::io
